!> Whether a scene has the same bits alone, in any lane, among any neighbours, and on any number of threads.
!>
!>    lane_independence [--scenes N] [--seed S]
!>
!> Random scenes of all laws, failing ones among them, are solved by every engine that works in lanes: all in
!> one call, in random order, in random portions that threads share (OMP_NUM_THREADS), and one by one.
!> Samples, states and endings must agree to the last bit. The exit code is 1 if any does not.
program lane_independence
   use, intrinsic :: iso_fortran_env, only: error_unit
   use engine, only: ending_t, motion_state_t, request_t, start_of
   use kinds, only: dp, int64
   use many_motions, only: solve_motions
   use problem, only: problem_t
   use random_walk, only: next_uniform, random_permutation, random_state_t
   use random_scenes, only: draw_scene, drawn_scene_t, group_size
   use stress_engines, only: engine_names, engines
   implicit none(type, external)

   integer, parameter :: periods = 12, sampled = 8, samples = 4, values = 2*sampled*samples + 6
   !> Scenes of a portion, at most.
   integer, parameter :: largest_portion = 40
   integer(int64), parameter :: order_stream = 10_int64**12

   type(drawn_scene_t), allocatable :: drawn(:)
   integer(int64), allocatable :: together(:, :), other(:, :)
   integer, allocatable :: order(:)
   integer(int64) :: seed = 2_int64
   integer :: scenes = 2000, engine, differing, all_differing, i
   type(random_state_t) :: state

   call read_arguments()
   state = random_state_t(seed=seed, stream=order_stream)
   ! One scene of every group, or neighbours would share law and accuracy.
   allocate (drawn(scenes), order(scenes))
   do i = 1, scenes
      drawn(i) = draw_scene(seed, int(i - 1, int64)*int(group_size + 1, int64))
   end do
   all_differing = 0
   print '(a)', '| engine | scenes | other order | in portions, threads | alone |', &
      '|---|---:|---:|---:|---:|'
   do engine = 1, engines
      together = bits_of(engine, [(i, i=1, scenes)])
      call random_permutation(state, order)
      other = bits_of(engine, order)
      differing = count(any(other /= together(:, order), dim=1))
      write (*, '(a, i0, a, i0, a)', advance='no') '| '//trim(engine_names(engine))//' | ', scenes, ' | ', &
         differing, ' | '
      all_differing = all_differing + differing
      differing = differing_in_portions(engine, order, together)
      write (*, '(i0, a)', advance='no') differing, ' | '
      all_differing = all_differing + differing
      differing = 0
      !$omp parallel do schedule(dynamic) reduction(+: differing)
      do i = 1, scenes
         if (any(bits_of(engine, [i]) /= together(:, i:i))) differing = differing + 1
      end do
      !$omp end parallel do
      print '(i0, a)', differing, ' |'
      all_differing = all_differing + differing
   end do
   print '(a, i0)', 'scenes that differ: ', all_differing
   if (all_differing > 0) stop 1

contains

   !> Scenes that differ when portions of random size are solved by whatever thread comes.
   integer function differing_in_portions(engine, order, together) result(differing)
      !> Place in `engine_names`
      integer, intent(in) :: engine
      !> Order of the scenes
      integer, intent(in) :: order(:)
      !> Bits to compare with
      integer(int64), intent(in) :: together(:, :)
      integer, allocatable :: ends(:)
      real(dp) :: number
      integer :: portion, last

      allocate (ends(1), source=0)
      do while (ends(size(ends)) < size(order))
         call next_uniform(state, number)
         last = min(size(order), ends(size(ends)) + 1 + int(number*real(largest_portion, dp)))
         ends = [ends, last]
      end do
      differing = 0
      !$omp parallel do schedule(dynamic) reduction(+: differing)
      do portion = 2, size(ends)
         associate (members => order(ends(portion - 1) + 1:ends(portion)))
            differing = differing + count(any(bits_of(engine, members) /= together(:, members), dim=1))
         end associate
      end do
      !$omp end parallel do
   end function differing_in_portions

   !> Bits of samples and ending of scenes solved in one call.
   function bits_of(engine, members) result(bits)
      !> Place in `engine_names`
      integer, intent(in) :: engine
      !> Which scenes, in their order
      integer, intent(in) :: members(:)
      integer(int64) :: bits(values, size(members))
      type(problem_t), allocatable :: problems(:)
      type(motion_state_t), allocatable :: starts(:)
      type(ending_t), allocatable :: endings(:)
      type(request_t) :: request
      !> Sample, number of its state, scene
      real(dp), allocatable :: states(:, :, :)
      integer :: place

      allocate (states(sampled*samples, 2, size(members)), source=0.0_dp)
      allocate (endings(size(members)))
      problems = drawn(members)%resolved%problem
      starts = start_of(problems)
      starts%implicit = engine == 2
      request%accuracy = 1.0e-6_dp
      request%periods = periods
      request%sampled_periods = sampled
      request%samples_per_period = samples
      request%until_steady = engine == 3
      call solve_motions(problems, starts, request, states, endings)
      do place = 1, size(members)
         associate (ending => endings(place))
            bits(:, place) = [transfer(states(:, :, place), [1_int64]), &
                              transfer([ending%numbers(:2), ending%lienard_variable], [1_int64]), &
                              int([ending%status, ending%periods], int64), ending%count%steps]
         end associate
      end do
   end function bits_of

   !> Command line.
   subroutine read_arguments()
      character(32) :: word, value
      integer :: place, failure

      failure = modulo(command_argument_count(), 2)
      do place = 1, command_argument_count() - 1, 2
         call get_command_argument(place, word)
         call get_command_argument(place + 1, value)
         if (failure /= 0) exit
         if (word == '--scenes') then
            read (value, *, iostat=failure) scenes
         else if (word == '--seed') then
            read (value, *, iostat=failure) seed
         else
            failure = 1
         end if
      end do
      if (failure == 0 .and. scenes > 0) return
      write (error_unit, '(a)') 'usage: lane_independence [--scenes N] [--seed S]'
      stop 2
   end subroutine read_arguments

end program lane_independence
