!> Open files by their descriptors: what is interrupted by a signal is repeated, what is done in part is carried
!> on, and every failure is seen; last_error then says why. Thin calls of the C library.
module file_descriptor
   use, intrinsic :: iso_c_binding, only: c_char, c_int, c_long, c_null_char, c_short, c_size_t
   use errors, only: interrupted_call, invalid_call, last_error
   use kinds, only: int64
   use signals, only: caught_signal
   implicit none(type, external)
   private

   !> How an existing file is opened.
   integer(c_int), parameter, public :: read_only = 0, read_and_write = 2
   integer(c_int), parameter, public :: standard_input = 0, standard_output = 1, standard_error = 2
   integer(c_int), parameter :: read_and_write_for_all = 438
   !> Bits that say how a file is opened, as Linux has them.
   integer(c_int), parameter :: write_only = 1, make_missing = 64, only_new = 128, follow_no_link = 131072, name_only = 2097152

   !> What a pipe takes without waiting once it takes anything [bytes]
   integer(int64), parameter :: pipe_bytes = 4096_int64
   integer(c_short), parameter :: can_be_written = 4_c_short

   !> What poll is asked.
   type, bind(c) :: poll_t
      integer(c_int) :: descriptor
      integer(c_short) :: events, found
   end type poll_t

   interface
      function c_poll(files, count, milliseconds) bind(c, name='poll') result(ready)
         import :: c_int, c_long, poll_t
         type(poll_t), intent(inout) :: files
         integer(c_long), value :: count
         integer(c_int), value :: milliseconds
         integer(c_int) :: ready
      end function c_poll

      function c_open(path, flags, mode) bind(c, name='open') result(descriptor)
         import :: c_char, c_int
         character(kind=c_char), intent(in) :: path(*)
         integer(c_int), value :: flags
         integer(c_int), value :: mode
         integer(c_int) :: descriptor
      end function c_open

      function c_close(descriptor) bind(c, name='close') result(stat)
         import :: c_int
         integer(c_int), value :: descriptor
         integer(c_int) :: stat
      end function c_close

      function c_fsync(descriptor) bind(c, name='fsync') result(stat)
         import :: c_int
         integer(c_int), value :: descriptor
         integer(c_int) :: stat
      end function c_fsync

      function c_read(descriptor, bytes, count) bind(c, name='read') result(got)
         import :: c_char, c_int, c_size_t
         integer(c_int), value :: descriptor
         character(kind=c_char), intent(out) :: bytes(*)
         integer(c_size_t), value :: count
         integer(c_size_t) :: got
      end function c_read

      function c_pread(descriptor, bytes, count, offset) bind(c, name='pread') result(got)
         import :: c_char, c_int, c_long, c_size_t
         integer(c_int), value :: descriptor
         character(kind=c_char), intent(out) :: bytes(*)
         integer(c_size_t), value :: count
         integer(c_long), value :: offset
         integer(c_size_t) :: got
      end function c_pread

      function c_write(descriptor, bytes, count) bind(c, name='write') result(written)
         import :: c_char, c_int, c_size_t
         integer(c_int), value :: descriptor
         character(kind=c_char), intent(in) :: bytes(*)
         integer(c_size_t), value :: count
         integer(c_size_t) :: written
      end function c_write

      function c_pwrite(descriptor, bytes, count, offset) bind(c, name='pwrite') result(written)
         import :: c_char, c_int, c_long, c_size_t
         integer(c_int), value :: descriptor
         character(kind=c_char), intent(in) :: bytes(*)
         integer(c_size_t), value :: count
         integer(c_long), value :: offset
         integer(c_size_t) :: written
      end function c_pwrite
   end interface

   public :: reserve_standard_descriptors, open_existing, open_new, open_or_make, synchronise_descriptor, close_descriptor, &
             read_bytes, write_bytes

