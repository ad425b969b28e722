!> All motions of one operating point that its starts have led to, and which of them shakes most and least.
module coexisting_motions
   use kinds, only: dp
   use motion_start, only: one_start_sentence, several_starts
   use quantities, only: quantity_rattle_class, quantity_word
   use text, only: integer_text, short_text, spaced
   implicit none(type, external)
   private

   !> Of a motion whose impacts no one asked for.
   integer, parameter, public :: unknown_verdict = -1

   !> One of them.
   type, public :: motion_summary_t
      !> Code of its class
      integer :: class = 0
      !> Its verdict, as of verdict_of, or unknown_verdict
      integer :: verdict = unknown_verdict
      !> Periods of the force after which it repeats; 0: it does not
      integer :: period = 0
      !> Numbers of its state at the start of a period of the force, from which it is the same motion again
      real(dp), allocatable :: state(:)
      !> Modulus of its largest Floquet multiplier; negative: unknown
      real(dp) :: floquet_modulus = -1.0_dp
      !> Starts that lead to it, and whether that of the scene is one of them
      integer :: starts = 0
      logical :: from_own_start = .false.
      !> Whether film and velocity of its state alone start it again
      logical :: restarts = .false.
      !> Acceleration rms [m/s2], film force rms [N] and least film [m]
      real(dp) :: acceleration_rms = 0.0_dp
      real(dp) :: film_force_rms = 0.0_dp
      real(dp) :: film_minimum = 0.0_dp
   end type motion_summary_t

   !> All of them.
   type, public :: coexisting_motions_t
      !> That of the scene first; not allocated: nothing is known of others
      type(motion_summary_t), allocatable :: motions(:)
      !> Starts whose motions were solved, and those of them that did not settle on one that repeats
      integer :: starts_solved = 0
      integer :: unsettled_starts = 0
      !> Starts among those that settled whose film and velocity were drawn
      integer :: drawn_starts = 0
      !> Why there is one start only, as of one_start_reason
      integer :: one_start_reason = several_starts
      !> Whether the scene itself starts from another film or velocity than those at rest
      logical :: start_is_given = .false.
      !> Periods that the other starts were followed
      integer :: extra_periods = 0
   end type coexisting_motions_t

   !> Probability with which a motion of a larger share of the starts would have been met [-].
   real(dp), parameter :: certainty = 0.95_dp

   public :: loudest_motion, quietest_motion, largest_missed_share, motions_in_short, motions_sentence, own_start_words

contains

   !> Place of the motion with the largest acceleration rms; 0: none is known.
   pure integer function loudest_motion(coexisting) result(place)
      type(coexisting_motions_t), intent(in) :: coexisting

      place = 0
      if (allocated(coexisting%motions)) place = maxloc(coexisting%motions%acceleration_rms, dim=1)
   end function loudest_motion

   !> Place of the motion with the smallest acceleration rms; 0: none is known.
   pure integer function quietest_motion(coexisting) result(place)
      type(coexisting_motions_t), intent(in) :: coexisting

      place = 0
      if (allocated(coexisting%motions)) place = minloc(coexisting%motions%acceleration_rms, dim=1)
   end function quietest_motion

   !> Share of the drawn starts that a motion which none of them met has less than, with 95 %: 1 - (1 - p)^n = 0.95 [-].
   elemental real(dp) function largest_missed_share(drawn) result(share)
      !> How many drawn starts have settled
      integer, intent(in) :: drawn

      share = 1.0_dp
      if (drawn > 0) share = 1.0_dp - (1.0_dp - certainty)**(1.0_dp/real(drawn, dp))
   end function largest_missed_share

   !> Which start the motion of a scene comes from.
   pure function own_start_words(coexisting) result(words)
      type(coexisting_motions_t), intent(in) :: coexisting
      character(:), allocatable :: words

      words = trim(merge('from the given start', 'from rest           ', coexisting%start_is_given))
   end function own_start_words

   !> What is known of all motions, in words; empty where nothing is.
   pure function motions_sentence(coexisting) result(sentence)
      type(coexisting_motions_t), intent(in) :: coexisting
      character(:), allocatable :: sentence
      integer :: i

      sentence = ''
      if (.not. allocated(coexisting%motions)) return
      associate (solved => coexisting%starts_solved, unsettled => coexisting%unsettled_starts, motions => coexisting%motions)
         if (solved == 1) then
            sentence = one_start_sentence(coexisting%one_start_reason)
            if (len(sentence) == 0) sentence = 'one start: other motions were not looked for (solver.starts)'
            return
         end if
         if (size(motions) == 1) then
            sentence = 'one motion from '//integer_text(solved)//' starts'
         else
            sentence = integer_text(size(motions))//' motions: '
            do i = 1, size(motions)
               if (i > 1) sentence = sentence//', '
               sentence = sentence//spaced(quantity_word(quantity_rattle_class, motions(i)%class))//' '// &
                          short_text(motions(i)%acceleration_rms, 4)//' m/s2 ('
               if (motions(i)%from_own_start) sentence = sentence//own_start_words(coexisting)//', '
               sentence = sentence//integer_text(motions(i)%starts)//' of '//integer_text(solved)
               if (i == 1) sentence = sentence//' starts'
               sentence = sentence//')'
            end do
         end if
         if (unsettled > 0) sentence = sentence//'; of '//integer_text(unsettled)//' starts the motion does not repeat, or not yet'
         if (coexisting%drawn_starts > 0) &
            sentence = sentence//trim(merge(': any other', '; any other', size(motions) == 1 .and. unsettled == 0))// &
                       ' has less than '//percent(largest_missed_share(coexisting%drawn_starts))// &
                       ' of the sampled starts (95 %)'
      end associate
   end function motions_sentence

   !> The same in one line, however many there are: their number, the loudest, what was not seen.
   pure function motions_in_short(coexisting) result(words)
      type(coexisting_motions_t), intent(in) :: coexisting
      character(:), allocatable :: words

      words = ''
      if (.not. allocated(coexisting%motions)) return
      words = motions_sentence(coexisting)
      if (size(coexisting%motions) == 1 .and. coexisting%unsettled_starts == 0) return
      words = integer_text(size(coexisting%motions))//' of '//integer_text(coexisting%starts_solved)//' starts'
      associate (loudest => coexisting%motions(loudest_motion(coexisting)))
         if (size(coexisting%motions) > 1) words = words//', loudest '// &
            spaced(quantity_word(quantity_rattle_class, loudest%class))//' '//short_text(loudest%acceleration_rms, 4)//' m/s2'
      end associate
      if (coexisting%unsettled_starts > 0) words = words//'; '//integer_text(coexisting%unsettled_starts)//' unsettled'
      if (coexisting%drawn_starts > 0) words = words//'; any other below '// &
         percent(largest_missed_share(coexisting%drawn_starts))//' (95 %)'
   end function motions_in_short

   !> A share in whole percent, rounded up.
   pure function percent(share) result(words)
      real(dp), intent(in) :: share
      character(:), allocatable :: words

      words = integer_text(ceiling(100.0_dp*share))//' %'
   end function percent

end module coexisting_motions
