!> Tests of lists of words in one text.
module test_word_list
   use checks, only: check_list_t
   use word_list, only: word_at, word_count, word_position
   implicit none(type, external)
   private

   public :: run_word_list_tests

contains

   !> Runs every test of this topic.
   subroutine run_word_list_tests(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      character(*), parameter :: list = 'time film film_load time'

      call checks%start('word_list')
      call checks%check(word_count('') == 0 .and. word_count('fast') == 1 .and. word_count(list) == 4, 'count')
      call checks%check(word_at(list, 1) == 'time' .and. word_at(list, 3) == 'film_load' .and. &
         word_at(list, 4) == 'time', 'word at a position')
      call checks%check(len(word_at(list, 2)) == 4, 'a word ends before the blank')
      call checks%check(len(word_at(list, 5)) == 0 .and. len(word_at('', 1)) == 0, 'no word beyond the last')
      call checks%check(word_position(list, 'time') == 1, 'position of the first of two')
      call checks%check(word_position(list, 'film_load') == 3, 'position behind a word that begins alike')
      call checks%check(word_position('', 'time') == 0, 'no word in an empty list')
      call checks%check(word_position('fast successive', 'succ') == 0, 'part of a word is no word')
      call checks%check(word_position('fast successive', '') == 0, 'no word')
   end subroutine run_word_list_tests

end module test_word_list
