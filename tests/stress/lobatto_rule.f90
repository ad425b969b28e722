!> Lobatto's quadrature and the implicit method IIIC on its nodes: Hairer and Wanner, Solving Ordinary Differential
!> Equations II, section IV.5. It has order 2 s - 2 at the end of a step, damps stiff motions completely, and its
!> nodes include both ends. The engines of the program have nothing of it: they use Taylor series and Radau's nodes.
!> The unit of length is the step, from 0 to 1.
module lobatto_rule
   use kinds, only: dp
   implicit none(type, external)
   private

   integer, parameter, public :: nodes = 8

   !> The rule.
   type, public :: lobatto_rule_t
      !> Nodes and weights
      real(dp) :: node(nodes) = 0.0_dp, weight(nodes) = 0.0_dp
      !> Inverse of the matrix of the method: values at the nodes less the value at the start, into slopes times the step
      real(dp) :: differentiate(nodes, nodes) = 0.0_dp
      !> The matrix of the method: slopes times the step at the nodes into what the values have gained
      real(dp) :: integrate(nodes, nodes) = 0.0_dp
      !> Values at the nodes into coefficients of the Legendre polynomials of degree 0 to nodes - 1
      real(dp) :: to_legendre(nodes, nodes) = 0.0_dp
   end type lobatto_rule_t

   public :: new_lobatto_rule, legendre, solve_linear

contains

   !> Make the rule.
   pure function new_lobatto_rule() result(rule)
      type(lobatto_rule_t) :: rule
      real(dp) :: values(nodes, nodes), conditions(nodes, nodes), moments(nodes, nodes), p(0:nodes)
      integer :: i, degree

      do i = 1, nodes
         rule%node(i) = 0.5_dp*(1.0_dp + lobatto_node(i))
         p = legendre(rule%node(i))
         rule%weight(i) = 1.0_dp/(real(nodes*(nodes - 1), dp)*p(nodes - 1)**2)
         values(i, :) = p(:nodes - 1)
      end do
      rule%to_legendre = inverse(values)
      ! The matrix a of the method: a_i1 is the first weight, and polynomials up to degree nodes - 2 are integrated exactly
      ! from 0 to every node. Its transpose solves conditions*transpose(a) = moments.
      conditions(1, :) = 0.0_dp
      conditions(1, 1) = 1.0_dp
      moments(1, :) = rule%weight(1)
      do i = 1, nodes
         p = legendre(rule%node(i))
         conditions(2:, i) = p(:nodes - 2)
         moments(2, i) = rule%node(i)
         do degree = 1, nodes - 2
            moments(degree + 2, i) = (p(degree + 1) - p(degree - 1))/real(2*(2*degree + 1), dp)
         end do
      end do
      rule%integrate = transpose(matmul(inverse(conditions), moments))
      rule%differentiate = inverse(rule%integrate)
   end function new_lobatto_rule

   !> Node in the interval from -1 to 1: an end, or a zero of the derivative of the Legendre polynomial of degree nodes - 1.
   pure real(dp) function lobatto_node(place) result(x)
      !> 1 to nodes
      integer, intent(in) :: place
      integer, parameter :: degree = nodes - 1
      real(dp) :: p(0:nodes), slope
      integer :: pass

      x = -cos(acos(-1.0_dp)*real(place - 1, dp)/real(degree, dp))
      if (place == 1 .or. place == nodes) return
      do pass = 1, 20
         p = legendre(0.5_dp*(1.0_dp + x))
         slope = real(degree, dp)*(p(degree - 1) - x*p(degree))/(1.0_dp - x**2)
         ! From Legendre's equation.
         x = x - slope*(1.0_dp - x**2)/(2.0_dp*x*slope - real(degree*(degree + 1), dp)*p(degree))
      end do
   end function lobatto_node

   !> Legendre polynomials of degree 0 to nodes on the interval from 0 to 1.
   pure function legendre(c) result(p)
      !> Where
      real(dp), intent(in) :: c
      real(dp) :: p(0:nodes)
      integer :: n

      p(0) = 1.0_dp
      p(1) = 2.0_dp*c - 1.0_dp
      do n = 1, nodes - 1
         p(n + 1) = (real(2*n + 1, dp)*p(1)*p(n) - real(n, dp)*p(n - 1))/real(n + 1, dp)
      end do
   end function legendre

   !> Inverse of a matrix.
   pure function inverse(matrix)
      real(dp), intent(in) :: matrix(nodes, nodes)
      real(dp) :: inverse(nodes, nodes)
      integer :: column
      logical :: solved

      do column = 1, nodes
         inverse(:, column) = 0.0_dp
         inverse(column, column) = 1.0_dp
         call solve_linear(matrix, inverse(:, column), solved)
      end do
   end function inverse

   !> Gauss's elimination with a search for the pivot.
   pure subroutine solve_linear(matrix, unknown, solved)
      !> Coefficients
      real(dp), intent(in) :: matrix(nodes, nodes)
      !> Right-hand side, on return the solution
      real(dp), intent(inout) :: unknown(nodes)
      !> Whether there is one
      logical, intent(out) :: solved
      real(dp) :: work(nodes, nodes), row(nodes), held, factor
      integer :: i, k, pivot

      work = matrix
      solved = .false.
      do k = 1, nodes
         pivot = k - 1 + maxloc(abs(work(k:, k)), dim=1)
         if (.not. abs(work(pivot, k)) > 0.0_dp) return
         if (pivot /= k) then
            row = work(k, :)
            work(k, :) = work(pivot, :)
            work(pivot, :) = row
            held = unknown(k)
            unknown(k) = unknown(pivot)
            unknown(pivot) = held
         end if
         do i = k + 1, nodes
            factor = work(i, k)/work(k, k)
            work(i, k + 1:) = work(i, k + 1:) - factor*work(k, k + 1:)
            unknown(i) = unknown(i) - factor*unknown(k)
         end do
      end do
      do k = nodes, 1, -1
         unknown(k) = (unknown(k) - dot_product(work(k, k + 1:), unknown(k + 1:)))/work(k, k)
      end do
      solved = .true.
   end subroutine solve_linear

end module lobatto_rule
