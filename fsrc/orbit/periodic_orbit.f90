!> The periodic motion next to a state: found by Newton's method on the period map, the shortest period first. What its Floquet
!> multipliers, the eigenvalues of the Jacobian of that map, say of its stability.
!>
!> The period map takes a state at the start of some periods of the force to the one at their end; a motion that repeats is a
!> fixed point of it.
module periodic_orbit
   use engine, only: ending_t, motion_state_t, request_t
   use kinds, only: dp
   use many_motions, only: has_tangents, solve_motions
   use carried_loads, only: counts_as, sizes_of_state, thinnest_film
   use linear_equations, only: eigenvalues, solve_linear
   use problem, only: problem_t
   use scene_status, only: status_complete
   implicit none(type, external)
   private

   !> Longest period that is looked for [periods of the force], and that of a motion which is known to settle
   integer, parameter, public :: longest_period = 8, longest_settled = 24
   !> Accuracy of the period map, and of the fixed point.
   real(dp), parameter :: map_accuracy = 1.0e-12_dp, converged = 1.0e-10_dp
   !> Accuracy of the map while a fixed point is still sought, and the correction from which on it is found. Most searches end
   !> before, since an irregular motion comes near periodic ones that are none of its own, or near none.
   real(dp), parameter :: search_accuracy = 1.0e-9_dp, found_so_far = 1.0e-5_dp
   !> Rounding over the thousands of steps of a period may disturb the map by more than that: changes below this that no longer
   !> fall to a tenth, as Newton's would, are such disturbances.
   real(dp), parameter :: largest_disturbance = 1.0e-7_dp, slowest_fall = 0.1_dp
   !> Step of the differences: their error is about its square, and map_accuracy over it.
   real(dp), parameter :: difference_step = 1.0e-4_dp
   !> How often Newton's method takes the slopes of the map
   integer, parameter :: most_slopes = 8

   integer, parameter, public :: orbit_stable = 1, orbit_doubling_near = 2, orbit_fold_near = 3, orbit_torus_near = 4, &
                         orbit_unstable = 5

   !> A multiplier beyond this is near the unit circle.
   real(dp), parameter :: near = 0.9_dp
   !> Error of the multipliers themselves.
   real(dp), parameter :: tolerance = 1.0e-6_dp

   !> A periodic motion.
   type, public :: periodic_orbit_t
      !> Period in periods of the force, 0: none was found
      integer :: period = 0
      !> Numbers of its state at the start of a period of the force
      real(dp), allocatable :: state(:)
      !> Distance of the state that the search began with, relative to the film [-]
      real(dp) :: distance = 0.0_dp
      !> Floquet multipliers of one period of the motion, as many as a state has numbers [-]
      complex(dp), allocatable :: multipliers(:)
   end type periodic_orbit_t

   public :: map_states, find_periodic_orbit, orbit_of_period, attracting_period, orbit_stability

