!> The lines of a CSV file as fields, read in blocks. Semicolons separate if the first line that is neither empty nor a comment has one
!> outside quotes, else commas. Numbers have points; where semicolons separate they may have commas instead, all of them.
module csv_fields
   use errors, only: error_words, is_shortage
   use file_system, only: is_directory, path_exists
   use kinds, only: dp, int64
   use number_text, only: read_strict_real
   use signals, only: must_stop
   implicit none(type, external)
   private

   !> Fields of a line beyond these are counted, but not kept
   integer, parameter :: block_bytes = 65536, longest_field = 80, most_fields = 4096
   !> Blanks of a field; what editors of old put at the end of a page and of a file are among them
   character(*), parameter :: line_feed = achar(10), carriage_return = achar(13), blanks = ' '//achar(9)//achar(12)//achar(26)
   !> Some editors begin a text in UTF-8 with it
   character(*), parameter :: utf8_mark = char(239)//char(187)//char(191)

   !> One field.
   type, public :: field_t
      private
      character(longest_field) :: letters = ''
      !> All its characters, more than are kept if it is too long
      integer(int64) :: length = 0_int64
      !> Whether it is the last of its line
      logical, public :: ends_line = .false.
   contains
      procedure :: word => field_word
      procedure :: shown => field_shown
      procedure :: bare => field_without_quotes
      procedure :: unit => field_without_brackets
   end type field_t

   !> An open file.
   type, public :: csv_text_t
      private
      integer :: unit = 0
      character(block_bytes) :: block
      integer :: at = 0
      integer :: used = 0
      !> Bytes that are not read yet
      integer(int64) :: left = 0_int64
      !> Whether the file could not be read to its end
      logical, public :: broken = .false.
      !> Whether the work had to stop within a field
      logical, public :: stopped = .false.
      !> What separates fields
      character(1), public :: separator = ','
      !> The decimal mark of the numbers read so far, a blank before any had one; and whether there were both
      character(1) :: mark = ' '
      logical, public :: has_both_marks = .false.
   contains
      procedure :: open => open_text
      procedure :: take_line
      procedure :: numeral
      procedure :: read_number
      procedure, private :: take_field
      procedure :: close => close_text
      procedure, private :: start
      procedure, private :: fill
   end type csv_text_t

