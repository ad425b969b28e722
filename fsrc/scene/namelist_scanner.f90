!> A walk through namelist text, word by word: what stands at its place, and what may be passed over.
!> It knows no group and no key; what it finds is judged by namelist_text.
module namelist_scanner
   use kinds, only: int64
   use number_text, only: read_strict_integer
   use text, only: is_word_character
   implicit none(type, external)
   private

   !> One value as it stands, and whether it stood in quotes. Without a text it is a null value: it sets nothing.
   type, public :: value_t
      character(:), allocatable :: text
      logical :: quoted = .false.
      !> Line of the key that it was given to
      integer :: line = 0
   end type value_t

   !> Elements along one dimension of an array, as first:last:stride; of a single one the last is not said.
   type, public :: subscript_t
      integer :: first = 1
      integer :: last = huge(1)
      integer :: stride = 1
      logical :: single = .false.
   contains
      procedure :: whole
      procedure :: extent
      procedure :: element
   end type subscript_t

   !> State of the walk.
   type, public :: scanner_t
      !> Line of its place
      integer :: line = 1
      character(:), allocatable, private :: content
      integer, private :: at = 1
   contains
      procedure :: letter
      procedure :: ended
      procedure :: at_sign
      procedure :: word_ahead
      procedure :: key_follows
      procedure :: step
      procedure :: skip_blanks
      procedure :: skip_line
      procedure :: skip_fault
      procedure :: take_stray
      procedure :: take_word
      procedure :: take_value
      procedure :: take_subscripts
      procedure, private :: take_quoted
      procedure, private :: word_follows
      procedure, private :: begins_line
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

   !> [r*] and a quoted text (it must end on its line), a bare word, or nothing: r null values. A slash with a word right behind it
   !> is part of the bare word: 3/4 is a bad number, not a 3 and the end of the group.
   subroutine take_value(self, value, repeats, closed)
      class(scanner_t), intent(inout) :: self
      !> The value, its quotes taken off
      type(value_t), intent(out) :: value
      !> How often it stands there; 0 if its repeat count is none
      integer, intent(out) :: repeats
      !> Whether its closing quote was found; if not, the rest of the line is passed over
      logical, intent(out) :: closed
      integer :: digits, start
      logical :: sound

      closed = .true.
      repeats = 1
      digits = max(0, verify(self%content(self%at:), '0123456789') - 1)
      start = self%at + digits
      if (digits > 0 .and. self%content(start:min(start, len(self%content))) == '*') then
         call read_strict_integer(self%content(self%at:start - 1), repeats, sound)
         self%at = start + 1
         if (is_blank(self%letter()) .or. scan(self%letter(), ',;!') > 0) return
         if (self%letter() == '/' .and. .not. self%word_follows()) return
      end if
      value%quoted = scan(self%letter(), "'"//'"') > 0
      if (value%quoted) then
         call self%take_quoted(value%text, closed)
         return
      end if
      start = self%at
      call self%step()
      do while (.not. self%ended())
         if (is_blank(self%letter()) .or. scan(self%letter(), ',;!=&$'//"'"//'"') > 0) exit
         if (self%letter() == '/' .and. .not. self%word_follows()) exit
         call self%step()
      end do
      value%text = self%content(start:self%at - 1)
   end subroutine take_value

   !> A text in quotes; a doubled quote in it stands for one.
   subroutine take_quoted(self, text, closed)
      class(scanner_t), intent(inout) :: self
      character(:), allocatable, intent(out) :: text
      logical, intent(out) :: closed
      character(1) :: quote
      integer :: start, closing

      quote = self%letter()
      call self%step()
      text = ''
      do
         start = self%at
         closing = scan(self%content(start:), quote//line_feed)
         closed = closing > 0
         if (closed) closed = self%content(start + closing - 1:start + closing - 1) == quote
         if (.not. closed) exit
         text = text//self%content(start:start + closing - 2)
         self%at = start + closing
         if (self%letter() /= quote) return
         text = text//quote
         call self%step()
      end do
      call self%skip_line()
   end subroutine take_quoted

   !> Subscripts in parentheses after a key: (3), (1:2), (2:), (1:5:2), or two of them with a comma between.
   subroutine take_subscripts(self, subscripts, text, sound, closed)
      class(scanner_t), intent(inout) :: self
      !> One for each dimension
      type(subscript_t), allocatable, intent(out) :: subscripts(:)
      !> They as they stand, without blanks
      character(:), allocatable, intent(out) :: text
      !> Whether all are elements that an array can have
      logical, intent(out) :: sound
      !> Whether the parenthesis was closed; if not, the scanner stands where it cannot be
      logical, intent(out) :: closed
      integer :: comma

      text = ''
      sound = .false.
      allocate (subscripts(0))
      do
         if (.not. is_blank(self%letter())) text = text//self%letter()
         if (self%letter() == line_feed) self%line = self%line + 1
         call self%step()
         closed = scan(self%letter(), '=/&$!'//"'"//'"') == 0 .and. .not. self%ended()
         if (.not. closed) return
         if (self%letter() == ')') exit
      end do
      call self%step()
      comma = index(text, ',')
      if (comma == 0) then
         subscripts = [subscript_of(text(2:))]
      else
         subscripts = [subscript_of(text(2:comma - 1)), subscript_of(text(comma + 1:))]
      end if
      text = text//')'
      sound = all(subscripts%first > 0)
   end subroutine take_subscripts

   !> One subscript; its first element is 0 if it is none.
   pure type(subscript_t) function subscript_of(text) result(subscript)
      !> Without blanks
      character(*), intent(in) :: text
      integer :: numbers(3), start, part, i
      logical :: sound

      numbers = [1, huge(1), 1]
      start = 1
      sound = len(text) > 0
      do i = 1, size(numbers)
         part = scan(text(start:)//':', ':') - 1
         if (part > 0) call read_strict_integer(text(start:start + part - 1), numbers(i), sound)
         start = start + part + 1
         if (start > len(text) + 1 .or. .not. sound) exit
      end do
      sound = sound .and. start > len(text) + 1 .and. all(numbers(:2) > 0) .and. numbers(3) /= 0
      ! Backwards from an element that is not said, or forwards to one before it: no elements.
      sound = sound .and. merge(numbers(2) >= numbers(1), numbers(2) <= numbers(1), numbers(3) > 0)
      subscript = subscript_t(merge(numbers(1), 0, sound), numbers(2), numbers(3), scan(text, ':') == 0)
   end function subscript_of

   !> Whether it is (:), all elements that there are.
   pure logical function whole(self)
      class(subscript_t), intent(in) :: self

      whole = self%first == 1 .and. self%last == huge(1) .and. self%stride == 1 .and. .not. self%single
   end function whole

   !> How many elements a subscript has.
   pure integer function extent(self)
      class(subscript_t), intent(in) :: self

      extent = 1
      if (.not. self%single) extent = (self%last - self%first)/self%stride + 1
   end function extent

   !> One of them; those beyond all bounds are the largest integer.
   pure integer function element(self, place)
      class(subscript_t), intent(in) :: self
      !> From 1
      integer, intent(in) :: place

      element = int(min(self%first + int(place - 1, int64)*self%stride, int(huge(1), int64)))
   end function element

   !> Whether a sign stands here with which a group opens or ends, or the text ends.
   pure logical function at_sign(self)
      class(scanner_t), intent(in) :: self

      at_sign = self%ended() .or. scan(self%letter(), '&$') > 0
   end function at_sign

   !> The word right behind the present character.
   pure function word_ahead(self) result(word)
      class(scanner_t), intent(in) :: self
      character(:), allocatable :: word
      integer :: last

      last = self%at
      do while (last < len(self%content))
         if (.not. is_word_character(self%content(last + 1:last + 1))) exit
         last = last + 1
      end do
      word = self%content(self%at + 1:last)
   end function word_ahead

   !> Whether a letter or digit comes right after the present character.
   pure logical function word_follows(self)
      class(scanner_t), intent(in) :: self

      word_follows = len(self%word_ahead()) > 0
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

   !> Pass over blanks, line ends and comments: behind a !, and lines that begin with a #.
   subroutine skip_blanks(self)
      class(scanner_t), intent(inout) :: self

      do while (.not. self%ended())
         if (self%letter() == '!' .or. (self%letter() == '#' .and. self%begins_line())) then
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

   !> Pass over what is no assignment: up to the line end or the end of its group.
   subroutine skip_fault(self)
      class(scanner_t), intent(inout) :: self

      do while (.not. self%at_sign())
         if (self%letter() == line_feed .or. (self%letter() == '/' .and. .not. self%word_follows())) return
         call self%step()
      end do
   end subroutine skip_fault

   !> Text outside a group, up to its line end or the sign before one of the given words.
   function take_stray(self, is_group) result(text)
      class(scanner_t), intent(inout) :: self
      !> Whether a word opens a group
      interface
         pure logical function is_group(word)
            character(*), intent(in) :: word
         end function is_group
      end interface
      character(:), allocatable :: text
      integer :: start

      start = self%at
      do while (.not. self%ended())
         if (self%letter() == line_feed) exit
         if (self%at_sign() .and. self%at > start) then
            if (is_group(self%word_ahead())) exit
         end if
         call self%step()
      end do
      text = self%content(start:self%at - 1)
   end function take_stray

   !> Whether nothing but blanks stands before the present character on its line.
   pure logical function begins_line(self)
      class(scanner_t), intent(in) :: self
      integer :: line_start

      line_start = index(self%content(:self%at - 1), line_feed, back=.true.) + 1
      begins_line = verify(self%content(line_start:self%at - 1), ' '//horizontal_tab) == 0
   end function begins_line

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
