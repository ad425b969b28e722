!> This program's engines as a contender of the comparison with other solvers.
!>
!>    bench_engine ENGINE SCENE_FILE ACCURACY
!>
!> ENGINE: taylor (full run), taylor-every-period (the same, no period skipped that returns to the last bit) or taylor-steady
!> (until the motion repeats). Prints the CPU seconds of one scene, then h/h0 at 64 points of each of the last ten periods.
program bench_engine
   use, intrinsic :: iso_fortran_env, only: error_unit
   use engine, only: ending_t, request_t, start_of
   use kinds, only: dp
   use many_motions, only: solve_motions
   use problem, only: of_film, problem_of, problem_t, state_size
   use scene_status, only: is_success, status_name
   use scene_types, only: law_iso_viscous, law_piezo_viscous, model_published, model_reynolds, scene_t
   use version, only: program_version
   implicit none(type, external)
   !> Copies that fill the lanes; the time is that of one.
   integer, parameter :: copies = 64, sampled = 10, points = 64
   real(dp), parameter :: least_seconds = 0.05_dp
   type(scene_t) :: scene
   type(problem_t) :: lanes(copies)
   type(ending_t) :: endings(copies)
   type(request_t) :: request
   real(dp), allocatable :: states(:, :, :)
   character(512) :: engine, path, word
   real(dp) :: accuracy, started, finished, best
   integer :: i, repetition, repetitions, rows, periods

   call get_command_argument(1, engine)
   if (engine == '--version' .or. command_argument_count() < 3) then
      print '(a)', program_version
      stop
   end if
   call get_command_argument(2, path)
   call get_command_argument(3, word)
   read (word, *) accuracy
   call read_scene_file(trim(path), scene, periods)
   lanes = problem_of(scene)
   request%accuracy = accuracy
   request%periods = periods
   request%samples_per_period = points
   request%sampled_periods = sampled
   request%until_steady = engine == 'taylor-steady'
   request%every_period = engine == 'taylor-every-period'
   allocate (states(sampled*points, state_size(lanes(1)), copies), source=0.0_dp)

   call solve()
   if (.not. all(is_success(endings%status))) then
      write (error_unit, '(a)') status_name(endings(1)%status)
      stop 1, quiet = .true.
   end if
   call cpu_time(started)
   call solve()
   call cpu_time(finished)
   repetitions = max(1, min(200, int(least_seconds/max(finished - started, 1.0e-6_dp))))
   best = (finished - started)/real(copies, dp)
   ! What takes long is timed well enough at once.
   do i = 1, merge(3, 0, finished - started < 10.0_dp*least_seconds)
      call cpu_time(started)
      do repetition = 1, repetitions
         call solve()
      end do
      call cpu_time(finished)
      best = min(best, (finished - started)/real(repetitions*copies, dp))
   end do
   print '(es24.16)', best
   ! A motion that stopped once it repeated goes on as its orbit does.
   rows = endings(1)%samples
   do i = 1, sampled*points
      print '(es24.16)', states(1 + modulo(i - 1 - sampled*points + rows*sampled*points, rows), of_film, 1)/scene%film%initial_film
   end do

contains

   subroutine solve()
      call solve_motions(lanes, start_of(lanes), request, states, endings)
   end subroutine solve

   !> Scene in SI units from lines of `key value`.
   subroutine read_scene_file(file, scene, periods)
      character(*), intent(in) :: file
      type(scene_t), intent(out) :: scene
      integer, intent(out) :: periods
      character(64) :: key
      character(128) :: line, value
      integer, parameter :: highest = 64
      !> Over the static load: amplitudes of the orders above the first, 0 where there is none; and their phases [rad]
      real(dp) :: ratio(highest), phase(highest), backlash, compliance
      integer :: unit, stat, order

      ratio = 0.0_dp
      phase = 0.0_dp
      backlash = 0.0_dp
      compliance = 0.0_dp
      periods = 200
      open (newunit=unit, file=file, status='old', action='read')
      do
         read (unit, '(a)', iostat=stat) line
         if (stat /= 0) exit
         key = line(:index(line, ' '))
         value = adjustl(line(index(line, ' '):))
         select case (key)
         case ('law')
            scene%film%law = merge(law_iso_viscous, law_piezo_viscous, index(value, 'iso') > 0)
         case ('model')
            scene%film%model = merge(model_reynolds, model_published, index(value, 'reynolds') > 0)
         case ('radius')
            read (value, *) scene%contact%radius
         case ('length')
            read (value, *) scene%contact%length
         case ('viscosity')
            read (value, *) scene%lubricant%viscosity
         case ('pressure_viscosity')
            read (value, *) scene%lubricant%pressure_viscosity
         case ('entrainment_speed')
            read (value, *) scene%kinematics%entrainment_speed
         case ('mass')
            read (value, *) scene%excitation%mass
         case ('gravity')
            read (value, *) scene%excitation%gravity
         case ('static_force')
            read (value, *) scene%excitation%steady_force
         case ('force_amplitude')
            read (value, *) scene%excitation%force_amplitude
         case ('frequency')
            read (value, *) scene%excitation%frequency
         case ('initial_film')
            read (value, *) scene%film%initial_film
         case ('periods')
            read (value, *) periods
         case ('backlash')
            read (value, *) backlash
         case ('compliance')
            read (value, *) compliance
         case default
            if (index(key, 'ratio_') /= 1 .and. index(key, 'phase_') /= 1) cycle
            read (key(7:), *) order
            if (key(:1) == 'r') read (value, *) ratio(order)
            if (key(:1) == 'p') read (value, *) phase(order)
         end select
      end do
      close (unit)
      ! In units of the first film, and of the stiffness which the static load compresses by it.
      scene%contact%backlash = backlash*scene%film%initial_film
      if (compliance > 0.0_dp) &
         scene%contact%stiffness = scene%excitation%static_load()/(compliance*scene%film%initial_film)
      if (any(ratio > 0.0_dp)) then
         scene%excitation%force_orders = pack([(order, order=1, highest)], ratio > 0.0_dp .or. [(order == 1, order=1, highest)])
         ratio(1) = scene%excitation%force_amplitude/scene%excitation%static_load()
         scene%excitation%force_amplitudes = ratio(scene%excitation%force_orders)*scene%excitation%static_load()
         scene%excitation%force_phases = phase(scene%excitation%force_orders)
      end if
      scene%contact%young_modulus = 2.0e11_dp
   end subroutine read_scene_file

end program bench_engine
