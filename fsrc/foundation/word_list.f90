!> Lists of words in one text, a single blank between two words and none around them.
module word_list
   implicit none(type, external)
   private

   public :: word_count, word_at, word_position

contains

   !> Number of words.
   pure integer function word_count(list)
      !> The list, may be empty
      character(*), intent(in) :: list
      integer :: i

      word_count = 0
      if (len(list) > 0) word_count = 1 + count([(list(i:i) == ' ', i=1, len(list))])
   end function word_count

   !> Word at a position, from 1; empty beyond the last.
   pure function word_at(list, position) result(word)
      !> The list, may be empty
      character(*), intent(in) :: list
      !> Position
      integer, intent(in) :: position
      character(:), allocatable :: word
      integer :: skipped

      word = list//' '
      do skipped = 1, position - 1
         word = word(index(word, ' ') + 1:)
      end do
      word = word(:index(word, ' ') - 1)
   end function word_at

   !> Position of the first word that equals a word, from 1; 0 if there is none.
   pure integer function word_position(list, word)
      !> The list, may be empty
      character(*), intent(in) :: list
      !> One word
      character(*), intent(in) :: word
      integer :: place, i

      word_position = 0
      place = index(' '//list//' ', ' '//word//' ')
      if (place > 0) word_position = 1 + count([(list(i:i) == ' ', i=1, place - 1)])
   end function word_position

end module word_list
