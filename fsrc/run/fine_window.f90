!> Last periods of a scene by the error-controlled engine, sampled finely enough for their lines.
module fine_window
   use integrate_controlled, only: solve_window
   use kinds, only: dp
   use lane_scenes, only: lane_ending_t, lane_scene_t
   use rattle_class, only: classify, rattle_verdict_t
   use scene_status, only: is_success
   use scene_types, only: scene_t, spectrum_choice_t
   implicit none(type, external)
   private

   !> Samples of a period and of a window that no spectrum needs.
   integer, parameter :: most_samples_per_period = 16384, most_samples = 8388608

   !> A window.
   type, public :: window_t
      !> Whole periods, and samples of each
      integer :: periods = 0
      integer :: samples_per_period = 0
      !> h [m], z' [m/s], z'' [m/s2]
      real(dp), allocatable :: films(:), velocities(:), accelerations(:)
   end type window_t

   public :: solve_fine_window, classify_window

contains

   !> Solve a scene and double the samples until the spectrum of its last periods needs no more.
   subroutine solve_fine_window(scene, lane, accuracy, periods, noise_floor, window, verdict, ending)
      !> Checked scene
      type(scene_t), intent(in) :: scene
      !> Its lane
      type(lane_scene_t), intent(in) :: lane
      !> Relative accuracy [-]
      real(dp), intent(in) :: accuracy
      !> Periods to solve
      integer, intent(in) :: periods
      !> Amplitude that the errors of the solution explain [m/s2]
      real(dp), intent(in) :: noise_floor
      !> On entry periods and fewest samples, on return the window
      type(window_t), intent(inout) :: window
      !> Verdict on it
      type(rattle_verdict_t), intent(out) :: verdict
      !> How the run ended; without success there is no window
      type(lane_ending_t), intent(out) :: ending

      do
         call solve_window(scene, lane, accuracy, window%samples_per_period, periods, window%periods, window%films, &
                           window%velocities, window%accelerations, ending)
         if (.not. is_success(ending%status)) return
         call classify_window(scene, window, noise_floor, verdict)
         if (verdict%lines%sampling_sufficient .or. 2*window%samples_per_period > most_samples_per_period .or. &
             2*size(window%films) > most_samples) return
         window%samples_per_period = 2*window%samples_per_period
      end do
   end subroutine solve_fine_window

   !> Class of a window, whose periods may be others than the scene asks for.
   subroutine classify_window(scene, window, noise_floor, verdict)
      !> Checked scene
      type(scene_t), intent(in) :: scene
      !> The window
      type(window_t), intent(in) :: window
      !> Amplitude that the errors of the solution explain [m/s2]
      real(dp), intent(in) :: noise_floor
      !> Verdict on it
      type(rattle_verdict_t), intent(out) :: verdict
      type(spectrum_choice_t) :: choice

      choice = scene%spectrum
      choice%periods = window%periods
      call classify(window%accelerations, choice, noise_floor, verdict)
   end subroutine classify_window

end module fine_window
