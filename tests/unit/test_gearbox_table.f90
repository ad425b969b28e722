!> Tests of the table of a gearbox: every cell and key against the pair that it comes from, and both sums.
module test_gearbox_table
   use, intrinsic :: ieee_arithmetic, only: ieee_is_nan
   use campaign_file_cases, only: content_of, line_feed
   use canonical_scenes, only: loose_gear
   use checks, only: check_list_t
   use errors, only: error_t
   use file_system, only: delete_file
   use force_signal, only: signal_of_window
   use gearbox_table, only: pair_row_t, row_of_pair, together, together_t, whole_gearbox, write_table
   use judged_scene, only: judged_scene_t
   use kinds, only: dp
   use problem, only: coast_flank, drive_flank
   use node_extremes, only: seen_acceleration, seen_films
   use output_place, only: log_path, summary_path
   use rattle_class, only: class_idle
   use prepared_scene, only: resolve
   use scene_status, only: status_film_lost, status_steady
   use scene_types, only: scene_t
   use text, only: short_text
   implicit none(type, external)
   private

   public :: run_gearbox_table_tests

   !> Film forces of the pairs, cosines of the first order [N], and their phases [rad]
   real(dp), parameter :: forces(3) = [3.0_dp, 4.0_dp, 12.0_dp]*sqrt(2.0_dp), phases(3) = [0.2_dp, 1.7_dp, 0.2_dp]
   real(dp), parameter :: powers(3) = [1.0_dp, 20.0_dp, 300.0_dp]

