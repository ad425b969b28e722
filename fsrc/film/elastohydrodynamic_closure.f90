!> Film between elastic flanks, without pressures in nodes: rolling and squeeze flow of the rigid film, each with the factor by
!> which bent flanks and thickened oil change it. In Moes' variables, with E* of (3), u = u1 + u2 and
!> eps = (eta0 u/(E* R))^(1/4),
!>
!>     h = R eps^2 H ,   W = E* R eps^2 l M ,   h' = eps u/2 H' ,   p = E* eps P ,   alpha p = L P ,   L = alpha E* eps ,
!>
!>     M = (12/H) g_r Phi(A g_s/g_r) ,   A = sqrt(2) H'/sqrt(H) ,
!>     g_r = (1 + 0.830 s) exp(0.864 x/(1 + 0.058 (x^2 + s^2)^2)^(1/4)) ,   x = ln(eta(0.278 q)/eta0) ,
!>     g_s = (1 + 0.765 s)^(3/2) eta(0.213 q)/eta0 ,   s = M/H ,   q = M/b ,   b^2 = 2 H + 8 M/pi .
!>
!> H is the minimum film thickness, Phi that of the Reynolds iso-viscous film. The flanks are compressed by M c in all, of which c
!> is a number of the flank but for the width of the contact, - (2/pi) ln(0.516 H + 0.245 M). The constants are fitted to films
!> solved in nodes: what they were fitted to, and how far they are off, stands in input/FILM_LAWS.md.
module elastohydrodynamic_closure
   use constants, only: pi
   use elementary_functions, only: exponentials, logarithm, logarithms
   use flank_elasticity, only: elastic_scale, roelands_logarithm
   use kinds, only: dp
   use reynolds_iso_viscous, only: iso_viscous_load
   use scene_types, only: viscosity_barus, viscosity_constant, viscosity_roelands
   use squeeze_of_load, only: iso_viscous_squeeze, load_carried
   implicit none(type, external)
   private

   !> Coefficients of the film in a contact.
   type, public :: closure_t
      !> h of H = 1 [m], W of M = 1 [N], h' of H' = 1 [m/s], p of P = 1 [Pa]
      real(dp) :: film_unit = 1.0_dp
      real(dp) :: load_unit = 1.0_dp
      real(dp) :: velocity_unit = 1.0_dp
      real(dp) :: pressure_unit = 1.0_dp
      !> L [-]
      real(dp) :: material = 0.0_dp
      !> Code of scene_types
      integer :: viscosity_law = viscosity_barus
      !> Roelands: ln eta0 + 9.67, its exponent z, and p/1.96e8 Pa of P = 1 [-]
      real(dp) :: logarithm = 0.0_dp
      real(dp) :: exponent = 0.0_dp
      real(dp) :: pressure_ratio = 0.0_dp
   end type closure_t

   !> Films that are asked for at once, at most: their numbers fill registers, and stand where no memory is asked for
   integer, parameter, public :: most_films = 16

   !> Largest load M, material number L and alpha p that the constants were fitted to [-]
   real(dp), parameter, public :: largest_load = 2.0_dp, largest_material = 20.0_dp, largest_alpha_p = 8.0_dp

   !> Factors of s and q in g_r and g_s, exponents of g_r and g_s, factors of H and M in the width
   real(dp), parameter :: rolling_bend = 0.830_dp, rolling_pressure = 0.278_dp, rolling_exponent = 0.864_dp, &
                          squeeze_bend = 0.765_dp, squeeze_pressure = 0.213_dp, squeeze_exponent = 1.5_dp, &
                          film_width = 0.516_dp, load_width = 0.245_dp
   !> Factor of (x^2 + s^2)^2 in g_r: heavy loads drag in no more oil, as its pressure rises within the contact and not before it
   real(dp), parameter :: rolling_limit = 0.058_dp
   !> Largest P of the film over q [-]
   real(dp), parameter :: peak_pressure = 0.64_dp

   !> Reference pressure of Roelands' law [Pa]
   real(dp), parameter :: roelands_pressure = 1.96e8_dp

   !> Newton's iterations at most, and the step of a logarithm after which all digits are there
   integer, parameter :: most_passes = 100
   real(dp), parameter :: last_step = 1.0e-13_dp
   !> Step of a film, as a share of it, that leaves an error of half its square, and so all digits
   real(dp), parameter :: last_share = 1.0e-8_dp
   !> Loads of a film beyond which no search goes [-]
   real(dp), parameter :: beyond_all = 1.0e60_dp

   public :: closure_of, closure_velocity, closure_velocities, closure_load, closure_steady_film, closure_width, closure_film, &
             closure_films, closure_pressure, is_fitted, error_of_loads, thicken

