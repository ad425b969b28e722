!> Accelerations of the samples of a motion, of which film and velocity are known.
module sample_accelerations
   use film_law, only: film_loads
   use forcing, only: force_of_period
   use kinds, only: dp
   use lane_scenes, only: lane_scene_t
   implicit none(type, external)
   private

   public :: accelerations_of_samples

contains

   !> z'' of samples [m/s2] from the equation of motion (1).
   pure subroutine accelerations_of_samples(scene, samples_per_period, films, velocities, accelerations)
      !> The scene
      type(lane_scene_t), intent(in) :: scene
      !> Samples of a period
      integer, intent(in) :: samples_per_period
      !> h [m], from the first sample of a period on
      real(dp), intent(in) :: films(:)
      !> z' [m/s]
      real(dp), intent(in) :: velocities(:)
      !> z'' [m/s2]
      real(dp), intent(out) :: accelerations(:)
      real(dp) :: force(samples_per_period)
      integer :: before, count

      call force_of_period(scene%steady_force, scene%force_amplitude, force)
      call film_loads(scene%film, films, velocities, accelerations)
      do before = 0, size(films) - 1, samples_per_period
         count = min(samples_per_period, size(films) - before)
         accelerations(before + 1:before + count) = (accelerations(before + 1:before + count) - scene%weight - force(:count)) &
                                                    /scene%mass
      end do
   end subroutine accelerations_of_samples

end module sample_accelerations
