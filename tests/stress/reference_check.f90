!> Holds the reference itself against motions that other programs have solved, before it judges anything.
module reference_check
   use engine, only: start_of
   use impact_reference, only: impact_reference_t, solve_reference
   use impact_steps, only: start_of_tooth, tooth_of_lane, tooth_state_t, tooth_t
   use impact_window, only: solve_periods
   use kinds, only: dp
   use lobatto_rule, only: lobatto_rule_t
   use random_scenes, only: choose_law
   use prepared_scene, only: resolve, resolved_scene_t
   use scene_types, only: scene_t
   implicit none(type, external)
   private

   !> A motion known to all digits given: law (place in law_names), entrainment speed [m/s], films [m], z'' and its first six
   !> harmonics [m/s2], of the last of 120 periods.
   type :: known_t
      integer :: law
      real(dp) :: speed
      real(dp) :: extremes(4)
      real(dp) :: harmonics(6)
      !> Whether the force has three orders: 150, 60 and 25 N with phases of 0, 0.7 and -1.2; its extremes are those of 2048
      !> samples a period
      logical :: three_orders = .false.
      !> Backlash [m], stiffness of a tooth [N/m]; their extremes are those of 2048 samples, too
      real(dp) :: backlash = 0.0_dp, stiffness = 0.0_dp
      !> Unit of the last digit of the harmonics [m/s2]
      real(dp) :: digit = 1.0e-7_dp
      !> Whether it is the loose gear of 0.45 kg between two flanks, R 7.5 mm, l 20 mm, 0.05 Pa s, 5 N with three orders of 7.9, 2
      !> and 0.8 N with phases of 0, 0.5 and 1.1 at 26.7 Hz, no gravity
      logical :: loose = .false.
   end type known_t

   !> The canonical scene of the paper's two films and of the exact ones: R 12.7 mm, l 10 mm, 0.3 Pa s, 2e-8 1/Pa, 3 kg,
   !> 199.2 N and 205.7 N at 600 Hz.
   type(known_t), parameter :: known(11) = [ &
      known_t(1, 1.905_dp, [0.341405e-6_dp, 3.570926e-6_dp, -64.348064_dp, 202.785793_dp], &
              [21.2023751_dp, 30.5365166_dp, 25.8178690_dp, 22.4385275_dp, 19.3319685_dp, 16.5060500_dp]), &
      known_t(4, 1.905_dp, [0.837089e-6_dp, 1.827841e-6_dp, -27.155588_dp, 14.733975_dp], &
              [6.3805133_dp, 8.5944899_dp, 6.5732897_dp, 4.1034383_dp, 2.4808443_dp, 1.5245533_dp]), &
      known_t(5, 0.9525_dp, [0.400824e-6_dp, 3.478332e-6_dp, -61.644347_dp, 123.573157_dp], &
              [20.8160154_dp, 28.7555678_dp, 21.6951357_dp, 17.0416711_dp, 13.3297691_dp, 10.3671095_dp]), &
      known_t(2, 1.905_dp, [0.245194e-6_dp, 4.676586e-6_dp, -82.560498_dp, 387.838543_dp], &
              [28.9175793_dp, 40.2342318_dp, 35.9704977_dp, 34.0112309_dp, 30.7059169_dp, 27.0072316_dp]), &
      known_t(5, 1.905_dp, [0.409978e-6_dp, 6.885256e-6_dp, -92.317481_dp, 370.473132_dp], &
              [42.1753420_dp, 52.7575920_dp, 44.9082791_dp, 38.5704473_dp, 32.4493844_dp, 27.3582296_dp]), &
      known_t(1, 1.905_dp, [0.4385202e-6_dp, 2.0769293e-6_dp, -40.487302_dp, 67.754164_dp], &
              [9.3167804_dp, 18.0493493_dp, 16.1777555_dp, 9.9559708_dp, 7.8172578_dp, 5.8696725_dp], three_orders=.true.), &
      known_t(5, 1.905_dp, [0.44165721e-6_dp, 17.791013e-6_dp, -137.09369_dp, 273.10504_dp], &
              [179.1303_dp, 65.92906_dp, 27.95162_dp, 8.087156_dp, 4.063589_dp, 3.244983_dp], stiffness=1.0e8_dp, &
              digit=1.0e-4_dp), &
      known_t(1, 1.905_dp, [0.25271515e-6_dp, 3.7657064e-6_dp, -115.71702_dp, 196.88632_dp], &
              [25.04402_dp, 38.72661_dp, 48.19850_dp, 46.01152_dp, 31.18127_dp, 17.62888_dp], stiffness=1.0e9_dp, &
              digit=1.0e-5_dp), &
      known_t(4, 1.905_dp, [0.76277243e-6_dp, 2.7210544e-6_dp, -63.473246_dp, 100.396692_dp], &
              [21.23886_dp, 55.53131_dp, 31.68247_dp, 1.048872_dp, 1.427171_dp, 1.322506_dp], stiffness=3.0e8_dp, &
              digit=1.0e-5_dp), &
      known_t(5, 1.07_dp, [2.0385964e-6_dp, 95.180665e-6_dp, -15.900521_dp, 36.042153_dp], &
              [1.0544934_dp, 2.0593625_dp, 1.5235086_dp, 0.8887504_dp, 1.8208022_dp, 2.0759337_dp], backlash=1.0e-4_dp, &
              loose=.true.), &
      known_t(5, 1.07_dp, [2.0209873e-6_dp, 95.342724e-6_dp, -15.810873_dp, 34.772748_dp], &
              [1.0586044_dp, 2.0625726_dp, 1.5370627_dp, 0.8834755_dp, 1.8064580_dp, 2.0901589_dp], backlash=1.0e-4_dp, &
              stiffness=5.0e7_dp, loose=.true.)]

   public :: reference_deviation

