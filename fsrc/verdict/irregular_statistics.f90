!> What an irregular motion amounts to over the periods that it was followed, and how far that can be trusted: standard errors by
!> batch means (fsrc/THEORY.md, section 11).
!>
!> The periods are parted into batches, so long that one is not correlated with the next. Leaving each batch out in turn
!> shows by how much any number of all of them is off (jackknife), also one that is no mean itself, such as a root or a ratio.
module irregular_statistics
   use kinds, only: dp
   use lyapunov, only: path_t
   use problem, only: most_contacts
   use vibration_severity, only: severity_of_sums, vibration_severity_t
   use window_record, only: sum_of_impacts, sum_of_impulses, sum_of_squares
   implicit none(type, external)
   private

   !> Places of numbers_of: rms of z'' and of the film force, kurtosis of z'', energy that the film takes; of each contact impacts a
   !> period and their mean impulse; harmonics by their mean power, in units of velocity.
   integer, parameter :: of_rms = 1, of_force = 2, of_kurtosis = 3, of_energy = 4, of_impacts = 5, &
                         of_impulses = of_impacts + most_contacts, of_harmonics = of_impulses + most_contacts
   !> Batches at least, so that they show an error, and correlation of a batch with the next one from which on they are longer [-].
   integer, parameter :: least_batches = 10
   real(dp), parameter :: correlated = 0.1_dp
   !> Standard errors by which both halves may differ, in units of their own.
   real(dp), parameter :: errors_apart = 3.0_dp
   !> Share of the rms of z'' and of the film force that their standard errors are wanted to be [-].
   real(dp), parameter :: wanted_share = 0.03_dp

   !> Standard errors of an irregular motion.
   type, public :: irregular_statistics_t
      !> Periods that it was followed, 0: it is none, and those of a batch
      integer :: periods = 0
      integer :: batch_periods = 0
      !> Of the numbers of its severity, each in its unit
      type(vibration_severity_t) :: severity
      !> Largest of these as a share of the number [-]
      real(dp) :: severity_share = 0.0_dp
      !> Of impacts a period, of each contact, and of their mean impulse [N s]
      real(dp) :: impacts_per_period(most_contacts) = 0.0_dp
      real(dp) :: impulse_mean(most_contacts) = 0.0_dp
      !> Of the harmonics [m/s2]
      real(dp), allocatable :: harmonics(:)
      !> rms of z'' in both halves [m/s2], and whether these agree in it and the film force, and in the contacts that are hit
      real(dp) :: rms_of_halves(2) = 0.0_dp
      logical :: halves_agree = .false.
      logical :: same_contacts = .false.
   end type irregular_statistics_t

   public :: statistics_of_path, is_enough

