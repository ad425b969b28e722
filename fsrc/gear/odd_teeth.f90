!> What is odd about the teeth of a gear pair: profile shifts and contact ratios that no designer means; teeth that are pointed or
!> undercut, or touch the root of the other gear. Each is a warning with the place of the key that it concerns.
module odd_teeth
   use constants, only: pi
   use gear_contact, only: find_contact, gear_contact_t
   use key_table, only: find_key
   use kinds, only: dp
   use scene_types, only: gear_t, scene_t
   use text, only: integer_text, printable, short_text
   use word_list, only: word_t
   implicit none(type, external)
   private

   !> Usual: the largest sum of profile shifts by size, the least normal thickness of tips, the largest addendum of high teeth [m_n]
   real(dp), parameter :: largest_shift_sum = 2.0_dp, least_tip_thickness = 0.2_dp, largest_addendum = 1.5_dp

   public :: warnings_of_teeth

contains

   !> Warnings of the teeth of a scene.
   function warnings_of_teeth(scene, at) result(lines)
      !> Of a gear pair that breaks no rule
      type(scene_t), intent(in) :: scene
      !> What was set in it since it was read; empty: nothing
      character(*), intent(in) :: at
      type(word_t), allocatable :: lines(:)
      type(gear_contact_t) :: contact
      character(:), allocatable :: wrong, message
      real(dp) :: without_shift

      allocate (lines(0))
      call find_contact(scene%gear, 0.0_dp, 1.0_dp, contact, wrong, message)
      if (len(wrong) > 0) return
      associate (teeth => contact%teeth, gear => scene%gear)
         without_shift = 0.5_dp*gear%normal_module*real(gear%teeth_1 + gear%teeth_2, dp)/cos(pi/180.0_dp*gear%helix_angle_deg)
         if (abs(teeth%shift_sum) > largest_shift_sum) call add('centre_distance', short_text(contact%centre_distance, 4)// &
            ' m takes profile shifts that add up to '//short_text(teeth%shift_sum, 3)//'; usual are -2 to 2, and '// &
            'without any it is '//short_text(without_shift, 4)//' m')
         if (teeth%tips_given) then
            call add_teeth_of_tips()
         else
            call add_usual_teeth()
         end if
         if (teeth%contact_ratio < 1.0_dp) call add_contact_ratio()
      end associate

   contains

      !> Teeth whose tips are given. How the sum of the profile shifts is shared is known if both addenda are alike.
      subroutine add_teeth_of_tips()
         character(:), allocatable :: gear_words, key
         integer :: i

         associate (teeth => contact%teeth)
            if (teeth%addendum > largest_addendum) call add('tip_diameter_1', 'both tip diameters make addenda of '// &
               short_text(teeth%addendum, 3)//' normal modules: 1 is usual, up to '//short_text(largest_addendum, 2)// &
               ' have high teeth, and roots as deep as usual touch these tips')
            do i = 1, 2
               gear_words = 'if both addenda are alike gear '//integer_text(i)//', with a profile shift of '// &
                            short_text(teeth%shifts(i), 2)//', '
               key = 'tip_diameter_'//integer_text(i)
               if (teeth%tip_thickness(i) <= 0.0_dp) then
                  call add(key, gear_words//'is pointed below this tip')
               else if (teeth%tip_thickness(i) < least_tip_thickness) then
                  call add(key, gear_words//'has tips '//short_text(teeth%tip_thickness(i), 2)//' normal modules thick, and '// &
                           'usual are '//short_text(least_tip_thickness, 1)//' at least')
               end if
               if (teeth%undercut(i) > 0.0_dp) call add(key, gear_words//'is undercut: it takes a profile shift of '// &
                  short_text(teeth%shifts(i) + teeth%undercut(i), 2)//' at least')
            end do
         end associate
      end subroutine add_teeth_of_tips

      !> Teeth as high as usual, of which alone the sum of the profile shifts is known.
      subroutine add_usual_teeth()
         associate (teeth => contact%teeth)
            if (sum(teeth%undercut) > 0.0_dp) call add('teeth_1', 'gears with so few teeth are undercut, however their profile '// &
               'shifts are shared: they add up to '//short_text(teeth%shift_sum, 2)//', and '// &
               short_text(teeth%shift_sum + sum(teeth%undercut), 2)//' at least is needed')
            if (teeth%is_cut_short) call add('normal_module', 'teeth as high as usual would '//trim(merge('be pointed ', &
               'interfere  ', any(teeth%tip_thickness < 0.0_dp)))//' if both gears have half of the sum of the profile '// &
               'shifts, so contact_ratio is that of lower ones; tip_diameter_1 and tip_diameter_2 give the true one')
            if (any([scene%gear%contact_position - contact%first_position, contact%last_position - scene%gear%contact_position] &
                    > teeth%reach)) call add('contact_position', 'teeth as high as usual do not touch there: it lies beyond a tip')
         end associate
      end subroutine add_usual_teeth

      !> A transverse contact ratio below 1.
      subroutine add_contact_ratio()
         character(:), allocatable :: key, words

         associate (teeth => contact%teeth)
            key = 'tip_diameter_1'
            words = 'the transverse contact ratio is '//short_text(teeth%contact_ratio, 3)
            if (.not. teeth%tips_given) then
               key = 'normal_module'
               words = 'the transverse contact ratio of teeth as high as usual is '//short_text(teeth%contact_ratio, 3)
            end if
            if (teeth%contact_ratio + teeth%overlap_ratio < 1.0_dp) then
               if (teeth%overlap_ratio > 0.0_dp) words = words//', with the overlap of the helix '// &
                  short_text(teeth%contact_ratio + teeth%overlap_ratio, 3)
               words = words//': below 1 the pair does not transmit continuously, teeth part before the next ones meet'
            else
               words = words//', below 1: teeth follow each other by the overlap of the helix alone, in all '// &
                       short_text(teeth%contact_ratio + teeth%overlap_ratio, 3)
            end if
            call add(key, words)
         end associate
      end subroutine add_contact_ratio

      !> Add a warning at the place of a key.
      subroutine add(name, sentence)
         !> In &gear
         character(*), intent(in) :: name
         character(*), intent(in) :: sentence
         character(:), allocatable :: place

         place = printable(scene%source, .false.)
         if (scene%lines(find_key('gear.'//name)) > 0) place = place//':'//integer_text(scene%lines(find_key('gear.'//name)))
         lines = [lines, word_t('warning: '//place//': &gear '//name//': '//at//sentence)]
      end subroutine add

   end function warnings_of_teeth

end module odd_teeth
