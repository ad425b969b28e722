!> Why the last call of the operating system failed.
module system_error
   use, intrinsic :: iso_c_binding, only: c_char, c_f_pointer, c_int, c_ptr, c_size_t
   implicit none(type, external)
   private

   integer(c_int), parameter, public :: interrupted_call = 4, invalid_call = 22, no_locks = 37, no_such_call = 38, &
                                        not_supported = 95

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

   public :: last_error, error_words

contains

   !> Number of the failure of the last call in this thread.
   integer(c_int) function last_error()
      integer(c_int), pointer :: number

      call c_f_pointer(c_errno_location(), number)
      last_error = number
   end function last_error

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

end module system_error
