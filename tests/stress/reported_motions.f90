!> What the program reports of the random gear scenes of stress_motions, alone and in the middle of a grid, for another build to be
!> compared with (compare_motions.py).
!>
!>    reported_motions FILE.csv [SCENES [FIRST]]
program reported_motions
   use, intrinsic :: iso_fortran_env, only: int64
   use coexisting_motions, only: coexisting_motions_t
   use gear_motions, only: draw_gear_scene, gear_scene_t, motions_reported, read_pairs, row_reported, reported_row_t
   use kinds, only: dp
   use scene_types, only: scene_t
   implicit none(type, external)

   character(*), parameter :: row_form = '(i0, 2(",", a), 5(",", i0), ",", es14.6, ",", f0.3)'
   type(scene_t), allocatable :: pairs(:)
   integer(int64) :: arguments(2), number
   character(512) :: path, word
   integer :: unit, i

   arguments = [282_int64, 0_int64]
   call get_command_argument(1, path)
   do i = 1, min(2, command_argument_count() - 1)
      call get_command_argument(1 + i, word)
      read (word, *) arguments(i)
   end do
   if (path == '') error stop 'usage: reported_motions FILE.csv [SCENES [FIRST]]'
   call read_pairs(pairs)
   open (newunit=unit, file=trim(path), status='replace', action='write')
   write (unit, '(a)') 'scene,way,what,count,period,unsettled,starts,periods,rms,seconds'
   do number = arguments(2), arguments(2) + arguments(1) - 1_int64
      call run_scene(number)
      flush (unit)
   end do
   close (unit)

contains

   !> One scene.
   subroutine run_scene(number)
      integer(int64), intent(in) :: number
      type(gear_scene_t) :: drawn
      type(coexisting_motions_t) :: reported
      type(reported_row_t) :: row
      real(dp) :: times(3), none
      integer :: periods(2), k
      logical :: judged

      none = 0.0_dp
      call draw_gear_scene(pairs, 1_int64, number, drawn)
      call cpu_time(times(1))
      call motions_reported(drawn, reported, periods, judged)
      call cpu_time(times(2))
      call row_reported(drawn, row)
      call cpu_time(times(3))
      if (judged) then
         write (unit, row_form) number, 'alone', 'all', size(reported%motions), 0, reported%unsettled_starts, &
            reported%starts_solved, periods(2), none, times(2) - times(1)
         do k = 1, size(reported%motions)
            associate (motion => reported%motions(k))
               write (unit, row_form) number, 'alone', 'motion', motion%class, motion%period, 0, motion%starts, 0, &
                  motion%acceleration_rms, none
            end associate
         end do
      end if
      if (.not. row%judged) return
      write (unit, row_form) number, 'row', 'all', row%motions, 0, row%unsettled, row%starts, 0, row%rest_rms, times(3) - times(2)
      write (unit, row_form) number, 'row', 'motion', 0, 1, 0, 0, 0, row%rest_rms, none
      write (unit, row_form) number, 'row', 'motion', 0, 1, 0, 0, 0, row%loudest_rms, none
      write (unit, row_form) number, 'row', 'motion', 0, 1, 0, 0, 0, row%quietest_rms, none
   end subroutine run_scene

end program reported_motions
