!> Tests of films in nodes of pressure: steady films against extrapolated solutions and the literature, slopes, ruptured cells, and
!> the flank that goes from the closed form to nodes and back.
module test_nodal_film
   use checks, only: check_list_t
   use constants, only: pi
   use elastohydrodynamic_closure, only: closure_steady_film, closure_t
   use kinds, only: dp
   use nodal_film, only: balance_of_cells, correct_pressures, film_at_place, films_along, films_at_nodes, find_largest_pressure, &
                         grid_of, hertzian_pressure, nodal_balance_t, nodal_correction_t, nodal_grid_t, outlet_shift, &
                         rigid_pressures, shares_of_fourth_order, smallest_film, volumes_of
   use nodal_flank, only: kept_times, nodal_contact_t, nodal_flank_t, rigid_gap, soften, stiffen
   use scene_types, only: viscosity_barus, viscosity_constant, viscosity_roelands
   implicit none(type, external)
   private

   public :: run_nodal_film_tests

contains

   !> Runs every test of this topic.
   subroutine run_nodal_film_tests(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      call checks%start('nodal_film')
      call test_integrals(checks)
      call test_steady_table(checks)
      call test_literature(checks)
      call test_shift(checks)
      call test_dry_contact(checks)
      call test_slopes(checks)
      call test_rupture(checks)
      call test_handing_over(checks)
   end subroutine run_nodal_film_tests

   !> Oil in Moes' variables.
   pure type(closure_t) function oil_of(viscosity_law, material)
      integer, intent(in) :: viscosity_law
      !> L [-]
      real(dp), intent(in) :: material

      oil_of%viscosity_law = viscosity_law
      oil_of%material = material
      if (viscosity_law /= viscosity_roelands) return
      oil_of%logarithm = 6.0_dp
      oil_of%pressure_ratio = 2.5_dp
      oil_of%exponent = material/(oil_of%logarithm*oil_of%pressure_ratio)
   end function oil_of

   !> Load and deflection of Hertz's pressure, sqrt(1 - (X/b)^2)/4 b with b^2 = 8 M/pi, whose gap is flat between -b and b. Its root
   !> at the ends leaves an error of order h^(3/2).
   subroutine test_integrals(checks)
      type(check_list_t), intent(inout) :: checks
      real(dp), parameter :: b = 2.0_dp
      type(nodal_grid_t) :: grid
      real(dp) :: pressures(128), middle, end
      integer :: i

      grid = grid_of(128, 1.5_dp, 0.0_dp)
      pressures = 0.25_dp*b*sqrt(max(0.0_dp, 1.0_dp - (grid%place/b)**2))
      call checks%check_close(dot_product(grid%load, pressures), pi*b*b/8.0_dp, 8.0e-3_dp, 'load of Hertz''s pressure')
      middle = 0.5_dp*grid%place(64)**2 + dot_product(grid%film_at_nodes(64, :), pressures)
      do i = 64, 128
         if (grid%place(i) > 0.9_dp*b) exit
         end = 0.5_dp*grid%place(i)**2 + dot_product(grid%film_at_nodes(i, :), pressures)
         call checks%check_close(end, middle, 8.0e-3_dp, 'Hertz''s gap is flat')
      end do
      ! Under a distant point a pressure is a line load: the deflection is its load times the logarithm.
      call checks%check_close(grid%film(128, 64), -4.0_dp/pi*grid%load(64)*log(grid%edge(128)), 1.0e-6_dp, 'far away')
      ! A cell holds its length times the film at its middle, but for its curvature.
      call checks%check_close(grid%volume(70, 64)/grid%length(70), grid%film_at_nodes(70, 64), 1.0e-3_dp, 'a cell holds its film')
   end subroutine test_integrals

   !> A steady film under a load, the load grown step by step.
   subroutine solve_steady(oil, grid, load, gap, pressures, solved)
      type(closure_t), intent(in) :: oil
      type(nodal_grid_t), intent(in) :: grid
      !> M [-]
      real(dp), intent(in) :: load
      !> G [-]
      real(dp), intent(out) :: gap
      !> P [-]
      real(dp), intent(out) :: pressures(:)
      logical, intent(out) :: solved
      type(nodal_balance_t) :: balance
      type(nodal_correction_t) :: correction
      real(dp) :: target, change, nothing(size(pressures))
      logical :: active(size(pressures)), filled
      integer :: pass

      nothing = 0.0_dp
      target = 0.1_dp
      gap = 12.0_dp*0.2039_dp/target
      pressures = rigid_pressures(grid, gap, 0.0_dp, target)
      active = pressures > 0.0_dp
      do
         do pass = 1, 200
            call balance_of_cells(grid, oil, gap, pressures, shares_of_fourth_order(pressures), 0.0_dp, nothing, balance, filled)
            solved = filled
            if (.not. filled) return
            call correct_pressures(grid, balance, pressures, .false., active, correction)
            change = (target - correction%load)/correction%load_by_gap
            pressures = max(0.0_dp, pressures + correction%own + correction%with_gap*change)
            gap = gap + change
            if (maxval(abs(correction%own + correction%with_gap*change)) < 1.0e-10_dp .and. .not. correction%changed) exit
         end do
         solved = pass <= 200
         if (.not. solved .or. .not. target < load) return
         target = min(load, 1.5_dp*target)
      end do
   end subroutine solve_steady

   !> Steady films on the grid of a motion against solutions that are extrapolated over 256, 512, 1024 nodes: gap, smallest film and
   !> largest pressure, and the film there. Their error falls with the square of the number of nodes, as that of the place of rupture
   !> does.
   subroutine test_steady_table(checks)
      type(check_list_t), intent(inout) :: checks
      !> M, L, H0, smallest H, largest P, H there
      real(dp), parameter :: table(6, 10) = reshape([ &
         0.1_dp, 0.0_dp, 24.7534_dp, 24.5476_dp, 0.008857_dp, 30.0928_dp, 0.4_dp, 0.0_dp, 6.8725_dp, 6.4012_dp, 0.068041_dp, &
         7.8611_dp, 1.0_dp, 0.0_dp, 3.6893_dp, 3.0631_dp, 0.225499_dp, 3.7906_dp, 2.0_dp, 0.0_dp, 2.8231_dp, 2.1416_dp, &
         0.448462_dp, 2.6868_dp, 5.0_dp, 0.0_dp, 3.4527_dp, 1.5906_dp, 0.830886_dp, 2.01593_dp, 0.4_dp, 5.0_dp, 7.5502_dp, &
         7.0698_dp, 0.069258_dp, 8.6855_dp, 1.0_dp, 5.0_dp, 4.8232_dp, 4.1289_dp, 0.245358_dp, 5.1408_dp, 5.0_dp, 5.0_dp, &
         5.2451_dp, 3.1755_dp, 0.95204_dp, 4.1762_dp, 1.0_dp, 10.0_dp, 6.1068_dp, 5.3467_dp, 0.290544_dp, 6.6880_dp, 0.4_dp, &
         20.0_dp, 9.7621_dp, 9.2532_dp, 0.075522_dp, 11.3797_dp], [6, 10])
      character(16), parameter :: names(4) = [character(16) :: 'gap', 'smallest film', 'largest pressure', 'film there']
      integer, parameter :: nodes(2) = [32, 128]
      real(dp) :: gap, peak, place, found(4), tolerance(4)
      real(dp), allocatable :: pressures(:)
      type(nodal_grid_t) :: grid
      type(closure_t) :: oil
      character(64) :: name
      logical :: solved
      integer :: i, j, k

      do i = 1, size(table, 2)
         oil = oil_of(merge(viscosity_constant, viscosity_barus, table(2, i) <= 0.0_dp), table(2, i))
         do j = 1, 2
            ! S of module nodal_scene
            grid = grid_of(nodes(j), 1.6_dp*sqrt(2.0_dp*closure_steady_film(oil, table(1, i)) + 8.0_dp/pi*table(1, i)), 0.0_dp, &
                           merge(outlet_shift, 0.0_dp, oil%viscosity_law == viscosity_constant))
            if (allocated(pressures)) deallocate (pressures)
            allocate (pressures(nodes(j)))
            call solve_steady(oil, grid, table(1, i), gap, pressures, solved)
            write (name, '(a, i0, a, f3.1, a, f4.1)') 'steady, ', nodes(j), ' nodes, M ', table(1, i), ', L ', table(2, i)
            call checks%check(solved, trim(name)//': solved')
            if (.not. solved) cycle
            call find_largest_pressure(pressures, peak, place)
            found = [gap/table(3, i), smallest_film(grid, gap, pressures)/table(4, i), peak/table(5, i), &
                     film_at_place(films_along(grid, gap, pressures), place)/table(6, i)]
            tolerance = merge([0.007_dp, 0.007_dp, 0.018_dp, 0.025_dp], [0.0005_dp, 0.001_dp, 0.001_dp, 0.001_dp], j == 1)
            if (table(1, i) > 4.0_dp) tolerance = merge([0.008_dp, 0.03_dp, 0.045_dp, 0.01_dp], &
                                                        [0.001_dp, 0.001_dp, 0.008_dp, 0.003_dp], j == 1)
            do k = 1, 4
               call checks%check_close(found(k), 1.0_dp, tolerance(k), trim(name)//': '//trim(names(k)))
            end do
         end do
      end do
   end subroutine test_steady_table

   !> Dowson and Higginson's smallest film, 1.631 L^0.54 M^-0.13, within the 0.6 % of the extrapolated solutions, and that of
   !> Kostreva's problem, which cuts its inlet off.
   subroutine test_literature(checks)
      type(check_list_t), intent(inout) :: checks
      real(dp) :: gap, pressures(128)
      type(nodal_grid_t) :: grid
      logical :: solved

      grid = grid_of(128, 4.0_dp, 0.0_dp)
      call solve_steady(oil_of(viscosity_barus, 5.0_dp), grid, 5.0_dp, gap, pressures, solved)
      call checks%check_close(smallest_film(grid, gap, pressures)/(1.631_dp*5.0_dp**0.54_dp*5.0_dp**(-0.13_dp)), 1.0_dp, 0.008_dp, &
                              'Dowson and Higginson, M 5, L 5')
      call solve_steady(oil_of(viscosity_barus, 5.677404_dp), grid, 1.563388_dp, gap, pressures, solved)
      call checks%check_close(smallest_film(grid, gap, pressures), 3.9074_dp, 0.004_dp, 'Kostreva''s problem')
   end subroutine test_literature

   !> Nodes that are closer at the outlet leave the contact where it is.
   subroutine test_shift(checks)
      type(check_list_t), intent(inout) :: checks
      type(nodal_grid_t) :: grid
      real(dp) :: gap, pressures(64), films(129), central(2)
      real(dp), parameter :: shifts(2) = [0.0_dp, outlet_shift]
      logical :: solved
      integer :: i

      do i = 1, 2
         grid = grid_of(64, 4.0_dp, 0.0_dp, shifts(i))
         call solve_steady(oil_of(viscosity_constant, 0.0_dp), grid, 1.0_dp, gap, pressures, solved)
         films = films_along(grid, gap, pressures)
         central(i) = film_at_place(films, grid%middle)
      end do
      call checks%check(grid%place(32) > 1.0_dp .and. grid%middle < 32.0_dp, 'nodes are closer at the outlet')
      call checks%check_close(central(2)/central(1), 1.0_dp, 2.0e-3_dp, 'the film in the middle is that at X = 0')
   end subroutine test_shift

   !> The pressure of a dry contact carries its load, and presses its flanks flat: its film is the same all over its width.
   subroutine test_dry_contact(checks)
      type(check_list_t), intent(inout) :: checks
      real(dp), parameter :: load = 5.0_dp, wide = 3.5682_dp
      real(dp) :: pressures(128), films(128)
      type(nodal_grid_t) :: grid

      grid = grid_of(128, 4.0_dp, 0.0_dp)
      pressures = hertzian_pressure(grid%place, load)
      ! Its edge, where the pressure falls as a root, lies within an interval of a thirtieth of the width: (1/30)^1.5 of the load.
      call checks%check_close(dot_product(grid%load, pressures)/load, 1.0_dp, 6.0e-3_dp, 'a dry contact carries its load')
      films = films_at_nodes(grid, 0.0_dp, pressures)
      associate (inside => abs(grid%place) < 0.9_dp*wide)
         call checks%check_close(maxval(films, mask=inside) - minval(films, mask=inside), 0.0_dp, 2.0e-2_dp, 'its flanks are flat')
      end associate
      call checks%check(all(pressures > 0.0_dp .eqv. abs(grid%place) < wide), 'and as wide as sqrt(8 M/pi)')
   end subroutine test_dry_contact

   !> Slopes of the balance of the cells in pressures and gap against central differences, of all oils, at rest and in motion.
   subroutine test_slopes(checks)
      type(check_list_t), intent(inout) :: checks
      real(dp), parameter :: step = 1.0e-5_dp, tolerance = 1.0e-6_dp
      integer, parameter :: n = 24
      character(8), parameter :: names(3) = [character(8) :: 'constant', 'barus', 'roelands']
      type(nodal_grid_t) :: grid
      type(nodal_balance_t) :: balance, up, down
      type(closure_t) :: oil
      real(dp) :: pressures(n), moved(n), past(n), fourth(0:n), worst, scale
      logical :: filled, near(n)
      integer :: law, k

      grid = grid_of(n, 3.0_dp, 5.0_dp)
      past = -10.0_dp*volumes_of(grid, 3.0_dp, rigid_pressures(grid, 8.0_dp, -2.0_dp, 0.5_dp))
      pressures = rigid_pressures(grid, 8.0_dp, -1.0_dp, 0.6_dp)
      fourth = shares_of_fourth_order(pressures)
      ! What far cells hold has no digits left for a difference.
      near = abs(grid%place) < 30.0_dp
      do law = viscosity_constant, viscosity_roelands
         oil = oil_of(law, 8.0_dp)
         call balance_of_cells(grid, oil, 4.0_dp, pressures, fourth, 10.0_dp, past, balance, filled)
         call checks%check(filled, 'there is a film: '//trim(names(law)))
         worst = 0.0_dp
         do k = 1, n
            moved = pressures
            moved(k) = pressures(k) + step
            call balance_of_cells(grid, oil, 4.0_dp, moved, fourth, 10.0_dp, past, up, filled)
            moved(k) = pressures(k) - step
            call balance_of_cells(grid, oil, 4.0_dp, moved, fourth, 10.0_dp, past, down, filled)
            scale = maxval(abs(balance%by_pressure(:, k)), mask=near)
            moved = abs((up%residual - down%residual)/(2.0_dp*step) - balance%by_pressure(:, k))
            worst = max(worst, maxval(moved, mask=near)/scale)
         end do
         call checks%check_close(worst, 0.0_dp, tolerance, 'slopes in the pressures: '//trim(names(law)))
         call balance_of_cells(grid, oil, 4.0_dp + step, pressures, fourth, 10.0_dp, past, up, filled)
         call balance_of_cells(grid, oil, 4.0_dp - step, pressures, fourth, 10.0_dp, past, down, filled)
         worst = maxval(abs((up%residual - down%residual)/(2.0_dp*step) - balance%by_gap), mask=near) &
                 /maxval(abs(balance%by_gap), mask=near)
         call checks%check_close(worst, 0.0_dp, tolerance, 'slope in the gap: '//trim(names(law)))
      end do
   end subroutine test_slopes

   !> Cells under pressure balance, those without lose oil and gain none, and no pressure is below 0.
   subroutine test_rupture(checks)
      type(check_list_t), intent(inout) :: checks
      type(nodal_grid_t) :: grid
      type(nodal_balance_t) :: balance
      real(dp) :: gap, pressures(48), nothing(48)
      logical :: solved

      nothing = 0.0_dp
      grid = grid_of(48, 4.0_dp, 0.0_dp)
      call solve_steady(oil_of(viscosity_barus, 8.0_dp), grid, 1.5_dp, gap, pressures, solved)
      call balance_of_cells(grid, oil_of(viscosity_barus, 8.0_dp), gap, pressures, shares_of_fourth_order(pressures), 0.0_dp, &
                            nothing, balance, solved)
      call checks%check(minval(pressures) >= 0.0_dp .and. any(pressures <= 0.0_dp), 'no pressure is below 0, and some are 0')
      call checks%check_close(maxval(abs(balance%residual), mask=pressures > 0.0_dp), 0.0_dp, 1.0e-8_dp, 'pressed cells balance')
      call checks%check(minval(balance%residual, mask=pressures <= 0.0_dp) >= 0.0_dp, 'ruptured cells gain no oil')
   end subroutine test_rupture

   !> A flank that goes to nodes and back keeps gaps, loads and, but for what nodes make of it, its film.
   subroutine test_handing_over(checks)
      type(check_list_t), intent(inout) :: checks
      type(nodal_contact_t) :: contact
      type(nodal_flank_t) :: flank
      real(dp) :: films(kept_times), gaps(kept_times), loads(kept_times)
      integer :: j

      contact%oil = oil_of(viscosity_barus, 8.0_dp)
      contact%compliance = 20.0_dp
      contact%grid = grid_of(64, 4.0_dp, contact%compliance)
      do j = 1, kept_times
         flank%film(j) = 60.0_dp + real(j, dp)
         flank%velocity(j) = -3.0_dp
         flank%load(j) = 0.1_dp - 0.001_dp*real(j, dp)
         flank%gap(j) = rigid_gap(contact, flank%film(j), flank%load(j))
      end do
      films = flank%film(1:)
      gaps = flank%gap(1:)
      loads = flank%load(1:)
      call stiffen(contact, flank)
      call checks%check(flank%in_nodes, 'a bent flank is solved in nodes')
      call checks%check_close(maxval(abs([(dot_product(contact%grid%load, flank%pressures(:, j)) - loads(j), j=1, kept_times)])), &
                              0.0_dp, 1.0e-14_dp, 'pressures carry the loads')
      ! The width of the contact is within a fifth of the logarithm, of which the load is a five-hundredth of the film.
      call checks%check_close(maxval(abs(flank%film(1:)/films - 1.0_dp)), 0.0_dp, 1.0e-3_dp, 'films in nodes are those they were')
      call soften(contact, flank)
      call checks%check(.not. flank%in_nodes, 'a rigid flank is not')
      call checks%check_close(maxval(abs(flank%film(1:)/films - 1.0_dp)), 0.0_dp, 1.0e-12_dp, 'films are back')
      call checks%check_close(maxval(abs(flank%gap(1:) - gaps)) + maxval(abs(flank%load(1:) - loads)), 0.0_dp, 0.0_dp, &
                              'gaps and loads stay')
   end subroutine test_handing_over

end module test_nodal_film
