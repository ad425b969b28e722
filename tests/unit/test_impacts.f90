!> Tests of impacts by hand: loads of straight lines, whose impacts can be counted and integrated on paper, wherever the window
!> begins; and of the largest force of several orders.
module test_impacts
   use checks, only: check_list_t
   use constants, only: two_pi
   use force, only: cosine_force, force_t, largest_size
   use impacts, only: impact_count_t, impact_watch_t, impacts_of_watch, load_point_t, point_fall, point_low, point_passing, &
      take_point
   use kinds, only: dp
   use problem, only: of_drive_compression, of_velocity, problem_t
   use window_extremes, only: window_extremes_t
   use window_impacts, only: agreement_of, impact_agreement_t, impacts_of_samples, impacts_without_separation, &
      single_sided_impacts, verdict_of, window_impacts_t
   implicit none(type, external)
   private

   integer, parameter :: samples = 16

   public :: run_impacts_tests

contains

   !> Runs every test of this topic.
   subroutine run_impacts_tests(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      call checks%start('impacts')
      ! F_max is 1 N: the triangle of 2 N exceeds it for a sample, with 1.5 N on average.
      call compare([2.0_dp], [2.0_dp], [1.5_dp], 'one impact')
      call compare([1.4_dp, 0.0_dp, 1.4_dp], [real(dp) ::], [real(dp) ::], 'below the limit')
      call compare([4.0_dp, 2.5_dp, 3.0_dp], [4.0_dp], [0.75_dp*2.5_dp + 3.25_dp + 2.75_dp + 2.0_dp/3.0_dp*2.0_dp], &
                   'two maxima of an impact')
      ! The stretch parts at 1.4 N.
      call compare([4.0_dp, 1.4_dp, 3.0_dp], [4.0_dp, 3.0_dp], &
                   [0.75_dp*2.5_dp + 2.7_dp, 2.2_dp + 2.0_dp/3.0_dp*2.0_dp], 'two impacts in a stretch')
      call compare([4.0_dp, 0.0_dp, 3.0_dp], [4.0_dp, 3.0_dp], [1.5_dp*2.5_dp, 4.0_dp/3.0_dp*2.0_dp], 'two impacts')
      ! The dip to 0.95 N is above half of 1.7 N: the interval is the stretch about 1.8 N.
      call compare([1.8_dp, 0.95_dp, 1.7_dp], [1.8_dp], [(0.8_dp/1.8_dp + 0.8_dp/0.85_dp)*1.4_dp], 'a dip below the force')
      call test_restitution(checks)
      call test_held(checks)
      call test_unloaded(checks)
      call test_largest_force(checks)
      call test_agreement(checks)
      call test_never_left(checks)

   contains

      !> Impacts of some loads with nothing behind them, beginning with each of the samples.
      subroutine compare(loads, tops, impulses, name)
         real(dp), intent(in) :: loads(:)     !> One after the other [N]
         real(dp), intent(in) :: tops(:)      !> Loads of their impacts [N]
         real(dp), intent(in) :: impulses(:)  !> And their impulses [N samples]
         character(*), intent(in) :: name     !> Of the case
         type(window_impacts_t) :: impacts
         real(dp) :: all_loads(samples), rounding
         integer :: shift

         rounding = 16.0_dp*epsilon(1.0_dp)
         all_loads = 0.0_dp
         all_loads(2:1 + size(loads)) = loads
         do shift = 0, samples - 1
            impacts = impacts_of_samples(pressed(0.0_dp), 1.5_dp, samples, states_of(cshift(all_loads, shift)))
            associate (drive => impacts%contacts(1))
               call checks%check(drive%count == size(tops) .and. impacts%contacts(2)%count == 0, name//': their number')
               if (size(tops) == 0) cycle
               call checks%check_close(drive%load_maximum, maxval(tops), 0.0_dp, name//': largest load')
               call checks%check_close(drive%impulse_maximum, maxval(impulses)/real(samples, dp), rounding, name//': impulse')
               call checks%check_close(drive%impulse_sum, sum(impulses)/real(samples, dp), rounding, name//': all impulses')
               call checks%check_close(drive%kept(1 + findloc(drive%kept%load >= maxval(tops), .true., dim=1) - 1)%time, &
                                       modulo(real(1 + maxloc(loads, dim=1) - shift, dp)/real(samples, dp), 1.0_dp), rounding, &
                                       name//': when')
            end associate
         end do
      end subroutine compare

   end subroutine run_impacts_tests

   !> A tooth on a spring of 1 N/m under a force of 1 N at most, or that beside a steady one.
   pure type(problem_t) function pressed(steady)
      real(dp), intent(in) :: steady  !> [N]

      pressed%force = cosine_force(steady, 1.0_dp)
      pressed%contact%compliance = 1.0_dp
      pressed%frequency = 1.0_dp
   end function pressed

   !> States that carry some loads.
   pure function states_of(loads) result(states)
      real(dp), intent(in) :: loads(:)  !> [N]
      real(dp) :: states(size(loads), 3)

      states = 1.0_dp
      states(:, of_velocity) = 0.0_dp
      states(:, of_drive_compression) = loads
   end function states_of

   !> Velocities of approach and away where the load passes 1 N, about the largest of all impacts, wherever the window begins.
   subroutine test_restitution(checks)
      type(check_list_t), intent(inout) :: checks
      type(impact_watch_t) :: watch
      type(impact_count_t) :: impacts

      ! Half way between two samples each.
      call compare([2.0_dp], [0.0_dp], 1.5_dp, 1.0_dp, 'one impact')
      call compare([2.0_dp, 0.0_dp, 4.0_dp], [0.0_dp, -3.0_dp, 0.0_dp], 2.25_dp, 1.5_dp, 'the larger one of two')
      call compare([4.0_dp, 0.0_dp, 2.0_dp], [0.0_dp, 1.0_dp, 0.0_dp], 2.25_dp, 0.75_dp, 'the larger one, first')
      ! Two impacts in a stretch: it begins before the first one and ends after the second one.
      call compare([4.0_dp, 1.4_dp, 3.0_dp], [0.0_dp, 0.0_dp, 0.5_dp], 2.25_dp, 1.5_dp, 'two impacts in a stretch')
      call compare([1.4_dp], [0.0_dp], 0.0_dp, 0.0_dp, 'no impact')
      ! A window that begins within an impact does not know its approach.
      watch%level = 1.0_dp
      watch%limit = 1.5_dp
      call take_point(load_point_t(time=0.0_dp, load=3.0_dp, velocity=1.0_dp, kind=point_passing), watch)
      call take_point(load_point_t(time=0.1_dp, load=1.0_dp, velocity=-1.0_dp, kind=point_fall), watch)
      call take_point(load_point_t(time=0.2_dp, load=0.0_dp, velocity=-1.0_dp, kind=point_low), watch)
      impacts = impacts_of_watch(watch, 1.0_dp)
      call checks%check(impacts%count == 1 .and. .not. impacts%approach > 0.0_dp, 'restitution: no approach in the window')

   contains

      !> Velocities of some loads with nothing about them, which is approached at 3 m/s and left at 2 m/s.
      subroutine compare(loads, velocities, approach, departure, name)
         real(dp), intent(in) :: loads(:)
         !> Of the film [m/s]
         real(dp), intent(in) :: velocities(:)
         real(dp), intent(in) :: approach
         real(dp), intent(in) :: departure
         character(*), intent(in) :: name
         type(window_impacts_t) :: found
         real(dp) :: all_loads(samples), all_velocities(samples), states(samples, 3)
         integer :: shift

         all_loads = 0.0_dp
         all_loads(3:2 + size(loads)) = loads
         all_velocities = 2.0_dp
         all_velocities(:2) = -3.0_dp
         all_velocities(3:2 + size(loads)) = velocities
         do shift = 0, samples - 1
            states = states_of(cshift(all_loads, shift))
            states(:, of_velocity) = cshift(all_velocities, shift)
            found = impacts_of_samples(pressed(0.0_dp), 1.5_dp, samples, states)
            call checks%check_close(found%contacts(1)%approach, approach, 1.0e-14_dp, 'restitution, '//name//': approach')
            call checks%check_close(found%contacts(1)%departure, departure, 1.0e-14_dp, 'restitution, '//name//': away')
         end do
      end subroutine compare

   end subroutine test_restitution

   !> A load that stays above the largest force has no impact, in one period and in two.
   subroutine test_held(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results
      type(window_impacts_t) :: impacts
      real(dp) :: loads(2*samples)
      integer :: i

      loads = [(3.0_dp + cos(two_pi*real(i, dp)/real(samples, dp)), i=1, 2*samples)]
      do i = 1, 2
         impacts = impacts_of_samples(pressed(0.0_dp), 1.5_dp, samples, states_of(loads(:i*samples)))
         call checks%check(impacts%exists .and. impacts%contacts(1)%count == 0, 'held: no impact')
      end do
   end subroutine test_held

   !> The film is unloaded below a hundredth of the static load, or of the largest force where there is none.
   subroutine test_unloaded(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results
      type(window_impacts_t) :: impacts

      ! A line from 0 to 1 N and back, over two samples of four; two samples stand at 0.
      impacts = impacts_of_samples(pressed(0.5_dp), 1.5_dp, 4, states_of([0.0_dp, 1.0_dp, 0.0_dp, 0.0_dp]))
      call checks%check_close(impacts%unloaded_share, 0.5_dp + 2.0_dp*0.005_dp/4.0_dp, 1.0e-14_dp, 'unloaded: static load')
      impacts = impacts_of_samples(pressed(0.0_dp), 1.5_dp, 4, states_of([0.0_dp, 1.0_dp, 0.0_dp, 0.0_dp]))
      call checks%check_close(impacts%unloaded_share, 0.5_dp + 2.0_dp*0.01_dp/4.0_dp, 1.0e-14_dp, 'unloaded: largest force')
      impacts = impacts_of_samples(pressed(0.0_dp), 1.5_dp, 2, states_of([0.0_dp, 1.0_dp, 0.0_dp, 1.0_dp]))
      call checks%check_close(impacts%unloaded_share, 4.0_dp*0.01_dp/4.0_dp, 1.0e-14_dp, 'unloaded: share of two periods')
   end subroutine test_unloaded

   !> The largest force of several orders is that of very many places, and a little more.
   subroutine test_largest_force(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results
      integer, parameter :: places = 100000, highest = 7, forces = 20
      type(force_t) :: several
      real(dp) :: drawn(2*highest), top, value, turn
      integer :: i, k, n

      do i = 1, forces
         drawn = [(modulo(0.61803398874989485_dp*real(13*i + k, dp)*real(k, dp), 1.0_dp) - 0.5_dp, k=1, 2*highest)]
         several = cosine_force(0.3_dp*drawn(3), drawn(1))
         several%sine = drawn(2)
         several%highest = highest
         if (allocated(several%others)) deallocate (several%others)
         allocate (several%others(2, 2:highest))
         several%others = reshape(drawn(3:), [2, highest - 1])
         top = 0.0_dp
         do k = 1, places
            turn = two_pi*real(k, dp)/real(places, dp)
            value = 0.2_dp + several%steady + drawn(1)*cos(turn) + drawn(2)*sin(turn)
            do n = 2, highest
               value = value + several%others(1, n)*cos(real(n, dp)*turn) + several%others(2, n)*sin(real(n, dp)*turn)
            end do
            top = max(top, abs(value))
         end do
         value = largest_size(several, 0.2_dp)
         ! Between places 1e-5 of a period apart a wave of order 7 rises by (7 pi 1e-5)**2/2 at most.
         call checks%check(value >= top*(1.0_dp - 1.0e-14_dp) .and. value <= top*(1.0_dp + 1.0e-7_dp), 'largest force')
      end do
      call checks%check_close(largest_size(cosine_force(-3.0_dp, 2.0_dp), 0.5_dp), 4.5_dp, 1.0e-15_dp, 'largest force: one order')
   end subroutine test_largest_force

   !> Impacts of a tooth that leaves its flank, and of one that never does, whose verdict a part of a motion does not settle.
   subroutine test_never_left(checks)
      type(check_list_t), intent(inout) :: checks
      type(window_impacts_t) :: impacts
      type(window_extremes_t) :: extremes
      type(impact_agreement_t) :: part
      type(problem_t) :: problem

      problem = pressed(0.0_dp)
      problem%backlash = huge(1.0_dp)
      impacts%contacts(1)%count = 1
      call checks%check(verdict_of(problem, extremes, impacts) == impacts_without_separation, 'never left')
      part = agreement_of(problem, extremes, impacts, extremes, impacts, is_part=.true.)
      call checks%check(.not. part%verdict, 'never left: a part of a motion')
      impacts%unloaded_share = 0.25_dp
      call checks%check(verdict_of(problem, extremes, impacts) == single_sided_impacts, 'left for a time')
      part = agreement_of(problem, extremes, impacts, extremes, impacts, is_part=.true.)
      call checks%check(part%verdict, 'left for a time: a part of a motion')
   end subroutine test_never_left

   !> Windows of unlike length agree where impacts are as many a period.
   subroutine test_agreement(checks)
      type(check_list_t), intent(inout) :: checks
      real(dp), parameter :: one_flank = huge(1.0_dp), two_flanks = 1.0e-4_dp

      call checks%check(agree(3, 2, 6, 4), 'three impacts in two periods, six in four')
      call checks%check(.not. agree(3, 2, 3, 4), 'three impacts in two periods, three in four')
      call checks%check(agree(3, 2, 3, 2) .and. .not. agree(3, 2, 4, 2), 'windows of one length')
      call checks%check(verdict_stands(1, 0, two_flanks, is_part=.false.), 'a whole motion that hits one of two flanks')
      call checks%check(verdict_stands(0, 0, one_flank, is_part=.false.), 'a whole motion without impacts')
      call checks%check(verdict_stands(1, 0, one_flank, is_part=.true.), 'a part of a motion that hits the only flank')
      call checks%check(.not. verdict_stands(0, 0, one_flank, is_part=.true.), 'a part of a motion without impacts')
      call checks%check(.not. verdict_stands(1, 0, two_flanks, is_part=.true.), 'a part that hits one of two flanks')
      call checks%check(verdict_stands(1, 2, two_flanks, is_part=.true.), 'a part that hits both flanks')

   contains

      !> Whether the numbers of two windows agree.
      logical function agree(count, periods, other_count, other_periods)
         integer, intent(in) :: count, periods, other_count, other_periods
         type(window_impacts_t) :: impacts, others
         type(window_extremes_t) :: extremes
         type(impact_agreement_t) :: agreement

         impacts%periods = periods
         impacts%contacts(1)%count = count
         others%periods = other_periods
         others%contacts(1)%count = other_count
         agreement = agreement_of(pressed(0.0_dp), extremes, impacts, extremes, others, is_part=.false.)
         agree = agreement%numbers
      end function agree

      !> Whether the verdict of two windows with the same impacts stands; their numbers do only of whole motions.
      logical function verdict_stands(drive, coast, backlash, is_part)
         integer, intent(in) :: drive, coast
         real(dp), intent(in) :: backlash
         logical, intent(in) :: is_part
         type(window_impacts_t) :: impacts
         type(window_extremes_t) :: extremes
         type(impact_agreement_t) :: agreement
         type(problem_t) :: problem

         problem = pressed(0.0_dp)
         problem%backlash = backlash
         impacts%periods = 2
         impacts%unloaded_share = 0.25_dp
         impacts%contacts%count = [drive, coast]
         agreement = agreement_of(problem, extremes, impacts, extremes, impacts, is_part)
         call checks%check(agreement%numbers .neqv. is_part, 'numbers of a part of a motion')
         verdict_stands = agreement%verdict
      end function verdict_stands

   end subroutine test_agreement

end module test_impacts
