!> 64-bit checksum of numbers or bytes, to find data that a disk has lost, torn or altered.
!>
!> The data are words w_1 ... w_n of 64 bits; bytes are filled up with zeros to whole words. The words are dealt
!> in turn to 509 lanes, the words of a lane are joined by exclusive or. Each lane is then mixed with its place,
!> and the mixed lanes are joined by exclusive or. So any one altered word is found for certain, because the mixing
!> can be undone, and 509 is a prime, so that rows and pages that change places meet other lanes:
!>
!>    x = lane_i xor i*m_0, split into its halves of 32 bits
!>    high = high xor f(low, m_1);  low = low xor f(high, m_2);  high = high xor f(low, m_3)
!>    f(v, m) = (v*m xor v*m/2^32) modulo 2^32
!>
!> The count of bytes goes in as a lane at place 0. A checksum of 0 is replaced by 1: 0 means 'none'.
!> All multipliers are below 2^31, so that no product leaves the positive 64-bit integers.
module checksum
   use kinds, only: dp, int64
   implicit none(type, external)
   private

   integer, parameter :: lane_count = 509
   integer(int64), parameter :: low_half = int(z'FFFFFFFF', int64)
   integer(int64), parameter :: m_0 = int(z'5E3779B1', int64), m_1 = int(z'7FEB352D', int64), &
                                m_2 = int(z'6C8E9CF5', int64), m_3 = int(z'58F38DED', int64)
   integer(int64), parameter :: word_bytes = 8_int64

   !> Checksum of numbers that come in pieces.
   type, public :: checksum_t
      private
      integer(int64) :: lanes(lane_count) = 0_int64
      integer(int64) :: words = 0_int64
   contains
      procedure :: add => add_numbers
      procedure :: value => checksum_value
   end type checksum_t

   !> Checksum of a table of numbers, or of a text.
   interface checksum_of
      module procedure checksum_of_table
      module procedure checksum_of_text
   end interface checksum_of

   public :: checksum_of

contains

   !> Checksum of a table of numbers, by their bits in order of storage: it distinguishes 0 from -0, and one NaN from another.
   pure integer(int64) function checksum_of_table(numbers)
      !> Any numbers, NaN and infinities included
      real(dp), contiguous, intent(in) :: numbers(:, :)
      type(checksum_t) :: sum_of_all

      call sum_of_all%add(numbers)
      checksum_of_table = sum_of_all%value()
   end function checksum_of_table

   !> Checksum of bytes.
   pure integer(int64) function checksum_of_text(text)
      !> Any bytes
      character(*), intent(in) :: text
      type(checksum_t) :: sum_of_all
      real(dp), allocatable :: words(:)

      allocate (words((len(text, int64) + word_bytes - 1_int64)/word_bytes))
      words(:) = transfer(text//repeat(achar(0), modulo(-len(text), int(word_bytes))), [0.0_dp])
      call add_words(sum_of_all, size(words, kind=int64), words)
      checksum_of_text = joined_lanes(sum_of_all, len(text, int64))
   end function checksum_of_text

   !> Take in more numbers, in the order of their storage.
   pure subroutine add_numbers(self, numbers)
      class(checksum_t), intent(inout) :: self
      !> Any numbers, NaN and infinities included
      real(dp), contiguous, intent(in) :: numbers(:, :)

      ! gfortran 12 loads the first of no numbers where it hands them on with their count.
      if (size(numbers) > 0) call add_words(self, size(numbers, kind=int64), numbers)
   end subroutine add_numbers

   !> Checksum of all numbers so far, never 0.
   pure integer(int64) function checksum_value(self)
      class(checksum_t), intent(in) :: self

      checksum_value = joined_lanes(self, word_bytes*self%words)
   end function checksum_value

   !> Deal words to the lanes.
   pure subroutine add_words(self, count, numbers)
      class(checksum_t), intent(inout) :: self
      integer(int64), intent(in) :: count
      real(dp), intent(in) :: numbers(count)
      integer(int64) :: before, run
      integer :: i, lane

      lane = int(modulo(self%words, int(lane_count, int64)))
      before = 0_int64
      do while (before < count)
         run = min(count - before, int(lane_count - lane, int64))
         do i = 1, int(run)
            self%lanes(lane + i) = ieor(self%lanes(lane + i), transfer(numbers(before + i), 0_int64))
         end do
         before = before + run
         lane = 0
      end do
      self%words = self%words + count
   end subroutine add_words

   !> The lanes and the count of bytes as one number.
   pure integer(int64) function joined_lanes(sum_of_all, bytes) result(joined)
      class(checksum_t), intent(in) :: sum_of_all
      integer(int64), intent(in) :: bytes
      integer :: i

      joined = mixed(bytes, 0_int64)
      ! Vectors of four words without an instruction that multiplies them are slower than one word at a time.
!GCC$ NOVECTOR
      do i = 1, lane_count
         joined = ieor(joined, mixed(sum_of_all%lanes(i), int(i, int64)))
      end do
      if (joined == 0_int64) joined = 1_int64
   end function joined_lanes

   !> One word mixed with its place, which must be below 2^31.
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
