!> A film with a state of its own, as a worked example of module film_state: a chain of films that relax one after the other towards
!> the film of the contact,
!>
!>     W = K (L - h) - C h' - k (h - y_n) ,      tau_i y_i' = y_(i-1) - y_i ,   y_0 = h .
!>
!> No oil does that. But all is linear, so that every motion of it is known.
module relaxing_film
   use film_law, only: film_t
   use film_state, only: film_response_t, film_state_t, state_number_t
   use kinds, only: dp
   use text, only: integer_text
   implicit none(type, external)
   private

   !> Films of the chain.
   integer, parameter, public :: chain_length = 10

   !> The law.
   type, extends(film_state_t), public :: relaxing_film_t
      !> K [N/m], C [N s/m], k [N/m] and L [m]
      real(dp) :: stiffness = 2.0e6_dp, damping = 1.5e3_dp, chain_stiffness = 1.0e6_dp, reach = 2.0e-4_dp
      !> tau_1 to tau_n [s]
      real(dp) :: times(chain_length) = 1.0e-5_dp*[1.0_dp, 2.0_dp, 3.0_dp, 5.0_dp, 7.0_dp, 10.0_dp, 15.0_dp, 20.0_dp, 30.0_dp, &
                                                   45.0_dp]
   contains
      procedure :: words
      procedure :: count => count_of_chain
      procedure :: number
      procedure :: rest
      procedure :: respond
   end type relaxing_film_t

contains

   !> The law in words.
   pure function words(self) result(sentence)
      class(relaxing_film_t), intent(in) :: self
      character(:), allocatable :: sentence

      sentence = 'chain of '//integer_text(size(self%times))//' relaxing films'
   end function words

   !> How many numbers the state has.
   pure integer function count_of_chain(self)
      class(relaxing_film_t), intent(in) :: self

      count_of_chain = size(self%times)
   end function count_of_chain

   !> A film of the chain counts as a film.
   pure function number(self, place)
      class(relaxing_film_t), intent(in) :: self
      integer, intent(in) :: place
      type(state_number_t) :: number

      number = state_number_t('relaxed_'//integer_text(min(place, self%count())), 'm', 1.0_dp)
   end function number

   !> At rest all films are that of the contact.
   pure function rest(self, film, thickness) result(inner)
      class(relaxing_film_t), intent(in) :: self
      !> Not asked: the law has coefficients of its own
      type(film_t), intent(in) :: film
      real(dp), intent(in) :: thickness
      real(dp), allocatable :: inner(:)

      allocate (inner(self%count()), source=thickness + 0.0_dp*film%radius)
   end function rest

   !> Load and residual, tau_i r_i = y_(i-1) - y_i - tau_i y_i'.
   pure function respond(self, film, thickness, velocity, inner, rate) result(response)
      class(relaxing_film_t), intent(in) :: self
      type(film_t), intent(in) :: film
      real(dp), intent(in) :: thickness
      real(dp), intent(in) :: velocity
      real(dp), intent(in) :: inner(:)
      real(dp), intent(in) :: rate(:)
      type(film_response_t) :: response
      integer :: n, i

      n = self%count()
      response%load = self%stiffness*(self%reach - thickness) - self%damping*velocity &
                      - self%chain_stiffness*(thickness - inner(n)) + 0.0_dp*film%radius
      response%by_film = -self%stiffness - self%chain_stiffness
      response%by_velocity = -self%damping
      allocate (response%by_inner(n), response%residual_by_film(n), response%residual_by_velocity(n), source=0.0_dp)
      allocate (response%residual_by_inner(n, n), response%residual_by_rate(n, n), source=0.0_dp)
      response%by_inner(n) = self%chain_stiffness
      response%residual = ([thickness, inner(:n - 1)] - inner)/self%times - rate
      response%residual_by_film(1) = 1.0_dp/self%times(1)
      do i = 1, n
         if (i > 1) response%residual_by_inner(i, i - 1) = 1.0_dp/self%times(i)
         response%residual_by_inner(i, i) = -1.0_dp/self%times(i)
         response%residual_by_rate(i, i) = -1.0_dp
      end do
   end function respond

end module relaxing_film
