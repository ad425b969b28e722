!> Why a class is not verified: a code with the numbers of its sentence. The sentence is made where it is printed.
module doubt
   use kinds, only: dp
   use lyapunov, only: draws_near, parting_t
   use quantities, only: quantity_rattle_class, quantity_word
   use scene_status, only: status_name
   use text, only: counted, error_text, integer_text, short_text, spaced
   implicit none(type, external)
   private

   !> Codes, and what their numbers and counts are.
   integer, parameter, public :: doubt_none = 0
   !> The second solution failed: its status
   integer, parameter, public :: doubt_second_ending = 1
   !> Another class: that of the second solution
   integer, parameter, public :: doubt_class = 2
   !> Irregular only so far: the parting of neighbouring motions
   integer, parameter, public :: doubt_parting = 3
   !> Mean z'' and its mean by the change of velocity [m/s2]; energy of film and of forces [J]
   integer, parameter, public :: doubt_momentum = 4, doubt_energy = 5
   !> Samples too few: how many a period would do, or 0; whether the scene's are Newmark's steps, 1 or 0
   integer, parameter, public :: doubt_samples = 6
   !> The motion holds too few impacts
   integer, parameter, public :: doubt_impacts = 7
   !> Films where the window begins and where it ends [m]
   integer, parameter, public :: doubt_return = 8
   !> The halves of an irregular motion differ: rms of z'' in both [m/s2]
   integer, parameter, public :: doubt_halves = 9
   !> The irregular fraction near its limit, or within its error of it
   integer, parameter, public :: doubt_fraction_close = 11, doubt_fraction_error = 12
   !> Difference of the film [-]
   integer, parameter, public :: doubt_film = 13
   !> The largest harmonic as small as its error: its number
   integer, parameter, public :: doubt_largest_harmonic = 14
   !> The harmonic distortion within its error of its limit, or no more than a bound
   integer, parameter, public :: doubt_distortion = 15, doubt_distortion_bound = 16
   !> The least count of harmonics; the least and the most
   integer, parameter, public :: doubt_count_bound = 17, doubt_count = 18
   !> The largest film, beyond what the model means [m]
   integer, parameter, public :: doubt_flight = 19

   type, public :: doubt_t
      integer :: code = doubt_none
      real(dp) :: numbers(2) = 0.0_dp
      integer :: counts(2) = 0
      !> Of an irregular motion that was followed beside a neighbouring one
      type(parting_t) :: parting = parting_t()
   end type doubt_t

   public :: is_doubted, first_doubt, doubt_sentence, parting_sentence