contains

   !> Coefficients of a contact.
   pure type(closure_t) function closure_of(radius, length, modulus, speed, viscosity, pressure_viscosity, viscosity_law) &
      result(closure)
      !> R and l [m]
      real(dp), intent(in) :: radius
      real(dp), intent(in) :: length
      !> E* [Pa]
      real(dp), intent(in) :: modulus
      !> u1 + u2 [m/s]
      real(dp), intent(in) :: speed
      !> eta0 [Pa s]
      real(dp), intent(in) :: viscosity
      !> alpha [1/Pa]
      real(dp), intent(in) :: pressure_viscosity
      !> Code of scene_types
      integer, intent(in) :: viscosity_law
      real(dp) :: eps

      eps = elastic_scale(radius, modulus, speed, viscosity)
      closure%film_unit = radius*eps*eps
      closure%load_unit = modulus*radius*eps*eps*length
      closure%velocity_unit = 0.5_dp*eps*speed
      closure%pressure_unit = modulus*eps
      closure%material = pressure_viscosity*modulus*eps
      closure%viscosity_law = viscosity_law
      if (viscosity_law /= viscosity_roelands) return
      closure%logarithm = roelands_logarithm(viscosity)
      closure%exponent = roelands_pressure*pressure_viscosity/closure%logarithm
      closure%pressure_ratio = closure%pressure_unit/roelands_pressure
   end function closure_of

   !> Velocity of a film under a load, and its slopes.
   elemental subroutine closure_velocity(closure, film, load, velocity, by_film, by_load, outcome)
      type(closure_t), intent(in) :: closure
      !> H > 0 [-]
      real(dp), intent(in) :: film
      !> M [-]
      real(dp), intent(in) :: load
      !> H' [-]; it and its slopes are 0 where no velocity gives the load
      real(dp), intent(out) :: velocity
      real(dp), intent(out) :: by_film
      real(dp), intent(out) :: by_load
      !> Whether there is one, a code of module squeeze_of_load
      integer, intent(out) :: outcome
      real(dp), dimension(1) :: velocities, by_films, by_loads
      integer :: outcomes(1)

      call closure_velocities(closure, 1, [film], [load], velocities, by_films, by_loads, outcomes)
      velocity = velocities(1)
      by_film = by_films(1)
      by_load = by_loads(1)
      outcome = outcomes(1)
   end subroutine closure_velocity

   !> The same of many films, in full registers.
   pure subroutine closure_velocities(closure, n, film, load, velocity, by_film, by_load, outcome)
      type(closure_t), intent(in) :: closure
      !> How many, at most most_films
      integer, intent(in) :: n
      !> H > 0 and M [-]
      real(dp), intent(in) :: film(n)
      real(dp), intent(in) :: load(n)
      !> H' [-]; it and its slopes are 0 where no velocity gives the load
      real(dp), intent(out) :: velocity(n)
      real(dp), intent(out) :: by_film(n)
      real(dp), intent(out) :: by_load(n)
      !> Whether there is one, a code of module squeeze_of_load
      integer, intent(out) :: outcome(n)
      real(dp), dimension(most_films, 2) :: bent, oil, factor_by_film, factor_by_load
      real(dp), dimension(2*most_films) :: exponent, growth
      real(dp), dimension(most_films) :: held, stiffness, group, a, a_by_group
      real(dp) :: scale, change
      integer :: i

      held(:n) = max(load, 0.0_dp)
      call factors_of(closure, n, film, held, bent, oil, factor_by_film, factor_by_load)
      exponent(:n) = -oil(:n, 1)
      exponent(n + 1:2*n) = oil(:n, 1) - oil(:n, 2)
      call exponentials(2*n, exponent, growth)
      do i = 1, n
         stiffness(i) = film(i)*growth(i)/(12.0_dp*bent(i, 1))
         group(i) = load(i)*stiffness(i)
         call iso_viscous_squeeze(group(i), a(i), a_by_group(i), outcome(i))
         if (outcome(i) == load_carried) cycle
         a(i) = 0.0_dp
         a_by_group(i) = 0.0_dp
      end do
      !$omp simd private(scale, change)
      do i = 1, n
         scale = sqrt(0.5_dp*film(i)/bent(i, 2))*(bent(i, 1)/bent(i, 2))*growth(n + i)
         change = scale*a_by_group(i)
         velocity(i) = scale*a(i)
         by_film(i) = velocity(i)*(0.5_dp/film(i) + factor_by_film(i, 1) - factor_by_film(i, 2)) + &
                      change*group(i)*(1.0_dp/film(i) - factor_by_film(i, 1))
         by_load(i) = velocity(i)*(factor_by_load(i, 1) - factor_by_load(i, 2)) + &
                      change*(stiffness(i) - group(i)*factor_by_load(i, 1))
      end do
   end subroutine closure_velocities

   !> Load of a film that moves, and its slopes. Of loads at which it moves alike this is the smallest; the slopes follow from those
   !> of the velocity.
   elemental subroutine closure_load(closure, film, velocity, load, by_film, by_velocity, exists)
      type(closure_t), intent(in) :: closure
      !> H > 0 [-]
      real(dp), intent(in) :: film
      !> H' [-]
      real(dp), intent(in) :: velocity
      !> M [-]; it and its slopes are 0 where there is none
      real(dp), intent(out) :: load
      real(dp), intent(out) :: by_film
      real(dp), intent(out) :: by_velocity
      !> Whether there is one
      logical, intent(out) :: exists
      real(dp) :: low, high, place, next, found, found_by_film, found_by_load, unit, miss, slope
      integer :: pass, outcome

      by_film = 0.0_dp
      by_velocity = 0.0_dp
      ! The flanks and the oil of an unloaded film are as those of the rigid film, whose load this is.
      unit = sqrt(2.0_dp/film)
      call iso_viscous_load(velocity*unit, load, slope)
      load = 12.0_dp/film*load
      exists = load > 0.0_dp
      if (.not. exists) return
      ! The velocity falls with the load, from infinity, up to loads that thicken the oil by more than they drive out.
      low = log(load)
      do
         call at(low, miss, slope)
         if (miss > 0.0_dp) exit
         low = low - 0.5_dp
         if (low < -log(beyond_all)) exit
      end do
      high = low
      do
         high = high + 0.25_dp
         call at(high, miss, slope)
         if (.not. miss > 0.0_dp) exit
         low = high
         exists = high < log(beyond_all) .and. .not. slope > 0.0_dp
         if (exists) cycle
         load = 0.0_dp
         return
      end do
      place = 0.5_dp*(low + high)
      do pass = 1, most_passes
         call at(place, miss, slope)
         if (miss > 0.0_dp) then
            low = place
         else
            high = place
         end if
         next = place
         if (slope < 0.0_dp) next = place - miss/slope
         if (.not. (next > low .and. next < high)) next = 0.5_dp*(low + high)
         slope = abs(next - place)
         place = next
         if (slope <= last_step*max(1.0_dp, abs(place))) exit
      end do
      load = exp(place)
      call closure_velocity(closure, film, load, found, found_by_film, found_by_load, outcome)
      if (.not. found_by_load < 0.0_dp) return
      by_velocity = 1.0_dp/found_by_load
      by_film = -found_by_film/found_by_load

   contains

      !> By how much the velocity under a load misses that of the film, in asinh A, and its slope.
      pure subroutine at(logarithm, miss, slope)
         !> Of the load
         real(dp), intent(in) :: logarithm
         real(dp), intent(out) :: miss
         real(dp), intent(out) :: slope
         real(dp) :: moves, moves_by_film, moves_by_load
         integer :: is_carried

         call closure_velocity(closure, film, exp(logarithm), moves, moves_by_film, moves_by_load, is_carried)
         miss = asinh(moves*unit) - asinh(velocity*unit)
         slope = moves_by_load*exp(logarithm)*unit/sqrt(1.0_dp + (moves*unit)**2)
         ! A load too small for any velocity is below that of all velocities.
         if (is_carried /= load_carried) miss = real(-is_carried, dp)
      end subroutine at

   end subroutine closure_load

   !> Film that carries a load at rest [-]: M H = 12 g_r Phi(0), of which the left side over the right one rises with H.
   elemental real(dp) function closure_steady_film(closure, load) result(film)
      type(closure_t), intent(in) :: closure
      !> M > 0 [-]
      real(dp), intent(in) :: load
      real(dp), dimension(most_films, 2) :: bent, oil, by_film, by_load
      real(dp) :: still, slope, place, least, step
      integer :: pass

      call iso_viscous_load(0.0_dp, still, slope)
      least = log(12.0_dp*still/load)
      place = least
      do pass = 1, most_passes
         film = exp(place)
         call factors_of(closure, 1, [film], [load], bent, oil, by_film, by_load)
         step = (log(bent(1, 1)) + oil(1, 1) + least - place)/(1.0_dp - by_film(1, 1)*film)
         place = place + step
         if (abs(step) <= last_step*max(1.0_dp, abs(place))) exit
      end do
      film = exp(place)
   end function closure_steady_film

   !> Compression of the flanks by the width of the contact, - (2/pi) M ln(0.516 H + 0.245 M), and its slopes. A load below
   !> zero, which interpolation may ask of, has the width of none.
   elemental subroutine closure_width(closure, film, load, gives, by_film, by_load)
      type(closure_t), intent(in) :: closure
      !> h >= 0, and above 0 where there is no load [m]
      real(dp), intent(in) :: film
      !> W [N]
      real(dp), intent(in) :: load
      !> [m], less than 0 where the contact is wide
      real(dp), intent(out) :: gives
      real(dp), intent(out) :: by_film
      !> [m/N]
      real(dp), intent(out) :: by_load
      real(dp) :: m, width, share, logarithm_of_width

      share = -2.0_dp/pi*(closure%film_unit/closure%load_unit)
      m = load/closure%load_unit
      width = film_width*film/closure%film_unit + load_width*max(m, 0.0_dp)
      logarithm_of_width = logarithm(width)
      gives = share*load*logarithm_of_width
      by_film = share*load*film_width/(closure%film_unit*width)
      by_load = share*logarithm_of_width + share*max(load, 0.0_dp)*load_width/(closure%load_unit*width)
   end subroutine closure_width

   !> Film whose flanks leave a gap once they have given way for the width of the contact: h less `closure_width` is what is given,
   !> and rises with h. Less than 0 where no film leaves a gap as small.
   elemental real(dp) function closure_film(closure, gap, load, near) result(film)
      type(closure_t), intent(in) :: closure
      !> [m]
      real(dp), intent(in) :: gap
      !> W [N]
      real(dp), intent(in) :: load
      !> A film near by, which saves time [m]
      real(dp), intent(in) :: near
      real(dp) :: gives, by_film, by_load, step
      integer :: pass

      film = gap
      if (.not. load > 0.0_dp) return
      call closure_width(closure, 0.0_dp, load, gives, by_film, by_load)
      film = gap + gives
      if (.not. film > 0.0_dp) return
      ! Its slope falls with h, so that from below Newton's steps never pass the film.
      film = max(near, 0.0_dp)
      do pass = 1, most_passes
         call closure_width(closure, film, load, gives, by_film, by_load)
         step = (gap + gives - film)/(1.0_dp - by_film)
         film = max(film + step, 0.0_dp)
         if (abs(step) <= last_share*film) return
      end do
   end function closure_film

   !> The same of many films in full registers, with their slopes in the gaps and the loads. A load that is none has no width.
   pure subroutine closure_films(closure, n, gap, load, near, film, by_gap, by_load)
      type(closure_t), intent(in) :: closure
      !> How many, at most most_films
      integer, intent(in) :: n
      !> [m]
      real(dp), intent(in) :: gap(n)
      !> W [N]
      real(dp), intent(in) :: load(n)
      !> Films near by, which save time [m]
      real(dp), intent(in) :: near(n)
      !> [m]
      real(dp), intent(out) :: film(n)
      !> Slopes of what the width gives, at that film [-], [m/N]
      real(dp), intent(out) :: by_gap(n)
      real(dp), intent(out) :: by_load(n)
      real(dp), dimension(most_films) :: held, width, logarithm_of_width, by_film, gives
      real(dp) :: share, film_share, load_share, next, farthest
      integer :: pass, i

      share = -2.0_dp/pi*(closure%film_unit/closure%load_unit)
      film_share = film_width/closure%film_unit
      load_share = load_width/closure%load_unit
      held(:n) = max(load, tiny(1.0_dp)/epsilon(1.0_dp)*closure%load_unit)
      film = max(near, 0.0_dp)
      do pass = 1, most_passes
         width(:n) = film_share*film + load_share*held(:n)
         call logarithms(n, width, logarithm_of_width)
         farthest = 0.0_dp
         !$omp simd private(next) reduction(max: farthest)
         do i = 1, n
            gives(i) = share*held(i)*logarithm_of_width(i)
            by_film(i) = share*held(i)*film_share/width(i)
            next = max(film(i) + (gap(i) + gives(i) - film(i))/(1.0_dp - by_film(i)), 0.0_dp)
            farthest = max(farthest, abs(next - film(i)) - last_share*next)
            film(i) = next
         end do
         if (farthest <= 0.0_dp) exit
      end do
      do i = 1, n
         by_load(i) = share*logarithm_of_width(i) + share*held(i)*load_share/width(i)
         if (film(i) > 0.0_dp) then
            by_load(i) = by_load(i)/(1.0_dp - by_film(i))
            by_gap(i) = by_film(i)/(1.0_dp - by_film(i))
         else
            film(i) = gap(i) + gives(i)
            by_gap(i) = 0.0_dp
         end if
      end do
   end subroutine closure_films

   !> Largest pressure of a film [Pa]: within 3 % where pressure does not thicken the oil.
   elemental real(dp) function closure_pressure(closure, film, load) result(pressure)
      type(closure_t), intent(in) :: closure
      !> h > 0 [m]
      real(dp), intent(in) :: film
      !> W [N]
      real(dp), intent(in) :: load
      real(dp) :: m

      m = max(load/closure%load_unit, 0.0_dp)
      pressure = peak_pressure*closure%pressure_unit*m/sqrt(2.0_dp*film/closure%film_unit + 8.0_dp/pi*m)
   end function closure_pressure

   !> Whether the constants were fitted to films under such loads and pressures.
   elemental logical function is_fitted(closure, load, pressure)
      type(closure_t), intent(in) :: closure
      !> Largest W [N] and p [Pa]
      real(dp), intent(in) :: load
      real(dp), intent(in) :: pressure

      is_fitted = load <= largest_load*closure%load_unit .and. closure%material <= largest_material &
                  .and. closure%material*pressure <= largest_alpha_p*closure%pressure_unit
   end function is_fitted

   !> Factors of the flows of many films and loads: of g_r and of g_s.
   pure subroutine factors_of(closure, n, film, load, bent, oil, by_film, by_load)
      type(closure_t), intent(in) :: closure
      !> How many, at most most_films
      integer, intent(in) :: n
      !> H > 0 and M >= 0 [-]
      real(dp), intent(in) :: film(n)
      real(dp), intent(in) :: load(n)
      !> Of the first n, what flanks are bent by, g_r by its power 1 and g_s by 3/2, and ln of what oil adds to them [-]
      real(dp), intent(out) :: bent(most_films, 2)
      real(dp), intent(out) :: oil(most_films, 2)
      !> Slopes of ln g in H and M [-]
      real(dp), intent(out) :: by_film(most_films, 2)
      real(dp), intent(out) :: by_load(most_films, 2)
      real(dp), parameter :: bend(2) = [rolling_bend, squeeze_bend], pressure(2) = [rolling_pressure, squeeze_pressure]
      real(dp), parameter :: of_bend(2) = [1.0_dp, squeeze_exponent], of_oil(2) = [rolling_exponent, 1.0_dp]
      real(dp), dimension(2*most_films) :: at, thicker, slope
      real(dp), dimension(most_films) :: s, q_by_film, q_by_load, limited_by_s
      real(dp) :: inverse_square, inverse, q, change, limited, squares, share, steeper
      integer :: flow, i

      !$omp simd private(inverse_square, inverse, q)
      do i = 1, n
         inverse_square = 1.0_dp/(2.0_dp*film(i) + 8.0_dp/pi*load(i))
         inverse = sqrt(inverse_square)
         q = load(i)*inverse
         q_by_film(i) = -q*inverse_square
         q_by_load(i) = inverse - q*inverse_square*(4.0_dp/pi)
         at(i) = rolling_pressure*q
         at(n + i) = squeeze_pressure*q
         s(i) = load(i)/film(i)
         limited_by_s(i) = 0.0_dp
      end do
      ! Both flows at once: what many numbers go through one by one takes its time, not its number of operations.
      call thicken_many(closure, 2*n, at, thicker, slope)
      if (closure%viscosity_law /= viscosity_constant) then
         !$omp simd private(squares, limited, share)
         do i = 1, n
            squares = min(thicker(i)**2 + s(i)**2, beyond_all)
            limited = 1.0_dp + rolling_limit*squares**2
            share = 1.0_dp/sqrt(sqrt(limited))
            limited = rolling_limit*squares/limited
            slope(i) = share*(1.0_dp - limited*thicker(i)**2)*slope(i)
            thicker(i) = share*thicker(i)
            limited_by_s(i) = -rolling_exponent*limited*s(i)*thicker(i)
         end do
      end if
      do flow = 1, 2
         !$omp simd private(change, steeper)
         do i = 1, n
            bent(i, flow) = 1.0_dp + bend(flow)*s(i)
            oil(i, flow) = of_oil(flow)*thicker(n*(flow - 1) + i)
            change = (of_bend(flow)*bend(flow)/bent(i, flow) + limited_by_s(i))/film(i)
            steeper = of_oil(flow)*pressure(flow)*slope(n*(flow - 1) + i)
            by_film(i, flow) = steeper*q_by_film(i) - change*s(i)
            by_load(i, flow) = steeper*q_by_load(i) + change
         end do
         limited_by_s(:n) = 0.0_dp
      end do
   end subroutine factors_of

   !> ln(eta/eta0) at a pressure, and its slope.
   elemental subroutine thicken(closure, pressure, thicker, slope)
      type(closure_t), intent(in) :: closure
      !> P [-]
      real(dp), intent(in) :: pressure
      real(dp), intent(out) :: thicker
      real(dp), intent(out) :: slope

      select case (closure%viscosity_law)
      case (viscosity_barus)
         thicker = closure%material*pressure
         slope = closure%material
      case (viscosity_roelands)
         call thicken_by_roelands(closure, pressure, (1.0_dp + closure%pressure_ratio*pressure)**closure%exponent, thicker, slope)
      case default
         thicker = 0.0_dp
         slope = 0.0_dp
      end select
   end subroutine thicken

   !> The same at many pressures.
   pure subroutine thicken_many(closure, n, pressure, thicker, slope)
      type(closure_t), intent(in) :: closure
      !> How many, at most two for each film
      integer, intent(in) :: n
      !> P [-]
      real(dp), intent(in) :: pressure(n)
      real(dp), intent(out) :: thicker(n)
      real(dp), intent(out) :: slope(n)
      real(dp), dimension(2*most_films) :: base, exponent, growth

      if (closure%viscosity_law == viscosity_roelands) then
         base(:n) = 1.0_dp + closure%pressure_ratio*pressure
         call logarithms(n, base, exponent)
         exponent(:n) = closure%exponent*exponent(:n)
         call exponentials(n, exponent, growth)
         call thicken_by_roelands(closure, pressure, growth(:n), thicker, slope)
      else
         call thicken(closure, pressure, thicker, slope)
      end if
   end subroutine thicken_many

   !> The same by Roelands' law, from the power in it.
   elemental subroutine thicken_by_roelands(closure, pressure, growth, thicker, slope)
      type(closure_t), intent(in) :: closure
      !> P [-]
      real(dp), intent(in) :: pressure
      !> (1 + p/1.96e8 Pa)^z [-]
      real(dp), intent(in) :: growth
      real(dp), intent(out) :: thicker
      real(dp), intent(out) :: slope

      thicker = closure%logarithm*(growth - 1.0_dp)
      slope = closure%logarithm*closure%exponent*closure%pressure_ratio*growth/(1.0_dp + closure%pressure_ratio*pressure)
   end subroutine thicken_by_roelands

   !> Share by which the largest load of a motion may be off that in nodes: 99 of 100 random loose gears are nearer
   !> (tests/stress/CLOSURE.md).
   elemental real(dp) function error_of_loads(closure, load)
      type(closure_t), intent(in) :: closure
      !> M [-]
      real(dp), intent(in) :: load
      !> Below and above this load, in oil of constant viscosity and in oil that pressure thickens
      real(dp), parameter :: light = 0.15_dp, of_light(2) = [0.0031_dp, 0.0049_dp], of_others(2) = [0.0087_dp, 0.011_dp]
      integer :: oil

      oil = merge(1, 2, closure%viscosity_law == viscosity_constant)
      error_of_loads = merge(of_light(oil), of_others(oil), load < light)
   end function error_of_loads

end module elastohydrodynamic_closure
