!> Separation and impacts of a window: whether the tooth leaves its flank, and which flanks it hits how hard.
module window_impacts
   use impacts, only: impact_count_t, impacts_of_watch
   use kinds, only: dp
   use load_record, only: load_record_t, record_load_samples, start_loads
   use node_extremes, only: seen_net_load_of
   use problem, only: contact_count, most_contacts, problem_t
   use window_extremes, only: window_extremes_t
   use window_record, only: window_record_t
   implicit none(type, external)
   private

   !> Verdicts. Impacts without separation are those of a tooth that floats up on its film while little presses it, and falls back
   !> on it, but never leaves it.
   integer, parameter, public :: no_separation = 0, separation_alone = 1, single_sided_impacts = 2, double_sided_impacts = 3, &
                                 impacts_without_separation = 4

   !> Impacts on each contact, with times in periods since the window began and impulses in N s.
   type, public :: window_impacts_t
      logical :: exists = .false.
      !> Periods that they were looked for in: those of the window, but for what only repeats them
      integer :: periods = 0
      type(impact_count_t) :: contacts(most_contacts)
      !> Share of the window in which the drive film is unloaded [-]
      real(dp) :: unloaded_share = 0.0_dp
   end type window_impacts_t

   !> Whether a motion solved again, tighter, has the same verdict, and as many impacts a period on each flank.
   type, public :: impact_agreement_t
      logical :: verdict = .false.
      logical :: numbers = .false.
   end type impact_agreement_t

   public :: impacts_of_record, impacts_of_samples, has_reversal, has_separation, verdict_of, agreement_of, &
             impulse_mean, list_impacts_of

contains

   !> Impacts that the steps of the engine show.
   elemental type(window_impacts_t) function impacts_of_record(record, frequency) result(impacts)
      !> Record of the window that was asked for impacts
      type(window_record_t), intent(in) :: record
      !> Frequency of the force [Hz]
      real(dp), intent(in) :: frequency

      if (record%loads%impact_limit > 0.0_dp) impacts = impacts_of_loads(record%loads, record%periods, frequency)
   end function impacts_of_record

   !> Impacts of samples.
   pure type(window_impacts_t) function impacts_of_samples(problem, impact_limit, samples_per_period, states) result(impacts)
      type(problem_t), intent(in) :: problem
      !> Multiple of the largest force
      real(dp), intent(in) :: impact_limit
      integer, intent(in) :: samples_per_period
      !> Sample, number of its state; whole periods
      real(dp), intent(in) :: states(:, :)
      type(load_record_t) :: loads

      loads%impact_limit = impact_limit
      call start_loads(problem, loads)
      call record_load_samples(problem, samples_per_period, states, loads)
      impacts = impacts_of_loads(loads, size(states, 1)/samples_per_period, problem%frequency)
   end function impacts_of_samples

   !> Impacts of recorded loads.
   pure type(window_impacts_t) function impacts_of_loads(loads, periods, frequency) result(impacts)
      type(load_record_t), intent(in) :: loads
      integer, intent(in) :: periods
      !> [Hz]
      real(dp), intent(in) :: frequency
      integer :: contact

      impacts%exists = .true.
      impacts%periods = periods
      impacts%unloaded_share = loads%unloaded/real(periods, dp)
      do contact = 1, size(impacts%contacts)
         associate (here => impacts%contacts(contact))
            here = impacts_of_watch(loads%contacts(contact), real(periods, dp))
            here%impulse_maximum = here%impulse_maximum/frequency
            here%impulse_sum = here%impulse_sum/frequency
            if (allocated(here%kept)) here%kept%impulse = here%kept%impulse/frequency
         end associate
      end do
   end function impacts_of_loads

   !> List the impacts of a window, which a time series shows, beside the numbers of more periods.
   pure subroutine list_impacts_of(window, impacts)
      type(window_impacts_t), intent(in) :: window
      !> Of more periods
      type(window_impacts_t), intent(inout) :: impacts
      integer :: contact

      do contact = 1, size(impacts%contacts)
         associate (listed => impacts%contacts(contact), shown => window%contacts(contact))
            if (allocated(listed%kept)) deallocate (listed%kept)
            if (allocated(shown%kept)) allocate (listed%kept, source=shown%kept)
         end associate
      end do
   end subroutine list_impacts_of

   !> Mean impulse of the impacts on a contact [N s], 0 where there is none.
   elemental real(dp) function impulse_mean(impacts)
      type(impact_count_t), intent(in) :: impacts

      impulse_mean = impacts%impulse_sum/real(max(1, impacts%count), dp)
   end function impulse_mean

   !> Whether what all contacts carry together changes its sign.
   pure logical function has_reversal(problem, extremes)
      type(problem_t), intent(in) :: problem
      !> Of the window
      type(window_extremes_t), intent(in) :: extremes
      integer :: carried

      carried = seen_net_load_of(problem)
      has_reversal = extremes%lowest(carried)%value < 0.0_dp .and. extremes%highest(carried)%value > 0.0_dp
   end function has_reversal

   !> Whether the tooth leaves the drive flank: what both films carry changes its sign, or the drive film is unloaded for a time.
   pure logical function has_separation(problem, extremes, impacts)
      type(problem_t), intent(in) :: problem
      type(window_extremes_t), intent(in) :: extremes
      type(window_impacts_t), intent(in) :: impacts

      has_separation = has_reversal(problem, extremes) .or. impacts%unloaded_share > 0.0_dp
   end function has_separation

   !> What separation and impacts amount to.
   pure integer function verdict_of(problem, extremes, impacts)
      type(problem_t), intent(in) :: problem
      type(window_extremes_t), intent(in) :: extremes
      type(window_impacts_t), intent(in) :: impacts

      select case (count(impacts%contacts%count > 0))
      case (2)
         verdict_of = double_sided_impacts
      case (1)
         verdict_of = merge(single_sided_impacts, impacts_without_separation, has_separation(problem, extremes, impacts))
      case default
         verdict_of = merge(separation_alone, no_separation, has_separation(problem, extremes, impacts))
      end select
   end function verdict_of

   !> In what two windows of a motion agree. Of windows that are shorter than the motion the numbers may not be those of all of it,
   !> and the verdict is it only if every flank is hit by a tooth that leaves it, which more periods do not change.
   pure type(impact_agreement_t) function agreement_of(problem, extremes, impacts, other_extremes, others, is_part) &
      result(agreement)
      type(problem_t), intent(in) :: problem
      type(window_extremes_t), intent(in) :: extremes
      type(window_impacts_t), intent(in) :: impacts
      type(window_extremes_t), intent(in) :: other_extremes
      type(window_impacts_t), intent(in) :: others
      !> Whether they are shorter than the motion
      logical, intent(in) :: is_part

      agreement%verdict = verdict_of(problem, extremes, impacts) == verdict_of(problem, other_extremes, others)
      agreement%numbers = all(impacts%contacts%count*others%periods == others%contacts%count*impacts%periods)
      if (.not. is_part) return
      agreement%verdict = agreement%verdict .and. count(impacts%contacts%count > 0) == contact_count(problem) .and. &
                          has_separation(problem, extremes, impacts)
      agreement%numbers = .false.
   end function agreement_of

end module window_impacts
