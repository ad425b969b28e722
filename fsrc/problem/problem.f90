!> What moves: a mass under a force, between two flanks that both carry a film of the same law,
!>
!>     m z'' = W(h, z') - W(b - h, -z') - F(t) - m g ,   0 < h < b .
!>
!> h is the film of the drive flank, b - h that of the coast flank, b the backlash. Without a backlash there is no coast flank and
!> this is (1). What both films carry together is called the net load.
!>
!> Teeth may give: a spring stands between the gear at z and each film, and its compression is the film's load,
!>
!>     W(h_1, h_1') = d_1/kappa ,   d_1 = h_1 - z ,      W(h_2, h_2') = d_2/kappa ,   d_2 = h_2 - (b - z) ,
!>     m z'' = (d_1 - d_2)/kappa - F(t) - m g .
!>
!> A damped tooth deflects by a D of its own, tau D' = d - D (module flank_contact), and D stands in the place of d in h_1 and h_2.
!>
!> The state of a motion is h_1 and z', with elastic teeth also d_1, and d_2 where there are two flanks (a compression keeps its
!> digits however stiff the tooth is, a position would not), of damped teeth D_1 and D_2, and where films have a state of their own
!> the numbers of both.
module problem
   use film_law, only: width_compression
   use film_state, only: load_t, state_number_t
   use flank_contact, only: contact_of, film_under, flank_contact_t, inner_count, inner_number, is_damped, is_elastic, &
      load_at_rest, compliance_at_rest
   use force, only: force_of, force_t, largest_oscillation, largest_size
   use kinds, only: dp
   use scene_types, only: least_static_load, scene_t
   implicit none(type, external)
   private

   !> What moves, and where it starts.
   type, public :: problem_t
      !> The contact of each flank
      type(flank_contact_t) :: contact = flank_contact_t()
      type(force_t) :: force = force_t()
      !> Mass m [kg] and weight m g [N]
      real(dp) :: mass = 0.0_dp
      real(dp) :: weight = 0.0_dp
      !> Backlash b [m]; huge: there is one flank
      real(dp) :: backlash = huge(1.0_dp)
      !> Frequency f_exc [Hz]; a start of the force's period is the start of the motion
      real(dp) :: frequency = 0.0_dp
      !> h [m] and z' [m/s] at the start; no film: there is none that carries the static load
      real(dp) :: initial_film = 0.0_dp
      real(dp) :: initial_velocity = 0.0_dp
      !> Films of drive and coast flank at rest under the static load [m], found once for what is asked of them in every period; who
      !> changes contact, loads or backlash sets them anew. Negative: not found yet
      real(dp) :: rest_films(2) = -1.0_dp
   end type problem_t

   !> The contacts of a problem: that of the drive flank, and where there is a backlash that of the coast flank.
   integer, parameter, public :: most_contacts = 2, drive_flank = 1, coast_flank = 2

   !> Places of the numbers of a state: film of the drive flank h_1 [m], velocity z' [m/s], and of elastic teeth compressions d_1
   !> and d_2 [m]; behind them stand deflections of damped teeth, and the states of the films, of the drive flank and then of the
   !> coast flank.
   integer, parameter, public :: of_film = 1, of_velocity = 2, of_drive_compression = 3, of_coast_compression = 4

   !> The film in the neighbourhood of rest, h'' + d h' + k h = 0 with the period of the force as the unit of time.
   type, public :: settling_t
      !> Stiffness k [1/periods^2]
      real(dp) :: stiffness = huge(1.0_dp)
      !> Damping d, 0 where Lienard's variable holds it [1/periods]
      real(dp) :: damping = 0.0_dp
      !> Smaller one of the rates at which it creeps, or turns and swings [1/periods]
      real(dp) :: rate = huge(1.0_dp)
   end type settling_t

   public :: problem_of, has_two_flanks, has_elastic_teeth, has_damped_teeth, has_inner_numbers, same_kind, contact_count, &
             compression_count, deflection_places, moving_numbers, state_size, state_numbers, inner_places, static_load, &
             largest_applied_force, force_to_resolve, closing_velocity, film_at_rest, films_at_rest, films_near_rest, rigid_films, &
             film_unit, thinner_in_units, acceleration_by_lengths, loads_at_rest, reference_films, reference_film, thinner_film, &
             linearise, settling_of