contains

   !> Open a file and count its lines; an end without a line feed counts as a line. Where the work must stop, only some are
   !> counted.
   subroutine open_text(self, path, lines, message)
      class(csv_text_t), intent(inout) :: self
      !> Path of the file
      character(*), intent(in) :: path
      !> How many lines there are
      integer(int64), intent(out) :: lines
      !> Why it cannot be read; empty if it can
      character(:), allocatable, intent(out) :: message
      integer(int64) :: bytes
      integer :: stat, i
      logical :: open_end

      lines = 0_int64
      message = ''
      if (.not. path_exists(path)) then
         message = 'there is no such file'
      else if (is_directory(path)) then
         message = 'it is a folder; a file is needed'
      end if
      if (len(message) > 0) return
      ! Pipes and devices have no length; they are not opened.
      inquire (file=path, size=bytes)
      if (bytes <= 0_int64) return
      open (newunit=self%unit, file=path, access='stream', form='unformatted', status='old', action='read', &
            iostat=stat)
      if (stat /= 0) then
         message = 'it may not be read'
         if (is_shortage(stat)) message = 'it cannot be opened: '//error_words(stat)
         return
      end if
      call self%start(bytes)
      open_end = .false.
      do
         call self%fill()
         if (self%used == 0) exit
         do i = 1, self%used
            if (self%block(i:i) == line_feed) lines = lines + 1_int64
         end do
         open_end = self%block(self%used:self%used) /= line_feed
         if (must_stop()) exit
      end do
      if (open_end) lines = lines + 1_int64
      if (self%broken) message = 'it cannot be read to its end'
      call self%start(bytes)
      call self%fill()
      if (index(self%block(:self%used), utf8_mark) == 1) self%at = len(utf8_mark)
      self%separator = separator_of(self%block(self%at + 1:self%used))
   end subroutine open_text

   !> What separates the fields of a text.
   pure character(1) function separator_of(text) result(separator)
      character(*), intent(in) :: text
      integer :: i
      logical :: is_comment, is_empty, is_quoted

      separator = ','
      is_comment = .false.
      is_empty = .true.
      is_quoted = .false.
      do i = 1, len(text)
         if (text(i:i) == line_feed) then
            if (.not. (is_comment .or. is_empty)) return
            is_comment = .false.
            is_empty = .true.
         else if (scan(text(i:i), blanks//carriage_return) == 0) then
            if (is_empty) is_comment = text(i:i) == '#'
            is_empty = .false.
            if (text(i:i) == '"') is_quoted = .not. is_quoted
            if (text(i:i) == ';' .and. .not. (is_comment .or. is_quoted)) separator = ';'
            if (separator == ';') return
         end if
      end do
   end function separator_of

   !> Go to the first byte.
   subroutine start(self, bytes)
      class(csv_text_t), intent(inout) :: self
      integer(int64), intent(in) :: bytes
      integer :: stat

      self%left = bytes
      self%at = 0
      self%used = 0
      read (self%unit, pos=1, iostat=stat)
      if (stat /= 0) self%broken = .true.
   end subroutine start

   !> Read the next block.
   subroutine fill(self)
      class(csv_text_t), intent(inout) :: self
      integer :: stat

      self%at = 0
      self%used = int(min(self%left, int(block_bytes, int64)))
      if (self%used == 0) return
      read (self%unit, iostat=stat) self%block(:self%used)
      self%left = self%left - int(self%used, int64)
      if (stat == 0) return
      self%broken = .true.
      self%used = 0
      self%left = 0_int64
   end subroutine fill

   !> Take the next line; past the end of the file, one of an empty field.
   subroutine take_line(self, fields, count)
      class(csv_text_t), intent(inout) :: self
      !> Its fields; grows, up to a limit, where a line has more
      type(field_t), allocatable, intent(inout) :: fields(:)
      !> How many it has
      integer, intent(out) :: count
      type(field_t) :: field

      if (.not. allocated(fields)) allocate (fields(2))
      count = 0
      do
         call self%take_field(field)
         count = count + 1
         if (count > size(fields) .and. size(fields) < most_fields) fields = [fields, fields]
         if (count <= size(fields)) fields(count) = field
         if (field%ends_line) exit
      end do
   end subroutine take_line

   !> A field with a number as one with a decimal point.
   pure function numeral(self, field) result(word)
      class(csv_text_t), intent(in) :: self
      type(field_t), intent(in) :: field
      character(:), allocatable :: word
      integer :: comma

      word = field%bare()
      comma = index(word, ',')
      if (self%separator == ';' .and. comma > 0 .and. index(word, '.') == 0) word(comma:comma) = '.'
   end function numeral

   !> The number of a field.
   subroutine read_number(self, field, number, sound)
      class(csv_text_t), intent(inout) :: self
      type(field_t), intent(in) :: field
      !> Its value, 0 if it is not sound
      real(dp), intent(out) :: number
      !> Whether it is one; not if its decimal mark is another than that of numbers before it
      logical, intent(out) :: sound
      character(:), allocatable :: word
      integer :: at

      call read_strict_real(self%numeral(field), number, sound)
      if (.not. sound .or. self%separator == ',') return
      word = field%bare()
      at = scan(word, '.,')
      if (at == 0) return
      if (self%mark == ' ') self%mark = word(at:at)
      sound = word(at:at) == self%mark
      if (.not. sound) self%has_both_marks = .true.
   end subroutine read_number

   !> Take the next field; past the end of the file, empty ones that end their line.
   subroutine take_field(self, field)
      class(csv_text_t), intent(inout) :: self
      !> The field
      type(field_t), intent(out) :: field
      character(1) :: letter
      logical :: returned, is_quoted, is_blank

      returned = .false.
      is_quoted = .false.
      is_blank = .true.
      do
         if (self%at == self%used) then
            self%stopped = must_stop()
            if (.not. self%stopped) call self%fill()
         end if
         field%ends_line = self%used == 0 .or. self%stopped
         if (field%ends_line) exit
         self%at = self%at + 1
         letter = self%block(self%at:self%at)
         field%ends_line = letter == line_feed
         if (field%ends_line .or. (letter == self%separator .and. .not. is_quoted)) exit
         returned = letter == carriage_return
         ! Quotes that begin a field keep separators in it until they end.
         if (letter == '"') is_quoted = is_blank
         if (is_blank) is_blank = scan(letter, blanks) > 0
         field%length = field%length + 1_int64
         if (field%length <= longest_field) field%letters(field%length:field%length) = letter
      end do
      ! A carriage return right before the end of the line belongs to that end.
      if (.not. (field%ends_line .and. returned)) return
      if (field%length <= longest_field) field%letters(field%length:field%length) = ' '
      field%length = field%length - 1_int64
   end subroutine take_field

   !> Close the file.
   subroutine close_text(self)
      class(csv_text_t), intent(inout) :: self
      integer :: ignored

      if (self%unit /= 0) close (self%unit, iostat=ignored)
      self%unit = 0
   end subroutine close_text

   !> The field without blanks and tabs around it; one that is too long ends with three points.
   pure function field_word(self) result(word)
      class(field_t), intent(in) :: self
      character(:), allocatable :: word
      integer :: first

      first = verify(self%letters, blanks)
      if (self%length > longest_field) then
         word = trim(self%letters)//'...'
      else if (first == 0) then
         word = ''
      else
         word = self%letters(first:verify(self%letters, blanks, back=.true.))
      end if
   end function field_word

   !> The word without the quotes around it.
   pure function field_without_quotes(self) result(word)
      class(field_t), intent(in) :: self
      character(:), allocatable :: word

      word = self%word()
      if (len(word) < 2) return
      if (scan(word(1:1), '"'//"'") > 0 .and. word(1:1) == word(len(word):)) word = trim(adjustl(word(2:len(word) - 1)))
   end function field_without_quotes

   !> The word without quotes and brackets around it, as units stand in them.
   pure function field_without_brackets(self) result(word)
      class(field_t), intent(in) :: self
      character(:), allocatable :: word

      word = self%bare()
      if (len(word) < 2) return
      if (scan(word(1:1), '[(') > 0 .and. scan(word(len(word):), '])') > 0) word = trim(adjustl(word(2:len(word) - 1)))
   end function field_without_brackets

   !> The field for a sentence: short, and every character can be printed.
   pure function field_shown(self) result(word)
      class(field_t), intent(in) :: self
      character(:), allocatable :: word
      integer, parameter :: most = 40
      integer :: i

      word = self%word()
      if (len(word) > most) word = word(:most)//'...'
      do i = 1, len(word)
         if (iachar(word(i:i)) < 32 .or. iachar(word(i:i)) > 126) word(i:i) = '?'
      end do
   end function field_shown

end module csv_fields
