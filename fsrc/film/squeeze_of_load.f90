!> Squeeze group A at which a film that ruptures carries a given load: the film laws inverted.
!>
!> At a given thickness the load falls with A. Written in asinh A its logarithm is nearly straight (slope -1 where the film is
!> squeezed fast, -2 where it separates fast), so Newton's steps need no other start; a bracket guards them. For iso-viscous films
!> A is tabulated over the load as well, which takes a twentieth of the time.
module squeeze_of_load
   use, intrinsic :: ieee_arithmetic, only: ieee_is_nan
   use kinds, only: dp, int64
   use load_pieces, only: exact_load, first_load, last_load_piece, load_limit, octave_pieces, piece_degree, squeezes, &
                          tabulated_published => published_load
   use published_iso_viscous, only: width_of_film
   use reynolds_iso_viscous, only: iso_viscous_load, peak_pressure_group, rupture_tangent_fast, rupture_tangent_slope
   use reynolds_piezo_viscous, only: piezo_viscous_load
   implicit none(type, external)
   private

   !> Whether some squeeze velocity gives the load: one does; all give more; all that leave a film give less.
   integer, parameter, public :: load_carried = 0, load_too_small = -1, load_too_large = 1

   !> Of the load without squeeze what the published film (24) with x_e solved carries however fast it separates
   real(dp), parameter, public :: share_kept = load_limit(tabulated_published)

   public :: iso_viscous_squeeze, piezo_viscous_squeeze, published_squeeze

   !> What falls with A: Phi of the Reynolds film, its max p*, Psi, and 8/3 - A (x_e + pi/2) of the published load (24)
   integer, parameter :: iso_load = 1, peak = 2, piezo_load = 3, published_load = 4
   !> Limits of asinh A and of what falls with A there
   real(dp), parameter :: widest = 110.0_dp, smallest_group = 1.0e-90_dp, largest_group = 1.0e40_dp
   !> A (x_e + pi/2) of a film that separates fast, and c of (24): how much of the load that is
   real(dp), parameter :: last_width = 8.0_dp/3.0_dp, width_factor = 15.0_dp/56.0_dp
   !> Loads from here to there are tabulated [-]
   real(dp), parameter :: least_load = 2.0_dp**first_load, &
                          first_load_beyond = 2.0_dp**(first_load + (last_load_piece + 1)/octave_pieces)

   !> Bisection alone needs 64 iterations; Newton's steps make it about 6, or 3 from a film near by.
   integer, parameter :: most_passes = 200, most_passes_near_by = 8
   !> After a step of asinh A this small Newton's method has all digits.
   real(dp), parameter :: last_step = 1.0e-9_dp

