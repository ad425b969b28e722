!> What the program tells a user of a scene: solved and judged as a single scene is, without its files. The only
!> file of this study that knows how the program does that.
module told_summary
   use certificate, only: certificate_word
   use errors, only: error_t
   use checkpoint, only: checkpoint_t
   use impact_reference, only: compared_harmonics
   use integrate_controlled, only: solve_controlled
   use integrate_motion, only: motion_watcher_t, solve_motion
   use kinds, only: dp
   use node_extremes, only: seen_acceleration, seen_film
   use rattle_class, only: class_name
   use random_scenes, only: drawn_scene_t
   use sample_recorder, only: sample_recorder_t
   use scene_result, only: judge, scene_result_t
   use scene_status, only: is_success, status_name
   use scene_types, only: method_taylor
   implicit none(type, external)
   private

   !> What the summary says.
   type, public :: told_t
      !> Status as a word, and whether there is a window
      character(16) :: status = ''
      logical :: judged = .false., certified = .false.
      character(16) :: class = ''
      character(160) :: reason = ''
      !> film_minimum, film_maximum [m], acceleration_minimum, acceleration_maximum [m/s2], with the errors stated
      real(dp) :: extremes(4) = 0.0_dp, extreme_errors(4) = 0.0_dp
      !> [m/s2], with the errors stated; beyond `harmonic_count` none is listed
      real(dp) :: harmonics(compared_harmonics) = 0.0_dp, harmonic_errors(compared_harmonics) = 0.0_dp
      integer :: harmonic_count = 0
      !> Periods solved, periods of the window, and of the orbit of a steady motion (0: not steady)
      integer :: periods = 0, window = 0, orbit = 0
      logical :: sampling_sufficient = .true.
   end type told_t

   !> Nobody watches.
   type, extends(motion_watcher_t) :: nobody_t
   contains
      procedure :: period_done
   end type nobody_t

   public :: summary_told

contains

   !> Solve and judge a scene.
   subroutine summary_told(drawn, told)
      !> The scene with its solver
      type(drawn_scene_t), intent(in) :: drawn
      type(told_t), intent(out) :: told
      type(scene_result_t) :: result
      type(sample_recorder_t) :: recorder
      type(checkpoint_t) :: start
      type(nobody_t) :: nobody
      type(error_t), allocatable :: error
      integer :: n

      call recorder%open(drawn%scene, '', 0, error)
      if (drawn%scene%solver%method == method_taylor) then
         call solve_controlled(drawn%scene, drawn%resolved%film, drawn%resolved%initial_film, start, .false., recorder, &
                               nobody, result%ending, error)
      else
         call solve_motion(drawn%scene, drawn%resolved%film, drawn%resolved%initial_film, start, recorder, nobody, &
                           result%ending, error)
      end if
      if (.not. allocated(error)) call judge(drawn%scene, drawn%resolved, recorder, result)
      told%status = status_name(result%ending%status)
      if (allocated(error)) told%status = 'not_written'
      told%judged = is_success(result%ending%status) .and. result%judged .and. .not. allocated(error)
      if (.not. told%judged) return
      told%class = class_name(result%rattle%class)
      told%periods = result%ending%periods
      told%window = result%window_periods
      told%orbit = result%ending%orbit
      told%sampling_sufficient = result%rattle%lines%sampling_sufficient
      associate (lowest => result%extremes%lowest, highest => result%extremes%highest)
         told%extremes = [lowest(seen_film)%value, highest(seen_film)%value, lowest(seen_acceleration)%value, &
                          highest(seen_acceleration)%value]
      end associate
      n = min(compared_harmonics, size(result%rattle%lines%harmonics))
      told%harmonic_count = n
      told%harmonics(:n) = result%rattle%lines%harmonics(:n)
      told%harmonic_errors = huge(1.0_dp)
      told%extreme_errors = huge(1.0_dp)
      associate (certificate => result%certificate)
         told%certified = certificate_word(certificate) == 'certified'
         if (allocated(certificate%reason)) told%reason = certificate%reason
         if (.not. allocated(certificate%harmonic_errors)) return
         n = min(n, size(certificate%harmonic_errors))
         told%harmonic_errors(:n) = certificate%harmonic_errors(:n)
         if (n == 0) return
         told%extreme_errors = [certificate%film_minimum_error, certificate%film_maximum_error, &
                                certificate%acceleration_minimum_error, certificate%acceleration_maximum_error]
      end associate
   end subroutine summary_told

   !> Nobody watches.
   subroutine period_done(self, done, all)
      class(nobody_t), intent(inout) :: self
      integer, intent(in) :: done
      integer, intent(in) :: all

      if (done > all .and. same_type_as(self, self)) return
   end subroutine period_done

end module told_summary
