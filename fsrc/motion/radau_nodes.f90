!> Radau's quadrature with seven nodes, and the operations on the polynomial through its nodes that the
!> collocation method is made of. The unit of length is the step, from 0 to 1.
!>
!> The nodes are the zeros of P_7(2c - 1) - P_6(2c - 1), the last one is 1. Collocation at them (Radau IIA)
!> has order 13 at the end of the step and damps stiff motions completely: Hairer and Wanner, Solving Ordinary
!> Differential Equations II, section IV.5. All numbers were computed with 60 digits.
module radau_nodes
   use kinds, only: dp
   implicit none(type, external)
   private

   integer, parameter, public :: stages = 7

   !> Nodes c_i
   real(dp), parameter, public :: node(stages) = [ &
      2.9316427159784893e-02_dp, 1.480785996684843e-01_dp, 3.369846902811543e-01_dp, 5.586715187715501e-01_dp, &
         7.692338620300545e-01_dp, 9.269456713197411e-01_dp, 1.0_dp]

   !> Integral from 0 to c_i of the polynomial that is 1 at c_j and 0 at the other nodes: element (i, j)
   real(dp), parameter, public :: once(stages, stages) = reshape([ &
      3.754626499392133e-02_dp, 8.014759651561897e-02_dp, 7.20638469418819e-02_dp, 7.570512581982441e-02_dp, &
         7.391234216319184e-02_dp, 7.470556205979623e-02_dp, 7.449423555601031e-02_dp, &
      -1.40393345564604e-02_dp, 8.106206398589154e-02_dp, 1.7106835498388662e-01_dp, 1.5409015514217114e-01_dp, &
         1.6135560761594242e-01_dp, 1.583072238724687e-01_dp, 1.5910211573365074e-01_dp, &
      1.03527896007423e-02_dp, -2.1237992120711036e-02_dp, 1.0961456404007211e-01_dp, 2.271077366732024e-01_dp, &
         2.068672415521042e-01_dp, 2.1415342326720002e-01_dp, 2.1235188950297781e-01_dp, &
      -8.158322540275011e-03_dp, 1.4000291238817119e-02_dp, -2.4619871728984055e-02_dp, 1.1747818703702478e-01_dp, &
         2.3700711534269422e-01_dp, 2.1987784703186003e-01_dp, 2.2355491450728324e-01_dp, &
      6.388413879534685e-03_dp, -1.0234185730090163e-02_dp, 1.4760377043950817e-02_dp, -2.3810827153044174e-02_dp, &
         1.0308679353381345e-01_dp, 1.9875212168063527e-01_dp, 1.9047493682211558e-01_dp, &
      -4.602326779148656e-03_dp, 7.1534651513645905e-03_dp, -9.575259396791401e-03_dp, 1.2709985533661206e-02_dp, &
         -1.8854139152580447e-02_dp, 6.926550160550914e-02_dp, 1.196137446126562e-01_dp, &
      1.8289425614706437e-03_dp, -2.8126393724067235e-03_dp, 3.6726783971383057e-03_dp, -4.608844281289633e-03_dp, &
         5.8589009748887914e-03_dp, -8.11600819772829e-03_dp, 2.040816326530612e-02_dp], [stages, stages])

   !> Integral of that integral
   real(dp), parameter, public :: twice(stages, stages) = reshape([ &
      6.775470061516647e-04_dp, 8.604020468096461e-03_dp, 2.3101084737337158e-02_dp, 3.9298618680259106e-02_dp, &
         5.520503088258123e-02_dp, 6.683161515065861e-02_dp, 7.231033072550869e-02_dp, &
      -5.580510526090879e-04_dp, 3.0036030473501204e-03_dp, 2.9263496556330166e-02_dp, 6.581799057579717e-02_dp, &
         9.85320896959485e-02_dp, 1.2404350387841538e-01_dp, 1.3554249723151862e-01_dp, &
      6.932031411022787e-04_dp, -1.2227110702237051e-03_dp, 5.319666876125448e-03_dp, 4.5903224438461315e-02_dp, &
         9.237189271090228e-02_dp, 1.2504687547769208e-01_dp, 1.4079255378819894e-01_dp, &
      -8.051596662591545e-04_dp, 1.1671623596307716e-03_dp, -1.5699354487211223e-03_dp, 5.870420306786658e-03_dp, &
         4.6002628193374626e-02_dp, 8.268653907191788e-02_dp, 9.866115089065526e-02_dp, &
      8.228163330506045e-04_dp, -1.1334078085471165e-03_dp, 1.23185017329794e-03_dp, -1.3447231278123789e-03_dp, &
         4.226503036580514e-03_dp, 2.9492104566990324e-02_dp, 4.3955165550508976e-02_dp, &
      -6.965167274101289e-04_dp, 9.443267890444678e-04_dp, -9.726624865895712e-04_dp, 8.504044442433752e-04_dp, &
         -7.031165976712511e-04_dp, 1.6123188986032282e-03_dp, 8.738301813609533e-03_dp, &
      2.9588741668130984e-04_dp, -3.9935794546138185e-04_dp, 4.058403341627279e-04_dp, -3.3900237447999674e-04_dp, &
         2.2533932512057252e-04_dp, -9.881825507475301e-05_dp, -5.7733932177342366e-58_dp], [stages, stages])

   !> Coefficient of (2c - 1)**(i - 1) in the polynomial that is 1 at c_j and 0 at the other nodes: element (i, j)
   real(dp), parameter, public :: power(stages, stages) = reshape([ &
      & 1.551343030914549e-02_dp, -1.2507369321123854e-01_dp, -1.9291815465259088e-01_dp, 1.1822801307428075_dp, &
      & -2.785720900996677e-01_dp, -1.8542385468120897_dp, 1.253008923723634_dp, &
      & -6.814884124417407e-02_dp, 5.738658402790531e-01_dp, 6.157932655710794e-01_dp, -5.168278702273369_dp, &
      & 3.0495676156768297_dp, 5.112689738092555_dp, -4.115488916101974_dp, &
      & 2.564039921411053e-01_dp, -2.5812693920620275_dp, 2.532776809187241_dp, 8.384927144952066_dp, &
      & -9.56476833413543_dp, -6.200568614635435_dp, 7.172498394552479_dp, &
      & 9.411591569546861e-01_dp, 1.4324653635541196_dp, -7.556840312575609_dp, -5.1065358877882945_dp, &
      & 1.5775013423454947e+01_dp, 3.9903593503591415_dp, -9.47562109395899_dp, &
      & -2.2214598126593016e-01_dp, 1.1424697857191386_dp, 6.786770835460247_dp, -1.3913386269408354_dp, &
      & -1.6579081730161935e+01_dp, 6.348442019609686e-05_dp, 1.0263262232769119e+01_dp, &
      & 1.2186110024802446e-01_dp, -7.103150471361879e-01_dp, -3.390939585847511_dp, 3.706088798450483_dp, &
      & 1.2017483972408114e+01_dp, -2.816162554281511_dp, -8.928016683841411_dp, &
      & -4.4642857142857144e-02_dp, 2.6785714285714285e-01_dp, 1.2053571428571428_dp, -1.6071428571428572_dp, &
      & -4.419642857142857_dp, 1.7678571428571428_dp, 3.830357142857143_dp], [stages, stages])

   !> Inverse of `once`: from the values of a function at the nodes, less that at the start, to its slopes there
   real(dp), parameter, public :: slope(stages, stages) = reshape([ &
      17.055284304421654_dp, -12.948988698811522_dp, 6.526797433701593_dp, -4.760415643167771_dp, &
         4.329451016638691_dp, -4.943623833507561_dp, 11.495455205116665_dp, &
      5.475299512185492_dp, 3.376585145452422_dp, -6.912304925481829_dp, 3.990860318095922_dp, &
         -3.3535280016779185_dp, 3.704802676027051_dp, -8.517072423056625_dp, &
      -1.618581105190787_dp, 4.054013503925586_dp, 1.4837469310040114_dp, -5.660688333657835_dp, &
         3.6906179318627217_dp, -3.7457284313738155_dp, 8.381031301964825_dp, &
      0.7496541282385067_dp, -1.4863139760065447_dp, 3.5946033544558915_dp, 0.8949802937859413_dp, &
         -6.037309187265788_dp, 4.781665625762615_dp, -10.033441651950401_dp, &
      -0.421891375983016_dp, 0.7728544737788972_dp, -1.4502156012225291_dp, 3.735899391500152_dp, &
         0.6499973865951115_dp, -8.783388755925044_dp, 15.094393942991166_dp, &
      0.25105021424639273_dp, -0.44494694720107_dp, 0.7670384491813573_dp, -1.5419785025493504_dp, &
         4.577300941414561_dp, 0.5394059387408583_dp, -34.42036637506563_dp, &
      -0.09232481935368413_dp, 0.1617747003353814_dp, -0.27142848561987243_dp, 0.5117126570997156_dp, &
         -1.2440566466772534_dp, 5.443680188059144_dp, 25.0_dp], [stages, stages])

   !> Coefficients of c**(i - 1) in the polynomial that is 1 at the start and 0 at the nodes
   real(dp), parameter :: start_alone(stages + 1) = [1.0_dp, -49.0_dp, 588.0_dp, -2940.0_dp, &
      & 7350.0_dp, -9702.0_dp, 6468.0_dp, -1716.0_dp]

   integer :: i, j
   !> Rows of a table that fills registers: one for each node, that of the last node twice
   integer, parameter, public :: rows = 8
   !> Nodes, and the tables above, in rows: the integrals, the slopes, and the coefficients of the powers of 2c - 1
   integer, parameter, public :: row_of(rows) = [(min(i, stages), i=1, rows)]
   real(dp), parameter, public :: node_rows(rows) = node(row_of)
   real(dp), parameter, public :: once_rows(rows, stages) = once(row_of, :), twice_rows(rows, stages) = twice(row_of, :), &
                                  slope_rows(rows, stages) = slope(row_of, :), power_rows(rows, stages) = power(row_of, :)
   !> Coefficient of c**(i - 1) in (2c - 1)**(j - 1)
   real(dp), parameter :: place_rows(rows, stages) = reshape( &
      & [((merge(2.0_dp**(i - 1)*(-1.0_dp)**modulo(j - i, 2)*anint(gamma(real(j, dp))/ &
                 (gamma(real(i, dp))*gamma(real(max(j - i, 0) + 1, dp)))), 0.0_dp, i <= j), i=1, rows), j=1, stages)], &
      & [rows, stages])

   public :: weigh, powers_of_place, meet_start

