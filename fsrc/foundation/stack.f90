!> The stack that the program runs on is given by its shell and by OpenMP: a lack of it is an error with a sentence, before it becomes a
!> crash. Thin calls of the C library, which know every spelling of a limit.
module stack
   use, intrinsic :: iso_c_binding, only: c_int, c_long, c_size_t
   use errors, only: error_t, exit_system, raise
   use kinds, only: int64
   use text, only: integer_text
   use, intrinsic :: omp_lib, only: omp_get_thread_num
   implicit none(type, external)
   private

   !> What is asked for [bytes]: four times what the ready inputs were measured to take, and half of what Linux gives at least to a
   !> thread whose stack no one limits.
   integer(int64), parameter :: needed_bytes = 2_int64**20
   integer(c_int), parameter :: limit_of_stack = 3
   !> More than the properties of a thread take on any machine
   integer, parameter :: attribute_words = 32

   public :: expect_stack, expect_stacks_of_threads

   interface
      function c_getrlimit(resource, limits) bind(c, name='getrlimit') result(stat)
         import :: c_int, c_long
         integer(c_int), value :: resource
         integer(c_long), intent(out) :: limits(2)
         integer(c_int) :: stat
      end function c_getrlimit

      function c_pthread_self() bind(c, name='pthread_self') result(thread)
         import :: c_long
         integer(c_long) :: thread
      end function c_pthread_self

      function c_pthread_getattr_np(thread, properties) bind(c, name='pthread_getattr_np') result(stat)
         import :: c_int, c_long
         integer(c_long), value :: thread
         integer(c_long), intent(inout) :: properties(*)
         integer(c_int) :: stat
      end function c_pthread_getattr_np

      function c_pthread_attr_getstacksize(properties, bytes) bind(c, name='pthread_attr_getstacksize') result(stat)
         import :: c_int, c_long, c_size_t
         integer(c_long), intent(in) :: properties(*)
         integer(c_size_t), intent(out) :: bytes
         integer(c_int) :: stat
      end function c_pthread_attr_getstacksize

      function c_pthread_attr_destroy(properties) bind(c, name='pthread_attr_destroy') result(stat)
         import :: c_int, c_long
         integer(c_long), intent(inout) :: properties(*)
         integer(c_int) :: stat
      end function c_pthread_attr_destroy
   end interface

contains

   !> See that there is stack enough for the thread that the program begins with.
   subroutine expect_stack(error)
      !> Set if there is not
      type(error_t), allocatable, intent(out) :: error
      integer(c_long) :: limits(2)

      if (c_getrlimit(limit_of_stack, limits) /= 0) return
      ! No limit is a negative number.
      if (limits(1) < 0_c_long .or. limits(1) >= needed_bytes) return
      call raise(error, exit_system, 'the stack is limited to '//kilobytes(int(limits(1), int64))//' (ulimit -s), and rattle '// &
                 'needs '//kilobytes(needed_bytes)//'; type ulimit -s 8192, the usual limit')
   end subroutine expect_stack

   !> Start the threads, and see that each of them has stack enough.
   subroutine expect_stacks_of_threads(error)
      !> Set if one has not
      type(error_t), allocatable, intent(out) :: error
      integer(int64) :: least

      least = needed_bytes
      !$omp parallel default(shared) reduction(min: least)
      if (omp_get_thread_num() > 0) least = own_stack()
      !$omp end parallel
      if (least >= needed_bytes) return
      call raise(error, exit_system, 'a thread has a stack of '//kilobytes(least)//' (OMP_STACKSIZE or GOMP_STACKSIZE), and '// &
                 'rattle needs '//kilobytes(needed_bytes)//'; unset the variable, or set OMP_STACKSIZE=8M')
   end subroutine expect_stacks_of_threads

   !> Stack of this thread [bytes]; what is not known is enough.
   integer(int64) function own_stack()
      integer(c_long) :: properties(attribute_words)
      integer(c_size_t) :: bytes
      integer(c_int) :: ignored

      own_stack = needed_bytes
      properties = 0_c_long
      if (c_pthread_getattr_np(c_pthread_self(), properties) /= 0) return
      if (c_pthread_attr_getstacksize(properties, bytes) == 0) own_stack = int(bytes, int64)
      ignored = c_pthread_attr_destroy(properties)
   end function own_stack

   pure function kilobytes(bytes) result(words)
      integer(int64), intent(in) :: bytes
      character(:), allocatable :: words

      words = integer_text(bytes/1024_int64)//' kB'
   end function kilobytes

end module stack
