!> Several gear pairs of one input as the one base scene of a campaign, whose slowest axis is the pair.
module gearbox
   use scene_types, only: scene_t
   use word_list, only: word_t
   implicit none(type, external)
   private

   public :: base_of_pairs

contains

   !> Base scene of a campaign over all pairs of an input.
   function base_of_pairs(scenes) result(base)
      !> Derived scenes of the pairs, which have all but the pair in common; one scene is its own base
      type(scene_t), intent(in) :: scenes(:)
      type(scene_t) :: base
      character(*), parameter :: opening = '&gear'//new_line('a'), closing = new_line('a')//'/'//new_line('a'), &
                                 derived = '! derived: '
      character(:), allocatable :: pairs, tails
      integer :: i, first, last, tail

      base = scenes(1)
      if (size(scenes) == 1) return
      allocate (base%pairs(size(scenes)))
      pairs = ''
      tails = ''
      do i = 1, size(scenes)
         associate (text => scenes(i)%resolved_input)
            first = index(text, opening)
            last = first + index(text(first:), closing) + len(closing) - 2
            tail = index(text, derived)
            if (i == 1) base%resolved_input = text(:first - 1)
            pairs = pairs//text(first:last)
            if (i == size(scenes)) pairs = pairs//text(last + 1:tail - 1)
            tails = tails//'! gear '//trim(scenes(i)%gear%name)//new_line('a')//text(tail:)
         end associate
         base%pairs(i) = scenes(i)%gear
         base%campaign%in_base = base%campaign%in_base .and. scenes(i)%campaign%in_base
      end do
      base%resolved_input = base%resolved_input//pairs//tails
      base%warnings = warnings_of_pairs(scenes)
   end function base_of_pairs

   !> Warnings of all pairs, each once; one that is not of all of them says whose it is.
   function warnings_of_pairs(scenes) result(warnings)
      type(scene_t), intent(in) :: scenes(:)
      type(word_t), allocatable :: warnings(:)
      integer :: i, j, pair, known

      allocate (warnings(0))
      do i = 1, size(scenes)
         do j = 1, size(scenes(i)%warnings)
            associate (text => scenes(i)%warnings(j)%text)
               known = 0
               do pair = 1, size(scenes)
                  if (is_among(text, scenes(pair)%warnings)) known = known + 1
               end do
               if (known < size(scenes)) then
                  warnings = [warnings, word_t('gear '//trim(scenes(i)%gear%name)//': '//text)]
               else if (i == 1) then
                  warnings = [warnings, word_t(text)]
               end if
            end associate
         end do
      end do
   end function warnings_of_pairs

   pure logical function is_among(text, words)
      character(*), intent(in) :: text
      type(word_t), intent(in) :: words(:)
      integer :: i

      is_among = .false.
      do i = 1, size(words)
         if (words(i)%text == text) is_among = .true.
      end do
   end function is_among

end module gearbox
