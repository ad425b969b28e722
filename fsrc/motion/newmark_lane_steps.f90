!> Steps of Newmark's method for all lanes of a group at once: extrapolated first iterate, two Newton passes,
!> then the criterion of (36) lane by lane. Lanes that need more passes get them while the others wait,
!> unchanged.
!>
!> A step is cut into loops over the lanes, short enough that the processor works on many lanes at once and
!> never waits for a division, of which a pass has one: load and slopes are numerators over a common denominator. Every lane
!> goes through the same instructions, and no number of one lane enters
!> another.
module newmark_lane_steps
   use film_law, only: kernel_half_pi
   use kinds, only: dp, int64
   use elementary_functions, only: near_exponential, nearness, power_of_two
   use newmark, only: smallest_film_ratio
   use newmark_lane_group, only: newmark_lane_group_t, rest_group_lane
   use piezo_viscous_terms, only: piezo_viscous_terms_fractions
   use published_iso_viscous, only: half_pi_rupture_fractions
   implicit none(type, external)
   private

   public :: advance_lanes

contains

   !> Advance all lanes of a group. A lane whose step fails is marked and rests from then on.
   pure subroutine advance_lanes(group, cosine)
      !> The group
      type(newmark_lane_group_t), intent(inout) :: group
      !> cos(2 pi f_exc t) at the end of every step [-]; its size is the number of steps
      real(dp), intent(in) :: cosine(:)
      integer :: i

      do i = 1, size(cosine)
         if (group%kernel == kernel_half_pi) then
            call begin_half_pi_steps(group)
            call correct_first(group, cosine(i))
            call load_half_pi_again(group)
         else
            call begin_piezo_steps(group)
            call correct_first(group, cosine(i))
            call load_piezo_again(group)
         end if
         call correct_second(group)
         if (unsettled_lanes(group) > 0) call settle_lanes(group)
      end do
   end subroutine advance_lanes

   !> Extrapolated iterate and the load (35) of it.
   pure subroutine begin_half_pi_steps(group)
      type(newmark_lane_group_t), intent(inout) :: group
      real(dp) :: velocity
      integer :: l

      associate (step => group%step)
         !$omp simd private(velocity)
         do l = 1, group%used
            call begin_step(group%film(l), group%velocity(l), group%acceleration(l), step%known_film(l), &
                            step%known_velocity(l), step%smallest(l), step%least(l), velocity)
            call half_pi_rupture_fractions(group%strength(l), group%squeeze(l), max(step%least(l), step%smallest(l)), velocity, &
                                           step%load(l), step%load_by_film(l), step%load_by_velocity(l), step%denominator(l))
         end do
      end associate
   end subroutine begin_half_pi_steps

   !> Extrapolated iterate and the load (37) of it.
   pure subroutine begin_piezo_steps(group)
      type(newmark_lane_group_t), intent(inout) :: group
      real(dp) :: velocity
      integer :: l

      associate (step => group%step)
         !$omp simd private(velocity)
         do l = 1, group%used
            call begin_step(group%film(l), group%velocity(l), group%acceleration(l), step%known_film(l), &
                            step%known_velocity(l), step%smallest(l), step%least(l), velocity)
            step%growth(l) = power_of_two(-group%doubling_rate(l)*velocity)
            call piezo_viscous_terms_fractions(group%strength(l), group%squeeze(l), max(step%least(l), step%smallest(l)), &
                                               step%growth(l), step%load(l), step%load_by_film(l), &
                                               step%load_by_velocity(l), step%denominator(l))
         end do
      end associate
   end subroutine begin_piezo_steps

   !> Known part of Newmark's formulas, and the extrapolated iterate.
   elemental subroutine begin_step(film, velocity, acceleration, known_film, known_velocity, smallest, next_film, &
                                   next_velocity)
      !> State h, V, A [m]
      real(dp), intent(in) :: film
      real(dp), intent(in) :: velocity
      real(dp), intent(in) :: acceleration
      !> h and V at the end of the step were A zero there [m]
      real(dp), intent(out) :: known_film
      real(dp), intent(out) :: known_velocity
      !> Film that fails [m]
      real(dp), intent(out) :: smallest
      !> h and V at its end with A as before [m]
      real(dp), intent(out) :: next_film
      real(dp), intent(out) :: next_velocity

      known_film = film + velocity + acceleration
      known_velocity = velocity + 2.0_dp*acceleration
      smallest = smallest_film_ratio*film
      next_film = known_film + acceleration
      next_velocity = known_velocity + 2.0_dp*acceleration
   end subroutine begin_step

   !> First Newton pass.
   pure subroutine correct_first(group, cosine)
      type(newmark_lane_group_t), intent(inout) :: group
      !> cos(2 pi f_exc t) at the end of the step [-]
      real(dp), intent(in) :: cosine
      real(dp) :: a, film
      integer :: l

      associate (step => group%step)
         !$omp simd private(a, film)
         do l = 1, group%used
            step%force(l) = group%mean_force(l) + group%force_amplitude(l)*cosine
            a = corrected(group%acceleration(l), step%load(l), step%load_by_film(l), &
               step%load_by_velocity(l), step%denominator(l), step%force(l))
            film = step%known_film(l) + a
            step%acceleration(l) = a
            step%least(l) = min(film, step%least(l))
            step%film(l) = max(film, step%smallest(l))
         end do
      end associate
   end subroutine correct_first

   !> Load (35) after the first pass.
   pure subroutine load_half_pi_again(group)
      type(newmark_lane_group_t), intent(inout) :: group
      integer :: l

      associate (step => group%step)
         !$omp simd
         do l = 1, group%used
            step%margin(l) = 1.0_dp
            call half_pi_rupture_fractions(group%strength(l), group%squeeze(l), step%film(l), &
                                           step%known_velocity(l) + 2.0_dp*step%acceleration(l), step%load(l), &
                                           step%load_by_film(l), step%load_by_velocity(l), step%denominator(l))
         end do
      end associate
   end subroutine load_half_pi_again

   !> Load (37) after the first pass. The exponent has hardly changed; where it has, the step is not settled.
   pure subroutine load_piezo_again(group)
      type(newmark_lane_group_t), intent(inout) :: group
      real(dp) :: change
      integer :: l

      associate (step => group%step)
         !$omp simd private(change)
         do l = 1, group%used
            change = 2.0_dp*group%squeeze(l)*(group%acceleration(l) - step%acceleration(l))
            step%margin(l) = nearness - abs(change)
            call piezo_viscous_terms_fractions(group%strength(l), group%squeeze(l), step%film(l), &
                                               step%growth(l)*near_exponential(change), step%load(l), &
                                               step%load_by_film(l), step%load_by_velocity(l), step%denominator(l))
         end do
      end associate
   end subroutine load_piezo_again

   !> Second Newton pass: its iterate becomes the state of the group.
   pure subroutine correct_second(group)
      type(newmark_lane_group_t), intent(inout) :: group
      real(dp) :: a, film
      integer :: l

      associate (step => group%step)
         !$omp simd private(a, film)
         do l = 1, group%used
            a = corrected(step%acceleration(l), step%load(l), step%load_by_film(l), &
               step%load_by_velocity(l), step%denominator(l), step%force(l))
            film = step%known_film(l) + a
            step%margin(l) = min(step%margin(l), group%tolerance(l) - abs(film - step%film(l)), &
               group%largest_load(l)*step%denominator(l) - step%load(l), min(film, step%least(l)) - step%smallest(l))
            group%film(l) = film
            group%velocity(l) = step%known_velocity(l) + 2.0_dp*a
            group%acceleration(l) = a
         end do
      end associate
   end subroutine correct_second

   !> Number of lanes that do not meet the criterion.
   pure integer(int64) function unsettled_lanes(group)
      type(newmark_lane_group_t), intent(in) :: group
      integer :: l

      unsettled_lanes = 0_int64
      do l = 1, group%used
         unsettled_lanes = unsettled_lanes + merge(0_int64, 1_int64, group%step%margin(l) > 0.0_dp)
      end do
   end function unsettled_lanes

   !> Further passes for the lanes that need them.
   pure subroutine settle_lanes(group)
      type(newmark_lane_group_t), intent(inout) :: group
      real(dp) :: a, film
      integer :: l, pass

      associate (step => group%step)
         pass = 2
         do
            do l = 1, group%used
               if (step%margin(l) > 0.0_dp) cycle
               step%least(l) = min(group%film(l), step%least(l))
               if (step%least(l) > step%smallest(l) .and. pass < group%pass_limit(l)) cycle
               group%failed(l) = .true.
               step%margin(l) = 1.0_dp
               call rest_group_lane(group, l)
            end do
            if (unsettled_lanes(group) == 0) return
            pass = pass + 1
            call load_states(group)
            do l = 1, group%used
               if (step%margin(l) > 0.0_dp) cycle
               a = corrected(group%acceleration(l), step%load(l), step%load_by_film(l), &
                             step%load_by_velocity(l), step%denominator(l), step%force(l))
               film = step%known_film(l) + a
               step%margin(l) = min(group%tolerance(l) - abs(film - group%film(l)), &
                  group%largest_load(l)*step%denominator(l) - step%load(l), min(film, step%least(l)) - step%smallest(l))
               group%film(l) = film
               group%velocity(l) = step%known_velocity(l) + 2.0_dp*a
               group%acceleration(l) = a
               group%further_passes(l) = group%further_passes(l) + 1_int64
            end do
         end do
      end associate
   end subroutine settle_lanes

   !> Loads and slopes at the states of all lanes, of which none has failed.
   pure subroutine load_states(group)
      type(newmark_lane_group_t), intent(inout) :: group
      integer :: l

      associate (step => group%step)
         if (group%kernel == kernel_half_pi) then
            !$omp simd
            do l = 1, group%used
               call half_pi_rupture_fractions(group%strength(l), group%squeeze(l), group%film(l), group%velocity(l), &
                                              step%load(l), step%load_by_film(l), step%load_by_velocity(l), &
                                              step%denominator(l))
            end do
         else
            !$omp simd
            do l = 1, group%used
               call piezo_viscous_terms_fractions(group%strength(l), group%squeeze(l), group%film(l), &
                                                  power_of_two(-group%doubling_rate(l)*group%velocity(l)), &
                                                  step%load(l), step%load_by_film(l), step%load_by_velocity(l), &
                                                  step%denominator(l))
            end do
         end if
      end associate
   end subroutine load_states

   !> A after a Newton pass: L + dL/dh dA + 2 dL/dV dA - F = A + dA, solved for A + dA.
   elemental real(dp) function corrected(acceleration, load, load_by_film, load_by_velocity, denominator, force)
      !> A before it [m]
      real(dp), intent(in) :: acceleration
      !> L [m] and its slopes dL/dh [-] and dL/dV [-] at the iterate, over a common denominator
      real(dp), intent(in) :: load
      real(dp), intent(in) :: load_by_film
      real(dp), intent(in) :: load_by_velocity
      real(dp), intent(in) :: denominator
      !> Force [m]
      real(dp), intent(in) :: force

      corrected = acceleration + (load - (force + acceleration)*denominator)/ &
         ((denominator - load_by_film) - 2.0_dp*load_by_velocity)
   end function corrected

end module newmark_lane_steps
