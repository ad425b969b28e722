!> The list of film laws: what each of them has as coefficients, kernel, steady film and words, and what it may be believed in.
!>
!> fsrc/README.md says how a law is added. A choice that has forgotten a law refuses it: there is a load beyond `overflow_load`, no
!> film that carries one, no kernel.
module film_law
   use constants, only: pi
   use elastohydrodynamic_closure, only: closure_film, closure_films, closure_load, closure_of, closure_steady_film, closure_t, &
                                         closure_velocities, closure_velocity, closure_width, most_films
   use flank_elasticity, only: contact_radius, plane_strain_modulus
   use kinds, only: dp
   use published_iso_viscous, only: half_pi_rupture_load, rolling_coefficient, solved_rupture_load, squeeze_coefficient
   use published_piezo_viscous, only: piezo_coefficient, piezo_viscous_terms_load, published_piezo_viscous_load, &
                                      squeeze_exponent_rate, squeeze_growth
   use reynolds_iso_viscous, only: rupture_tangent_fast
   use reynolds_load, only: load_scale, pressure_rate, reynolds_iso_viscous_load, reynolds_piezo_viscous_load, &
                            reynolds_piezo_viscous_load_array, squeeze_rate, steady_iso_viscous_film, steady_piezo_viscous_film
   use rupture, only: rupture_tangent_successive, squeeze_group
   use scene_status, only: status_no_rigid_film, status_overflow
   use scene_types, only: film_choice_t, law_elastohydrodynamic, law_iso_viscous, law_piezo_viscous, model_closure, &
                          model_published, model_resolved, model_reynolds, rupture_half_pi, rupture_solved, rupture_solver_fast, &
                          rupture_solver_successive, scene_t, viscosity_constant
   use squeeze_of_load, only: iso_viscous_squeeze, load_carried, load_too_small, piezo_viscous_squeeze, published_squeeze, &
                              share_kept
   implicit none(type, external)
   private

   !> A load above this is no load: the exponential of the piezo-viscous law has overflown [N].
   real(dp), parameter, public :: overflow_load = 1.0e100_dp

   !> Code of a law, with the way in which it is computed; 0 is none.
   integer, parameter, public :: kernel_half_pi = 1, kernel_solved_fast = 2, kernel_solved_successive = 3, kernel_piezo = 4, &
                                 kernel_reynolds_iso = 5, kernel_reynolds_piezo = 6, kernel_closure = 7

   !> Film of a scene.
   type, public :: film_t
      integer :: kernel = 0
      !> Whether pressure thickens the oil, by (29)
      logical :: pressure_thickens = .false.
      !> Whether this is the film of rigid flanks, which knows no lower limit of alpha p
      logical :: exact = .false.
      !> Whether an evaluation costs much more than the arithmetic around it
      logical :: costly = .false.
      !> Whether its flanks bend: their compression follows the width of the contact, too
      logical :: bends = .false.
      !> Whether its pressure is solved in nodes, so that its minimum film thickness and largest pressure are numbers of a state
      logical :: in_nodes = .false.
      !> Equivalent radius R of (2) [m]
      real(dp) :: radius = 0.0_dp
      !> Plane-strain modulus E* of (3) [Pa]
      real(dp) :: modulus = 0.0_dp
      !> Viscosity eta0 [Pa s]
      real(dp) :: viscosity = 0.0_dp
      !> Barus coefficient alpha [1/Pa]
      real(dp) :: pressure_viscosity = 0.0_dp
      !> The u of the formulas: U for the published model, u1 + u2 = 2 U for the exact one [m/s]
      real(dp) :: speed = 0.0_dp
      !> (23): coefficient of 1/h [N m]
      real(dp) :: rolling = 0.0_dp
      !> (24): coefficient of the squeeze term [N s m^(1/2)]
      real(dp) :: squeeze = 0.0_dp
      !> (37): coefficient of h^(-7/2) [N m^(7/2)]
      real(dp) :: piezo = 0.0_dp
      !> (37): 703/u [s/m]
      real(dp) :: rate = 0.0_dp
      !> Reynolds films: 12 l u eta0 R [N m]
      real(dp) :: scale = 0.0_dp
      !> Films that rupture by (18): A sqrt(h)/w [s m^(-1/2)]
      real(dp) :: squeeze_rate = 0.0_dp
      !> Reynolds piezo-viscous film: B h^(3/2) [m^(3/2)]
      real(dp) :: pressure_rate = 0.0_dp
      !> Elastohydrodynamic film
      type(closure_t) :: closure = closure_t()
      !> What it means if the kernel gives a load above `overflow_load`
      integer :: status_without_load = status_overflow
   end type film_t

   abstract interface
      !> Load and slopes of a film at one state.
      pure subroutine film_kernel(film, thickness, velocity, load, load_by_film, load_by_velocity)
         import :: dp, film_t
         type(film_t), intent(in) :: film
         !> Film thickness h > 0 [m]
         real(dp), intent(in) :: thickness
         !> Film velocity w = dh/dt [m/s]
         real(dp), intent(in) :: velocity
         !> Load W [N]
         real(dp), intent(out) :: load
         !> dW/dh [N/m]
         real(dp), intent(out) :: load_by_film
         !> dW/dw [N s/m]
         real(dp), intent(out) :: load_by_velocity
      end subroutine film_kernel
   end interface

   public :: new_film, with_exact_film, kernel_of, film_load, film_loads, mixed_film_loads, steady_film, squeeze_velocity, &
             squeeze_velocities, width_compression, kept_load, film_over_gap, films_over_gaps, most_films, never_pulls, law_words, &
             film_kernel

