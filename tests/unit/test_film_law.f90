!> Tests of the film of a scene: coefficients, choice of the kernel, steady film.
module test_film_law
   use canonical_scenes, only: canonical_scene, static_load
   use checks, only: check_list_t, same_bits
   use film_law, only: film_load, film_loads, film_t, kernel_half_pi, kernel_of, kernel_piezo, kernel_solved_fast, &
      kernel_solved_successive, law_words, mixed_film_loads, new_film, overflow_load, steady_film
   use kinds, only: dp
   use published_iso_viscous, only: half_pi_rupture_load, solved_rupture_load
   use published_piezo_viscous, only: published_piezo_viscous_load
   use reynolds_iso_viscous, only: rupture_tangent_fast
   use rupture, only: rupture_tangent_successive, squeeze_group
   use scene_types, only: law_iso_viscous, law_piezo_viscous, model_reynolds, rupture_half_pi, rupture_solved, &
      rupture_solver_fast, &
      rupture_solver_successive, scene_t
   implicit none(type, external)
   private

   public :: run_film_law_tests

contains

   !> Runs every test of this topic.
   subroutine run_film_law_tests(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      call checks%start('film_law')
      call test_kernels(checks)
      call test_alone(checks)
      call test_steady_film(checks)
      call test_contact(checks)
      call test_linearised(checks)
      call test_unknown_law(checks)
   end subroutine run_film_law_tests

   !> Law, rupture and solver of the scene choose the kernel, and film_load calls it: it gives the load of the law's own file.
   subroutine test_kernels(checks)
      type(check_list_t), intent(inout) :: checks

      real(dp), parameter :: h = 5.0e-7_dp, w = 1.0e-3_dp
      type(scene_t) :: scene
      type(film_t) :: film
      real(dp) :: a, expected(3)

      scene = canonical_scene(law_iso_viscous, 512)
      scene%film%rupture = rupture_half_pi
      scene%film%rupture_solver = rupture_solver_successive
      film = new_film(scene)
      call half_pi_rupture_load(film%rolling, film%squeeze, h, w, expected(1), expected(2), expected(3))
      call same_load(kernel_half_pi, 'half-pi')

      scene%film%rupture = rupture_solved
      film = new_film(scene)
      a = squeeze_group(film%radius, film%speed, h, w)
      call solved_rupture_load(film%rolling, film%squeeze, h, w, a, rupture_tangent_successive(a), expected(1), expected(2), &
                               expected(3))
      call same_load(kernel_solved_successive, 'solved, successive')

      scene%film%rupture_solver = rupture_solver_fast
      film = new_film(scene)
      call solved_rupture_load(film%rolling, film%squeeze, h, w, a, rupture_tangent_fast(a), expected(1), expected(2), expected(3))
      call same_load(kernel_solved_fast, 'solved, fast')

      scene%film%law = law_piezo_viscous
      film = new_film(scene)
      call published_piezo_viscous_load(film%piezo, film%rate, h, w, expected(1), expected(2), expected(3))
      call same_load(kernel_piezo, 'piezo-viscous')

   contains

      !> The film has this kernel, and film_load gives what is expected.
      subroutine same_load(kernel, law)
         integer, intent(in) :: kernel
         character(*), intent(in) :: law
         real(dp) :: loads(3)

         call checks%check(film%kernel == kernel, 'kernel: '//law)
         call film_load(film, h, w, loads(1), loads(2), loads(3))
         call checks%check(maxval(abs(loads/expected - 1.0_dp)) < 16.0_dp*epsilon(1.0_dp), 'film_load: '//law)
      end subroutine same_load

   end subroutine test_kernels

   !> The steady film carries the load, and is the known one for the canonical scenes.
   subroutine test_steady_film(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      !> The known films have 13 digits.
      real(dp), parameter :: known(2) = [8.889224234368e-07_dp, 1.000449736566e-06_dp]
      character(13), parameter :: names(2) = ['iso-viscous  ', 'piezo-viscous']
      type(film_t) :: film
      real(dp) :: thickness, load, slope_h, slope_w
      integer :: law

      do law = 1, 2
         film = new_film(canonical_scene(law, 512))
         thickness = steady_film(film, static_load)
         call checks%check_close(thickness/known(law), 1.0_dp, 1.0e-12_dp, &
            'canonical steady film, '//names(law))
         call film_load(film, thickness, 0.0_dp, load, slope_h, slope_w)
         call checks%check_close(load/static_load, 1.0_dp, 32.0_dp*epsilon(1.0_dp), &
            'steady film carries its load, '//names(law))
      end do
   end subroutine test_steady_film

   !> Two flank radii in place of one; E* of steel.
   subroutine test_contact(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      type(scene_t) :: scene
      type(film_t) :: film

      scene = canonical_scene(law_iso_viscous, 512)
      film = new_film(scene)
      call checks%check_close(film%radius, 0.0127_dp, 0.0_dp, 'radius as given')
      call checks%check_close(film%modulus/226.0e9_dp, 1.0_dp, 8.0_dp*epsilon(1.0_dp), 'plane-strain modulus')
      scene%contact%radius = 0.0_dp
      scene%contact%radius_1 = 0.03_dp
      scene%contact%radius_2 = 0.06_dp
      film = new_film(scene)
      call checks%check_close(film%radius, 0.02_dp, 0.02_dp*4.0_dp*epsilon(1.0_dp), 'radius of two flanks')
   end subroutine test_contact

   !> The load of a state has the same bits in any place of any number of states; alone it may come by another exponential.
   subroutine test_alone(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      ! No whole number of registers
      integer, parameter :: states = 67
      type(scene_t) :: scenes(5)
      type(film_t) :: film
      real(dp), dimension(states) :: thicknesses, velocities, loads, fewer, alone
      real(dp) :: load, by_film, by_velocity
      integer :: i, j

      scenes = canonical_scene(law_iso_viscous, 512)
      scenes(2)%film%rupture = rupture_solved
      scenes(3)%film%law = law_piezo_viscous
      scenes(4:)%film%model = model_reynolds
      scenes(5)%film%law = law_piezo_viscous
      scenes(5)%lubricant%pressure_viscosity = 1.0e-9_dp
      thicknesses = [(5.0e-7_dp*(1.0_dp + 0.03_dp*real(i, dp)), i=1, states)]
      velocities = [(1.0e-3_dp*sin(real(i, dp)), i=1, states)]
      do j = 1, size(scenes)
         film = new_film(scenes(j))
         call film_loads(film, thicknesses, velocities, loads)
         call film_loads(film, thicknesses(2:), velocities(2:), fewer(2:))
         do i = 1, states
            call film_load(film, thicknesses(i), velocities(i), load, by_film, by_velocity)
            alone(i) = load
         end do
         call checks%check(all(same_bits(loads(2:), fewer(2:))), 'the same bits in another place')
         call checks%check_close(maxval(abs(loads/alone - 1.0_dp)), 0.0_dp, 8.0_dp*epsilon(1.0_dp), 'the same alone')
      end do
   end subroutine test_alone

   !> Natural frequency and damping ratio of the canonical films, known to five and four digits.
   subroutine test_linearised(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      real(dp), parameter :: frequencies(2) = [1473.6_dp, 2598.7_dp], ratios(2) = [0.6146_dp, 0.8612_dp]
      real(dp), parameter :: mass = 3.0_dp, two_pi = 8.0_dp*atan(1.0_dp)
      type(film_t) :: film
      real(dp) :: load, slope_h, slope_w
      integer :: law

      do law = 1, 2
         film = new_film(canonical_scene(law, 512))
         call film_load(film, steady_film(film, static_load), 0.0_dp, load, slope_h, slope_w)
         call checks%check_close(sqrt(-slope_h/mass)/two_pi, frequencies(law), 0.05_dp, 'natural frequency')
         call checks%check_close(-slope_w/(2.0_dp*sqrt(-slope_h*mass)), ratios(law), 0.00005_dp, &
            'damping ratio')
      end do
   end subroutine test_linearised

   !> A law that no one knows is refused by every choice, never taken for another one.
   subroutine test_unknown_law(checks)
      type(check_list_t), intent(inout) :: checks  !> Collects the results

      integer, parameter :: unknown = 99
      type(scene_t) :: scenes(4)
      type(film_t) :: film
      real(dp) :: load, by_film, by_velocity, loads(2), loads_by_film(2), loads_by_velocity(2)
      integer :: i

      scenes = canonical_scene(law_iso_viscous, 512)
      scenes(1)%film%law = unknown
      scenes(2)%film%model = unknown
      scenes(3)%film%rupture = unknown
      scenes(4)%film%rupture = rupture_solved
      scenes(4)%film%rupture_solver = unknown
      do i = 1, size(scenes)
         film = new_film(scenes(i))
         call checks%check(film%kernel == 0 .and. law_words(scenes(i)%film) == 'unknown film law', 'unknown law: choice')
         if (i == size(scenes)) film%kernel = unknown
         call checks%check(.not. associated(kernel_of(film)), 'unknown law: kernel')
         call film_load(film, 1.0e-6_dp, 0.0_dp, load, by_film, by_velocity)
         call checks%check(.not. load < overflow_load, 'unknown law: load')
         call film_loads(film, [1.0e-6_dp, 2.0e-6_dp], [0.0_dp, 0.0_dp], loads)
         call checks%check(.not. any(loads < overflow_load), 'unknown law: loads')
         call mixed_film_loads([film], [1, 1], [1.0e-6_dp, 2.0e-6_dp], [0.0_dp, 0.0_dp], loads, loads_by_film, loads_by_velocity)
         call checks%check(.not. any(loads < overflow_load), 'unknown law: loads of several films')
         call checks%check(.not. steady_film(film, static_load) > 0.0_dp, 'unknown law: steady film')
      end do
   end subroutine test_unknown_law

end module test_film_law
