!> Lists of words in one text, one or more blanks between two words and none before them.
module word_list
   implicit none(type, external)
   private

   !> One word, of its own length.
   type, public :: word_t
      character(:), allocatable :: text
   end type word_t

   public :: word_count, split_words, word_position, joined_words

contains

   !> Number of words.
   pure integer function word_count(list)
      !> The list, may be empty
      character(*), intent(in) :: list
      integer :: i

      word_count = 0
      if (len(list) > 0) word_count = 1 + count([(list(i:i + 1) /= '  ' .and. list(i:i) == ' ', i=1, len(list) - 1)])
   end function word_count

   !> The words one by one.
   pure function split_words(list) result(words)
      !> The list, may be empty
      character(*), intent(in) :: list
      type(word_t), allocatable :: words(:)
      integer :: i, start, length

      allocate (words(word_count(list)))
      start = 1
      do i = 1, size(words)
         length = index(list(start:), ' ') - 1
         if (length < 0) length = len(list) - start + 1
         words(i)%text = list(start:start + length - 1)
         start = start + length
         start = start + verify(list(start:)//'.', ' ') - 1
      end do
   end function split_words

   !> Position of the first word that equals a word, from 1; 0 if there is none.
   pure integer function word_position(list, word)
      !> The list, may be empty
      character(*), intent(in) :: list
      !> One word
      character(*), intent(in) :: word
      integer :: place

      word_position = 0
      if (len(word) == 0) return
      place = index(' '//list//' ', ' '//word//' ')
      if (place > 0) word_position = word_count(list(:place))
   end function word_position

   !> Words as a sentence lists them: 'a', 'a and b', 'a, b and c'.
   pure function joined_words(words, mask) result(sentence)
      !> Any words
      type(word_t), intent(in) :: words(:)
      !> Which of them are listed; none give an empty text
      logical, intent(in) :: mask(:)
      character(:), allocatable :: sentence
      integer :: i

      sentence = ''
      do i = 1, size(words)
         if (.not. mask(i)) cycle
         if (any(mask(:i - 1))) then
            if (any(mask(i + 1:))) sentence = sentence//', '
            if (.not. any(mask(i + 1:))) sentence = sentence//' and '
         end if
         sentence = sentence//words(i)%text
      end do
   end function joined_words

end module word_list
