!> The canonical scenes, a loose gear between two flanks, and a run of any scene that leaves its window.
module canonical_scenes
   use constants, only: standard_gravity
   use engine, only: checkpoint_t, ending_t, motion_watcher_t, request_t
   use errors, only: error_t
   use kinds, only: dp
   use newmark_engine, only: solve_newmark
   use problem, only: problem_of
   use prepared_scene, only: request_of
   use sample_recorder, only: sample_recorder_t
   use scene_types, only: law_elastohydrodynamic, law_iso_viscous, model_closure, model_reynolds, scene_t
   use window_record, only: window_record_t
   implicit none(type, external)
   private

   !> Watcher that only counts.
   type, extends(motion_watcher_t), public :: counting_watcher_t
      !> Periods it was reported of, and what it was reported last
      integer :: reported = 0, done = 0, all = 0
   contains
      procedure :: period_done
   end type counting_watcher_t

   !> Static load Q + m g [N], and the published iso-viscous film that carries it [m].
   real(dp), parameter, public :: static_load = 199.2_dp + 3.0_dp*9.80665_dp
   real(dp), parameter, public :: idle_steady_film = 8.889224234368e-7_dp

   public :: canonical_scene, canonical_method, loose_gear, scene_g, run_window

contains

   !> Canonical load and contact, Newton iteration to rounding.
   function canonical_scene(law, steps_per_period) result(scene)
      !> Film law
      integer, intent(in) :: law
      !> Steps per period
      integer, intent(in) :: steps_per_period
      type(scene_t) :: scene

      scene%contact%radius = 0.0127_dp
      scene%contact%length = 0.010_dp
      scene%contact%young_modulus = 205.66e9_dp
      scene%contact%poisson_ratio = 0.3_dp
      scene%lubricant%viscosity = 0.3_dp
      scene%lubricant%pressure_viscosity = 2.0e-8_dp
      scene%kinematics%entrainment_speed = 1.905_dp
      scene%excitation%mass = 3.0_dp
      scene%excitation%steady_force = 199.2_dp
      scene%excitation%force_amplitude = 205.7_dp
      scene%excitation%frequency = 600.0_dp
      scene%excitation%gravity = standard_gravity
      scene%film%law = law
      scene%solver%tolerance = 1.0e-14_dp
      scene%solver%iteration_limit = 100
      scene%solver%steps_per_period = steps_per_period
      scene%solver%periods = 120
      scene%spectrum%periods = 1
      scene%output%series = .false.
   end function canonical_scene

   !> A loose gear: case R1 of a Reynolds film, R4 of a published one.
   type(scene_t) function loose_gear() result(scene)
      scene%contact%radius = 7.5e-3_dp
      scene%contact%length = 0.02_dp
      scene%contact%young_modulus = 205.66e9_dp
      scene%contact%poisson_ratio = 0.3_dp
      scene%contact%backlash = 1.0e-4_dp
      scene%lubricant%viscosity = 0.05_dp
      scene%lubricant%pressure_viscosity = 2.0e-8_dp
      scene%kinematics%entrainment_speed = 1.07_dp
      scene%excitation%mass = 0.45_dp
      scene%excitation%frequency = 26.7_dp
      scene%excitation%steady_force = 5.0_dp
      ! Allocated by name: gfortran 12 takes what an assignment would find for uninitialised.
      allocate (scene%excitation%force_orders, source=[1, 2, 3])
      allocate (scene%excitation%force_amplitudes, source=[7.9_dp, 2.0_dp, 0.8_dp])
      allocate (scene%excitation%force_phases, source=[0.0_dp, 0.5_dp, 1.1_dp])
      scene%film%law = law_iso_viscous
      scene%film%model = model_reynolds
   end function loose_gear

   !> Scene G, a loose gear, with a plane contact beside the stiffness of its teeth, by the closure.
   type(scene_t) function scene_g(viscosity_law) result(scene)
      !> Code of scene_types
      integer, intent(in) :: viscosity_law

      scene%contact%radius = 9.1269e-3_dp
      scene%contact%length = 0.018943_dp
      scene%contact%young_modulus = 205.66e9_dp
      scene%contact%poisson_ratio = 0.3_dp
      scene%contact%backlash = 110.0e-6_dp
      scene%contact%stiffness = 2.38e8_dp
      scene%contact%flattening_included = .false.
      scene%lubricant%viscosity = 0.0214299_dp
      scene%lubricant%pressure_viscosity = 1.57335e-8_dp
      scene%lubricant%viscosity_law = viscosity_law
      scene%kinematics%entrainment_speed = 0.5_dp*2.83747_dp
      scene%excitation%mass = 0.620931_dp
      scene%excitation%steady_force = 2.04527_dp
      scene%excitation%frequency = 30.0_dp
      allocate (scene%excitation%force_orders, source=[1, 2])
      allocate (scene%excitation%force_amplitudes, source=[9.15706_dp, 2.44188_dp])
      allocate (scene%excitation%force_phases, source=[0.0_dp, 0.0_dp])
      scene%film%law = law_elastohydrodynamic
      scene%film%model = model_closure
   end function scene_g

   !> Newmark's iteration for the canonical scenes.
   function canonical_method() result(method)
      type(request_t) :: method

      method%tolerance = 1.0e-14_dp
      method%iteration_limit = 100
   end function canonical_method

   !> Solve a scene; the recorder then holds its window.
   subroutine run_window(scene, recorder, ending, watcher)
      !> Checked scene without a series
      type(scene_t), intent(in) :: scene
      !> Holds the window
      type(sample_recorder_t), intent(out) :: recorder
      !> How it ended
      type(ending_t), intent(out) :: ending
      !> Reported of progress
      type(counting_watcher_t), intent(inout), optional :: watcher

      type(counting_watcher_t) :: unwatched
      type(checkpoint_t) :: checkpoint
      type(window_record_t) :: record
      type(error_t), allocatable :: error

      call recorder%open(scene, problem_of(scene), '', 0, error)
      if (present(watcher)) then
         call solve_newmark(problem_of(scene), request_of(scene), recorder, watcher, checkpoint, ending, record, error)
      else
         call solve_newmark(problem_of(scene), request_of(scene), recorder, unwatched, checkpoint, ending, record, error)
      end if
   end subroutine run_window

   !> Count the periods.
   subroutine period_done(self, done, all)
      class(counting_watcher_t), intent(inout) :: self
      integer, intent(in) :: done
      integer, intent(in) :: all

      self%reported = self%reported + 1
      self%done = done
      self%all = all
   end subroutine period_done

end module canonical_scenes
