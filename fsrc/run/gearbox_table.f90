!> The table of all gear pairs of an input: what became of each, and what they do together.
module gearbox_table
   use, intrinsic :: ieee_arithmetic, only: ieee_is_nan, ieee_quiet_nan, ieee_value
   use coexisting_motions, only: motions_sentence
   use earlier_files, only: begin_anew
   use errors, only: error_t, exit_bad_input, raise
   use force_signal, only: force_signal_t, sum_in_phase
   use input_key, only: name_limit
   use judged_scene, only: judged_scene_t, quantity_value
   use kinds, only: dp, int64
   use log_file, only: log_magic, log_t
   use output_place, only: log_path, summary_path
   use quantities, only: a_code, a_flag, quantity_acceleration_maximum, quantity_acceleration_minimum, &
                         quantity_acceleration_rms, quantity_verified, quantity_dissipated_power, quantity_double_sided, &
                         quantity_film_force_rms, quantity_film_minimum, quantity_loudest_acceleration_rms, &
                         quantity_loudest_class, quantity_motions, quantity_rattle_class, quantity_table, quantity_verdict, &
                         quantity_word
   use scene_report, only: acceleration_words, operating_point
   use scene_status, only: is_success, status_complete, status_interrupted, status_name
   use scene_types, only: scene_t
   use summary_file, only: checksum_in_summary, read_from_summary, summary_t
   use text, only: counted, integer_text, short_text, spaced
   use version, only: program_version
   use word_list, only: joined_words, word_t
   implicit none(type, external)
   private

   !> What is recorded of a pair.
   integer, parameter :: recorded(13) = [quantity_rattle_class, quantity_verified, quantity_double_sided, quantity_film_minimum, &
                                    quantity_acceleration_minimum, quantity_acceleration_maximum, quantity_acceleration_rms, &
                                    quantity_film_force_rms, quantity_dissipated_power, quantity_verdict, quantity_motions, &
                                    quantity_loudest_class, quantity_loudest_acceleration_rms]
   integer, parameter :: place_minimum = 5, place_maximum = 6, place_rms = 7, place_force = 8, place_power = 9, &
                         place_verdict = 10, place_motions = 11

   !> A row of the table: what is recorded of a pair, NaN where it is unknown.
   type, public :: pair_row_t
      private
      character(name_limit) :: name = ''
      integer :: status = status_complete
      !> Checksum of the summary of the pair
      integer(int64) :: summary_checksum = 0_int64
      real(dp) :: numbers(size(recorded)) = 0.0_dp
      type(force_signal_t) :: film_force
      !> What is known of all its motions
      character(:), allocatable :: motions
   end type pair_row_t

   !> What all pairs do together: power that heats the oil [W]; rms of the film force that the bearings feel, as if the forces knew
   !> nothing of each other and as they are [N]; what these are, or why one is unknown, NaN.
   type, public :: together_t
      real(dp) :: power = 0.0_dp, force_uncorrelated = 0.0_dp, force_in_phase = 0.0_dp
      character(:), allocatable :: words
   end type together_t

   public :: row_of_pair, write_table, whole_gearbox, together, check_earlier_table

