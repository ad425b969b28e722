!> A tiny test driver: checks are counted, failures are reported with their numbers, nothing stops.
module checks
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
   use kinds, only: dp, int64
   implicit none(type, external)
   private

   !> Outcome of a list of checks.
   type, public :: check_list_t
      integer :: passed = 0
      integer :: failed = 0
      !> Name of the module under test, printed with a failure
      character(40) :: topic = ''
      !> Only checks whose sentence has these words are made, and each is printed; blank: all are, in silence
      character(:), allocatable :: wanted
   contains
      procedure :: start => start_topic
      procedure :: check => check_condition
      procedure :: check_close
      procedure, private :: is_wanted
   end type check_list_t

   public :: same_bits

contains

   !> Name what is tested next.
   subroutine start_topic(self, topic)
      class(check_list_t), intent(inout) :: self
      !> Name of the module under test
      character(*), intent(in) :: topic

      self%topic = topic
   end subroutine start_topic

   !> Count a condition.
   subroutine check_condition(self, condition, message)
      class(check_list_t), intent(inout) :: self
      !> What must hold
      logical, intent(in) :: condition
      !> What it says
      character(*), intent(in) :: message

      if (.not. self%is_wanted(message)) return
      if (condition) then
         self%passed = self%passed + 1
      else
         self%failed = self%failed + 1
         print '(4a)', 'FAILED ', trim(self%topic), ': ', message
      end if
   end subroutine check_condition

   !> Count a comparison of two numbers; NaN on either side fails.
   subroutine check_close(self, actual, expected, tolerance, message)
      class(check_list_t), intent(inout) :: self
      !> Number under test
      real(dp), intent(in) :: actual
      !> What it should be
      real(dp), intent(in) :: expected
      !> Largest allowed absolute difference
      real(dp), intent(in) :: tolerance
      !> What is compared
      character(*), intent(in) :: message

      if (.not. self%is_wanted(message)) return
      if (abs(actual - expected) <= tolerance) then
         self%passed = self%passed + 1
      else
         self%failed = self%failed + 1
         print '(4a, 3(a, es24.16))', 'FAILED ', trim(self%topic), ': ', message, ': got', actual, ', expected', expected, &
            ', tolerance', tolerance
      end if
   end subroutine check_close

   !> Whether a check is to be made; what is asked for by its words is printed too.
   logical function is_wanted(self, message)
      class(check_list_t), intent(in) :: self
      !> What the check says
      character(*), intent(in) :: message

      is_wanted = .true.
      if (.not. allocated(self%wanted)) return
      if (self%wanted == '') return
      is_wanted = index(message, self%wanted) > 0
      if (is_wanted) print '(4a)', 'check  ', trim(self%topic), ': ', message
   end function is_wanted

   !> Whether two numbers are finite and the same to the last bit.
   elemental logical function same_bits(x, y)
      !> A number
      real(dp), intent(in) :: x
      !> Another one
      real(dp), intent(in) :: y

      same_bits = ieee_is_finite(x) .and. transfer(x, 1_int64) == transfer(y, 1_int64)
   end function same_bits

end module checks
