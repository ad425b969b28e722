!> What the engines are compared with: every scene of a group solved by collocation far tighter than any
!> engine, and its sensitivity.
!>
!> Sensitivity. An error e made somewhere has grown to g e where it is looked at, and no method that is only
!> accurate to e can do better. g is found by two more tight solutions: one with the film at the start and the
!> force all along off by 1e-9, which stands for errors made at any time, and one with the film off by as much
!> at the start of the last periods. The larger growth is taken, and never less than one.
module stress_references
   use engine, only: ending_t, motion_state_t, request_t, start_of
   use kinds, only: dp
   use many_motions, only: solve_motions
   use problem, only: of_film, problem_t, static_load
   use random_scenes, only: drawn_scene_t, group_t
   use scene_status, only: is_success
   implicit none(type, external)
   private

   !> The last periods and their samples: what all engines are compared by.
   integer, parameter, public :: compared_periods = 8, compared_samples = 8
   integer, parameter, public :: comparisons = compared_periods*compared_samples
   !> Accuracy of the tight solution; where it cannot be had, this share of the accuracy of the group.
   real(dp), parameter :: tight_accuracy = 1.0e-11_dp, second_share = 1.0e-2_dp
   !> What film and force are put off by to see the sensitivity [-].
   real(dp), parameter :: offset = 1.0e-9_dp

   !> References of one scene.
   type, public :: reference_t
      !> Whether there is a tight solution, how the attempt ended, and its accuracy
      logical :: exists = .false.
      integer :: status = 0
      real(dp) :: accuracy = 0.0_dp
      !> Its film [m]
      real(dp) :: films(comparisons) = 0.0_dp
      !> Growth g of errors [-]
      real(dp) :: growth = 1.0_dp
   end type reference_t

   public :: solve_references

contains

   !> References of all scenes of a group.
   subroutine solve_references(group, drawn, references)
      !> The group
      type(group_t), intent(in) :: group
      !> Its scenes
      type(drawn_scene_t), intent(in) :: drawn(:)
      !> The references
      type(reference_t), intent(out) :: references(:)
      integer :: i

      call solve_tight(group, drawn, tight_accuracy, references)
      if (.not. all(references%exists)) call solve_tight(group, drawn, second_share*group%accuracy, &
                                                         references)
      do i = 1, size(references)
         if (.not. references(i)%growth >= 1.0_dp) references(i)%growth = 1.0_dp
      end do
   end subroutine solve_references

   !> Tight solutions of the scenes that have none yet, and their sensitivity.
   subroutine solve_tight(group, drawn, accuracy, references)
      type(group_t), intent(in) :: group
      type(drawn_scene_t), intent(in) :: drawn(:)
      !> Of the solution [-]
      real(dp), intent(in) :: accuracy
      type(reference_t), intent(inout) :: references(:)
      type(problem_t), allocatable :: problems(:), off_problems(:)
      type(motion_state_t), allocatable :: starts(:), rest(:)
      type(ending_t), allocatable :: middle(:), unused(:), endings(:)
      integer, allocatable :: number(:), solved(:)
      real(dp), allocatable :: films(:, :), off(:, :)
      integer :: i

      number = pack([(i, i=1, size(drawn))],.not. references%exists)
      problems = drawn(number)%resolved%problem
      starts = start_of(problems)
      starts%implicit = .true.
      allocate (films(comparisons, size(number)), off(comparisons, size(number)), source=0.0_dp)

      allocate (middle(size(number)), endings(size(number)))
      call last_periods(problems, starts, films, group%periods, accuracy, middle, endings)
      do i = 1, size(number)
         associate (reference => references(number(i)))
            reference%status = endings(i)%status
            reference%exists = is_success(endings(i)%status)
            reference%accuracy = accuracy
            reference%films = films(:, i)
         end associate
      end do

      ! What has no tight solution needs no sensitivity.
      solved = [(i, i=1, size(number))]
      solved = pack(solved, references(number)%exists)
      problems = problems(solved)
      starts = starts(solved)
      middle = middle(solved)
      endings = endings(solved)
      number = number(solved)
      films = films(:, solved)
      off = off(:, solved)
      unused = middle
      rest = starts
      call move_films(rest)
      off_problems = problems
      off_problems%force%steady = problems%force%steady + offset*(static_load(problems) + problems%force%cosine)
      call last_periods(off_problems, rest, off, group%periods, accuracy, unused, endings)
      call note_growth()
      rest = middle%motion_state_t
      call move_films(rest)
      call last_periods(problems, rest, off, group%periods, accuracy, unused, endings)
      call note_growth()

   contains

      !> Move the films at the start by the offset.
      subroutine move_films(states)
         type(motion_state_t), intent(inout) :: states(:)
         integer :: place

         do place = 1, size(states)
            states(place)%numbers(of_film) = states(place)%numbers(of_film)*(1.0_dp + offset)
         end do
      end subroutine move_films

      !> Take the growth from solutions that are off.
      subroutine note_growth()
         integer :: place

         do place = 1, size(number)
            associate (reference => references(number(place)))
               if (is_success(endings(place)%status)) then
                  reference%growth = max(reference%growth, maxval(abs(off(:, place) - &
                     films(:, place))/films(:, place))/offset)
               else
                  ! A motion that ends, once it starts a little off, is as sensitive as can be.
                  reference%growth = 1.0_dp/offset
               end if
            end associate
         end do
      end subroutine note_growth

   end subroutine solve_tight

   !> Solve up to the compared periods, and then these.
   subroutine last_periods(problems, starts, films, periods, accuracy, middle, endings)
      !> What moves
      type(problem_t), intent(in) :: problems(:)
      !> From where
      type(motion_state_t), intent(in) :: starts(:)
      !> Films of the last periods: sample, scene [m]
      real(dp), contiguous, intent(inout) :: films(:, :)
      !> Periods to solve
      integer, intent(in) :: periods
      !> Relative accuracy [-]
      real(dp), intent(in) :: accuracy
      !> States before the last periods
      type(ending_t), intent(inout) :: middle(:)
      !> How the scenes ended
      type(ending_t), intent(inout) :: endings(:)
      type(request_t) :: request
      type(motion_state_t) :: rest(size(starts))
      real(dp), allocatable :: states(:, :, :)
      integer :: i

      allocate (states(size(films, 1), 2, size(films, 2)), source=0.0_dp)
      states(:, of_film, :) = films
      rest = starts
      request%accuracy = accuracy
      request%samples_per_period = compared_samples
      if (.not. all(starts%carried_on)) then
         request%periods = periods - compared_periods
         call solve_motions(problems, starts, request, states, middle)
         rest = middle%motion_state_t
      end if
      request%periods = periods
      request%sampled_periods = compared_periods
      call solve_motions(problems, rest, request, states, endings)
      films = states(:, of_film, :)
      do i = 1, size(starts)
         if (.not. is_success(middle(i)%status)) endings(i)%status = middle(i)%status
      end do
   end subroutine last_periods

end module stress_references
