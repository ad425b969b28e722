!> Whether the class of a scene of a campaign stands: the certificate of the single scene.
module campaign_certificate
   use certificate, only: certificate_t
   use certify_scene, only: certify
   use engine, only: ending_t, request_t, start_of
   use errors, only: error_t
   use fine_window, only: judge_window, window_t
   use kinds, only: dp
   use loudness, only: loudness_of_record
   use many_motions, only: solve_motions
   use problem, only: accelerations_of_samples, state_size
   use rattle_class, only: note_orbit, rattle_verdict_t
   use resolved_scene, only: resolved_scene_t
   use scene_status, only: is_success
   use scene_types, only: scene_t
   use window_extremes, only: extremes_of_record
   use window_record, only: window_record_t
   implicit none(type, external)
   private

   public :: test_class

contains

   !> The certificate holds the motion that follows from its start against the same periods solved tighter. So the periods
   !> that a forecast has saved in the campaign are solved here.
   subroutine test_class(scene, resolved, request, verdict, certificate, error)
      !> The scene with its varied keys set
      type(scene_t), intent(in) :: scene
      !> What follows from it
      type(resolved_scene_t), intent(in) :: resolved
      !> What the campaign asked of the engine
      type(request_t), intent(in) :: request
      !> Verdict to be tested
      type(rattle_verdict_t), intent(in) :: verdict
      !> Its certificate
      type(certificate_t), intent(out) :: certificate
      !> Set if there is not enough memory
      type(error_t), allocatable, intent(out) :: error
      type(request_t) :: from_start
      type(ending_t) :: endings(1)
      type(window_record_t) :: records(1)
      type(rattle_verdict_t) :: own_verdict
      type(window_t) :: window
      real(dp), allocatable :: states(:, :, :)
      integer :: samples

      certificate%exists = .true.
      from_start = request
      from_start%forecast = .false.
      samples = request%sampled_periods*scene%campaign%samples_per_period
      from_start%samples_per_period = scene%campaign%samples_per_period
      allocate (states(samples, state_size(resolved%problem), 1))
      call solve_motions([resolved%problem], [start_of(resolved%problem)], from_start, states, endings, &
                         records=records)
      if (.not. is_success(endings(1)%status)) return
      samples = endings(1)%samples
      window%periods = samples/request%samples_per_period
      window%samples_per_period = request%samples_per_period
      allocate (window%states, source=states(:samples, :, 1))
      allocate (window%accelerations(samples))
      call accelerations_of_samples(resolved%problem, request%samples_per_period, window%states, &
                                    window%accelerations)
      window%record = records(1)
      call judge_window(scene, resolved%problem, request%accuracy, resolved%noise_floor, window, own_verdict, error)
      if (allocated(error)) return
      call note_orbit(own_verdict, endings(1)%orbit)
      if (own_verdict%class /= verdict%class) return
      call certify(scene, resolved, endings(1)%periods, window, extremes_of_record(records(1)), &
                   loudness_of_record(records(1), resolved%problem%frequency), own_verdict, certificate, error)
      ! An irregular class does not stand where the certificate has found that the motion repeats.
      certificate%certified = certificate%certified .and. own_verdict%class == verdict%class
   end subroutine test_class

end module campaign_certificate
