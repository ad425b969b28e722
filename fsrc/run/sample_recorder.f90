!> Keeps of the samples of a motion what the scene asks for: the window at the end, and the time series
!> in its file. A scene without a series keeps nothing beyond the window, however long it runs.
module sample_recorder
   use errors, only: error_t, exit_bad_input, raise
   use force, only: force_at
   use kinds, only: dp, int64
   use node_extremes, only: extreme_t, seen_acceleration, seen_films, seen_velocity
   use carried_loads, only: acceleration_at, contact_films, contact_loads, gear_positions
   use problem, only: contact_count, most_contacts, of_velocity, problem_t, state_size
   use result_reader, only: result_reader_t
   use result_writer, only: result_writer_t
   use scene_types, only: column_acceleration, column_applied_force, column_gear_position, column_names, &
      column_squeeze_velocity, column_time, column_units, columns_of_films, columns_of_loads, scene_t
   use signals, only: caught_signal
   use window_keeper, only: window_keeper_t
   use window_record, only: window_record_t
   implicit none(type, external)
   private

   !> Recorder of a motion.
   type, extends(window_keeper_t), public :: sample_recorder_t
      private
      real(dp) :: steps_per_second = 0.0_dp, gravity = 0.0_dp
      type(problem_t) :: problem
      logical :: series = .false.
      integer :: stride = 1
      integer, allocatable :: columns(:)
      real(dp), allocatable :: rows(:, :)
      type(result_writer_t) :: writer
      character(:), allocatable :: path
   contains
      procedure :: open => open_recorder
      procedure :: take => take_samples
      procedure :: add_extremes
      procedure :: close => close_recorder
   end type sample_recorder_t

   public :: series_rows

