!> The force on the loose gear, F = Q + sum of a_n cos(2 pi n x + phi_n), where x = f_exc t counts time in periods; (34) is the
!> case of one order without phase.
!>
!> All that a force is stands here and, scaled for the lanes of a block, in module lane_force. A phase stands on
!> the unit circle at exp(2 pi i x), from whose powers every harmonic of a force follows.
module force
   use, intrinsic :: ieee_arithmetic, only: ieee_quiet_nan, ieee_value
   use elementary_functions, only: cosine_sine
   use kinds, only: dp
   use scene_types, only: excitation_t
   implicit none(type, external)
   private

   !> A force that repeats.
   type, public :: force_t
      !> Steady part: Q, with the mean of the force [N]
      real(dp) :: steady = 0.0_dp
      !> Order n of the last harmonic
      integer :: highest = 1
      !> a_n cos(phi_n) and -a_n sin(phi_n): factors of cos(2 pi n x) and sin(2 pi n x), of the first order, and of the others
      !> (both, n) from the second to the highest if there are any [N]
      real(dp) :: cosine = 0.0_dp, sine = 0.0_dp
      real(dp), allocatable :: others(:, :)
   end type force_t

   public :: cosine_force, force_of, force_at, forces_on_circle, force_of_period, inertia_ratio, &
             largest_oscillation, largest_size

