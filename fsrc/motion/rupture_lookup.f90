!> Rupture and load of the films of a block of lanes, from the film tables: what the Taylor series of module taylor_rupture starts
!> from.
!>
!> A step ends where the next one starts. It is looked up once for both: to hold the end of the step against the equation of
!> motion, and to begin the next series.
module rupture_lookup
   use iso_viscous_coefficients, only: coordinate_scale, load_slope_table, tangent_slope_table, tangent_table
   use iso_viscous_sums, only: locate_block, sum_block
   use kinds, only: dp
   use lane_functions, only: lanes
   use published_iso_viscous, only: squeeze_share
   implicit none(type, external)
   private

   !> Phi = constant + cosine s + A (width P + angle X) of a film law.
   type, public :: rupture_load_t
      real(dp) :: constant = 0.0_dp
      real(dp) :: cosine = 0.0_dp
      real(dp) :: width = 0.0_dp
      real(dp) :: angle = 0.0_dp
   end type rupture_load_t

   !> The exact film, and the published one.
   type(rupture_load_t), parameter, public :: exact_load = rupture_load_t(cosine=0.25_dp, width=-0.125_dp)
   type(rupture_load_t), parameter, public :: published_load = rupture_load_t(constant=1.0_dp, angle=-squeeze_share)

   !> Films of a block, all of one law, in the names of module taylor_rupture.
   type, public :: rupture_state_t
      !> H, V and c: what all else follows from. A film is positive: none has been looked up yet
      real(dp), dimension(lanes) :: film = 0.0_dp, momentum = 0.0_dp, rate = 0.0_dp
      !> p, r, A
      real(dp), dimension(lanes) :: pressure = 0.0_dp, root = 0.0_dp, group = 0.0_dp
      !> t, m, P, s, 1/(2 o)
      real(dp), dimension(lanes) :: tangent = 0.0_dp, end_ratio = 0.0_dp, width = 0.0_dp, cosine_square = 0.0_dp, half_o = 0.0_dp
      !> Sine times cosine of x_e, what A is multiplied by in Phi, Phi, dPhi/dA
      real(dp), dimension(lanes) :: sine = 0.0_dp, width_part = 0.0_dp, load = 0.0_dp, load_slope = 0.0_dp
   end type rupture_state_t

   public :: look_up

contains

   !> Look the films of a block up, unless they are what was looked up last.
   pure subroutine look_up(form, film, momentum, rate, state)
      !> Load of the film law, the one of the films looked up before
      type(rupture_load_t), intent(in) :: form
      !> H [-]
      real(dp), intent(in) :: film(lanes)
      !> V [-]
      real(dp), intent(in) :: momentum(lanes)
      !> c [periods]
      real(dp), intent(in) :: rate(lanes)
      !> The films
      type(rupture_state_t), intent(inout) :: state
      real(dp), dimension(lanes) :: coordinate, lead, fall, half, tangent_sum, slope, slope_sum
      real(dp) :: changed, turning
      integer :: l

      ! A film that is no number has changed: with max it would count as the same, and a lane would hang on its neighbours.
      changed = 0.0_dp
      !$omp simd reduction(+: changed)
      do l = 1, lanes
         changed = changed + merge(0.0_dp, 1.0_dp, abs(film(l) - state%film(l)) + abs(momentum(l) - state%momentum(l)) &
                                   + abs(rate(l) - state%rate(l)) <= 0.0_dp)
      end do
      if (.not. changed > 0.0_dp) return
      !$omp simd
      do l = 1, lanes
         state%film(l) = film(l)
         state%momentum(l) = momentum(l)
         state%rate(l) = rate(l)
         state%pressure(l) = 1.0_dp/film(l)
         state%root(l) = sqrt(state%pressure(l))
         state%group(l) = rate(l)*momentum(l)*state%root(l)
      end do
      call locate_block(lanes, state%group, coordinate, lead, fall, half)
      call sum_block(lanes, tangent_table, state%group, coordinate, tangent_sum)
      call sum_block(lanes, tangent_slope_table, state%group, coordinate, slope)
      call sum_block(lanes, load_slope_table, state%group, coordinate, slope_sum)
      !$omp simd private(turning)
      do l = 1, lanes
         state%tangent(l) = tangent_sum(l)*sqrt(state%group(l)*state%group(l) + coordinate_scale*coordinate_scale)
         state%half_o(l) = 0.5_dp/(2.0_dp*state%tangent(l) + state%group(l))
         state%end_ratio(l) = -state%tangent(l) - (2.0_dp*state%tangent(l) + state%group(l))*slope(l)
         state%cosine_square(l) = 1.0_dp/(1.0_dp + state%tangent(l)*state%tangent(l))
         slope_sum(l) = (fall(l)*half(l))*(fall(l)*half(l))*(fall(l)*half(l))*slope_sum(l)
         state%width(l) = 2.0_dp*state%cosine_square(l)*state%cosine_square(l)*(state%end_ratio(l) + state%tangent(l)) &
            - 8.0_dp*slope_sum(l)
         state%sine(l) = state%tangent(l)*state%cosine_square(l)
         state%width_part(l) = form%width*state%width(l) + form%angle*(state%width(l) - state%sine(l))
         state%load(l) = form%constant + form%cosine*state%cosine_square(l) + state%group(l)*state%width_part(l)
         ! dX/dA, then dPhi/dA
         turning = -state%cosine_square(l)*(state%end_ratio(l) + state%tangent(l))/(2.0_dp*state%tangent(l) + state%group(l))
         state%load_slope(l) = state%width_part(l) + turning*(state%group(l)*(2.0_dp*form%width*state%cosine_square(l) &
                                                                             + form%angle) - 2.0_dp*form%cosine*state%sine(l))
      end do
   end subroutine look_up

end module rupture_lookup
