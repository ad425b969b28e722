!> The list of films with a state of their own.
!>
!> To add a law: extend film_state_t in a file of its own (tests/unit/relaxing_film.f90 is a worked example), give it a word and a
!> code in scene_types, and let the program add it with `add_film_state` before it sets up a problem.
module film_states
   use film_law, only: film_t
   use film_state, only: film_response_t, film_state_t, state_number_t
   use kinds, only: dp
   implicit none(type, external)
   private

   !> A law that a program has added, and the code by which scenes choose it.
   type :: added_t
      integer :: law = 0
      class(film_state_t), pointer :: film => null()
   end type added_t

   integer, parameter :: most_added = 4
   type(added_t) :: added(most_added)

   public :: add_film_state, place_of_law, words_of_state, count_of_state, number_of_state, rest_of_state, respond_of_state

contains

   !> Add a law of a program's own, or put it in the place of one added before under this code.
   subroutine add_film_state(law, film)
      !> Code of the law in a scene, that of no other law
      integer, intent(in) :: law
      !> The law; it has to live as long as the scenes that choose it
      class(film_state_t), target, intent(in) :: film
      integer :: place

      place = findloc(added%law, law, dim=1)
      if (place == 0) place = findloc(added%law, 0, dim=1)
      added(place)%law = law
      added(place)%film => film
   end subroutine add_film_state

   !> Place in this list of the law that a scene chooses, 0 where its films have no state of their own.
   pure integer function place_of_law(law)
      !> Code of a scene
      integer, intent(in) :: law

      place_of_law = findloc(added%law, law, dim=1)
      if (law == 0) place_of_law = 0
   end function place_of_law

   !> The law in words.
   pure function words_of_state(place) result(words)
      !> In the list
      integer, intent(in) :: place
      character(:), allocatable :: words

      words = added(place)%film%words()
   end function words_of_state

   !> How many numbers the state of a film has; none without a place in the list.
   pure integer function count_of_state(place)
      integer, intent(in) :: place

      count_of_state = 0
      if (place > 0) count_of_state = added(place)%film%count()
   end function count_of_state

   !> A number of the state.
   pure function number_of_state(place, which) result(number)
      integer, intent(in) :: place
      !> From 1 to count_of_state
      integer, intent(in) :: which
      type(state_number_t) :: number

      number = added(place)%film%number(which)
   end function number_of_state

   !> The state of a film that has stood still for long.
   pure function rest_of_state(place, film, thickness) result(inner)
      integer, intent(in) :: place
      type(film_t), intent(in) :: film
      !> h [m]
      real(dp), intent(in) :: thickness
      real(dp), allocatable :: inner(:)

      inner = added(place)%film%rest(film, thickness)
   end function rest_of_state

   !> Load and residual of a film at a point in time.
   pure function respond_of_state(place, film, thickness, velocity, inner, rate) result(response)
      integer, intent(in) :: place
      type(film_t), intent(in) :: film
      !> h [m] and h' [m/s]
      real(dp), intent(in) :: thickness
      real(dp), intent(in) :: velocity
      !> y and y'
      real(dp), intent(in) :: inner(:)
      real(dp), intent(in) :: rate(:)
      type(film_response_t) :: response

      response = added(place)%film%respond(film, thickness, velocity, inner, rate)
   end function respond_of_state

end module film_states
