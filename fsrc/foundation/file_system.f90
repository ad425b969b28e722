!> What Fortran lacks of the file system: whole files as text, folders, permissions, terminals.
!> Thin calls of the C library.
module file_system
   use, intrinsic :: iso_c_binding, only: c_char, c_int, c_int16_t, c_int32_t, c_int64_t, c_null_char, c_null_funptr, &
      c_null_ptr, c_ptr, c_size_t, c_associated, c_f_pointer, c_funptr
   use errors, only: last_error
   use file_descriptor, only: close_descriptor, open_existing, read_bytes, read_only, standard_input, standard_output
   use kinds, only: int64
   use word_list, only: word_t
   implicit none(type, external)
   private

   public :: read_whole_file, first_bytes, path_exists, file_state_t, state_of_path, state_of_descriptor, &
             is_directory, is_writable, make_directory, rename_file, rename_new, &
             delete_file, is_terminal, lies_inside, is_link, stands_at, found_files, random_word

   !> What stands at a path.
   type :: file_state_t
      logical :: exists = .false.
      !> Whether it is a file that keeps bytes: no folder, pipe or device
      logical :: is_file = .false.
      logical :: is_folder = .false., is_link = .false.
      integer(int64) :: bytes = 0_int64
      !> Number of the file on its device, and of the device in two parts
      integer(int64) :: number = 0_int64
      integer(c_int32_t) :: device(2) = 0_c_int32_t
   end type file_state_t

   !> The answer of statx, whose layout is the same on all machines.
   type, bind(c) :: statx_t
      integer(c_int32_t) :: mask, block_bytes
      integer(c_int64_t) :: attributes
      integer(c_int32_t) :: links, user, group
      integer(c_int16_t) :: mode, unused
      integer(c_int64_t) :: number, bytes, blocks, attributes_mask
      integer(c_int32_t) :: times(16), special_device(2), device(2)
      integer(c_int64_t) :: reserved(14)
   end type statx_t

   !> The answer of glob.
   type, bind(c) :: glob_t
      integer(c_size_t) :: count
      type(c_ptr) :: paths
      integer(c_size_t) :: offset
      integer(c_int) :: flags
      type(c_funptr) :: procedures(5)
   end type glob_t

   integer(c_int), parameter :: from_working_directory = -100, path_is_empty = 4096, link_itself = 256, basic_facts = 2047
   integer(c_int), parameter :: replace_nothing = 1
   integer, parameter :: type_bits = int(o'170000'), regular_file = int(o'100000'), folder = int(o'040000'), link = int(o'120000')
   integer(c_int), parameter :: test_exists = 0, test_write_and_enter = 3

   interface
      function c_access(path, mode) bind(c, name='access') result(stat)
         import :: c_char, c_int
         character(kind=c_char), intent(in) :: path(*)
         integer(c_int), value :: mode
         integer(c_int) :: stat
      end function c_access

      function c_statx(directory, path, flags, mask, facts) bind(c, name='statx') result(stat)
         import :: c_char, c_int, statx_t
         integer(c_int), value :: directory
         character(kind=c_char), intent(in) :: path(*)
         integer(c_int), value :: flags
         integer(c_int), value :: mask
         type(statx_t), intent(out) :: facts
         integer(c_int) :: stat
      end function c_statx

      function c_mkdir(path, mode) bind(c, name='mkdir') result(stat)
         import :: c_char, c_int
         character(kind=c_char), intent(in) :: path(*)
         integer(c_int), value :: mode
         integer(c_int) :: stat
      end function c_mkdir

      function c_rename(from, to) bind(c, name='rename') result(stat)
         import :: c_char, c_int
         character(kind=c_char), intent(in) :: from(*)
         character(kind=c_char), intent(in) :: to(*)
         integer(c_int) :: stat
      end function c_rename

      function c_renameat2(from_folder, from, to_folder, to, flags) bind(c, name='renameat2') result(stat)
         import :: c_char, c_int
         integer(c_int), value :: from_folder
         character(kind=c_char), intent(in) :: from(*)
         integer(c_int), value :: to_folder
         character(kind=c_char), intent(in) :: to(*)
         integer(c_int), value :: flags
         integer(c_int) :: stat
      end function c_renameat2

      function c_unlink(path) bind(c, name='unlink') result(stat)
         import :: c_char, c_int
         character(kind=c_char), intent(in) :: path(*)
         integer(c_int) :: stat
      end function c_unlink

      function c_realpath(path, real_path) bind(c, name='realpath') result(place)
         import :: c_char, c_ptr
         character(kind=c_char), intent(in) :: path(*)
         character(kind=c_char), intent(out) :: real_path(*)
         type(c_ptr) :: place
      end function c_realpath

      function c_glob(pattern, flags, on_error, answer) bind(c, name='glob') result(stat)
         import :: c_char, c_funptr, c_int, glob_t
         character(kind=c_char), intent(in) :: pattern(*)
         integer(c_int), value :: flags
         type(c_funptr), value :: on_error
         type(glob_t), intent(inout) :: answer
         integer(c_int) :: stat
      end function c_glob

      subroutine c_globfree(answer) bind(c, name='globfree')
         import :: glob_t
         type(glob_t), intent(inout) :: answer
      end subroutine c_globfree

      function c_getrandom(number, count, flags) bind(c, name='getrandom') result(got)
         import :: c_int, c_int64_t, c_size_t
         integer(c_int64_t), intent(out) :: number
         integer(c_size_t), value :: count
         integer(c_int), value :: flags
         integer(c_size_t) :: got
      end function c_getrandom

      function c_isatty(descriptor) bind(c, name='isatty') result(answer)
         import :: c_int
         integer(c_int), value :: descriptor
         integer(c_int) :: answer
      end function c_isatty
   end interface

