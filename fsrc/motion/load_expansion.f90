!> Load of films with rupture about the states of a block of lanes, in powers of the squeeze group: what the Taylor series of
!> module taylor_rupture starts from.
!>
!> The polynomials of module load_pieces, moved to where the films are. A step ends where the next one starts. It is looked up
!> once for both: to hold the end of the step against the equation of motion, and to begin the next series.
module load_expansion
   use kinds, only: dp
   use lane_functions, only: coarse_log, half_block, lanes, log_of_one, octave
   use lane_rows, only: interleave_rows
   use load_pieces, only: last_piece, octave_pieces, piece_degree, piece_size, pieces
   implicit none(type, external)
   private

   !> Highest power of the deviation that a series of the motion asks for.
   integer, parameter, public :: highest_power = 11

   !> Films of a block, all of one law, in the names of module taylor_rupture.
   type, public :: load_expansion_t
      !> H, V and c: what all else follows from. A film is positive: none has been looked up yet
      real(dp), dimension(lanes) :: film = 0.0_dp, momentum = 0.0_dp, rate = 0.0_dp
      !> p, r, A
      real(dp), dimension(lanes) :: inverse_film = 0.0_dp, root = 0.0_dp, group = 0.0_dp
      !> 1/e: deviations of A are counted in units e of its piece
      real(dp) :: inverse_unit(lanes) = 1.0_dp
      !> phi_i: Phi in powers of the deviation
      real(dp) :: terms(lanes, 0:highest_power) = 0.0_dp
      !> dPhi/dA
      real(dp) :: load_slope(lanes) = 0.0_dp
   end type load_expansion_t

   public :: expand_load

contains

   !> Expand the load about the films of a block, unless they are what it was last expanded about.
   pure subroutine expand_load(law, film, momentum, rate, expansion)
      !> Load: exact_load or published_load of module load_pieces, the one of the films before
      integer, intent(in) :: law
      !> H [-]
      real(dp), intent(in) :: film(lanes)
      !> V [-]
      real(dp), intent(in) :: momentum(lanes)
      !> c [periods]
      real(dp), intent(in) :: rate(lanes)
      !> The films
      type(load_expansion_t), intent(inout) :: expansion
      !> Pieces by `coarse_log` of 2 + |A|, which is straight between powers of two, as the ends of the pieces are
      real(dp), parameter :: pieces_per_log = real(octave_pieces, dp)/octave, first_log = log_of_one + octave
      real(dp) :: changed, piece
      integer :: row(lanes), l

      ! NaN must count as changed, or a lane's result would depend on its neighbours: a sum keeps it, max would not.
      changed = 0.0_dp
      !$omp simd reduction(+: changed)
      do l = 1, lanes
         changed = changed + merge(0.0_dp, 1.0_dp, abs(film(l) - expansion%film(l)) + abs(momentum(l) - expansion%momentum(l)) &
                                   + abs(rate(l) - expansion%rate(l)) <= 0.0_dp)
      end do
      if (.not. changed > 0.0_dp) return
      !$omp simd private(piece)
      do l = 1, lanes
         expansion%film(l) = film(l)
         expansion%momentum(l) = momentum(l)
         expansion%rate(l) = rate(l)
         expansion%inverse_film(l) = 1.0_dp/film(l)
         expansion%root(l) = sqrt(expansion%inverse_film(l))
         expansion%group(l) = rate(l)*momentum(l)*expansion%root(l)
         ! The coarse log of NaN is a large number.
         piece = min((coarse_log(2.0_dp + abs(expansion%group(l))) - first_log)*pieces_per_log, real(last_piece, dp))
         row(l) = int(piece + merge(real(last_piece + 1, dp), 0.0_dp, expansion%group(l) < 0.0_dp))
      end do
      do l = 1, lanes, half_block
         call expand_half(law, l, row(l:l + half_block - 1), expansion)
      end do
   end subroutine expand_load

   !> Expand the load about the films of half a block.
   pure subroutine expand_half(law, first, row, expansion)
      !> Load, as module load_pieces numbers it
      integer, intent(in) :: law
      !> Its first lane
      integer, intent(in) :: first
      !> Pieces of its lanes
      integer, intent(in) :: row(half_block)
      !> The films, A known
      type(load_expansion_t), intent(inout) :: expansion
      !> Centre of the piece, one over its unit, and the load
      real(dp) :: c(half_block, -2:piece_size - 3)
      real(dp) :: deviation
      integer :: last, l, i, j

      last = first + half_block - 1
      call interleave_rows(piece_size, pieces(:, row(1), law), pieces(:, row(2), law), pieces(:, row(3), law), &
                           pieces(:, row(4), law), pieces(:, row(5), law), pieces(:, row(6), law), pieces(:, row(7), law), &
                           pieces(:, row(8), law), c)
      ! Division by z - deviation, again and again: the remainders are the terms.
      !$omp simd private(deviation)
      do l = 1, half_block
         deviation = (expansion%group(first - 1 + l) - c(l, -2))*c(l, -1)
         !GCC$ unroll 24
         do j = 0, highest_power
            !GCC$ unroll 24
            do i = piece_degree - 1, j, -1
               c(l, i) = c(l, i) + deviation*c(l, i + 1)
            end do
         end do
      end do
      expansion%inverse_unit(first:last) = c(:, -1)
      expansion%load_slope(first:last) = c(:, 1)*c(:, -1)
      expansion%terms(first:last, :) = c(:, 0:highest_power)
   end subroutine expand_half

end module load_expansion