contains

   !> Largest deviation of the reference from the known motions, in units of their last digit.
   function reference_deviation(rule) result(deviation)
      type(lobatto_rule_t), intent(in) :: rule
      real(dp) :: deviation
      real(dp), parameter :: digit(4) = [1.0e-12_dp, 1.0e-12_dp, 1.0e-6_dp, 1.0e-6_dp], tolerance = 1.0e-9_dp
      real(dp) :: share
      type(scene_t) :: scene
      type(resolved_scene_t) :: resolved
      type(tooth_t) :: tooth
      type(tooth_state_t) :: state
      type(impact_reference_t) :: reference
      logical :: solved
      integer :: i

      deviation = 0.0_dp
      do i = 1, size(known)
         call choose_law(known(i)%law, scene)
         scene%contact%radius = 0.0127_dp
         scene%contact%length = 0.010_dp
         scene%contact%young_modulus = 205.66e9_dp
         scene%contact%poisson_ratio = 0.3_dp
         scene%lubricant%viscosity = 0.3_dp
         scene%lubricant%pressure_viscosity = 2.0e-8_dp
         scene%kinematics%entrainment_speed = known(i)%speed
         scene%excitation%mass = 3.0_dp
         scene%excitation%steady_force = 199.2_dp
         scene%excitation%force_amplitude = 205.7_dp
         scene%excitation%frequency = 600.0_dp
         scene%excitation%gravity = 9.80665_dp
         if (known(i)%three_orders) then
            scene%excitation%force_orders = [1, 2, 3]
            scene%excitation%force_amplitudes = [150.0_dp, 60.0_dp, 25.0_dp]
            scene%excitation%force_phases = [0.0_dp, 0.7_dp, -1.2_dp]
         end if
         if (known(i)%loose) then
            scene%contact%radius = 7.5e-3_dp
            scene%contact%length = 0.02_dp
            scene%lubricant%viscosity = 0.05_dp
            scene%excitation%mass = 0.45_dp
            scene%excitation%gravity = 0.0_dp
            scene%excitation%frequency = 26.7_dp
            scene%excitation%steady_force = 5.0_dp
            scene%excitation%force_orders = [1, 2, 3]
            scene%excitation%force_amplitudes = [7.9_dp, 2.0_dp, 0.8_dp]
            scene%excitation%force_phases = [0.0_dp, 0.5_dp, 1.1_dp]
         else if (allocated(scene%excitation%force_orders) .and. .not. known(i)%three_orders) then
            deallocate (scene%excitation%force_orders, scene%excitation%force_amplitudes, scene%excitation%force_phases)
         end if
         scene%contact%backlash = known(i)%backlash
         scene%contact%stiffness = known(i)%stiffness
         resolved = resolve(scene)
         tooth = tooth_of_lane(resolved%problem)
         state = start_of_tooth(resolved%problem, start_of(resolved%problem), 0.0_dp)
         call solve_periods(tooth, rule, tolerance, 119, state, solved)
         if (solved) call solve_reference(tooth, rule, tolerance, 1, scene%spectrum, resolved%noise_floor, 0.0_dp, state, &
                                          reference)
         if (.not. (solved .and. reference%solved)) then
            deviation = huge(1.0_dp)
            return
         end if
         share = merge(5.0e-3_dp, 1.0_dp, known(i)%three_orders)
         if (max(known(i)%backlash, known(i)%stiffness) > 0.0_dp) share = 1.0e-4_dp
         deviation = max(deviation, maxval(abs(reference%harmonics(:6) - known(i)%harmonics))/known(i)%digit, &
                         maxval(abs(reference%extremes(:4) - known(i)%extremes)/digit)*share)
      end do
   end function reference_deviation

end module reference_check
