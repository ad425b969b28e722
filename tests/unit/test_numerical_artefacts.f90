!> Tests of what the choice of step and tolerance does to the spectrum: reversals and lines that are no part
!> of the motion, and one that is.
module test_numerical_artefacts
   use canonical_scenes, only: canonical_scene, run_window
   use checks, only: check_list_t
   use engine, only: ending_t
   use fourier, only: amplitude_spectrum
   use kinds, only: dp
   use rattle_class, only: class_irregular_so_far, classify, rattle_verdict_t
   use sample_recorder, only: sample_recorder_t
   use scene_status, only: status_complete
   use scene_types, only: iteration_newton, iteration_successive, law_iso_viscous, law_piezo_viscous, &
      predictor_extrapolated, predictor_previous, scene_t
   implicit none(type, external)
   private

   !> Amplitude that counts as no motion [m/s2].
   real(dp), parameter :: noise_floor = 1.0e-10_dp

   public :: run_numerical_artefacts_tests

contains

   !> Runs every test of this topic.
   subroutine run_numerical_artefacts_tests(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      call checks%start('numerical_artefacts')
      call test_false_reversals(checks)
      call test_false_harmonic(checks)
      call test_doubled_period(checks)
   end subroutine run_numerical_artefacts_tests

   !> Solve a scene and classify its window of 16 periods.
   subroutine judge(checks, scene, amplitudes, verdict)
      type(check_list_t), intent(inout) :: checks            !> Collects the results
      type(scene_t), intent(inout) :: scene                  !> Scene, its window is set here
      real(dp), allocatable, intent(out) :: amplitudes(:)    !> Spectrum of z'', bins of f_exc/16 [m/s2]
      type(rattle_verdict_t), intent(out) :: verdict         !> Its class

      type(sample_recorder_t) :: recorder
      type(ending_t) :: ending

      scene%spectrum%periods = 16
      call run_window(scene, recorder, ending)
      call checks%check(ending%status == status_complete, 'the motion ended well')
      call amplitude_spectrum(recorder%accelerations, amplitudes)
      call classify(recorder%accelerations, scene%spectrum, noise_floor, verdict)
   end subroutine judge

   !> The idle scene with 64 steps a period: a loose tolerance makes 18 reversals of four.
   subroutine test_false_reversals(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      real(dp), parameter :: tolerances(2) = [1.0e-7_dp, 1.0e-12_dp], reversals(2) = [18.0_dp, 4.0_dp]
      type(scene_t) :: scene
      type(rattle_verdict_t) :: verdict
      real(dp), allocatable :: amplitudes(:)
      integer :: i

      do i = 1, 2
         scene = canonical_scene(law_iso_viscous, 64)
         scene%solver%iteration = iteration_successive
         scene%solver%predictor = predictor_extrapolated
         scene%solver%tolerance = tolerances(i)
         call judge(checks, scene, amplitudes, verdict)
         call checks%check_close(verdict%reversals_per_period, reversals(i), 0.0_dp, 'reversals a period')
      end do
      scene = canonical_scene(law_iso_viscous, 4096)
      call judge(checks, scene, amplitudes, verdict)
      call checks%check_close(verdict%reversals_per_period, 4.0_dp, 0.0_dp, 'reversals a period, converged')
   end subroutine test_false_reversals

   !> A lightly loaded piezo-viscous film: with 18 and 20 steps a period and a loose tolerance a line near
   !> 2.5 f_exc stands above all, with more steps or a tight tolerance there is nothing but the harmonics.
   subroutine test_false_harmonic(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      type(rattle_verdict_t) :: verdict
      real(dp), allocatable :: amplitudes(:)
      integer :: largest, i
      type(scene_t) :: scene

      do i = 18, 20, 2
         scene = light_scene(i, 1.0e-7_dp)
         call judge(checks, scene, amplitudes, verdict)
         largest = maxloc(amplitudes(1:), dim=1)
         ! 2.3 to 2.7 f_exc. Where the line stands and how high hangs on the last bit; band and ratio do not.
         call checks%check(largest >= 37 .and. largest <= 43, 'false harmonic near 2.5 f_exc')
         call checks%check(amplitudes(largest) > 4.0_dp*amplitudes(16), 'false harmonic above that at f_exc')
         call checks%check(verdict%class == class_irregular_so_far, 'false harmonic: irregular')
      end do
      do i = 1, 4
         scene = light_scene(merge(24, 20, i == 1), merge(1.0e-7_dp, 1.0e-12_dp, i == 1))
         if (i == 3) scene = light_scene(64, 1.0e-7_dp)
         if (i == 4) scene = light_scene(1024, 1.0e-12_dp)
         call judge(checks, scene, amplitudes, verdict)
         largest = maxloc(amplitudes(1:), dim=1)
         call checks%check(largest == 16, 'no false harmonic')
         call checks%check(verdict%spectrum%irregular_fraction < 1.0e-6_dp, 'nothing but harmonics')
         ! Four digits are known, of the converged motion.
         if (i == 4) call checks%check_close(amplitudes(16), 0.4135_dp, 0.00005_dp, 'line at f_exc')
      end do
   end subroutine test_false_harmonic

   !> The lightly loaded film of the false harmonic.
   function light_scene(steps, tolerance) result(scene)
      integer, intent(in) :: steps       !> Steps a period
      real(dp), intent(in) :: tolerance  !> eps of (36) [m]
      type(scene_t) :: scene

      scene = canonical_scene(law_piezo_viscous, steps)
      scene%contact%length = 1.6e-3_dp
      scene%excitation%steady_force = 25.88_dp
      scene%excitation%force_amplitude = 5.530_dp
      scene%film%initial_film = 0.889e-6_dp
      scene%solver%iteration = iteration_successive
      scene%solver%predictor = predictor_previous
      scene%solver%tolerance = tolerance
   end function light_scene

   !> At three times the static load the same kind of film doubles its period in earnest.
   subroutine test_doubled_period(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      real(dp), parameter :: lines(5) = [18.59_dp, 54.14_dp, 24.81_dp, 16.39_dp, 18.88_dp]
      type(scene_t) :: scene
      type(rattle_verdict_t) :: verdict
      real(dp), allocatable :: amplitudes(:)
      integer :: i

      scene = canonical_scene(law_piezo_viscous, 2048)
      scene%contact%length = 1.958e-3_dp
      scene%excitation%steady_force = 38.27_dp
      scene%excitation%force_amplitude = 203.1_dp
      scene%film%initial_film = 0.889e-6_dp
      scene%solver%iteration = iteration_newton
      scene%solver%periods = 240
      call judge(checks, scene, amplitudes, verdict)
      do i = 1, 5
         ! Four digits are known; the step leaves less.
         call checks%check_close(amplitudes(8*i), lines(i), 0.01_dp, 'line of the doubled period')
      end do
      call checks%check(verdict%class == class_irregular_so_far, 'doubled period: irregular')
   end subroutine test_doubled_period

end module test_numerical_artefacts