contains

   !> Prepare for the samples of a scene; its series is opened if it is asked for.
   subroutine open_recorder(self, scene, problem, path, resumed_periods, error)
      class(sample_recorder_t), intent(inout) :: self
      !> Checked scene
      type(scene_t), intent(in) :: scene
      !> What moves
      type(problem_t), intent(in) :: problem
      !> Path of the series
      character(*), intent(in) :: path
      !> Periods of an earlier series at this path that are kept, 0: none
      integer, intent(in) :: resumed_periods
      !> Set if the file cannot be written
      type(error_t), allocatable, intent(out) :: error
      integer :: samples

      samples = scene%solver%samples_per_period()
      self%steps_per_second = scene%excitation%frequency*real(samples, dp)
      self%problem = problem
      call self%keep_windows_of(problem)
      self%gravity = scene%excitation%gravity
      self%series = scene%output%series
      if (.not. self%series) return
      self%stride = scene%output%stride
      self%columns = scene%output%columns
      allocate (self%rows(size(self%columns), samples/self%stride + 1))
      self%path = path
      call self%writer%open(path, scene%resolved_input, column_names(self%columns), column_units(self%columns), &
                            series_rows(scene, scene%solver%periods), .true., error)
      if (resumed_periods > 0 .and. .not. allocated(error)) call copy_rows(self, series_rows(scene, resumed_periods), error)
   end subroutine open_recorder

   !> Rows of a series of some periods; the first is the start.
   pure integer(int64) function series_rows(scene, periods)
      !> Checked scene
      type(scene_t), intent(in) :: scene
      !> Periods from the start
      integer, intent(in) :: periods

      series_rows = int(periods, int64)*int(scene%solver%samples_per_period(), int64)/int(scene%output%stride, int64) + 1_int64
   end function series_rows

   !> Copy the first rows of the earlier series.
   subroutine copy_rows(self, count, error)
      class(sample_recorder_t), intent(inout) :: self
      integer(int64), intent(in) :: count
      type(error_t), allocatable, intent(out) :: error
      type(result_reader_t) :: reader
      integer(int64) :: done, part

      call reader%open(self%path, error)
      if (.not. allocated(error) .and. reader%columns /= size(self%columns)) &
         call raise(error, exit_bad_input, self%path//' has other columns')
      done = 0
      do while (done < count .and. .not. allocated(error))
         if (caught_signal() /= 0) then
            call raise(error, 128 + caught_signal(), self%path//' was interrupted while its rows were copied; it stays as it was')
            exit
         end if
         part = min(count - done, int(size(self%rows, 2), int64))
         call reader%read_rows(done + 1_int64, self%rows(:, :int(part)), error)
         if (.not. allocated(error)) call self%writer%write_rows(self%rows(:, :int(part)), error)
         done = done + part
      end do
      call reader%close()
   end subroutine copy_rows

   !> Keep what belongs to the window, write what belongs to the series.
   subroutine take_samples(self, first_step, force, states, acceleration, error)
      class(sample_recorder_t), intent(inout) :: self
      !> Step of the first sample
      integer(int64), intent(in) :: first_step
      !> Applied force F [N]
      real(dp), intent(in) :: force(:)
      !> Sample, number of its state
      real(dp), intent(in) :: states(:, :)
      !> Acceleration z'' [m/s2]
      real(dp), intent(in) :: acceleration(:)
      !> Set if the series could not be written
      type(error_t), allocatable, intent(out) :: error

      call self%window_keeper_t%take(first_step, force, states, acceleration, error)
      if (self%series) call write_series(self, first_step, force, states, acceleration, error)
   end subroutine take_samples

   !> Every stride-th step as a row of the chosen columns.
   subroutine write_series(self, first_step, force, states, acceleration, error)
      class(sample_recorder_t), intent(inout) :: self
      integer(int64), intent(in) :: first_step
      real(dp), intent(in) :: force(:)
      real(dp), intent(in) :: states(:, :)
      real(dp), intent(in) :: acceleration(:)
      type(error_t), allocatable, intent(out) :: error
      real(dp), allocatable :: times(:)
      integer :: first, i, last

      first = 1 + int(modulo(-first_step, int(self%stride, int64)))
      last = (size(force) - first)/self%stride + 1
      if (first > size(force)) return
      times = [(real(first_step + first - 1 + (i - 1)*self%stride, dp)/self%steps_per_second, i=1, last)]
      call fill_rows(self, times, force(first::self%stride), states(first::self%stride, :), &
                     acceleration(first::self%stride), self%rows)
      call self%writer%write_rows(self%rows(:, :last), error)
   end subroutine write_series

   !> Rows of the chosen columns.
   pure subroutine fill_rows(self, times, force, states, acceleration, rows)
      class(sample_recorder_t), intent(in) :: self
      real(dp), intent(in) :: times(:)
      real(dp), intent(in) :: force(:)
      real(dp), intent(in) :: states(:, :)
      real(dp), intent(in) :: acceleration(:)
      real(dp), intent(inout) :: rows(:, :)
      integer :: column, last, contact

      last = size(times)
      do column = 1, size(self%columns)
         select case (self%columns(column))
         case (column_time)
            rows(column, :last) = times
         case (column_applied_force)
            rows(column, :last) = force
         case (column_squeeze_velocity)
            rows(column, :last) = states(:, of_velocity)
         case (column_acceleration)
            rows(column, :last) = acceleration
         case (column_gear_position)
            rows(column, :last) = gear_positions(self%problem, states)
         case default
            do contact = 1, most_contacts
               if (self%columns(column) == columns_of_films(contact)) &
                  rows(column, :last) = contact_films(self%problem, contact, states)
               if (self%columns(column) == columns_of_loads(contact)) &
                  rows(column, :last) = loads_of_samples(self, contact, force, states, acceleration)
            end do
         end select
      end do
   end subroutine fill_rows

   !> Loads of the film of a contact: of the first one the net load, read off the equation of motion (1), which the sample fulfils,
   !> and what the others carry [N].
   pure function loads_of_samples(self, contact, force, states, acceleration) result(loads)
      class(sample_recorder_t), intent(in) :: self
      integer, intent(in) :: contact
      real(dp), intent(in) :: force(:)
      real(dp), intent(in) :: states(:, :)
      real(dp), intent(in) :: acceleration(:)
      real(dp) :: loads(size(force)), others(size(force))
      integer :: other

      if (contact > 1) then
         call contact_loads(self%problem, contact, states, loads)
         return
      end if
      loads = self%problem%mass*(acceleration + self%gravity) + force
      do other = 2, contact_count(self%problem)
         call contact_loads(self%problem, other, states, others)
         loads = loads + others
      end do
   end function loads_of_samples

   !> Put the extremes of the window, which fall between samples, behind the rows of the series, and say there whether the series
   !> is coarser than the motion.
   subroutine add_extremes(self, record, first_period, coarse)
      class(sample_recorder_t), intent(inout) :: self
      !> What the steps of the window show; nothing where each sample is a step of its own
      type(window_record_t), intent(in) :: record
      !> Periods before the window
      integer, intent(in) :: first_period
      !> Whether the samples are too few for the motion
      logical, intent(in) :: coarse
      type(extreme_t) :: found(6), kept(6)
      real(dp) :: rows(size(self%columns), 6), phases(6), states(6, state_size(self%problem)), accelerations(6)
      integer :: n, next

      if (.not. self%series) return
      if (coarse) call self%writer%mark_coarse()
      if (record%periods == 0) return
      associate (quantities => [seen_films(1), seen_velocity, seen_acceleration])
         found = [record%lowest(quantities), record%highest(quantities)]
      end associate
      ! In the order of time, each state once.
      n = 0
      do while (any(found%exists))
         next = minloc(real(found%period, dp) + found%phase, dim=1, mask=found%exists)
         n = n + 1
         kept(n) = found(next)
         found%exists = found%exists .and. .not. (found%period == kept(n)%period .and. abs(found%phase - kept(n)%phase) <= 0.0_dp)
      end do
      if (n == 0) return
      phases(:n) = min(1.0_dp, kept(:n)%phase)
      do next = 1, n
         states(next, :) = kept(next)%state
         accelerations(next) = acceleration_at(self%problem, kept(next)%state, phases(next))
      end do
      call fill_rows(self, (real(first_period + kept(:n)%period, dp) + kept(:n)%phase)/self%problem%frequency, &
                     force_at(self%problem%force, phases(:n)), states(:n, :), accelerations(:n), rows)
      call self%writer%write_extremes(rows(:, :n))
   end subroutine add_extremes

   !> Complete the series. Where an earlier one stands it is beside its place, until place_files puts it there.
   subroutine close_recorder(self, error)
      class(sample_recorder_t), intent(inout) :: self
      !> Set if the file could not be completed
      type(error_t), allocatable, intent(out) :: error

      if (self%series) call self%writer%close(error)
   end subroutine close_recorder

end module sample_recorder
