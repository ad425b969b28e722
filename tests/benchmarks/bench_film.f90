!> Time per film of the Reynolds film kernels, one core: median of several rounds, scalar calls and arrays.
program bench_film
   use, intrinsic :: iso_fortran_env, only: int64
   use kinds, only: dp
   use reynolds_iso_viscous, only: iso_viscous_load, iso_viscous_load_array, rupture_tangent_fast
   use reynolds_piezo_viscous, only: critical_pressure_group, piezo_viscous_load, piezo_viscous_load_array
   implicit none(type, external)

   integer, parameter :: films = 4096, rounds = 21, repetitions = 40

   real(dp), dimension(films) :: a, b, value, slope_a, slope_b
   real(dp) :: times(rounds), total
   integer(int64) :: start, finish, rate
   integer :: kernel, round, repetition, i
   character(*), parameter :: names(5) = [character(30) :: 'rupture tangent, scalar', &
      'Phi and slope, scalar', 'Phi and slope, array', 'Psi and slopes, scalar', 'Psi and slopes, array']

   call random_number(a)
   call random_number(b)
   a = sinh(12.0_dp*(a - 0.5_dp))
   b = 0.999_dp*b*critical_pressure_group(a)
   total = 0.0_dp
   do kernel = 1, size(names)
      do round = 1, rounds
         call system_clock(start, rate)
         do repetition = 1, repetitions
            select case (kernel)
            case (1)
               do i = 1, films
                  value(i) = rupture_tangent_fast(a(i))
               end do
            case (2)
               do i = 1, films
                  call iso_viscous_load(a(i), value(i), slope_a(i))
               end do
            case (3)
               call iso_viscous_load_array(films, a, value, slope_a)
            case (4)
               do i = 1, films
                  call piezo_viscous_load(a(i), b(i), value(i), slope_a(i), slope_b(i))
               end do
            case default
               call piezo_viscous_load_array(films, a, b, value, slope_a, slope_b)
            end select
            ! Every repetition is read, or the compiler would leave out all but the last.
            total = total + value(1 + modulo(repetition, films))
         end do
         call system_clock(finish)
         times(round) = real(finish - start, dp)/real(rate, dp)/(real(films, dp)*repetitions)
      end do
      print '(a, f8.2, a)', names(kernel), 1.0e9_dp*median(times), ' ns'
   end do
   print '(a, es12.4)', 'sum of all answers read       ', total

contains

   !> Middle value of an odd number of times.
   pure function median(times) result(middle)
      !> Times in any order [s].
      real(dp), intent(in) :: times(:)
      real(dp) :: middle

      integer :: k

      middle = times(1)
      do k = 1, size(times)
         if (2*count(times < times(k)) < size(times) .and. 2*count(times > times(k)) < size(times)) &
            middle = times(k)
      end do

   end function median

end program bench_film
