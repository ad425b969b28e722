!> Where a motion leaves what the model can mean: a gap so wide that it is no line contact any more, or so narrow that no oil is
!> in it.
module model_limits
   use kinds, only: dp
   implicit none(type, external)
   private

   !> Beyond this share of the radius the parabola h0 + x**2/(2 R), which stands for the round flank, ends [-].
   real(dp), parameter, public :: widest_share = 0.1_dp
   !> Below this film there is no oil film left: a few molecules [m].
   real(dp), parameter, public :: thinnest_film = 1.0e-9_dp
   !> Codes: within, too wide, too narrow, both at different times.
   integer, parameter, public :: within_model = 0, gap_too_wide = 1, gap_too_narrow = 2, gap_both = 3

   public :: model_limit, model_limit_name, model_limit_sentence

contains

   !> Which limits a motion has passed.
   elemental integer function model_limit(film_minimum, film_maximum, radius)
      !> Smallest and largest film [m]
      real(dp), intent(in) :: film_minimum
      real(dp), intent(in) :: film_maximum
      !> Equivalent radius R [m]
      real(dp), intent(in) :: radius

      model_limit = within_model
      if (film_maximum > widest_share*radius) model_limit = gap_too_wide
      if (film_minimum < thinnest_film) model_limit = model_limit + gap_too_narrow
   end function model_limit

   !> Word for the summary.
   pure function model_limit_name(limit) result(name)
      !> Code of a limit
      integer, intent(in) :: limit
      character(:), allocatable :: name
      character(*), parameter :: names(0:3) = [character(19) :: 'within', 'too_wide', 'too_narrow', 'too_wide_and_narrow']

      name = trim(names(limit))
   end function model_limit_name

   !> What it means, in a sentence; empty within the limits.
   pure function model_limit_sentence(limit) result(sentence)
      !> Code of a limit
      integer, intent(in) :: limit
      character(:), allocatable :: sentence
      character(*), parameter :: wide = 'the film grows beyond a tenth of the radius, where the parabolic gap of a line '// &
                                         'contact ends'
      character(*), parameter :: narrow = 'the film falls below 1 nm, where no oil film is left'

      select case (limit)
      case (gap_too_wide)
         sentence = wide
      case (gap_too_narrow)
         sentence = narrow
      case (gap_both)
         sentence = wide//', and '//narrow
      case default
         sentence = ''
      end select
   end function model_limit_sentence

end module model_limits
