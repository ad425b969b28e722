!> Random numbers one after another along a stream, and random orders.
module random_walk
   use kinds, only: dp, int64
   use random_numbers, only: random_bit_count, random_bits
   implicit none(type, external)
   private

   !> A walk along one stream; any seed gives a sequence of its own, and the streams of a seed are independent.
   type, public :: random_state_t
      integer(int64) :: seed = 0_int64
      integer(int64) :: stream = 0_int64
      !> Place of the next number
      integer(int64) :: place = 0_int64
   end type random_state_t

   public :: next_uniform, random_permutation

contains

   !> Next random number of a walk, between 0 and 1, both excluded: the middle of one of 2^52 equal parts.
   pure subroutine next_uniform(state, number)
      type(random_state_t), intent(inout) :: state
      real(dp), intent(out) :: number

      number = scale(real(random_bits(state%seed, state%stream, state%place), dp) + 0.5_dp, -random_bit_count)
      state%place = state%place + 1_int64
   end subroutine next_uniform

   !> Random order of the numbers 1 to n (Fisher and Yates).
   pure subroutine random_permutation(state, order)
      type(random_state_t), intent(inout) :: state
      !> Each of 1 to n once
      integer, intent(out) :: order(:)
      real(dp) :: number
      integer :: i, other, held

      order = [(i, i=1, size(order))]
      do i = size(order), 2, -1
         call next_uniform(state, number)
         other = 1 + int(number*real(i, dp))
         held = order(i)
         order(i) = order(other)
         order(other) = held
      end do
   end subroutine random_permutation

end module random_walk
