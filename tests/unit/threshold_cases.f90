!> A threshold of six traces and points of them of which all is known, each count of what was found another number.
module threshold_cases
   use campaign_file_cases, only: line_feed
   use checks, only: check_list_t
   use errors, only: fault_list_t
   use kinds, only: dp, int64
   use prepared_threshold, only: prepare_threshold, prepared_threshold_t
   use scene_status, only: status_film_lost, status_steady
   use scene_texts, only: input_path, read_text
   use scene_types, only: scene_t
   use threshold_outcome, only: outcome_t, start_outcome
   use threshold_search, only: new_point, point_t
   implicit none(type, external)
   private

   !> Values of the key of the traces
   real(dp), parameter, public :: speeds(6) = [0.8_dp, 1.0_dp, 1.2_dp, 1.5_dp, 1.9_dp, 9.5_dp]
   !> Ends of the range of the key, and places that it is divided into
   real(dp), parameter, public :: first_force = 5.0_dp, last_force = 325.0_dp
   integer, parameter, public :: steps = 32
   !> Codes of the class
   integer, parameter, public :: quiet = 1, creep = 2, idle = 3
   !> What is found: each count is another number
   integer(int64), parameter, public :: traces = 6_int64, crossings = 3_int64, uncrossed = 4_int64, uncertain = 2_int64, &
                                        wide = 1_int64, failed = 7_int64, solved = 42_int64
   !> Scenes of a grid as fine: 33 values a trace, as four steps halved down to 1/32 of the range
   real(dp), parameter, public :: grid = 198.0_dp

   public :: prepare, case_points, new_outcome

contains

   !> A threshold of the class over the force amplitude, on a trace for each speed.
   subroutine prepare(checks, scene, threshold, more)
      class(check_list_t), intent(inout) :: checks
      type(scene_t), intent(out) :: scene
      type(prepared_threshold_t), intent(out) :: threshold
      !> More of the input
      character(*), intent(in) :: more
      type(fault_list_t) :: faults
      character(*), parameter :: text = &
         '&contact radius = 0.0127, length = 0.010 /'//line_feed// &
         '&lubricant viscosity = 0.3, pressure_viscosity = 2e-8 /'//line_feed// &
         '&kinematics entrainment_speed = 1.905 /'//line_feed// &
         '&load mass = 3.0, steady_force = 199.2, force_amplitude = 205.7, frequency = 600.0 /'//line_feed// &
         '&film law = "iso-viscous" /'//line_feed// &
         '&scene task = "threshold", name = "unit_test_threshold" /'//line_feed// &
         '&threshold key = "load.force_amplitude", first = 5.0, last = 325.0, count = 5, tolerance = 0.05 /'//line_feed// &
         '&output directory = "." /'//line_feed

      call read_text(text//'&campaign vary = "kinematics.entrainment_speed", values(:, 1) = 0.8, 1.0, 1.2, 1.5, 1.9, 9.5'// &
                     more, scene, faults)
      if (faults%count() == 0) call prepare_threshold(scene, input_path, .false., threshold, faults)
      call checks%check(faults%count() == 0, 'threshold prepared')
      if (faults%count() > 0) print '(a)', faults%sentence(1)
   end subroutine prepare

   !> Two traces with crossings, three without one, and one of scenes that fail.
   function case_points(scene) result(points)
      type(scene_t), intent(in) :: scene
      type(point_t), allocatable :: points(:)
      integer, parameter :: scan(5) = [0, 8, 16, 24, 32]
      integer :: trace, i

      allocate (points(0))
      ! One crossing with nothing verified above it.
      points = [points, point(1, 0, quiet), point(1, 8, quiet, 1), point(1, 9, idle, 0), point(1, 16, idle, 0), &
                point(1, 24, idle, 0), point(1, 32, idle, 0)]
      ! One that is verified some places apart, and one where scenes begin to fail.
      points = [points, point(2, 0, quiet), point(2, 8, quiet, 1), point(2, 10, quiet, 0), point(2, 11, idle, 1), &
                point(2, 16, idle), point(2, 23, idle), point(2, 24), point(2, 32)]
      do trace = 3, 5
         points = [points, (point(trace, scan(i), creep), i=1, size(scan))]
      end do
      points = [points, (point(6, scan(i)), i=1, size(scan))]

   contains

      !> A point of a class, put to the test or not; one without a class failed.
      type(point_t) function point(trace, place, class, verified)
         integer, intent(in) :: trace
         integer, intent(in) :: place
         integer, intent(in), optional :: class
         integer, intent(in), optional :: verified

         point = point_t(trace=int(trace, int64), place=place, scanned=mod(place, 8) == 0)
         if (present(class)) then
            point = new_point(scene%threshold, point, status_steady, real(class, dp))
         else
            point = new_point(scene%threshold, point, status_film_lost, 0.0_dp)
         end if
         point%tested = present(verified)
         if (present(verified)) point%verified = real(verified, dp)
      end function point

   end function case_points

   !> An outcome of which all points are known, and no trace is entered.
   subroutine new_outcome(scene, threshold, outcome)
      type(scene_t), intent(in) :: scene
      type(prepared_threshold_t), intent(in) :: threshold
      type(outcome_t), intent(out) :: outcome

      call start_outcome(scene, threshold, outcome)
      outcome%points = case_points(scene)
   end subroutine new_outcome

end module threshold_cases
