!> Newmark's average acceleration with Richardson extrapolation and error control, for any film.
!>
!> With the iteration of every step carried to rounding the method is the trapezoidal rule, whose error runs
!> in even powers of the step. A period is cut into intervals. Each is solved with more and more steps from
!> the same state, and film and velocity at the points that all rows have in common are extrapolated, until
!> the last two columns agree; then the extrapolated state is where the next interval starts. So the steps are
!> fine only where the motion needs it.
module newmark_extrapolated
   use film_law, only: film_kernel, film_t, overflow_load
   use forcing, only: applied_force
   use kinds, only: dp
   use newmark, only: advance_period, motion_count_t, motion_state_t, newmark_t
   use richardson, only: doubt, extrapolate, most_rows, multiples
   use scene_status, only: status_complete, status_interrupted, status_not_converged
   implicit none(type, external)
   private

   !> Intervals of a period, at least.
   integer, parameter :: least_intervals = 16
   !> Rows that a table should have, and steps of its first row, at most; in an interval at its first
   !> solution.
   integer, parameter :: few_rows = 3, many_rows = 7, largest_base = 2**16, first_base = 4
   !> A step has converged when an iterate moves the film by less than this share; the next one would by its
   !> square.
   real(dp), parameter :: iteration_share = 1.0e-11_dp
   !> Passes in a step. More are a sign of too long a step.
   integer, parameter :: pass_limit = 20
   !> Share of the accuracy that an interval may spend, by the error of the last column but one: errors of
   !> earlier intervals add until the film has damped them.
   real(dp), parameter :: interval_share = 0.1_dp
   !> Most credit of an interval's last column. The share above is a margin of its own, so only the longest rows
   !> are held to it.
   real(dp), parameter :: most_credit = 36.0_dp

   !> Intervals of a period, and what they needed last time.
   type, public :: extrapolation_t
      !> Accuracy of the film, relative [-]
      real(dp) :: accuracy = 0.0_dp
      !> Samples in an interval, intervals to a sample; one of them is 1
      integer :: samples = 1
      integer :: stride = 1
      !> Steps of the first row, interval by interval
      integer, allocatable :: bases(:)
      !> Largest estimate of the relative error of the film so far, in one interval [-]
      real(dp) :: largest_estimate = 0.0_dp
   end type extrapolation_t

   public :: new_extrapolation, advance_extrapolated, extrapolate_interval

