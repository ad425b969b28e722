!> &load signal: one cycle of a force from a CSV file becomes mean, orders, amplitudes and phases, as if the input gave them.
module force_signal
   use csv_signal, only: read_csv_signal
   use errors, only: fault_list_t
   use fourier, only: trigonometric_interpolation
   use key_table, only: find_key
   use keys_in_use, only: in_use
   use kinds, only: dp
   use scene_input, only: scene_input_t
   use scene_types, only: highest_order
   use text, only: integer_text, printable, short_text
   use word_list, only: word_t
   implicit none(type, external)
   private

   character(*), parameter :: shape_keys(5) = [character(16) :: 'force_amplitude', 'force_orders', 'force_amplitudes', &
                                               'force_phases', 'force_mean'], &
                              signal_keys(3) = [character(16) :: 'signal', 'signal_column', 'signal_orders']

   public :: take_signal

contains

   !> Put what a signal gives into the keys of the force, and the keys of the signal away.
   subroutine take_signal(input, notes, faults)
      !> Typed values
      type(scene_input_t), intent(inout) :: input
      !> A line on what was made of the signal is appended
      type(word_t), allocatable, intent(inout) :: notes(:)
      !> Faults are appended
      type(fault_list_t), intent(inout) :: faults
      real(dp), allocatable :: samples(:), amplitudes(:), phases(:)
      character(:), allocatable :: path, column
      real(dp) :: mean
      integer :: i, before, last

      if (.not. input%is_given('load', 'signal')) then
         do i = 2, size(signal_keys)
            if (input%is_given('load', trim(signal_keys(i)))) call input%add_fault('load', trim(signal_keys(i)), &
                                                                'this key is used only with signal; leave it out', faults)
         end do
         return
      end if
      before = faults%count()
      do i = 1, size(shape_keys)
         if (input%is_given('load', trim(shape_keys(i)))) call input%add_fault('load', trim(shape_keys(i)), &
                                                         'the signal gives the force; leave this key or the signal out', faults)
      end do
      if (any([(input%is_faulty('load', trim(signal_keys(i))), i=1, 3)])) return
      if (.not. in_use(input, find_key('load', 'signal'))) return
      path = input%word('load', 'signal')
      if (path(1:1) /= '/') path = input%file(:index(input%file, '/', back=.true.))//path
      call read_csv_signal(path, input%word('load', 'signal_column'), column, samples, faults)
      if (faults%count() > before) return
      call trigonometric_interpolation(samples, mean, amplitudes, phases)
      last = kept_orders()
      notes = [notes, note()]
      call put('force_orders', [(real(i, dp), i=1, last)])
      call put('force_amplitudes', amplitudes(:last))
      call put('force_phases', phases(:last))
      associate (entry => input%entries(find_key('load', 'force_mean')))
         entry%given = .true.
         entry%present = .true.
         entry%number = mean
      end associate
      do i = 1, size(signal_keys)
         associate (entry => input%entries(find_key('load', trim(signal_keys(i)))))
            entry%given = .false.
            entry%present = .false.
         end associate
      end do

   contains

      !> How many orders are kept: what was asked for, or what holds nearly all of the power.
      integer function kept_orders()
         real(dp), parameter :: most_dropped = 1.0e-6_dp

         if (input%is_given('load', 'signal_orders')) then
            kept_orders = min(input%count('load', 'signal_orders'), size(amplitudes))
            return
         end if
         do kept_orders = 1, min(size(amplitudes), highest_order) - 1
            if (dropped_share(kept_orders) <= most_dropped) return
         end do
      end function kept_orders

      !> Share of the power of what oscillates that lies beyond an order [-].
      real(dp) function dropped_share(kept)
         integer, intent(in) :: kept

         dropped_share = sum((amplitudes(kept + 1:)/maxval(amplitudes))**2)/sum((amplitudes/maxval(amplitudes))**2)
      end function dropped_share

      !> What was made of the signal.
      type(word_t) function note()
         note%text = 'signal '//printable(path, .false.)//", column '"//column//"': "//integer_text(size(samples))// &
                 ' samples; orders 1 to '//integer_text(last)//' are kept, '//short_text(100.0_dp*dropped_share(last), 2)// &
                 ' % of its power is dropped; its mean of '//short_text(mean, 5)//' N is added to steady_force'
      end function note

      !> Give a list of the force its numbers, at the place of the signal.
      subroutine put(name, numbers)
         character(*), intent(in) :: name
         real(dp), intent(in) :: numbers(:)

         associate (entry => input%entries(find_key('load', name)), signal => input%entries(find_key('load', 'signal')))
            entry%given = .true.
            entry%present = .true.
            entry%file = signal%file
            entry%line = signal%line
            entry%numbers = numbers
         end associate
      end subroutine put

   end subroutine take_signal

end module force_signal
