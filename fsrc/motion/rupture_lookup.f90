!> Rupture of the films of a block of lanes, from the film tables: what the Taylor series of module taylor_rupture starts from.
!>
!> A step ends where the next one starts. It is looked up once for both: to hold the end of the step against the equation of
!> motion, and to begin the next series.
module rupture_lookup
   use iso_viscous_coefficients, only: coordinate_scale, load_slope_table, tangent_slope_table, tangent_table
   use iso_viscous_sums, only: locate_block, sum_block
   use kinds, only: dp
   use lane_functions, only: lanes
   implicit none(type, external)
   private

   !> Films of a block, in the names of module taylor_rupture.
   type, public :: rupture_state_t
      !> H, V and c: what all else follows from. A film is positive: none has been looked up yet
      real(dp), dimension(lanes) :: film = 0.0_dp, momentum = 0.0_dp, rate = 0.0_dp
      !> p, r, A
      real(dp), dimension(lanes) :: pressure = 0.0_dp, root = 0.0_dp, group = 0.0_dp
      !> t, m, P, s, 1/(2 o)
      real(dp), dimension(lanes) :: tangent = 0.0_dp, share = 0.0_dp, width = 0.0_dp, cosine = 0.0_dp, half_o = 0.0_dp
   end type rupture_state_t

   public :: look_up

contains

   !> Look the films of a block up, unless they are what was looked up last.
   pure subroutine look_up(film, momentum, rate, state)
      !> H [-]
      real(dp), intent(in) :: film(lanes)
      !> V [-]
      real(dp), intent(in) :: momentum(lanes)
      !> c [periods]
      real(dp), intent(in) :: rate(lanes)
      !> The films
      type(rupture_state_t), intent(inout) :: state
      real(dp), dimension(lanes) :: coordinate, lead, fall, half, tangent_sum, slope, load_slope
      real(dp) :: changed
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
      call sum_block(lanes, load_slope_table, state%group, coordinate, load_slope)
      !$omp simd
      do l = 1, lanes
         state%tangent(l) = tangent_sum(l)*sqrt(state%group(l)*state%group(l) + coordinate_scale*coordinate_scale)
         state%half_o(l) = 0.5_dp/(2.0_dp*state%tangent(l) + state%group(l))
         state%share(l) = -state%tangent(l) - (2.0_dp*state%tangent(l) + state%group(l))*slope(l)
         state%cosine(l) = 1.0_dp/(1.0_dp + state%tangent(l)*state%tangent(l))
         load_slope(l) = (fall(l)*half(l))*(fall(l)*half(l))*(fall(l)*half(l))*load_slope(l)
         state%width(l) = 2.0_dp*state%cosine(l)*state%cosine(l)*(state%share(l) + state%tangent(l)) - 8.0_dp*load_slope(l)
      end do
   end subroutine look_up

end module rupture_lookup
