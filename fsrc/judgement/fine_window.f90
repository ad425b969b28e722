!> Last periods of a scene by the error-controlled engine, and the verdict on them.
module fine_window
   use controlled_engine, only: solve_window
   use engine, only: ending_t, motion_state_t
   use errors, only: error_t
   use finer_windows, only: classify_finer
   use kinds, only: dp
   use problem, only: problem_t
   use rattle_class, only: rattle_verdict_t
   use scene_status, only: is_success
   use scene_types, only: scene_t
   use text_output, only: lock_texts, unlock_texts
   use window_class, only: classify_window
   use window_record, only: window_record_t
   implicit none(type, external)
   private

   !> A window.
   type, public :: window_t
      !> Whole periods, and samples of each
      integer :: periods = 0
      integer :: samples_per_period = 0
      !> Sample, number of its state; and z'' [m/s2]
      real(dp), allocatable :: states(:, :), accelerations(:)
      !> What the steps of the engine tell of it; no periods: the samples are all that is known
      type(window_record_t) :: record = window_record_t()
      !> Samples of a period that its harmonics are found from; 0: they are integrals over the steps
      integer :: classified_by = 0
   end type window_t

   public :: solve_whole_window, judge_window

contains

   !> Solve a scene and judge its last periods. Other threads make texts while it is solved.
   subroutine solve_whole_window(scene, problem, start, accuracy, periods, noise_floor, window, verdict, ending, error, &
                                 until_steady)
      !> Checked scene
      type(scene_t), intent(in) :: scene
      !> What moves, and where the motion starts
      type(problem_t), intent(in) :: problem
      type(motion_state_t), intent(in) :: start
      !> Relative accuracy [-]
      real(dp), intent(in) :: accuracy
      !> Periods to solve, at most
      integer, intent(in) :: periods
      !> Amplitude that the errors of the solution explain [m/s2]
      real(dp), intent(in) :: noise_floor
      !> On entry periods and samples of each, on return the window
      type(window_t), intent(inout) :: window
      !> Verdict on it
      type(rattle_verdict_t), intent(out) :: verdict
      !> How the run ended; without success there is no window
      type(ending_t), intent(out) :: ending
      !> Set if there is not enough memory
      type(error_t), allocatable, intent(out) :: error
      !> Whether the motion ends where it repeats; its window is then what repeats. Absent: all periods are solved
      logical, intent(in), optional :: until_steady

      call unlock_texts()
      call solve_window(problem, start, accuracy, window%samples_per_period, periods, window%periods, window%states, &
                        window%accelerations, ending, window%record, scene%spectrum%impact_limit, until_steady)
      call lock_texts()
      if (is_success(ending%status)) window%periods = ending%samples/window%samples_per_period
      if (is_success(ending%status)) call judge_window(scene, problem, accuracy, noise_floor, window, verdict, error)
   end subroutine solve_whole_window

   !> Judge a window of the error-controlled engine: by its samples, and as a row of a campaign is where these are too few.
   subroutine judge_window(scene, problem, accuracy, noise_floor, window, verdict, error)
      !> Checked scene
      type(scene_t), intent(in) :: scene
      !> What moves
      type(problem_t), intent(in) :: problem
      !> Relative accuracy of its solution [-]
      real(dp), intent(in) :: accuracy
      !> Amplitude that the errors of the solution explain [m/s2]
      real(dp), intent(in) :: noise_floor
      !> The window with its record; what its harmonics are found from is added
      type(window_t), intent(inout) :: window
      !> Verdict on it
      type(rattle_verdict_t), intent(out) :: verdict
      !> Set if there is not enough memory
      type(error_t), allocatable, intent(out) :: error
      type(rattle_verdict_t) :: verdicts(1)
      integer :: classified_by(1)

      call classify_window(scene%spectrum, problem, window%periods, window%accelerations, window%record, noise_floor, verdict)
      window%classified_by = window%samples_per_period
      if (verdict%spectrum%sampling_sufficient) return
      verdicts(1) = verdict
      call unlock_texts()
      call classify_finer([problem], [scene%spectrum], [noise_floor], accuracy, window%samples_per_period, [window%periods], &
                          [window%record], verdicts, classified_by, .false., error)
      call lock_texts()
      verdict = verdicts(1)
      window%classified_by = classified_by(1)
   end subroutine judge_window

end module fine_window
