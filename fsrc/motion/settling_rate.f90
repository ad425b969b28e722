!> How a film settles by its law alone, without watching it. Where that takes many periods of the force, the motion may move less
!> in a period than the errors of its states and still have far to go.
module settling_rate
   use film_law, only: film_load, film_t
   use kinds, only: dp
   implicit none(type, external)
   private

   !> The film in the neighbourhood of rest, h'' + d h' + k h = 0 with the period of the force as the unit of time.
   type, public :: settling_t
      !> Stiffness k [1/periods^2]
      real(dp) :: stiffness = huge(1.0_dp)
      !> Damping d, 0 where the momentum of the motion holds it [1/periods]
      real(dp) :: damping = 0.0_dp
      !> Smaller one of the rates at which it creeps, or turns and swings [1/periods]
      real(dp) :: rate = huge(1.0_dp)
   end type settling_t

   public :: settling_of

contains

   !> Settling of a film without squeeze velocity. Its rate is that of a thinner film at rest if it is there: a tooth in flight does
   !> not settle, nor is its motion small.
   pure type(settling_t) function settling_of(film, thickness, rest_thickness, mass, frequency)
      !> The film
      type(film_t), intent(in) :: film
      !> Film thickness h [m]
      real(dp), intent(in) :: thickness
      !> Film at rest, near enough [m]
      real(dp), intent(in) :: rest_thickness
      !> Mass m [kg]
      real(dp), intent(in) :: mass
      !> Frequency of the force [Hz]
      real(dp), intent(in) :: frequency
      type(settling_t) :: rest

      settling_of = linear_settling(film, thickness, mass, frequency)
      if (.not. thickness > rest_thickness) return
      rest = linear_settling(film, rest_thickness, mass, frequency)
      settling_of%rate = max(settling_of%rate, rest%rate)
   end function settling_of

   !> Settling about one film.
   pure type(settling_t) function linear_settling(film, thickness, mass, frequency) result(settling)
      type(film_t), intent(in) :: film
      real(dp), intent(in) :: thickness
      real(dp), intent(in) :: mass
      real(dp), intent(in) :: frequency
      real(dp) :: load, load_by_film, load_by_velocity, discriminant

      call film_load(film, thickness, 0.0_dp, load, load_by_film, load_by_velocity)
      associate (d => settling%damping, k => settling%stiffness)
         d = -load_by_velocity/(mass*frequency)
         k = -load_by_film/(mass*frequency*frequency)
         discriminant = d*d - 4.0_dp*k
         settling%rate = sqrt(abs(k))
         if (discriminant > 0.0_dp) settling%rate = 2.0_dp*k/(d + sqrt(discriminant))
      end associate
   end function linear_settling

end module settling_rate
