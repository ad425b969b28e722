!> Load of films with rupture about the states of a block of lanes, in powers of the squeeze group: what the Taylor series of
!> module taylor_rupture starts from, and of elastic teeth the squeeze group in powers of the load.
!>
!> The polynomials of module load_pieces, moved to where the films are. A step ends where the next one starts. It is looked up
!> once for both: to hold the end of the step against the equation of motion, and to begin the next series.
module load_expansion
   use kinds, only: dp
   use lane_functions, only: coarse_log, half_block, lanes, log_of_one, octave
   use lane_rows, only: interleave_rows
   use load_pieces, only: first_load, last_load_piece, last_piece, octave_pieces, piece_degree, piece_size, pieces, squeezes
   implicit none(type, external)
   private

   !> Highest power of the deviation that a series of the motion takes.
   integer, parameter, public :: highest_power = 11

   !> Films of a block, all of one law, in the names of module taylor_rupture.
   type, public :: load_expansion_t
      !> H, V and c: what all else follows from. A film is positive: none has been looked up yet
      real(dp), dimension(lanes) :: film = 0.0_dp, lienard = 0.0_dp, rate = 0.0_dp
      !> p, r, A
      real(dp), dimension(lanes) :: inverse_film = 0.0_dp, root = 0.0_dp, group = 0.0_dp
      !> 1/e: deviations of A are counted in units e of its piece
      real(dp) :: inverse_unit(lanes) = 1.0_dp
      !> phi_i: Phi in powers of the deviation
      real(dp) :: terms(lanes, 0:highest_power) = 0.0_dp
      !> dPhi/dA
      real(dp) :: load_slope(lanes) = 0.0_dp
   end type load_expansion_t

   !> Squeeze groups of a block that follow from loads, all of one law.
   type, public :: squeeze_expansion_t
      !> Load group W H/a less its limit on separation, what all else follows from. It is positive: none has been looked up yet
      real(dp) :: load(lanes) = 0.0_dp
      !> 1 where there is an expansion, else 0
      real(dp) :: inside(lanes) = 0.0_dp
      !> Deviations of the load group are counted in units: one over that
      real(dp) :: inverse_unit(lanes) = 1.0_dp
      !> A in powers of the deviation
      real(dp) :: terms(lanes, 0:highest_power) = 0.0_dp
   end type squeeze_expansion_t

   public :: expand_load, expand_squeeze

