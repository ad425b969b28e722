!> How severe a vibration is: what its acceleration and the force of its film amount to over the window, and what the film takes
!> from it.
!>
!> Work is that of what the film carries beyond the static load, which does no work in a motion that repeats:
!>
!>     dissipated energy = - integral of (W - Q - m g) dh,      in a periodic motion the work - integral of (F - Q) dh of the force
module vibration_severity
   use force, only: force_of_period
   use kinds, only: dp
   use problem, only: problem_t
   use window_record, only: sum_beyond, sum_of_power, sum_of_powers, sums_of_record, window_record_t
   implicit none(type, external)
   private

   !> Vibration severity of a window.
   type, public :: vibration_severity_t
      !> Root of the mean square of z'' [m/s2]
      real(dp) :: acceleration_rms = 0.0_dp
      !> Fourth central moment of z'' over the square of the second [-], 0 where z'' stands still
      real(dp) :: acceleration_kurtosis = 0.0_dp
      !> Root of the mean square by which the film force leaves its mean [N]
      real(dp) :: film_force_rms = 0.0_dp
      !> What films and teeth take from the motion, a period of the force, and the part of damped teeth [J]
      real(dp) :: dissipated_energy = 0.0_dp
      real(dp) :: tooth_energy = 0.0_dp
   end type vibration_severity_t

   public :: severity_of_record, severity_of_sums, severity_of_samples, severity_numbers

contains

   !> Vibration severity that the steps of the engine show.
   pure type(vibration_severity_t) function severity_of_record(record, frequency) result(severity)
      !> A record of one or more periods
      type(window_record_t), intent(in) :: record
      !> Frequency of the force [Hz]
      real(dp), intent(in) :: frequency

      severity = severity_of_sums(sums_of_record(record), record%periods, frequency)
      severity%tooth_energy = record%tooth_loss/real(record%periods, dp)
   end function severity_of_record

   !> Vibration severity of sums over some periods.
   pure type(vibration_severity_t) function severity_of_sums(sums, periods, frequency) result(severity)
      !> By the places of module window_record
      real(dp), intent(in) :: sums(:)
      integer, intent(in) :: periods
      !> Frequency of the force [Hz]
      real(dp), intent(in) :: frequency

      associate (means => sums/real(periods, dp))
         severity = severity_of_means(means(sum_of_powers:sum_of_powers + 3), means(sum_beyond:sum_beyond + 1), &
                                      means(sum_of_power)/frequency)
      end associate
   end function severity_of_sums

   !> Vibration severity of samples of whole periods.
   pure type(vibration_severity_t) function severity_of_samples(problem, samples_per_period, velocities, &
      accelerations) result(severity)
      !> What moves
      type(problem_t), intent(in) :: problem
      integer, intent(in) :: samples_per_period
      !> z' [m/s] and z'' [m/s2], from the first sample of a period on
      real(dp), intent(in) :: velocities(:)
      real(dp), intent(in) :: accelerations(:)
      real(dp) :: powers(4), beyond(2), power, load, force(samples_per_period)
      integer :: i

      call force_of_period(problem%force, force)
      powers = 0.0_dp
      beyond = 0.0_dp
      power = 0.0_dp
      do i = 1, size(accelerations)
         load = problem%mass*accelerations(i) + (force(modulo(i - 1, samples_per_period) + 1) - problem%force%steady)
         powers = powers + accelerations(i)**[1, 2, 3, 4]
         beyond = beyond + load**[1, 2]
         power = power + load*velocities(i)
      end do
      associate (samples => real(size(accelerations), dp))
         severity = severity_of_means(powers/samples, beyond/samples, power/(samples*problem%frequency))
      end associate
   end function severity_of_samples

   !> The numbers whose errors are reported, in the order of the type.
   pure function severity_numbers(severity) result(numbers)
      type(vibration_severity_t), intent(in) :: severity
      real(dp) :: numbers(4)

      numbers = [severity%acceleration_rms, severity%acceleration_kurtosis, severity%film_force_rms, severity%dissipated_energy]
   end function severity_numbers

   !> Vibration severity from means over the window.
   pure type(vibration_severity_t) function severity_of_means(powers, beyond, work) result(severity)
      !> Of z'' and its powers
      real(dp), intent(in) :: powers(4)
      !> Of what the film carries beyond the static load, and of its square [N], [N2]
      real(dp), intent(in) :: beyond(2)
      !> Work of it, a period of the force [J]
      real(dp), intent(in) :: work
      real(dp) :: variance

      severity%acceleration_rms = sqrt(powers(2))
      variance = powers(2) - powers(1)**2
      if (variance > 0.0_dp) severity%acceleration_kurtosis = &
         (powers(4) - 4.0_dp*powers(1)*powers(3) + 6.0_dp*powers(1)**2*powers(2) - 3.0_dp*powers(1)**4)/variance**2
      severity%film_force_rms = sqrt(max(0.0_dp, beyond(2) - beyond(1)**2))
      severity%dissipated_energy = -work
   end function severity_of_means

end module vibration_severity
