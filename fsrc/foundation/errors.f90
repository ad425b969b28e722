!> Errors as values: one error, and a list of faults found in an input.
!> Only the main program turns them into an exit code. And why the last call of the operating system failed.
module errors
   use, intrinsic :: iso_c_binding, only: c_char, c_f_pointer, c_int, c_ptr, c_size_t
   use text, only: integer_text, printable
   implicit none(type, external)
   private

   !> Exit codes of the program.
   integer, parameter, public :: exit_complete = 0
   integer, parameter, public :: exit_scene_failed = 1
   integer, parameter, public :: exit_bad_input = 2
   integer, parameter, public :: exit_system = 3

   !> One failure: what exit code it leads to and a plain sentence.
   type, public :: error_t
      integer :: exit_code = exit_system
      character(:), allocatable :: message
   end type error_t

   !> A file that is no input at all could have millions of faults.
   integer, parameter :: most_faults = 1000

   type :: fault_t
      character(:), allocatable :: sentence
      integer :: line = 0
   end type fault_t

   !> All faults of the inputs of a call, each a full sentence that starts with its place.
   type, public :: fault_list_t
      private
      type(fault_t), allocatable :: faults(:)
      !> How many are kept, and how many came after the list was full
      integer :: used = 0
      integer :: beyond = 0
      !> Exit code that they lead to together
      integer, public :: exit_code = exit_bad_input
   contains
      procedure :: add => add_fault
      procedure :: add_error
      procedure :: take
      procedure :: count => count_faults
      procedure :: not_kept => count_faults_beyond
      procedure :: sentence => fault_sentence
      procedure :: sort_since => sort_faults_by_line
   end type fault_list_t

   public :: raise, last_error, error_words, is_shortage

   !> Failures of calls of the operating system.
   integer(c_int), parameter, public :: interrupted_call = 4, would_wait = 11, not_permitted = 13, invalid_call = 22, &
                                        no_locks = 37, no_such_call = 38, not_supported = 95

   interface
      function c_errno_location() bind(c, name='__errno_location') result(location)
         import :: c_ptr
         type(c_ptr) :: location
      end function c_errno_location

      function c_strerror(number) bind(c, name='strerror') result(words)
         import :: c_int, c_ptr
         integer(c_int), value :: number
         type(c_ptr) :: words
      end function c_strerror

      function c_strlen(words) bind(c, name='strlen') result(length)
         import :: c_ptr, c_size_t
         type(c_ptr), value :: words
         integer(c_size_t) :: length
      end function c_strlen
   end interface

