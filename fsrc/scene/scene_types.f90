!> What is to be computed: one type per namelist group, all resolved, SI units.
module scene_types
   use, intrinsic :: iso_c_binding, only: c_double
   use input_key, only: name_limit, path_limit
   use kinds, only: dp
   use whole_numbers, only: common_divisor
   use word_list, only: word_t
   implicit none(type, external)
   private

   ! The codes of a key count its choices in the order of the key table, which takes words of tasks and laws from here.

   !> What is computed, and what &scene task calls it.
   integer, parameter, public :: task_motion = 1, task_film = 2, task_sweep = 3, task_campaign = 4, task_threshold = 5
   character(*), parameter, public :: words_of_tasks = 'motion film sweep campaign threshold'
   !> What a film task computes of every point.
   integer, parameter, public :: compute_rupture = 1, compute_load = 2, compute_stiffness = 3, compute_damping = 4, &
                                 compute_pressure = 5, compute_limits = 6, compute_profile = 7
   !> Viscosity under pressure.
   integer, parameter, public :: viscosity_constant = 1, viscosity_barus = 2, viscosity_roelands = 3
   !> Which speed forms the groups of a film task.
   integer, parameter, public :: speed_mean = 1, speed_sum = 2
   !> Film law of the motion, and what &film law calls it.
   integer, parameter, public :: law_iso_viscous = 1, law_piezo_viscous = 2, law_elastohydrodynamic = 3
   character(*), parameter, public :: words_of_laws = 'iso-viscous piezo-viscous elastohydrodynamic'
   !> Whose formulas.
   integer, parameter, public :: model_published = 1, model_reynolds = 2, model_numerical = 3, model_closure = 4, &
                                 model_resolved = 5, model_automatic = 6
   !> Rupture angle in the squeeze term of (24).
   integer, parameter, public :: rupture_half_pi = 1, rupture_solved = 2
   !> Root finder of (18).
   integer, parameter, public :: rupture_solver_fast = 1, rupture_solver_successive = 2
   !> Time integration.
   integer, parameter, public :: method_newmark = 1, method_taylor = 2
   !> End of the run.
   integer, parameter, public :: until_periods = 1, until_steady = 2
   !> Iteration within a Newmark step.
   integer, parameter, public :: iteration_newton = 1, iteration_successive = 2
   !> First iterate of a Newmark step.
   integer, parameter, public :: predictor_extrapolated = 1, predictor_previous = 2

   !> Columns that a time series can hold, in the order of their codes.
   character(*), parameter, public :: column_names(9) = [character(16) :: 'time', 'applied_force', 'film_thickness', &
                                                         'squeeze_velocity', 'acceleration', 'film_load', &
                                                         'coast_film', 'coast_load', 'gear_position']
   character(*), parameter, public :: column_units(9) = [character(4) :: 's', 'N', 'm', 'm/s', 'm/s2', 'N', 'm', 'N', 'm']
   integer, parameter, public :: column_time = 1, column_applied_force = 2, column_squeeze_velocity = 4, &
                                 column_acceleration = 5, column_gear_position = 9

   !> Columns of the film and of its load, of the drive flank and of the coast flank
   integer, parameter, public :: columns_of_films(2) = [3, 7], columns_of_loads(2) = [6, 8]

   !> &contact
   type, public :: contact_t
      !> Equivalent radius R [m]; 0: the two flank radii are given instead
      real(dp) :: radius = 0.0_dp
      !> Radii of the two flanks [m]
      real(dp) :: radius_1 = 0.0_dp
      real(dp) :: radius_2 = 0.0_dp
      !> Contact length l [m]
      real(dp) :: length = 0.0_dp
      !> Young's modulus E [Pa] and Poisson ratio [-] of the teeth
      real(dp) :: young_modulus = 0.0_dp
      real(dp) :: poisson_ratio = 0.0_dp
      !> Backlash, the clearance between the two flanks along their normal [m]; 0: there is one flank only
      real(dp) :: backlash = 0.0_dp
      !> Stiffness of a flank and its tooth, in series with the film [N/m]; 0: rigid
      real(dp) :: stiffness = 0.0_dp
      !> Damping ratio of the mass that moves on that stiffness [-]; 0: the teeth lose no energy
      real(dp) :: damping_ratio = 0.0_dp
      !> Whether the flattening of the flanks is in there, or adds to what it gives
      logical :: flattening_included = .true.
      !> Width of all teeth in contact [m]; 0: the contact length
      real(dp) :: tooth_width = 0.0_dp
   contains
      procedure :: stiffness_of_width
   end type contact_t

   !> Sums of keys that are smaller than this come of rounding, and lead out of the range of the reals: Q + m g [N], U [m/s]
   real(dp), parameter, public :: least_static_load = 1.0e-12_dp, least_entrainment_speed = 1.0e-9_dp

   !> &lubricant
   type, public :: lubricant_t
      !> Viscosity at ambient pressure eta0 [Pa s]
      real(dp) :: viscosity = 0.0_dp
      !> Barus coefficient alpha [1/Pa]
      real(dp) :: pressure_viscosity = 0.0_dp
      integer :: viscosity_law = viscosity_barus
   end type lubricant_t

   !> &kinematics
   type, public :: kinematics_t
      !> Entrainment speed U, the mean of the surface speeds [m/s]
      real(dp) :: entrainment_speed = 0.0_dp
      !> The surface speeds, where they were given [m/s]
      real(dp) :: surface_speed_1 = 0.0_dp
      real(dp) :: surface_speed_2 = 0.0_dp
   end type kinematics_t

   !> Highest order of a force that a scene may have
   integer, parameter, public :: highest_order = 128

   !> &load: the mass that moves and the forces on it; `load` alone is the film's
   type, public :: excitation_t
      !> Equivalent mass m [kg]
      real(dp) :: mass = 0.0_dp
      !> Steady force Q [N]
      real(dp) :: steady_force = 0.0_dp
      !> Amplitude F0 of the force that oscillates, a cosine [N]
      real(dp) :: force_amplitude = 0.0_dp
      !> Or its orders (multiples of the frequency), their amplitudes [N] and phases [rad]
      integer, allocatable :: force_orders(:)
      real(dp), allocatable :: force_amplitudes(:), force_phases(:)
      !> Mean of the force beside Q [N]
      real(dp) :: force_mean = 0.0_dp
      !> By what all that oscillates is multiplied [-]
      real(dp) :: force_scale = 1.0_dp
      !> Frequency f_exc of the oscillating force [Hz]
      real(dp) :: frequency = 0.0_dp
      !> Acceleration of free fall g [m/s2]
      real(dp) :: gravity = 0.0_dp
   contains
      procedure :: weight
      procedure :: static_load
   end type excitation_t

   !> How the drag torque on a loose gear is known
   integer, parameter, public :: drag_unknown = 0, drag_given = 1, drag_tabulated = 2, drag_computed = 3

   !> A measured drag torque over speed and temperature, on a full grid
   type, public :: drag_table_t
      !> Ascending [1/min] and [degC]
      real(dp), allocatable :: speeds(:), temperatures(:)
      !> (speed, temperature) [N m]
      real(dp), allocatable :: torques(:, :)
   end type drag_table_t

   !> The drag torque on a loose gear; positive: it holds the gear against the drive flank
   type, public :: drag_t
      integer :: known_by = drag_unknown
      real(dp) :: torque = 0.0_dp
      !> Its parts, where it is computed, which add up to it [N m]
      real(dp) :: bearing = 0.0_dp
      real(dp) :: synchroniser = 0.0_dp
      real(dp) :: churning = 0.0_dp
   end type drag_t

   !> A number of the input that was surely meant in another unit
   type, public :: mistaken_number_t
      !> Where it stands: file or option, and line
      character(:), allocatable :: source
      integer :: line = 0
      !> Its key, by its position in the key table, and what it would be in the unit of the key
      integer :: key = 0
      real(dp) :: meant = 0.0_dp
      !> Why it is odd
      character(:), allocatable :: sentence
   end type mistaken_number_t

   !> The teeth of a gear pair, derived; first that of gear 1, where both have their own
   type, public :: teeth_t
      !> Whether the tips are those of the input; else they are as high as usual
      logical :: tips_given = .false.
      !> Sum of the profile shifts; both, and the addendum of the rack before tips are shortened, if that is one for both [m_n]
      real(dp) :: shift_sum = 0.0_dp
      real(dp) :: shifts(2) = 0.0_dp
      real(dp) :: addendum = 0.0_dp
      !> Normal thickness of the tips, below 0 where teeth are pointed, and by how much shifts are too small for no undercut [m_n]
      real(dp) :: tip_thickness(2) = 0.0_dp
      real(dp) :: undercut(2) = 0.0_dp
      !> How far from where the line of action touches the base circles the tips cross it [m]
      real(dp) :: reach(2) = 0.0_dp
      !> Whether tips as high as usual would be pointed, or beyond the line of action, and end there
      logical :: is_cut_short = .false.
      !> Contact ratios eps_alpha and eps_beta, and the largest eps_alpha that any teeth have at this centre distance
      real(dp) :: contact_ratio = 0.0_dp
      real(dp) :: overlap_ratio = 0.0_dp
      real(dp) :: largest_ratio = 0.0_dp
   end type teeth_t

   !> &gear: a loose gear and the gear that drives it, of which the contact follows
   type, public :: gear_t
      logical :: given = .false.
      !> Empty: it has none
      character(name_limit) :: name = ''
      !> Teeth of the gear on the shaft and of the loose gear
      integer :: teeth_1 = 0
      integer :: teeth_2 = 0
      !> Normal module, face width, centre distance (0: that without profile shift), place on the line of action [m]
      real(dp) :: normal_module = 0.0_dp
      real(dp) :: face_width = 0.0_dp
      real(dp) :: centre_distance = 0.0_dp
      real(dp) :: contact_position = 0.0_dp
      !> Normal pressure angle and helix angle [degrees]
      real(dp) :: pressure_angle_deg = 0.0_dp
      real(dp) :: helix_angle_deg = 0.0_dp
      real(dp) :: contact_lines = 1.0_dp
      !> Tip diameters [m]; 0: not given, and contact_lines is
      real(dp) :: tip_diameter_1 = 0.0_dp
      real(dp) :: tip_diameter_2 = 0.0_dp
      !> Inertia of the loose gear [kg m2] and drag torque on it [N m], of which one of three stands: the torque, a table, a bearing
      real(dp) :: loose_inertia = 0.0_dp
      real(dp) :: drag_torque = 0.0_dp
      type(drag_table_t), allocatable :: drag_table
      !> What multiplies a computed or tabulated drag
      real(dp) :: drag_scale = 1.0_dp
      !> Bearing: mean diameter [m], 0: the drag is not computed; f_0 of a needle bearing, or width and radial clearance of a
      !> plain one [m]
      real(dp) :: bearing_mean_diameter = 0.0_dp
      real(dp) :: bearing_factor = 0.0_dp
      real(dp) :: bearing_width = 0.0_dp
      real(dp) :: bearing_clearance = 0.0_dp
      !> Synchroniser: cones that shear, their mean diameter, width, and gap normal to the cone [m]
      integer :: synchroniser_cones = 0
      real(dp) :: synchroniser_diameter = 0.0_dp
      real(dp) :: synchroniser_width = 0.0_dp
      real(dp) :: synchroniser_gap = 0.0_dp
      !> Depth of the lowest point of the reference circle below the oil [m]
      real(dp) :: immersion_depth = 0.0_dp
      !> Speed of the shaft that carries the loose gear over that of the shaft that drives it
      real(dp) :: own_shaft_ratio = 0.0_dp
      !> Backlash along the normal of the flanks [m], 0: one flank; stiffness of the teeth for each width [N/m2], 0: rigid; damping
      !> ratio of the loose gear on that stiffness [-]
      real(dp) :: backlash = 0.0_dp
      real(dp) :: tooth_stiffness = 0.0_dp
      real(dp) :: tooth_damping_ratio = 0.0_dp
   contains
      procedure :: drag_known_by
   end type gear_t

   !> A measured run-up of a shaft: amplitudes and phases of its orders over speed
   type, public :: excitation_table_t
      !> Ascending [1/min]
      real(dp), allocatable :: speeds(:)
      real(dp), allocatable :: orders(:)
      !> (speed, order) [rad/s2] and [rad]
      real(dp), allocatable :: accelerations(:, :), phases(:, :)
   end type excitation_table_t

   !> &shaft: speed [1/min] and motion of the gear that drives, the sum of amplitude cos(2 pi order t/turn + phase)
   type, public :: shaft_t
      real(dp) :: speed_rpm = 0.0_dp
      !> Multiples of the speed, halves among them; phases [rad]
      real(dp), allocatable :: orders(:), phases(:)
      !> Amplitudes of the angular acceleration [rad/s2]; or of the angular speed [rad/s], which is differentiated at speed_rpm
      real(dp), allocatable :: accelerations(:), speed_amplitudes(:)
      !> Lowest and highest speed for which these were measured [1/min]; absent: they were not
      real(dp), allocatable :: signal_speed_range(:)
      !> Of which accelerations and phases follow at speed_rpm
      type(excitation_table_t), allocatable :: table
   end type shaft_t

   !> Kind of base oil.
   integer, parameter, public :: oil_mineral = 1, oil_pao = 2, oil_polyglycol = 3

   !> &oil: the data sheet, of which &lubricant follows
   type, public :: oil_t
      logical :: given = .false.
      !> Kinematic viscosities at 40 and 100 degC [mm2/s], density at 15 degC [kg/m3]
      real(dp) :: viscosity_40_cst = 0.0_dp
      real(dp) :: viscosity_100_cst = 0.0_dp
      real(dp) :: density_15 = 0.0_dp
      real(dp) :: temperature_celsius = 0.0_dp
      integer :: base = oil_mineral
      !> Barus coefficient [1/Pa]; 0: that of its kind at this temperature
      real(dp) :: pressure_viscosity = 0.0_dp
      !> Volume of the sump [m3]
      real(dp) :: volume = 0.0_dp
   end type oil_t

   !> &film
   type, public :: film_choice_t
      integer :: law = law_iso_viscous
      integer :: model = model_published
      !> Whether the closure, which the model is then, or nodes of pressure are chosen by what the closure shows; once it is chosen,
      !> why, and whether it is the closure because nodes stopped
      logical :: automatic = .false., nodes_stopped = .false.
      character(400) :: model_words = ''
      integer :: rupture = rupture_half_pi
      integer :: rupture_solver = rupture_solver_fast
      !> Nodes of pressure across a contact
      integer :: nodes = 48
      !> Film at t = 0 [m]; 0: the steady film
      real(dp) :: initial_film = 0.0_dp
      !> Film velocity at t = 0 [m/s]
      real(dp) :: initial_velocity = 0.0_dp
   end type film_choice_t

   !> &solver
   type, public :: solver_t
      integer :: method = method_newmark
      integer :: iteration = iteration_newton
      integer :: predictor = predictor_extrapolated
      !> eps of (36) [m]
      real(dp) :: tolerance = 0.0_dp
      !> Most iterations in a step
      integer :: iteration_limit = 0
      !> Steps of Newmark's method, each a sample
      integer :: steps_per_period = 0
      !> Samples of an error-controlled method
      integer :: kept_per_period = 0
      !> Periods to solve, the most if until steady
      integer :: periods = 0
      !> Relative accuracy of the film [-]
      real(dp) :: accuracy = 1.0e-8_dp
      integer :: until = until_periods
      !> Starts from which motions of the scene are looked for; 1: its own alone
      integer :: starts = 1
      !> Wall time [s]; 0: no limit
      real(dp) :: time_limit = 0.0_dp
   contains
      procedure :: samples_per_period
   end type solver_t

   !> &spectrum
   type, public :: spectrum_choice_t
      !> Whole periods in the window at the end of the run
      integer :: periods = 16
      !> Orders at which the force makes harmonics
      logical :: forced(highest_order) = [.true., spread(.false., 1, highest_order - 1)]
      !> Order with the largest force, whose multiples the harmonics are counted by
      integer :: dominant_order = 1
      !> Greatest common divisor of orders that are no mere trace: the force repeats as many times in its period
      integer :: common_order = 1
      !> A harmonic above this share of the largest forced one counts
      real(dp) :: harmonic_threshold = 0.01_dp
      !> From this many harmonics on: idle
      integer :: idle_harmonics = 20
      !> Harmonic distortion below this: quiet
      real(dp) :: quiet_limit = 0.35_dp
      !> Irregular fraction above this: irregular, or subharmonic
      real(dp) :: irregular_limit = 0.01_dp
      !> Largest loads of a film above this multiple of the largest force: impacts
      real(dp) :: impact_limit = 1.5_dp
      !> Whether the scene is solved again tighter, and the film error [-] up to which its class is verified
      logical :: verify = .true.
      real(dp) :: verification_tolerance = 0.01_dp
   end type spectrum_choice_t

   !> &points: a film task is the product of these lists
   type, public :: film_points_t
      !> h* = h0/R [-]
      real(dp), allocatable :: film_ratios(:)
      !> w* = w/u [-]
      real(dp), allocatable :: squeeze_ratios(:)
      !> u* = u eta0 alpha/R [-]
      real(dp), allocatable :: speed_groups(:)
      !> Whether the speed groups are formed from the speeds, and with which
      logical :: from_speeds = .false.
      integer :: speed_reading = speed_mean
      !> What is computed, by compute code
      logical :: compute(7) = .false.
      !> Films of the published formulas, of the exact ones, and of the numerical reference solution
      logical :: published = .true., exact = .true., numerical = .false.
      !> Nodes of a pressure profile
      integer :: profile_nodes = 0
      !> Cells of the numerical solution
      integer :: cells = 0
   end type film_points_t

   !> &sweep
   type, public :: sweep_t
      !> Position of the swept key in the key table
      integer :: key = 0
      !> Values in their order, there and back [unit of the key]
      real(dp), allocatable :: values(:)
      !> How many of them lead there; the others lead back
      integer :: outward = 0
   end type sweep_t

   !> One column of a table.
   type, public :: numbers_t
      real(dp), allocatable :: numbers(:)
   end type numbers_t

   !> &campaign, as given; the campaign folder makes scenes of it.
   type, public :: campaign_choice_t
      type(word_t), allocatable :: vary(:)
      !> Scale code of each varied key: 1 linear, 2 logarithmic
      integer, allocatable :: scale(:)
      real(dp), allocatable :: first(:), last(:), count(:)
      type(numbers_t), allocatable :: values(:)
      !> 1 grid, 2 Sobol
      integer :: sample = 1
      integer :: size = 0
      integer :: seed = 1
      character(:), allocatable :: csv
      !> Recorded quantities, by their codes
      integer, allocatable :: record(:)
      !> Whether neighbours on a grid hand each other their motions
      logical :: neighbours = .true.
      integer :: samples_per_period = 256
      logical :: allow_invalid = .false.
      logical :: confirm_size = .false.
      integer :: part = 1, parts = 1
      !> Keys that the base input gives or has a default for, by position in the key table
      logical, allocatable :: in_base(:)
   end type campaign_choice_t

   !> &threshold, as given
   type, public :: threshold_t
      !> As group.key
      character(:), allocatable :: key
      real(dp) :: first = 0.0_dp
      real(dp) :: last = 0.0_dp
      !> 1 linear, 2 logarithmic
      integer :: scale = 1
      !> Values of the scan
      integer :: count = 0
      !> Width of a bracket as a share of the range
      real(dp) :: tolerance = 0.0_dp
      !> Code of the quantity; its code that is looked for, or the least of its codes that are, 0: any change; its level [unit of
      !> the quantity]
      integer :: quantity = 0
      integer :: wanted = 0
      integer :: least_wanted = 0
      real(dp) :: level = 0.0_dp
   end type threshold_t

   !> &output
   type, public :: output_t
      character(path_limit) :: directory = ''
      logical :: series = .true.
      !> Codes of the columns, in the order of the file
      integer, allocatable :: columns(:)
      integer :: stride = 1
      !> Whether pressures and films over the contact are written, and at which phases of the last period; none: at the largest load
      !> of each impact
      logical :: profiles = .false.
      real(dp), allocatable :: profile_phases(:)
      logical :: overwrite = .false.
   end type output_t

   !> One scene.
   type, public :: scene_t
      character(name_limit) :: name = ''
      !> Name of the scenes of all gear pairs of its input together; empty: there is one pair at most
      character(name_limit) :: gearbox = ''
      !> Its input, for the faults
      character(:), allocatable :: source
      integer :: task = task_motion
      type(contact_t) :: contact
      type(lubricant_t) :: lubricant
      type(kinematics_t) :: kinematics
      type(excitation_t) :: excitation
      type(gear_t) :: gear
      !> All pairs of a campaign over several, of which the gear is one
      type(gear_t), allocatable :: pairs(:)
      !> Drag torque on the loose gear, and the teeth of the pair, derived
      type(drag_t) :: drag
      type(teeth_t) :: teeth
      type(shaft_t) :: shaft
      type(oil_t) :: oil
      type(film_choice_t) :: film
      type(solver_t) :: solver
      type(spectrum_choice_t) :: spectrum
      type(film_points_t) :: points
      type(sweep_t) :: sweep
      type(campaign_choice_t) :: campaign
      type(threshold_t) :: threshold
      type(output_t) :: output
      !> What was made of a signal, and what is allowed but hardly meant, a line each
      type(word_t), allocatable :: warnings(:)
      !> Numbers in a unit that is surely not theirs
      type(mistaken_number_t), allocatable :: mistaken(:)
      !> Line in which each key of the table was set; 0: it was not, or on the command line
      integer, allocatable :: lines(:)
      !> All keys with their resolved values as namelist text, without places on this machine
      character(:), allocatable :: resolved_input
   end type scene_t

   interface
      !> x y + z of the C library, rounded once on every machine.
      pure real(c_double) function fma(x, y, z) bind(c)
         import :: c_double
         real(c_double), value :: x
         real(c_double), value :: y
         real(c_double), value :: z
      end function fma
   end interface

   public :: is_shared_task, note_orders, set_number

