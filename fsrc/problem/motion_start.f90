!> Where motions start by which all motions of one operating point are looked for: from rest, from the coast flank, out of the
!> middle of the gap, and from films and velocities drawn at random. THEORY.md says why these, and what they can show.
module motion_start
   use constants, only: two_pi
   use kinds, only: dp, int64
   use linear_motion, only: natural_motion
   use problem, only: film_at_rest, films_at_rest, has_two_flanks, problem_t, static_load
   use random_numbers, only: random_bit_count, random_bits
   use scene_types, only: method_newmark, solver_t
   implicit none(type, external)
   private

   !> A start at the beginning of a period of the force.
   type, public :: motion_start_t
      !> rest, or given where the scene gives another one; coast, the other flank, or far where there is one flank; middle; random
      character(6) :: name = 'rest'
      !> Film of the drive flank [m] and its velocity [m/s]
      real(dp) :: film = 0.0_dp
      real(dp) :: velocity = 0.0_dp
   end type motion_start_t

   !> Starts that are not drawn; they come first.
   integer, parameter, public :: chosen_starts = 3

   !> Why one start is enough; 0: it is not.
   integer, parameter, public :: several_starts = 0, one_by_newmark = 1, one_without_film = 2, one_without_swing = 3, &
                                 one_by_damping = 4

   !> Velocity from the middle of the gap, and largest size of those that are drawn, over the characteristic one [-].
   real(dp), parameter :: middle_velocity = -4.0_dp, drawn_velocity = 2.0_dp
   !> Share of the gap about its middle that films are drawn from [-].
   real(dp), parameter :: drawn_share = 0.5_dp
   !> Damping ratio from which on the motion on one flank has been seen to be one [-].
   real(dp), parameter :: enough_damping = 0.5_dp
   !> Least share of the oscillating force that a tooth is taken to rest under on the coast flank [-].
   real(dp), parameter :: least_load = 0.01_dp

   public :: characteristic_velocity, gap_of_starts, motion_starts, start_is_given, one_start_reason, one_start_sentence, &
             start_count

