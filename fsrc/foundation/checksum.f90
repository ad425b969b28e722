!> 64-bit checksum of numbers or bytes, to find data that a disk has lost, torn or altered.
!>
!> The data are words w_1 ... w_n of 64 bits; bytes are filled up with zeros to whole words. Each word is
!> mixed with its place, the mixed words are joined by exclusive or. So the order of evaluation is free,
!> and any one altered word is found for certain, because the mixing can be undone:
!>
!>    x = w_i xor i*m_0, split into its halves of 32 bits
!>    high = high xor f(low, m_1);  low = low xor f(high, m_2);  high = high xor f(low, m_3)
!>    f(v, m) = (v*m xor v*m/2^32) modulo 2^32
!>
!> The count of bytes goes in as a word at place 0. A checksum of 0 is replaced by 1: 0 means 'none'.
!> All multipliers are below 2^31, so that no product leaves the positive 64-bit integers.
module checksum
   use, intrinsic :: iso_c_binding, only: c_char
   use kinds, only: dp, int64
   implicit none(type, external)
   private

   integer(int64), parameter :: low_half = int(z'FFFFFFFF', int64)
   integer(int64), parameter :: m_0 = int(z'5E3779B1', int64), m_1 = int(z'7FEB352D', int64), &
                                m_2 = int(z'6C8E9CF5', int64), m_3 = int(z'58F38DED', int64)
   integer(int64), parameter :: word_bytes = 8_int64

   !> Checksum of reals of rank 1 or 2, or of a text.
   interface checksum_of
      module procedure checksum_of_list
      module procedure checksum_of_table
      module procedure checksum_of_text
   end interface checksum_of

   public :: checksum_of

contains

   !> Checksum of a list of numbers, by their bits: it tells 0 from -0, and one NaN from another.
   pure integer(int64) function checksum_of_list(numbers)
      !> Any numbers, NaN and infinities included
      real(dp), contiguous, intent(in) :: numbers(:)

      checksum_of_list = checksum_of_reals(size(numbers, kind=int64), numbers)
   end function checksum_of_list

   !> Checksum of a table of numbers, in the order of its storage.
   pure integer(int64) function checksum_of_table(numbers)
      !> Any numbers, NaN and infinities included
      real(dp), contiguous, intent(in) :: numbers(:, :)

      checksum_of_table = checksum_of_reals(size(numbers, kind=int64), numbers)
   end function checksum_of_table

   !> Checksum of bytes.
   pure integer(int64) function checksum_of_text(text)
      !> Any bytes
      character(*), intent(in) :: text
      character(word_bytes, kind=c_char) :: bytes
      integer(int64) :: joined, place, first

      joined = mixed(len(text, int64), 0_int64)
      do place = 1_int64, (len(text, int64) + word_bytes - 1_int64)/word_bytes
         first = (place - 1_int64)*word_bytes + 1_int64
         bytes = repeat(achar(0), word_bytes)
         bytes(:min(word_bytes, len(text, int64) - first + 1_int64)) = &
            text(first:min(len(text, int64), first + word_bytes - 1_int64))
         joined = ieor(joined, mixed(transfer(bytes, 0_int64), place))
      end do
      checksum_of_text = not_zero(joined)
   end function checksum_of_text

   pure integer(int64) function checksum_of_reals(count, numbers)
      integer(int64), intent(in) :: count
      real(dp), intent(in) :: numbers(count)
      integer(int64) :: joined, place

      joined = mixed(word_bytes*count, 0_int64)
      ! Vectors of four words without an instruction that multiplies them are slower than one word at a time.
!GCC$ NOVECTOR
      do place = 1_int64, count
         joined = ieor(joined, mixed(transfer(numbers(place), 0_int64), place))
      end do
      checksum_of_reals = not_zero(joined)
   end function checksum_of_reals

   pure integer(int64) function not_zero(joined)
      integer(int64), intent(in) :: joined

      not_zero = merge(1_int64, joined, joined == 0_int64)
   end function not_zero

   !> One word mixed with its place, which must be below 2^31 (16 GB of data).
   elemental integer(int64) function mixed(word, place)
      integer(int64), intent(in) :: word
      integer(int64), intent(in) :: place
      integer(int64) :: keyed, high, low

      keyed = ieor(word, place*m_0)
      low = iand(keyed, low_half)
      high = shiftr(keyed, 32)
      high = ieor(high, folded(low*m_1))
      low = ieor(low, folded(high*m_2))
      high = ieor(high, folded(low*m_3))
      mixed = ior(shiftl(high, 32), low)
   end function mixed

   !> Both halves of a product joined into 32 bits.
   elemental integer(int64) function folded(product)
      integer(int64), intent(in) :: product

      folded = iand(ieor(product, shiftr(product, 32)), low_half)
   end function folded

end module checksum