contains

   !> Set the number that a key stands for. It knows every number of a motion that campaigns may vary. All speeds end as the
   !> entrainment speed.
   pure subroutine set_number(scene, group, name, value, known)
      type(scene_t), intent(inout) :: scene
      !> The key
      character(*), intent(in) :: group
      character(*), intent(in) :: name
      !> In the unit of the key
      real(dp), intent(in) :: value
      !> Whether there is such a number
      logical, intent(out), optional :: known

      if (present(known)) known = .true.
      if (group == 'gear' .and. name /= 'name') then
         call set_number_of_gear(scene%gear, name, value, known)
         return
      end if
      associate (contact => scene%contact, lubricant => scene%lubricant, kinematics => scene%kinematics, &
                 excitation => scene%excitation, film => scene%film, solver => scene%solver, spectrum => scene%spectrum, &
                 oil => scene%oil)
         select case (trim(group)//'.'//name)
         case ('contact.radius')
            contact%radius = value
         case ('contact.radius_1')
            contact%radius_1 = value
         case ('contact.radius_2')
            contact%radius_2 = value
         case ('contact.length')
            contact%length = value
         case ('contact.young_modulus')
            contact%young_modulus = value
         case ('contact.poisson_ratio')
            contact%poisson_ratio = value
         case ('contact.backlash')
            contact%backlash = value
         case ('contact.stiffness')
            contact%stiffness = value
         case ('contact.damping_ratio')
            contact%damping_ratio = value
         case ('lubricant.viscosity')
            lubricant%viscosity = value
         case ('lubricant.pressure_viscosity')
            lubricant%pressure_viscosity = value
         case ('kinematics.entrainment_speed')
            kinematics%entrainment_speed = value
         case ('kinematics.rolling_speed')
            kinematics%entrainment_speed = 0.5_dp*value
         case ('kinematics.surface_speed_1')
            kinematics%surface_speed_1 = value
            kinematics%entrainment_speed = 0.5_dp*kinematics%surface_speed_1 + 0.5_dp*kinematics%surface_speed_2
         case ('kinematics.surface_speed_2')
            kinematics%surface_speed_2 = value
            kinematics%entrainment_speed = 0.5_dp*kinematics%surface_speed_1 + 0.5_dp*kinematics%surface_speed_2
         case ('load.mass')
            excitation%mass = value
         case ('load.steady_force')
            excitation%steady_force = value
         case ('load.force_amplitude')
            excitation%force_amplitude = value
         case ('load.force_mean')
            excitation%force_mean = value
         case ('load.force_scale')
            excitation%force_scale = value
         case ('load.frequency')
            excitation%frequency = value
         case ('load.gravity')
            excitation%gravity = value
         case ('gear.name')
            ! The key that stands for the whole pair.
            if (allocated(scene%pairs)) scene%gear = scene%pairs(nint(value))
         case ('shaft.speed_rpm')
            scene%shaft%speed_rpm = value
         case ('oil.viscosity_40_cst')
            oil%viscosity_40_cst = value
         case ('oil.viscosity_100_cst')
            oil%viscosity_100_cst = value
         case ('oil.density_15')
            oil%density_15 = value
         case ('oil.temperature_celsius')
            oil%temperature_celsius = value
         case ('oil.volume')
            oil%volume = value
         case ('oil.pressure_viscosity')
            oil%pressure_viscosity = value
         case ('film.initial_film')
            film%initial_film = value
         case ('film.initial_velocity')
            film%initial_velocity = value
         case ('solver.accuracy')
            solver%accuracy = value
         case ('solver.periods')
            solver%periods = nint(value)
         case ('spectrum.periods')
            spectrum%periods = nint(value)
         case ('spectrum.harmonic_threshold')
            spectrum%harmonic_threshold = value
         case ('spectrum.idle_harmonics')
            spectrum%idle_harmonics = nint(value)
         case ('spectrum.quiet_limit')
            spectrum%quiet_limit = value
         case ('spectrum.irregular_limit')
            spectrum%irregular_limit = value
         case ('spectrum.impact_limit')
            spectrum%impact_limit = value
         case default
            if (present(known)) known = .false.
         end select
      end associate
   end subroutine set_number

   !> Set a number of a gear pair.
   pure subroutine set_number_of_gear(gear, name, value, known)
      type(gear_t), intent(inout) :: gear
      !> The key in the group
      character(*), intent(in) :: name
      !> In the unit of the key
      real(dp), intent(in) :: value
      !> .false. if there is no such number
      logical, intent(inout), optional :: known

      select case (name)
      case ('teeth_1')
         gear%teeth_1 = nint(value)
      case ('teeth_2')
         gear%teeth_2 = nint(value)
      case ('normal_module')
         gear%normal_module = value
      case ('pressure_angle_deg')
         gear%pressure_angle_deg = value
      case ('helix_angle_deg')
         gear%helix_angle_deg = value
      case ('face_width')
         gear%face_width = value
      case ('centre_distance')
         gear%centre_distance = value
      case ('contact_position')
         gear%contact_position = value
      case ('contact_lines')
         gear%contact_lines = value
      case ('loose_inertia')
         gear%loose_inertia = value
      case ('drag_torque')
         gear%drag_torque = value
      case ('drag_scale')
         gear%drag_scale = value
      case ('tip_diameter_1')
         gear%tip_diameter_1 = value
      case ('tip_diameter_2')
         gear%tip_diameter_2 = value
      case ('bearing_mean_diameter')
         gear%bearing_mean_diameter = value
      case ('bearing_factor')
         gear%bearing_factor = value
      case ('bearing_width')
         gear%bearing_width = value
      case ('bearing_clearance')
         gear%bearing_clearance = value
      case ('synchroniser_cones')
         gear%synchroniser_cones = nint(value)
      case ('synchroniser_diameter')
         gear%synchroniser_diameter = value
      case ('synchroniser_width')
         gear%synchroniser_width = value
      case ('synchroniser_gap')
         gear%synchroniser_gap = value
      case ('immersion_depth')
         gear%immersion_depth = value
      case ('own_shaft_ratio')
         gear%own_shaft_ratio = value
      case ('backlash')
         gear%backlash = value
      case ('tooth_stiffness')
         gear%tooth_stiffness = value
      case ('tooth_damping_ratio')
         gear%tooth_damping_ratio = value
      case default
         if (present(known)) known = .false.
      end select
   end subroutine set_number_of_gear

   !> Note at which orders harmonics are forced, those of at least a hundredth of the largest amplitude of the force, and which is
   !> dominant, that of the largest, the lowest of equal ones. Orders from a thousandth on make the period after which the force
   !> repeats: what smaller ones make of a motion that repeats with the others stays below a hundredth of its power.
   pure subroutine note_orders(orders, amplitudes, choice)
      integer, intent(in) :: orders(:)
      !> Of each order [N]
      real(dp), intent(in) :: amplitudes(:)
      type(spectrum_choice_t), intent(inout) :: choice
      real(dp), parameter :: equal_share = 1.0_dp - 1.0e-9_dp, least_share = 0.01_dp*equal_share, &
                             trace = 0.001_dp*equal_share
      integer :: i

      choice%forced = .false.
      choice%forced(pack(orders, orders <= highest_order .and. amplitudes >= least_share*maxval(amplitudes))) = .true.
      choice%dominant_order = minval(orders, mask=amplitudes >= equal_share*maxval(amplitudes))
      choice%common_order = 0
      do i = 1, size(orders)
         if (amplitudes(i) >= trace*maxval(amplitudes)) choice%common_order = common_divisor(orders(i), choice%common_order)
      end do
      choice%common_order = max(1, choice%common_order)
   end subroutine note_orders

   !> How the drag torque of a pair is known.
   pure integer function drag_known_by(self)
      class(gear_t), intent(in) :: self

      drag_known_by = drag_given
      if (allocated(self%drag_table)) drag_known_by = drag_tabulated
      if (self%bearing_mean_diameter > 0.0_dp) drag_known_by = drag_computed
   end function drag_known_by

   !> Stiffness of teeth that have one for each metre of their width [N/m].
   elemental real(dp) function stiffness_of_width(self, tooth_stiffness)
      class(contact_t), intent(in) :: self
      !> c' of ISO 6336-1 [N/m2]
      real(dp), intent(in) :: tooth_stiffness

      stiffness_of_width = tooth_stiffness*merge(self%tooth_width, self%length, self%tooth_width > 0.0_dp)
   end function stiffness_of_width

   !> Weight m g of the tooth pair [N].
   elemental real(dp) function weight(self)
      class(excitation_t), intent(in) :: self

      weight = self%mass*self%gravity
   end function weight

   !> Static load Q + m g [N], with the mean of the force, which the steady film carries.
   elemental real(dp) function static_load(self)
      class(excitation_t), intent(in) :: self

      static_load = fma(self%mass, self%gravity, self%steady_force + self%force_mean)
   end function static_load

   !> Samples of a period, whichever way the method makes them.
   elemental integer function samples_per_period(self)
      class(solver_t), intent(in) :: self

      samples_per_period = merge(self%steps_per_period, self%kept_per_period, self%method == method_newmark)
   end function samples_per_period

   !> Whether threads and ranks share the work of a task, which --resume goes on with: a table of many scenes.
   elemental logical function is_shared_task(task)
      !> Code of a task
      integer, intent(in) :: task

      is_shared_task = any(task == [task_campaign, task_threshold])
   end function is_shared_task

end module scene_types
