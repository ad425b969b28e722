!> Latin hypercube: n points, and in every dimension one of them in each of n equal strata; see McKay,
!> Beckman and Conover, Technometrics 21 (1979) 239-245. The order of the strata is computed place by
!> place, so any point is had on its own, and no memory grows with n.
module latin_hypercube
   use hash_permutation, only: hash_permutation_t, new_hash_permutation, permuted
   use kinds, only: dp, int64
   use random_numbers, only: random_bit_count, random_bits
   implicit none(type, external)
   private

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

   public :: new_latin_hypercube, hypercube_point

contains

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
