!> Numbers that the keys allow and no engineer can mean, millimetres typed for metres: a line each, with the place, and what they
!> would be in the unit that was surely meant (module mistaken_units).
module odd_numbers
   use constants, only: two_pi
   use input_entry, only: entry_t, place_of
   use input_key, only: real_kind, reals_kind
   use key_table, only: find_key, find_swept_key, keys
   use kinds, only: dp
   use mistaken_units, only: acceleration_meant, is_odd, meant_behind, mistaken_words, odd_words, speed_meant, surely_meant
   use scene_input, only: scene_input_t
   use scene_types, only: mistaken_number_t, shaft_t
   use text, only: integer_text, real_text, short_text
   use word_list, only: split_words, word_t
   implicit none(type, external)
   private

   !> An engine shakes no shaft so that an order has an acceleration of more than this share of the square of the mean angular speed:
   !> 25 % of the speed at order 2
   real(dp), parameter, public :: largest_swing = 0.5_dp

   public :: odd_numbers_of_input, odd_numbers_of_list, odd_swings, mistaken_numbers

contains

   !> Odd numbers of all keys that were given, of the ends of a sweep or threshold, and of the ranges and lists of a campaign.
   pure function odd_numbers_of_input(input) result(lines)
      !> Typed values without a fault
      type(scene_input_t), intent(in) :: input
      type(word_t), allocatable :: lines(:)
      character(:), allocatable :: task
      integer :: i

      allocate (lines(0))
      do i = 1, size(keys)
         associate (entry => input%entries(i), what => '&'//trim(keys(i)%group)//' '//trim(keys(i)%name))
            if (.not. entry%given) cycle
            if (keys(i)%kind == real_kind) call add_odd(entry, what, i, entry%number, '', lines)
            if (keys(i)%kind == reals_kind) lines = [lines, odd_numbers_of_list(place_of(entry), what, i, entry%numbers)]
         end associate
      end do
      task = input%word('scene.task')
      if (task == 'sweep' .or. task == 'threshold') call add_ends(input, task, lines)
      if (task == 'campaign' .or. task == 'threshold') call add_campaign(input, lines)
   end function odd_numbers_of_input

   !> Numbers of an input that were surely meant in another unit.
   pure function mistaken_numbers(input) result(mistaken)
      !> Typed values without a fault
      type(scene_input_t), intent(in) :: input
      type(mistaken_number_t), allocatable :: mistaken(:)
      integer :: positions(size(keys)), count, i

      count = 0
      do i = 1, size(keys)
         if (.not. input%entries(i)%given .or. keys(i)%kind /= real_kind) cycle
         if (len(mistaken_words(keys(i), input%entries(i)%number)) == 0) cycle
         count = count + 1
         positions(count) = i
      end do
      allocate (mistaken(count))
      do i = 1, count
         associate (entry => input%entries(positions(i)), key => keys(positions(i)))
            mistaken(i)%source = entry%file
            mistaken(i)%line = entry%line
            mistaken(i)%key = positions(i)
            mistaken(i)%meant = surely_meant(key, entry%number)
            mistaken(i)%sentence = mistaken_words(key, entry%number)
         end associate
      end do
   end function mistaken_numbers

   !> Both ends of a sweep, or of the range of a threshold. A name that is no key is reported elsewhere.
   pure subroutine add_ends(input, task, lines)
      type(scene_input_t), intent(in) :: input
      !> The task, which is also the group
      character(*), intent(in) :: task
      type(word_t), allocatable, intent(inout) :: lines(:)
      character(*), parameter :: ends(2) = ['first', 'last ']
      character(:), allocatable :: name
      integer :: i, position

      name = input%word(task//'.key')
      position = find_key(name)
      if (index(name, '.') == 0) position = find_swept_key(name)
      if (position < 1 .or. position > size(keys)) return
      do i = 1, size(ends)
         call add_odd(input%entries(find_key(task//'.'//ends(i))), '&'//task//' '//trim(ends(i)), position, &
                      input%number(task//'.'//ends(i)), whose(position), lines)
      end do
   end subroutine add_ends

   !> Both ends of the range of every varied key, or its list of values. Names that are no keys are reported elsewhere.
   pure subroutine add_campaign(input, lines)
      type(scene_input_t), intent(in) :: input
      type(word_t), allocatable, intent(inout) :: lines(:)
      type(word_t), allocatable :: names(:)
      integer :: i, position

      allocate (names, source=split_words(input%words('campaign.vary')))
      do i = 1, size(names)
         position = find_key(names(i)%text)
         if (position == 0) cycle
         associate (first => input%entries(find_key('campaign.first')), last => input%entries(find_key('campaign.last')), &
                    values => input%entries(find_key('campaign.values')))
            if (i <= size(values%columns)) then
               if (size(values%columns(i)%numbers) > 0) then
                  lines = [lines, odd_numbers_of_list(place_of(values), '&campaign values(:, '//integer_text(i)//')', position, &
                                                      values%columns(i)%numbers)]
                  cycle
               end if
            end if
            if (i <= size(first%numbers)) call add_odd(first, '&campaign first('//integer_text(i)//')', position, &
                                                       first%numbers(i), whose(position), lines)
            if (i <= size(last%numbers)) call add_odd(last, '&campaign last('//integer_text(i)//')', position, &
                                                      last%numbers(i), whose(position), lines)
         end associate
      end do
   end subroutine add_campaign

   !> One number, if it is odd.
   pure subroutine add_odd(entry, what, position, number, for_whom, lines)
      !> Where it stands
      type(entry_t), intent(in) :: entry
      !> How it is called there
      character(*), intent(in) :: what
      !> Key in whose unit it is, by its position in the table
      integer, intent(in) :: position
      real(dp), intent(in) :: number
      !> The key in words, if `what` does not say it
      character(*), intent(in) :: for_whom
      type(word_t), allocatable, intent(inout) :: lines(:)

      if (.not. is_odd(keys(position), number)) return
      lines = [lines, word_t('warning: '//place_of(entry)//': '//what//' = '//odd_words(keys(position), number, for_whom)// &
                             question(position, number))]
   end subroutine add_odd

   !> What is odd about a list of numbers: one line, or none. Where each has a line of its own in a file, the first odd one is
   !> named by it.
   pure function odd_numbers_of_list(place, what, position, numbers, first_line) result(lines)
      !> File, or file and line
      character(*), intent(in) :: place
      !> How the list is called there
      character(*), intent(in) :: what
      !> Key in whose unit they are, by its position in the table
      integer, intent(in) :: position
      real(dp), intent(in) :: numbers(:)
      !> Line of the first number, if each has its own
      integer, intent(in), optional :: first_line
      type(word_t), allocatable :: lines(:)
      character(:), allocatable :: line, how_many
      integer :: i, odd, first

      odd = 0
      first = 0
      do i = 1, size(numbers)
         if (.not. is_odd(keys(position), numbers(i))) cycle
         odd = odd + 1
         if (odd == 1) first = i
      end do
      allocate (lines(0))
      if (odd == 0) return
      how_many = 'the only such number'
      if (odd > 1) how_many = 'the first of '//integer_text(odd)//' such numbers'
      line = ''
      if (present(first_line)) line = ':'//integer_text(first_line + first - 1)
      lines = [word_t('warning: '//place//line//': '//what//': '//odd_words(keys(position), numbers(first), whose(position))// &
                      ', '//how_many//' among '//integer_text(size(numbers))//question(position, numbers(first)))]
   end function odd_numbers_of_list

   !> Behind an odd number what it would be in another unit, or the question whether it is in its own.
   pure function question(position, number) result(words)
      !> Key by its position in the table
      integer, intent(in) :: position
      real(dp), intent(in) :: number
      character(:), allocatable :: words

      words = meant_behind(keys(position), number)
      if (len(words) == 0) words = '; is it in this unit?'
   end function question

   !> What is odd about the motion of a shaft at its speed.
   pure function odd_swings(input, shaft) result(lines)
      !> Typed values without a fault
      type(scene_input_t), intent(in) :: input
      !> The motion of the shaft that they, or a signal, give
      type(shaft_t), intent(in) :: shaft
      type(word_t), allocatable :: lines(:)
      real(dp), allocatable :: accelerations(:)
      real(dp) :: speed, limit
      character(:), allocatable :: key, number, meant
      integer :: worst

      allocate (lines(0))
      if (.not. allocated(shaft%orders)) return
      ! The amplitudes of a run-up are those of its table, at each speed.
      if (.not. (allocated(shaft%speed_amplitudes) .or. allocated(shaft%accelerations))) return
      if (is_odd(keys(find_key('shaft.speed_rpm')), shaft%speed_rpm)) return
      speed = two_pi*shaft%speed_rpm/60.0_dp
      limit = largest_swing*speed**2
      if (allocated(shaft%speed_amplitudes)) then
         allocate (accelerations, source=shaft%speed_amplitudes*shaft%orders*speed)
      else
         allocate (accelerations, source=shaft%accelerations)
      end if
      worst = maxloc(accelerations, dim=1)
      if (worst == 0) return
      if (.not. accelerations(worst) > limit) return
      if (allocated(shaft%speed_amplitudes)) then
         limit = limit/(shaft%orders(worst)*speed)
         number = real_text(shaft%speed_amplitudes(worst))//' rad/s'
         meant = short_text(limit, 3)//' rad/s at most); it would be '//speed_meant(shaft%speed_amplitudes(worst))
      else
         number = real_text(accelerations(worst))//' rad/s2'
         meant = short_text(limit, 3)//' rad/s2 at most); it would be '//acceleration_meant(accelerations(worst))
      end if
      key = 'accelerations'
      if (input%is_given('shaft.speed_amplitudes')) key = 'speed_amplitudes'
      if (input%is_given('shaft.signal')) key = 'signal'
      associate (entry => input%entries(find_key('shaft.'//key)), order => shaft%orders(worst))
         lines = [word_t('warning: '//place_of(entry)//': &shaft '//key//': '//number//' of order '//short_text(order, 3)// &
                         ' is not what machines have: the speed of '//real_text(shaft%speed_rpm)//' 1/min would swing by '// &
                         short_text(100.0_dp*accelerations(worst)/(order*speed**2), 2)//' % ('//meant)]
      end associate
   end function odd_swings

   !> Of which key the numbers of a sweep, a threshold or a campaign are.
   pure function whose(position) result(words)
      integer, intent(in) :: position
      character(:), allocatable :: words

      words = ' for '//trim(keys(position)%group)//'.'//trim(keys(position)%name)
   end function whose

end module odd_numbers