contains

   !> Sums of values at the nodes, weighted by the rows of a table.
   pure subroutine weigh(table, values, sums)
      real(dp), intent(in) :: table(rows, stages)
      !> Of which those at the nodes count
      real(dp), intent(in) :: values(rows)
      real(dp), intent(out) :: sums(rows)
      integer :: row, place

      sums = table(:, 1)*values(1)
      do place = 2, stages
         !$omp simd
         do row = 1, rows
            sums(row) = sums(row) + table(row, place)*values(place)
         end do
      end do
   end subroutine weigh

   !> From coefficients of the powers of 2c - 1 to those of the powers of c.
   pure function powers_of_place(polynomial) result(shifted)
      real(dp), intent(in) :: polynomial(stages)
      real(dp) :: shifted(0:stages)
      real(dp) :: in_rows(rows)

      in_rows(:stages) = polynomial
      in_rows(rows) = 0.0_dp
      call weigh(place_rows, in_rows, shifted)
   end function powers_of_place

   !> Let a polynomial through the values at the nodes meet that at the start: one that is there alone makes up for what it misses.
   pure subroutine meet_start(start, polynomial)
      real(dp), intent(in) :: start
      !> Coefficients of the powers of c
      real(dp), intent(inout) :: polynomial(0:stages)
      real(dp) :: gap

      gap = start - polynomial(0)
      polynomial = polynomial + gap*start_alone
   end subroutine meet_start

end module radau_nodes
