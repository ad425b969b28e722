!> How many scenes make a chunk of the file, how many a thread takes at a time, and in which order these are computed.
module schedule
   use kinds, only: dp, int64
   implicit none(type, external)
   private

   !> Most scenes of a chunk, and chunks of a campaign as long as these are not reached
   integer, parameter :: largest_chunk = 8192
   integer(int64), parameter :: most_chunks = 16384_int64

   !> What a thread takes at a time [s]: a signal or a kill loses it, and no progress is reported before it is done. Scenes that are
   !> many times slower than those before them still take less than ten seconds.
   real(dp), parameter :: wanted_seconds = 4.0_dp
   !> How many times as many scenes it takes at most as before, and at most at all
   integer, parameter :: largest_growth = 8
   integer, parameter, public :: most_scenes = 2048
   !> Scenes that are left to a thread in the end: fewer leave lanes empty, more leave the other threads nothing
   integer(int64), parameter :: fewest_taken = 32_int64

   !> What the scenes that a thread solved last have taken.
   type, public :: pace_t
      private
      integer :: scenes = 0
      real(dp) :: seconds = 0.0_dp
   contains
      procedure :: note
      procedure :: next_scenes
      procedure :: next_share
   end type pace_t

   public :: chunk_rows_for, cost_order

contains

   !> Scenes in a chunk of the file, which holds or does not hold all of it. It depends on the campaign alone, never on threads,
   !> ranks or what scenes take, so that the bytes of the result do not: as few as a table of chunks allows, since a thread takes as
   !> many chunks at a time as are done in a few seconds.
   pure integer function chunk_rows_for(scene_count, block)
      !> Scenes of the campaign
      integer(int64), intent(in) :: scene_count
      !> Scenes that are solved together, of which a chunk holds all
      integer, intent(in) :: block

      chunk_rows_for = block
      do while (chunk_rows_for < largest_chunk .and. (scene_count - 1_int64)/chunk_rows_for >= most_chunks)
         chunk_rows_for = 2*chunk_rows_for
      end do
   end function chunk_rows_for

   !> Note what some scenes have taken.
   pure subroutine note(self, scenes, seconds)
      class(pace_t), intent(inout) :: self
      integer, intent(in) :: scenes
      real(dp), intent(in) :: seconds

      self%scenes = scenes
      self%seconds = seconds
   end subroutine note

   !> How many scenes a thread takes next: one, as long as nothing is known of them, then as many as the time allows.
   pure integer function next_scenes(self)
      class(pace_t), intent(in) :: self

      next_scenes = 1
      if (self%scenes == 0) return
      next_scenes = min(largest_growth*self%scenes, most_scenes)
      if (real(next_scenes, dp)*self%seconds > wanted_seconds*real(self%scenes, dp)) &
         next_scenes = max(1, int(wanted_seconds*real(self%scenes, dp)/self%seconds))
   end function next_scenes

   !> How many scenes a thread takes of those that are left: less and less towards the end, so that all threads end together.
   pure integer(int64) function next_share(self, left, threads)
      class(pace_t), intent(in) :: self
      !> Scenes that no thread has taken
      integer(int64), intent(in) :: left
      !> Threads of all ranks
      integer, intent(in) :: threads

      next_share = min(int(self%next_scenes(), int64), max(fewest_taken, left/(2_int64*threads) + 1_int64))
   end function next_share

   !> Order by rising cost, equal costs in their old order (merge sort). Scene order(k) is computed as the
   !> k-th; its result goes back to place order(k).
   pure subroutine cost_order(costs, order)
      !> Cost of each scene, in any unit, finite
      real(dp), intent(in) :: costs(:)
      !> Each of 1 to n once
      integer, intent(out) :: order(:)
      integer :: merged(size(costs))
      integer :: width, first, middle, last, i, j, k, n

      n = size(costs)
      order = [(i, i=1, n)]
      width = 1
      do while (width < n)
         do first = 1, n, 2*width
            middle = min(first + width, n + 1)
            last = min(first + 2*width, n + 1)
            i = first
            j = middle
            do k = first, last - 1
               if (takes_left(i, middle, j, last)) then
                  merged(k) = order(i)
                  i = i + 1
               else
                  merged(k) = order(j)
                  j = j + 1
               end if
            end do
         end do
         order = merged
         width = 2*width
      end do

   contains

      !> Whether the next comes from the left part.
      pure logical function takes_left(i, middle, j, last)
         integer, intent(in) :: i
         integer, intent(in) :: middle
         integer, intent(in) :: j
         integer, intent(in) :: last

         takes_left = j >= last
         if (takes_left .or. i >= middle) return
         takes_left = costs(order(i)) <= costs(order(j))
      end function takes_left

   end subroutine cost_order

end module schedule
