!> Whether two motions that do not repeat are one, as far as their states at the ends of periods show: by the distance of Kolmogorov
!> and Smirnov between the distributions of their films and of their velocities.
module irregular_states
   use kinds, only: dp
   implicit none(type, external)
   private

   !> Distance that one of a hundred pairs of samples of one distribution exceeds, in units of sqrt(1/n + 1/m).
   real(dp), parameter :: rare_distance = 1.63_dp

   !> Periods after which a start that does not repeat is held against an irregular motion that is known, and by how many of the last
   !> ones.
   integer, parameter, public :: compared_after = 32, compared_periods = 24

   public :: are_of_one_motion

contains

   !> Whether states may be those of one motion.
   pure logical function are_of_one_motion(one, other)
      !> Number of a state, such as film and velocity; period
      real(dp), intent(in) :: one(:, :)
      real(dp), intent(in) :: other(:, :)
      real(dp) :: limit
      integer :: i

      limit = rare_distance*sqrt(1.0_dp/real(size(one, 2), dp) + 1.0_dp/real(size(other, 2), dp))
      are_of_one_motion = all([(largest_distance(one(i, :), other(i, :)) <= limit, i=1, size(one, 1))])
   end function are_of_one_motion

   !> Largest difference of the shares of two samples that are not above a value [-].
   pure real(dp) function largest_distance(one, other) result(distance)
      real(dp), intent(in) :: one(:)
      real(dp), intent(in) :: other(:)
      real(dp) :: values(size(one) + size(other))
      integer :: i

      values = [one, other]
      distance = maxval([(abs(real(count(one <= values(i)), dp)/real(size(one), dp) - &
                              real(count(other <= values(i)), dp)/real(size(other), dp)), i=1, size(values))])
   end function largest_distance

end module irregular_states