contains

   !> Velocity v* that the oscillating force gives a free mass, sum of F_k/(m k omega) [m/s].
   elemental real(dp) function characteristic_velocity(problem)
      type(problem_t), intent(in) :: problem

      characteristic_velocity = swing(problem, 1)
   end function characteristic_velocity

   !> Room of the motion [m]: the backlash, or on one flank the film at rest and twice the way that the force moves a free mass,
   !> sum of F_k/(m (k omega)^2).
   elemental real(dp) function gap_of_starts(problem) result(gap)
      type(problem_t), intent(in) :: problem

      gap = problem%backlash
      if (.not. has_two_flanks(problem)) gap = max(film_at_rest(problem, static_load(problem)), 0.0_dp) + 2.0_dp*swing(problem, 2)
   end function gap_of_starts

   !> Sum of F_k/(m (k omega)^power).
   elemental real(dp) function swing(problem, power)
      type(problem_t), intent(in) :: problem
      !> How often the acceleration is integrated
      integer, intent(in) :: power
      integer :: k

      associate (force => problem%force, omega => two_pi*problem%frequency)
         swing = hypot(force%cosine, force%sine)/omega**power
         do k = 2, force%highest
            swing = swing + hypot(force%others(1, k), force%others(2, k))/(real(k, dp)*omega)**power
         end do
         swing = swing/problem%mass
      end associate
   end function swing

   !> Starts of a problem, its own first. Any of them depends on problem, seed and its place alone.
   pure function motion_starts(problem, count, seed) result(starts)
      type(problem_t), intent(in) :: problem
      !> How many, 1 at least
      integer, intent(in) :: count
      !> Of those that are drawn
      integer, intent(in) :: seed
      type(motion_start_t) :: starts(count)
      real(dp) :: gap, velocity
      integer :: i

      gap = gap_of_starts(problem)
      velocity = characteristic_velocity(problem)
      starts(1) = motion_start_t('rest', problem%initial_film, problem%initial_velocity)
      if (start_is_given(problem)) starts(1)%name = 'given'
      if (count > 1) starts(2) = motion_start_t(merge('coast', 'far  ', has_two_flanks(problem)), other_flank(problem, gap), 0.0_dp)
      if (count > 2) starts(3) = motion_start_t('middle', 0.5_dp*gap, middle_velocity*velocity)
      do i = chosen_starts + 1, count
         starts(i) = motion_start_t('random', gap*(0.5_dp + drawn_share*(drawn(seed, 1, i) - 0.5_dp)), &
                                    velocity*drawn_velocity*(2.0_dp*drawn(seed, 2, i) - 1.0_dp))
      end do
   end function motion_starts

   !> Whether a problem starts from another film or velocity than those at rest.
   pure logical function start_is_given(problem)
      type(problem_t), intent(in) :: problem

      start_is_given = abs(problem%initial_velocity) > 0.0_dp .or. &
                       abs(problem%initial_film - film_at_rest(problem, static_load(problem))) > 0.0_dp
   end function start_is_given

   !> Film of a tooth that rests on the flank that its static load does not press it on [m].
   pure real(dp) function other_flank(problem, gap) result(film)
      type(problem_t), intent(in) :: problem
      !> Room of the motion [m]
      real(dp), intent(in) :: gap
      real(dp) :: load

      film = gap
      if (.not. has_two_flanks(problem)) return
      load = static_load(problem)
      load = -sign(max(abs(load), least_load*swing(problem, 0)*problem%mass), load)
      film = film_at_rest(problem, load)
      if (.not. film > 0.0_dp) film = gap - problem%initial_film
   end function other_flank

   !> A number between 0 and 1.
   pure real(dp) function drawn(seed, stream, place)
      integer, intent(in) :: seed
      integer, intent(in) :: stream
      integer, intent(in) :: place

      drawn = (real(random_bits(int(seed, int64), int(stream, int64), int(place, int64)), dp) + 0.5_dp)/2.0_dp**random_bit_count
   end function drawn

   !> Why the motion from one start is all that is asked for, or several_starts.
   pure integer function one_start_reason(problem, method) result(reason)
      type(problem_t), intent(in) :: problem
      !> Code of the method of the scene
      integer, intent(in) :: method
      real(dp) :: films(2), natural_frequency, damping_ratio

      reason = several_starts
      films = films_at_rest(problem, static_load(problem))
      if (method == method_newmark) then
         reason = one_by_newmark
      else if (.not. (films(1) > 0.0_dp .and. problem%initial_film > 0.0_dp)) then
         reason = one_without_film
      else if (.not. characteristic_velocity(problem) > 0.0_dp) then
         reason = one_without_swing
      else if (.not. has_two_flanks(problem)) then
         call natural_motion(problem, films, natural_frequency, damping_ratio)
         ! No frequency: small motions creep.
         if (.not. natural_frequency > 0.0_dp .or. damping_ratio > enough_damping) reason = one_by_damping
      end if
   end function one_start_reason

   !> How many starts of a scene are followed.
   pure integer function start_count(problem, solver)
      type(problem_t), intent(in) :: problem
      !> Of the scene
      type(solver_t), intent(in) :: solver

      start_count = solver%starts
      if (one_start_reason(problem, solver%method) /= several_starts) start_count = 1
   end function start_count

   !> The reason in words.
   pure function one_start_sentence(reason) result(sentence)
      !> As of one_start_reason
      integer, intent(in) :: reason
      character(:), allocatable :: sentence

      select case (reason)
      case (one_by_newmark)
         sentence = 'one start: the method of the paper follows the motion from its start alone'
      case (one_without_film)
         sentence = 'one start: no film of this law carries the static load'
      case (one_without_swing)
         sentence = 'one start: nothing oscillates'
      case (one_by_damping)
         sentence = 'one start: on one flank and damped above half of the critical damping the motion does not depend on it'
      case default
         sentence = ''
      end select
   end function one_start_sentence

end module motion_start
