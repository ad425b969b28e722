!> Tests of lists of words in one text.
module test_word_list
   use checks, only: check_list_t
   use word_list, only: split_words, word_count, word_position, word_t
   implicit none(type, external)
   private

   public :: run_word_list_tests

contains

   !> Runs every test of this topic.
   subroutine run_word_list_tests(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      character(*), parameter :: list = 'time film film_load time'
      type(word_t), allocatable :: words(:)

      call checks%start('word_list')
      call checks%check(word_count('') == 0 .and. word_count('fast') == 1 .and. word_count(list) == 4, 'count')
      allocate (words, source=split_words(list))
      call checks%check(size(words) == 4, 'as many words as are counted')
      call checks%check(words(1)%text == 'time' .and. words(3)%text == 'film_load' .and. words(4)%text == 'time', &
         'the words one by one')
      call checks%check(len(words(2)%text) == 4, 'a word ends before the blank')
      call checks%check(size(split_words('')) == 0, 'no word in an empty list')
      call checks%check(word_position(list, 'time') == 1, 'position of the first of two')
      call checks%check(word_position(list, 'film_load') == 3, 'position behind a word that begins alike')
      call checks%check(word_position('', 'time') == 0, 'no word in an empty list')
      call checks%check(word_position('fast successive', 'succ') == 0, 'part of a word is no word')
      call checks%check(word_position('fast successive', '') == 0, 'no word')
   end subroutine run_word_list_tests

end module test_word_list