contains

   !> Whether the errors are small enough, or the motion should be followed on.
   pure logical function is_enough(path)
      type(path_t), intent(in) :: path
      real(dp), allocatable :: numbers(:), errors(:)
      integer :: batch_periods

      call find_errors(path%sums(:sum_of_squares - 1, :path%record%periods), batch_periods, numbers, errors)
      is_enough = all(errors([of_rms, of_force]) <= wanted_share*numbers([of_rms, of_force]))
   end function is_enough

   !> Statistics of the periods that a motion was followed.
   pure type(irregular_statistics_t) function statistics_of_path(path, frequency) result(statistics)
      !> Of a motion that parts from its neighbours for good
      type(path_t), intent(in) :: path
      !> Frequency of the force [Hz]
      real(dp), intent(in) :: frequency
      real(dp), allocatable :: numbers(:), errors(:)
      real(dp) :: halves(of_force, 2), relative(of_energy)
      integer :: half

      associate (periods => path%record%periods)
         statistics%periods = periods
         call find_errors(path%sums, statistics%batch_periods, numbers, errors)
         statistics%severity = vibration_severity_t(errors(of_rms), errors(of_kurtosis), errors(of_force), &
                                                    errors(of_energy)/frequency)
         relative = errors(:of_energy)/max(abs(numbers(:of_energy)), tiny(1.0_dp))
         statistics%severity_share = maxval(relative)
         ! An impact more or less is within the error, unless there are none at all.
         statistics%impacts_per_period = max(errors(of_impacts:of_impulses - 1), &
                                             merge(1.0_dp/real(periods, dp), 0.0_dp, counts_of(path%sums(:, periods)) > 0.0_dp))
         statistics%impulse_mean = errors(of_impulses:of_harmonics - 1)/frequency
         statistics%harmonics = 2.0_dp*frequency*errors(of_harmonics:)
         half = periods/2
         associate (first => path%sums(:, half), second => path%sums(:, periods) - path%sums(:, half))
            numbers = numbers_of(first, half)
            halves(:, 1) = numbers(:of_force)
            numbers = numbers_of(second, periods - half)
            halves(:, 2) = numbers(:of_force)
            statistics%same_contacts = all(counts_of(first) > 0.0_dp .eqv. counts_of(second) > 0.0_dp)
         end associate
      end associate
      statistics%rms_of_halves = halves(of_rms, :)
      ! Each half has an error of sqrt(2) of that of the whole, their difference twice that of the whole.
      statistics%halves_agree = all(abs(halves(:, 1) - halves(:, 2)) <= 2.0_dp*errors_apart*errors(:of_force))
   end function statistics_of_path

   !> Standard errors, by batches of the length that leaves them uncorrelated, or as long as there are enough of them. What is left of
   !> their correlation r adds to the error, by sqrt((1 + r)/(1 - r)).
   pure subroutine find_errors(sums, batch_periods, numbers, errors)
      !> As of path_t
      real(dp), intent(in) :: sums(:, 0:)
      integer, intent(out) :: batch_periods
      !> As of numbers_of, and their standard errors
      real(dp), allocatable, intent(out) :: numbers(:)
      real(dp), allocatable, intent(out) :: errors(:)
      real(dp), allocatable :: without(:, :)
      real(dp) :: correlations(of_harmonics + size(sums, 1) - sum_of_squares)
      integer :: periods, batches, i

      periods = ubound(sums, 2)
      batch_periods = 1
      do
         batches = periods/batch_periods
         associate (first => periods - batches*batch_periods)
            numbers = numbers_of(sums(:, periods) - sums(:, first), periods - first)
            without = reshape([(numbers_of(sums(:, periods) - sums(:, first) - &
                                           (sums(:, first + i*batch_periods) - sums(:, first + (i - 1)*batch_periods)), &
                                           periods - first - batch_periods), i=1, batches)], [size(numbers), batches])
         end associate
         without = without - spread(sum(without, dim=2)/real(batches, dp), 2, batches)
         errors = sum(without**2, dim=2)
         correlations(:) = max(0.0_dp, sum(without(:, 2:)*without(:, :batches - 1), dim=2)/max(errors, tiny(1.0_dp)))
         if (all(correlations([of_rms, of_force]) <= correlated) .or. periods/(2*batch_periods) < least_batches) exit
         batch_periods = 2*batch_periods
      end do
      errors = sqrt(errors*real(batches - 1, dp)/real(batches, dp)*(1.0_dp + correlations)/(1.0_dp - correlations))
      numbers = numbers_of(sums(:, periods), periods)
   end subroutine find_errors

   !> What some periods amount to, by the places above; energies and impulses times the frequency of the force.
   pure function numbers_of(sums, periods) result(numbers)
      !> Over these periods
      real(dp), intent(in) :: sums(:)
      integer, intent(in) :: periods
      real(dp) :: numbers(of_harmonics + size(sums) - sum_of_squares)
      type(vibration_severity_t) :: severity

      severity = severity_of_sums(sums, periods, 1.0_dp)
      associate (counts => counts_of(sums))
         numbers(:of_harmonics - 1) = [severity%acceleration_rms, severity%film_force_rms, severity%acceleration_kurtosis, &
                                       severity%dissipated_energy, counts/real(periods, dp), &
                                       sums(sum_of_impulses:sum_of_squares - 1)/max(1.0_dp, counts)]
      end associate
      numbers(of_harmonics:) = sqrt(sums(sum_of_squares:)/real(periods, dp))
   end function numbers_of

   !> Impacts on each contact.
   pure function counts_of(sums) result(counts)
      real(dp), intent(in) :: sums(:)
      real(dp) :: counts(most_contacts)

      counts = sums(sum_of_impacts:sum_of_impulses - 1)
   end function counts_of

end module irregular_statistics
