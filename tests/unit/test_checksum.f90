!> Tests of the checksum: its definition written out anew, and what it must find.
module test_checksum
   use, intrinsic :: ieee_arithmetic, only: ieee_quiet_nan, ieee_value
   use checks, only: check_list_t
   use checksum, only: checksum_of, checksum_t
   use kinds, only: dp, int64
   use random_numbers, only: random_bits
   use text, only: integer_text
   implicit none(type, external)
   private

   public :: run_checksum_tests

contains

   !> Runs every test of this topic.
   subroutine run_checksum_tests(checks)
      !> Collects the results
      type(check_list_t), intent(inout) :: checks

      call checks%start('checksum')
      call test_definition(checks)
      call test_forms(checks)
      call test_flips(checks)
      call test_structure(checks)
   end subroutine run_checksum_tests

   !> The definition in wider integers, and a value from another program.
   subroutine test_definition(checks)
      type(check_list_t), intent(inout) :: checks
      real(dp), parameter :: numbers(5) = [1.0_dp, -2.5_dp, 0.0_dp, 1.0e300_dp, -0.0_dp]
      real(dp) :: many(2000)
      type(checksum_t) :: pieces
      integer :: n, first

      do n = 1, size(numbers)
         call checks%check(sum_of_list(numbers(:n)) == defined(numbers(:n)), 'definition, '// &
                           integer_text(n)//' numbers')
      end do
      many = [(sqrt(real(n, dp)), n=1, size(many))]
      do n = 500, size(many), 250
         call checks%check(sum_of_list(many(:n)) == defined(many(:n)), 'definition, '//integer_text(n)//' numbers')
      end do
      first = 1
      do n = 1, 7
         call pieces%add(reshape(many(first:first + 40*n - 1), [4, 10*n]))
         first = first + 40*n
      end do
      call checks%check(pieces%value() == sum_of_list(many(:first - 1)), 'in pieces')
      call checks%check(sum_of_list(numbers) == int(z'67A4758817EF34BD', int64), 'a fixed value')
      call checks%check(sum_of_list(numbers(:0)) /= 0_int64, 'no data: not 0')
   end subroutine test_definition

   !> A list as a table of one row.
   pure integer(int64) function sum_of_list(numbers)
      real(dp), intent(in) :: numbers(:)

      sum_of_list = checksum_of(reshape(numbers, [1, size(numbers)]))
   end function sum_of_list

   !> Lane by lane, each from the words that belong to it.
   pure integer(int64) function defined(numbers)
      real(dp), intent(in) :: numbers(:)
      integer, parameter :: lane_count = 509
      integer(int64) :: lane
      integer :: i, j

      defined = word(8_int64*size(numbers), 0)
      do i = 1, lane_count
         lane = 0_int64
         do j = i, size(numbers), lane_count
            lane = ieor(lane, transfer(numbers(j), 0_int64))
         end do
         defined = ieor(defined, word(lane, i))
      end do

   contains

      pure integer(int64) function word(bits, place)
         integer(int64), intent(in) :: bits
         integer, intent(in) :: place
         integer, parameter :: wide = selected_int_kind(38)
         integer(wide), parameter :: two_32 = 4294967296_wide
         integer(wide), parameter :: multipliers(3) = [int(z'7FEB352D', wide), int(z'6C8E9CF5', wide), &
                                                       int(z'58F38DED', wide)]
         integer(wide) :: halves(2), product
         integer(int64) :: keyed
         integer :: k

         keyed = ieor(bits, int(place, int64)*int(z'5E3779B1', int64))
         halves = [int(ibits(keyed, 32, 32), wide), int(ibits(keyed, 0, 32), wide)]
         do k = 1, 3
            product = halves(1 + modulo(k, 2))*multipliers(k)
            halves(2 - modulo(k, 2)) = ieor(halves(2 - modulo(k, 2)), modulo(ieor(product, product/two_32), &
                                                            two_32))
         end do
         word = ior(shiftl(int(halves(1), int64), 32), int(halves(2), int64))
      end function word

   end function defined

   !> List, table and bytes of the same words agree; bytes are reported from the zeros that fill them up.
   subroutine test_forms(checks)
      type(check_list_t), intent(inout) :: checks
      real(dp) :: table(3, 4), nothing(1)
      character(96) :: bytes
      integer :: i

      table = reshape([(1.0_dp/real(i, dp), i=1, 12)], [3, 4])
      bytes = transfer(table, bytes)
      call checks%check(checksum_of(table) == sum_of_list(reshape(table, [12])), 'table as list')
      call checks%check(checksum_of(table) == checksum_of(bytes), 'table as bytes')
      call checks%check(checksum_of('abc') /= checksum_of('abc'//achar(0)), 'a zero more')
      call checks%check(checksum_of('') /= checksum_of(achar(0)), 'nothing and a zero')
      nothing = 0.0_dp
      call checks%check(sum_of_list(nothing) /= sum_of_list(-nothing), 'sign of zero')
      table(2, 2) = ieee_value(1.0_dp, ieee_quiet_nan)
      call checks%check(checksum_of(table) == checksum_of(table), 'NaN has a checksum')
   end subroutine test_forms

   !> One flipped bit changes about half of the bits; two flipped bits never undo each other.
   subroutine test_flips(checks)
      type(check_list_t), intent(inout) :: checks
      integer, parameter :: trials = 4000
      real(dp) :: numbers(64)
      integer(int64) :: words(64), whole, one, changed
      integer :: i, bit, first, second, unseen

      words = [(transfer(1.0_dp/real(i, dp), 0_int64), i=1, 64)]
      numbers = transfer(words, numbers)
      whole = sum_of_list(numbers)
      changed = 0_int64
      do bit = 0, 63
         one = sum_of_list(flipped(words, 17, bit))
         call checks%check(one /= whole, 'flipped bit '//integer_text(bit))
         changed = changed + popcnt(ieor(one, whole))
      end do
      call checks%check(changed > 64*24 .and. changed < 64*40, 'half of the bits change')
      unseen = 0
      do i = 1, trials
         bit = int(modulo(random_bits(1_int64, 1_int64, int(i, int64)), 64_int64))
         first = 1 + int(modulo(random_bits(1_int64, 2_int64, int(i, int64)), 32_int64))
         second = 33 + int(modulo(random_bits(1_int64, 3_int64, int(i, int64)), 32_int64))
         if (sum_of_list(flipped(transfer(flipped(words, first, bit), words), second, &
                                 bit)) == whole) unseen = unseen + 1
      end do
      call checks%check(unseen == 0, 'two flips of the same bit')
   end subroutine test_flips

   pure function flipped(words, place, bit) result(numbers)
      integer(int64), intent(in) :: words(:)
      integer, intent(in) :: place
      integer, intent(in) :: bit
      real(dp) :: numbers(size(words))
      integer(int64) :: changed(size(words))

      changed = words
      changed(place) = ieor(changed(place), shiftl(1_int64, bit))
      numbers = transfer(changed, numbers)
   end function flipped

   !> Rows that change places, blocks of zeros and missing ends.
   subroutine test_structure(checks)
      type(check_list_t), intent(inout) :: checks
      real(dp) :: numbers(1024), other(1024)
      integer :: i, distance

      numbers = [(sqrt(real(i, dp)), i=1, 1024)]
      distance = 1
      do while (distance < 1024)
         other = numbers
         other(1) = numbers(1 + distance)
         other(1 + distance) = numbers(1)
         call checks%check(sum_of_list(other) /= sum_of_list(numbers), 'swap over '//integer_text(distance))
         other = cshift(numbers, distance)
         call checks%check(sum_of_list(other) /= sum_of_list(numbers), 'shift by '//integer_text(distance))
         call checks%check(sum_of_list(numbers(:distance)) /= sum_of_list(numbers), 'cut at '// &
                           integer_text(distance))
         other = numbers
         other(distance:) = 0.0_dp
         call checks%check(sum_of_list(other) /= sum_of_list(numbers), 'zeros from '//integer_text(distance))
         distance = 2*distance
      end do
   end subroutine test_structure

end module test_checksum