contains

   !> Whether there is a doubt.
   elemental logical function is_doubted(doubt)
      type(doubt_t), intent(in) :: doubt

      is_doubted = doubt%code /= doubt_none
   end function is_doubted

   !> The first of several doubts, none if there is none among them.
   pure type(doubt_t) function first_doubt(doubts)
      type(doubt_t), intent(in) :: doubts(:)
      integer :: first

      first_doubt = doubt_t()
      first = findloc(is_doubted(doubts), .true., dim=1)
      if (first > 0) first_doubt = doubts(first)
   end function first_doubt

   !> A doubt in words, empty where there is none.
   pure function doubt_sentence(doubt) result(sentence)
      type(doubt_t), intent(in) :: doubt
      character(:), allocatable :: sentence

      sentence = ''
      associate (numbers => doubt%numbers, counts => doubt%counts)
         select case (doubt%code)
         case (doubt_second_ending)
            sentence = 'The second solution ended as '//status_name(counts(1))//'.'
         case (doubt_class)
            sentence = 'Solved again, the class is '//spaced(quantity_word(quantity_rattle_class, counts(1)))//'.'
         case (doubt_parting)
            sentence = doubt_of_parting(doubt%parting)
         case (doubt_momentum)
            sentence = 'The window does not close: the mean of z" is '//short_text(numbers(1), 3)// &
                       ' m/s2, while the change of velocity gives '//short_text(numbers(2), 3)//' m/s2.'
         case (doubt_energy)
            sentence = 'The window does not close: the film takes '//short_text(numbers(1), 3)//' J, the forces give '// &
                       short_text(numbers(2), 3)//' J.'
         case (doubt_samples)
            sentence = doubt_of_samples(counts(1), counts(2) == 1)
         case (doubt_impacts)
            sentence = 'The motion has too few impacts, while it is followed, to be called irregular.'
         case (doubt_return)
            sentence = 'Solved again, the window of one period begins with a film of '//short_text(numbers(1), 3)// &
                       ' m and ends with '//short_text(numbers(2), 3)// &
                       ' m: that solution does not repeat after it, or not yet. '// &
                       'Raise spectrum.periods to see which.'
         case (doubt_halves)
            sentence = 'The two halves of the '//counted(doubt%parting%periods, 'period')//' that the motion was followed '// &
                       'differ by more than their errors: the rms of z" is '//short_text(numbers(1), 3)//' and '// &
                       short_text(numbers(2), 3)//' m/s2.'
         case (doubt_fraction_close)
            sentence = 'The irregular fraction is close to its limit.'
         case (doubt_fraction_error)
            sentence = 'The irregular fraction is within its error of its limit.'
         case (doubt_film)
            sentence = 'Solved tighter, the film differs by '//short_text(100.0_dp*numbers(1), 2)//' %.'
         case (doubt_largest_harmonic)
            sentence = 'Of the harmonics that the force has, the largest is as small as its error.'
            if (counts(1) == 1) sentence = 'The first harmonic is as small as its error.'
         case (doubt_distortion)
            sentence = 'The harmonic distortion is within its error of the quiet limit.'
         case (doubt_distortion_bound)
            sentence = 'The harmonic distortion is a lower bound: '// &
                       'more harmonics than are resolved may lift it over the quiet limit.'
         case (doubt_count_bound)
            sentence = 'There are at least '//integer_text(counts(1))// &
                       ' harmonics, and beyond the highest resolved one there may be more.'
         case (doubt_count)
            sentence = 'Within their errors there are '//integer_text(counts(1))//' to '//integer_text(counts(2))//' harmonics.'
         case (doubt_flight)
            sentence = 'The film grows to '//short_text(numbers(1), 3)//' m, beyond a tenth of the radius: '// &
                       'the film law does not hold there.'
         case default
            continue
         end select
      end associate
   end function doubt_sentence

   !> Why a motion is irregular only so far.
   pure function doubt_of_parting(parting) result(sentence)
      !> How a neighbour parts from it
      type(parting_t), intent(in) :: parting
      character(:), allocatable :: sentence

      if (parting%out_of_time) then
         sentence = 'The motion does not repeat, and solver.time_limit was over before it had been followed beside a '// &
                    'neighbouring one.'
      else if (parting%periods == 0) then
         sentence = 'The motion does not repeat, and it could not be followed beside a neighbouring one.'
      else if (draws_near(parting)) then
         sentence = parting_sentence(parting)//' The motion settles; raise solver.periods to see to which one.'
      else
         sentence = parting_sentence(parting)//' That is not positive beyond its error: the motion may settle later.'
      end if
   end function doubt_of_parting

   !> The Lyapunov exponent of a motion that was followed.
   pure function parting_sentence(parting) result(sentence)
      type(parting_t), intent(in) :: parting
      character(:), allocatable :: sentence

      sentence = 'Neighbouring motions part with a Lyapunov exponent of '//short_text(parting%exponent, 2)//' +- '// &
                error_text(parting%standard_error, parting%exponent, 2)//' a period, over '//counted(parting%periods, 'period')//'.'
   end function parting_sentence

   !> That the samples are too few, and how many would do.
   pure function doubt_of_samples(enough, are_steps) result(sentence)
      !> Samples of a period that would follow the motion, 0: not known
      integer, intent(in) :: enough
      !> Whether the samples of the scene are Newmark's steps
      logical, intent(in) :: are_steps
      character(:), allocatable :: sentence
      character(:), allocatable :: key

      key = 'solver.samples_per_period'
      if (are_steps) key = 'solver.steps_per_period'
      sentence = 'The samples a period are too few for the harmonics: '
      if (enough > 0) then
         sentence = sentence//key//' = '//integer_text(enough)//' would follow the motion.'
      else
         sentence = sentence//'raise '//key//'; the default method finds them by integrals over its steps.'
      end if
   end function doubt_of_samples

end module doubt
