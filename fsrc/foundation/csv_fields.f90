!> The fields of a CSV file one after the other, read in blocks.
module csv_fields
   use errors, only: error_words, is_shortage
   use file_system, only: is_directory, path_exists
   use kinds, only: int64
   use signals, only: must_stop
   implicit none(type, external)
   private

   integer, parameter :: block_bytes = 65536, longest_field = 80
   character(*), parameter :: line_feed = achar(10), carriage_return = achar(13), horizontal_tab = achar(9)
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
   contains
      procedure :: open => open_text
      procedure :: take_field
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
   end subroutine open_text

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

   !> Take the next field; past the end of the file, empty ones that end their line.
   subroutine take_field(self, field)
      class(csv_text_t), intent(inout) :: self
      !> The field
      type(field_t), intent(out) :: field
      character(1) :: letter
      logical :: returned

      returned = .false.
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
         if (field%ends_line .or. letter == ',') exit
         returned = letter == carriage_return
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
      character(*), parameter :: blanks = ' '//horizontal_tab
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
