!> Memory that a scene takes, as far as it follows from its input. The bytes a number were measured, the largest of each
!> kind of scene, and a tenth was added.
module memory_need
   use errors, only: error_t
   use kinds, only: dp
   use memory, only: expect_memory
   use scene_types, only: scene_t, task_film
   use text, only: integer_text
   implicit none(type, external)
   private

   !> Bytes a sample of a window: its motion and its transform, whose length may be a prime; and the tighter solution
   real(dp), parameter :: judging_bytes = 144.0_dp, verification_bytes = 36.0_dp
   !> Bytes a sample of a period beside it: the motion, the columns of the series
   real(dp), parameter :: period_bytes = 144.0_dp
   !> Bytes a node of a profile, and a cell of the numerical film
   real(dp), parameter :: node_bytes = 144.0_dp, cell_bytes = 144.0_dp

   public :: expect_scene_memory, expect_window_memory, scenes_that_fit, window_bytes

contains

   !> See that there is memory for a scene, a motion of a sweep, or a point of a film task.
   subroutine expect_scene_memory(scene, error)
      !> Checked scene
      type(scene_t), intent(in) :: scene
      !> Set if there is not enough
      type(error_t), allocatable, intent(out) :: error

      if (scene%task == task_film) then
         associate (points => scene%points)
            call expect_memory(scene_bytes(scene), &
                               'a film of '//integer_text(points%profile_nodes)//' nodes (&points profile_nodes) and '// &
                               integer_text(points%cells)//' cells (&points cells)', error)
         end associate
      else
         call expect_memory(scene_bytes(scene), &
                            'a window of '//integer_text(scene%spectrum%periods)//' periods (&spectrum periods) of '// &
                            integer_text(scene%solver%samples_per_period())// &
                            ' samples (&solver samples_per_period, steps_per_period)', error)
      end if
   end subroutine expect_scene_memory

   !> What a scene, a motion of a sweep, or a point of a film task takes [bytes].
   pure real(dp) function scene_bytes(scene) result(bytes)
      type(scene_t), intent(in) :: scene
      real(dp) :: samples

      if (scene%task == task_film) then
         bytes = node_bytes*real(scene%points%profile_nodes, dp) + &
                 cell_bytes*real(merge(scene%points%cells, 0, scene%points%numerical), dp)
      else
         samples = real(scene%solver%samples_per_period(), dp)
         bytes = samples*(period_bytes + real(scene%spectrum%periods, dp)*judging_bytes)
         if (scene%spectrum%verify) bytes = bytes + verification_bytes*samples*real(scene%spectrum%periods, dp)
      end if
   end function scene_bytes

   !> How many scenes there is memory for at a time.
   integer function scenes_that_fit(scenes, most) result(count)
      !> Checked scenes; there is memory for each of them alone
      type(scene_t), intent(in) :: scenes(:)
      !> More are not asked for
      integer, intent(in) :: most
      type(error_t), allocatable :: error
      real(dp) :: largest
      integer :: i

      largest = maxval([(scene_bytes(scenes(i)), i=1, size(scenes))])
      do count = min(most, size(scenes)), 2, -1
         call expect_memory(real(count, dp)*largest, 'scenes side by side', error)
         if (.not. allocated(error)) return
      end do
   end function scenes_that_fit

   !> See that there is memory for a window that is solved again with more samples than were asked for.
   subroutine expect_window_memory(samples, error)
      !> Samples of the window
      integer, intent(in) :: samples
      !> Set if there is not enough
      type(error_t), allocatable, intent(out) :: error

      call expect_memory(window_bytes(real(samples, dp)), 'a window of '//integer_text(samples)// &
                         ' samples, which impacts as short as these ask for (&spectrum periods makes it shorter),', error)
   end subroutine expect_window_memory

   !> What it takes to solve and judge a window [bytes].
   pure real(dp) function window_bytes(samples)
      !> Samples of the window
      real(dp), intent(in) :: samples

      window_bytes = judging_bytes*samples
   end function window_bytes

end module memory_need
