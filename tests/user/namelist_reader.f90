! Reads &points of a file as the runtime does, and prints each element of its lists; a dash where nothing was set.
program namelist_reader
   implicit none(type, external)
   integer, parameter :: dp = kind(1.0d0)
   real(dp), parameter :: unset = -huge(1.0_dp)
   real(dp), dimension(20) :: film_ratios, squeeze_ratios, speed_groups
   character(32) :: compute(20)
   namelist /points/ film_ratios, squeeze_ratios, speed_groups, compute
   character(512) :: path
   integer :: unit, i

   film_ratios = unset
   squeeze_ratios = unset
   speed_groups = unset
   compute = '-'
   call get_command_argument(1, path)
   open (newunit=unit, file=trim(path), status='old', action='read')
   read (unit, nml=points)
   call show('film_ratios', film_ratios)
   call show('squeeze_ratios', squeeze_ratios)
   call show('speed_groups', speed_groups)
   print '(*(a, 1x))', 'compute', (trim(compute(i)), i=1, size(compute))

contains

   subroutine show(name, numbers)
      character(*), intent(in) :: name
      real(dp), intent(in) :: numbers(:)
      character(32) :: words(size(numbers))
      integer :: i

      do i = 1, size(numbers)
         words(i) = '-'
         if (numbers(i) > unset) write (words(i), '(es32.17e3)') numbers(i)
      end do
      print '(*(a, 1x))', name, (trim(adjustl(words(i))), i=1, size(words))
   end subroutine show

end program namelist_reader
