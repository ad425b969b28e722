!> A film with a state of its own: n numbers y beside its thickness h, such as a profile of pressures,
!>
!>     W = W(h, h', y) ,      0 = r(h, h', y, y') ,
!>
!> with as many equations r as numbers. A law that gives y' has r = g(h, h', y) - y'; an equation without y' holds at every time.
!>
!> A law extends the type of this module and stands in the list of module film_states. It is asked at single points in time; how
!> its numbers are followed through a step and taken out of the equations of the gear is the business of module inner_step.
module film_state
   use film_law, only: film_t
   use kinds, only: dp
   implicit none(type, external)
   private

   !> Load of a contact W [N], with its slopes in the film h [N/m] and in its velocity h' [N s/m].
   type, public :: load_t
      real(dp) :: load = 0.0_dp
      real(dp) :: by_film = 0.0_dp
      real(dp) :: by_velocity = 0.0_dp
   end type load_t

   !> What a film answers at h, h', y and y'.
   type, extends(load_t), public :: film_response_t
      !> dW/dy
      real(dp), allocatable :: by_inner(:)
      !> Residual r, and its slopes in h, h', y and y': equation, number
      real(dp), allocatable :: residual(:)
      real(dp), allocatable :: residual_by_film(:)
      real(dp), allocatable :: residual_by_velocity(:)
      real(dp), allocatable :: residual_by_inner(:, :)
      real(dp), allocatable :: residual_by_rate(:, :)
   end type film_response_t

   !> A number of a state: what files call it, its unit, and the film that one of it counts as in the control of the steps and in
   !> the search for repetition [m].
   type, public :: state_number_t
      character(:), allocatable :: name
      character(:), allocatable :: unit
      real(dp) :: counts_as = 1.0_dp
   end type state_number_t

   !> A law of films with a state of their own.
   type, abstract, public :: film_state_t
   contains
      procedure(words_of), deferred :: words
      procedure(count_of), deferred :: count
      procedure(number_of), deferred :: number
      procedure(rest_of), deferred :: rest
      procedure(respond_to), deferred :: respond
   end type film_state_t

   abstract interface
      !> The law in words, for log and summary.
      pure function words_of(self) result(words)
         import :: film_state_t
         class(film_state_t), intent(in) :: self
         character(:), allocatable :: words
      end function words_of

      !> How many numbers the state has.
      pure integer function count_of(self)
         import :: film_state_t
         class(film_state_t), intent(in) :: self
      end function count_of

      !> One of its numbers.
      pure function number_of(self, place) result(number)
         import :: film_state_t, state_number_t
         class(film_state_t), intent(in) :: self
         !> From 1 to count
         integer, intent(in) :: place
         type(state_number_t) :: number
      end function number_of

      !> The state of a film that has stood still for long.
      pure function rest_of(self, film, thickness) result(inner)
         import :: dp, film_state_t, film_t
         class(film_state_t), intent(in) :: self
         !> Contact, oil and speed of the film
         type(film_t), intent(in) :: film
         !> h [m]
         real(dp), intent(in) :: thickness
         real(dp), allocatable :: inner(:)
      end function rest_of

      !> Load and residual at a point in time.
      pure function respond_to(self, film, thickness, velocity, inner, rate) result(response)
         import :: dp, film_response_t, film_state_t, film_t
         class(film_state_t), intent(in) :: self
         !> Contact, oil and speed of the film
         type(film_t), intent(in) :: film
         !> h [m] and h' [m/s]
         real(dp), intent(in) :: thickness
         real(dp), intent(in) :: velocity
         !> y and y'
         real(dp), intent(in) :: inner(:)
         real(dp), intent(in) :: rate(:)
         type(film_response_t) :: response
      end function respond_to
   end interface

end module film_state
