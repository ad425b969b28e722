!> Tests of namelist text against the reader of the runtime: the same text, value by value.
module test_namelist_standard
   use checks, only: check_list_t
   use errors, only: fault_list_t
   use input_entry, only: close_list, entry_t, new_entry, set_entry
   use key_table, only: find_key, keys
   use kinds, only: dp
   use namelist_text, only: assignment_t, scan_namelists
   implicit none(type, external)
   private

   !> What is left unset keeps these
   real(dp), parameter :: unset_number = -77.0_dp
   character(*), parameter :: unset_word = '?'

   character(96), parameter :: texts(37) = [character(96) :: &
      'first = 3*50.0', &
      'first = 2*, 5.0', &
      'first = 2* 5.0', &
      'first = 1.0,,3.0', &
      'first = 1.0 , , 3.0', &
      'first = ,2.0, part = 3', &
      'first = 1.0,, part = 3', &
      'first = , part = 3,', &
      'first = ,,,4.0', &
      'first = 1.0, 2*7.0, 2*, .5', &
      'first = 3*.5 1*-2.', &
      'first = 1.0q-8 1.0-8 1.0d0 1.+3 1.e5 5', &
      'first = 1E5 .5 -.5 +3. 007 1.0D+03', &
      'first(1:2) = 1, 2', &
      'first(2:) = 1, 2', &
      'first(:2) = 1, 2', &
      'first(:) = 1, 2', &
      'first(1:5:2) = 1, 2, 3', &
      'first(3:1:-1) = 1, 2, 3', &
      'first(6:2:-2) = 3*4.0', &
      'first(1:5:2) = 1, , 3, first(2:4:2) = 2*9.0', &
      'first( 2 ) = 1', &
      'first(3)=3.0, first(1)=2.0 first(2)=1', &
      'first(2:4) = 2*', &
      'values(:,1) = 1 2, values(:, 2) = 3, 4', &
      'values(2,:) = 1 2 values(1,1:2) = 7 8', &
      'values(1:2,1:2) = 1 2 3 4', &
      'values(1:3:2,3) = 2*6.0, values(2,2) = 1', &
      'values(:,3) = 2*, 5.0', &
      'vary = 3*''a'' ''it''''s''', &
      'vary = 2*"q""q" 2*, ''e''', &
      'vary(2:3) = ''/&,!='', "it''s" vary(1) = ''x''', &
      'csv = ''it''''s.csv'', part = 4', &
      'csv = "a "" b", neighbours = .true.', &
      'neighbours = T seed = 5', &
      'NEIGHBOURS=.T,SEED=1*7,', &
      ', seed = 5,, part = 1*, neighbours = true']

   public :: run_namelist_standard_tests

contains

   !> Runs every test of this topic.
   subroutine run_namelist_standard_tests(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results
      integer :: i

      call checks%start('namelist_standard')
      do i = 1, size(texts)
         call compare(checks, '&campaign '//trim(texts(i))//' /')
         call compare(checks, '$campaign '//trim(texts(i))//' $end')
      end do
   end subroutine run_namelist_standard_tests

   !> One text, read by the runtime and by the reader of scenes.
   subroutine compare(checks, text)
      type(check_list_t), intent(inout) :: checks  !> Collects the results
      character(*), intent(in) :: text             !> One group

      real(dp) :: first(7), values(4, 3)
      character(16) :: vary(7), csv
      integer :: part, seed, stat
      logical :: neighbours
      namelist /campaign/ first, values, vary, csv, part, seed, neighbours
      type(assignment_t), allocatable :: assignments(:)
      type(fault_list_t) :: faults
      character(len(text)) :: unit

      first = unset_number
      values = unset_number
      vary = unset_word
      csv = unset_word
      part = nint(unset_number)
      seed = part
      neighbours = .false.
      unit = text
      read (unit, nml=campaign, iostat=stat)
      call checks%check(stat == 0, 'the runtime reads '//text)
      call scan_namelists(text, 'f', 1, assignments, faults)
      call check_table('first', reshape(first, [size(first), 1]))
      call check_table('values', values)
      call check_words('vary', vary)
      call check_words('csv', [csv])
      call check_table('part', reshape([real(part, dp)], [1, 1]))
      call check_table('seed', reshape([real(seed, dp)], [1, 1]))
      call check_flag(neighbours)
      call checks%check(faults%count() == 0, 'no fault: '//text)

   contains

      !> Numbers of one key.
      subroutine check_table(name, expected)
         character(*), intent(in) :: name      !> Of the group
         real(dp), intent(in) :: expected(:, :)  !> As the runtime has them

         real(dp) :: found(size(expected, 1), size(expected, 2))
         type(entry_t) :: entry
         integer :: j

         found = unset_number
         call read_key(name, '-77.0', entry)
         if (name == 'first') then
            found(:size(entry%numbers), 1) = entry%numbers
         else if (name == 'values') then
            do j = 1, size(entry%columns)
               found(:size(entry%columns(j)%numbers), j) = entry%columns(j)%numbers
            end do
         else if (entry%given) then
            found = real(entry%count, dp)
         end if
         call checks%check(all(abs(found - expected) <= 0.0_dp), name//' of '//text)
      end subroutine check_table

      !> Words of one key.
      subroutine check_words(name, expected)
         character(*), intent(in) :: name         !> Of the group
         character(*), intent(in) :: expected(:)  !> As the runtime has them

         type(entry_t) :: entry
         character(:), allocatable :: words
         integer :: i, last

         call read_key(name, unset_word, entry)
         words = ''
         last = findloc(expected /= unset_word, .true., dim=1, back=.true.)
         do i = 1, last
            words = words//trim(expected(i))//' '
         end do
         if (name == 'csv') call checks%check(entry%word == trim(words), name//' of '//text)
         if (name == 'vary') call checks%check(entry%words == trim(words), name//' of '//text)
      end subroutine check_words

      subroutine check_flag(expected)
         logical, intent(in) :: expected  !> As the runtime has it

         type(entry_t) :: entry

         call read_key('neighbours', '', entry)
         call checks%check((entry%given .and. entry%flag) .eqv. expected, 'neighbours of '//text)
      end subroutine check_flag

      !> All assignments to a key, its unset elements filled as those of the runtime were.
      subroutine read_key(name, filling, entry)
         character(*), intent(in) :: name      !> Of the group
         character(*), intent(in) :: filling   !> Text of unset elements
         type(entry_t), intent(out) :: entry   !> Its values

         integer :: position, i, j
         logical :: is_last

         position = find_key('campaign.'//name)
         entry = new_entry(keys(position), 'f')
         do i = 1, size(assignments)
            if (assignments(i)%key == name) call set_entry(keys(position), assignments(i), .false., entry, 'f', faults)
         end do
         do j = 1, size(entry%elements, 2)
            is_last = .true.
            do i = size(entry%elements, 1), 1, -1
               is_last = is_last .and. .not. allocated(entry%elements(i, j)%text)
               if (is_last .or. allocated(entry%elements(i, j)%text)) cycle
               entry%elements(i, j)%text = filling
               entry%elements(i, j)%quoted = filling == unset_word
            end do
         end do
         call close_list(keys(position), entry, faults)
      end subroutine read_key

   end subroutine compare

end module test_namelist_standard
