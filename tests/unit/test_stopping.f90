!> Tests of work that must stop: the engine leaves its motions at the start of a period, a table is left half read.
module test_stopping
   use, intrinsic :: iso_c_binding, only: c_int
   use canonical_scenes, only: canonical_scene
   use checks, only: check_list_t, same_bits
   use csv_samples, only: csv_samples_t, read_csv_samples
   use engine, only: ending_t, motion_state_t, request_t, start_of
   use errors, only: fault_list_t
   use kinds, only: dp, int64
   use many_motions, only: solve_motions
   use problem, only: of_film, problem_of, problem_t
   use scene_status, only: status_complete, status_interrupted
   use scene_types, only: law_iso_viscous, scene_t
   use signals, only: lift_time_limit, limit_time, must_stop
   implicit none(type, external)
   private

   interface
      function c_raise(number) bind(c, name='raise') result(failed)
         import :: c_int
         integer(c_int), value :: number
         integer(c_int) :: failed
      end function c_raise
   end interface

   public :: run_stopping_tests

contains

   !> Runs every test of this topic.
   subroutine run_stopping_tests(checks)
      !> Collects the results
      type(check_list_t), intent(inout) :: checks

      call checks%start('stopping')
      call test_limit(checks)
      call test_motions(checks)
      call test_table(checks)
   end subroutine run_stopping_tests

   !> The end of a time limit, without waiting for it.
   subroutine end_time()
      integer(c_int), parameter :: signal_alarm = 14_c_int
      integer(c_int) :: failed

      call limit_time(1000)
      failed = c_raise(signal_alarm)
   end subroutine end_time

   subroutine test_limit(checks)
      type(check_list_t), intent(inout) :: checks

      call checks%check(.not. must_stop(), 'nothing asks to stop')
      call limit_time(1000)
      call checks%check(.not. must_stop(), 'there is time')
      call end_time()
      call checks%check(must_stop(), 'the time is up')
      call limit_time(1000)
      call checks%check(.not. must_stop(), 'a new limit')
      call end_time()
      call lift_time_limit()
      call checks%check(.not. must_stop(), 'no limit any more')
   end subroutine test_limit

   !> More scenes than lanes, by series and by collocation: all are where they began, none of them counts as solved.
   subroutine test_motions(checks)
      type(check_list_t), intent(inout) :: checks
      integer, parameter :: scenes = 20
      type(scene_t) :: scene
      type(problem_t) :: lanes(scenes)
      type(motion_state_t) :: starts(scenes)
      type(request_t) :: request
      type(ending_t) :: endings(scenes)
      real(dp) :: states(64, 2, scenes)
      integer :: i

      scene = canonical_scene(law_iso_viscous, 64)
      lanes = problem_of(scene)
      starts = start_of(lanes)
      starts(15:)%implicit = .true.
      request = request_t(accuracy=1.0e-6_dp, periods=3, samples_per_period=64, sampled_periods=1)
      states = 0.0_dp
      call end_time()
      call solve_motions(lanes, starts, request, states, endings)
      call lift_time_limit()
      call checks%check(all(endings%status == status_interrupted), 'motions: interrupted')
      call checks%check(all(endings%periods == 0 .and. endings%samples == 0), 'motions: nothing solved')
      call checks%check(all(same_bits([(endings(i)%numbers(of_film), i=1, size(endings))], lanes%initial_film)), &
                        'motions: where they began')
      call solve_motions(lanes, starts, request, states, endings)
      call checks%check(all(endings%status == status_complete .and. endings%periods == 3), 'motions: solved in the end')
   end subroutine test_motions

   subroutine test_table(checks)
      type(check_list_t), intent(inout) :: checks
      character(*), parameter :: path = 'rattle_test_table_cut.csv'
      type(csv_samples_t) :: samples
      type(fault_list_t) :: faults
      integer :: unit, i

      open (newunit=unit, file=path, status='replace', action='write')
      write (unit, '(a)') 'load.mass', ('1.5', i=1, 100)
      close (unit)
      call end_time()
      call read_csv_samples(path, samples, faults)
      call lift_time_limit()
      call checks%check(faults%count() == 0, 'table: a stop is no fault')
      call checks%check(samples%read == 0_int64 .and. size(samples%values, 2) == 100, 'table: counted, not read')
      call read_csv_samples(path, samples, faults)
      call checks%check(samples%read == 100_int64, 'table: all read')
      open (newunit=unit, file=path)
      close (unit, status='delete')
   end subroutine test_table

end module test_stopping
