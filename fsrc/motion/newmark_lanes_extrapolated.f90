!> Newmark's method with Richardson extrapolation for many scenes at once, a scene a lane: whole motions are
!> solved again with more and more steps a period, and the samples at their end are extrapolated, until the
!> last two columns agree. A scene that agrees takes no part in the next row; no other scene has a say in
!> that, so it has the same bits in any company.
module newmark_lanes_extrapolated
   use kinds, only: dp, int64
   use lane_scenes, only: lane_scene_t
   use newmark_lanes, only: newmark_lane_ending_t, newmark_lane_request_t, newmark_lane_scene_t, &
      solve_newmark_lanes
   use richardson, only: doubt, extrapolate, most_rows, multiples
   use sample_accelerations, only: accelerations_of_samples
   use scene_status, only: status_complete, status_not_converged
   implicit none(type, external)
   private

   !> Rows of a table, tables of a scene, and how much finer each table is than the one before.
   integer, parameter :: rows = 6, tables = 5, refinement = 4
   !> A step has converged when an iterate moves the film by less than this share of the initial film.
   real(dp), parameter :: iteration_share = 1.0e-9_dp
   !> Passes in a step. More are a sign of too long a step.
   integer, parameter :: pass_limit = 20
   !> Most credit of the last column. A row runs through the whole motion, also where its steps are far too coarse, and its
   !> best value may rest for a row far from the truth: its last move counts four times, and no order is credited.
   real(dp), parameter :: most_credit = 0.25_dp

   !> How a scene ended.
   type, public :: extrapolated_ending_t
      !> Status of scene_status
      integer :: status = status_not_converged
      !> Estimate of the largest relative error of the film in the samples [-]
      real(dp) :: estimate = huge(1.0_dp)
      !> Steps of all rows
      integer(int64) :: steps = 0_int64
   end type extrapolated_ending_t

   public :: solve_lanes_extrapolated

