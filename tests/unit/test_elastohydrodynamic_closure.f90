!> Tests of the closure of elastohydrodynamic films: steady films against solutions in nodes and the literature, its limit of rigid
!> flanks, there and back, slopes, and scene G of a loose gear.
module test_elastohydrodynamic_closure
   use canonical_scenes, only: canonical_scene, scene_g
   use checks, only: check_list_t
   use constants, only: pi
   use controlled_engine, only: solve_window
   use elastohydrodynamic_closure, only: closure_film, closure_films, closure_load, closure_of, closure_pressure, &
                                         closure_steady_film, closure_t, closure_velocities, closure_velocity, closure_width, &
                                         most_films
   use engine, only: ending_t, start_of
   use film_law, only: film_load, film_t, new_film, squeeze_velocity, steady_film
   use flank_elasticity, only: flank_compliance, flattening_compliance
   use kinds, only: dp
   use node_extremes, only: seen_acceleration, seen_films, seen_loads
   use problem, only: films_at_rest, linearise, problem_of, problem_t
   use reynolds_iso_viscous, only: iso_viscous_load
   use scene_status, only: status_complete
   use scene_types, only: law_elastohydrodynamic, law_iso_viscous, model_closure, model_reynolds, scene_t, viscosity_barus, &
                          viscosity_constant, viscosity_roelands
   use squeeze_of_load, only: load_carried
   use window_record, only: window_record_t
   implicit none(type, external)
   private

   character(8), parameter :: law_names(3) = [character(8) :: 'constant', 'barus', 'roelands']

   public :: run_elastohydrodynamic_closure_tests