contains

   !> The force (34).
   pure type(force_t) function cosine_force(steady, amplitude) result(force)
      !> Q and F0 [N]
      real(dp), intent(in) :: steady
      real(dp), intent(in) :: amplitude

      force%steady = steady
      force%cosine = amplitude
   end function cosine_force

   !> The force of a scene.
   pure type(force_t) function force_of(excitation) result(force)
      !> Group &load of the scene
      type(excitation_t), intent(in) :: excitation
      integer :: k

      force%steady = excitation%steady_force + excitation%force_mean
      if (.not. allocated(excitation%force_orders)) then
         force = cosine_force(force%steady, excitation%force_scale*excitation%force_amplitude)
         return
      end if
      force%highest = maxval(excitation%force_orders)
      if (force%highest > 1) allocate (force%others(2, 2:force%highest), source=0.0_dp)
      do k = 1, size(excitation%force_orders)
         associate (n => excitation%force_orders(k), a => excitation%force_scale*excitation%force_amplitudes(k), &
                    phi => excitation%force_phases(k))
            if (n == 1) then
               force%cosine = a*cos(phi)
               force%sine = -a*sin(phi)
            else
               force%others(:, n) = [a*cos(phi), -a*sin(phi)]
            end if
         end associate
      end do
   end function force_of

   !> Force at a phase [N].
   elemental real(dp) function force_at(force, phase)
      !> The force
      type(force_t), intent(in) :: force
      !> From 0 to 1 [periods]
      real(dp), intent(in) :: phase
      real(dp) :: cosine(1), sine(1), values(1)

      call cosine_sine(phase, cosine(1), sine(1))
      call forces_on_circle(force, cosine, sine, values)
      force_at = values(1)
   end function force_at

   !> Force where phases stand on the unit circle [N].
   pure subroutine forces_on_circle(force, cosine, sine, values)
      !> The force
      type(force_t), intent(in) :: force
      !> Of 2 pi x
      real(dp), intent(in) :: cosine(:)
      real(dp), intent(in) :: sine(:)
      !> Of the size of the phases
      real(dp), intent(out) :: values(:)
      real(dp) :: c(size(cosine)), s(size(cosine)), next
      integer :: n, i

      !$omp simd
      do i = 1, size(cosine)
         values(i) = force%steady + force%cosine*cosine(i) + force%sine*sine(i)
      end do
      if (force%highest < 2) return
      c = cosine
      s = sine
      do n = 2, force%highest
         !$omp simd private(next)
         do i = 1, size(cosine)
            next = c(i)*cosine(i) - s(i)*sine(i)
            s(i) = s(i)*cosine(i) + c(i)*sine(i)
            c(i) = next
            values(i) = values(i) + force%others(1, n)*c(i) + force%others(2, n)*s(i)
         end do
      end do
   end subroutine forces_on_circle

   !> Force at the end of every step of a period; it repeats from period to period to the last bit.
   pure subroutine force_of_period(force, values)
      !> The force
      type(force_t), intent(in) :: force
      !> At phases 1/n, 2/n, ... 1 [N]
      real(dp), intent(out) :: values(:)
      integer, parameter :: together = 256
      real(dp) :: cosine(together), sine(together)
      integer :: before, n, i

      do before = 0, size(values) - 1, together
         n = min(together, size(values) - before)
         do i = 1, n
            call cosine_sine(real(before + i, dp)/real(size(values), dp), cosine(i), sine(i))
         end do
         call forces_on_circle(force, cosine(:n), sine(:n), values(before + 1:before + n))
      end do
   end subroutine force_of_period

   !> Bound of the part that oscillates [N].
   elemental real(dp) function largest_oscillation(force)
      !> The force
      type(force_t), intent(in) :: force
      integer :: n

      largest_oscillation = hypot(force%cosine, force%sine)
      do n = 2, force%highest
         largest_oscillation = largest_oscillation + hypot(force%others(1, n), force%others(2, n))
      end do
   end function largest_oscillation

   !> Largest size of a force and a steady one beside it [N].
   pure real(dp) function largest_size(force, beside)
      !> The force
      type(force_t), intent(in) :: force
      !> [N]
      real(dp), intent(in) :: beside

      largest_size = largest_value(force, beside, [1.0_dp, -1.0_dp])
   end function largest_size

   !> Lambda of a loose gear: the largest force with which its inertia pulls the tooth off the flank where the drag holds it, over
   !> the steady force, J_2 (z_1/z_2) max(-theta_1'')/T_d. Not a number without a steady force.
   pure real(dp) function inertia_ratio(force)
      !> The force on a loose gear: its steady part is that of the drag, what oscillates that of the shaft
      type(force_t), intent(in) :: force

      inertia_ratio = ieee_value(inertia_ratio, ieee_quiet_nan)
      if (abs(force%steady) > 0.0_dp) inertia_ratio = &
         largest_value(force, -force%steady, spread(-sign(1.0_dp, force%steady), 1, 2))/abs(force%steady)
   end function inertia_ratio

   !> Largest of a force and a steady one beside it times one of two signs [N]: of its size, its rise or its fall. Several orders
   !> are looked at in 16 places to the period of the highest one; what may be larger between two of them than all others is
   !> followed to where it is largest.
   pure real(dp) function largest_value(force, beside, signs)
      !> The force
      type(force_t), intent(in) :: force
      !> [N]
      real(dp), intent(in) :: beside
      real(dp), intent(in) :: signs(2)
      integer, parameter :: places_per_wave = 16
      !> Share of the oscillation by which a wave may rise above the nearest of the places: (pi/16)**2/2
      real(dp), parameter :: between = 0.02_dp
      real(dp), allocatable :: sizes(:)
      real(dp) :: top
      integer :: n, i

      largest_value = maxval(signs*(force%steady + beside)) + hypot(force%cosine, force%sine)
      if (force%highest < 2) return
      n = places_per_wave*force%highest
      allocate (sizes(n))
      call force_of_period(force, sizes)
      sizes = max(signs(1)*(sizes + beside), signs(2)*(sizes + beside))
      top = maxval(sizes)
      largest_value = top
      do i = 1, n
         if (sizes(i) + between*largest_oscillation(force) < top) cycle
         if (sizes(i) < max(sizes(modulo(i - 2, n) + 1), sizes(modulo(i, n) + 1))) cycle
         largest_value = max(largest_value, largest_near(real(i, dp)/real(n, dp), 1.0_dp/real(n, dp)))
      end do

   contains

      !> Largest value between two phases that stand as far on both sides of one, by the golden section.
      pure real(dp) function largest_near(phase, distance)
         real(dp), intent(in) :: phase
         real(dp), intent(in) :: distance
         real(dp), parameter :: section = 0.6180339887498949_dp
         !> After these what is left is 1e-9 of the wave, its height off by less than rounding.
         integer, parameter :: iterations = 42
         real(dp) :: ends(2), inner(2), values(2)
         integer :: iteration, k

         ends = phase + [-distance, distance]
         inner = [ends(2) - section*(ends(2) - ends(1)), ends(1) + section*(ends(2) - ends(1))]
         values = [(size_at(inner(k)), k=1, 2)]
         do iteration = 1, iterations
            if (values(1) >= values(2)) then
               ends(2) = inner(2)
               inner = [ends(2) - section*(ends(2) - ends(1)), inner(1)]
               values = [size_at(inner(1)), values(1)]
            else
               ends(1) = inner(1)
               inner = [inner(2), ends(1) + section*(ends(2) - ends(1))]
               values = [values(2), size_at(inner(2))]
            end if
         end do
         largest_near = maxval(values)
      end function largest_near

      !> Value at a phase [N].
      pure real(dp) function size_at(phase)
         real(dp), intent(in) :: phase

         size_at = maxval(signs*(force_at(force, modulo(phase, 1.0_dp)) + beside))
      end function size_at

   end function largest_value

end module force