contains

   !> Solve all scenes to an accuracy. Samples of a scene that failed mean nothing.
   subroutine solve_lanes_extrapolated(scenes, accuracy, periods, sampled_periods, samples_per_period, &
                                       films, velocities, accelerations, endings)
      !> The scenes; tolerance and limit of their iteration are not used
      type(newmark_lane_scene_t), intent(in) :: scenes(:)
      !> Accuracy of the film in the samples, relative [-]
      real(dp), intent(in) :: accuracy
      !> Periods to solve
      integer, intent(in) :: periods
      !> Periods sampled, the last ones, at least one
      integer, intent(in) :: sampled_periods
      !> Samples of a period
      integer, intent(in) :: samples_per_period
      !> Samples of h [m], z' [m/s] and z'' [m/s2]: sample, scene
      real(dp), contiguous, intent(inout) :: films(:, :)
      real(dp), contiguous, intent(inout) :: velocities(:, :)
      real(dp), contiguous, intent(inout) :: accelerations(:, :)
      !> How they ended
      type(extrapolated_ending_t), intent(out) :: endings(:)
      type(newmark_lane_scene_t), allocatable :: exact(:)
      type(newmark_lane_ending_t), allocatable :: row_endings(:)
      real(dp), allocatable :: film_tables(:, :, :), velocity_tables(:, :, :), row_films(:, :), &
                                           row_velocities(:, :), row_accelerations(:, :)
      real(dp) :: changes(size(scenes))
      logical, allocatable :: pending(:)
      integer, allocatable :: queue(:)
      integer :: table, row, steps, i

      allocate (exact, source=scenes)
      exact%method%tolerance = iteration_share*scenes%thickness
      exact%method%iteration_limit = pass_limit
      exact%method%by_newton = .true.
      exact%method%extrapolate = .true.
      allocate (film_tables(size(films, 1), most_rows, size(scenes)), &
         velocity_tables(size(films, 1), most_rows, size(scenes)))
      allocate (pending(size(scenes)))
      do table = 0, tables - 1
         pending = endings%status /= status_complete
         changes = huge(changes)
         do row = 1, rows
            queue = pack([(i, i=1, size(scenes))], pending)
            if (size(queue) == 0) exit
            steps = samples_per_period*refinement**table*multiples(row)
            allocate (row_films(size(films, 1), size(queue)), row_velocities(size(films, 1), size(queue)), &
               row_accelerations(size(films, 1), size(queue)), row_endings(size(queue)))
            call solve_newmark_lanes(exact(queue), newmark_lane_request_t(steps, periods, sampled_periods, &
                                     samples_per_period), row_films, row_velocities, row_accelerations, &
                                     row_endings)
            do i = 1, size(queue)
               associate (scene => queue(i))
                  endings(scene)%steps = endings(scene)%steps + row_endings(i)%count%steps
                  endings(scene)%status = row_endings(i)%status
                  ! The error of a motion with steps cut in two has no expansion.
                  if (row_endings(i)%count%cuts > 0 .and. endings(scene)%status == status_complete) &
                     endings(scene)%status = status_not_converged
                  pending(scene) = endings(scene)%status == status_complete
                  if (.not. pending(scene)) cycle
                  call extrapolate(row, row_films(:, i), film_tables(:, :, scene))
                  call extrapolate(row, row_velocities(:, i), velocity_tables(:, :, scene))
                  endings(scene)%status = status_not_converged
                  if (row == 1) cycle
                  call judge(row, film_tables(:, :, scene), velocity_tables(:, :, scene), scenes(scene), &
                             samples_per_period, changes(scene), endings(scene)%estimate)
                  ! The first estimate has no row before to hold it against.
                  if (row == 2 .or. .not. endings(scene)%estimate <= accuracy) cycle
                  endings(scene)%status = status_complete
                  pending(scene) = .false.
                  films(:, scene) = film_tables(:, 1, scene)
                  velocities(:, scene) = velocity_tables(:, 1, scene)
                  call accelerations_of_samples(same_scene(scenes(scene)), samples_per_period, films(:, scene), &
                                                velocities(:, scene), accelerations(:, scene))
               end associate
            end do
            deallocate (row_films, row_velocities, row_accelerations, row_endings)
         end do
      end do
   end subroutine solve_lanes_extrapolated

   !> A scene as the other engine has it, all but its start.
   pure type(lane_scene_t) function same_scene(scene)
      type(newmark_lane_scene_t), intent(in) :: scene

      same_scene%film = scene%film
      same_scene%mass = scene%method%mass
      same_scene%weight = scene%method%weight
      same_scene%steady_force = scene%method%steady_force
      same_scene%force_amplitude = scene%method%force_amplitude
      same_scene%frequency = scene%method%frequency
   end function same_scene

   !> Estimate of the relative error of the film from the last two columns. A velocity counts by the film that
   !> it moves between two samples.
   pure subroutine judge(row, film_table, velocity_table, scene, samples_per_period, change, estimate)
      !> Number of the row
      integer, intent(in) :: row
      real(dp), intent(in) :: film_table(:, :)
      real(dp), intent(in) :: velocity_table(:, :)
      type(newmark_lane_scene_t), intent(in) :: scene
      integer, intent(in) :: samples_per_period
      !> Largest difference of the last two columns: on entry that of the row before
      real(dp), intent(inout) :: change
      real(dp), intent(out) :: estimate
      real(dp) :: time, last_change

      estimate = huge(estimate)
      last_change = change
      change = huge(change)
      if (.not. all(film_table(:, 1) > 0.0_dp)) return
      time = 1.0_dp/(scene%method%frequency*real(samples_per_period, dp))
      change = maxval(max(abs(film_table(:, 1) - film_table(:, 2)), &
         time*abs(velocity_table(:, 1) - velocity_table(:, 2)))/film_table(:, 1))
      estimate = change*doubt(row, change, last_change, most_credit)
   end subroutine judge

end module newmark_lanes_extrapolated