contains

   !> Read a file, a pipe, or standard input ('-') as it is, byte by byte.
   subroutine read_whole_file(path, limit, content, stat)
      !> Path; '-' is standard input
      character(*), intent(in) :: path
      !> Largest number of bytes that is accepted
      integer, intent(in) :: limit
      !> All bytes
      character(:), allocatable, intent(out) :: content
      !> 0: read; 1: cannot be opened; 2: cannot be read (a directory, say); 3: larger than the limit
      integer, intent(out) :: stat
      integer, parameter :: block = 65536
      character(block) :: buffer
      character(:), allocatable :: grown
      integer(c_int) :: descriptor
      integer(int64) :: got
      integer :: used
      logical :: failed, ignored

      stat = 0
      descriptor = standard_input
      if (path /= '-') descriptor = open_existing(trim(path), read_only)
      if (descriptor < 0) then
         stat = 1
         return
      end if
      allocate (character(block) :: content)
      used = 0
      do
         call read_bytes(descriptor, int(block, int64), buffer, got, failed)
         if (failed) stat = 2
         if (failed) exit
         if (used + int(got) > limit) then
            stat = 3
            exit
         end if
         if (used + int(got) > len(content)) then
            allocate (character(2*len(content)) :: grown)
            grown(:used) = content(:used)
            call move_alloc(grown, content)
         end if
         content(used + 1:used + int(got)) = buffer(:got)
         used = used + int(got)
         if (got < block) exit
      end do
      if (path /= '-') call close_descriptor(descriptor, ignored)
      content = content(:used)
   end subroutine read_whole_file

   !> The first bytes of a file, fewer if it is shorter, none if it cannot be read.
   subroutine first_bytes(path, bytes, got, cause)
      character(*), intent(in) :: path
      !> Filled from the left
      character(*), intent(out) :: bytes
      !> How many bytes were filled
      integer, intent(out) :: got
      !> Number of the failure, 0: it can be read
      integer(c_int), optional, intent(out) :: cause
      integer(c_int) :: descriptor
      integer(int64) :: filled
      logical :: failed, ignored

      got = 0
      bytes = ''
      if (present(cause)) cause = 0_c_int
      descriptor = open_existing(trim(path), read_only)
      if (descriptor < 0 .and. present(cause)) cause = last_error()
      if (descriptor < 0) return
      call read_bytes(descriptor, len(bytes, int64), bytes, filled, failed)
      if (failed .and. present(cause)) cause = last_error()
      got = int(filled)
      call close_descriptor(descriptor, ignored)
   end subroutine first_bytes

   !> Whether anything stands at a path.
   logical function path_exists(path)
      character(*), intent(in) :: path

      path_exists = c_access(trim(path)//c_null_char, test_exists) == 0
   end function path_exists

   !> What stands at a path; links are followed.
   type(file_state_t) function state_of_path(path)
      character(*), intent(in) :: path

      state_of_path = state_of(from_working_directory, trim(path)//c_null_char, 0)
   end function state_of_path

   !> What an open file is.
   type(file_state_t) function state_of_descriptor(descriptor)
      integer(c_int), intent(in) :: descriptor

      state_of_descriptor = state_of(descriptor, c_null_char, path_is_empty)
   end function state_of_descriptor

   type(file_state_t) function state_of(directory, path, flags) result(state)
      integer(c_int), intent(in) :: directory
      character(*), intent(in) :: path
      integer(c_int), intent(in) :: flags
      type(statx_t) :: facts

      state%exists = c_statx(directory, path, flags, basic_facts, facts) == 0
      if (.not. state%exists) return
      state%is_file = iand(int(facts%mode), type_bits) == regular_file
      state%is_folder = iand(int(facts%mode), type_bits) == folder
      state%is_link = iand(int(facts%mode), type_bits) == link
      state%bytes = facts%bytes
      state%number = facts%number
      state%device = facts%device
   end function state_of

   !> Whether a path is a directory.
   logical function is_directory(path)
      character(*), intent(in) :: path
      type(file_state_t) :: state

      state = state_of_path(path)
      is_directory = state%is_folder
   end function is_directory

   !> Whether a path is a link, wherever it leads.
   logical function is_link(path)
      character(*), intent(in) :: path
      type(file_state_t) :: state

      state = state_of(from_working_directory, trim(path)//c_null_char, link_itself)
      is_link = state%is_link
   end function is_link

   !> Whether an open file is the one that stands at a path.
   logical function stands_at(descriptor, path)
      integer(c_int), intent(in) :: descriptor
      character(*), intent(in) :: path
      type(file_state_t) :: open_one, at_path

      open_one = state_of_descriptor(descriptor)
      at_path = state_of_path(path)
      stands_at = open_one%exists .and. at_path%exists .and. open_one%number == at_path%number .and. &
                  all(open_one%device == at_path%device)
   end function stands_at

   !> Paths of the files that are called like a pattern, in their order.
   subroutine found_files(folder_and_start, pattern, paths)
      !> What all of them begin with, as it stands
      character(*), intent(in) :: folder_and_start
      !> What follows, as a shell has it
      character(*), intent(in) :: pattern
      type(word_t), allocatable, intent(out) :: paths(:)
      type(glob_t) :: answer
      type(c_ptr), pointer :: places(:)
      character(kind=c_char), pointer :: letters(:)
      character(:), allocatable :: quoted
      integer, parameter :: longest_path = 4096
      integer :: i, j, length

      allocate (paths(0))
      quoted = ''
      do i = 1, len(folder_and_start)
         if (index('*?[]\', folder_and_start(i:i)) > 0) quoted = quoted//'\'
         quoted = quoted//folder_and_start(i:i)
      end do
      answer = glob_t(0_c_size_t, c_null_ptr, 0_c_size_t, 0_c_int, c_null_funptr)
      if (c_glob(quoted//pattern//c_null_char, 0_c_int, c_null_funptr, answer) /= 0) return
      call c_f_pointer(answer%paths, places, [answer%count])
      deallocate (paths)
      allocate (paths(size(places)))
      do i = 1, size(places)
         call c_f_pointer(places(i), letters, [longest_path])
         length = 0
         do while (letters(length + 1) /= c_null_char)
            length = length + 1
         end do
         allocate (character(length) :: paths(i)%text)
         do j = 1, length
            paths(i)%text(j:j) = letters(j)
         end do
      end do
      call c_globfree(answer)
   end subroutine found_files

   !> Sixteen letters that no one can foresee.
   function random_word() result(word)
      character(16) :: word
      integer(c_int64_t) :: number
      integer(c_size_t) :: got

      got = c_getrandom(number, 8_c_size_t, 0_c_int)
      ! Without a source of randomness the moment makes names that are new all the same.
      if (got /= 8_c_size_t) call system_clock(number)
      write (word, '(z16.16)') number
      do got = 1_c_size_t, 16_c_size_t
         if (word(got:got) >= 'A') word(got:got) = achar(iachar(word(got:got)) + 32)
      end do
   end function random_word

   !> Whether a file lies in a folder or below it, wherever links and '..' on the way to both lead. One that is not there
   !> lies nowhere else.
   logical function lies_inside(path, folder)
      !> Path of the file
      character(*), intent(in) :: path
      !> Path of the folder; empty: the working directory
      character(*), intent(in) :: folder
      character(:), allocatable :: place, base

      place = real_path(path)
      base = real_path(folder//'.')
      if (base(len(base):) /= '/') base = base//'/'
      lies_inside = len(place) == 0 .or. index(place, base) == 1
   end function lies_inside

   !> Path without links and '..'; empty if nothing can be found there.
   function real_path(path)
      character(*), intent(in) :: path
      character(:), allocatable :: real_path
      integer, parameter :: longest_path = 4096
      character(longest_path) :: buffer

      real_path = ''
      if (c_associated(c_realpath(trim(path)//c_null_char, buffer))) real_path = buffer(:index(buffer, c_null_char) - 1)
   end function real_path

   !> Whether files can be made in a directory.
   logical function is_writable(directory)
      !> Existing directory
      character(*), intent(in) :: directory

      is_writable = c_access(trim(directory)//c_null_char, test_write_and_enter) == 0
   end function is_writable

   !> Make a directory and those above it that are missing.
   subroutine make_directory(path, made)
      !> Path of the directory
      character(*), intent(in) :: path
      !> Whether it stands now
      logical, intent(out) :: made
      integer(c_int), parameter :: mode = 511
      integer(c_int) :: ignored
      integer :: i

      do i = 2, len_trim(path)
         if (path(i:i) /= '/') cycle
         ignored = c_mkdir(path(:i - 1)//c_null_char, mode)
      end do
      ignored = c_mkdir(trim(path)//c_null_char, mode)
      made = is_directory(path)
   end subroutine make_directory

   !> Move a file over another in one step.
   subroutine rename_file(from, to, moved)
      !> Present path
      character(*), intent(in) :: from
      !> New path; a file that stands there is replaced
      character(*), intent(in) :: to
      !> Whether it worked
      logical, intent(out) :: moved

      moved = c_rename(trim(from)//c_null_char, trim(to)//c_null_char) == 0
   end subroutine rename_file

   !> Move a file to a path where nothing stands, in one step.
   subroutine rename_new(from, to, moved)
      !> Present path
      character(*), intent(in) :: from
      !> New path
      character(*), intent(in) :: to
      !> Whether it worked; .false. if something stands there
      logical, intent(out) :: moved
      logical :: stands

      moved = c_renameat2(from_working_directory, trim(from)//c_null_char, from_working_directory, trim(to)//c_null_char, &
                          replace_nothing) == 0
      if (moved) return
      ! Some file systems cannot look and move in one step.
      stands = path_exists(to)
      if (.not. stands) call rename_file(from, to, moved)
   end subroutine rename_new

   !> Delete a file, if it is there.
   subroutine delete_file(path)
      character(*), intent(in) :: path
      integer(c_int) :: ignored

      ignored = c_unlink(trim(path)//c_null_char)
   end subroutine delete_file

   !> Whether standard output is a terminal.
   logical function is_terminal()
      is_terminal = c_isatty(standard_output) /= 0
   end function is_terminal

end module file_system
