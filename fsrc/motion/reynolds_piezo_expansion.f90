!> Load of the Reynolds piezo-viscous film about the states of a block of lanes, in powers of the squeeze group A and of
!> sigma = sqrt(1 - B max p*(A)): what the Taylor series of module taylor_reynolds_piezo starts from.
!>
!> The polynomials of module piezo_viscous_cells, moved to where the films are. They end at |A| = 14; beyond, and where no
!> rigid film exists, there is no expansion.
module reynolds_piezo_expansion
   use kinds, only: dp
   use lane_functions, only: coarse_log, half_block, lanes, log_of_one, octave, whole_below
   use lane_rows, only: interleave_rows
   use piezo_viscous_cells, only: cell_degree, cell_size, cells, octave_pieces, peak_pieces, piece_size, side_pieces, &
      sigma_cells
   implicit none(type, external)
   private

   integer :: i, k
   !> Highest power of A in the expansion of max p*, and in that of the load with each power of sigma: with more of them the
   !> steps of a motion are hardly longer.
   integer, parameter, public :: highest_peak_power = 7, highest_sigma_power = 6
   integer, parameter, public :: highest_group_power(0:highest_sigma_power) = [8, 7, 6, 4, 3, 2, 0]
   !> Highest power of time in the series of sigma: that of the series of the motion less one
   integer, parameter, public :: highest_time_power = 11
   !> Terms of the load: ascending powers of A, for each power of sigma from its first term on.
   integer, parameter :: load_terms = sum(highest_group_power + 1)
   integer, parameter :: earlier(0:highest_sigma_power, 0:highest_sigma_power) = reshape( &
                         [((merge(1, 0, k < i), i=0, highest_sigma_power), k=0, highest_sigma_power)], &
                         [highest_sigma_power + 1, highest_sigma_power + 1])
   integer, parameter, public :: first_term(0:highest_sigma_power) = matmul(earlier, highest_group_power + 1)
   !> The same in a cell.
   integer, parameter :: first_coefficient(0:cell_degree) = [(i*(cell_degree + 1) - i*(i - 1)/2 + 1, i=0, cell_degree)]

   !> Films of a block, in the names of module taylor_reynolds_piezo.
   type, public :: reynolds_piezo_expansion_t
      !> H, V, c and b: what all else follows from. A film is positive: none has been looked up yet
      real(dp), dimension(lanes) :: film = 0.0_dp, lienard = 0.0_dp, rate = 0.0_dp, pressing = 0.0_dp
      !> 1 where there is an expansion, else 0
      real(dp) :: inside(lanes) = 0.0_dp
      !> p, r, A, B, sigma
      real(dp), dimension(lanes) :: inverse_film = 0.0_dp, root = 0.0_dp, group = 0.0_dp
      real(dp), dimension(lanes) :: pressure_group = 0.0_dp, sigma = 0.0_dp
      !> 1/e: deviations of A are counted in units e of its piece
      real(dp) :: inverse_unit(lanes) = 1.0_dp
      !> max p* in powers of the deviation
      real(dp) :: peak(lanes, 0:highest_peak_power) = 0.0_dp
      !> Psi in powers of the deviations of A and sigma
      real(dp) :: terms(lanes, 0:load_terms - 1) = 0.0_dp
      !> dPsi/dA at constant B
      real(dp) :: load_slope(lanes) = 0.0_dp
      !> Of elastic teeth: the series of sigma in time
      real(dp) :: sigma_series(lanes, 0:highest_time_power) = 1.0_dp
   end type reynolds_piezo_expansion_t

   public :: expand_reynolds_piezo

