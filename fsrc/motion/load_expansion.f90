!> Load of films with rupture about the states of a block of lanes, in powers of the squeeze group: what the Taylor series of
!> module taylor_rupture starts from.
!>
!> The polynomials of module load_pieces, moved to where the films are. A step ends where the next one starts. It is looked up
!> once for both: to hold the end of the step against the equation of motion, and to begin the next series.
module load_expansion
   use kinds, only: dp
   use lane_functions, only: coarse_log, lanes, log_of_one, octave
   use load_pieces, only: last_piece, octave_pieces, piece_degree, pieces
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
      real(dp) :: c(lanes, 0:piece_degree), deviation(lanes), changed, piece
      integer :: row(lanes), l, i, j

      ! A film that is no number has changed: with max it would count as the same, and a lane would hang on its neighbours.
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
         ! The coarse log of what is no number is one, a large one.
         piece = min((coarse_log(2.0_dp + abs(expansion%group(l))) - first_log)*pieces_per_log, real(last_piece, dp))
         row(l) = int(piece + merge(real(last_piece + 1, dp), 0.0_dp, expansion%group(l) < 0.0_dp))
      end do
      do l = 1, lanes
         deviation(l) = (expansion%group(l) - pieces(-2, row(l), law))*pieces(-1, row(l), law)
         expansion%inverse_unit(l) = pieces(-1, row(l), law)
      end do
      !GCC$ unroll 24
      do i = 0, piece_degree
         !$omp simd
         do l = 1, lanes
            c(l, i) = pieces(i, row(l), law)
         end do
      end do
      ! Division by z - deviation, again and again: the remainders are the terms.
      !GCC$ unroll 24
      do j = 0, highest_power
         !GCC$ unroll 24
         do i = piece_degree - 1, j, -1
            !$omp simd
            do l = 1, lanes
               c(l, i) = c(l, i) + deviation(l)*c(l, i + 1)
            end do
         end do
      end do
      !$omp simd
      do l = 1, lanes
         expansion%load_slope(l) = c(l, 1)*expansion%inverse_unit(l)
      end do
      expansion%terms = c(:, :highest_power)
   end subroutine expand_load

end module load_expansion
