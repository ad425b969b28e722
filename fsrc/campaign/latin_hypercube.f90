!> Latin hypercube: n points, and in every dimension one of them in each of n equal strata; see McKay,
!> Beckman and Conover, Technometrics 21 (1979) 239-245. The order of the strata is computed place by
!> place, so any point is had on its own, and no memory grows with n.
module latin_hypercube
   use kinds, only: dp, int64
   use random_numbers, only: random_bit_count, random_bits
   implicit none(type, external)
   private

   integer, parameter :: rounds = 10
   integer(int64), parameter :: low_half = int(z'FFFFFFFF', int64)
   integer(int64), parameter :: multiplier_1 = int(z'7FEB352D', int64), multiplier_2 = int(z'6C8E9CF5', int64)

   !> Random order of the numbers 0 to n - 1 that is computed place by place and needs no memory: a Feistel
   !> network on the pairs (l, r) with l < a, r < b, n <= a b; see Black and Rogaway, "Ciphers with arbitrary
   !> finite domains", CT-RSA (2002). A result of n or more goes in again until it is below n.
   type, public :: hash_permutation_t
      private
      integer(int64) :: size = 1_int64
      !> a and b
      integer(int64) :: left_size = 1_int64
      integer(int64) :: right_size = 1_int64
      integer(int64) :: keys(rounds) = 0_int64
   end type hash_permutation_t

   !> The place within a stratum has 20 binary digits, so that place and number of the stratum together
   !> are an exact real, and their quotient by n never rounds into the next stratum.
   integer, parameter :: place_digits = 20
   integer(int64), parameter, public :: largest_hypercube_size = 2_int64**30

   !> Hypercube of one size and seed.
   type, public :: latin_hypercube_t
      private
      integer(int64) :: size = 0_int64
      integer(int64) :: seed = 0_int64
      !> Order of the strata in every dimension
      type(hash_permutation_t), allocatable :: orders(:)
   end type latin_hypercube_t

   public :: new_latin_hypercube, hypercube_point, new_hash_permutation, permuted

contains

   !> Order that belongs to a seed and a stream.
   pure function new_hash_permutation(size, seed, stream) result(permutation)
      !> n, from 1 to 2^52: products of a hash of 32 bits with a or b stay positive 64-bit integers
      integer(int64), intent(in) :: size
      !> Any number
      integer(int64), intent(in) :: seed
      !> Any number
      integer(int64), intent(in) :: stream
      type(hash_permutation_t) :: permutation
      integer :: i

      permutation%size = size
      permutation%right_size = max(1_int64, ceiling(sqrt(real(size, dp)), int64))
      permutation%left_size = (size + permutation%right_size - 1_int64)/permutation%right_size
      do i = 1, rounds
         permutation%keys(i) = iand(random_bits(seed, stream, int(i, int64)), low_half)
      end do
   end function new_hash_permutation

   !> Number at a place of the order.
   elemental integer(int64) function permuted(permutation, place)
      !> The order
      type(hash_permutation_t), intent(in) :: permutation
      !> From 0 to n - 1
      integer(int64), intent(in) :: place

      permuted = place
      do
         permuted = shuffled(permutation, permuted)
         if (permuted < permutation%size) exit
      end do
   end function permuted

   !> One pass through the network.
   elemental integer(int64) function shuffled(permutation, place)
      type(hash_permutation_t), intent(in) :: permutation
      integer(int64), intent(in) :: place
      integer(int64) :: left, right
      integer :: i

      left = place/permutation%right_size
      right = place - left*permutation%right_size
      do i = 1, rounds, 2
         left = moved(left, right, permutation%keys(i), permutation%left_size)
         right = moved(right, left, permutation%keys(i + 1), permutation%right_size)
      end do
      shuffled = left*permutation%right_size + right
   end function shuffled

   !> A half moved on round its circle by the hash of the other half.
   elemental integer(int64) function moved(half, other, key, circle)
      integer(int64), intent(in) :: half
      integer(int64), intent(in) :: other
      integer(int64), intent(in) :: key
      integer(int64), intent(in) :: circle
      integer(int64) :: hash

      hash = ieor(other, key)
      hash = ieor(hash, shiftr(hash, 16))
      hash = iand(hash*multiplier_1, low_half)
      hash = ieor(hash, shiftr(hash, 15))
      hash = iand(hash*multiplier_2, low_half)
      hash = ieor(hash, shiftr(hash, 16))
      moved = half + shiftr(hash*circle, 32)
      if (moved >= circle) moved = moved - circle
   end function moved

   !> Prepare a hypercube.
   pure function new_latin_hypercube(dimensions, size, seed) result(hypercube)
      !> 1 or more
      integer, intent(in) :: dimensions
      !> From 1 to largest_hypercube_size
      integer(int64), intent(in) :: size
      !> Any number
      integer(int64), intent(in) :: seed
      type(latin_hypercube_t) :: hypercube
      integer :: i

      hypercube%size = size
      hypercube%seed = seed
      allocate (hypercube%orders(dimensions))
      do i = 1, dimensions
         hypercube%orders(i) = new_hash_permutation(size, seed, int(i, int64))
      end do
   end function new_latin_hypercube

   !> A point of the hypercube.
   pure subroutine hypercube_point(hypercube, index, point)
      !> Prepared hypercube
      type(latin_hypercube_t), intent(in) :: hypercube
      !> From 0 to size - 1
      integer(int64), intent(in) :: index
      !> Coordinates between 0 and 1, both excluded
      real(dp), intent(out) :: point(:)
      integer(int64) :: stratum, stream, place
      integer :: i

      do i = 1, size(point)
         stratum = permuted(hypercube%orders(i), index)
         ! Streams 1 to the number of dimensions made the orders.
         stream = int(size(point) + i, int64)
         place = shiftr(random_bits(hypercube%seed, stream, index), random_bit_count - place_digits)
         point(i) = (real(stratum, dp) + scale(real(place, dp) + 0.5_dp, &
                                               -place_digits))/real(hypercube%size, dp)
      end do
   end subroutine hypercube_point

end module latin_hypercube