contains

   !> Set an error.
   pure subroutine raise(error, exit_code, message)
      !> Error to set
      type(error_t), allocatable, intent(out) :: error
      !> Exit code that the failure leads to
      integer, intent(in) :: exit_code
      !> Plain sentence
      character(*), intent(in) :: message

      allocate (error)
      error%exit_code = exit_code
      error%message = message
   end subroutine raise

   !> Append a fault as 'file:line: &group key: message'; what is not known is left out, and words of the input are shown as
   !> a terminal may see them.
   pure subroutine add_fault(self, file, line, group, key, message)
      class(fault_list_t), intent(inout) :: self
      !> Name of the input, as the user gave it
      character(*), intent(in) :: file
      !> Line in the input; 0: not tied to a line
      integer, intent(in) :: line
      !> Namelist group, or empty
      character(*), intent(in) :: group
      !> Key in the group, or empty
      character(*), intent(in) :: key
      !> What is wrong and what is allowed
      character(*), intent(in) :: message
      character(:), allocatable :: place

      place = printable(file, .false.)
      if (line > 0) place = place//':'//integer_text(line)
      place = place//':'
      if (len(group) > 0) place = place//' &'//group
      if (len(key) > 0) place = place//' '//key
      if (len(group) > 0 .or. len(key) > 0) place = place//':'
      call keep(self, fault_t(place//' '//printable(message, .true.), line))
   end subroutine add_fault

   !> Append a fault, or count it where the list is full.
   pure subroutine keep(self, fault)
      class(fault_list_t), intent(inout) :: self
      type(fault_t), intent(in) :: fault
      type(fault_t), allocatable :: grown(:)

      if (self%used == most_faults) then
         self%beyond = self%beyond + 1
         return
      end if
      if (.not. allocated(self%faults)) allocate (self%faults(16))
      if (self%used == size(self%faults)) then
         allocate (grown(2*self%used))
         grown(:self%used) = self%faults
         call move_alloc(grown, self%faults)
      end if
      self%used = self%used + 1
      self%faults(self%used) = fault
   end subroutine keep

   !> Append an error that was found while the input was looked at. One of the system is not the fault of the input.
   pure subroutine add_error(self, file, group, key, error)
      class(fault_list_t), intent(inout) :: self
      !> Place in the input, as for a fault
      character(*), intent(in) :: file
      character(*), intent(in) :: group
      character(*), intent(in) :: key
      type(error_t), intent(in) :: error

      call self%add(file, 0, group, key, error%message)
      self%exit_code = max(self%exit_code, error%exit_code)
   end subroutine add_error

   !> Append the faults of another look at the same input that are not known yet.
   pure subroutine take(self, other)
      class(fault_list_t), intent(inout) :: self
      class(fault_list_t), intent(in) :: other
      integer :: i, j, known

      known = self%used
      do i = 1, other%used
         do j = 1, known
            if (self%faults(j)%sentence == other%faults(i)%sentence) exit
         end do
         if (j > known) call keep(self, other%faults(i))
      end do
      self%beyond = max(self%beyond, other%beyond)
      self%exit_code = max(self%exit_code, other%exit_code)
   end subroutine take

   !> Number of faults that are counted but not kept.
   pure integer function count_faults_beyond(self)
      class(fault_list_t), intent(in) :: self

      count_faults_beyond = self%beyond
   end function count_faults_beyond

   !> Number of faults that are kept.
   pure integer function count_faults(self)
      class(fault_list_t), intent(in) :: self

      count_faults = self%used
   end function count_faults

   !> Sentence of one fault.
   pure function fault_sentence(self, index) result(sentence)
      class(fault_list_t), intent(in) :: self
      !> 1 to count()
      integer, intent(in) :: index
      character(:), allocatable :: sentence

      sentence = self%faults(index)%sentence
   end function fault_sentence

   !> Bring the faults after the first `before` into the order of their lines, unplaced ones last.
   pure subroutine sort_faults_by_line(self, before)
      class(fault_list_t), intent(inout) :: self
      !> Faults of earlier inputs, left where they are
      integer, intent(in) :: before
      type(fault_t) :: moving
      integer :: i, j

      do i = before + 2, self%used
         moving = self%faults(i)
         do j = i - 1, before + 1, -1
            if (line_rank(self%faults(j)) <= line_rank(moving)) exit
            self%faults(j + 1) = self%faults(j)
         end do
         self%faults(j + 1) = moving
      end do

   contains

      pure integer function line_rank(fault)
         type(fault_t), intent(in) :: fault

         line_rank = merge(fault%line, huge(1), fault%line > 0)
      end function line_rank

   end subroutine sort_faults_by_line

   !> Number of the failure of the last call in this thread.
   integer(c_int) function last_error()
      integer(c_int), pointer :: number

      call c_f_pointer(c_errno_location(), number)
      last_error = number
   end function last_error

   !> Whether a call failed because the system has no memory or open files to spare, whatever it was asked about.
   elemental logical function is_shortage(number)
      !> Number of the failure
      integer(c_int), intent(in) :: number
      integer(c_int), parameter :: no_memory = 12, too_many_files = 23, too_many_files_of_program = 24

      is_shortage = any(number == [no_memory, too_many_files, too_many_files_of_program])
   end function is_shortage

   !> What the operating system calls a failure.
   function error_words(number) result(words)
      !> Number of the failure
      integer(c_int), intent(in) :: number
      character(:), allocatable :: words
      character(kind=c_char), pointer :: letters(:)
      type(c_ptr) :: place
      integer :: i

      place = c_strerror(number)
      call c_f_pointer(place, letters, [c_strlen(place)])
      allocate (character(size(letters)) :: words)
      do i = 1, size(letters)
         words(i:i) = letters(i)
      end do
   end function error_words

end module errors
