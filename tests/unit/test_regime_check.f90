!> Tests of the regime of a motion by its exact pressure.
module test_regime_check
   use canonical_scenes, only: canonical_scene, static_load
   use checks, only: check_list_t
   use film_law, only: film_t, new_film, steady_film
   use flank_contact, only: flank_contact_t
   use kinds, only: dp
   use node_extremes, only: seen_pressure
   use problem, only: of_film, problem_t
   use regime, only: film_elastohydrodynamic, film_iso_viscous, film_piezo_viscous
   use regime_check, only: check_regime, gap_both, gap_too_narrow, gap_too_wide, model_limit, regime_sentence, regime_verdict_t, &
                           steady_alpha_p, within_model
   use scene_types, only: law_iso_viscous, law_piezo_viscous, model_reynolds, scene_t
   use window_extremes, only: extremes_of_samples, window_extremes_t
   implicit none(type, external)
   private

   !> Critical pressure groups of films at rest, A = 0, and falling with A = -1.
   real(dp), parameter :: critical_at_rest = 7.889828622697975_dp, critical_falling = 3.299920163085864_dp
   real(dp), parameter :: rounding = 64.0_dp*epsilon(1.0_dp)

   public :: run_regime_check_tests

contains

   !> Runs every test of this topic.
   subroutine run_regime_check_tests(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      call checks%start('regime_check')
      call test_steady(checks)
      call test_canonical(checks)
      call test_largest(checks)
      call test_regimes(checks)
      call test_exact_piezo_viscous(checks)
      call test_deep(checks)
      call test_sentences(checks)
      call test_model_limit(checks)
   end subroutine run_regime_check_tests

   !> B of a film thickness: 6 sqrt(2) (u eta0 alpha/R)/(h/R)^(3/2).
   pure real(dp) function pressure_group(film, thickness)
      type(film_t), intent(in) :: film      !> The film
      real(dp), intent(in) :: thickness     !> h [m]

      pressure_group = 6.0_dp*sqrt(2.0_dp)*film%speed*film%viscosity*film%pressure_viscosity/film%radius &
         *(film%radius/thickness)**1.5_dp
   end function pressure_group

   !> Regime of a motion of which some samples are known.
   pure function regime_of(film, films, velocities) result(verdict)
      type(film_t), intent(in) :: film        !> The film
      real(dp), intent(in) :: films(:)        !> h [m]
      real(dp), intent(in) :: velocities(:)   !> z' [m/s]
      type(regime_verdict_t) :: verdict

      type(window_extremes_t) :: extremes

      extremes = extremes_of_samples(problem_t(contact=flank_contact_t(film=film)), &
                                     reshape([films, velocities], [size(films), 2]), velocities)
      associate (pressure => extremes%highest(seen_pressure))
         verdict = check_regime(film, pressure%value, pressure%state(of_film))
      end associate
   end function regime_of

   !> Film whose B is a given one, so that alpha p is B/B_crit [m].
   pure real(dp) function film_of_group(film, group)
      type(film_t), intent(in) :: film      !> The film
      real(dp), intent(in) :: group         !> B [-]

      film_of_group = film%radius*(pressure_group(film, film%radius)/group)**(2.0_dp/3.0_dp)
   end function film_of_group

   !> A film at rest, and one with A = -1, have alpha p = B/B_crit.
   subroutine test_steady(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      type(film_t) :: film
      type(regime_verdict_t) :: verdict
      real(dp) :: h, w

      film = new_film(canonical_scene(law_iso_viscous, 512))
      h = 2.0e-6_dp
      call checks%check_close(steady_alpha_p(film, h)/(pressure_group(film, h)/critical_at_rest), 1.0_dp, &
         rounding, &
         'alpha p at rest')
      verdict = regime_of(film, [h], [0.0_dp])
      call checks%check_close(verdict%alpha_p_maximum, steady_alpha_p(film, h), 0.0_dp, 'one sample at rest')
      call checks%check_close(verdict%pressure_maximum*film%pressure_viscosity/verdict%alpha_p_maximum, &
         1.0_dp, rounding, &
         'pressure of an iso-viscous law')
      ! p in 4 R p^2/E*^2.
      call checks%check_close( &
         verdict%deflection/(4.0_dp*film%radius*(verdict%pressure_maximum/226.0e9_dp)**2), &
         1.0_dp, &
         rounding, 'deflection')
      w = -0.25_dp*film%speed*sqrt(2.0_dp*h/film%radius)
      verdict = regime_of(film, [h], [w])
      call checks%check_close(verdict%alpha_p_maximum/(pressure_group(film, h)/critical_falling), 1.0_dp, &
         rounding, &
         'alpha p with A = -1')
   end subroutine test_steady

   !> Known to two decimals: at the steady film both canonical scenes are beyond what their films assume.
   subroutine test_canonical(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      real(dp), parameter :: known(2) = [1.65_dp, 1.38_dp]
      type(film_t) :: film
      type(regime_verdict_t) :: verdict
      real(dp) :: h
      integer :: law

      do law = 1, 2
         film = new_film(canonical_scene(law, 512))
         h = steady_film(film, static_load)
         call checks%check_close(steady_alpha_p(film, h), known(law), 0.005_dp, 'canonical scene: alpha p')
         verdict = regime_of(film, [h, 2.0_dp*h], [0.0_dp, 0.0_dp])
         call checks%check(verdict%regime == film_elastohydrodynamic, 'canonical scene: elastohydrodynamic')
         call checks%check(verdict%law_contradicted, 'canonical scene: law contradicted')
         call checks%check(verdict%pressure_exists .eqv. law == law_iso_viscous, &
            'canonical scene: q does not exist')
      end do
   end subroutine test_canonical

   !> The sample of the largest pressure is found wherever it stands, and its film with it.
   subroutine test_largest(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      type(film_t) :: film
      type(regime_verdict_t) :: verdict
      real(dp) :: films(5), velocities(5), many(1000)
      integer :: i, k

      film = new_film(canonical_scene(law_iso_viscous, 512))
      do i = 1, 5
         films = [3.0e-6_dp, 3.5e-6_dp, 4.0e-6_dp, 5.0e-6_dp, 6.0e-6_dp]
         velocities = 0.0_dp
         films(i) = 2.5e-6_dp
         verdict = regime_of(film, films, velocities)
         call checks%check_close(verdict%film, 2.5e-6_dp, 0.0_dp, 'the thinnest film at rest')
         call checks%check_close(verdict%alpha_p_maximum, steady_alpha_p(film, 2.5e-6_dp), 0.0_dp, &
            'its alpha p')
      end do
      do i = 1, 1000, 37
         many = 4.0e-6_dp
         many(i) = 2.5e-6_dp
         verdict = regime_of(film, many, [(0.0_dp, k=1, 1000)])
         call checks%check_close(verdict%film, 2.5e-6_dp, 0.0_dp, 'the thinnest film of many')
      end do
      ! A thicker film that falls fast has the larger pressure.
      velocities(3) = -1.0_dp
      verdict = regime_of(film, films, velocities)
      call checks%check_close(verdict%film, films(3), 0.0_dp, 'the falling film')
   end subroutine test_largest

   !> Regime and contradiction on both sides of alpha p = 0.1 and 1, with steel stiff enough not to matter.
   subroutine test_regimes(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      call expect(law_iso_viscous, 0.09_dp, film_iso_viscous, .false., .true.)
      call expect(law_iso_viscous, 0.11_dp, film_piezo_viscous, .true., .true.)
      call expect(law_iso_viscous, 1.01_dp, film_elastohydrodynamic, .true., .true.)
      call expect(law_piezo_viscous, 0.09_dp, film_iso_viscous, .true., .true.)
      call expect(law_piezo_viscous, 0.11_dp, film_piezo_viscous, .false., .true.)
      call expect(law_piezo_viscous, 0.99_dp, film_piezo_viscous, .false., .true.)
      call expect(law_piezo_viscous, 1.01_dp, film_elastohydrodynamic, .true., .false.)

   contains

      !> A film at rest with a given alpha p.
      subroutine expect(law, alpha_p, regime, contradicted, exists)
         integer, intent(in) :: law           !> Law of the scene
         real(dp), intent(in) :: alpha_p      !> Largest alpha p
         integer, intent(in) :: regime        !> Its regime
         logical, intent(in) :: contradicted  !> Whether the law does not fit
         logical, intent(in) :: exists        !> Whether its pressure exists

         type(film_t) :: film
         type(regime_verdict_t) :: verdict
         character(4) :: digits

         film = new_film(canonical_scene(law, 512))
         film%modulus = 1.0e15_dp
         verdict = regime_of(film, [film_of_group(film, alpha_p*critical_at_rest)], [0.0_dp])
         write (digits, '(f4.2)') alpha_p
         call checks%check_close(verdict%alpha_p_maximum, alpha_p, rounding, 'alpha p = '//digits)
         call checks%check(verdict%regime == regime, 'regime at alpha p = '//digits)
         call checks%check(verdict%law_contradicted .eqv. contradicted, 'contradiction at alpha p = '//digits)
         call checks%check(verdict%pressure_exists .eqv. exists, &
            'existence of the pressure at alpha p = '//digits)
         if (law == law_piezo_viscous .and. exists) call checks%check_close( &
            1.0_dp - exp(-film%pressure_viscosity*verdict%pressure_maximum), alpha_p, rounding, &
            'q at alpha p = '//digits)
      end subroutine expect

   end subroutine test_regimes

   !> The Reynolds piezo-viscous film holds for thin oil as well, though not beyond alpha p = 1.
   subroutine test_exact_piezo_viscous(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      real(dp), parameter :: alpha_p(3) = [0.09_dp, 0.11_dp, 1.01_dp]
      integer, parameter :: regimes(3) = [film_iso_viscous, film_piezo_viscous, film_elastohydrodynamic]
      type(scene_t) :: scene
      type(film_t) :: film
      type(regime_verdict_t) :: verdict
      integer :: i

      scene = canonical_scene(law_piezo_viscous, 512)
      scene%film%model = model_reynolds
      film = new_film(scene)
      film%modulus = 1.0e15_dp
      do i = 1, 3
         verdict = regime_of(film, [film_of_group(film, alpha_p(i)*critical_at_rest)], [0.0_dp])
         call checks%check(verdict%regime == regimes(i), 'Reynolds piezo-viscous film: regime')
         call checks%check(verdict%law_contradicted .eqv. alpha_p(i) > 1.0_dp, 'Reynolds piezo-viscous film: contradiction')
      end do
   end subroutine test_exact_piezo_viscous

   !> Soft flanks deflect by more than a tenth of the film long before alpha p = 1.
   subroutine test_deep(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      type(film_t) :: film
      type(regime_verdict_t) :: verdict

      film = new_film(canonical_scene(law_piezo_viscous, 512))
      film%modulus = 1.0e9_dp
      verdict = regime_of(film, [film_of_group(film, 0.5_dp*critical_at_rest)], &
         [0.0_dp])
      call checks%check(verdict%regime == film_elastohydrodynamic .and. verdict%law_contradicted, &
         'soft flanks')
      call checks%check(verdict%pressure_exists, 'soft flanks: q exists')
   end subroutine test_deep

   !> Each sentence has its numbers in the unit that it names.
   subroutine test_sentences(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      call expect(0.05_dp, 2.0e-7_dp, 'alpha p = 0.0500; the flanks deflect by 20 % of the film, limit 10 %')
      call expect(0.05_dp, 0.9e-7_dp, 'alpha p = 0.0500; below 0.1 pressure hardly thickens the oil')
      call expect(0.5_dp, 0.9e-7_dp, 'alpha p = 0.500; from 0.1 on pressure thickens the oil')
      call expect(1.0_dp, 0.9e-7_dp, 'alpha p = 1.00; from 1 on there is no piezo-viscous film of rigid flanks')

   contains

      !> A film of a micrometre.
      subroutine expect(alpha_p, deflection, ending)
         real(dp), intent(in) :: alpha_p     !> Largest alpha p
         real(dp), intent(in) :: deflection  !> Of the flanks [m]
         character(*), intent(in) :: ending  !> Of the sentence

         type(regime_verdict_t) :: verdict
         character(:), allocatable :: sentence

         verdict%alpha_p_maximum = alpha_p
         verdict%deflection = deflection
         verdict%film = 1.0e-6_dp
         sentence = regime_sentence(verdict)
         call checks%check(index(sentence, ending, back=.true.) == len(sentence) - len(ending) + 1, sentence)
      end subroutine expect

   end subroutine test_sentences

   !> The widest film is compared with a tenth of the radius, the thinnest one against 1 nm.
   subroutine test_model_limit(checks)
      type(check_list_t), intent(inout) :: checks
      real(dp), parameter :: radius = 0.01_dp

      call checks%check(model_limit(1.0e-8_dp, 0.9e-3_dp, radius) == within_model, 'films that the model can mean')
      call checks%check(model_limit(1.0e-8_dp, 1.1e-3_dp, radius) == gap_too_wide, 'too wide at its widest alone')
      call checks%check(model_limit(0.9e-9_dp, 0.9e-3_dp, radius) == gap_too_narrow, 'too narrow at its thinnest alone')
      call checks%check(model_limit(0.9e-9_dp, 1.1e-3_dp, radius) == gap_both, 'both')
   end subroutine test_model_limit

end module test_regime_check