contains

   !> Intervals for a number of samples a period.
   pure function new_extrapolation(accuracy, samples_per_period) result(extrapolation)
      !> Accuracy of the film, relative [-]
      real(dp), intent(in) :: accuracy
      !> Samples a period, equidistant
      integer, intent(in) :: samples_per_period
      type(extrapolation_t) :: extrapolation
      integer :: intervals

      extrapolation%accuracy = accuracy
      if (samples_per_period < least_intervals) then
         extrapolation%stride = (least_intervals + samples_per_period - 1)/samples_per_period
         intervals = samples_per_period*extrapolation%stride
      else
         intervals = least_intervals
         do while (mod(samples_per_period, intervals) /= 0)
            intervals = intervals + 1
         end do
         extrapolation%samples = samples_per_period/intervals
      end if
      allocate (extrapolation%bases(intervals), source=max(first_base, extrapolation%samples))
   end function new_extrapolation

   !> Advance one period of the force. On failure the state is that before the failing interval.
   subroutine advance_extrapolated(kernel, film, method, extrapolation, state, count, films, velocities, &
                                   accelerations, done, status)
      !> Kernel of the film
      procedure(film_kernel) :: kernel
      !> The film
      type(film_t), intent(in) :: film
      !> Constants of the scene; its tolerance and its choice of iteration are not used
      type(newmark_t), intent(in) :: method
      !> Accuracy and intervals; learns from period to period
      type(extrapolation_t), intent(inout) :: extrapolation
      !> State, advanced
      type(motion_state_t), intent(inout) :: state
      !> Cost, counted up
      type(motion_count_t), intent(inout) :: count
      !> Samples at phases 1/n, 2/n, ... 1, n as given to `new_extrapolation`: h [m], z' [m/s], z'' [m/s2]
      real(dp), contiguous, intent(out) :: films(:)
      real(dp), contiguous, intent(out) :: velocities(:)
      real(dp), contiguous, intent(out) :: accelerations(:)
      !> Samples that succeeded
      integer, intent(out) :: done
      !> Status of scene_status
      integer, intent(out) :: status
      type(newmark_t) :: stretch
      real(dp), dimension(extrapolation%samples) :: film_values, velocity_values
      real(dp) :: width, phase, load, load_by_film, load_by_velocity
      integer :: i, j, intervals

      done = 0
      status = status_complete
      intervals = size(extrapolation%bases)
      width = 1.0_dp/real(intervals, dp)
      stretch = method
      stretch%frequency = method%frequency*real(intervals, dp)
      stretch%by_newton = .true.
      stretch%extrapolate = .true.
      stretch%iteration_limit = pass_limit
      do i = 1, intervals
         stretch%tolerance = iteration_share*state%film
         call solve_interval(kernel, film, stretch, real(i - 1, dp)*width, width, state, extrapolation, i, &
                             count, film_values, velocity_values, status)
         if (status /= status_complete) return
         do j = 1, extrapolation%samples
            phase = (real(i - 1, dp) + real(j, dp)/real(extrapolation%samples, dp))*width
            state%film = film_values(j)
            state%velocity = velocity_values(j)
            call kernel(film, state%film, state%velocity, load, load_by_film, load_by_velocity)
            state%acceleration = (load - method%weight - &
               applied_force(method%steady_force, method%force_amplitude, phase))/method%mass
            if (mod(i, extrapolation%stride) /= 0) cycle
            done = done + 1
            films(done) = state%film
            velocities(done) = state%velocity
            accelerations(done) = state%acceleration
         end do
      end do
   end subroutine advance_extrapolated

   !> One interval with as many rows as the accuracy needs; if all rows do not do, again with a finer first
   !> one.
   subroutine solve_interval(kernel, film, stretch, phase, width, state, extrapolation, interval, count, &
                             films, velocities, status)
      procedure(film_kernel) :: kernel
      type(film_t), intent(in) :: film
      !> Constants of the scene, with the inverse of the length of the interval as frequency
      type(newmark_t), intent(in) :: stretch
      !> Phase at the start of the interval, and its length in phase [-]
      real(dp), intent(in) :: phase
      real(dp), intent(in) :: width
      !> State at its start
      type(motion_state_t), intent(in) :: state
      type(extrapolation_t), intent(inout) :: extrapolation
      !> Number of the interval
      integer, intent(in) :: interval
      type(motion_count_t), intent(inout) :: count
      !> h [m] and z' [m/s] at the samples of the interval
      real(dp), intent(out) :: films(:)
      real(dp), intent(out) :: velocities(:)
      integer, intent(out) :: status
      real(dp) :: estimate
      integer :: rows

      associate (base => extrapolation%bases(interval), samples => extrapolation%samples)
         do
            call extrapolate_interval(kernel, film, stretch, phase, width, state, base, &
                                      interval_share*extrapolation%accuracy, most_rows, rows, count, films, &
                                      velocities, estimate, status)
            if (status == status_complete) exit
            if (base > largest_base/2 .or. status == status_interrupted) return
            base = 2*base
         end do
         extrapolation%largest_estimate = max(extrapolation%largest_estimate, estimate)
         if (rows >= many_rows) base = 2*base
         if (rows <= few_rows .and. mod(base, 2*samples) == 0) base = base/2
      end associate
   end subroutine solve_interval

   !> Rows of one interval, until the last two columns agree within the tolerance. A row in which steps had to
   !> be cut is none: its error has no expansion.
   subroutine extrapolate_interval(kernel, film, stretch, phase, width, state, base, tolerance, row_limit, &
                                   rows, count, films, velocities, estimate, status)
      !> Kernel of the film
      procedure(film_kernel) :: kernel
      !> The film
      type(film_t), intent(in) :: film
      !> Constants of the scene, with the inverse of the length of the interval as frequency
      type(newmark_t), intent(in) :: stretch
      !> Phase at the start of the interval, and its length in phase [-]
      real(dp), intent(in) :: phase
      real(dp), intent(in) :: width
      !> State at its start
      type(motion_state_t), intent(in) :: state
      !> Steps of the first row, a multiple of the number of values
      integer, intent(in) :: base
      !> Relative error of the film to be reached [-]; 0: all rows, and no failure
      real(dp), intent(in) :: tolerance
      !> Most rows
      integer, intent(in) :: row_limit
      !> Rows needed
      integer, intent(out) :: rows
      !> Cost, counted up
      type(motion_count_t), intent(inout) :: count
      !> h [m] and z' [m/s] at equidistant points up to the end of the interval
      real(dp), intent(out) :: films(:)
      real(dp), intent(out) :: velocities(:)
      !> Estimate of the relative error of the film [-]
      real(dp), intent(out) :: estimate
      !> status_complete, or why no row or not enough of them came about
      integer, intent(out) :: status
      real(dp), dimension(size(films), row_limit) :: film_table, velocity_table
      real(dp), allocatable, dimension(:) :: force, row_films, row_velocities, row_accelerations
      type(motion_state_t) :: moving
      real(dp) :: change, last_change, factor
      integer :: row, steps, i, stride, done
      type(motion_count_t) :: before

      steps = base*multiples(row_limit)
      allocate (force(steps), row_films(steps), row_velocities(steps), row_accelerations(steps))
      estimate = huge(estimate)
      change = huge(change)
      do row = 1, row_limit
         steps = base*multiples(row)
         do i = 1, steps
            force(i) = applied_force(stretch%steady_force, stretch%force_amplitude, &
               phase + width*(real(i, dp)/real(steps, dp)))
         end do
         before = count
         moving = state
         call advance_period(kernel, film, stretch, force(:steps), moving, count, row_films(:steps), &
                             row_velocities(:steps), row_accelerations(:steps), done, status)
         if (count%cuts > before%cuts .and. status == status_complete) status = status_not_converged
         if (status /= status_complete) return
         stride = steps/size(films)
         call extrapolate(row, row_films(stride:steps:stride), film_table)
         call extrapolate(row, row_velocities(stride:steps:stride), velocity_table)
         rows = row
         if (row == 1) cycle
         last_change = change
         change = maxval(max(abs(film_table(:, 1) - film_table(:, 2)), &
            abs(velocity_table(:, 1) - velocity_table(:, 2))/stretch%frequency)/abs(film_table(:, 1)))
         factor = doubt(row, change, last_change, most_credit)
         estimate = factor*change
         if (estimate <= tolerance) then
            count%evaluations = count%evaluations + 1
            estimate = max(estimate, factor*carried_error(kernel, film, stretch, width, film_table(size(films), :2), &
                                                          velocity_table(size(films), :2)))
            if (estimate <= tolerance) exit
         end if
         ! The expansion has not set in: longer rows would be in vain.
         if (tolerance > 0.0_dp .and. row > few_rows .and. change > last_change) exit
      end do
      films = film_table(:, 1)
      velocities = velocity_table(:, 1)
      if (tolerance > 0.0_dp .and. .not. (estimate <= tolerance .and. all(films > 0.0_dp))) &
         status = status_not_converged
   end subroutine extrapolate_interval

   !> Relative error of the film to which the error of the velocity at the end of an interval grows afterwards:
   !> it moves the film until the film has damped it or turned it round, in free flight for a whole period.
   real(dp) function carried_error(kernel, film, stretch, width, films, velocities) result(error)
      procedure(film_kernel) :: kernel
      type(film_t), intent(in) :: film
      type(newmark_t), intent(in) :: stretch
      !> Length of the interval in phase [-]
      real(dp), intent(in) :: width
      !> h [m] and z' [m/s] there: the last column, and the one before
      real(dp), intent(in) :: films(:)
      real(dp), intent(in) :: velocities(:)
      real(dp) :: load, load_by_film, load_by_velocity, rate

      error = huge(error)
      if (.not. films(1) > 0.0_dp) return
      call kernel(film, films(1), velocities(1), load, load_by_film, load_by_velocity)
      if (.not. load < overflow_load) return
      rate = stretch%frequency*width + max(0.0_dp, -load_by_velocity)/stretch%mass + &
             sqrt(max(0.0_dp, -load_by_film)/stretch%mass)
      error = abs(velocities(1) - velocities(2))/(rate*films(1))
   end function carried_error

end module newmark_extrapolated
