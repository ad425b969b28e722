!> A contact of a flank: a film, the compliance of what stands behind it, and a state of its own,
!>
!>     W(h, h', y) = d/kappa      with elastic teeth, else d = 0.
!>
!> h is its film, d the compression of its spring, y the state of the film where its law has one. Rigid and elastic teeth, films
!> with and without a state are contacts of different numbers; one flank or two are one contact or two. Flanks that bend are
!> compressed by what follows the width of the contact beside d, w(h, W) of module film_law.
!>
!> A damped tooth resists its deflection D as well, W = k D + c D' or tau D' = kappa_t W - D with kappa_t = 1/k, tau = c/k. Then d
!> is no more than the load in other units, and the contact is compressed by d - kappa_t W + D.
module flank_contact
   use film_law, only: film_kernel, film_load, film_loads, film_t, kept_load, kernel_of, law_words, mixed_film_loads, most_films, &
      never_pulls, new_film, overflow_load, squeeze_velocities, squeeze_velocity, steady_film, width_compression
   use film_state, only: film_response_t, load_t, state_number_t
   use film_states, only: count_of_state, number_of_state, place_of_law, respond_of_state, rest_of_state, words_of_state
   use flank_elasticity, only: flank_compliance, tooth_compliance
   use kinds, only: dp
   use linear_equations, only: solve_linear
   use scene_types, only: film_choice_t, scene_t
   use squeeze_of_load, only: load_carried, load_too_large
   implicit none(type, external)
   private

   !> A contact.
   type, public :: flank_contact_t
      type(film_t) :: film = film_t()
      !> Place in module film_states of the law of a film with a state of its own; 0: it has none
      integer :: state_law = 0
      !> kappa [m/N]; 0: rigid
      real(dp) :: compliance = 0.0_dp
      !> tau of a damped tooth [s], and the share of kappa that is the tooth's, which flattens or bends beside it [-]; 0: not damped
      real(dp) :: retardation = 0.0_dp
      real(dp) :: damped_share = 0.0_dp
   end type flank_contact_t

   !> Equations of films at nodes: h' = w(h, W), the velocity that carries a load, or W(h, h') = W.
   type, public :: film_equations_t
      !> Whether it is the first one, and whether the film has such a velocity, or a load; if not, whether because the load is
      !> beyond all
      logical, dimension(most_films) :: of_velocities, exists, overloaded
      !> w [m/s] or W [N], with its slopes in h and in W or h'
      real(dp), dimension(most_films) :: value, by_film, by_other
   end type film_equations_t

   !> What the state of a flank with a film in nodes reports of it: its minimum film thickness, its largest pressure, the gap
   !> that the gear leaves, the film at the largest pressure, and the one in the middle. The pressures themselves stay with the
   !> engine.
   integer, parameter, public :: of_smallest_film = 1, of_pressure = 2, of_gap = 3, of_film_at_pressure = 4, of_central_film = 5
   character(*), parameter :: nodal_numbers(5) = [character(16) :: 'smallest_film', 'pressure', 'gap', 'film_at_pressure', &
                                                  'central_film']
   character(*), parameter :: nodal_units(5) = [character(2) :: 'm', 'Pa', 'm', 'm', 'm']

   !> Slope of the load over the velocity of a film without squeeze, over that slope where it gives no velocity any more
   real(dp), parameter :: flattest = 1.0e3_dp

   public :: contact_of, contact_words, is_elastic, is_damped, carries_positive_loads, keeps_load, is_costly, inner_count, &
             inner_number, inner_at_rest, film_under, load_of_contact, load_at_rest, loads_of_contact, mixed_loads, &
             velocity_under, equations_of_films, compliance_at_rest, kernel_of_contact

