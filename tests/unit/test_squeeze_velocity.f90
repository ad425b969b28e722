!> Tests of the film velocity at which a film carries a load: there and back for every law, its slopes, and loads that no velocity
!> gives.
module test_squeeze_velocity
   use canonical_scenes, only: canonical_scene
   use checks, only: check_list_t
   use film_law, only: film_load, film_t, new_film, overflow_load, squeeze_velocity
   use kinds, only: dp
   use reynolds_piezo_viscous, only: critical_pressure_group, piezo_viscous_load
   use scene_types, only: law_iso_viscous, law_piezo_viscous, model_reynolds, rupture_solved, rupture_solver_fast, &
                          rupture_solver_successive, scene_t
   use squeeze_of_load, only: iso_viscous_squeeze, load_carried, load_too_large, load_too_small, piezo_viscous_squeeze
   implicit none(type, external)
   private

   integer, parameter :: laws = 6
   character(20), parameter :: names(laws) = [character(20) :: 'half-pi', 'solved, fast', 'solved, successive', &
                                              'published piezo', 'exact iso', 'exact piezo']

   public :: run_squeeze_velocity_tests

contains

   !> Runs every test of this topic.
   subroutine run_squeeze_velocity_tests(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      call checks%start('squeeze_velocity')
      call test_there_and_back(checks)
      call test_groups(checks)
      call test_slopes(checks)
      call test_refusals(checks)
   end subroutine run_squeeze_velocity_tests

   !> Films of all laws in the canonical contact, in the order of their names.
   function all_films() result(films)
      type(film_t) :: films(laws)
      type(scene_t) :: scenes(laws)
      integer :: i

      scenes(:3) = canonical_scene(law_iso_viscous, 512)
      scenes(4:) = canonical_scene(law_piezo_viscous, 512)
      scenes(2:3)%film%rupture = rupture_solved
      scenes(2)%film%rupture_solver = rupture_solver_fast
      scenes(3)%film%rupture_solver = rupture_solver_successive
      scenes(5:)%film%model = model_reynolds
      scenes(5)%film%law = law_iso_viscous
      do i = 1, laws
         films(i) = new_film(scenes(i))
      end do
   end function all_films

   !> From velocities to loads and back, films from 10 nm to 100 um, squeeze groups of both signs from 1e-3 to 1e6.
   subroutine test_there_and_back(checks)
      type(check_list_t), intent(inout) :: checks

      integer, parameter :: states = 4000
      real(dp), parameter :: guesses(4) = [1.0_dp + 1.0e-6_dp, 0.7_dp, -3.0_dp, 1.0e6_dp]
      real(dp) :: h, a, w, load, by_film, by_velocity, found, found_by_film, found_by_load, again, rounding
      real(dp) :: worst_velocity, worst_load, worst_guess, guessed
      type(film_t) :: films(laws)
      integer :: law, i, j, outcome, carried

      films = all_films()
      do law = 1, laws
         worst_velocity = 0.0_dp
         worst_load = 0.0_dp
         worst_guess = 0.0_dp
         carried = 0
         do i = 1, states
            h = 10.0_dp**(-8.0_dp + 4.0_dp*fraction_of(i, 0.6180339887498949_dp))
            a = sign(10.0_dp**(-3.0_dp + 9.0_dp*fraction_of(i, 0.7548776662466927_dp)), &
                     fraction_of(i, 0.5698402909980532_dp) - 0.5_dp)
            w = a*1.905_dp*sqrt(h/0.0254_dp)
            if (law == 4) w = 100.0_dp/films(law)%rate*a/(1.0_dp + abs(a))
            call film_load(films(law), h, w, load, by_film, by_velocity)
            if (.not. load < overflow_load) cycle
            call squeeze_velocity(films(law), h, load, 0.0_dp, found, found_by_film, found_by_load, outcome)
            ! A load that is rounded below the least one of (24) is not carried.
            if (outcome /= load_carried) cycle
            carried = carried + 1
            call film_load(films(law), h, found, again, by_film, by_velocity)
            do j = 1, size(guesses)
               call squeeze_velocity(films(law), h, load, guesses(j)*w, guessed, found_by_film, found_by_load, outcome)
               worst_guess = max(worst_guess, abs(guessed - found)/max(abs(found), abs(load/by_velocity)))
            end do
            ! The angle pi/2 + x_e of (24) has few digits where films separate fast, and with them the load.
            rounding = merge(4.0_dp*epsilon(1.0_dp)*max(0.0_dp, a, a*found/w), 0.0_dp, law == 2 .or. law == 3)
            worst_load = max(worst_load, abs(again - load)/(abs(load) + abs(w*by_velocity)) - rounding)
            if (law == 2 .or. law == 3) cycle
            worst_velocity = max(worst_velocity, abs(found - w)/max(abs(w), abs(load/by_velocity)))
         end do
         call checks%check(100*carried > merge(40, 99, law == laws)*states, 'there and back: carried, '//names(law))
         call checks%check_close(worst_load, 0.0_dp, 1.0e-12_dp, 'there and back: load, '//names(law))
         call checks%check_close(worst_guess, 0.0_dp, 1.0e-12_dp, 'any guess of the velocity leads to it, '//names(law))
         call checks%check_close(worst_velocity, 0.0_dp, 1.0e-12_dp, 'there and back: velocity, '//names(law))
      end do
   end subroutine test_there_and_back

   !> Known pairs of A and load group, also at the ends of what numbers can show.
   subroutine test_groups(checks)
      type(check_list_t), intent(inout) :: checks

      real(dp), parameter :: groups(7) = [-1.0e4_dp, -10.0_dp, -0.1_dp, 0.0_dp, 1.0_dp, 10.0_dp, 100.0_dp]
      real(dp), parameter :: loads(7) = [3926.99081698890821_dp, 3.92863451118859376_dp, 0.224017485509953746_dp, &
                                         0.203957020579723718_dp, 0.0785102121900387023_dp, 0.00193998402019949367_dp, &
                                         0.0000197494752420071716_dp]
      real(dp) :: a, psi, by_a, by_b, b
      integer :: i, outcome

      do i = 1, size(groups)
         call iso_viscous_squeeze(loads(i), a, by_a, outcome)
         call checks%check_close(a, groups(i), 1.0e-14_dp*max(1.0_dp, abs(groups(i))), 'known group, iso-viscous')
         call piezo_viscous_squeeze(loads(i), 0.0_dp, 0.0_dp, a, by_a, by_b, outcome)
         call checks%check_close(a, groups(i), 1.0e-14_dp*max(1.0_dp, abs(groups(i))), 'known group, no pressure')
         ! From far below to just below the end of the film
         b = critical_pressure_group(groups(i))
         call piezo_viscous_load(groups(i), 0.999999_dp*b, psi, by_a, by_b)
         call piezo_viscous_squeeze(psi, 0.999999_dp*b, 0.0_dp, a, by_a, by_b, outcome)
         call checks%check_close(a, groups(i), 1.0e-12_dp*max(1.0_dp, abs(groups(i))), 'known group, high pressure')
      end do
   end subroutine test_groups

   !> Slopes against differences of fourth order.
   subroutine test_slopes(checks)
      type(check_list_t), intent(inout) :: checks

      real(dp), parameter :: groups(6) = [-20.0_dp, -2.0_dp, -0.3_dp, 0.2_dp, 2.0_dp, 20.0_dp], step = 2.0e-3_dp
      real(dp), parameter :: fourth_order(-2:2) = [1.0_dp, -8.0_dp, 0.0_dp, 8.0_dp, -1.0_dp]/12.0_dp
      type(film_t) :: films(laws)
      real(dp) :: h, w, load, by_film, by_load, velocity, velocity_by_film, velocity_by_load, film_side(-2:2), load_side(-2:2)
      integer :: law, i, j, outcome

      films = all_films()
      do law = 1, laws
         do i = 1, size(groups)
            ! The load of (24) hardly falls any more at A = 20, and the Reynolds piezo-viscous film does not live at A = -20.
            if (law == merge(2, 3, law == 2) .and. i == 6 .or. law == laws .and. i == 1) cycle
            h = merge(2.0e-5_dp, 2.0e-6_dp, law == laws)
            w = groups(i)*1.905_dp*sqrt(h/0.0254_dp)
            if (law == 4) w = groups(i)/films(law)%rate
            call film_load(films(law), h, w, load, by_film, by_load)
            do j = -2, 2
               film_side(j) = velocity_at(films(law), h*(1.0_dp + real(j, dp)*step), load)
               load_side(j) = velocity_at(films(law), h, load*(1.0_dp + real(j, dp)*step))
            end do
            by_film = sum(fourth_order*film_side)/(step*h)
            by_load = sum(fourth_order*load_side)/(step*load)
            call squeeze_velocity(films(law), h, load, 0.0_dp, velocity, velocity_by_film, velocity_by_load, outcome)
            call checks%check_close(velocity_by_film/by_film, 1.0_dp, 1.0e-7_dp, 'slope in the film, '//names(law))
            call checks%check_close(velocity_by_load/by_load, 1.0_dp, 1.0e-7_dp, 'slope in the load, '//names(law))
         end do
      end do
   end subroutine test_slopes

   !> Velocity of a film under a load [m/s].
   real(dp) function velocity_at(film, thickness, load) result(velocity)
      type(film_t), intent(in) :: film
      !> h [m]
      real(dp), intent(in) :: thickness
      !> W [N]
      real(dp), intent(in) :: load
      real(dp) :: by_film, by_load
      integer :: outcome

      call squeeze_velocity(film, thickness, load, 0.0_dp, velocity, by_film, by_load, outcome)
   end function velocity_at

   !> Loads that no velocity gives, and a law that no one knows.
   subroutine test_refusals(checks)
      type(check_list_t), intent(inout) :: checks

      real(dp), parameter :: h = 1.0e-6_dp
      type(film_t) :: films(laws), unknown
      integer :: law

      films = all_films()
      call refuse(films(1), -1.0e3_dp, load_carried, 'a film of the half-pi law pulls')
      do law = 2, laws
         call refuse(films(law), -1.0e-3_dp, load_too_small, 'no film pulls, '//names(law))
         call refuse(films(law), 0.0_dp, load_too_small, 'no film without a load, '//names(law))
      end do
      ! The load of (24) falls to two sevenths of that without squeeze, no further.
      call refuse(films(2), 2.01_dp/7.0_dp*films(2)%rolling/h, load_carried, 'just above the least load')
      call refuse(films(2), 1.99_dp/7.0_dp*films(2)%rolling/h, load_too_small, 'just below the least load')
      call refuse(films(6), 1.0e12_dp, load_too_large, 'no film under a load beyond the critical pressure')
      unknown = films(1)
      unknown%kernel = 99
      call refuse(unknown, 1.0_dp, load_too_small, 'unknown law')

   contains

      !> The outcome is the one expected, and what is not carried has no velocity.
      subroutine refuse(film, load, expected, message)
         type(film_t), intent(in) :: film
         real(dp), intent(in) :: load
         integer, intent(in) :: expected
         character(*), intent(in) :: message
         real(dp) :: velocity, by_film, by_load
         integer :: outcome

         call squeeze_velocity(film, h, load, 0.0_dp, velocity, by_film, by_load, outcome)
         call checks%check(outcome == expected, message)
         if (outcome /= load_carried) call checks%check(.not. any(abs([velocity, by_film, by_load]) > 0.0_dp), message)
      end subroutine refuse

   end subroutine test_refusals

   !> Fraction of a multiple: numbers spread evenly from 0 to 1.
   pure real(dp) function fraction_of(i, multiplier)
      integer, intent(in) :: i
      real(dp), intent(in) :: multiplier

      fraction_of = real(i, dp)*multiplier - aint(real(i, dp)*multiplier)
   end function fraction_of

end module test_squeeze_velocity