contains

   !> Runs every test of this topic.
   subroutine run_elastohydrodynamic_closure_tests(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      call checks%start('elastohydrodynamic_closure')
      call test_steady_table(checks)
      call test_literature(checks)
      call test_rest_falls(checks)
      call test_rigid_limit(checks)
      call test_there_and_back(checks)
      call test_slopes(checks)
      call test_width(checks)
      call test_many_films(checks)
      call test_units(checks)
      call test_scene_g(checks)
      call test_total_compliance(checks)
   end subroutine run_elastohydrodynamic_closure_tests

   !> A closure whose Moes' units are 1, but for those of Roelands' law.
   pure type(closure_t) function unit_closure(viscosity_law, material)
      integer, intent(in) :: viscosity_law
      !> L [-]
      real(dp), intent(in) :: material

      ! eps = 1/300: u and E* follow from it.
      unit_closure = closure_of(radius=0.01_dp, length=0.02_dp, modulus=226.0e9_dp, &
                                speed=226.0e9_dp*0.01_dp/0.05_dp/300.0_dp**4, viscosity=0.05_dp, &
                                pressure_viscosity=material/226.0e9_dp*300.0_dp, viscosity_law=viscosity_law)
   end function unit_closure

   !> Smallest films of steady contacts, by solutions in nodes: within what the closure is off.
   subroutine test_steady_table(checks)
      type(check_list_t), intent(inout) :: checks
      !> M, L, smallest H, and by how much the closure is above it
      real(dp), parameter :: table(4, 10) = reshape([ &
         0.1_dp, 0.0_dp, 24.5476_dp, 0.000_dp, 0.4_dp, 0.0_dp, 6.4012_dp, 0.005_dp, 1.0_dp, 0.0_dp, 3.0631_dp, 0.013_dp, &
         2.0_dp, 0.0_dp, 2.1416_dp, 0.010_dp, 5.0_dp, 0.0_dp, 1.5906_dp, 0.06_dp, 0.4_dp, 5.0_dp, 7.0698_dp, 0.02_dp, &
         1.0_dp, 5.0_dp, 4.1289_dp, 0.02_dp, 5.0_dp, 5.0_dp, 3.1755_dp, 0.047_dp, 1.0_dp, 10.0_dp, 5.3467_dp, 0.02_dp, &
         0.4_dp, 20.0_dp, 9.2532_dp, 0.05_dp], [4, 10])
      real(dp) :: film, rounding
      character(40) :: name
      integer :: i

      do i = 1, size(table, 2)
         film = closure_steady_film(unit_closure(merge(viscosity_constant, viscosity_barus, table(2, i) <= 0.0_dp), table(2, i)), &
                                    table(1, i))
         write (name, '(a, f3.1, a, f4.1)') 'smallest steady film at M ', table(1, i), ', L ', table(2, i)
         ! The errors are reported to one or two digits.
         rounding = merge(0.006_dp, 0.0006_dp, table(4, i) > 0.015_dp)
         call checks%check_close(film/table(3, i) - 1.0_dp, table(4, i), rounding, trim(name))
      end do
   end subroutine test_steady_table

   !> Films of the literature: Moes' regression of the film at the largest pressure lies above the smallest film by what the table
   !> of solutions in nodes says, and is within 5 % of it; Dowson and Higginson's smallest films.
   subroutine test_literature(checks)
      type(check_list_t), intent(inout) :: checks
      real(dp) :: film

      film = closure_steady_film(unit_closure(viscosity_constant, 0.0_dp), 0.1_dp)
      call checks%check_close(film*30.0928_dp/24.5476_dp/moes(0.1_dp, 0.0_dp), 1.0_dp, 0.05_dp, 'Moes, M 0.1, L 0')
      film = closure_steady_film(unit_closure(viscosity_constant, 0.0_dp), 1.0_dp)
      call checks%check_close(film*3.7906_dp/3.0631_dp/moes(1.0_dp, 0.0_dp), 1.0_dp, 0.063_dp, 'Moes, M 1, L 0')
      film = closure_steady_film(unit_closure(viscosity_barus, 10.0_dp), 1.0_dp)
      call checks%check_close(film*6.6880_dp/5.3467_dp/moes(1.0_dp, 10.0_dp), 1.0_dp, 0.07_dp, 'Moes, M 1, L 10')
      ! M 5, L 5: the closure is 5 % above the solution in nodes, which is within 0.6 % of Dowson and Higginson.
      film = closure_steady_film(unit_closure(viscosity_barus, 5.0_dp), 5.0_dp)
      call checks%check_close(film/(1.631_dp*5.0_dp**0.54_dp*5.0_dp**(-0.13_dp)), 1.05_dp, 0.01_dp, &
                              'Dowson and Higginson, M 5, L 5')
   end subroutine test_literature

   !> The film at rest falls with the load wherever the closure is fitted. Without the limit of g_r it would rise with it by a power
   !> of 0.4.
   subroutine test_rest_falls(checks)
      type(check_list_t), intent(inout) :: checks
      !> Viscosities and coefficients of oils that pressure thickens [Pa s], [1/Pa]
      real(dp), parameter :: oils(2, 3) = reshape([0.005_dp, 1.2e-8_dp, 0.1_dp, 2.0e-8_dp, 2.0_dp, 2.5e-8_dp], [2, 3])
      !> Of each law: what the closure has, rounded down; films in nodes fall by powers of 0.3, 0.01 and 0.03 at least
      real(dp), parameter :: least_powers(viscosity_constant:viscosity_roelands) = [0.39_dp, 0.0005_dp, 0.034_dp]
      real(dp), parameter :: step = 1.0e-3_dp
      type(closure_t) :: closure
      real(dp) :: m, power, least, speed
      integer :: law, oil, material, i

      do law = viscosity_constant, viscosity_roelands
         least = huge(1.0_dp)
         do oil = 1, size(oils, 2)
            do material = 1, 20
               speed = (real(material, dp)/(oils(2, oil)*226.0e9_dp))**4*226.0e9_dp*0.01_dp/oils(1, oil)
               closure = closure_of(radius=0.01_dp, length=0.02_dp, modulus=226.0e9_dp, speed=speed, viscosity=oils(1, oil), &
                                    pressure_viscosity=oils(2, oil), viscosity_law=law)
               do i = 1, 60
                  m = 0.05_dp*40.0_dp**(real(i, dp)/60.0_dp)
                  power = -log(closure_steady_film(closure, m*exp(step))/closure_steady_film(closure, m*exp(-step)))/(2.0_dp*step)
                  least = min(least, power)
               end do
            end do
         end do
         call checks%check(least >= least_powers(law), 'the film at rest falls with the load: '//trim(law_names(law)))
      end do
   end subroutine test_rest_falls

   !> Moes' regression of the film at the largest pressure.
   pure real(dp) function moes(m, l)
      real(dp), intent(in) :: m
      real(dp), intent(in) :: l
      real(dp) :: ri, rp, ei, ep, s, iso, piezo

      ri = 3.0_dp/m
      rp = 1.287_dp*l**(2.0_dp/3.0_dp)
      ei = 2.621_dp*m**(-0.2_dp)
      ep = 1.311_dp*m**(-0.125_dp)*l**0.75_dp
      s = (7.0_dp + 8.0_dp*exp(-2.0_dp*ei/ri))/5.0_dp
      iso = (ri**(7.0_dp/3.0_dp) + ei**(7.0_dp/3.0_dp))**(3.0_dp*s/7.0_dp)
      piezo = 0.0_dp
      if (l > 0.0_dp) piezo = (rp**(-3.5_dp) + ep**(-3.5_dp))**(-2.0_dp*s/7.0_dp)
      moes = (iso + piezo)**(1.0_dp/s)
   end function moes

   !> Under little load the film is that of rigid flanks: M H = 12 Phi(A), to first order in M/H.
   subroutine test_rigid_limit(checks)
      type(check_list_t), intent(inout) :: checks
      real(dp) :: load, by_film, by_velocity, phi, slope, film, velocity
      logical :: exists
      integer :: law, i

      do law = viscosity_constant, viscosity_roelands
         do i = -3, 3
            film = 1.0e4_dp
            velocity = real(i, dp)*sqrt(0.5_dp*film)
            call closure_load(unit_closure(law, 8.0_dp), film, velocity, load, by_film, by_velocity, exists)
            call iso_viscous_load(real(i, dp), phi, slope)
            call checks%check(exists, 'a film of little load: '//trim(law_names(law)))
            call checks%check_close(load*film/(12.0_dp*phi), 1.0_dp, 5.0e-4_dp, 'as of rigid flanks: '//trim(law_names(law)))
         end do
      end do
   end subroutine test_rigid_limit

   !> Loads of the lower branch lead to velocities, and these back; films at rest have no velocity.
   subroutine test_there_and_back(checks)
      type(check_list_t), intent(inout) :: checks
      real(dp), parameter :: rounding = 1.0e-9_dp
      type(closure_t) :: closure
      real(dp) :: film, load, velocity, by_film, by_load, again, worst, worst_rest
      logical :: exists
      integer :: law, i, outcome, tried

      do law = viscosity_constant, viscosity_roelands
         closure = unit_closure(law, 8.0_dp)
         worst = 0.0_dp
         worst_rest = 0.0_dp
         tried = 0
         do i = 1, 2000
            film = 10.0_dp**(3.5_dp*modulo(0.618_dp*real(i, dp), 1.0_dp))
            load = 10.0_dp**(-4.0_dp + 4.6_dp*modulo(0.755_dp*real(i, dp), 1.0_dp))
            call closure_velocity(closure, film, load, velocity, by_film, by_load, outcome)
            call checks%check(outcome == load_carried, 'some velocity gives the load: '//trim(law_names(law)))
            if (.not. by_load < 0.0_dp) cycle
            call closure_load(closure, film, velocity, again, by_film, by_load, exists)
            ! A load beyond which the velocity rises again has another one below it that moves alike.
            if (.not. exists .or. again < 0.99_dp*load) cycle
            tried = tried + 1
            worst = max(worst, abs(again/load - 1.0_dp))
            call closure_velocity(closure, closure_steady_film(closure, load), load, velocity, by_film, by_load, outcome)
            worst_rest = max(worst_rest, abs(velocity))
         end do
         call checks%check(tried > 1900, 'nearly all loads are met again: '//trim(law_names(law)))
         call checks%check_close(worst, 0.0_dp, rounding, 'there and back: '//trim(law_names(law)))
         call checks%check_close(worst_rest, 0.0_dp, rounding, 'films at rest rest: '//trim(law_names(law)))
      end do
   end subroutine test_there_and_back

   !> Slopes against central differences.
   subroutine test_slopes(checks)
      type(check_list_t), intent(inout) :: checks
      !> Step of the logarithms; its square and rounding over it leave about 1e-9, the table of Phi's inverse a little more
      real(dp), parameter :: step = 1.0e-5_dp, tolerance = 2.0e-7_dp
      type(closure_t) :: closure
      real(dp) :: film, load, velocity, by_film, by_load, up, down, a, b, worst_film, worst_load, scale
      integer :: law, i, outcome

      do law = viscosity_constant, viscosity_roelands
         closure = unit_closure(law, 8.0_dp)
         worst_film = 0.0_dp
         worst_load = 0.0_dp
         do i = 1, 500
            film = 10.0_dp**(3.0_dp*modulo(0.618_dp*real(i, dp), 1.0_dp))
            load = 10.0_dp**(-3.0_dp + 3.5_dp*modulo(0.755_dp*real(i, dp), 1.0_dp))
            call closure_velocity(closure, film, load, velocity, by_film, by_load, outcome)
            scale = max(abs(velocity), sqrt(film))
            call closure_velocity(closure, film*exp(step), load, up, a, b, outcome)
            call closure_velocity(closure, film*exp(-step), load, down, a, b, outcome)
            worst_film = max(worst_film, abs((up - down)/(2.0_dp*step) - by_film*film)/scale)
            call closure_velocity(closure, film, load*exp(step), up, a, b, outcome)
            call closure_velocity(closure, film, load*exp(-step), down, a, b, outcome)
            worst_load = max(worst_load, abs((up - down)/(2.0_dp*step) - by_load*load)/scale)
         end do
         call checks%check_close(worst_film, 0.0_dp, tolerance, 'slope in the film: '//trim(law_names(law)))
         call checks%check_close(worst_load, 0.0_dp, tolerance, 'slope in the load: '//trim(law_names(law)))
      end do
   end subroutine test_slopes

   !> Compression of flanks by the width of their contact: by its formula, its slopes, and from gaps to films.
   subroutine test_width(checks)
      type(check_list_t), intent(inout) :: checks
      real(dp), parameter :: step = 1.0e-6_dp, tolerance = 1.0e-8_dp
      type(closure_t) :: closure
      real(dp) :: film, load, gives, by_film, by_load, up, down, a, b, worst, worst_slope, worst_formula, unit
      integer :: i

      closure = unit_closure(viscosity_constant, 0.0_dp)
      unit = closure%film_unit/closure%load_unit
      worst = 0.0_dp
      worst_slope = 0.0_dp
      worst_formula = 0.0_dp
      do i = 1, 500
         film = closure%film_unit*10.0_dp**(-2.0_dp + 5.0_dp*modulo(0.618_dp*real(i, dp), 1.0_dp))
         load = closure%load_unit*10.0_dp**(-5.0_dp + 6.0_dp*modulo(0.755_dp*real(i, dp), 1.0_dp))
         call closure_width(closure, film, load, gives, by_film, by_load)
         worst_formula = max(worst_formula, abs(gives + 2.0_dp/pi*unit*load*log(0.516_dp*film/closure%film_unit + &
                                                                                  0.245_dp*load/closure%load_unit))/(unit*load))
         call closure_width(closure, film*(1.0_dp + step), load, up, a, b)
         call closure_width(closure, film*(1.0_dp - step), load, down, a, b)
         worst_slope = max(worst_slope, abs((up - down)/(2.0_dp*step) - by_film*film)/(unit*load))
         call closure_width(closure, film, load*(1.0_dp + step), up, a, b)
         call closure_width(closure, film, load*(1.0_dp - step), down, a, b)
         worst_slope = max(worst_slope, abs((up - down)/(2.0_dp*step) - by_load*load)/(unit*load))
         worst = max(worst, abs(closure_film(closure, film - gives, load, 0.0_dp)/film - 1.0_dp), &
                     abs(closure_film(closure, film - gives, load, 30.0_dp*film)/film - 1.0_dp))
      end do
      call checks%check_close(worst_formula, 0.0_dp, 1.0e-13_dp, 'width: its formula')
      call checks%check_close(worst_slope, 0.0_dp, tolerance, 'width: slopes')
      call checks%check_close(worst, 0.0_dp, 1.0e-11_dp, 'from gaps to films')
      load = 10.0_dp*closure%load_unit
      call checks%check(closure_film(closure, -100.0_dp*closure%film_unit, load, 0.0_dp) < 0.0_dp, 'no film leaves such a gap')
      call checks%check_close(closure_film(closure, film, 0.0_dp, 0.0_dp), film, 0.0_dp, 'without a load the gap is the film')
   end subroutine test_width

   !> Many films at once are each of them alone, those without load or without room included.
   subroutine test_many_films(checks)
      type(check_list_t), intent(inout) :: checks
      ! Both take the same steps but for sums that the compiler may fuse, and end within the last digits of Newton's method.
      real(dp), parameter :: tolerance = 1.0e-12_dp
      integer, parameter :: laws(3) = [viscosity_constant, viscosity_barus, viscosity_roelands]
      type(closure_t) :: closure
      real(dp), dimension(most_films) :: gap, film, load, near, velocity, by_film, by_load, by_gap, alone
      real(dp) :: velocity_alone, by_film_alone, by_load_alone, worst, worst_film
      integer :: outcome(most_films), outcome_alone, law, round, i
      logical :: same

      do law = 1, 3
         closure = unit_closure(laws(law), 5.0_dp)
         worst = 0.0_dp
         worst_film = 0.0_dp
         same = .true.
         do round = 1, 40
            do i = 1, most_films
               film(i) = closure%film_unit*10.0_dp**(-1.0_dp + 4.0_dp*modulo(0.618_dp*real(16*round + i, dp), 1.0_dp))
               load(i) = closure%load_unit*10.0_dp**(-4.0_dp + 5.0_dp*modulo(0.755_dp*real(16*round + i, dp), 1.0_dp))
            end do
            load(3) = 0.0_dp
            gap = film
            gap(5) = -100.0_dp*closure%film_unit
            near = film*0.9_dp
            call closure_films(closure, most_films, gap, load, near, film, by_gap, by_load)
            alone = closure_film(closure, gap, load, near)
            worst_film = max(worst_film, maxval(abs(film/alone - 1.0_dp)))
            do i = 1, most_films
               call closure_width(closure, max(film(i), 0.0_dp), load(i), velocity_alone, by_film_alone, by_load_alone)
               if (film(i) < 0.0_dp) by_film_alone = 0.0_dp
               if (i /= 3) worst_film = max(worst_film, abs(by_gap(i)*(1.0_dp - by_film_alone) - by_film_alone), &
                                            abs(by_load(i)*(1.0_dp - by_film_alone)/by_load_alone - 1.0_dp))
            end do
            ! No film of a gap that is too small.
            where (film < 0.0_dp) film = closure%film_unit
            film = film/closure%film_unit
            load = load/closure%load_unit
            call closure_velocities(closure, most_films, film, load, velocity, by_film, by_load, outcome)
            do i = 1, most_films
               call closure_velocity(closure, film(i), load(i), velocity_alone, by_film_alone, by_load_alone, outcome_alone)
               same = same .and. outcome(i) == outcome_alone
               if (i == 3) same = same .and. .not. abs(velocity(i)) + abs(by_film(i)) + abs(by_load(i)) > 0.0_dp
               if (i /= 3) worst = max(worst, abs(velocity(i) - velocity_alone)/abs(velocity_alone), &
                                       abs(by_load(i) - by_load_alone)/abs(by_load_alone))
            end do
         end do
         call checks%check(same, 'many films: which carry their load: '//trim(law_names(law)))
         call checks%check_close(worst, 0.0_dp, tolerance, 'many films: velocities: '//trim(law_names(law)))
         call checks%check_close(worst_film, 0.0_dp, 1.0e-7_dp, 'many films: over their gaps: '//trim(law_names(law)))
      end do
   end subroutine test_many_films

   !> Film of a scene in SI units: that of Moes' variables, and Reynolds' where the load is small.
   subroutine test_units(checks)
      type(check_list_t), intent(inout) :: checks
      type(scene_t) :: scene
      type(film_t) :: film, rigid
      real(dp) :: load, by_film, by_velocity, rigid_load, velocity, by_load
      integer :: outcome

      scene = canonical_scene(law_elastohydrodynamic, 512)
      scene%film%model = model_closure
      scene%lubricant%viscosity_law = viscosity_constant
      film = new_film(scene)
      scene%film%law = law_iso_viscous
      scene%film%model = model_reynolds
      rigid = new_film(scene)
      call film_load(film, 1.0e-4_dp, -0.01_dp, load, by_film, by_velocity)
      call film_load(rigid, 1.0e-4_dp, -0.01_dp, rigid_load, by_film, by_velocity)
      call checks%check_close(load/rigid_load, 1.0_dp, 1.0e-3_dp, 'a thick film is that of rigid flanks')
      call squeeze_velocity(film, 1.0e-4_dp, load, 0.0_dp, velocity, by_film, by_load, outcome)
      call checks%check_close(velocity, -0.01_dp, 1.0e-10_dp, 'its velocity')
      call checks%check_close(by_load*by_velocity, 1.0_dp, 1.0e-2_dp, 'its damping')
      call checks%check_close(steady_film(film, 0.1_dp)/steady_film(rigid, 0.1_dp), 1.0_dp, 1.0e-3_dp, 'its steady film')
      ! Iso-viscous largest pressures are within 3 % of those of impacts in nodes, and 4 % below at rest: M 1, P max 0.2255.
      call checks%check_close(closure_pressure(film%closure, 3.103_dp*film%closure%film_unit, film%closure%load_unit) &
                              /film%closure%pressure_unit/0.225499_dp, 1.0_dp, 0.045_dp, 'largest pressure')
   end subroutine test_units

   !> Twelfth period of scene G: the closure's own numbers to their last digit, which independent programs reported, those of
   !> Roelands' oil that of tests/reference (with tolerances of 1e-6 and 1e-7 alike); so the closure is as far from the films in
   !> nodes as it is said to be.
   subroutine test_scene_g(checks)
      type(check_list_t), intent(inout) :: checks
      !> z'' max and min [m/s2], films [m], loads [N], in nodes and by the closure: iso-viscous, Roelands
      real(dp), parameter :: in_nodes(6, 2) = reshape([508.18_dp, -251.54_dp, 0.1319e-6_dp, 0.2177e-6_dp, 326.80_dp, 161.06_dp, &
                                                       514.03_dp, -255.15_dp, 0.2385e-6_dp, 0.2926e-6_dp, 330.41_dp, 163.30_dp], &
                                                      [6, 2])
      real(dp), parameter :: by_closure(5, 2) = reshape([507.1_dp, -250.4_dp, 0.1325e-6_dp, 0.2201e-6_dp, 326.1_dp, &
                                                         513.84_dp, -254.56_dp, 0.23415e-6_dp, 0.29909e-6_dp, 330.30_dp], [5, 2])
      real(dp), parameter :: last_digit(5, 2) = reshape([0.1_dp, 0.1_dp, 1.0e-10_dp, 1.0e-10_dp, 0.1_dp, &
                                                         0.01_dp, 0.01_dp, 1.0e-11_dp, 1.0e-11_dp, 0.01_dp], [5, 2])
      !> Of peaks, films of iso-viscous and of thickened oil, and loads
      real(dp), parameter :: errors(6, 2) = reshape([0.005_dp, 0.005_dp, 0.013_dp, 0.013_dp, 0.005_dp, 0.005_dp, &
                                                     0.006_dp, 0.006_dp, 0.037_dp, 0.037_dp, 0.006_dp, 0.006_dp], [6, 2])
      character(16), parameter :: names(6) = [character(16) :: 'acceleration max', 'acceleration min', 'drive film', &
                                              'coast film', 'drive load', 'coast load']
      integer, parameter :: laws(2) = [viscosity_constant, viscosity_roelands]
      type(problem_t) :: problem
      type(ending_t) :: ending
      type(window_record_t) :: record
      real(dp), allocatable :: states(:, :), samples(:)
      real(dp) :: found(6)
      integer :: i, j

      do i = 1, 2
         problem = problem_of(scene_g(laws(i)))
         call solve_window(problem, start_of(problem), 1.0e-7_dp, 256, 12, 1, states, samples, ending, record)
         call checks%check(ending%status == status_complete, 'scene G is solved')
         associate (lowest => record%lowest, highest => record%highest)
            found = [highest(seen_acceleration)%value, lowest(seen_acceleration)%value, lowest(seen_films(1))%value, &
                     lowest(seen_films(2))%value, highest(seen_loads(1))%value, highest(seen_loads(2))%value]
         end associate
         do j = 1, 6
            call checks%check_close(found(j)/in_nodes(j, i), 1.0_dp, errors(j, i), 'scene G, '//trim(law_names(laws(i)))//': '// &
                                    trim(names(j))//' near that in nodes')
         end do
         do j = 1, 5
            call checks%check_close(found(j), by_closure(j, i), last_digit(j, i), 'scene G, '//trim(law_names(laws(i)))//': '// &
                                    trim(names(j)))
         end do
      end do
   end subroutine test_scene_g

   !> A stiffness contains the flattening unless it is said not to: compliances of both kinds, of both laws; and at low pressure rigid
   !> and bending flanks on one stiffness are as stiff.
   subroutine test_total_compliance(checks)
      type(check_list_t), intent(inout) :: checks
      type(scene_t) :: scene, rigid
      type(problem_t) :: bending, stiff
      real(dp) :: plane, stiffness(2), damping(2)

      scene = scene_g(viscosity_constant)
      plane = 7.7182_dp/(226.0e9_dp*0.018943_dp)
      call checks%check_close(flattening_compliance(scene)/plane, 1.0_dp, 1.0e-5_dp, 'plane contact of scene G')
      call checks%check_close(flank_compliance(scene)*226.0e9_dp*0.018943_dp, 25.7061_dp, 1.0e-3_dp, 'beside the teeth')
      rigid = scene
      rigid%film%law = law_iso_viscous
      rigid%film%model = model_reynolds
      call checks%check_close(flank_compliance(rigid), flank_compliance(scene), 0.0_dp, 'of rigid flanks alike')
      scene%contact%flattening_included = .true.
      rigid%contact%flattening_included = .true.
      call checks%check_close(flank_compliance(scene), 1.0_dp/2.38e8_dp, 0.0_dp, 'in the teeth')
      bending = problem_of(scene)
      stiff = problem_of(rigid)
      call linearise(bending, films_at_rest(bending, 2.04527_dp), stiffness(1), damping(1))
      call linearise(stiff, films_at_rest(stiff, 2.04527_dp), stiffness(2), damping(2))
      call checks%check_close(stiffness(1)/stiffness(2), 1.0_dp, 1.0e-3_dp, 'stiffness at low pressure')
      call checks%check_close(damping(1)/damping(2), 1.0_dp, 2.0e-3_dp, 'damping at low pressure')
      scene%contact%stiffness = 0.0_dp
      rigid%contact%stiffness = 0.0_dp
      call checks%check_close(flank_compliance(scene), flattening_compliance(scene), 0.0_dp, 'flanks of rigid teeth flatten')
      call checks%check_close(flank_compliance(rigid), 0.0_dp, 0.0_dp, 'rigid flanks of rigid teeth do not')
   end subroutine test_total_compliance

end module test_elastohydrodynamic_closure
