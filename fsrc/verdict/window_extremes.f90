!> Smallest and largest values of a motion over its window: of the steps of the engine and what lies between their ends, or of
!> the samples where each is a step of its own (Newmark's method).
module window_extremes
   use kinds, only: dp
   use node_extremes, only: extreme_t, seen_acceleration, seen_coast_load, seen_film, seen_load, seen_net_load, &
      seen_pressure, seen_quantities, seen_velocity
   use problem, only: coast_loads, drive_loads, has_two_flanks, largest_pressures, net_loads, problem_t
   use value_range, only: range_of
   use window_record, only: window_record_t
   implicit none(type, external)
   private

   !> Samples that are looked at together: their arrays stay in the cache.
   integer, parameter :: block = 512

   !> Extremes of a window, by the codes of node_extremes.
   type, public :: window_extremes_t
      type(extreme_t) :: lowest(seen_quantities), highest(seen_quantities)
   end type window_extremes_t

   public :: extremes_of_record, extremes_of_samples

contains

   !> Extremes that the steps of the engine tell.
   pure function extremes_of_record(record) result(extremes)
      !> Record of the window
      type(window_record_t), intent(in) :: record
      type(window_extremes_t) :: extremes

      extremes%lowest = record%lowest
      extremes%highest = record%highest
   end function extremes_of_record

   !> Extremes of samples.
   pure function extremes_of_samples(problem, films, velocities, accelerations) result(extremes)
      type(problem_t), intent(in) :: problem
      !> h [m], z' [m/s], z'' [m/s2]
      real(dp), intent(in) :: films(:)
      real(dp), intent(in) :: velocities(:)
      real(dp), intent(in) :: accelerations(:)
      type(window_extremes_t) :: extremes
      real(dp) :: values(block)
      integer :: first, last

      do first = 1, size(films), block
         last = min(first + block - 1, size(films))
         associate (h => films(first:last), w => velocities(first:last), part => values(:last - first + 1))
            call note(h, w, h, extremes%lowest(seen_film), extremes%highest(seen_film))
            call note(h, w, w, extremes%lowest(seen_velocity), extremes%highest(seen_velocity))
            call note(h, w, accelerations(first:last), extremes%lowest(seen_acceleration), extremes%highest(seen_acceleration))
            call drive_loads(problem, h, w, part)
            call note(h, w, part, extremes%lowest(seen_load), extremes%highest(seen_load))
            call largest_pressures(problem, h, w, part)
            call note(h, w, part, extremes%lowest(seen_pressure), extremes%highest(seen_pressure))
            if (.not. has_two_flanks(problem)) cycle
            call coast_loads(problem, h, w, part)
            call note(h, w, part, extremes%lowest(seen_coast_load), extremes%highest(seen_coast_load))
            call net_loads(problem, h, w, part)
            call note(h, w, part, extremes%lowest(seen_net_load), extremes%highest(seen_net_load))
         end associate
      end do
   end function extremes_of_samples

   !> Take the extremes of a quantity over some samples.
   pure subroutine note(films, velocities, numbers, lowest, highest)
      real(dp), intent(in) :: films(:)
      real(dp), intent(in) :: velocities(:)
      !> The quantity
      real(dp), intent(in) :: numbers(:)
      type(extreme_t), intent(inout) :: lowest
      type(extreme_t), intent(inout) :: highest
      real(dp) :: smallest, largest
      integer :: i

      call range_of(numbers, smallest, largest)
      if (.not. lowest%exists .or. smallest < lowest%value) then
         i = findloc(numbers <= smallest, .true., dim=1)
         lowest = extreme_t(value=smallest, film=films(i), velocity=velocities(i), exists=.true.)
      end if
      if (.not. highest%exists .or. largest > highest%value) then
         i = findloc(numbers >= largest, .true., dim=1)
         highest = extreme_t(value=largest, film=films(i), velocity=velocities(i), exists=.true.)
      end if
   end subroutine note

end module window_extremes