contains

   !> Images of states under the period map; neighbours are solved together.
   subroutine map_states(problem, periods, accuracy, states, mapped, slopes)
      !> What moves
      type(problem_t), intent(in) :: problem
      !> Periods of the force
      integer, intent(in) :: periods
      !> Relative accuracy of the film [-]
      real(dp), intent(in) :: accuracy
      !> Number of a state, state; replaced by their images
      real(dp), intent(inout) :: states(:, :)
      !> Whether every state could be followed to the end
      logical, intent(out) :: mapped
      !> Of a single state whose motion has tangents, the slopes of its image: number of the image, number of the state
      real(dp), intent(out), optional :: slopes(:, :)
      type(problem_t) :: problems(size(states, 2))
      type(motion_state_t) :: starts(size(states, 2))
      type(ending_t) :: endings(size(states, 2))
      real(dp) :: none(0, 2, size(states, 2))
      real(dp), allocatable :: displacements(:, :, :)
      integer :: i

      problems = problem
      do i = 1, size(starts)
         starts(i)%numbers = states(:, i)
      end do
      if (present(slopes)) then
         allocate (displacements(size(states, 1), size(states, 1), 1), source=0.0_dp)
         do i = 1, size(states, 1)
            displacements(i, i, 1) = 1.0_dp
         end do
         call solve_motions(problems, starts, request_t(accuracy=accuracy, periods=periods), none, endings, &
                            displacements=displacements)
         slopes = displacements(:, :, 1)
      else
         call solve_motions(problems, starts, request_t(accuracy=accuracy, periods=periods), none, endings)
      end if
      mapped = all(endings%status == status_complete)
      do i = 1, size(endings)
         states(:, i) = endings(i)%numbers
      end do
   end subroutine map_states

   !> Look for a periodic motion near a state: the shortest period that is near enough is taken, a motion that attracts others before
   !> one that they leave. Where a motion has doubled its period, the one that it was is near by still.
   function find_periodic_orbit(problem, state, nearness, longest) result(orbit)
      !> What moves
      type(problem_t), intent(in) :: problem
      !> State at the start of a period of the force
      real(dp), intent(in) :: state(:)
      !> Distance at which a periodic motion is another one, relative to the film [-]
      real(dp), intent(in) :: nearness
      !> Longest period that is looked for; absent: longest_period [periods of the force]
      integer, intent(in), optional :: longest
      type(periodic_orbit_t) :: orbit
      type(periodic_orbit_t) :: other
      real(dp) :: images(size(state), 1), scale(size(state))
      integer :: period, last
      logical :: mapped

      scale = counts_as(problem, state)
      images(:, 1) = state
      last = longest_period
      if (present(longest)) last = longest
      do period = 1, last
         call map_states(problem, 1, search_accuracy, images, mapped)
         if (.not. mapped) return
         if (maxval(abs(images(:, 1) - state)*scale) > nearness*thinnest_film(problem, state)) cycle
         other = orbit_of_period(problem, period, state, nearness)
         if (other%period > 0 .and. (orbit%period == 0 .or. attracting_period(other) > 0)) orbit = other
         if (attracting_period(orbit) > 0) return
      end do
   end function find_periodic_orbit

   !> The periodic motion near a state that comes near itself after some periods, with its shortest period.
   function orbit_of_period(problem, period, state, nearness) result(orbit)
      !> What moves
      type(problem_t), intent(in) :: problem
      !> Periods of the force
      integer, intent(in) :: period
      !> State at the start of a period of the force
      real(dp), intent(in) :: state(:)
      !> Distance at which a periodic motion is another one, relative to the film [-]
      real(dp), intent(in) :: nearness
      type(periodic_orbit_t) :: orbit
      real(dp) :: scale(size(state))

      scale = counts_as(problem, state)
      orbit = newton(problem, period, state, scale, nearness)
      if (orbit%period > 0) orbit = shortest(problem, orbit, scale, nearness)
   end function orbit_of_period

   !> Periods of the force after which motions near a periodic one repeat, 0 where there is none or they leave it.
   pure integer function attracting_period(orbit) result(period)
      !> A periodic motion, or none
      type(periodic_orbit_t), intent(in) :: orbit

      period = 0
      if (orbit%period == 0) return
      if (orbit_stability(orbit%multipliers) /= orbit_unstable) period = orbit%period
   end function attracting_period

   !> Stability of a periodic motion by its multipliers.
   pure integer function orbit_stability(multipliers) result(code)
      !> Largest one first
      complex(dp), intent(in) :: multipliers(:)

      code = orbit_stable
      if (abs(multipliers(1)) > 1.0_dp + tolerance) then
         code = orbit_unstable
      else if (abs(multipliers(1)) > near) then
         if (abs(multipliers(1)%im) > 0.0_dp) then
            code = orbit_torus_near
         else if (multipliers(1)%re < 0.0_dp) then
            code = orbit_doubling_near
         else
            code = orbit_fold_near
         end if
      end if
   end function orbit_stability

   !> The same motion with its shortest period: a fixed point of the map of one period is one of every longer map, and a motion that
   !> turns about it while it settles may come near it after several periods first.
   function shortest(problem, orbit, scale, nearness)
      type(problem_t), intent(in) :: problem
      type(periodic_orbit_t), intent(in) :: orbit
      !> Film that one of each number counts as
      real(dp), intent(in) :: scale(:)
      !> Distance at which a periodic motion is another one [-]
      real(dp), intent(in) :: nearness
      type(periodic_orbit_t) :: shortest
      real(dp) :: images(size(scale), 1)
      integer :: period
      logical :: mapped

      shortest = orbit
      images(:, 1) = orbit%state
      do period = 1, orbit%period/2
         call map_states(problem, 1, map_accuracy, images, mapped)
         if (.not. mapped) return
         associate (state => orbit%state)
            if (any(abs(images(:, 1) - state) > largest_disturbance*sizes_of_state(problem, state, scale))) cycle
            shortest = newton(problem, period, state, scale, nearness)
         end associate
         shortest%distance = orbit%distance
         return
      end do
   end function shortest

   !> Fixed point of the map of some periods, and the multipliers there. The slopes of the map take many times what its value takes:
   !> steps keep those of the step before as long as the changes fall fast, and the last one takes those at its end. Where motions have
   !> tangents, slopes are these; else differences, to one side while the fixed point is sought with a coarser map, and central ones
   !> then.
   function newton(problem, period, start, scale, nearness) result(orbit)
      type(problem_t), intent(in) :: problem
      integer, intent(in) :: period
      real(dp), intent(in) :: start(:)
      !> Film that one of each number counts as
      real(dp), intent(in) :: scale(:)
      !> Distance from the start at which a fixed point is of no use [-]
      real(dp), intent(in) :: nearness
      type(periodic_orbit_t) :: orbit
      real(dp), dimension(size(start)) :: state, change, sizes
      real(dp) :: image(size(start), 1), jacobian(size(start), size(start)), matrix(size(start), size(start)), &
                  solution(size(start), 1), thickness, accuracy, moved, moved_before, distance, reach, &
                  disturbance, disturbance_before
      integer :: slopes_taken, i, n
      logical :: mapped, anew, settled, solved, near_by

      n = size(start)
      state = start
      disturbance = huge(disturbance)
      moved = huge(moved)
      anew = .true.
      near_by = .false.
      slopes_taken = 0
      do
         if (anew) slopes_taken = slopes_taken + 1
         if (slopes_taken > most_slopes) return
         sizes = sizes_of_state(problem, state, scale)
         image(:, 1) = state
         accuracy = merge(map_accuracy, search_accuracy, near_by)
         if (.not. anew) then
            call map_states(problem, period, accuracy, image, mapped)
         else if (has_tangents(problem, motion_state_t(numbers=state), accuracy)) then
            call map_states(problem, period, accuracy, image, mapped, jacobian)
         else
            call map_by_differences(problem, period, accuracy, difference_step*sizes, near_by, image, jacobian, mapped)
         end if
         if (.not. mapped) return
         if (anew) then
            ! (1 - J) change = image - state, in units of the scale
            do i = 1, n
               matrix(:, i) = -jacobian(:, i)*scale/scale(i)
               matrix(i, i) = matrix(i, i) + 1.0_dp
            end do
         end if
         solution(:, 1) = (image(:, 1) - state)*scale
         call solve_linear(matrix, solution, solved)
         if (.not. solved) return
         change = solution(:, 1)/scale
         thickness = thinnest_film(problem, state + change)
         if (anew .and. .not. thickness > 0.0_dp) return
         moved_before = moved
         moved = maxval(abs(change)*scale)/thickness
         ! A step with old slopes that does not fall fast is not taken.
         if (.not. (anew .or. (thickness > 0.0_dp .and. moved <= slowest_fall*moved_before))) then
            moved = moved_before
            anew = .true.
            cycle
         end if
         state = state + change
         disturbance_before = disturbance
         disturbance = maxval(abs(change)/sizes)
         distance = maxval(abs(state - start)*scale)/thickness
         settled = near_by .and. anew .and. (moved <= converged .or. (disturbance <= largest_disturbance .and. &
                                                        disturbance >= slowest_fall*disturbance_before))
         ! Changes that halve at least lead no farther than the last one went.
         reach = huge(reach)
         if (moved < 0.5_dp*moved_before) reach = moved
         if (settled) reach = 0.0_dp
         if (distance - reach > nearness) return
         if (.not. settled) then
            anew = near_by .and. moved <= converged
            if (.not. near_by .and. moved <= found_so_far) then
               near_by = .true.
               moved = huge(moved)
               disturbance = huge(disturbance)
            end if
            cycle
         end if
         orbit%multipliers = eigenvalues(jacobian*spread(scale, 2, n)/spread(scale, 1, n))
         ! A motion of whose stability nothing is known counts as none.
         if (size(orbit%multipliers) == 0) return
         orbit%period = period
         orbit%state = state
         orbit%distance = distance
         return
      end do
   end function newton

   !> Image of a state, and the slopes of the map there by differences; neighbours are solved together.
   subroutine map_by_differences(problem, periods, accuracy, step, central, image, slopes, mapped)
      type(problem_t), intent(in) :: problem
      !> Periods of the force
      integer, intent(in) :: periods
      !> Relative accuracy of the film [-]
      real(dp), intent(in) :: accuracy
      !> Of each number of the state
      real(dp), intent(in) :: step(:)
      !> Whether to both sides
      logical, intent(in) :: central
      !> The state, replaced by its image
      real(dp), intent(inout) :: image(:, :)
      !> Number of the image, number of the state
      real(dp), intent(out) :: slopes(:, :)
      !> Whether every state could be followed to the end
      logical, intent(out) :: mapped
      real(dp) :: states(size(step), 0:2*size(step))
      integer :: n, i

      n = size(step)
      states = spread(image(:, 1), 2, 2*n + 1)
      do i = 1, n
         states(i, i) = image(i, 1) + step(i)
         states(i, n + i) = image(i, 1) - step(i)
      end do
      call map_states(problem, periods, accuracy, states(:, 0:merge(2*n, n, central)), mapped)
      image(:, 1) = states(:, 0)
      do i = 1, n
         if (central) then
            slopes(:, i) = (states(:, i) - states(:, n + i))/(2.0_dp*step(i))
         else
            slopes(:, i) = (states(:, i) - states(:, 0))/step(i)
         end if
      end do
   end subroutine map_by_differences

end module periodic_orbit
