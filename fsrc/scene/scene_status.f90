!> How a scene ended.
module scene_status
   use quantities, only: quantity_status, quantity_word
   implicit none(type, external)
   private

   integer, parameter, public :: status_complete = 0, status_steady = 1, status_not_converged = 2, &
                                 status_film_lost = 3, status_no_rigid_film = 4, status_overflow = 5, &
                                 status_interrupted = 6, status_time_limit = 7, status_not_written = 8, &
                                 status_invalid = 9, status_film_cycles = 10, status_film_torn = 11

   public :: status_name, status_sentence, is_success

contains

   !> Word for the summary.
   pure function status_name(status) result(name)
      integer, intent(in) :: status
      character(:), allocatable :: name

      name = quantity_word(quantity_status, status)
   end function status_name

   !> Plain sentence for log and summary.
   pure function status_sentence(status) result(sentence)
      integer, intent(in) :: status
      character(:), allocatable :: sentence

      select case (status)
      case (status_complete)
         sentence = 'All that was asked for was solved.'
      case (status_steady)
         sentence = 'The motion repeats; the remaining periods were not needed.'
      case (status_not_converged)
         sentence = 'No step, short as it was or often as it was iterated, met the accuracy, or too many of them would be '// &
                    'needed; for newmark raise steps_per_period, or set iteration = ''newton''.'
      case (status_film_lost)
         sentence = 'The film would reach zero however short the step; raise steps_per_period.'
      case (status_no_rigid_film)
         sentence = 'The piezo-viscous film of rigid flanks ceases to exist here; the contact is elastohydrodynamic.'
      case (status_overflow)
         sentence = 'The film load exceeds every number that can be represented; the film law does not hold here.'
      case (status_interrupted)
         sentence = 'A signal ended the run; what was computed until then is kept.'
      case (status_film_cycles)
         sentence = 'The nodes under pressure cycle however short the step; 64 nodes or more help under heavy loads, and '// &
                    'model = closure has no nodes.'
      case (status_film_torn)
         sentence = 'A cavity opens in a film again and again; 64 nodes or more help under heavy loads, and model = closure '// &
                    'has no nodes.'
      case (status_invalid)
         sentence = 'The values do not make a valid scene.'
      case (status_not_written)
         sentence = 'The time series could not be written; the disk may be full.'
      case default
         sentence = 'The time limit ended the run; what was computed until then is kept.'
      end select
   end function status_sentence

   !> Whether the scene has its full result.
   elemental logical function is_success(status)
      integer, intent(in) :: status

      is_success = status == status_complete .or. status == status_steady
   end function is_success

end module scene_status
