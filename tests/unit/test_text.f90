!> Tests of the text helpers.
module test_text
   use, intrinsic :: ieee_arithmetic, only: ieee_get_halting_mode, ieee_is_finite, ieee_overflow
   use checks, only: check_list_t
   use kinds, only: dp, int64
   use text, only: counted, edit_distance, error_text, integer_text, is_word_character, logical_text, lower, quoted, &
      quoted_words, real_text, short_text, stated_error
   implicit none(type, external)
   private

   public :: run_text_tests

contains

   !> Runs every test of this topic.
   subroutine run_text_tests(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      call checks%start('text')
      call test_real_text(checks)
      call test_random_reals(checks)
      call test_short_text(checks)
      call test_errors_of_numbers(checks)
      call test_words(checks)
      call test_edit_distance(checks)
   end subroutine run_text_tests

   !> Spelling of known numbers.
   subroutine test_real_text(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      call spelt(checks, real_text(0.0_dp), '0.0')
      call spelt(checks, real_text(1.0_dp), '1.0')
      call spelt(checks, real_text(-0.5_dp), '-0.5')
      call spelt(checks, real_text(0.1_dp), '0.1')
      call spelt(checks, real_text(0.001_dp), '0.001')
      call spelt(checks, real_text(199.2_dp), '199.2')
      call spelt(checks, real_text(9.80665_dp), '9.80665')
      call spelt(checks, real_text(999999.0_dp), '999999.0')
      call spelt(checks, real_text(1.0e6_dp), '1.0E6')
      call spelt(checks, real_text(2.0e-8_dp), '2.0E-8')
      call spelt(checks, real_text(205.66e9_dp), '2.0566E11')
      call spelt(checks, real_text(1.0_dp/3.0_dp), '0.3333333333333333')
      call spelt(checks, real_text(8.889224234368e-07_dp), '8.889224234368E-7')
      call spelt(checks, integer_text(-42), '-42')
      call spelt(checks, counted(1, 'rank'), '1 rank')
      call spelt(checks, counted(0, 'rank'), '0 ranks')
      call spelt(checks, integer_text(9000000000_int64), '9000000000')
      call spelt(checks, logical_text(.true.), '.true.')
      call spelt(checks, logical_text(.false.), '.false.')
   end subroutine test_real_text

   !> Errors have two digits, are rounded up, and are not below the rounding of their number as it is reported.
   subroutine test_errors_of_numbers(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results
      integer, parameter :: count_ = 2000
      real(dp) :: number, error, reported, number_reported, rounding
      character(:), allocatable :: text
      integer :: i, digits, stat, low, long, other

      call spelt(checks, error_text(1.7e-16_dp, 0.08_dp, 5), '5.0E-7')
      call spelt(checks, error_text(0.00631_dp, 14.737_dp, 5), '0.0064')
      call spelt(checks, error_text(0.33_dp, 202.62_dp, 5), '0.33')
      call spelt(checks, error_text(23.4_dp, 20.691_dp, 5), '24')
      call spelt(checks, error_text(0.0995_dp, 20.691_dp, 5), '0.10')
      call spelt(checks, error_text(1.0e-12_dp, -1.0_dp, 5), '5.0E-5')
      call spelt(checks, error_text(3.0_dp, 123456.0_dp, 3), '3.0')
      call spelt(checks, error_text(0.1_dp, 123456.0_dp, 3), '0.50')
      call spelt(checks, error_text(1.0_dp, 1.5e9_dp, 3), '5.0E6')
      call spelt(checks, error_text(0.0_dp, 0.0_dp, 5), '0')
      call spelt(checks, error_text(3.21e-9_dp, 0.0_dp, 5), '3.3E-9')
      call checks%check(.not. abs(stated_error(0.0_dp, 0.0_dp)) > 0.0_dp, 'no error')
      call checks%check(stated_error(huge(1.0_dp), 0.0_dp) >= huge(1.0_dp), 'the largest error')
      call checks%check(stated_error(tiny(1.0_dp), 0.0_dp) >= tiny(1.0_dp), 'the smallest error')
      low = 0
      long = 0
      other = 0
      do i = 1, count_
         number = 10.0_dp**(-12.0_dp + 20.0_dp*fraction_of(i, 0.61803398875_dp))
         error = number*10.0_dp**(-18.0_dp + 19.0_dp*fraction_of(i, 0.75487766625_dp))
         digits = 3 + mod(i, 4)
         text = short_text(number, digits)
         read (text, *, iostat=stat) number_reported
         text = error_text(error, number, digits)
         read (text, *, iostat=stat) reported
         rounding = abs(number_reported - number)
         if (reported < max(error, rounding)*(1.0_dp - 1.0e-10_dp)) low = low + 1
         if (short_text(reported, 2) /= error_text(error, number, digits)) long = long + 1
         if (reported > 1.1_dp*max(error, 0.5_dp*10.0_dp**(-decimals(short_text(number, digits))))*(1.0_dp + 1.0e-9_dp)) &
            other = other + 1
         ! What is reported may be reported again.
         if (error_text(reported, number, digits) /= error_text(error, number, digits)) other = other + 1
      end do
      call checks%check(low == 0, 'no error is below the bound or the rounding of its number')
      call checks%check(long == 0, 'no error has more than two digits')
      call checks%check(other == 0, 'no error is reported larger than bound and rounding ask for')
   end subroutine test_errors_of_numbers

   !> A number between 0 and 1, another one for each place.
   pure real(dp) function fraction_of(place, step)
      integer, intent(in) :: place
      real(dp), intent(in) :: step

      fraction_of = modulo(real(place, dp)*step, 1.0_dp)
   end function fraction_of

   !> Decimals of a number in text, its exponent taken in.
   pure integer function decimals(number)
      character(*), intent(in) :: number
      integer :: point, mark, exponent, stat

      mark = index(number, 'E')
      exponent = 0
      if (mark > 0) read (number(mark + 1:), *, iostat=stat) exponent
      if (mark == 0) mark = len(number) + 1
      point = index(number(:mark - 1), '.')
      decimals = -exponent
      if (point > 0) decimals = mark - 1 - point - exponent
   end function decimals

   !> Text as expected, length included.
   subroutine spelt(checks, actual, expected)
      type(check_list_t), intent(inout) :: checks  !> Collects the results
      character(*), intent(in) :: actual           !> Text under test
      character(*), intent(in) :: expected         !> What it should be

      call checks%check(actual == expected .and. len(actual) == len(expected), &
         "'"//actual//"' instead of '"//expected//"'")
   end subroutine spelt

   !> Any bit pattern that is a finite number reads back to itself, extremes of the range included.
   subroutine test_random_reals(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      integer, parameter :: count_ = 3000
      real(dp), parameter :: special(8) = [tiny(1.0_dp), huge(1.0_dp), -huge(1.0_dp), epsilon(1.0_dp), &
         1.0_dp + epsilon(1.0_dp), &
         1.0_dp - 0.5_dp*epsilon(1.0_dp), nearest(1.0e6_dp, -1.0_dp), nearest(1.0e-3_dp, -1.0_dp)]
      integer(int64) :: bits
      real(dp) :: number, largest
      integer :: i, unread
      character(:), allocatable :: first_unread
      logical :: halting

      ! Too short a text of the largest numbers is infinite: a build with traps would stop there.
      call ieee_get_halting_mode(ieee_overflow, halting)
      largest = merge(0.9e308_dp, huge(1.0_dp), halting)
      unread = 0
      first_unread = ''
      do i = 1, size(special)
         if (abs(special(i)) > largest) cycle
         if (reads_back(special(i))) cycle
         unread = unread + 1
         first_unread = real_text(special(i))
      end do
      call checks%check(unread == 0, 'special numbers read back: '//first_unread)
      call checks%check(reads_back(transfer(1_int64, 1.0_dp)), 'the smallest subnormal number reads back')

      ! A xorshift generator: the same numbers in every run.
      unread = 0
      first_unread = ''
      bits = 88172645463325252_int64
      do i = 1, count_
         bits = ieor(bits, ishft(bits, 13))
         bits = ieor(bits, ishft(bits, -7))
         bits = ieor(bits, ishft(bits, 17))
         number = transfer(bits, 1.0_dp)
         ! Every other one near 1, where the plain notation is used.
         if (mod(i, 2) == 0) number = real(iand(bits, 1048575_int64), &
            dp)*2.0_dp**(-int(iand(ishft(bits, -40), 31_int64)))
         if (.not. ieee_is_finite(number)) cycle
         if (abs(number) > largest) cycle
         if (reads_back(number)) cycle
         unread = unread + 1
         first_unread = real_text(number)
      end do
      call checks%check(unread == 0, 'random numbers read back: '//first_unread)
   end subroutine test_random_reals

   !> Whether the text of a number gives its bits again; zero has one text for both signs.
   logical function reads_back(number)
      real(dp), intent(in) :: number  !> Finite number

      character(:), allocatable :: text
      real(dp) :: back
      integer :: stat

      text = real_text(number)
      read (text, *, iostat=stat) back
      reads_back = stat == 0 .and. (transfer(back, 1_int64) == transfer(number, 1_int64) &
         .or. .not. abs(number) > 0.0_dp)
   end function reads_back

   !> Numbers rounded for sentences.
   subroutine test_short_text(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      call spelt(checks, short_text(0.0_dp, 3), '0')
      call spelt(checks, short_text(1.6542_dp, 3), '1.65')
      call spelt(checks, short_text(-1.6542_dp, 2), '-1.7')
      call spelt(checks, short_text(199.2_dp, 3), '199')
      call spelt(checks, short_text(0.012345_dp, 2), '0.012')
      call spelt(checks, short_text(8.889e-7_dp, 3), '8.89E-7')
      call spelt(checks, short_text(2.5e11_dp, 2), '2.5E11')
   end subroutine test_short_text

   !> Lower case, quotes, characters of words.
   subroutine test_words(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      call checks%check(lower('RaTTle_[9]') == 'rattle_[9]', 'lower case')
      call checks%check(quoted('idle') == "'idle'", 'quoted')
      call checks%check(quoted("it's") == "'it''s'", 'a quote inside is doubled')
      call checks%check(quoted('') == "''", 'empty text in quotes')
      call checks%check(quoted_words('time film', ' ') == "'time', 'film'", 'words in quotes')
      call checks%check(quoted_words('time', ' ') == "'time'", 'one word in quotes')
      call checks%check(all(is_word_character(['a', 'z', 'A', 'Z', '0', '9', '_'])), 'characters of words')
      call checks%check(.not. any(is_word_character([' ', '-', '&', '=', '.', '@', '[', '`', '{', '/', &
         ':'])), &
         'other characters')
   end subroutine test_words

   !> Distances known by hand, and the axioms of a distance.
   subroutine test_edit_distance(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      character(9), parameter :: words(5) = [character(9) :: 'radius', 'radios', 'raduis', 'frequency', '']
      integer :: i, j, k
      logical :: symmetric, triangular, separated

      call checks%check(edit_distance('kitten', 'sitting') == 3, 'kitten, sitting')
      call checks%check(edit_distance('viscosity', 'viscosty') == 1, 'one letter missing')
      call checks%check(edit_distance('radius', 'radios') == 1, 'one letter wrong')
      call checks%check(edit_distance('radius', 'raduis') == 2, 'two letters swapped')
      call checks%check(edit_distance('', 'mass') == 4 .and. edit_distance('mass', '') == 4, &
         'against nothing')
      symmetric = .true.
      triangular = .true.
      separated = .true.
      do i = 1, size(words)
         do j = 1, size(words)
            symmetric = symmetric .and. distance(i, j) == distance(j, i)
            separated = separated .and. ((distance(i, j) == 0) .eqv. i == j)
            do k = 1, size(words)
               triangular = triangular .and. distance(i, j) <= distance(i, k) + distance(k, j)
            end do
         end do
      end do
      call checks%check(symmetric, 'the same in both directions')
      call checks%check(separated, 'zero only between the same words')
      call checks%check(triangular, 'no way round is shorter')

   contains

      !> Distance of two of the words.
      integer function distance(i, j)
         integer, intent(in) :: i  !> Position of one word
         integer, intent(in) :: j  !> Position of the other

         distance = edit_distance(trim(words(i)), trim(words(j)))
      end function distance

   end subroutine test_edit_distance

end module test_text
