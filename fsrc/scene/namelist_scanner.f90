!> A walk through namelist text, word by word: what stands at its place, and what may be passed over.
!> It knows no group and no key; what it finds is judged by namelist_text.
module namelist_scanner
   use text, only: is_word_character
   implicit none(type, external)
   private

   !> One value as it stands, and whether it stood in quotes.
   type, public :: value_t
      character(:), allocatable :: text
      logical :: quoted = .false.
   end type value_t

   !> State of the walk.
   type, public :: scanner_t
      !> Line of its place
      integer :: line = 1
      character(:), allocatable, private :: content
      integer, private :: at = 1
   contains
      procedure :: letter
      procedure :: ended
      procedure :: at_new_group
      procedure :: key_follows
      procedure :: step
      procedure :: skip_blanks
      procedure :: skip_line
      procedure :: skip_stray
      procedure :: take_word
      procedure :: take_value
      procedure :: take_index
      procedure, private :: word_follows
   end type scanner_t

   character(*), parameter :: horizontal_tab = achar(9), line_feed = achar(10), carriage_return = achar(13)
   !> Some editors begin a text in UTF-8 with it
   character(*), parameter :: byte_order_mark = char(239)//char(187)//char(191)

   public :: new_scanner

contains

   !> Walk that begins with a text.
   pure function new_scanner(content, first_line) result(scanner)
      !> Whole text
      character(*), intent(in) :: content
      !> Number of its first line
      integer, intent(in) :: first_line
      type(scanner_t) :: scanner

      scanner%content = content
      scanner%line = first_line
      if (index(content, byte_order_mark) == 1) scanner%at = 1 + len(byte_order_mark)
   end function new_scanner

   !> A quoted text (it must end on its line) or a bare word. A slash with a word right behind it is part
   !> of the bare word: 3/4 is a bad number, not a 3 and the end of the group.
   subroutine take_value(self, value, closed)
      class(scanner_t), intent(inout) :: self
      !> The value, its quotes taken off
      type(value_t), intent(out) :: value
      !> Whether its closing quote was found; if not, the rest of the line is passed over
      logical, intent(out) :: closed
      character(1) :: quote
      integer :: start, closing

      closed = .true.
      quote = self%letter()
      value%quoted = quote == "'" .or. quote == '"'
      start = self%at
      call self%step()
      if (.not. value%quoted) then
         do while (.not. self%ended())
            if (is_blank(self%letter()) .or. scan(self%letter(), ',!='//"'"//'"') > 0) exit
            if (self%letter() == '/' .and. .not. self%word_follows()) exit
            call self%step()
         end do
         value%text = self%content(start:self%at - 1)
         return
      end if
      value%text = ''
      do
         start = self%at
         closing = scan(self%content(start:), quote//line_feed//carriage_return)
         closed = closing > 0
         if (closed) closed = self%content(start + closing - 1:start + closing - 1) == quote
         if (.not. closed) exit
         value%text = value%text//self%content(start:start + closing - 2)
         self%at = start + closing
         if (self%letter() /= quote) return
         value%text = value%text//quote
         call self%step()
      end do
      call self%skip_line()
   end subroutine take_value

   !> Index in parentheses after a key: (3), or (:, 3) for a column of a table.
   subroutine take_index(self, first_element, whole_column)
      class(scanner_t), intent(inout) :: self
      !> Its number; 0 if that is not one positive integer
      integer, intent(out) :: first_element
      !> Whether it is a column
      logical, intent(out) :: whole_column
      character(:), allocatable :: inside
      integer :: closing, stat

      first_element = 0
      whole_column = .false.
      closing = index(self%content(self%at:), ')')
      if (closing < 3 .or. closing > 16) return
      inside = adjustl(self%content(self%at + 1:self%at + closing - 2))
      if (inside(1:1) == ':') then
         whole_column = .true.
         inside = adjustl(inside(2:))
         if (index(inside, ',') /= 1) return
         inside = adjustl(inside(2:))
      end if
      if (verify(trim(inside), '0123456789') > 0 .or. len_trim(inside) == 0) return
      read (inside, *, iostat=stat) first_element
      if (stat /= 0) first_element = 0
      self%at = self%at + closing
   end subroutine take_index

   !> Whether a group opens here, or the text ends.
   pure logical function at_new_group(self)
      class(scanner_t), intent(in) :: self

      at_new_group = self%ended()
      if (.not. at_new_group) at_new_group = self%letter() == '&'
   end function at_new_group

   !> Whether a letter or digit comes right after the present character.
   pure logical function word_follows(self)
      class(scanner_t), intent(in) :: self

      word_follows = self%at < len(self%content)
      if (word_follows) word_follows = is_word_character(self%content(self%at + 1:self%at + 1))
   end function word_follows

   !> Whether 'word =' or 'word(' stands here; the scanner stays where it is.
   logical function key_follows(self)
      class(scanner_t), intent(inout) :: self
      integer :: at, line

      at = self%at
      line = self%line
      key_follows = len(self%take_word()) > 0
      if (key_follows) then
         call self%skip_blanks()
         key_follows = scan(self%letter(), '=(') > 0
      end if
      self%at = at
      self%line = line
   end function key_follows

   !> Letters, digits and underscores from here on.
   function take_word(self) result(word)
      class(scanner_t), intent(inout) :: self
      character(:), allocatable :: word
      integer :: start

      start = self%at
      do while (.not. self%ended())
         if (.not. is_word_character(self%letter())) exit
         call self%step()
      end do
      word = self%content(start:self%at - 1)
   end function take_word

   !> Pass over blanks, line ends and comments.
   subroutine skip_blanks(self)
      class(scanner_t), intent(inout) :: self

      do while (.not. self%ended())
         if (self%letter() == '!') then
            call self%skip_line()
         else if (.not. is_blank(self%letter())) then
            return
         else
            if (self%letter() == line_feed) self%line = self%line + 1
            call self%step()
         end if
      end do
   end subroutine skip_blanks

   !> Pass over the rest of the line, its end excepted.
   subroutine skip_line(self)
      class(scanner_t), intent(inout) :: self

      do while (.not. self%ended())
         if (self%letter() == line_feed) return
         call self%step()
      end do
   end subroutine skip_line

   !> Pass over text outside a group up to the next & or line end.
   subroutine skip_stray(self)
      class(scanner_t), intent(inout) :: self

      do while (.not. self%ended())
         if (self%letter() == '&' .or. self%letter() == line_feed) return
         call self%step()
      end do
   end subroutine skip_stray

   !> The present character, a blank behind the end.
   pure character(1) function letter(self)
      class(scanner_t), intent(in) :: self

      letter = ' '
      if (self%at <= len(self%content)) letter = self%content(self%at:self%at)
   end function letter

   !> Pass over the present character.
   pure subroutine step(self)
      class(scanner_t), intent(inout) :: self

      self%at = self%at + 1
   end subroutine step

   !> Whether the end is passed.
   pure logical function ended(self)
      class(scanner_t), intent(in) :: self

      ended = self%at > len(self%content)
   end function ended

   pure logical function is_blank(letter)
      character(1), intent(in) :: letter

      is_blank = letter == ' ' .or. letter == horizontal_tab .or. letter == line_feed .or. letter == carriage_return
   end function is_blank

end module namelist_scanner