contains

   !> Row of a judged pair whose files are in their places.
   function row_of_pair(scene, judged) result(row)
      type(scene_t), intent(in) :: scene
      type(judged_scene_t), intent(in) :: judged
      type(pair_row_t) :: row
      integer :: i

      row%name = scene%gear%name
      row%status = judged%status
      row%summary_checksum = checksum_in_summary(summary_path(scene))
      do i = 1, size(recorded)
         row%numbers(i) = quantity_value(recorded(i), judged)
      end do
      row%film_force = judged%film_force
      row%motions = motions_sentence(judged%coexisting)
   end function row_of_pair

   !> The scene that stands for all pairs, as far as files go.
   function whole_gearbox(scene) result(whole)
      !> Any of its pairs
      type(scene_t), intent(in) :: scene
      type(scene_t) :: whole

      whole = scene
      whole%name = scene%gearbox
      whole%output%series = .false.
   end function whole_gearbox

   !> See that the table of an earlier run holds no pair that this input does not have.
   subroutine check_earlier_table(gearbox, gears, error)
      !> Scene that stands for all pairs
      type(scene_t), intent(in) :: gearbox
      !> Names of the gears of this input
      type(word_t), intent(in) :: gears(:)
      !> Set if there is one
      type(error_t), allocatable, intent(out) :: error
      type(word_t), allocatable :: recorded(:)
      integer :: i, j

      call read_from_summary(summary_path(gearbox), "   gear = ", recorded)
      do i = 1, size(recorded)
         if (any([(recorded(i)%text == gears(j)%text, j=1, size(gears))])) cycle
         call raise(error, exit_bad_input, summary_path(gearbox)//" belongs to another gearbox: it has the gear '"// &
                    recorded(i)%text//"', which this input has not"//begin_anew)
         return
      end do
   end subroutine check_earlier_table

   !> Write the table as NAME.summary.nml, print it, and keep it in NAME.log.
   subroutine write_table(gearbox, pairs, rows, quiet, error, verbose)
      !> Scene that stands for all pairs
      type(scene_t), intent(in) :: gearbox
      !> How many pairs there are
      integer, intent(in) :: pairs
      !> Those that were solved
      type(pair_row_t), intent(in) :: rows(:)
      !> Nothing to the terminal
      logical, intent(in) :: quiet
      !> Set if a file could not be written
      type(error_t), allocatable, intent(out) :: error
      !> All of the log to the terminal; absent: no
      logical, intent(in), optional :: verbose
      type(together_t) :: sums
      type(summary_t) :: summary
      type(log_t) :: log
      integer :: i, j

      call log%open(log_path(gearbox), quiet, error, verbose)
      if (allocated(error)) return
      call log%line(log_magic//program_version//', gearbox '//trim(gearbox%name)//': '//counted(pairs, 'pair'))
      call log%item('operating point', operating_point(gearbox))
      sums = together(pairs, rows)
      call report_rows(log, gearbox, rows, sums)
      call summary%add('name', trim(gearbox%name))
      call summary%add('program_version', program_version)
      call summary%add('status', status_name(merge(status_interrupted, status_complete, size(rows) < pairs .or. &
                                                   any(rows%status == status_interrupted))))
      call summary%add('pairs', pairs)
      call summary%add('pairs_failed', count(.not. is_success(rows%status)))
      call summary%add('film_force_rms_uncorrelated', sums%force_uncorrelated)
      call summary%add('film_force_rms_in_phase', sums%force_in_phase)
      call summary%add('film_force_text', sums%words)
      call summary%add('dissipated_power', sums%power)
      do i = 1, size(rows)
         call summary%next_group('pair')
         call summary%add('gear', trim(rows(i)%name))
         call summary%add('status', status_name(rows(i)%status))
         if (rows(i)%summary_checksum /= 0_int64) call summary%add('summary_checksum', rows(i)%summary_checksum)
         do j = 1, size(recorded)
            associate (name => quantity_table(recorded(j))%name, number => rows(i)%numbers(j))
               if (ieee_is_nan(number)) cycle
               select case (quantity_table(recorded(j))%kind)
               case (a_code)
                  call summary%add(trim(name), quantity_word(recorded(j), nint(number)))
               case (a_flag)
                  call summary%add(trim(name), number > 0.0_dp)
               case default
                  call summary%add(trim(name), number)
               end select
            end associate
         end do
         if (len(words_of_motions(rows(i))) > 0) call summary%add('motions_text', words_of_motions(rows(i)))
      end do
      call summary%write(summary_path(gearbox), error)
      if (.not. allocated(error)) then
         call log%item('files', summary_path(gearbox)//', .log')
      end if
      call log%close()
   end subroutine write_table

   !> What all pairs do together; unknown where one is.
   pure type(together_t) function together(pairs, rows)
      !> How many pairs there are
      integer, intent(in) :: pairs
      !> Those that were solved
      type(pair_row_t), intent(in) :: rows(:)
      type(word_t) :: names(size(rows))
      logical :: unknown(size(rows))
      character(:), allocatable :: in_phase
      integer :: i

      unknown = ieee_is_nan(rows%numbers(place_force))
      do i = 1, size(rows)
         names(i)%text = trim(rows(i)%name)
         if (unknown(i)) names(i)%text = names(i)%text//' ('//status_name(rows(i)%status)//')'
      end do
      together%power = ieee_value(together%power, ieee_quiet_nan)
      together%force_uncorrelated = together%power
      together%force_in_phase = together%power
      if (any(unknown)) then
         together%words = 'together unknown, as there is no window to judge of '//joined_words(names, unknown)
      else if (size(rows) < pairs) then
         together%words = 'together unknown, as only '//counted(size(rows), 'pair')//' of '//integer_text(pairs)//' began'
      else
         together%power = sum(rows%numbers(place_power))
         together%force_uncorrelated = sqrt(sum(rows%numbers(place_force)**2))
         call sum_in_phase(rows%film_force, names, together%force_in_phase, in_phase)
         together%words = 'uncorrelated: root of the sum of the squares, as of independent forces; '// &
                          'in phase: rms of the sum of the forces, as all pairs follow one shaft, '//in_phase//'; '// &
                          'of the powers the sum'
      end if
   end function together

   !> A line for each pair, the largest film force first, and what all do together.
   subroutine report_rows(log, gearbox, rows, sums)
      type(log_t), intent(in) :: log
      type(scene_t), intent(in) :: gearbox
      type(pair_row_t), intent(in) :: rows(:)
      type(together_t), intent(in) :: sums
      real(dp) :: peak
      integer, allocatable :: order(:)
      integer :: i, width, verdicts, classes

      width = max(6, maxval(len_trim(rows%name)) + 2)
      verdicts = max(9, maxval([(len(verdict_cell(rows(i))), i=1, size(rows))]) + 2)
      classes = max(7, maxval([(len(class_cell(rows(i))), i=1, size(rows))]) + 2)
      call log%line('  '//cell('gear', width)//cell('verdict', verdicts)//cell('class', classes)//cell('least film', 12)// &
                    cell('peak', 10)//cell('rms', 10)//cell('film force', 12)//'power')
      call log%line('  '//cell('', width + verdicts + classes)//cell('[um]', 12)//cell('[m/s2]', 10)//cell('[m/s2]', 10)// &
                    cell('rms [N]', 12)//'[W]')
      order = by_force(rows)
      do i = 1, size(rows)
         associate (row => rows(order(i)), numbers => rows(order(i))%numbers)
            peak = numbers(place_maximum)
            if (.not. ieee_is_nan(peak)) peak = max(abs(numbers(place_minimum)), abs(peak))
            call log%line('  '//cell(trim(row%name), width)//cell(verdict_cell(row), verdicts)//cell(class_cell(row), classes)// &
                          cell(number_cell(1.0e6_dp*numbers(4)), 12)//cell(number_cell(peak), 10)// &
                          cell(number_cell(numbers(place_rms)), 10)//cell(number_cell(numbers(place_force)), 12)// &
                          number_cell(numbers(place_power)))
         end associate
      end do
      width = width + verdicts + classes + 32
      call log%line('  '//cell('together, uncorrelated', width)//cell(number_cell(sums%force_uncorrelated), 12)// &
                    number_cell(sums%power))
      call log%line('  '//cell('together, in phase', width)//number_cell(sums%force_in_phase))
      call log%detail('  '//sums%words)
      do i = 1, size(rows)
         associate (row => rows(order(i)))
            if (ieee_is_nan(row%numbers(place_motions))) cycle
            if (row%numbers(place_motions) > 1.0_dp) call log%detail('  '//trim(row%name)//': '//words_of_motions(row))
         end associate
      end do
      call log%line('  peak and rms of the acceleration'//acceleration_words(gearbox))
   end subroutine report_rows

   !> The verdict on a pair, or how it ended.
   pure function verdict_cell(row) result(words)
      type(pair_row_t), intent(in) :: row
      character(:), allocatable :: words

      words = status_name(row%status)
      if (.not. ieee_is_nan(row%numbers(place_verdict))) &
         words = quantity_word(quantity_verdict, nint(row%numbers(place_verdict)))
   end function verdict_cell

   !> The class of a pair, and whether it is verified.
   pure function class_cell(row) result(words)
      type(pair_row_t), intent(in) :: row
      character(:), allocatable :: words

      words = '-'
      if (.not. ieee_is_nan(row%numbers(1))) words = spaced(quantity_word(recorded(1), nint(row%numbers(1))))
      ! What is unknown is compared with nothing.
      if (.not. ieee_is_nan(row%numbers(2))) words = words//trim(merge(', verified', '          ', row%numbers(2) > 0.0_dp))
   end function class_cell

   !> What is known of all motions of a pair; empty where nothing is.
   pure function words_of_motions(row) result(words)
      type(pair_row_t), intent(in) :: row
      character(:), allocatable :: words

      words = ''
      if (allocated(row%motions)) words = row%motions
   end function words_of_motions

   !> The rows by their film force, the largest first, those without one last.
   pure function by_force(rows) result(order)
      type(pair_row_t), intent(in) :: rows(:)
      integer :: order(size(rows))
      real(dp) :: forces(size(rows))
      integer :: i

      forces = rows%numbers(place_force)
      where (ieee_is_nan(forces)) forces = -1.0_dp
      do i = 1, size(rows)
         order(i) = maxloc(forces, dim=1)
         forces(order(i)) = -2.0_dp
      end do
   end function by_force

   !> Words with blanks behind them up to a width; one at least.
   pure function cell(words, width)
      character(*), intent(in) :: words
      integer, intent(in) :: width
      character(:), allocatable :: cell

      cell = words//repeat(' ', max(1, width - len(words)))
   end function cell

   pure function number_cell(number) result(words)
      real(dp), intent(in) :: number
      character(:), allocatable :: words

      words = '-'
      if (.not. ieee_is_nan(number)) words = short_text(number, 4)
   end function number_cell

end module gearbox_table
