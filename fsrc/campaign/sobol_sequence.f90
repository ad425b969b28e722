!> Sobol's sequence of points that fill the unit cube evenly, with the direction numbers of Joe and Kuo,
!> "Constructing Sobol sequences with better two-dimensional projections", SIAM J. Sci. Comput. 30 (2008)
!> 2635-2654, their table new-joe-kuo-6. Order of the Gray code (Antonov and Saleev); any point is computed
!> on its own from its index. A seed other than 0 turns some binary digits of each dimension (digital
!> shift), which keeps the evenness.
module sobol_sequence
   use kinds, only: dp, int64
   use random_numbers, only: random_bit_count, random_bits
   implicit none(type, external)
   private

   integer, parameter, public :: largest_dimension = 32
   !> Binary digits of a coordinate; the sequence has 2 to this power of points
   integer, parameter :: digit_count = random_bit_count
   integer(int64), parameter, public :: largest_sobol_size = 2_int64**digit_count
   integer, parameter :: largest_degree = 7

   !> Primitive polynomials modulo 2, coefficients as binary digits; the first dimension has none.
   integer, parameter :: polynomials(largest_dimension) = [ &
      1, 3, 7, 11, 13, 19, 25, 37, 41, 47, 55, 59, 61, 67, 91, 97, &
      103, 109, 115, 131, 137, 143, 145, 157, 167, 171, 185, 191, 193, 203, 211, 213]

   !> First direction numbers m of every dimension, as many as the degree of the polynomial.
   integer, parameter :: first_numbers(largest_degree, largest_dimension) = reshape([ &
      1, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 1, 3, 0, 0, 0, 0, 0, 1, 3, 1, 0, 0, 0, 0, &
      1, 1, 1, 0, 0, 0, 0, 1, 1, 3, 3, 0, 0, 0, 1, 3, 5, 13, 0, 0, 0, 1, 1, 5, 5, 17, 0, 0, &
      1, 1, 5, 5, 5, 0, 0, 1, 1, 7, 11, 19, 0, 0, 1, 1, 5, 1, 1, 0, 0, 1, 1, 1, 3, 11, 0, 0, &
      1, 3, 5, 5, 31, 0, 0, 1, 3, 3, 9, 7, 49, 0, 1, 1, 1, 15, 21, 21, 0, 1, 3, 1, 13, 27, 49, 0, &
      1, 1, 1, 15, 7, 5, 0, 1, 3, 1, 15, 13, 25, 0, 1, 1, 5, 5, 19, 61, 0, 1, 3, 7, 11, 23, 15, 103, &
      1, 3, 7, 13, 13, 15, 69, 1, 1, 3, 13, 7, 35, 63, 1, 3, 5, 9, 1, 25, 53, 1, 3, 1, 13, 9, 35, 107, &
      1, 3, 1, 5, 27, 61, 31, 1, 1, 5, 11, 19, 41, 61, 1, 3, 5, 3, 3, 13, 69, 1, 1, 7, 13, 1, 19, 1, &
      1, 3, 7, 5, 13, 19, 59, 1, 1, 3, 9, 25, 29, 41, 1, 3, 5, 13, 23, 1, 55, 1, 3, 7, 3, 13, 59, 17], &
      [largest_degree, largest_dimension])

   !> Sequence of one dimension count and seed.
   type, public :: sobol_sequence_t
      private
      !> (digit, dimension)
      integer(int64), allocatable :: directions(:, :)
      integer(int64), allocatable :: shift(:)
   end type sobol_sequence_t

   public :: new_sobol_sequence, sobol_point

contains

   !> Prepare a sequence.
   pure function new_sobol_sequence(dimensions, seed) result(sequence)
      !> From 1 to largest_dimension
      integer, intent(in) :: dimensions
      !> 0: the plain sequence, which starts at the origin; any other number: shifted
      integer(int64), intent(in) :: seed
      type(sobol_sequence_t) :: sequence
      integer :: i

      allocate (sequence%directions(digit_count, dimensions), sequence%shift(dimensions))
      do i = 1, dimensions
         sequence%directions(:, i) = direction_numbers(i)
         sequence%shift(i) = 0_int64
         if (seed /= 0_int64) sequence%shift(i) = random_bits(seed, int(i, int64), 0_int64)
      end do
   end function new_sobol_sequence

   !> Direction numbers v_k = m_k 2^(digits - k) of a dimension; with the coefficients a of a polynomial of
   !> degree s: m_k = 2 a_1 m_(k-1) xor ... xor 2^(s-1) a_(s-1) m_(k-s+1) xor 2^s m_(k-s) xor m_(k-s).
   pure function direction_numbers(number) result(directions)
      integer, intent(in) :: number
      integer(int64) :: directions(digit_count)
      integer :: degree, i, k

      if (number == 1) then
         directions = [(shiftl(1_int64, digit_count - k), k=1, digit_count)]
         return
      end if
      degree = bit_size(1) - 1 - leadz(polynomials(number))
      do k = 1, degree
         directions(k) = shiftl(int(first_numbers(k, number), int64), digit_count - k)
      end do
      do k = degree + 1, digit_count
         directions(k) = ieor(directions(k - degree), shiftr(directions(k - degree), degree))
         do i = 1, degree - 1
            if (btest(polynomials(number), degree - i)) directions(k) = ieor(directions(k), directions(k - i))
         end do
      end do
   end function direction_numbers

   !> A point of the sequence.
   pure subroutine sobol_point(sequence, index, point)
      !> Prepared sequence
      type(sobol_sequence_t), intent(in) :: sequence
      !> From 0 to largest_sobol_size - 1
      integer(int64), intent(in) :: index
      !> Coordinates, at least 0 and below 1
      real(dp), intent(out) :: point(:)
      integer(int64) :: code, digits(size(point))
      integer :: k

      digits = sequence%shift
      code = ieor(index, shiftr(index, 1))
      do while (code /= 0_int64)
         k = trailz(code)
         digits = ieor(digits, sequence%directions(k + 1, :))
         code = ibclr(code, k)
      end do
      point = scale(real(digits, dp), -digit_count)
   end subroutine sobol_point

end module sobol_sequence
