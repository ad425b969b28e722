!> Pressures and films over X that are kept of a motion in nodes: at the largest loads of the window, or at phases of its last period.
!> They are those at the ends of steps, as they were solved: at a largest load that of the step whose end carries most, at a phase the
!> first end of a step that is not before it.
module nodal_profiles
   use kinds, only: dp
   use nodal_film, only: films_at_nodes, rigid_pressures
   use nodal_flank, only: nodal_contact_t
   use nodal_step, only: motion_t
   implicit none(type, external)
   private

   !> A profile: number of the contact, time since the window began [periods], load M, and P and H at the nodes.
   type, public :: nodal_profile_t
      integer :: contact = 0
      real(dp) :: time = 0.0_dp, load = 0.0_dp
      real(dp), allocatable :: pressures(:), films(:)
   end type nodal_profile_t

   !> What is requested, and then the profiles of a window.
   type, public :: nodal_profiles_t
      !> Whether any are requested
      logical :: wanted = .false.
      !> Phases of the last period, in their order [periods]; none: at the largest loads
      real(dp), allocatable :: phases(:)
      !> In the order of time
      type(nodal_profile_t), allocatable :: kept(:)
      integer :: count = 0
      !> Of each flank the one of the largest load so far
      type(nodal_profile_t) :: largest(2)
      !> Place of the next phase
      integer, private :: next = 1
      !> Grid of the contact, filled with the first profile
      type(nodal_contact_t) :: contact
   end type nodal_profiles_t

   public :: start_profiles, note_profiles, at_largest_loads

contains

   !> Begin a window.
   pure subroutine start_profiles(contact, profiles)
      type(nodal_contact_t), intent(in) :: contact
      !> What is requested stays
      type(nodal_profiles_t), intent(inout) :: profiles
      integer, parameter :: first_room = 16

      if (.not. profiles%wanted) return
      profiles%contact = contact
      profiles%count = 0
      profiles%next = 1
      profiles%largest = nodal_profile_t()
      if (.not. allocated(profiles%kept)) allocate (profiles%kept(first_room))
   end subroutine start_profiles

   !> Keep what is requested of an accepted step.
   pure subroutine note_profiles(flanks, motion, period, is_last, profiles)
      !> How many there are
      integer, intent(in) :: flanks
      type(motion_t), intent(in) :: motion
      !> Whole periods since the window began
      integer, intent(in) :: period
      !> Whether this is the last period of the window
      logical, intent(in) :: is_last
      type(nodal_profiles_t), intent(inout) :: profiles
      integer :: flank

      if (.not. profiles%wanted) return
      if (allocated(profiles%phases)) then
         if (.not. is_last) return
         do while (profiles%next <= size(profiles%phases))
            if (profiles%phases(profiles%next) > motion%time(1)*(1.0_dp + epsilon(1.0_dp))) exit
            do flank = 1, flanks
               call keep(profile_of(profiles%contact, motion, flank, 1, period), profiles)
            end do
            profiles%next = profiles%next + 1
         end do
         return
      end if
      do flank = 1, flanks
         associate (load => motion%flanks(flank)%load, contact => profiles%contact)
            if (load(1) > profiles%largest(flank)%load) profiles%largest(flank) = profile_of(contact, motion, flank, 1, period)
            if (real(period, dp) + motion%time(2) < 0.0_dp) cycle
            if (load(2) >= load(1) .and. load(2) > load(3)) call keep(profile_of(contact, motion, flank, 2, period), profiles)
         end associate
      end do
   end subroutine note_profiles

   !> The profile of a flank at a place of its histories; of a rigid film that of its closed form.
   pure type(nodal_profile_t) function profile_of(contact, motion, flank, place, period) result(profile)
      type(nodal_contact_t), intent(in) :: contact
      type(motion_t), intent(in) :: motion
      integer, intent(in) :: flank
      !> 1 the present, 2 the end of the step before
      integer, intent(in) :: place
      !> Whole periods since the window began
      integer, intent(in) :: period

      profile%contact = flank
      profile%time = real(period, dp) + motion%time(place)
      associate (film => motion%flanks(flank))
         profile%load = film%load(place)
         if (film%in_nodes) then
            profile%pressures = film%pressures(:, place)
         else
            profile%pressures = rigid_pressures(contact%grid, film%film(place), film%velocity(place), film%load(place))
         end if
         profile%films = films_at_nodes(contact%grid, film%gap(place), profile%pressures)
      end associate
   end function profile_of

   !> Keep a profile.
   pure subroutine keep(profile, profiles)
      type(nodal_profile_t), intent(in) :: profile
      type(nodal_profiles_t), intent(inout) :: profiles
      type(nodal_profile_t), allocatable :: longer(:)

      if (profiles%count == size(profiles%kept)) then
         allocate (longer(2*profiles%count))
         longer(:profiles%count) = profiles%kept
         call move_alloc(longer, profiles%kept)
      end if
      profiles%count = profiles%count + 1
      profiles%kept(profiles%count) = profile
   end subroutine keep

   !> The profiles at some times of a flank, the nearest largest load to each; without any time the one of its largest load.
   pure function at_largest_loads(profiles, flank, times, periods) result(chosen)
      type(nodal_profiles_t), intent(in) :: profiles
      integer, intent(in) :: flank
      !> Since the window began [periods]
      real(dp), intent(in) :: times(:)
      !> Periods of the window
      integer, intent(in) :: periods
      type(nodal_profile_t), allocatable :: chosen(:)
      real(dp) :: away, nearest
      integer :: i, j, found

      if (size(times) == 0) then
         allocate (chosen(merge(1, 0, profiles%largest(flank)%contact == flank)))
         if (size(chosen) > 0) chosen(1) = profiles%largest(flank)
         return
      end if
      allocate (chosen(size(times)))
      do i = 1, size(times)
         found = 0
         nearest = huge(1.0_dp)
         do j = 1, profiles%count
            if (profiles%kept(j)%contact /= flank) cycle
            ! A window whose motion repeats has no ends.
            away = abs(modulo(profiles%kept(j)%time - times(i) + 0.5_dp*real(periods, dp), real(periods, dp)) &
                       - 0.5_dp*real(periods, dp))
            if (away >= nearest) cycle
            nearest = away
            found = j
         end do
         if (found > 0) then
            chosen(i) = profiles%kept(found)
         else
            chosen(i) = profiles%largest(flank)
         end if
      end do
   end function at_largest_loads

end module nodal_profiles