contains

   !> The contact of a scene.
   pure type(flank_contact_t) function contact_of(scene) result(contact)
      type(scene_t), intent(in) :: scene

      contact%film = new_film(scene)
      contact%state_law = place_of_law(scene%film%law)
      contact%compliance = flank_compliance(scene)
      if (.not. scene%contact%damping_ratio > 0.0_dp) return
      contact%damped_share = tooth_compliance(scene)/contact%compliance
      ! Slow motions on the stiffness k lose what c = 2 zeta sqrt(k m) loses, whatever part of it is the tooth's.
      contact%retardation = 2.0_dp*scene%contact%damping_ratio*sqrt(scene%excitation%mass/scene%contact%stiffness) &
                            /(scene%contact%stiffness*tooth_compliance(scene))
   end function contact_of

   !> The law that the group &film chooses, in words.
   pure function contact_words(choice) result(words)
      type(film_choice_t), intent(in) :: choice
      character(:), allocatable :: words

      if (place_of_law(choice%law) > 0) then
         words = words_of_state(place_of_law(choice%law))
      else
         words = law_words(choice)
      end if
   end function contact_words

   !> Kernel of its film, which loops over time choose once; none where the film has a state of its own.
   pure function kernel_of_contact(contact) result(kernel)
      type(flank_contact_t), intent(in) :: contact
      procedure(film_kernel), pointer :: kernel

      kernel => kernel_of(contact%film)
   end function kernel_of_contact

   !> Whether its flank or tooth is elastic.
   elemental logical function is_elastic(contact)
      type(flank_contact_t), intent(in) :: contact

      is_elastic = contact%compliance > 0.0_dp
   end function is_elastic

   !> Whether its tooth is damped.
   elemental logical function is_damped(contact)
      type(flank_contact_t), intent(in) :: contact

      is_damped = contact%retardation > 0.0_dp
   end function is_damped

   !> Numbers of the state of its film.
   elemental integer function inner_count(contact)
      type(flank_contact_t), intent(in) :: contact

      inner_count = count_of_state(contact%state_law)
      if (contact%film%in_nodes) inner_count = size(nodal_numbers)
   end function inner_count

   !> One of them.
   pure function inner_number(contact, which) result(number)
      type(flank_contact_t), intent(in) :: contact
      !> From 1 to inner_count
      integer, intent(in) :: which
      type(state_number_t) :: number

      if (contact%film%in_nodes) then
         number = state_number_t(trim(nodal_numbers(which)), trim(nodal_units(which)))
      else
         number = number_of_state(contact%state_law, which)
      end if
   end function inner_number

   !> Load of the film and its slopes, at a state of the film's own if it has one.
   pure type(load_t) function load_of_contact(contact, thickness, velocity, inner) result(load)
      type(flank_contact_t), intent(in) :: contact
      !> Film thickness h > 0 [m]
      real(dp), intent(in) :: thickness
      !> Film velocity h' [m/s]
      real(dp), intent(in) :: velocity
      !> y, as many as inner_count
      real(dp), intent(in) :: inner(:)
      type(film_response_t) :: response

      if (contact%state_law == 0) then
         call film_load(contact%film, thickness, velocity, load%load, load%by_film, load%by_velocity)
      else
         response = respond_of_state(contact%state_law, contact%film, thickness, velocity, inner, spread(0.0_dp, 1, size(inner)))
         load = response%load_t
      end if
   end function load_of_contact

   !> Load of a film whose own state has followed it at leisure, and its slopes against slow motions: with r = 0 and small motions
   !> of h by exp(s t), y moves by Y_0 + s Y_1 with r_y Y_0 = -r_h, r_y Y_1 = -r_h' - r_y' Y_0, and W by W_h + W_y Y_0
   !> + s (W_h' + W_y Y_1).
   pure type(load_t) function load_at_rest(contact, thickness, velocity) result(load)
      type(flank_contact_t), intent(in) :: contact
      !> Film thickness h > 0 [m]
      real(dp), intent(in) :: thickness
      !> Film velocity h' [m/s]
      real(dp), intent(in) :: velocity
      type(film_response_t) :: response
      real(dp), allocatable :: inner(:), follows(:, :)
      logical :: solved

      if (contact%state_law == 0) then
         call film_load(contact%film, thickness, velocity, load%load, load%by_film, load%by_velocity)
         return
      end if
      allocate (inner, source=inner_at_rest(contact, thickness))
      response = respond_of_state(contact%state_law, contact%film, thickness, velocity, inner, spread(0.0_dp, 1, size(inner)))
      load = response%load_t
      allocate (follows(size(inner), 1))
      follows(:, 1) = -response%residual_by_film
      call solve_linear(response%residual_by_inner, follows, solved)
      if (.not. solved) return
      load%by_film = load%by_film + dot_product(response%by_inner, follows(:, 1))
      follows(:, 1) = -response%residual_by_velocity - matmul(response%residual_by_rate, follows(:, 1))
      call solve_linear(response%residual_by_inner, follows, solved)
      if (solved) load%by_velocity = load%by_velocity + dot_product(response%by_inner, follows(:, 1))
   end function load_at_rest

   !> Loads of many states of one rigid contact.
   pure subroutine loads_of_contact(contact, thicknesses, velocities, inner, loads)
      type(flank_contact_t), intent(in) :: contact
      !> h [m] and h' [m/s]
      real(dp), intent(in) :: thicknesses(:)
      real(dp), intent(in) :: velocities(:)
      !> y: state, number
      real(dp), intent(in) :: inner(:, :)
      !> W [N]
      real(dp), intent(out) :: loads(:)
      type(load_t) :: load
      integer :: i

      if (contact%state_law == 0) then
         call film_loads(contact%film, thicknesses, velocities, loads)
         return
      end if
      do i = 1, size(loads)
         load = load_of_contact(contact, thicknesses(i), velocities(i), inner(i, :))
         loads(i) = load%load
      end do
   end subroutine loads_of_contact

   !> Loads of many contacts whose films have no state of their own.
   pure subroutine mixed_loads(contacts, contact_of_state, thicknesses, velocities, loads)
      type(flank_contact_t), intent(in) :: contacts(:)
      !> Which of the contacts each state is of
      integer, intent(in) :: contact_of_state(:)
      !> h [m] and h' [m/s]
      real(dp), intent(in) :: thicknesses(:)
      real(dp), intent(in) :: velocities(:)
      type(load_t), intent(out) :: loads(:)
      real(dp), dimension(size(loads)) :: values, by_film, by_velocity
      integer :: i

      call mixed_film_loads(contacts%film, contact_of_state, thicknesses, velocities, values, by_film, by_velocity)
      do i = 1, size(loads)
         loads(i) = load_t(values(i), by_film(i), by_velocity(i))
      end do
   end subroutine mixed_loads

   !> Velocity at which a film without a state of its own carries a load, or one that is given where it carries it at none.
   pure real(dp) function velocity_under(contact, thickness, load, near) result(velocity)
      type(flank_contact_t), intent(in) :: contact
      !> h [m] and W [N]
      real(dp), intent(in) :: thickness
      real(dp), intent(in) :: load
      !> What it is likely to be [m/s]
      real(dp), intent(in) :: near
      real(dp) :: by_film, by_load
      integer :: outcome

      call squeeze_velocity(contact%film, thickness, load, near, velocity, by_film, by_load, outcome)
      if (outcome /= load_carried) velocity = near
   end function velocity_under

   !> Equations of films without a state of their own: those of velocities where a load gives its velocity. A short step leaves the
   !> load where it is, but not the velocity of the film, and where loads hardly give it an equation of them would be far from
   !> linear. Of a film that may pull or holds on to a part of its load it is so until that part is all that is left, which gives no
   !> velocity: from there on where the step is so short that a load that changes moves the velocity by more than the law says.
   pure subroutine equations_of_films(contact, n, thickness, load, velocity, follows, equations)
      type(flank_contact_t), intent(in) :: contact
      !> How many, at most most_films
      integer, intent(in) :: n
      !> h > 0 [m], W [N] and h' [m/s] where it is asked for
      real(dp), intent(in) :: thickness(n)
      real(dp), intent(in) :: load(n)
      real(dp), intent(in) :: velocity(n)
      !> By how much the step lets h' follow W, about [m/(N s)]
      real(dp), intent(in) :: follows
      !> The first n of them are set
      type(film_equations_t), intent(out) :: equations
      integer :: outcome(most_films), i

      associate (these => equations)
         call squeeze_velocities(contact%film, n, thickness, load, velocity, these%value, these%by_film, these%by_other, outcome)
         these%of_velocities = .true.
         these%exists(:n) = outcome(:n) == load_carried
         these%overloaded(:n) = outcome(:n) == load_too_large
         if (never_pulls(contact%film)) return
         do i = 1, n
            if (tells_velocity(contact, thickness(i), these%by_other(i), follows, outcome(i))) cycle
            call film_load(contact%film, thickness(i), velocity(i), these%value(i), these%by_film(i), these%by_other(i))
            these%of_velocities(i) = .false.
            these%exists(i) = abs(these%value(i)) < overflow_load
            these%overloaded(i) = .not. these%exists(i)
         end do
      end associate
   end subroutine equations_of_films

   !> Whether the load of a film that may pull, or holds on to a part of it, gives its velocity.
   pure logical function tells_velocity(contact, thickness, velocity_by_load, follows, outcome)
      type(flank_contact_t), intent(in) :: contact
      !> h [m], slope of its velocity at the load [m/(N s)]
      real(dp), intent(in) :: thickness
      real(dp), intent(in) :: velocity_by_load
      !> By how much the step lets the velocity follow the load, about [m/(N s)]
      real(dp), intent(in) :: follows
      !> Whether there is such a velocity, one of load_...
      integer, intent(in) :: outcome
      type(load_t) :: still

      tells_velocity = .false.
      if (outcome /= load_carried .or. .not. velocity_by_load < 0.0_dp) return
      tells_velocity = -velocity_by_load < follows
      if (tells_velocity) return
      call film_load(contact%film, thickness, 0.0_dp, still%load, still%by_film, still%by_velocity)
      tells_velocity = velocity_by_load*still%by_velocity < flattest
   end function tells_velocity

   !> Compliance of a flank at rest against small changes of its film or its load: of the film a share is left to the gear and the
   !> load.
   pure subroutine compliance_at_rest(contact, film, load, own_share, compliance)
      type(flank_contact_t), intent(in) :: contact
      !> h [m] and W [N]
      real(dp), intent(in) :: film
      real(dp), intent(in) :: load
      !> 1 but where flanks bend [-]
      real(dp), intent(out) :: own_share
      !> [m/N]
      real(dp), intent(out) :: compliance
      real(dp) :: wider, by_film, by_load

      call width_compression(contact%film, film, load, wider, by_film, by_load)
      own_share = 1.0_dp - by_film
      compliance = contact%compliance + by_load
   end subroutine compliance_at_rest

   !> Whether a film carries positive loads only, down to nothing.
   elemental logical function carries_positive_loads(contact)
      type(flank_contact_t), intent(in) :: contact

      carries_positive_loads = never_pulls(contact%film)
   end function carries_positive_loads

   !> Whether a film keeps a part of its load however fast it separates.
   elemental logical function keeps_load(contact)
      type(flank_contact_t), intent(in) :: contact

      keeps_load = kept_load(contact%film, 1.0_dp) > 0.0_dp
   end function keeps_load

   !> Whether an evaluation costs much more than the arithmetic around it.
   elemental logical function is_costly(contact)
      type(flank_contact_t), intent(in) :: contact

      is_costly = contact%film%costly
   end function is_costly

   !> State of a film that has stood still for long; none where it has no state of its own.
   pure function inner_at_rest(contact, thickness) result(inner)
      type(flank_contact_t), intent(in) :: contact
      !> h [m]
      real(dp), intent(in) :: thickness
      real(dp), allocatable :: inner(:)

      if (contact%film%in_nodes) then
         inner = [thickness, 0.0_dp, thickness, thickness, thickness]
      else if (contact%state_law > 0) then
         inner = rest_of_state(contact%state_law, contact%film, thickness)
      else
         allocate (inner(0))
      end if
   end function inner_at_rest

   !> Film at rest under a load [m], 0 where there is none.
   pure real(dp) function film_under(contact, load) result(film)
      type(flank_contact_t), intent(in) :: contact
      !> > 0 [N]
      real(dp), intent(in) :: load
      !> Logarithms of films between which one is looked for
      real(dp), parameter :: thinnest = -35.0_dp, thickest = 5.0_dp
      type(load_t) :: carried
      real(dp) :: low, high, middle

      if (contact%state_law == 0) then
         film = steady_film(contact%film, load)
         return
      end if
      low = thinnest
      high = thickest
      do
         middle = 0.5_dp*(low + high)
         if (.not. (middle > low .and. middle < high)) exit
         carried = load_at_rest(contact, exp(middle), 0.0_dp)
         if (carried%load > load) then
            low = middle
         else
            high = middle
         end if
      end do
      film = 0.0_dp
      if (low > thinnest .and. high < thickest) film = exp(middle)
   end function film_under

end module flank_contact
