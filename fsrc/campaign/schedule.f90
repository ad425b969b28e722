!> How many scenes make a chunk, and in which order the scenes of a chunk are computed.
module schedule
   use kinds, only: dp, int64
   implicit none(type, external)
   private

   integer, parameter :: smallest_chunk = 256, largest_chunk = 8192
   !> A chunk of fewer scenes leaves lanes of the engine empty, and is done no sooner
   integer, parameter :: fewest_scenes = 8
   !> Chunks that a large campaign is cut into, at least
   integer(int64), parameter :: wanted_chunks = 512_int64
   !> Most periods of all scenes of a chunk together. A period takes 10 to 30 microseconds, one of long flights and hard
   !> impacts up to 330; with a certificate it takes up to four times as long. So a chunk is done within a minute and a
   !> half: a time limit of two minutes always lets a campaign go on.
   real(dp), parameter :: most_periods = 2.0_dp**18, most_certified_periods = 2.0_dp**16

   !> What a thread takes at a time [s]: a signal or a kill loses it, and no progress is told before it is done. Scenes that are
   !> many times slower than those before them still take less than ten seconds.
   real(dp), parameter :: wanted_seconds = 4.0_dp
   !> How many times as many scenes it takes at most as before, and at most at all
   integer, parameter :: largest_growth = 8, most_scenes = 2048

   !> What the scenes that a thread solved last have taken.
   type, public :: pace_t
      private
      integer :: scenes = 0
      real(dp) :: seconds = 0.0_dp
   contains
      procedure :: note
      procedure :: next_scenes
   end type pace_t

   public :: chunk_rows_for, cost_order

contains

   !> Scenes in a chunk. It depends on the campaign alone, never on threads or ranks, so that the bytes of
   !> the result do not: chunks as small as keeps the table of chunks and the hand-outs cheap, since a chunk
   !> under way is what a signal or a kill loses, and what the last worker may have to finish alone.
   pure integer function chunk_rows_for(scene_count, periods, certified)
      !> Scenes of the campaign
      integer(int64), intent(in) :: scene_count
      !> Most periods of a scene
      real(dp), intent(in) :: periods
      !> Whether every scene gets a certificate
      logical, intent(in) :: certified
      real(dp) :: most

      chunk_rows_for = smallest_chunk
      do while (chunk_rows_for < largest_chunk .and. scene_count/wanted_chunks > int(chunk_rows_for, int64))
         chunk_rows_for = 2*chunk_rows_for
      end do
      most = merge(most_certified_periods, most_periods, certified)
      do while (chunk_rows_for > fewest_scenes .and. real(chunk_rows_for, dp)*periods > most)
         chunk_rows_for = chunk_rows_for/2
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