contains

   !> Runs every test of this topic.
   subroutine run_gearbox_table_tests(checks)
      class(check_list_t), intent(inout) :: checks  !> Collects the results
      type(pair_row_t) :: rows(3)

      call checks%start('gearbox_table')
      rows = [row_of(1, status_steady), row_of(2, status_steady), row_of(3, status_steady)]
      call test_sums(checks, rows)
      call test_table(checks, rows)
      rows(2) = row_of(2, status_film_lost)
      call test_failed_pair(checks, rows)
      call test_pairs_not_begun(checks, rows)
   end subroutine run_gearbox_table_tests

   !> A pair as it is judged: numbers that differ in every column.
   type(pair_row_t) function row_of(number, status) result(row)
      integer, intent(in) :: number
      integer, intent(in) :: status
      type(judged_scene_t) :: judged
      type(scene_t) :: scene
      real(dp) :: accelerations(64), two_pi
      integer :: i

      two_pi = 8.0_dp*atan(1.0_dp)
      scene = loose_gear()
      scene%excitation%force_amplitudes = 0.0_dp
      scene%gear%name = 'g'//achar(iachar('0') + number)
      judged%resolved = resolve(scene)
      judged%status = status
      judged%judged = status == status_steady
      judged%ending%periods = 10
      judged%rattle%class = class_idle
      judged%verification%exists = .true.
      judged%verification%verified = number == 1
      judged%extremes%lowest(seen_films(1))%value = real(number, dp)*1.2345e-7_dp
      judged%extremes%lowest(seen_acceleration)%value = -real(number, dp)*20.0_dp
      judged%extremes%highest(seen_acceleration)%value = real(number, dp)**2*10.0_dp
      judged%severity%acceleration_rms = 0.5_dp + real(number, dp)
      judged%severity%film_force_rms = forces(number)/sqrt(2.0_dp)
      judged%severity%dissipated_energy = powers(number)/judged%resolved%problem%frequency
      judged%impacts%exists = .true.
      judged%impacts%periods = 1
      judged%impacts%contacts(drive_flank)%count = 1
      judged%impacts%contacts(coast_flank)%count = number - 1
      accelerations = [(forces(number)/judged%resolved%problem%mass*cos(two_pi*real(i, dp)/64.0_dp + phases(number)), i=1, 64)]
      if (judged%judged) judged%film_force = signal_of_window(judged%resolved%problem, accelerations, 1, 10, .true., &
                                                              judged%severity%film_force_rms)
      row = row_of_pair(scene, judged)
   end function row_of

   !> Forces that are independent of each other add as the root of their squares, those of one shaft by their phases.
   subroutine test_sums(checks, rows)
      class(check_list_t), intent(inout) :: checks
      type(pair_row_t), intent(in) :: rows(:)
      type(together_t) :: sums
      real(dp) :: in_phase

      sums = together(3, rows)
      in_phase = abs(sum(forces*exp(cmplx(0.0_dp, phases, dp))))/sqrt(2.0_dp)
      call checks%check_close(sums%force_uncorrelated, 13.0_dp, 1.0e-13_dp, 'root of the sum of 9, 16 and 144')
      call checks%check_close(sums%force_in_phase, in_phase, 1.0e-13_dp, 'sum of three phasors')
      call checks%check_close(sums%power, 321.0_dp, 1.0e-12_dp, 'sum of the powers')
      call checks%check(index(sums%words, 'uncorrelated: root of the sum of the squares') == 1 .and. &
                        index(sums%words, 'in phase: rms of the sum of the forces') > 0 .and. &
                        index(sums%words, 'over 1 period, after which all pairs repeat') > 0, 'what the sums are: '//sums%words)
      sums = together(1, rows(3:))
      call checks%check_close(sums%force_in_phase, 12.0_dp, 1.0e-13_dp, 'one pair is its own sum')
   end subroutine test_sums

   !> The lines of the log and the keys of the summary.
   subroutine test_table(checks, rows)
      class(check_list_t), intent(inout) :: checks
      type(pair_row_t), intent(in) :: rows(:)
      type(together_t) :: sums
      character(:), allocatable :: log, summary

      call write_both(checks, 3, rows, log, summary)
      sums = together(3, rows)
      ! The largest film force comes first.
      call expect(checks, log, ' [N] [W] g3 double-sided impacts idle 0.3704 90.00 3.500 12.00 300.0 '// &
                  'g2 double-sided impacts idle 0.2469 40.00 2.500 4.000 20.00 '// &
                  'g1 impacts without separation idle, verified 0.1235 20.00 1.500 3.000 1.000 ')
      call expect(checks, log, ' together, uncorrelated 13.00 321.0 ')
      call expect(checks, log, ' together, in phase '//short_text(sums%force_in_phase, 4)//' ')
      call expect(checks, log, ' '//sums%words//' ')
      call expect(checks, log, ' least film peak rms film force power [um] [m/s2] [m/s2] rms [N] [W] ')
      call expect(checks, summary, " name = 'box' ")
      call expect(checks, summary, " status = 'complete' pairs = 3 pairs_failed = 0 film_force_rms_uncorrelated = 13.0")
      call expect(checks, summary, ' film_force_rms_in_phase = ')
      call expect(checks, summary, " film_force_text = '"//sums%words//"' dissipated_power = 321.0 ")
      call expect(checks, summary, " &pair gear = 'g2' status = 'steady' rattle_class = 'idle' verified = .false. "// &
                  'double_sided = .true. film_minimum = 2.469E-7 acceleration_minimum = -40.0 acceleration_maximum = 40.0 '// &
                  'acceleration_rms = 2.5 ')
   end subroutine test_table

   !> A pair without a window leaves nothing to add.
   subroutine test_failed_pair(checks, rows)
      class(check_list_t), intent(inout) :: checks
      type(pair_row_t), intent(in) :: rows(:)
      type(together_t) :: sums
      character(:), allocatable :: log, summary

      sums = together(3, rows)
      call checks%check(all(ieee_is_nan([sums%power, sums%force_uncorrelated, sums%force_in_phase])), 'no sum with a failed pair')
      call checks%check(sums%words == 'together unknown, as there is no window to judge of g2 (film_lost)', sums%words)
      call write_both(checks, 3, rows, log, summary)
      call expect(checks, log, ' g2 film_lost - - - - - - ')
      call expect(checks, log, ' together, uncorrelated - - together, in phase - together unknown, as ')
      call expect(checks, summary, " status = 'complete' pairs = 3 pairs_failed = 1 film_force_text = 'together unknown, as")
      call expect(checks, summary, " &pair gear = 'g2' status = 'film_lost' / ")
   end subroutine test_failed_pair

   !> A call that ended before the last pair shows no sum of the others.
   subroutine test_pairs_not_begun(checks, rows)
      class(check_list_t), intent(inout) :: checks
      type(pair_row_t), intent(in) :: rows(:)
      character(:), allocatable :: log, summary

      call write_both(checks, 3, rows(:1), log, summary)
      call expect(checks, log, ' gearbox box: 3 pairs ')
      call expect(checks, log, ' together unknown, as only 1 pair of 3 began ')
      call expect(checks, summary, " status = 'interrupted' pairs = 3 pairs_failed = 0 film_force_text = ")
   end subroutine test_pairs_not_begun

   !> Log and summary of a table, each stretch of blanks and line ends as one blank.
   subroutine write_both(checks, pairs, rows, log, summary)
      class(check_list_t), intent(inout) :: checks
      integer, intent(in) :: pairs
      type(pair_row_t), intent(in) :: rows(:)
      character(:), allocatable, intent(out) :: log
      character(:), allocatable, intent(out) :: summary
      type(error_t), allocatable :: error
      type(scene_t) :: scene

      scene = loose_gear()
      scene%output%directory = '.'
      scene%gearbox = 'box'
      scene = whole_gearbox(scene)
      call write_table(scene, pairs, rows, .true., error)
      call checks%check(.not. allocated(error), 'table written')
      log = spaced(content_of(log_path(scene)))
      summary = spaced(content_of(summary_path(scene)))
      call delete_file(log_path(scene))
      call delete_file(summary_path(scene))
   end subroutine write_both

   !> A text with single blanks.
   pure function spaced(text)
      character(*), intent(in) :: text
      character(:), allocatable :: spaced
      integer :: i

      spaced = ''
      do i = 1, len(text)
         if (text(i:i) /= ' ' .and. text(i:i) /= line_feed) then
            spaced = spaced//text(i:i)
         else if (spaced(max(1, len(spaced)):) /= ' ') then
            spaced = spaced//' '
         end if
      end do
   end function spaced

   subroutine expect(checks, text, words)
      class(check_list_t), intent(inout) :: checks
      character(*), intent(in) :: text
      character(*), intent(in) :: words

      call checks%check(index(text, words) > 0, 'reported: '//words)
   end subroutine expect

end module test_gearbox_table