contains

   !> Reynolds iso-viscous film: A of Phi(A) = phi, and dA/dphi. Tabulated where a film of some use carries the load, else solved
   !> for.
   elemental subroutine iso_viscous_squeeze(phi, a, a_by_load, outcome)
      !> Load group W h/(12 l u eta0 R) [-]
      real(dp), intent(in) :: phi
      !> A [-], 0 where no film carries the load
      real(dp), intent(out) :: a
      !> Its slope [-]
      real(dp), intent(out) :: a_by_load
      !> One of load_...
      integer, intent(out) :: outcome
      real(dp) :: load, slope

      if (is_tabulated(phi)) then
         call look_up(exact_load, phi, a, a_by_load)
         outcome = load_carried
         return
      end if
      call find_group(iso_load, 0.0_dp, phi, -widest, a, outcome)
      call iso_viscous_load(a, load, slope)
      a_by_load = 1.0_dp/slope
   end subroutine iso_viscous_squeeze

   !> Whether the tables reach to a load less its limit on separation.
   elemental logical function is_tabulated(load)
      !> [-]
      real(dp), intent(in) :: load

      is_tabulated = load >= least_load .and. load < first_load_beyond
   end function is_tabulated

   !> A of a tabulated load, and its slope.
   elemental subroutine look_up(law, load, a, a_by_load)
      !> exact_load or the published one of module load_pieces
      integer, intent(in) :: law
      !> The load less its limit on separation [-]
      real(dp), intent(in) :: load
      !> A [-]
      real(dp), intent(out) :: a
      real(dp), intent(out) :: a_by_load
      !> Bits of a number below those that show its piece
      integer, parameter :: piece_bits = digits(1.0_dp) - 1 - exponent(real(octave_pieces, dp)) + 1
      real(dp) :: deviation, slope
      integer :: piece, i

      ! The exponent of a number and the first bits behind it count the pieces.
      piece = int(shiftr(transfer(load, 1_int64) - transfer(least_load, 1_int64), piece_bits))
      deviation = (load - squeezes(1, piece, law))*squeezes(2, piece, law)
      a = squeezes(piece_degree + 3, piece, law)
      slope = 0.0_dp
      do i = piece_degree - 1, 0, -1
         slope = slope*deviation + a
         a = a*deviation + squeezes(i + 3, piece, law)
      end do
      a_by_load = slope*squeezes(2, piece, law)
   end subroutine look_up

   !> Reynolds piezo-viscous film: A of Psi(A, B) = psi. A film that is squeezed faster and faster ceases to exist at B max p*(A) =
   !> 1 under a finite load, which it reaches with infinite slope.
   elemental subroutine piezo_viscous_squeeze(psi, b, near, a, a_by_load, a_by_b, outcome)
      !> Load group W h/(12 l u eta0 R) [-]
      real(dp), intent(in) :: psi
      !> Pressure group B >= 0 [-]
      real(dp), intent(in) :: b
      !> Where A is likely to be; a good guess saves more than half of the time, a bad one costs little [-]
      real(dp), intent(in) :: near
      !> A [-], 0 where no film carries the load
      real(dp), intent(out) :: a
      !> Its slopes [-], 0 where no film carries the load
      real(dp), intent(out) :: a_by_load
      real(dp), intent(out) :: a_by_b
      !> One of load_...
      integer, intent(out) :: outcome
      real(dp) :: fastest, last, load, slope, load_by_b, nudge
      logical :: found

      a = 0.0_dp
      a_by_load = 0.0_dp
      a_by_b = 0.0_dp
      outcome = load_too_small
      if (.not. psi > smallest_group) return
      outcome = load_carried
      a = near
      call approach_load(psi, b, a, a_by_load, a_by_b, found)
      if (found) return
      ! The iso-viscous film that carries this load is near by where pressure thickens the oil little.
      call iso_viscous_squeeze(psi, a, slope, outcome)
      found = .false.
      if (outcome == load_carried) call approach_load(psi, b, a, a_by_load, a_by_b, found)
      if (found) return
      a_by_load = 0.0_dp
      a_by_b = 0.0_dp
      fastest = -widest
      if (b*largest_group > 1.0_dp) then
         call find_group(peak, 0.0_dp, 1.0_dp/b, -widest, last, outcome)
         nudge = 4.0_dp*epsilon(1.0_dp)*max(1.0_dp, abs(asinh(last)))
         do
            fastest = asinh(last) + nudge
            call evaluate(piezo_load, b, sinh(fastest), load, slope)
            if (load > 0.0_dp) exit
            nudge = 2.0_dp*nudge
         end do
         if (psi > load) then
            a = 0.0_dp
            outcome = load_too_large
            return
         end if
      end if
      call find_group(piezo_load, b, psi, fastest, a, outcome)
      if (outcome /= load_carried) return
      call piezo_viscous_load(a, b, load, slope, load_by_b)
      if (.not. slope < 0.0_dp) return
      a_by_load = 1.0_dp/slope
      a_by_b = -load_by_b/slope
   end subroutine piezo_viscous_squeeze

   !> Newton's method for A of a load group of the Reynolds piezo-viscous film, from a place near by.
   elemental subroutine approach_load(psi, b, a, a_by_load, a_by_b, found)
      !> Load group and pressure group [-]
      real(dp), intent(in) :: psi
      real(dp), intent(in) :: b
      !> The place; on return A [-]
      real(dp), intent(inout) :: a
      !> Its slopes [-]
      real(dp), intent(out) :: a_by_load
      real(dp), intent(out) :: a_by_b
      !> Whether the place was near enough
      logical, intent(out) :: found
      real(dp) :: place, load, slope, load_by_b, step
      integer :: pass

      found = .false.
      a_by_load = 0.0_dp
      a_by_b = 0.0_dp
      if (.not. (psi > smallest_group .and. psi < largest_group .and. abs(a) < largest_group)) return
      place = asinh(a)
      do pass = 1, most_passes_near_by
         call piezo_viscous_load(a, b, load, slope, load_by_b)
         ! Compared with a number, the NaN of a film that does not exist stops the debug build.
         if (ieee_is_nan(load)) return
         if (.not. (load > 0.0_dp .and. slope < 0.0_dp)) return
         a_by_load = 1.0_dp/slope
         a_by_b = -load_by_b/slope
         step = log(psi/load)*load/(slope*sqrt(1.0_dp + a*a))
         place = place + step
         if (.not. abs(place) < widest) return
         a = sinh(place)
         found = abs(step) <= last_step*max(1.0_dp, abs(place))
         if (found) return
      end do
   end subroutine approach_load

   !> Published film (24) with x_e solved: A of W h = a (1 - c A (x_e + pi/2)), and its slope. Its load never falls to zero, only to
   !> the share 2/7 of that without squeeze; close to it A depends on the last digits of the load. Tabulated like that of the
   !> Reynolds film.
   elemental subroutine published_squeeze(load_share, a, a_by_load, outcome)
      !> W h/a, the load over that without squeeze [-]
      real(dp), intent(in) :: load_share
      !> A [-], 0 where no film carries the load
      real(dp), intent(out) :: a
      !> Its slope, 0 where no film carries the load [-]
      real(dp), intent(out) :: a_by_load
      !> One of load_...
      integer, intent(out) :: outcome
      real(dp) :: above_limit, width, slope

      above_limit = load_share - share_kept
      if (is_tabulated(above_limit)) then
         call look_up(tabulated_published, above_limit, a, a_by_load)
         outcome = load_carried
         return
      end if
      a_by_load = 0.0_dp
      call find_group(published_load, 0.0_dp, above_limit/width_factor, -widest, a, outcome)
      if (outcome /= load_carried) return
      call evaluate(published_load, 0.0_dp, a, width, slope)
      if (slope < 0.0_dp) a_by_load = 1.0_dp/(width_factor*slope)
   end subroutine published_squeeze

   !> A at which a quantity that falls with it has a given value.
   pure subroutine find_group(quantity, b, wanted, fastest, a, outcome)
      !> What falls with A
      integer, intent(in) :: quantity
      !> B [-], where it matters
      real(dp), intent(in) :: b
      !> Its value [-]
      real(dp), intent(in) :: wanted
      !> Lower limit of asinh A, at which the value is larger
      real(dp), intent(in) :: fastest
      !> A [-], 0 where there is none
      real(dp), intent(out) :: a
      !> One of load_...
      integer, intent(out) :: outcome
      real(dp) :: low, high, place, next, value, slope, rounding
      integer :: pass

      a = 0.0_dp
      outcome = load_too_small
      if (.not. wanted > smallest_group) return
      outcome = load_too_large
      if (wanted > largest_group) return
      outcome = load_carried
      rounding = epsilon(1.0_dp)*wanted
      if (quantity == published_load) rounding = epsilon(1.0_dp)*max(wanted, last_width)
      low = fastest
      high = widest
      place = max(fastest, 0.0_dp)
      do pass = 1, most_passes
         a = sinh(place)
         call evaluate(quantity, b, a, value, slope)
         if (abs(value - wanted) <= rounding) return
         if (value > wanted) then
            low = place
         else
            high = place
         end if
         next = 0.5_dp*(low + high)
         if (value > 0.0_dp .and. slope < 0.0_dp) then
            value = place + log(wanted/value)*value/(slope*cosh(place))
            if (value > low .and. value < high) next = value
         end if
         if (abs(next - place) <= epsilon(1.0_dp)*max(1.0_dp, abs(place))) return
         place = next
      end do
   end subroutine find_group

   !> What falls with A, and its slope; a load of 0 where there is no film.
   pure subroutine evaluate(quantity, b, a, value, slope)
      !> Which
      integer, intent(in) :: quantity
      !> B [-], where it matters
      real(dp), intent(in) :: b
      !> A [-]
      real(dp), intent(in) :: a
      !> The value [-]
      real(dp), intent(out) :: value
      !> Its derivative with respect to A [-]
      real(dp), intent(out) :: slope
      real(dp) :: tangent, width, value_by_b

      select case (quantity)
      case (iso_load)
         call iso_viscous_load(a, value, slope)
      case (peak)
         call peak_pressure_group(a, value, slope)
      case (piezo_load)
         call piezo_viscous_load(a, b, value, slope, value_by_b)
         if (ieee_is_nan(value)) value = 0.0_dp
      case (published_load)
         tangent = rupture_tangent_fast(a)
         width = width_of_film(tangent)
         value = last_width - a*width
         slope = -(width + a*rupture_tangent_slope(a)/(1.0_dp + tangent*tangent))
      case default
         value = 0.0_dp
         slope = 0.0_dp
      end select
   end subroutine evaluate

end module squeeze_of_load