contains

   !> Expand the load about the films of a block, unless they are what it was last expanded about.
   pure subroutine expand_reynolds_piezo(film, lienard, rate, pressing, expansion)
      !> H [-]
      real(dp), intent(in) :: film(lanes)
      !> V [-]
      real(dp), intent(in) :: lienard(lanes)
      !> c [periods]
      real(dp), intent(in) :: rate(lanes)
      !> b [-]
      real(dp), intent(in) :: pressing(lanes)
      !> The films
      type(reynolds_piezo_expansion_t), intent(inout) :: expansion
      real(dp) :: changed
      integer :: l

      ! NaN must count as changed, or a lane's result would depend on its neighbours: a sum keeps it, max would not.
      changed = 0.0_dp
      !$omp simd reduction(+: changed)
      do l = 1, lanes
         changed = changed + merge(0.0_dp, 1.0_dp, abs(film(l) - expansion%film(l)) + abs(lienard(l) - expansion%lienard(l)) &
                                   + abs(rate(l) - expansion%rate(l)) + abs(pressing(l) - expansion%pressing(l)) <= 0.0_dp)
      end do
      if (.not. changed > 0.0_dp) return
      !$omp simd
      do l = 1, lanes
         expansion%film(l) = film(l)
         expansion%lienard(l) = lienard(l)
         expansion%rate(l) = rate(l)
         expansion%pressing(l) = pressing(l)
         expansion%inverse_film(l) = 1.0_dp/film(l)
         expansion%root(l) = sqrt(expansion%inverse_film(l))
         expansion%group(l) = rate(l)*lienard(l)*expansion%root(l)
         expansion%pressure_group(l) = pressing(l)*expansion%inverse_film(l)*expansion%root(l)
      end do
      do l = 1, lanes, half_block
         call expand_half(l, l + half_block - 1, expansion)
      end do
   end subroutine expand_reynolds_piezo

   !> Expand the load about the films of half a block.
   pure subroutine expand_half(first, last, expansion)
      !> Its lanes
      integer, intent(in) :: first
      integer, intent(in) :: last
      !> The films, with A and B
      type(reynolds_piezo_expansion_t), intent(inout) :: expansion
      !> Pieces by `coarse_log` of 2 + |A|, which is straight between powers of two, as the ends of the pieces are
      real(dp), parameter :: pieces_per_log = real(octave_pieces, dp)/octave, first_log = log_of_one + octave
      real(dp), parameter :: last_piece = real(side_pieces - 1, dp), last_cell = real(sigma_cells - 1, dp)
      !> Centre of the piece of A, one over its unit, and max p*; and the cell
      real(dp) :: peak(half_block, -2:piece_size - 3), c(half_block, cell_size)
      real(dp), dimension(half_block) :: group, pressure_group, inside, sigma, inverse_unit, deviation, offset
      real(dp) :: place, gap
      integer :: row(half_block), cell(half_block), l, k, j, m

      group = expansion%group(first:last)
      pressure_group = expansion%pressure_group(first:last)
      !$omp simd private(place)
      do l = 1, half_block
         ! The coarse log of NaN is a large number.
         place = (coarse_log(2.0_dp + abs(group(l))) - first_log)*pieces_per_log
         inside(l) = merge(1.0_dp, 0.0_dp, place < real(side_pieces, dp))
         row(l) = int(min(place, last_piece) + merge(real(side_pieces, dp), 0.0_dp, group(l) < 0.0_dp))
      end do
      call interleave_rows(piece_size, peak_pieces(:, row(1)), peak_pieces(:, row(2)), peak_pieces(:, row(3)), &
                           peak_pieces(:, row(4)), peak_pieces(:, row(5)), peak_pieces(:, row(6)), peak_pieces(:, row(7)), &
                           peak_pieces(:, row(8)), peak)
      !$omp simd private(gap, place)
      do l = 1, half_block
         deviation(l) = (group(l) - peak(l, -2))*peak(l, -1)
         inverse_unit(l) = peak(l, -1)
         ! Division by z - deviation, again and again: the remainders are the terms.
         !GCC$ unroll 24
         do m = 0, highest_peak_power
            !GCC$ unroll 24
            do k = cell_degree - 1, m, -1
               peak(l, k) = peak(l, k) + deviation(l)*peak(l, k + 1)
            end do
         end do
         gap = 1.0_dp - pressure_group(l)*peak(l, 0)
         inside(l) = inside(l)*merge(1.0_dp, 0.0_dp, gap > 0.0_dp .and. gap <= 1.0_dp)
         sigma(l) = sqrt(merge(gap, 1.0_dp, inside(l) > 0.0_dp))
         place = real(sigma_cells, dp)*sigma(l)
         place = min(whole_below(place), last_cell)
         offset(l) = sigma(l) - (place + 0.5_dp)*(1.0_dp/real(sigma_cells, dp))
         cell(l) = int(place)
      end do
      call interleave_rows(cell_size, cells(:, cell(1), row(1)), cells(:, cell(2), row(2)), cells(:, cell(3), row(3)), &
                           cells(:, cell(4), row(4)), cells(:, cell(5), row(5)), cells(:, cell(6), row(6)), &
                           cells(:, cell(7), row(7)), cells(:, cell(8), row(8)), c)
      ! The same for powers of A, with each power of sigma, then for powers of sigma.
      !$omp simd
      do l = 1, half_block
         !GCC$ unroll 24
         do j = 0, cell_degree - 1
            !GCC$ unroll 24
            do m = 0, min(highest_group_power(0), cell_degree - j - 1)
               !GCC$ unroll 24
               do k = first_coefficient(j) + cell_degree - j - 1, first_coefficient(j) + m, -1
                  c(l, k) = c(l, k) + deviation(l)*c(l, k + 1)
               end do
            end do
         end do
         !GCC$ unroll 24
         do k = 0, highest_group_power(0)
            !GCC$ unroll 24
            do m = 0, count(highest_group_power >= k) - 1
               !GCC$ unroll 24
               do j = cell_degree - k - 1, m, -1
                  c(l, first_coefficient(j) + k) = c(l, first_coefficient(j) + k) + offset(l)*c(l, first_coefficient(j + 1) + k)
               end do
            end do
         end do
      end do
      expansion%inside(first:last) = inside
      expansion%sigma(first:last) = sigma
      expansion%inverse_unit(first:last) = inverse_unit
      expansion%peak(first:last, :) = peak(:, 0:highest_peak_power)
      !GCC$ unroll 24
      do j = 0, highest_sigma_power
         expansion%terms(first:last, first_term(j):first_term(j) + highest_group_power(j)) = &
            c(:, first_coefficient(j):first_coefficient(j) + highest_group_power(j))
      end do
      ! dPsi/dA at constant sigma, and what sigma changes by
      expansion%load_slope(first:last) = inverse_unit*(c(:, first_coefficient(0) + 1) &
         - c(:, first_coefficient(1))*pressure_group*peak(:, 1)/(2.0_dp*sigma))
   end subroutine expand_half

end module reynolds_piezo_expansion