contains

   !> Expand the load about the films of a block, unless they are what it was last expanded about.
   pure subroutine expand_load(law, film, lienard, rate, expansion)
      !> Load: exact_load or published_load of module load_pieces, the one of the films before
      integer, intent(in) :: law
      !> H [-]
      real(dp), intent(in) :: film(lanes)
      !> V [-]
      real(dp), intent(in) :: lienard(lanes)
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
         changed = changed + merge(0.0_dp, 1.0_dp, abs(film(l) - expansion%film(l)) + abs(lienard(l) - expansion%lienard(l)) &
                                   + abs(rate(l) - expansion%rate(l)) <= 0.0_dp)
      end do
      if (.not. changed > 0.0_dp) return
      !$omp simd private(piece)
      do l = 1, lanes
         expansion%film(l) = film(l)
         expansion%lienard(l) = lienard(l)
         expansion%rate(l) = rate(l)
         expansion%inverse_film(l) = 1.0_dp/film(l)
         expansion%root(l) = sqrt(expansion%inverse_film(l))
         expansion%group(l) = rate(l)*lienard(l)*expansion%root(l)
         ! The coarse log of NaN is a large number.
         piece = min((coarse_log(2.0_dp + abs(expansion%group(l))) - first_log)*pieces_per_log, real(last_piece, dp))
         row(l) = int(piece + merge(real(last_piece + 1, dp), 0.0_dp, expansion%group(l) < 0.0_dp))
      end do
      do l = 1, lanes, half_block
         call expand_half(pieces(:, :, law), 2*last_piece + 1, l, row(l:l + half_block - 1), expansion%group, &
                          expansion%inverse_unit, expansion%terms)
      end do
      expansion%load_slope = expansion%terms(:, 1)*expansion%inverse_unit
   end subroutine expand_load

   !> Expand the squeeze group about the loads of films, unless they are what it was last expanded about. There is no expansion
   !> where a load is none, or beyond the pieces.
   pure subroutine expand_squeeze(law, load, expansion)
      !> Load: exact_load or published_load of module load_pieces, the one of the films before
      integer, intent(in) :: law
      !> Load group W H/a less its limit on separation [-]
      real(dp), intent(in) :: load(lanes)
      !> The films
      type(squeeze_expansion_t), intent(inout) :: expansion
      real(dp), parameter :: pieces_per_log = real(octave_pieces, dp)/octave, first_log = log_of_one + real(first_load, dp)*octave
      real(dp) :: place(lanes), changed, piece
      integer :: row(lanes), l

      changed = 0.0_dp
      !$omp simd reduction(+: changed)
      do l = 1, lanes
         changed = changed + merge(0.0_dp, 1.0_dp, abs(load(l) - expansion%load(l)) <= 0.0_dp)
      end do
      if (.not. changed > 0.0_dp) return
      !$omp simd private(piece)
      do l = 1, lanes
         expansion%load(l) = load(l)
         ! The coarse log of NaN and of a negative load is a large number.
         piece = (coarse_log(load(l)) - first_log)*pieces_per_log
         expansion%inside(l) = merge(1.0_dp, 0.0_dp, piece >= 0.0_dp)*merge(1.0_dp, 0.0_dp, piece < real(last_load_piece + 1, dp))
         ! Where there is no expansion, numbers that do not overflow
         place(l) = merge(load(l), 1.0_dp, expansion%inside(l) > 0.0_dp)
         row(l) = int(merge(piece, -real(octave_pieces*first_load, dp), expansion%inside(l) > 0.0_dp))
      end do
      do l = 1, lanes, half_block
         call expand_half(squeezes(:, :, law), last_load_piece, l, row(l:l + half_block - 1), place, &
                          expansion%inverse_unit, expansion%terms)
      end do
   end subroutine expand_squeeze

   !> Move the polynomials of half a block to where it stands.
   pure subroutine expand_half(table, last_row, first, row, place, inverse_unit, terms)
      integer, intent(in) :: last_row
      !> Centre, one over unit and coefficients of every piece
      real(dp), intent(in) :: table(piece_size, 0:last_row)
      !> Its first lane
      integer, intent(in) :: first
      !> Pieces of its lanes
      integer, intent(in) :: row(half_block)
      !> Where the lanes stand
      real(dp), intent(in) :: place(lanes)
      !> One over the units of their pieces
      real(dp), intent(inout) :: inverse_unit(lanes)
      !> Terms in ascending powers of the deviation from there, in units
      real(dp), intent(inout) :: terms(lanes, 0:highest_power)
      !> Centre of the piece, one over its unit, and the polynomial
      real(dp) :: c(half_block, -2:piece_size - 3)
      real(dp) :: deviation
      integer :: last, l, i, j

      last = first + half_block - 1
      call interleave_rows(piece_size, table(:, row(1)), table(:, row(2)), table(:, row(3)), table(:, row(4)), &
                           table(:, row(5)), table(:, row(6)), table(:, row(7)), table(:, row(8)), c)
      ! Division by z - deviation, again and again: the remainders are the terms.
      !$omp simd private(deviation)
      do l = 1, half_block
         deviation = (place(first - 1 + l) - c(l, -2))*c(l, -1)
         !GCC$ unroll 24
         do j = 0, highest_power
            !GCC$ unroll 24
            do i = piece_degree - 1, j, -1
               c(l, i) = c(l, i) + deviation*c(l, i + 1)
            end do
         end do
      end do
      inverse_unit(first:last) = c(:, -1)
      terms(first:last, :) = c(:, 0:highest_power)
   end subroutine expand_half

end module load_expansion
