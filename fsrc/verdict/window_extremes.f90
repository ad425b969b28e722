!> Smallest and largest values of a motion over its window: of the steps of the engine and what lies between their ends, or of
!> the samples where each is a step of its own (Newmark's method).
module window_extremes
   use flank_contact, only: is_elastic
   use kinds, only: dp
   use node_extremes, only: extreme_t, seen_acceleration, seen_films, seen_loads, seen_net_load, seen_position, seen_pressure, &
      seen_quantities, seen_velocity
   use carried_loads, only: contact_films, contact_loads, gear_positions, largest_pressures, net_loads
   use problem, only: contact_count, of_velocity, problem_t
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

   !> Share of the range of a quantity by which samples may miss its extremes: as much as a picture hides [-].
   real(dp), parameter :: hardly = 0.01_dp

   public :: extremes_of_record, extremes_of_samples, misses_extremes

contains

   !> Extremes that the steps of the engine show.
   pure function extremes_of_record(record) result(extremes)
      !> Record of the window
      type(window_record_t), intent(in) :: record
      type(window_extremes_t) :: extremes

      extremes%lowest = record%lowest
      extremes%highest = record%highest
   end function extremes_of_record

   !> Extremes of samples.
   pure function extremes_of_samples(problem, states, accelerations) result(extremes)
      type(problem_t), intent(in) :: problem
      !> Sample, number of its state
      real(dp), intent(in) :: states(:, :)
      !> z'' [m/s2]
      real(dp), intent(in) :: accelerations(:)
      type(window_extremes_t) :: extremes
      real(dp) :: values(block)
      integer :: first, last, contact

      do first = 1, size(states, 1), block
         last = min(first + block - 1, size(states, 1))
         associate (here => states(first:last, :), part => values(:last - first + 1))
            do contact = 1, contact_count(problem)
               call note(seen_films(contact), contact_films(problem, contact, here), extremes)
               call contact_loads(problem, contact, here, part)
               call note(seen_loads(contact), part, extremes)
            end do
            call note(seen_velocity, here(:, of_velocity), extremes)
            call note(seen_acceleration, accelerations(first:last), extremes)
            call largest_pressures(problem, here, part)
            call note(seen_pressure, part, extremes)
            if (is_elastic(problem%contact)) call note(seen_position, gear_positions(problem, here), extremes)
            if (contact_count(problem) == 1) cycle
            call net_loads(problem, here, part)
            call note(seen_net_load, part, extremes)
         end associate
      end do

   contains

      !> Take the extremes of a quantity over these samples.
      pure subroutine note(quantity, numbers, extremes)
         !> Code of node_extremes
         integer, intent(in) :: quantity
         real(dp), intent(in) :: numbers(:)
         type(window_extremes_t), intent(inout) :: extremes
         real(dp) :: smallest, largest

         call range_of(numbers, smallest, largest)
         associate (lowest => extremes%lowest(quantity), highest => extremes%highest(quantity))
            if (.not. lowest%exists .or. smallest < lowest%value) &
               call place(findloc(numbers <= smallest, .true., dim=1), smallest, lowest)
            if (.not. highest%exists .or. largest > highest%value) &
               call place(findloc(numbers >= largest, .true., dim=1), largest, highest)
         end associate
      end subroutine note

      !> An extreme at one of these samples.
      pure subroutine place(sample, value, extreme)
         integer, intent(in) :: sample
         real(dp), intent(in) :: value
         type(extreme_t), intent(inout) :: extreme

         extreme = extreme_t(value=value, exists=.true.)
         ! gfortran 12 takes the numbers behind the first for the row where it stands in the constructor.
         extreme%state = states(first + sample - 1, :)
      end subroutine place

   end function extremes_of_samples

   !> Whether a picture of samples would miss extremes of the acceleration, or of the film on its logarithmic axis.
   pure logical function misses_extremes(samples, steps)
      !> Extremes of the samples
      type(window_extremes_t), intent(in) :: samples
      !> Those of the steps between them
      type(window_extremes_t), intent(in) :: steps

      associate (film => seen_films(1), moved => seen_acceleration)
         misses_extremes = is_missed(log(samples%lowest(film)%value), log(samples%highest(film)%value), &
                                     log(steps%lowest(film)%value), log(steps%highest(film)%value)) .or. &
                           is_missed(samples%lowest(moved)%value, samples%highest(moved)%value, &
                                     steps%lowest(moved)%value, steps%highest(moved)%value)
      end associate

   contains

      !> Whether a found range leaves out more than hardly anything of the true one.
      pure logical function is_missed(found_lowest, found_highest, lowest, highest)
         real(dp), intent(in) :: found_lowest
         real(dp), intent(in) :: found_highest
         real(dp), intent(in) :: lowest
         real(dp), intent(in) :: highest

         is_missed = max(found_lowest - lowest, highest - found_highest) > hardly*(highest - lowest)
      end function is_missed

   end function misses_extremes

end module window_extremes
