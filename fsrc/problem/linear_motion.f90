!> Small motions about the rest. With the stiffness K and damping C of each film, and springs k in series with them, they are
!> those of
!>
!>     m s^2 + S(s) = 0 ,      S(s) = sum over the films of k (K + C s)/(k + K + C s) ,
!>
!> for one film m C s^3 + m (k + K) s^2 + k C s + k K = 0; between rigid teeth S(s) = K + C s. A damped tooth has k + c s in place
!> of k; where it flattens or bends beside its damping, the c of slow motions. Of films with a state of their own K
!> and C are those of motions so slow that the state follows. Of flanks that bend each has a k of its own, and K and C are over the
!> share of a film's motion that is left to the gear.
module linear_motion
   use constants, only: two_pi
   use film_state, only: load_t
   use flank_contact, only: load_at_rest, compliance_at_rest
   use kinds, only: dp
   use problem, only: contact_count, has_damped_teeth, has_elastic_teeth, problem_t
   implicit none(type, external)
   private

   public :: natural_motion

contains

   !> Natural frequency |s|/(2 pi) and damping ratio -Re s/|s| of the pair of roots that oscillates; both 0 where none does.
   pure subroutine natural_motion(problem, films, natural_frequency, damping_ratio)
      type(problem_t), intent(in) :: problem
      !> Films of drive and coast flank at rest [m]
      real(dp), intent(in) :: films(2)
      !> [Hz]
      real(dp), intent(out) :: natural_frequency
      !> [-]
      real(dp), intent(out) :: damping_ratio
      type(load_t) :: load
      real(dp) :: stiffness(2), damping(2), spring(2), loss(2), share, compliance, twice_decay, square
      integer :: flanks, flank
      integer, allocatable :: order(:)

      flanks = contact_count(problem)
      loss = 0.0_dp
      do flank = 1, flanks
         load = load_at_rest(problem%contact, films(flank), 0.0_dp)
         call compliance_at_rest(problem%contact, films(flank), load%load, share, compliance)
         stiffness(flank) = -load%by_film/share
         damping(flank) = -load%by_velocity/share
         if (has_elastic_teeth(problem)) spring(flank) = 1.0_dp/compliance
         if (has_damped_teeth(problem)) loss(flank) = problem%contact%retardation*problem%contact%damped_share* &
                                                      problem%contact%compliance*spring(flank)**2
      end do
      if (has_elastic_teeth(problem)) then
         order = [(flank, flank=1, flanks)]
         if ((spring(1) + stiffness(1))/(loss(1) + damping(1)) > &
             (spring(flanks) + stiffness(flanks))/(loss(flanks) + damping(flanks))) order = [2, 1]
         call pair_on_springs(problem%mass, spring(order), loss(order), stiffness(order), damping(order), twice_decay, square)
      else
         twice_decay = sum(damping(:flanks))/problem%mass
         square = sum(stiffness(:flanks))/problem%mass
      end if
      natural_frequency = 0.0_dp
      damping_ratio = 0.0_dp
      if (.not. twice_decay < 2.0_dp*sqrt(square)) return
      natural_frequency = sqrt(square)/two_pi
      damping_ratio = 0.5_dp*twice_decay/sqrt(square)
   end subroutine natural_motion

   !> Sum and product of the last two roots of films on springs, s^2 + twice_decay s + square = 0. The others are real: S rises
   !> from minus to plus infinity between its poles, and from minus infinity to a positive value between the last pole and 0, so
   !> that a root lies to the right of each pole. Taken out, these leave the last two (Vieta). Nothing is lost where the films
   !> differ by many powers of ten; the eigenvalues of a matrix would lose the smaller film.
   pure subroutine pair_on_springs(mass, spring, loss, stiffness, damping, twice_decay, square)
      !> [kg]
      real(dp), intent(in) :: mass
      !> Stiffness of the tooth at each film k [N/m]
      real(dp), intent(in) :: spring(:)
      !> and its damping c [N s/m]
      real(dp), intent(in) :: loss(:)
      !> K [N/m] and C [N s/m] of each film, the one with the smaller (k + K)/(c + C) first
      real(dp), intent(in) :: stiffness(:)
      real(dp), intent(in) :: damping(:)
      !> [1/s]
      real(dp), intent(out) :: twice_decay
      !> [1/s2]
      real(dp), intent(out) :: square
      !> Logarithms between which the ratio of the ways from root to pole and to the next pole lies
      real(dp), parameter :: least = -250.0_dp, most = 250.0_dp
      real(dp), dimension(size(damping)) :: poles, from_poles
      real(dp) :: next_pole, way, rest, root, low, high, middle
      integer :: own

      ! Poles and roots are counted without their sign.
      poles = (spring + stiffness)/(loss + damping)
      twice_decay = sum(loss*damping/(loss + damping))/mass
      square = sum(1.0_dp/(1.0_dp/spring + 1.0_dp/stiffness))/mass
      next_pole = 0.0_dp
      do own = 1, size(poles)
         way = poles(own) - next_pole
         low = least
         high = most
         ! Of two equal poles one is a root, too.
         root = poles(own)
         from_poles = 0.0_dp
         do while (way > 0.0_dp)
            middle = 0.5_dp*(low + high)
            rest = way/(1.0_dp + exp(middle))
            root = next_pole + rest
            from_poles(:own - 1) = poles(:own - 1) - next_pole - rest
            from_poles(own:) = poles(own:) - poles(own) + way/(1.0_dp + exp(-middle))
            if (.not. (middle > low .and. middle < high)) exit
            if (mass*root*root + sum((spring - loss*root)*(stiffness - damping*root)/((loss + damping)*from_poles)) < 0.0_dp) then
               low = middle
            else
               high = middle
            end if
         end do
         twice_decay = twice_decay + from_poles(own)
         square = square*poles(own)/root
         next_pole = poles(own)
      end do
   end subroutine pair_on_springs

end module linear_motion
