!> Random numbers that depend on seed, stream and place alone: Philox 4x32 with ten rounds, see Salmon,
!> Moraes, Dror and Shaw, "Parallel random numbers: as easy as 1, 2, 3", SC11 (2011). Any number can be had
!> without those before it, and every machine gives the same. Words of 32 bits are held in longer integers,
!> and no product leaves the positive 64-bit integers.
module random_numbers
   use kinds, only: int64
   implicit none(type, external)
   private

   integer(int64), parameter :: low_half = int(z'FFFFFFFF', int64), low_quarter = int(z'FFFF', int64)
   integer, parameter :: rounds = 10
   integer(int64), parameter :: multiplier_1 = int(z'D2511F53', int64), multiplier_2 = int(z'CD9E8D57', int64)
   integer(int64), parameter :: key_step_1 = int(z'9E3779B9', int64), key_step_2 = int(z'BB67AE85', int64)
   !> Bits of the integers that become reals
   integer, parameter, public :: random_bit_count = 52

   public :: philox_words, random_bits

contains

   !> Four random words of 32 bits.
   pure function philox_words(counter, key) result(words)
      !> Place, four words of 32 bits
      integer(int64), intent(in) :: counter(4)
      !> Seed, two words of 32 bits
      integer(int64), intent(in) :: key(2)
      integer(int64) :: words(4)
      integer(int64) :: round_key(2), high_1, low_1, high_2, low_2
      integer :: i

      words = counter
      round_key = key
      do i = 1, rounds
         call multiply(words(1), multiplier_1, high_1, low_1)
         call multiply(words(3), multiplier_2, high_2, low_2)
         words = [ieor(ieor(high_2, words(2)), round_key(1)), low_2, &
                  ieor(ieor(high_1, words(4)), round_key(2)), low_1]
         round_key(1) = iand(round_key(1) + key_step_1, low_half)
         round_key(2) = iand(round_key(2) + key_step_2, low_half)
      end do
   end function philox_words

   !> Product of two words of 32 bits as two words. One factor goes in by halves.
   pure subroutine multiply(left, right, high, low)
      integer(int64), intent(in) :: left
      integer(int64), intent(in) :: right
      integer(int64), intent(out) :: high
      integer(int64), intent(out) :: low
      integer(int64) :: lower, upper

      lower = left*iand(right, low_quarter)
      upper = left*shiftr(right, 16) + shiftr(lower, 16)
      high = shiftr(upper, 16)
      low = ior(shiftl(iand(upper, low_quarter), 16), iand(lower, low_quarter))
   end subroutine multiply

   !> Random integer from 0 to 2^52 - 1.
   pure integer(int64) function random_bits(seed, stream, place)
      !> Any number
      integer(int64), intent(in) :: seed
      !> Any number
      integer(int64), intent(in) :: stream
      !> Any number
      integer(int64), intent(in) :: place
      integer(int64) :: words(4), counter(4), key(2)

      counter = [iand(place, low_half), shiftr(place, 32), iand(stream, low_half), shiftr(stream, 32)]
      key = [iand(seed, low_half), shiftr(seed, 32)]
      words = philox_words(counter, key)
      random_bits = ior(shiftl(words(1), random_bit_count - 32), shiftr(words(2), 64 - random_bit_count))
   end function random_bits

end module random_numbers