contains

   !> Take the standard descriptors that whoever started the program has closed, before any file becomes one of them: what is for the
   !> terminal would be written into it. Reading and writing fail there as they do where nothing is open.
   subroutine reserve_standard_descriptors(output_is_closed)
      !> Whether the standard output was closed
      logical, intent(out) :: output_is_closed
      integer(c_int) :: descriptor
      logical :: ignored

      output_is_closed = .false.
      do
         ! The lowest free one is taken; the root folder is always there.
         descriptor = c_open('/'//c_null_char, name_only, 0_c_int)
         output_is_closed = output_is_closed .or. descriptor == standard_output
         if (descriptor < 0 .or. descriptor > standard_error) exit
      end do
      if (descriptor > standard_error) call close_descriptor(descriptor, ignored)
   end subroutine reserve_standard_descriptors

   !> Open a file that is there; a negative descriptor: it cannot be opened. A link is followed only to read.
   integer(c_int) function open_existing(path, access) result(descriptor)
      !> Path, without blanks behind it
      character(*), intent(in) :: path
      !> read_only or read_and_write
      integer(c_int), intent(in) :: access

      descriptor = c_open(path//c_null_char, merge(access, ior(access, follow_no_link), access == read_only), 0_c_int)
   end function open_existing

   !> Make a file for writing; a negative descriptor: it cannot be made, or something stands there, be it a link to nowhere.
   integer(c_int) function open_new(path) result(descriptor)
      !> Path, without blanks behind it
      character(*), intent(in) :: path

      descriptor = c_open(path//c_null_char, ior(ior(write_only, follow_no_link), ior(make_missing, only_new)), &
                          read_and_write_for_all)
   end function open_new

   !> Open a file for reading and writing, whatever it holds, and make it if it is missing; a negative descriptor: it cannot be
   !> opened, or is a link.
   integer(c_int) function open_or_make(path) result(descriptor)
      !> Path, without blanks behind it
      character(*), intent(in) :: path

      descriptor = c_open(path//c_null_char, ior(ior(read_and_write, follow_no_link), make_missing), read_and_write_for_all)
   end function open_or_make

   !> See that everything written stands on the disk itself.
   subroutine synchronise_descriptor(descriptor, stands)
      integer(c_int), intent(in) :: descriptor
      !> Whether it does; also where the file system cannot say
      logical, intent(out) :: stands

      do
         stands = c_fsync(descriptor) == 0
         if (stands) return
         if (last_error() == interrupted_call) cycle
         stands = last_error() == invalid_call
         return
      end do
   end subroutine synchronise_descriptor

   !> Close a file.
   subroutine close_descriptor(descriptor, closed)
      integer(c_int), intent(in) :: descriptor
      !> Whether everything written is taken; a disk across the network may report only now that it is full
      logical, intent(out) :: closed

      closed = c_close(descriptor) == 0
   end subroutine close_descriptor

   !> Read bytes, in as many calls as it takes.
   subroutine read_bytes(descriptor, count, bytes, got, failed, offset)
      integer(c_int), intent(in) :: descriptor
      !> Bytes that are asked for
      integer(int64), intent(in) :: count
      !> Filled from the left
      character(kind=c_char), intent(out) :: bytes(count)
      !> How many were read; fewer than asked for where the file ends or reading fails
      integer(int64), intent(out) :: got
      !> Whether it failed
      logical, intent(out) :: failed
      !> Bytes before them; absent: from where the last call ended
      integer(int64), optional, intent(in) :: offset
      integer(c_size_t) :: part

      got = 0_int64
      failed = .false.
      do while (got < count)
         if (present(offset)) then
            part = c_pread(descriptor, bytes(got + 1_int64:), int(count - got, c_size_t), int(offset + got, c_long))
         else
            part = c_read(descriptor, bytes(got + 1_int64:), int(count - got, c_size_t))
         end if
         if (part > 0_c_size_t) then
            got = got + int(part, int64)
            cycle
         end if
         failed = part < 0_c_size_t
         if (.not. failed) return
         if (last_error() /= interrupted_call) return
         failed = .false.
      end do
   end subroutine read_bytes

   !> Write bytes, in as many calls as it takes.
   subroutine write_bytes(descriptor, count, bytes, complete, offset)
      integer(c_int), intent(in) :: descriptor
      !> Their number
      integer(int64), intent(in) :: count
      character(kind=c_char), intent(in) :: bytes(count)
      !> Whether all were written; .false. if the disk is full, say
      logical, intent(out) :: complete
      !> Bytes before them; absent: from where the last call ended
      integer(int64), optional, intent(in) :: offset
      integer(int64) :: done
      integer(c_size_t) :: part

      done = 0_int64
      do while (done < count)
         if (descriptor <= standard_error) then
            if (.not. takes_bytes(descriptor)) exit
            part = c_write(descriptor, bytes(done + 1_int64:), int(min(pipe_bytes, count - done), c_size_t))
         else if (present(offset)) then
            part = c_pwrite(descriptor, bytes(done + 1_int64:), int(count - done, c_size_t), int(offset + done, c_long))
         else
            part = c_write(descriptor, bytes(done + 1_int64:), int(count - done, c_size_t))
         end if
         if (part > 0_c_size_t) then
            done = done + int(part, int64)
         else if (part == 0_c_size_t) then
            exit
         else if (last_error() /= interrupted_call) then
            exit
         end if
      end do
      complete = done == count
   end subroutine write_bytes

   !> Wait until a standard descriptor takes bytes. Where no one reads, a signal ends the waiting.
   logical function takes_bytes(descriptor)
      integer(c_int), intent(in) :: descriptor
      !> A signal may come between the look at it and the waiting [ms]
      integer(c_int), parameter :: longest_wait = 500_c_int
      type(poll_t) :: file
      integer(c_int) :: ready

      do
         file = poll_t(descriptor, can_be_written, 0_c_short)
         ready = c_poll(file, 1_c_long, merge(0_c_int, longest_wait, caught_signal() /= 0))
         takes_bytes = ready > 0
         ! What cannot be waited for is for the writing to fail at.
         if (ready < 0) takes_bytes = last_error() /= interrupted_call
         if (takes_bytes .or. caught_signal() /= 0) return
      end do
   end function takes_bytes

end module file_descriptor