contains

   !> Coefficients of the film of a scene.
   pure function new_film(scene) result(film)
      type(scene_t), intent(in) :: scene
      type(film_t) :: film

      associate (contact => scene%contact, lubricant => scene%lubricant)
         film%radius = contact_radius(contact)
         film%modulus = plane_strain_modulus(contact%young_modulus, contact%poisson_ratio)
         film%viscosity = lubricant%viscosity
         film%pressure_viscosity = lubricant%pressure_viscosity
         film%speed = scene%kinematics%entrainment_speed
         film%kernel = kernel_of_choice(scene%film)
         select case (film%kernel)
         case (kernel_half_pi, kernel_solved_fast, kernel_solved_successive)
            film%rolling = rolling_coefficient(contact%length, film%speed, film%viscosity, film%radius)
            film%squeeze = squeeze_coefficient(contact%length, film%viscosity, film%radius)
            film%squeeze_rate = squeeze_rate(film%speed, film%radius)
         case (kernel_piezo)
            film%pressure_thickens = .true.
            film%piezo = piezo_coefficient(contact%length, film%speed, film%viscosity, film%radius, film%pressure_viscosity)
            film%rate = squeeze_exponent_rate(film%speed)
         case (kernel_reynolds_iso, kernel_reynolds_piezo)
            film%exact = .true.
            film%speed = 2.0_dp*scene%kinematics%entrainment_speed
            film%scale = load_scale(contact%length, film%speed, film%viscosity, film%radius)
            film%squeeze_rate = squeeze_rate(film%speed, film%radius)
            if (film%kernel == kernel_reynolds_iso) return
            film%pressure_thickens = .true.
            film%costly = .true.
            film%pressure_rate = pressure_rate(film%speed, film%viscosity, film%radius, film%pressure_viscosity)
            film%status_without_load = status_no_rigid_film
         case (kernel_closure)
            film%exact = .true.
            film%bends = .true.
            film%in_nodes = scene%film%model == model_resolved
            film%pressure_thickens = lubricant%viscosity_law /= viscosity_constant
            film%speed = 2.0_dp*scene%kinematics%entrainment_speed
            film%closure = closure_of(film%radius, contact%length, film%modulus, film%speed, film%viscosity, &
                                      film%pressure_viscosity, lubricant%viscosity_law)
         case default
            film%kernel = 0
         end select
      end associate
   end function new_film

   !> The same scene with the Reynolds iso-viscous film.
   pure type(scene_t) function with_exact_film(scene)
      type(scene_t), intent(in) :: scene

      with_exact_film = scene
      with_exact_film%film%law = law_iso_viscous
      with_exact_film%film%model = model_reynolds
   end function with_exact_film

   !> Code of the law that the group &film chooses, 0 where it is not known.
   pure integer function kernel_of_choice(choice) result(kernel)
      type(film_choice_t), intent(in) :: choice

      kernel = 0
      if (choice%law == law_elastohydrodynamic) then
         ! The closure shows what is asked before the films of a motion are solved in nodes.
         if (choice%model == model_closure .or. choice%model == model_resolved) kernel = kernel_closure
      else if (choice%model == model_reynolds) then
         if (choice%law == law_iso_viscous) kernel = kernel_reynolds_iso
         if (choice%law == law_piezo_viscous) kernel = kernel_reynolds_piezo
      else if (choice%model == model_published) then
         if (choice%law == law_piezo_viscous) kernel = kernel_piezo
         if (choice%law /= law_iso_viscous) return
         if (choice%rupture == rupture_half_pi) kernel = kernel_half_pi
         if (choice%rupture /= rupture_solved) return
         if (choice%rupture_solver == rupture_solver_fast) kernel = kernel_solved_fast
         if (choice%rupture_solver == rupture_solver_successive) kernel = kernel_solved_successive
      end if
   end function kernel_of_choice

   !> Kernel of a film, which loops over time choose once; none for a law that is not known.
   pure function kernel_of(film) result(kernel)
      type(film_t), intent(in) :: film
      procedure(film_kernel), pointer :: kernel

      select case (film%kernel)
      case (kernel_half_pi)
         kernel => load_half_pi
      case (kernel_solved_fast)
         kernel => load_solved_fast
      case (kernel_solved_successive)
         kernel => load_solved_successive
      case (kernel_piezo)
         kernel => load_piezo
      case (kernel_reynolds_iso)
         kernel => load_reynolds_iso
      case (kernel_reynolds_piezo)
         kernel => load_reynolds_piezo
      case (kernel_closure)
         kernel => load_closure
      case default
         kernel => null()
      end select
   end function kernel_of

   !> Load and slopes of one film at one state.
   pure subroutine film_load(film, thickness, velocity, load, load_by_film, load_by_velocity)
      type(film_t), intent(in) :: film
      !> Film thickness h > 0 [m]
      real(dp), intent(in) :: thickness
      !> Film velocity w = dh/dt [m/s]
      real(dp), intent(in) :: velocity
      !> Load W [N]; beyond `overflow_load` for a law that is not known
      real(dp), intent(out) :: load
      !> dW/dh [N/m]
      real(dp), intent(out) :: load_by_film
      !> dW/dw [N s/m]
      real(dp), intent(out) :: load_by_velocity
      procedure(film_kernel), pointer :: kernel

      kernel => kernel_of(film)
      if (associated(kernel)) then
         call kernel(film, thickness, velocity, load, load_by_film, load_by_velocity)
      else
         load = 2.0_dp*overflow_load
         load_by_film = 0.0_dp
         load_by_velocity = 0.0_dp
      end if
   end subroutine film_load

   !> Loads of many states of one film: which law it is, is asked once, and the published ones run in full registers. A state has
   !> the same bits in any place.
   pure subroutine film_loads(film, thicknesses, velocities, loads)
      type(film_t), intent(in) :: film
      !> Film thicknesses h > 0 [m]
      real(dp), intent(in) :: thicknesses(:)
      !> Film velocities w = dh/dt [m/s], as many
      real(dp), intent(in) :: velocities(:)
      !> Loads W [N], as many; beyond `overflow_load` for a law that is not known
      real(dp), intent(out) :: loads(:)
      real(dp) :: load_by_film, load_by_velocity
      integer :: i

      select case (film%kernel)
      case (kernel_half_pi)
         !$omp simd private(load_by_film, load_by_velocity)
         do i = 1, size(loads)
            call half_pi_rupture_load(film%rolling, film%squeeze, thicknesses(i), velocities(i), loads(i), load_by_film, &
                                      load_by_velocity)
         end do
      case (kernel_piezo)
         !$omp simd private(load_by_film, load_by_velocity)
         do i = 1, size(loads)
          call piezo_viscous_terms_load(film%piezo, film%rate, thicknesses(i), squeeze_growth(film%rate, velocities(i)), loads(i), &
                                          load_by_film, load_by_velocity)
         end do
      case default
         do i = 1, size(loads)
            call film_load(film, thicknesses(i), velocities(i), loads(i), load_by_film, load_by_velocity)
         end do
      end select
   end subroutine film_loads

   !> Loads and slopes of states of many films. The Reynolds piezo-viscous ones go together: their kernel is expensive, and much
   !> faster for many films than for one at a time.
   pure subroutine mixed_film_loads(films, film_of, thicknesses, velocities, loads, loads_by_film, loads_by_velocity)
      type(film_t), intent(in) :: films(:)
      !> Which of the films each state is of
      integer, intent(in) :: film_of(:)
      !> Film thicknesses h > 0 [m]
      real(dp), intent(in) :: thicknesses(:)
      !> Film velocities w = dh/dt [m/s]
      real(dp), intent(in) :: velocities(:)
      !> Loads W [N]; beyond `overflow_load` for a law that is not known
      real(dp), intent(out) :: loads(:)
      !> dW/dh [N/m]
      real(dp), intent(out) :: loads_by_film(:)
      !> dW/dw [N s/m]
      real(dp), intent(out) :: loads_by_velocity(:)
      real(dp), dimension(size(film_of)) :: load, load_by_film, load_by_velocity
      integer :: together(size(film_of)), n, i

      n = 0
      do i = 1, size(film_of)
         if (films(film_of(i))%kernel == kernel_reynolds_piezo) then
            n = n + 1
            together(n) = i
         else
            call film_load(films(film_of(i)), thicknesses(i), velocities(i), loads(i), loads_by_film(i), loads_by_velocity(i))
         end if
      end do
      if (n == 0) return
      associate (these => together(:n))
         call reynolds_piezo_viscous_load_array(n, films(film_of(these))%scale, films(film_of(these))%squeeze_rate, &
                                                films(film_of(these))%pressure_rate, thicknesses(these), velocities(these), &
                                                load(:n), load_by_film(:n), load_by_velocity(:n))
         loads(these) = load(:n)
         loads_by_film(these) = load_by_film(:n)
         loads_by_velocity(these) = load_by_velocity(:n)
      end associate
   end subroutine mixed_film_loads

   !> Film that carries a static load without squeeze [m]: (23), (37) or the load of the Reynolds film, solved for h. 0 where no
   !> rigid film carries it, and for a law that is not known.
   pure real(dp) function steady_film(film, load)
      type(film_t), intent(in) :: film
      !> Static load > 0 [N]
      real(dp), intent(in) :: load

      select case (film%kernel)
      case (kernel_half_pi, kernel_solved_fast, kernel_solved_successive)
         steady_film = film%rolling/load
      case (kernel_piezo)
         steady_film = (film%piezo/load)**(2.0_dp/7.0_dp)
      case (kernel_reynolds_iso)
         steady_film = steady_iso_viscous_film(film%scale, load)
      case (kernel_reynolds_piezo)
         steady_film = steady_piezo_viscous_film(film%scale, film%pressure_rate, load)
      case (kernel_closure)
         steady_film = closure_steady_film(film%closure, load/film%closure%load_unit)*film%closure%film_unit
      case default
         steady_film = 0.0_dp
      end select
   end function steady_film

   !> Whether a film carries positive loads only, down to nothing.
   elemental logical function never_pulls(film)
      type(film_t), intent(in) :: film

      never_pulls = film%exact .or. film%pressure_thickens
   end function never_pulls

   !> Load that a film keeps however fast it separates [N]; 0 of laws that keep none, or may pull.
   elemental real(dp) function kept_load(film, thickness)
      type(film_t), intent(in) :: film
      !> Film thickness h > 0 [m]
      real(dp), intent(in) :: thickness

      select case (film%kernel)
      case (kernel_solved_fast, kernel_solved_successive)
         kept_load = share_kept*film%rolling/thickness
      case default
         kept_load = 0.0_dp
      end select
   end function kept_load

   !> Film velocity at which a film carries a load, and its slopes. Those of a film that carries it at no velocity, and of a law
   !> that is not known, are 0.
   pure subroutine squeeze_velocity(film, thickness, load, near, velocity, velocity_by_film, velocity_by_load, outcome)
      type(film_t), intent(in) :: film
      !> Film thickness h > 0 [m]
      real(dp), intent(in) :: thickness
      !> Load W [N]
      real(dp), intent(in) :: load
      !> What the velocity is likely to be, which saves time; 0 where nothing is known of it [m/s]
      real(dp), intent(in) :: near
      !> Film velocity w = dh/dt [m/s]
      real(dp), intent(out) :: velocity
      !> dw/dh at constant load [1/s]
      real(dp), intent(out) :: velocity_by_film
      !> dw/dW at constant thickness [m/(N s)]
      real(dp), intent(out) :: velocity_by_load
      !> Whether some velocity gives the load, one of load_... of module squeeze_of_load
      integer, intent(out) :: outcome
      real(dp) :: a, a_by_load, a_by_pressure_group, pressure_group, share, velocity_of_one

      velocity = 0.0_dp
      velocity_by_film = 0.0_dp
      velocity_by_load = 0.0_dp
      select case (film%kernel)
      case (kernel_half_pi)
         outcome = load_carried
         share = 1.0_dp/(pi*film%squeeze)
         velocity = (film%rolling - load*thickness)*sqrt(thickness)*share
         velocity_by_film = (0.5_dp*film%rolling/sqrt(thickness) - 1.5_dp*load*sqrt(thickness))*share
         velocity_by_load = -thickness*sqrt(thickness)*share
      case (kernel_solved_fast, kernel_solved_successive)
         call published_squeeze(load*thickness/film%rolling, a, a_by_load, outcome)
         velocity_of_one = sqrt(thickness)/film%squeeze_rate
         velocity = a*velocity_of_one
         ! Of (24) this slope is lost in rounding where the film separates very fast.
         if (outcome /= load_carried .or. .not. a_by_load < 0.0_dp) return
         share = 1.0_dp/film%rolling
         velocity_by_film = a_by_load*load*share*velocity_of_one + 0.5_dp*velocity/thickness
         velocity_by_load = a_by_load*thickness*share*velocity_of_one
      case (kernel_piezo)
         outcome = merge(load_carried, load_too_small, load > 0.0_dp)
         if (.not. load > 0.0_dp) return
         velocity = -log(load/film%piezo*(thickness*thickness*thickness)*sqrt(thickness))/film%rate
         velocity_by_film = -3.5_dp/(film%rate*thickness)
         velocity_by_load = -1.0_dp/(film%rate*load)
      case (kernel_reynolds_iso)
         share = 1.0_dp/film%scale
         velocity_of_one = sqrt(thickness)/film%squeeze_rate
         call iso_viscous_squeeze(load*thickness*share, a, a_by_load, outcome)
         velocity = a*velocity_of_one
         if (outcome /= load_carried) return
         velocity_by_film = a_by_load*load*share*velocity_of_one + 0.5_dp*velocity/thickness
         velocity_by_load = a_by_load*thickness*share*velocity_of_one
      case (kernel_reynolds_piezo)
         share = 1.0_dp/film%scale
         velocity_of_one = sqrt(thickness)/film%squeeze_rate
         pressure_group = film%pressure_rate/(thickness*sqrt(thickness))
         call piezo_viscous_squeeze(load*thickness*share, pressure_group, near/velocity_of_one, a, a_by_load, a_by_pressure_group, &
                                    outcome)
         velocity = a*velocity_of_one
         velocity_by_film = (a_by_load*load*share - 1.5_dp*a_by_pressure_group*pressure_group/thickness)*velocity_of_one + &
                            0.5_dp*velocity/thickness
         velocity_by_load = a_by_load*thickness*share*velocity_of_one
      case (kernel_closure)
         associate (closure => film%closure)
            call closure_velocity(closure, thickness/closure%film_unit, load/closure%load_unit, velocity, velocity_by_film, &
                                  velocity_by_load, outcome)
            velocity = velocity*closure%velocity_unit
            velocity_by_film = velocity_by_film*(closure%velocity_unit/closure%film_unit)
            velocity_by_load = velocity_by_load*(closure%velocity_unit/closure%load_unit)
         end associate
      case default
         outcome = load_too_small
      end select
   end subroutine squeeze_velocity

   !> The same of many films. Which law it is, is asked once, and some run in full registers.
   pure subroutine squeeze_velocities(film, n, thickness, load, near, velocity, velocity_by_film, velocity_by_load, outcome)
      type(film_t), intent(in) :: film
      !> How many, at most most_films
      integer, intent(in) :: n
      !> Film thicknesses h > 0 [m]
      real(dp), intent(in) :: thickness(n)
      !> Loads W [N]
      real(dp), intent(in) :: load(n)
      !> What the velocities are likely to be; 0 where nothing is known [m/s]
      real(dp), intent(in) :: near(n)
      !> Film velocities w = dh/dt [m/s], their slopes [1/s], [m/(N s)]
      real(dp), intent(out) :: velocity(n)
      real(dp), intent(out) :: velocity_by_film(n)
      real(dp), intent(out) :: velocity_by_load(n)
      !> Whether some velocity gives the load, one of load_... of module squeeze_of_load
      integer, intent(out) :: outcome(n)
      real(dp), dimension(most_films) :: scaled_film, scaled_load
      integer :: i

      select case (film%kernel)
      case (kernel_closure)
         associate (closure => film%closure)
            scaled_film(:n) = thickness/closure%film_unit
            scaled_load(:n) = load/closure%load_unit
            call closure_velocities(closure, n, scaled_film, scaled_load, velocity, velocity_by_film, velocity_by_load, outcome)
            velocity = velocity*closure%velocity_unit
            velocity_by_film = velocity_by_film*(closure%velocity_unit/closure%film_unit)
            velocity_by_load = velocity_by_load*(closure%velocity_unit/closure%load_unit)
         end associate
      case default
         do i = 1, n
            call squeeze_velocity(film, thickness(i), load(i), near(i), velocity(i), velocity_by_film(i), velocity_by_load(i), &
                                  outcome(i))
         end do
      end select
   end subroutine squeeze_velocities

   !> Compression of flanks that bend, beside the compliance behind them, and its slopes; 0 of flanks that do not.
   elemental subroutine width_compression(film, thickness, load, gives, by_film, by_load)
      type(film_t), intent(in) :: film
      !> Film thickness h [m]
      real(dp), intent(in) :: thickness
      !> Load W [N]
      real(dp), intent(in) :: load
      !> [m]
      real(dp), intent(out) :: gives
      !> Its slopes [-], [m/N]; at a film that is none by the load alone
      real(dp), intent(out) :: by_film
      real(dp), intent(out) :: by_load

      gives = 0.0_dp
      by_film = 0.0_dp
      by_load = 0.0_dp
      if (.not. film%bends) return
      if (thickness > 0.0_dp) then
         call closure_width(film%closure, thickness, load, gives, by_film, by_load)
      else if (load > 0.0_dp) then
         call closure_width(film%closure, 0.0_dp, load, gives, by_film, by_load)
         by_film = 0.0_dp
      end if
   end subroutine width_compression

   !> Film of a flank: the gap, with the compression of the compliance behind it, and that of flanks that bend beside it [m].
   elemental real(dp) function film_over_gap(film, gap, load, near) result(thickness)
      type(film_t), intent(in) :: film
      !> [m]
      real(dp), intent(in) :: gap
      !> Load W [N]
      real(dp), intent(in) :: load
      !> A film near by, which saves time; 0 where none is known [m]
      real(dp), intent(in) :: near

      thickness = gap
      if (film%bends) thickness = closure_film(film%closure, gap, load, near)
   end function film_over_gap

   !> The same of many flanks that bend, whose films must be looked for, with their slopes.
   pure subroutine films_over_gaps(film, n, gap, load, near, thickness, by_gap, by_load)
      type(film_t), intent(in) :: film
      !> How many, at most most_films
      integer, intent(in) :: n
      !> [m]
      real(dp), intent(in) :: gap(n)
      !> Loads W [N]
      real(dp), intent(in) :: load(n)
      !> Films near by, which save time; 0 where none is known [m]
      real(dp), intent(in) :: near(n)
      !> [m]
      real(dp), intent(out) :: thickness(n)
      !> By how much the film grows more than the gap, and with the load [-], [m/N]
      real(dp), intent(out) :: by_gap(n)
      real(dp), intent(out) :: by_load(n)

      call closure_films(film%closure, n, gap, load, near, thickness, by_gap, by_load)
   end subroutine films_over_gaps

   !> The law that the group &film chooses, in words.
   pure function law_words(choice) result(words)
      type(film_choice_t), intent(in) :: choice
      character(:), allocatable :: words

      select case (kernel_of_choice(choice))
      case (kernel_half_pi)
         words = 'published iso-viscous film (35), rupture angle pi/2'
      case (kernel_solved_fast, kernel_solved_successive)
         words = 'published iso-viscous film (24), rupture angle solved from (18)'
      case (kernel_piezo)
         words = 'published piezo-viscous film (37)'
      case (kernel_reynolds_iso)
         words = 'Reynolds iso-viscous film of rigid flanks'
      case (kernel_reynolds_piezo)
         words = 'Reynolds piezo-viscous film of rigid flanks'
      case (kernel_closure)
         words = 'elastohydrodynamic film, by its closure'
         if (choice%model == model_resolved) words = 'elastohydrodynamic film, its pressure in nodes'
      case default
         words = 'unknown film law'
      end select
   end function law_words

   !> (35), rupture fixed at pi/2; interface film_kernel.
   pure subroutine load_half_pi(film, thickness, velocity, load, load_by_film, load_by_velocity)
      type(film_t), intent(in) :: film
      real(dp), intent(in) :: thickness
      real(dp), intent(in) :: velocity
      real(dp), intent(out) :: load
      real(dp), intent(out) :: load_by_film
      real(dp), intent(out) :: load_by_velocity

      call half_pi_rupture_load(film%rolling, film%squeeze, thickness, velocity, load, load_by_film, load_by_velocity)
   end subroutine load_half_pi

   !> (24), rupture from the table of (18); interface film_kernel.
   pure subroutine load_solved_fast(film, thickness, velocity, load, load_by_film, load_by_velocity)
      type(film_t), intent(in) :: film
      real(dp), intent(in) :: thickness
      real(dp), intent(in) :: velocity
      real(dp), intent(out) :: load
      real(dp), intent(out) :: load_by_film
      real(dp), intent(out) :: load_by_velocity
      real(dp) :: a

      a = squeeze_group(film%radius, film%speed, thickness, velocity)
      call solved_rupture_load(film%rolling, film%squeeze, thickness, velocity, a, rupture_tangent_fast(a), &
                               load, load_by_film, load_by_velocity)
   end subroutine load_solved_fast

   !> (24), rupture from (18) by successive substitution; interface film_kernel.
   pure subroutine load_solved_successive(film, thickness, velocity, load, load_by_film, load_by_velocity)
      type(film_t), intent(in) :: film
      real(dp), intent(in) :: thickness
      real(dp), intent(in) :: velocity
      real(dp), intent(out) :: load
      real(dp), intent(out) :: load_by_film
      real(dp), intent(out) :: load_by_velocity
      real(dp) :: a

      a = squeeze_group(film%radius, film%speed, thickness, velocity)
      call solved_rupture_load(film%rolling, film%squeeze, thickness, velocity, a, rupture_tangent_successive(a), &
                               load, load_by_film, load_by_velocity)
   end subroutine load_solved_successive

   !> (37); interface film_kernel.
   pure subroutine load_piezo(film, thickness, velocity, load, load_by_film, load_by_velocity)
      type(film_t), intent(in) :: film
      real(dp), intent(in) :: thickness
      real(dp), intent(in) :: velocity
      real(dp), intent(out) :: load
      real(dp), intent(out) :: load_by_film
      real(dp), intent(out) :: load_by_velocity

      call published_piezo_viscous_load(film%piezo, film%rate, thickness, velocity, load, load_by_film, load_by_velocity)
   end subroutine load_piezo

   !> Reynolds iso-viscous film; interface film_kernel.
   pure subroutine load_reynolds_iso(film, thickness, velocity, load, load_by_film, load_by_velocity)
      type(film_t), intent(in) :: film
      real(dp), intent(in) :: thickness
      real(dp), intent(in) :: velocity
      real(dp), intent(out) :: load
      real(dp), intent(out) :: load_by_film
      real(dp), intent(out) :: load_by_velocity

      call reynolds_iso_viscous_load(film%scale, film%squeeze_rate, thickness, velocity, load, load_by_film, load_by_velocity)
   end subroutine load_reynolds_iso

   !> Reynolds piezo-viscous film; interface film_kernel.
   pure subroutine load_reynolds_piezo(film, thickness, velocity, load, load_by_film, load_by_velocity)
      type(film_t), intent(in) :: film
      real(dp), intent(in) :: thickness
      real(dp), intent(in) :: velocity
      real(dp), intent(out) :: load
      real(dp), intent(out) :: load_by_film
      real(dp), intent(out) :: load_by_velocity

      call reynolds_piezo_viscous_load(film%scale, film%squeeze_rate, film%pressure_rate, thickness, velocity, load, &
                                       load_by_film, load_by_velocity)
   end subroutine load_reynolds_piezo

   !> Elastohydrodynamic film by its closure; interface film_kernel.
   pure subroutine load_closure(film, thickness, velocity, load, load_by_film, load_by_velocity)
      type(film_t), intent(in) :: film
      real(dp), intent(in) :: thickness
      real(dp), intent(in) :: velocity
      real(dp), intent(out) :: load
      real(dp), intent(out) :: load_by_film
      real(dp), intent(out) :: load_by_velocity
      logical :: exists

      associate (closure => film%closure)
         call closure_load(closure, thickness/closure%film_unit, velocity/closure%velocity_unit, load, load_by_film, &
                           load_by_velocity, exists)
         load = load*closure%load_unit
         load_by_film = load_by_film*(closure%load_unit/closure%film_unit)
         load_by_velocity = load_by_velocity*(closure%load_unit/closure%velocity_unit)
      end associate
      if (.not. exists) load = 2.0_dp*overflow_load
   end subroutine load_closure

end module film_law