contains

   !> The problem of a scene. Without an initial film it starts from the steady one.
   pure type(problem_t) function problem_of(scene) result(problem)
      !> Checked scene
      type(scene_t), intent(in) :: scene

      problem%contact = contact_of(scene)
      problem%force = force_of(scene%excitation)
      problem%mass = scene%excitation%mass
      problem%weight = scene%excitation%weight()
      problem%frequency = scene%excitation%frequency
      if (scene%contact%backlash > 0.0_dp) problem%backlash = scene%contact%backlash
      problem%initial_film = scene%film%initial_film
      if (.not. problem%initial_film > 0.0_dp) problem%initial_film = film_at_rest(problem, scene%excitation%static_load())
      problem%initial_velocity = scene%film%initial_velocity
      problem%rest_films = films_at_rest(problem, static_load(problem))
   end function problem_of

   !> Static load Q + m g [N].
   elemental real(dp) function static_load(problem)
      type(problem_t), intent(in) :: problem

      static_load = problem%force%steady + problem%weight
   end function static_load

   !> Largest |F + m g| of a period [N].
   pure real(dp) function largest_applied_force(problem)
      type(problem_t), intent(in) :: problem

      largest_applied_force = largest_size(problem%force, problem%weight)
   end function largest_applied_force

   !> Whether there is a coast flank.
   elemental logical function has_two_flanks(problem)
      type(problem_t), intent(in) :: problem

      has_two_flanks = problem%backlash < huge(1.0_dp)
   end function has_two_flanks

   !> Whether the teeth are elastic.
   elemental logical function has_elastic_teeth(problem)
      type(problem_t), intent(in) :: problem

      has_elastic_teeth = is_elastic(problem%contact)
   end function has_elastic_teeth

   !> Whether they are damped.
   elemental logical function has_damped_teeth(problem)
      type(problem_t), intent(in) :: problem

      has_damped_teeth = is_damped(problem%contact)
   end function has_damped_teeth

   !> Whether motions of two problems go by the same equations: films of one law, flanks and numbers alike.
   elemental logical function same_kind(problem, other)
      type(problem_t), intent(in) :: problem
      type(problem_t), intent(in) :: other

      same_kind = problem%contact%film%kernel == other%contact%film%kernel .and. &
                  problem%contact%state_law == other%contact%state_law .and. &
                  (has_two_flanks(problem) .eqv. has_two_flanks(other)) .and. &
                  (has_elastic_teeth(problem) .eqv. has_elastic_teeth(other)) .and. &
                  (has_damped_teeth(problem) .eqv. has_damped_teeth(other))
   end function same_kind

   !> Whether contacts have numbers of their own, beside film and velocity.
   elemental logical function has_inner_numbers(problem)
      type(problem_t), intent(in) :: problem

      has_inner_numbers = state_size(problem) > of_velocity
   end function has_inner_numbers

   !> How many contacts there are.
   elemental integer function contact_count(problem)
      type(problem_t), intent(in) :: problem

      contact_count = merge(2, 1, has_two_flanks(problem))
   end function contact_count

   !> Velocity at which the gear closes the gap of a contact [m/s].
   elemental real(dp) function closing_velocity(contact, velocity)
      !> Number of the contact
      integer, intent(in) :: contact
      !> Velocity of the gear z' [m/s]
      real(dp), intent(in) :: velocity

      closing_velocity = merge(-velocity, velocity, contact == drive_flank)
   end function closing_velocity

   !> How many compressions a state has, with the deflections of damped teeth.
   elemental integer function compression_count(problem)
      type(problem_t), intent(in) :: problem

      compression_count = merge(contact_count(problem), 0, has_elastic_teeth(problem))
      if (has_damped_teeth(problem)) compression_count = 2*compression_count
   end function compression_count

   !> First and last of the deflections of damped teeth.
   pure function deflection_places(problem) result(places)
      type(problem_t), intent(in) :: problem
      integer :: places(2)

      places = of_velocity + contact_count(problem) + [1, contact_count(problem)]
   end function deflection_places

   !> How many numbers of a state show how gear and teeth stand and move: film, velocity, and what contacts are compressed by. They
   !> are its first ones; states of films stand behind them.
   elemental integer function moving_numbers(problem)
      type(problem_t), intent(in) :: problem

      moving_numbers = of_velocity + compression_count(problem)
   end function moving_numbers

   !> How many numbers a state has.
   elemental integer function state_size(problem)
      type(problem_t), intent(in) :: problem

      state_size = of_velocity + compression_count(problem) + contact_count(problem)*inner_count(problem%contact)
   end function state_size

   !> First and last of the numbers of a film's own state.
   pure function inner_places(problem, contact) result(places)
      type(problem_t), intent(in) :: problem
      !> Number of the contact
      integer, intent(in) :: contact
      integer :: places(2)

      places = of_velocity + compression_count(problem) + [(contact - 1)*inner_count(problem%contact) + 1, &
                                                           contact*inner_count(problem%contact)]
   end function inner_places

   !> The numbers of a state, in their order.
   pure function state_numbers(problem) result(numbers)
      type(problem_t), intent(in) :: problem
      type(state_number_t) :: numbers(state_size(problem))
      character(*), parameter :: flanks(2) = ['drive_', 'coast_']
      integer :: places(2), flank, i

      numbers(of_film) = state_number_t('film', 'm')
      numbers(of_velocity) = state_number_t('velocity', 'm/s')
      do flank = 1, contact_count(problem)
         if (has_elastic_teeth(problem)) numbers(of_velocity + flank) = state_number_t(flanks(flank)//'compression', 'm')
         if (has_damped_teeth(problem)) numbers(of_velocity + contact_count(problem) + flank) = &
            state_number_t(flanks(flank)//'deflection', 'm')
         places = inner_places(problem, flank)
         do i = places(1), places(2)
            numbers(i) = inner_number(problem%contact, i - places(1) + 1)
            numbers(i)%name = flanks(flank)//numbers(i)%name
         end do
      end do
   end function state_numbers

   !> The thinner one of the films of both flanks, of rigid teeth [m].
   elemental real(dp) function thinner_film(problem, film)
      type(problem_t), intent(in) :: problem
      !> Film of the drive flank h [m]
      real(dp), intent(in) :: film

      thinner_film = min(film, problem%backlash - film)
   end function thinner_film

   !> Film of the drive flank at rest under a load [m], 0 where there is none.
   elemental real(dp) function film_at_rest(problem, load) result(film)
      type(problem_t), intent(in) :: problem
      !> Q + m g [N]
      real(dp), intent(in) :: load
      real(dp) :: films(2)

      films = films_at_rest(problem, load)
      film = films(1)
   end function film_at_rest

   !> Films of drive and coast flank at rest under a load [m]: 0 where there are none, the second huge where there is one flank.
   pure function films_at_rest(problem, load) result(films)
      type(problem_t), intent(in) :: problem
      !> Q + m g [N]
      real(dp), intent(in) :: load
      real(dp) :: films(2), loads(2)

      films = 0.0_dp
      if (has_two_flanks(problem)) then
         call loads_at_rest(problem, load, loads(1), loads(2))
         if (loads(1) > 0.0_dp) films = [film_under(problem%contact, loads(1)), film_under(problem%contact, loads(2))]
      else if (load > 0.0_dp) then
         films = [film_under(problem%contact, load), huge(1.0_dp)]
      end if
   end function films_at_rest

   !> Films at rest under the static load [m]: 0 where there are none, the second huge where there is one flank.
   pure function steady_films(problem) result(films)
      type(problem_t), intent(in) :: problem
      real(dp) :: films(2)

      films = problem%rest_films
      if (films(1) < 0.0_dp) films = films_at_rest(problem, static_load(problem))
   end function steady_films

   !> Films at rest, near enough to show how films settle: of rigid teeth about a film near that of the drive flank at rest [m].
   pure function films_near_rest(problem, film) result(films)
      type(problem_t), intent(in) :: problem
      !> Near that of the drive flank at rest [m]
      real(dp), intent(in) :: film
      real(dp) :: films(2)

      films = rigid_films(problem, film)
      if (has_elastic_teeth(problem)) films = steady_films(problem)
   end function films_near_rest

   !> Films of drive and coast flank of rigid teeth, the second huge where there is one flank [m].
   pure function rigid_films(problem, film) result(films)
      type(problem_t), intent(in) :: problem
      !> Film of the drive flank [m]
      real(dp), intent(in) :: film
      real(dp) :: films(2)

      films = [film, problem%backlash - film]
   end function rigid_films

   !> Film that states of rigid teeth are distinguished in: that of the start, between two flanks the thinner one at rest [m].
   elemental real(dp) function film_unit(problem)
      type(problem_t), intent(in) :: problem

      film_unit = problem%initial_film
      if (has_two_flanks(problem)) film_unit = reference_film(problem)
   end function film_unit

   !> The thinner one of the films of rigid teeth in some unit [-].
   elemental real(dp) function thinner_in_units(problem, film, unit) result(thinner)
      type(problem_t), intent(in) :: problem
      !> Film of the drive flank over the unit [-]
      real(dp), intent(in) :: film
      !> [m]
      real(dp), intent(in) :: unit

      thinner = film
      if (has_two_flanks(problem)) thinner = min(film, problem%backlash/unit - film)
   end function thinner_in_units

   !> Force that steps have to resolve [N]: the static load, which presses on one flank; between two flanks it may be nothing, and
   !> all of the force counts.
   pure real(dp) function force_to_resolve(problem, static)
      type(problem_t), intent(in) :: problem
      !> Q + m g [N]
      real(dp), intent(in) :: static

      force_to_resolve = static
      if (has_two_flanks(problem)) force_to_resolve = max(abs(static) + largest_oscillation(problem%force), least_static_load)
   end function force_to_resolve

   !> Acceleration by which a length is off that contacts are compressed by; 0 with rigid teeth [m/s2].
   elemental real(dp) function acceleration_by_lengths(problem, length) result(acceleration)
      type(problem_t), intent(in) :: problem
      !> [m]
      real(dp), intent(in) :: length

      acceleration = 0.0_dp
      if (has_elastic_teeth(problem)) acceleration = length/(problem%contact%compliance*problem%mass)
   end function acceleration_by_lengths

   !> Loads of both films of a tooth that rests between its flanks under a load. Their difference is that load, and the films that
   !> carry them fill the backlash and what both springs give,
   !>
   !>     h(W_1) + h(W_2) - kappa (W_1 + W_2) = b ,      W_1 - W_2 = Q + m g .
   !>
   !> The left side falls with the smaller one of both loads, whose logarithm is found by bisection: so both films have all their
   !> digits. Loads that are too large for their films count as films of no thickness.
   pure subroutine loads_at_rest(problem, load, drive_load, coast_load)
      !> With two flanks
      type(problem_t), intent(in) :: problem
      !> Q + m g [N]
      real(dp), intent(in) :: load
      !> W_1 and W_2 [N], both 0 where no films carry them
      real(dp), intent(out) :: drive_load
      real(dp), intent(out) :: coast_load
      !> Logarithms of loads between which the smaller one lies
      real(dp), parameter :: least = -200.0_dp, most = 80.0_dp
      !> Share of the backlash by which no root of rounded numbers misses it
      real(dp), parameter :: missed = 1.0e-6_dp
      real(dp) :: low, high, middle, smaller, larger, thick, thin, excess
      real(dp), dimension(2) :: wider, by_film, by_load

      low = least
      high = most
      do
         middle = 0.5_dp*(low + high)
         smaller = exp(middle)
         larger = smaller + abs(load)
         thin = film_under(problem%contact, larger)
         thick = film_under(problem%contact, smaller)
         excess = thick + thin - problem%contact%compliance*(smaller + larger) - problem%backlash
         if (thin > 0.0_dp) then
            call width_compression(problem%contact%film, [thick, thin], [smaller, larger], wider, by_film, by_load)
            excess = excess - sum(wider)
         else
            excess = -problem%backlash
         end if
         if (.not. (middle > low .and. middle < high)) exit
         if (excess > 0.0_dp) then
            low = middle
         else
            high = middle
         end if
      end do
      ! The bracket may have closed upon the largest load that films of the law carry, or where none carries the load at all, and
      ! not upon the backlash.
      if (.not. thin > 0.0_dp .or. abs(excess) > missed*(problem%backlash + thick)) then
         smaller = 0.0_dp
         larger = 0.0_dp
      end if
      drive_load = merge(larger, smaller, load > 0.0_dp)
      coast_load = merge(smaller, larger, load > 0.0_dp)
   end subroutine loads_at_rest

   !> Films of drive and coast flank at rest under the static load, or where there are none about those of the start [m].
   pure function reference_films(problem) result(films)
      type(problem_t), intent(in) :: problem
      real(dp) :: films(2)

      films = steady_films(problem)
      if (films(1) > 0.0_dp) return
      films = [problem%initial_film, problem%backlash - problem%initial_film]
      ! Elastic teeth let a film grow beyond the backlash.
      if (.not. films(2) > 0.0_dp) films(2) = films(1)
   end function reference_films

   !> The thinner one of them [m].
   elemental real(dp) function reference_film(problem)
      type(problem_t), intent(in) :: problem

      reference_film = minval(reference_films(problem))
   end function reference_film

   !> Stiffness [N/m] and damping [N s/m] against slow motions of the gear: of each film -dW/dh and -dW/dh' without squeeze
   !> velocity, with elastic teeth in series with its spring.
   pure subroutine linearise(problem, films, stiffness, damping)
      type(problem_t), intent(in) :: problem
      !> Films of drive and coast flank [m]
      real(dp), intent(in) :: films(2)
      real(dp), intent(out) :: stiffness
      real(dp), intent(out) :: damping
      type(load_t) :: load
      real(dp) :: share, own_share, compliance
      integer :: flank

      stiffness = 0.0_dp
      damping = 0.0_dp
      do flank = 1, contact_count(problem)
         load = load_at_rest(problem%contact, films(flank), 0.0_dp)
         ! What of the gear's way the film takes; the spring takes the rest.
         call compliance_at_rest(problem%contact, films(flank), load%load, own_share, compliance)
         share = 1.0_dp
         if (has_elastic_teeth(problem)) share = 1.0_dp/(own_share - compliance*load%by_film)
         stiffness = stiffness - load%by_film*share
         damping = damping - load%by_velocity*share*share*own_share
         ! What is left of the gear's way is that of the tooth.
         if (has_damped_teeth(problem)) damping = damping + problem%contact%retardation*problem%contact%damped_share* &
                                                  problem%contact%compliance*(load%by_film*share)**2
      end do
   end subroutine linearise

   !> How the film settles by its law alone, without watching it. Its rate is that of a thinner film at rest if it is there: a tooth
   !> in flight does not settle, nor is its motion small.
   pure type(settling_t) function settling_of(problem, films, rest_films)
      type(problem_t), intent(in) :: problem
      !> Films of drive and coast flank, and those at rest, near enough [m]
      real(dp), intent(in) :: films(2)
      real(dp), intent(in) :: rest_films(2)
      type(settling_t) :: rest

      settling_of = settling_about(problem, films)
      if (.not. minval(films) > minval(rest_films)) return
      rest = settling_about(problem, rest_films)
      settling_of%rate = max(settling_of%rate, rest%rate)
   end function settling_of

   !> Settling about some films.
   pure type(settling_t) function settling_about(problem, films) result(settling)
      type(problem_t), intent(in) :: problem
      real(dp), intent(in) :: films(2)
      real(dp) :: stiffness, damping, discriminant

      call linearise(problem, films, stiffness, damping)
      associate (d => settling%damping, k => settling%stiffness)
         d = damping/(problem%mass*problem%frequency)
         k = stiffness/(problem%mass*problem%frequency*problem%frequency)
         discriminant = d*d - 4.0_dp*k
         settling%rate = sqrt(abs(k))
         if (discriminant > 0.0_dp) settling%rate = 2.0_dp*k/(d + sqrt(discriminant))
      end associate
   end function settling_about

end module problem
