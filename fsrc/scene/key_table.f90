!> The one table of input keys. Reader, checker, nearest-key suggestion, template, the page of all keys
!> and the keys that a campaign may vary all come from here. fsrc/README.md says how a key is added.
module key_table
   use input_key, only: integer_kind, key_t, list_kind, logical_kind, range_t, real_kind, reals_kind, table_kind, text_kind
   use kinds, only: dp
   use quantities, only: class_words, measurable, recordable
   use scene_types, only: highest_order, words_of_laws, words_of_tasks
   use text, only: edit_distance, lower
   use word_list, only: split_words, word_t
   implicit none(type, external)
   private

   type(range_t), parameter :: any_number = range_t()
   type(range_t), parameter :: positive = range_t(lower=0.0_dp)
   type(range_t), parameter :: poisson = range_t(lower=-1.0_dp, upper=0.5_dp, upper_open=.false.)
   type(range_t), parameter :: not_negative = range_t(lower=0.0_dp, lower_open=.false.)
   type(range_t), parameter :: at_least_1 = range_t(1.0_dp, .false., 1.0e9_dp, .false.)
   type(range_t), parameter :: at_least_8 = range_t(8.0_dp, .false., 1.0e7_dp, .false.)
   ! Numbers of machines, with a margin of a thousand or more on both sides. Within these the powers and products of them that
   ! the film and its motion need stay in the range of the reals; beyond, a scene would report overflow at best.
   real(dp), parameter :: a_length(2) = [1.0e-10_dp, 1.0e7_dp]
   real(dp), parameter :: a_modulus(2) = [1.0_dp, 1.0e30_dp]
   real(dp), parameter :: a_viscosity(2) = [1.0e-10_dp, 1.0e7_dp]
   real(dp), parameter :: a_pressure_viscosity(2) = [1.0e-30_dp, 0.1_dp]
   real(dp), parameter :: a_speed(2) = [1.0e-9_dp, 1.0e6_dp]
   real(dp), parameter :: a_signed_speed(2) = [-1.0e6_dp, 1.0e6_dp]
   real(dp), parameter :: a_mass(2) = [1.0e-10_dp, 1.0e9_dp]
   real(dp), parameter :: a_signed_force(2) = [-1.0e12_dp, 1.0e12_dp]
   real(dp), parameter :: an_amplitude(2) = [0.0_dp, 1.0e12_dp]
   type(range_t), parameter :: an_order = range_t(1.0_dp, .false., real(highest_order, dp), .false.)
   real(dp), parameter :: a_phase(2) = [-1.0e6_dp, 1.0e6_dp]
   real(dp), parameter :: a_scale(2) = [0.0_dp, 1.0e6_dp]
   real(dp), parameter :: a_frequency(2) = [1.0e-7_dp, 1.0e11_dp]
   real(dp), parameter :: a_fall(2) = [0.0_dp, 1.0e8_dp]
   real(dp), parameter :: a_film(2) = [1.0e-16_dp, 1.0e4_dp]
   real(dp), parameter :: a_play(2) = [1.0e-9_dp, 1.0e4_dp]
   type(range_t), parameter :: a_tooth_count = range_t(2.0_dp, .false., 1.0e4_dp, .false.)
   type(range_t), parameter :: a_data_viscosity = range_t(0.31_dp, .false., 1.0e6_dp, .false.)
   real(dp), parameter :: a_stiffness(2) = [1.0_dp, 1.0e20_dp]
   real(dp), parameter :: a_film_ratio(2) = [1.0e-20_dp, 1.0e10_dp]
   real(dp), parameter :: a_squeeze_ratio(2) = [-1.0e20_dp, 1.0e20_dp]
   real(dp), parameter :: a_speed_group(2) = [1.0e-30_dp, 1.0e10_dp]
   type(range_t), parameter :: fraction = range_t(0.0_dp, .true., 1.0_dp, .false.)
   type(range_t), parameter :: below_critical = range_t(0.0_dp, .false., 1.0_dp, .true.)

   ! Keys of the one of three ways in which the drag of a loose gear is known
   character(*), parameter :: of_computed_drag = 'gear.bearing_mean_diameter'
   character(*), parameter :: of_motions = 'scene.task=motion|sweep|campaign|threshold', &
      of_listed_motions = of_motions//' & without shaft.table', &
      of_campaigns = 'scene.task=campaign|threshold', of_thresholds = 'scene.task=threshold', &
      verified = 'scene.task=motion|threshold'

   ! Three parts: a statement has 255 continuation lines at most.
   type(key_t), parameter :: keys_of_gears(*) = [ &
      key_t('scene', 'name', text_kind, '', '', any_number, '', '', &
            'Name of the scene and stem of its output files: letters, digits, . _ - only; absent: the stem of the input file.'), &
      key_t('scene', 'task', text_kind, '', 'motion', any_number, words_of_tasks, '', &
            'What is computed: motion, of film and tooth; film, the oil film at given points; sweep, steady motions along a '// &
            'key, each from the one before; campaign, many motions that differ in some keys; threshold, where they change.'), &
      key_t('contact', 'radius', real_kind, 'm', '', positive, '', '', &
            'Equivalent radius R of the contact; give either this or both radius_1 and radius_2.', example='0.0127', &
            sensible=[1.0e-4_dp, 1.0_dp], computable=a_length, given_by='gear'), &
      key_t('contact', 'radius_1', real_kind, 'm', '', positive, '', '', &
            'Radius of the first tooth flank; 1/R = 1/radius_1 + 1/radius_2 (2).', sensible=[1.0e-4_dp, 10.0_dp], &
            computable=a_length, given_by='gear'), &
      key_t('contact', 'radius_2', real_kind, 'm', '', positive, '', '', &
            'Radius of the second tooth flank.', sensible=[1.0e-4_dp, 10.0_dp], computable=a_length, given_by='gear'), &
      key_t('contact', 'length', real_kind, 'm', 'required', positive, '', '', &
            'Length l of the line contact.', example='0.010', sensible=[1.0e-4_dp, 1.0_dp], computable=a_length, given_by='gear'), &
      key_t('contact', 'young_modulus', real_kind, 'Pa', '205.66e9', positive, '', '', &
            'Young''s modulus E of the teeth, for the deflection (4); with the default Poisson ratio E* is 226 GPa.', &
            sensible=[1.0e8_dp, 1.0e12_dp], computable=a_modulus), &
      key_t('contact', 'poisson_ratio', real_kind, '-', '0.3', poisson, '', '', &
            'Poisson ratio of the teeth; E* = E/(1 - nu^2) (3).'), &
      key_t('contact', 'backlash', real_kind, 'm', '', positive, '', of_motions, &
            'Backlash, the clearance between drive and coast flank along their normal, the sum of both gaps; absent: the drive '// &
            'flank alone.', sensible=[1.0e-6_dp, 1.0e-2_dp], computable=a_play, given_by='gear'), &
      key_t('contact', 'stiffness', real_kind, 'N/m', '', positive, '', of_motions, &
            'Stiffness of a flank with its tooth, in series with the film of each flank; absent: rigid teeth.', &
            sensible=[1.0e5_dp, 1.0e12_dp], computable=a_stiffness, given_by='gear'), &
      key_t('contact', 'damping_ratio', real_kind, '-', '0.0', below_critical, '', of_motions, &
            'Damping ratio zeta of the mass on that stiffness k: a tooth deflected by D carries k D + c D'', c = '// &
            '2 zeta sqrt(k mass); 0: it gives all energy back.', sensible=[0.0_dp, 0.3_dp], given_by='gear'), &
      key_t('contact', 'flattening_included', logical_kind, '', '.true.', any_number, '', of_motions, &
            'Whether that stiffness, or gear.tooth_stiffness, contains the flattening of the flanks, as that of ISO 6336-1 '// &
            'does; else a plane contact, elastic to the depth R, is compressed beside it.'), &
      key_t('lubricant', 'viscosity', real_kind, 'Pa s', 'required', positive, '', '', &
            'Dynamic viscosity eta0 at ambient pressure.', example='0.3', sensible=[1.0e-4_dp, 20.0_dp], computable=a_viscosity, &
            given_by='oil'), &
      key_t('lubricant', 'pressure_viscosity', real_kind, '1/Pa', 'required', positive, '', '', &
            'Barus coefficient alpha (29): the piezo-viscous laws and the regime check need it.', example='2.0e-8', &
            sensible=[1.0e-10_dp, 1.0e-7_dp], computable=a_pressure_viscosity, given_by='oil'), &
      key_t('lubricant', 'viscosity_law', text_kind, '', 'barus', any_number, 'constant barus roelands', '', &
            'How viscosity rises with pressure: barus is eta0 exp(alpha q) (29). constant and roelands are for the '// &
            'elastohydrodynamic law, roelands for a film task with model = numerical, too.', with_gear='roelands'), &
      key_t('kinematics', 'entrainment_speed', real_kind, 'm/s', '', positive, '', '', &
            'Entrainment speed U, the mean of the two surface speeds; give this, rolling_speed, or both surface speeds.', &
            example='1.905', sensible=[1.0e-3_dp, 300.0_dp], computable=a_speed, given_by='gear'), &
      key_t('kinematics', 'rolling_speed', real_kind, 'm/s', '', positive, '', '', &
            'Sum u_r of the two surface speeds, twice the entrainment speed.', sensible=[2.0e-3_dp, 600.0_dp], computable=a_speed, &
            given_by='gear'), &
      key_t('kinematics', 'surface_speed_1', real_kind, 'm/s', '', any_number, '', '', &
            'Surface speed of the first flank; the sum of both must be positive.', sensible=[-300.0_dp, 300.0_dp], &
            computable=a_signed_speed, given_by='gear'), &
      key_t('kinematics', 'surface_speed_2', real_kind, 'm/s', '', any_number, '', '', &
            'Surface speed of the second flank.', sensible=[-300.0_dp, 300.0_dp], computable=a_signed_speed, given_by='gear'), &
      key_t('load', 'mass', real_kind, 'kg', 'required', positive, '', of_motions, &
            'Equivalent mass m of the impacting tooth pair.', example='3.0', sensible=[1.0e-4_dp, 1.0e3_dp], computable=a_mass, &
            given_by='gear'), &
      key_t('load', 'steady_force', real_kind, 'N', 'required', any_number, '', of_motions, &
            'Steady force Q of (34); without a backlash Q + m g must be positive.', example='199.2', &
            sensible=[-1.0e6_dp, 1.0e6_dp], computable=a_signed_force, given_by='gear'), &
      key_t('load', 'force_amplitude', real_kind, 'N', '', not_negative, '', of_motions, &
            'Amplitude F0 of the oscillating force of (34); give this, or force_orders with force_amplitudes.', example='205.7', &
            sensible=[0.0_dp, 1.0e6_dp], computable=an_amplitude, given_by='shaft'), &
      key_t('load', 'force_orders', reals_kind, '-', '', an_order, '', of_motions, &
            'Harmonics of a force of any shape, whole multiples of the frequency, instead of force_amplitude.', given_by='shaft'), &
      key_t('load', 'force_amplitudes', reals_kind, 'N', '', not_negative, '', of_motions, &
            'Amplitude of each harmonic.', sensible=[0.0_dp, 1.0e6_dp], computable=an_amplitude, given_by='shaft'), &
      key_t('load', 'force_phases', reals_kind, 'rad', '', any_number, '', of_motions, &
            'Phase of each harmonic: a cos(2 pi n f t + phase); absent: all 0.', sensible=[-1.0e3_dp, 1.0e3_dp], &
            computable=a_phase, given_by='shaft', unset='0.0'), &
      key_t('load', 'force_mean', real_kind, 'N', '', any_number, '', of_motions, &
            'Mean of the force beside steady_force: added to it, and not multiplied by force_scale; absent: 0.', &
            sensible=[-1.0e6_dp, 1.0e6_dp], computable=a_signed_force), &
      key_t('load', 'signal', text_kind, '', '', any_number, '', of_motions, &
            'CSV file, in the folder of this input, with cycles of the force [N], uniformly sampled; it becomes force_orders '// &
            'and, by its mean, force_mean. A column of time or angle, with its unit, must fit frequency.', &
            given_by='shaft'), &
      key_t('load', 'signal_column', text_kind, '', '', any_number, '', of_motions, &
            'Name of the signal in the header of the file; absent: the only column that is no time or angle.', given_by='shaft'), &
      key_t('load', 'signal_orders', integer_kind, '-', '', an_order, '', of_motions, &
            'Harmonics that are kept of a signal, from the first on; absent: those that hold all but 1e-6 of its power.', &
            given_by='shaft'), &
      key_t('load', 'signal_cycles', integer_kind, '-', '', range_t(1.0_dp, .false., 1.0e6_dp, .false.), '', of_motions, &
            'Cycles in the file, which are averaged; absent: as many as its axis of time or angle spans, one without it.', &
            given_by='shaft'), &
      key_t('load', 'force_scale', real_kind, '-', '1.0', not_negative, '', of_motions, &
            'Multiplies all that oscillates of the force.', sensible=[0.0_dp, 1.0e4_dp], computable=a_scale), &
      key_t('load', 'frequency', real_kind, 'Hz', 'required', positive, '', of_motions, &
            'Frequency f_exc of the oscillating force.', example='600.0', sensible=[0.1_dp, 1.0e5_dp], computable=a_frequency, &
            given_by='shaft'), &
      key_t('load', 'gravity', real_kind, 'm/s2', '9.80665', not_negative, '', of_motions, &
            'Acceleration of free fall g.', sensible=[0.0_dp, 100.0_dp], computable=a_fall, given_by='gear'), &
      key_t('film', 'law', text_kind, '', 'required', any_number, words_of_laws, of_motions, &
            'Film law of the motion: iso-viscous (35), idle rattle; piezo-viscous (37), creep rattle; elastohydrodynamic, '// &
            'where pressure bends the flanks.', example='iso-viscous', with_gear='elastohydrodynamic'), &
      key_t('film', 'model', text_kind, '', 'published', any_number, 'published reynolds numerical closure resolved automatic', &
            '', &
            'published, the paper''s with U as u; reynolds, exact with u = 2U; of the elastohydrodynamic law closure, its '// &
            'default, resolved, in nodes, automatic, either. Film task: absent means the first two, numerical adds finite '// &
            'volumes.', with_gear='reynolds'), &
      key_t('film', 'rupture', text_kind, '', 'half-pi', any_number, 'half-pi solved', &
            'film.law=iso-viscous & film.model=published', &
            'Rupture angle x_e in the squeeze term of (24): half-pi as in (35), or solved from (18) at every evaluation.'), &
      key_t('film', 'rupture_solver', text_kind, '', 'fast', any_number, 'fast successive', 'film.rupture=solved', &
            'Root finder of (18): fast takes a table good to rounding, successive the paper''s substitution; same root.'), &
      key_t('film', 'nodes', integer_kind, '-', '48', range_t(24.0_dp, .false., 128.0_dp, .false.), '', &
            'film.model=resolved|automatic', &
            'Nodes of pressure across a contact: 24, 32, 48, 64 or 128; unless given 48 at an accuracy of 3e-3, '// &
            '64 down to 1e-3, 128 below, 32 at 1e-2.'), &
      key_t('film', 'initial_film', real_kind, 'm', '', positive, '', of_motions, &
            'Film at t = 0; absent: the steady film under Q + m g.', sensible=[1.0e-10_dp, 1.0e-2_dp], computable=a_film), &
      key_t('film', 'initial_velocity', real_kind, 'm/s', '0.0', any_number, '', of_motions, &
            'Film velocity dh/dt at t = 0, negative on approach.', sensible=[-100.0_dp, 100.0_dp], computable=a_signed_speed) &
      ]

   ! What a drawing and a data sheet show: from it keys of the groups above follow.
   type(key_t), parameter :: keys_of_drawings(*) = [ &
      key_t('gear', 'name', text_kind, '', '', any_number, '', of_motions, &
            'Name of the pair, required where several &gear stand: each is solved as a scene NAME.GEAR of its own.'), &
      key_t('gear', 'teeth_1', integer_kind, '-', 'required', a_tooth_count, '', of_motions, &
            'Teeth of the gear on the shaft, which drives.', example='11'), &
      key_t('gear', 'teeth_2', integer_kind, '-', 'required', a_tooth_count, '', of_motions, &
            'Teeth of the loose gear.', example='38'), &
      key_t('gear', 'normal_module', real_kind, 'm', 'required', positive, '', of_motions, &
            'Normal module.', example='2.5e-3', sensible=[3.0e-4_dp, 0.05_dp], computable=a_length), &
      key_t('gear', 'pressure_angle_deg', real_kind, 'deg', '20.0', range_t(1.0_dp, .false., 45.0_dp, .false.), '', of_motions, &
            'Normal pressure angle.', sensible=[10.0_dp, 30.0_dp]), &
      key_t('gear', 'helix_angle_deg', real_kind, 'deg', '0.0', range_t(-80.0_dp, .false., 80.0_dp, .false.), '', of_motions, &
            'Helix angle at the reference circle; 0 is a spur gear.', sensible=[-50.0_dp, 50.0_dp]), &
      key_t('gear', 'face_width', real_kind, 'm', 'required', positive, '', of_motions, &
            'Common face width of both gears.', example='0.016', sensible=[1.0e-3_dp, 0.5_dp], computable=a_length), &
      key_t('gear', 'centre_distance', real_kind, 'm', '', positive, '', of_motions, &
            'Distance of the axes; absent: that of a pair without profile shift.', sensible=[5.0e-3_dp, 2.0_dp], &
            computable=a_length), &
      key_t('gear', 'contact_position', real_kind, 'm', '0.0', any_number, '', of_motions, &
            'Place of the contact on the line of action: 0 is the pitch point, positive towards the root of gear 2.', &
            sensible=[-0.1_dp, 0.1_dp]), &
      key_t('gear', 'contact_lines', real_kind, '-', '1.0', positive, '', of_motions//' & without gear.tip_diameter_1', &
            'Mean length of all lines of contact over that of one as long as the face is wide: the transverse contact ratio, '// &
            'which tip_diameter_1 and tip_diameter_2 give.', sensible=[0.1_dp, 10.0_dp], computable=[1.0e-6_dp, 1.0e6_dp]), &
      key_t('gear', 'tip_diameter_1', real_kind, 'm', '', positive, '', of_motions, &
            'Tip diameter of the gear on the shaft. With both, contact_lines is the transverse contact ratio eps_alpha.', &
            sensible=[5.0e-3_dp, 2.0_dp], computable=a_length), &
      key_t('gear', 'tip_diameter_2', real_kind, 'm', '', positive, '', of_motions, &
            'Tip diameter of the loose gear.', sensible=[5.0e-3_dp, 2.0_dp], computable=a_length), &
      key_t('gear', 'loose_inertia', real_kind, 'kg m2', 'required', positive, '', of_motions, &
            'Moment of inertia of the loose gear about its axis.', example='1.715e-3', sensible=[1.0e-7_dp, 10.0_dp], &
            computable=[1.0e-15_dp, 1.0e12_dp]), &
      key_t('gear', 'drag_torque', real_kind, 'N m', '', any_number, '', &
            of_motions//' & without gear.drag_table & without '//of_computed_drag, &
            'Drag torque on the loose gear, which holds its teeth against the drive flank; without a backlash it is positive. '// &
            'Give this, drag_table or bearing_mean_diameter.', example='0.10', sensible=[-100.0_dp, 100.0_dp], &
            computable=a_signed_force), &
      key_t('gear', 'drag_table', text_kind, '', '', any_number, '', of_motions//' & without '//of_computed_drag, &
            'CSV file, in the folder of this input, with measured drag torques on a full grid: columns speed_rpm (of gear 1), '// &
            'temperature_celsius, torque [N m]; bilinear, refused outside.'), &
      key_t('gear', 'drag_scale', real_kind, '-', '1.0', positive, '', of_computed_drag//'|gear.drag_table', &
            'Multiplies a computed or tabulated drag: fits it to what was measured, spreads it, is varied.', &
            sensible=[0.05_dp, 20.0_dp], computable=[1.0e-9_dp, 1.0e9_dp]), &
      key_t('gear', 'bearing_mean_diameter', real_kind, 'm', '', positive, '', of_motions, &
            'Mean diameter of the bearing of the loose gear. The drag is then computed from it, synchroniser, churning and &oil.', &
            sensible=[2.0e-3_dp, 1.0_dp], computable=a_length), &
      key_t('gear', 'bearing_factor', real_kind, '-', '6.0', positive, '', of_computed_drag//' & without gear.bearing_width', &
            'Factor f_0 of a needle bearing (Palmgren): 6 oil mist, 12 oil bath or grease, 24 jet or vertical.', &
            sensible=[0.5_dp, 50.0_dp], computable=a_scale), &
      key_t('gear', 'bearing_width', real_kind, 'm', '', positive, '', of_computed_drag, &
            'Width of a plain bearing; with bearing_clearance it stands for the needle bearing.', sensible=[1.0e-3_dp, 0.5_dp], &
            computable=a_length), &
      key_t('gear', 'bearing_clearance', real_kind, 'm', '', positive, '', of_computed_drag, &
            'Radial clearance of a plain bearing.', sensible=[1.0e-6_dp, 1.0e-3_dp], computable=a_play), &
      key_t('gear', 'synchroniser_cones', integer_kind, '-', '0', range_t(0.0_dp, .false., 3.0_dp, .false.), '', &
            of_computed_drag, &
            'Gaps of the disengaged synchroniser that shear: 1, 2, 3 of single, double, triple cones; 0: it has none.'), &
      key_t('gear', 'synchroniser_diameter', real_kind, 'm', '', positive, '', of_computed_drag, &
            'Mean diameter of the cones of the synchroniser; required where there are cones.', sensible=[5.0e-3_dp, 1.0_dp], &
            computable=a_length), &
      key_t('gear', 'synchroniser_width', real_kind, 'm', '', positive, '', of_computed_drag, &
            'Width of a cone, along it; required where there are cones.', sensible=[5.0e-4_dp, 0.2_dp], computable=a_length), &
      key_t('gear', 'synchroniser_gap', real_kind, 'm', '', positive, '', of_computed_drag, &
            'Gap of a cone, normal to it, taken as full of oil; required where there are cones.', sensible=[1.0e-5_dp, 5.0e-3_dp], &
            computable=a_play), &
      key_t('gear', 'immersion_depth', real_kind, 'm', '0.0', not_negative, '', of_computed_drag, &
            'Depth of the lowest point of the reference circle below the oil in motion, which is lower than at rest; 0: dry. '// &
            'At most the reference diameter.', sensible=[0.0_dp, 1.0_dp], computable=[0.0_dp, 1.0e7_dp]), &
      key_t('gear', 'own_shaft_ratio', real_kind, '-', '0.0', any_number, '', of_computed_drag, &
            'Speed of the shaft that carries the loose gear over that of gear 1, positive where it turns as the loose gear '// &
            'does: 0 in neutral at rest, z_1/z_2 of the pair that is engaged.', sensible=[-10.0_dp, 10.0_dp], &
            computable=[-1.0e6_dp, 1.0e6_dp]), &
      key_t('gear', 'backlash', real_kind, 'm', '', positive, '', of_motions, &
            'Backlash, the clearance between both flanks along their normal; absent: the drive flank alone.', &
            sensible=[1.0e-6_dp, 1.0e-2_dp], computable=a_play), &
      key_t('gear', 'tooth_stiffness', real_kind, 'N/m2', '', not_negative, '', of_motions, &
            'Stiffness of the teeth for each metre of face width, c'' of ISO 6336-1 (1.4e10 for steel); a flank has it times '// &
            'face_width and contact_lines; 0: rigid.', sensible=[1.0e7_dp, 1.0e12_dp], computable=[0.0_dp, 1.0e20_dp], &
            with_gear='14.0e9'), &
      key_t('gear', 'tooth_damping_ratio', real_kind, '-', '0.0', below_critical, '', of_motions, &
            'Damping ratio of the loose gear on the stiffness of its teeth, as contact.damping_ratio; steel alone has 0.01 to '// &
            '0.03.', sensible=[0.0_dp, 0.3_dp]), &
      key_t('shaft', 'speed_rpm', real_kind, '1/min', 'required', positive, '', of_motions, &
            'Mean speed of the shaft.', example='800.0', sensible=[1.0_dp, 1.0e5_dp], computable=[1.0e-6_dp, 1.0e9_dp]), &
      key_t('shaft', 'table', text_kind, '', '', any_number, '', of_motions, &
            'CSV file, in the folder of this input, with a measured run-up instead of orders, accelerations and phases: '// &
            'columns speed_rpm, acceleration_O [rad/s2] and, if known, phase_O of each order O; linear, refused outside.'), &
      key_t('shaft', 'orders', reals_kind, '-', 'required', positive, '', of_listed_motions, &
            'Engine orders of its angular acceleration, multiples of the speed; an engine of four strokes has halves among them.', &
            example='2.0', sensible=[0.1_dp, 1000.0_dp], computable=[1.0e-3_dp, 1.0e6_dp]), &
      key_t('shaft', 'accelerations', reals_kind, 'rad/s2', '', not_negative, '', of_listed_motions, &
            'Amplitude of the angular acceleration of each engine order; load.force_scale multiplies all of them.', &
            example='600.0', sensible=[0.0_dp, 1.0e5_dp], computable=an_amplitude), &
      key_t('shaft', 'speed_amplitudes', reals_kind, 'rad/s', '', not_negative, '', of_listed_motions, &
            'Amplitude of the angular speed of each engine order instead of accelerations: differentiated at speed_rpm, '// &
            'whatever that is varied to. A signal of a speed becomes this.', sensible=[0.0_dp, 1.0e3_dp], &
            computable=an_amplitude), &
      key_t('shaft', 'phases', reals_kind, 'rad', '', any_number, '', of_listed_motions, &
            'Phase of each engine order: A cos(2 pi order t speed_rpm/60 + phase) is its acceleration or speed; absent: all 0.', &
            sensible=[-1.0e3_dp, 1.0e3_dp], computable=a_phase, unset='0.0'), &
      key_t('shaft', 'signal', text_kind, '', '', any_number, '', of_listed_motions, &
            'CSV file, in the folder of this input, with cycles of the motion of the shaft, uniformly sampled, instead of '// &
            'orders, accelerations (or speed_amplitudes) and phases. Its axis must fit speed_rpm and cycle_revolutions.'), &
      key_t('shaft', 'signal_column', text_kind, '', '', any_number, '', of_listed_motions, &
            'Name of the signal in the header of the file; absent: the only column that is no time or angle.'), &
      key_t('shaft', 'signal_orders', integer_kind, '-', '', an_order, '', of_listed_motions, &
            'Harmonics of the cycle that are kept, from the first on; absent: those that hold all but 1e-6 of its power.'), &
      key_t('shaft', 'signal_cycles', integer_kind, '-', '', range_t(1.0_dp, .false., 1.0e6_dp, .false.), '', of_listed_motions, &
            'Cycles in the file, which are averaged; absent: as many as its axis of time or angle spans, one without it.'), &
      key_t('shaft', 'signal_kind', text_kind, '', 'angular_acceleration', any_number, &
            'angular_acceleration angular_speed angular_speed_rpm', of_listed_motions, &
            'What the signal is: rad/s2, rad/s or 1/min; a speed is differentiated at speed_rpm.'), &
      key_t('shaft', 'cycle_revolutions', integer_kind, '-', '2', range_t(1.0_dp, .false., 1.0e4_dp, .false.), '', &
            of_listed_motions, &
            'Revolutions of the shaft in a cycle of the signal: two of a four-stroke engine.'), &
      key_t('shaft', 'signal_speed_range', reals_kind, '1/min', '', positive, '', of_listed_motions, &
            'Lowest and highest speed for which this motion was measured; a warning says where speeds lie beyond. Absent: a '// &
            'tenth either way of that of the signal, its mean if it is a speed, else speed_rpm.', &
            sensible=[1.0_dp, 1.0e5_dp], computable=[1.0e-6_dp, 1.0e9_dp]), &
      key_t('oil', 'viscosity_40_cst', real_kind, 'mm2/s', 'required', a_data_viscosity, '', '', &
            'Kinematic viscosity at 40 degC, of the data sheet.', example='58.0', sensible=[2.0_dp, 2.0e3_dp]), &
      key_t('oil', 'viscosity_100_cst', real_kind, 'mm2/s', 'required', a_data_viscosity, '', '', &
            'Kinematic viscosity at 100 degC.', example='9.6', sensible=[1.0_dp, 200.0_dp]), &
      key_t('oil', 'density_15', real_kind, 'kg/m3', '870.0', positive, '', '', &
            'Density at 15 degC.', sensible=[600.0_dp, 1500.0_dp], computable=[1.0_dp, 1.0e5_dp]), &
      key_t('oil', 'temperature_celsius', real_kind, 'degC', 'required', range_t(-150.0_dp, .false., 400.0_dp, .false.), '', '', &
            'Temperature of the oil. A warning says where it lies more than 60 K beyond 40 or 100 degC, or the oil is '// &
            'thinner than 2 mm2/s.', example='40.0', sensible=[-50.0_dp, 200.0_dp]), &
      key_t('oil', 'base', text_kind, '', 'mineral', any_number, 'mineral pao polyglycol', '', &
            'Kind of base oil, by which pressure raises its viscosity (ISO/TR 15144-1).'), &
      key_t('oil', 'pressure_viscosity', real_kind, '1/Pa', '', positive, '', '', &
            'Barus coefficient alpha; absent: that of its kind at this temperature.', sensible=[1.0e-10_dp, 1.0e-7_dp], &
            computable=a_pressure_viscosity), &
      key_t('oil', 'volume', real_kind, 'm3', '2.0e-3', positive, '', of_motions, &
            'Volume of the oil that gears churn, where a drag is computed.', sensible=[1.0e-4_dp, 0.1_dp], &
            computable=[1.0e-12_dp, 1.0e6_dp]) &
      ]

   type(key_t), parameter :: keys_of_tasks(*) = [ &
      key_t('solver', 'method', text_kind, '', 'taylor', any_number, 'newmark taylor', of_motions, &
            'Time integration: taylor (error-controlled series, implicit where the film is stiff) or the paper''s newmark.'), &
      key_t('solver', 'accuracy', real_kind, '-', '1.0e-8', range_t(1.0e-12_dp, .false., 1.0e-2_dp, .false.), '', &
            'solver.method=taylor', &
            'Relative accuracy of the film that an error-controlled method aims at; of model = resolved 3e-3 unless given, '// &
            '1e-5 at least, and that of the peak of the acceleration; of films it is three times that.'), &
      key_t('solver', 'until', text_kind, '', 'periods', any_number, 'periods steady', 'scene.task=motion|campaign|threshold', &
            'End of the run: all periods, or as soon as the motion is verified to repeat; then one period of the motion is the '// &
            'window.', with_gear='steady'), &
      key_t('solver', 'periods', integer_kind, '-', '120', at_least_1, '', of_motions, &
            'Periods of the force that are solved (the most, until steady); at least those of the spectrum window.'), &
      key_t('solver', 'starts', integer_kind, '-', '', range_t(1.0_dp, .false., 1.0e4_dp, .false.), '', &
            'scene.task=motion|campaign|threshold & solver.method=taylor', &
            'Starts that the motions of a scene are looked for from; absent: 29 of a motion, 3 of a campaign or threshold. 1: '// &
            'its own start alone.'), &
      key_t('solver', 'time_limit', real_kind, 's', '', positive, '', 'scene.task=motion', &
            'Wall time after which the run ends cleanly, to be resumed; of films in nodes, what is learned of the motion too; '// &
            'absent: none.'), &
      key_t('solver', 'samples_per_period', integer_kind, '-', '512', at_least_8, '', 'solver.method=taylor', &
            'Samples of a period that are kept; the steps are chosen by the accuracy.', with_gear='4096'), &
      key_t('solver', 'iteration', text_kind, '', 'newton', any_number, 'newton successive', 'solver.method=newmark', &
            'Iteration in a step: newton with the exact slopes of the film, or the paper''s successive one.'), &
      key_t('solver', 'predictor', text_kind, '', 'extrapolated', any_number, 'extrapolated previous', 'solver.method=newmark', &
            'First iterate of a step: extrapolated with the present acceleration, or the previous state as it stands.'), &
      key_t('solver', 'tolerance', real_kind, 'm', '1.0e-14', positive, '', 'solver.method=newmark', &
            'Tolerance eps of (36) on the film between two iterations; it lets through an acceleration error of about 4 '// &
            'eps/dt^2.'), &
      key_t('solver', 'iteration_limit', integer_kind, '-', '100', range_t(1.0_dp, .false., 1.0e5_dp, .false.), '', &
            'solver.method=newmark', &
            'Most iterations in a step; a step that needs more ends the scene as not_converged.'), &
      key_t('solver', 'steps_per_period', integer_kind, '-', '512', at_least_8, '', 'solver.method=newmark', &
            'Time steps in one period of the force; every one is a sample.'), &
      key_t('spectrum', 'periods', integer_kind, '-', '16', at_least_1, '', of_motions, &
            'Whole periods at the end of the run that spectrum, extremes and regime are taken from.'), &
      key_t('spectrum', 'harmonic_threshold', real_kind, '-', '0.01', fraction, '', of_motions, &
            'A harmonic counts if it exceeds this share of the first (of several forced ones: of the largest).'), &
      key_t('spectrum', 'idle_harmonics', integer_kind, '-', '20', at_least_1, '', of_motions, &
            'From this many harmonics on the motion is idle rattle.'), &
      key_t('spectrum', 'quiet_limit', real_kind, '-', '0.35', positive, '', of_motions, &
            'Below this harmonic distortion the motion is quiet.'), &
      key_t('spectrum', 'irregular_limit', real_kind, '-', '0.01', fraction, '', of_motions, &
            'Above this share of power off the harmonics of the force the motion is irregular, or subharmonic if it repeats.'), &
      key_t('spectrum', 'impact_limit', real_kind, '-', '1.5', range_t(lower=1.0_dp), '', of_motions, &
            'A largest load of a film above this multiple of the largest force |F + m g| is an impact.'), &
      key_t('spectrum', 'verify', logical_kind, '', '.true.', any_number, '', verified, &
            'Whether the scene is solved again tighter, to say how large its errors are and whether its class is verified.'), &
      key_t('spectrum', 'verification_tolerance', real_kind, '-', '0.01', fraction, '', verified, &
            'Largest error of the film, relative, with which the class of a regular motion is verified.'), &
      key_t('points', 'film_ratios', reals_kind, '-', '', positive, '', 'scene.task=film', &
            'Film ratios h* = h0/R, one or more; give these or film_ratio_range.', example='70.0e-6', computable=a_film_ratio), &
      key_t('points', 'film_ratio_range', reals_kind, '-', '', positive, '', 'scene.task=film', &
            'First and last film ratio and their count, logarithmically spaced.', computable=a_film_ratio), &
      key_t('points', 'squeeze_ratios', reals_kind, '-', '0.0', any_number, '', 'scene.task=film', &
            'Squeeze-roll speed ratios w* = w/u, negative on approach; give these or squeeze_ratio_range.', &
            computable=a_squeeze_ratio), &
      key_t('points', 'squeeze_ratio_range', reals_kind, '-', '', any_number, '', 'scene.task=film', &
            'First and last squeeze-roll ratio and their count, linearly spaced.', computable=a_squeeze_ratio), &
      key_t('points', 'speed_groups', reals_kind, '-', '', positive, '', 'scene.task=film', &
            'Speed groups u* = u eta0 alpha/R; absent: formed from &kinematics as speed_reading says.', computable=a_speed_group), &
      key_t('points', 'speed_group_range', reals_kind, '-', '', positive, '', 'scene.task=film', &
            'First and last speed group and their count, logarithmically spaced.', computable=a_speed_group), &
      key_t('points', 'speed_reading', text_kind, '', 'mean', any_number, 'mean sum', 'scene.task=film', &
            'Which speed of &kinematics is the u of u* and w*: mean is the entrainment speed U, sum is u_r = 2U.'), &
      key_t('points', 'compute', list_kind, '', 'rupture load stiffness damping pressure', any_number, &
            'rupture load stiffness damping pressure limits profile', 'scene.task=film', &
            'What is computed of every point; profile writes pressures over x to NAME.profiles.rattle.'), &
      key_t('points', 'profile_nodes', integer_kind, '-', '201', range_t(3.0_dp, .false., 1.0e6_dp, .false.), '', &
            'scene.task=film', &
            'Points of a pressure profile between inlet and rupture.'), &
      key_t('points', 'cells', integer_kind, '-', '4096', range_t(32.0_dp, .false., 1.0e6_dp, .false.), '', &
            'scene.task=film & film.model=numerical', &
            'Cells of the finite-volume solution, an even number; its load is extrapolated from these and half of these.'), &
      key_t('sweep', 'key', text_kind, '', 'required', any_number, &
            'frequency force_amplitude steady_force entrainment_speed force_scale backlash stiffness '// &
            'speed_rpm drag_torque drag_scale temperature_celsius', &
            'scene.task=sweep', &
            'What is swept: a key of &load or &contact, the entrainment speed; or a key of &shaft, &gear or &oil.', &
            example='frequency'), &
      key_t('sweep', 'first', real_kind, 'of key', 'required', any_number, '', 'scene.task=sweep', &
            'Value that the sweep begins with.', example='200.0'), &
      key_t('sweep', 'last', real_kind, 'of key', 'required', any_number, '', 'scene.task=sweep', &
            'Value at which it turns or ends.', example='800.0'), &
      key_t('sweep', 'count', integer_kind, '-', '101', range_t(2.0_dp, .false., 1.0e6_dp, .false.), '', 'scene.task=sweep', &
            'Values from first to last.'), &
      key_t('sweep', 'spacing', text_kind, '', 'linear', any_number, 'linear logarithmic', 'scene.task=sweep', &
            'How the values are spaced.'), &
      key_t('sweep', 'turn', logical_kind, '', '.true.', any_number, '', 'scene.task=sweep', &
            'Whether the sweep goes back to first, so that jumps and hysteresis show.'), &
      key_t('campaign', 'vary', list_kind, '', '', any_number, '', of_campaigns, &
            'Keys that are varied, as ''group.key'': vary(1) = ..., vary(2) = ...; any numeric key of a motion.'), &
      key_t('campaign', 'scale', list_kind, '', '', any_number, 'linear logarithmic', of_campaigns, &
            'How the range of each varied key is divided; absent: linear.', unset='linear'), &
      key_t('campaign', 'first', reals_kind, 'of key', '', any_number, '', of_campaigns, &
            'First value of each varied key.'), &
      key_t('campaign', 'last', reals_kind, 'of key', '', any_number, '', of_campaigns, &
            'Last value of each varied key.'), &
      key_t('campaign', 'count', reals_kind, '-', '', at_least_1, '', of_campaigns, &
            'Values of each varied key on a grid, both ends included.'), &
      key_t('campaign', 'values', table_kind, 'of key', '', any_number, '', of_campaigns, &
            'Values of a varied key instead of a range: values(:, 1) = ..., all of vary(1).'), &
      key_t('campaign', 'sample', text_kind, '', 'grid', any_number, 'grid sobol', of_campaigns, &
            'Which scenes: the full grid, or a sample of the ranges.'), &
      key_t('campaign', 'size', integer_kind, '-', '', at_least_1, '', 'campaign.sample=sobol', &
            'Scenes of a sample.'), &
      key_t('campaign', 'seed', integer_kind, '-', '1', range_t(0.0_dp, .false., 2.0e9_dp, .false.), '', 'campaign.sample=sobol', &
            'Seed of a sample: the same seed gives the same scenes everywhere.'), &
      key_t('campaign', 'csv', text_kind, '', '', any_number, '', of_campaigns, &
            'Table of scenes instead of vary: a CSV file, found from the folder of this input, whose header names group.key, '// &
            'one scene per row.'), &
      key_t('campaign', 'record', list_kind, '', &
            'film_minimum film_maximum acceleration_minimum acceleration_maximum '// &
            'natural_frequency damping_ratio harmonic_count harmonic_count_is_bound harmonic_distortion '// &
            'harmonic_distortion_is_bound irregular_fraction irregular_fraction_is_bound reversals_per_period '// &
            'rattle_class motions loudest_class loudest_acceleration_rms sampling_sufficient film_regime alpha_p_maximum '// &
            'model_limit harmonics', &
            any_number, recordable, 'scene.task=campaign', &
            'Recorded of every scene beside number, varied keys and status; verified (1 or 0) solves each again, tighter.'), &
      key_t('campaign', 'neighbours', logical_kind, '', '.true.', any_number, '', 'scene.task=campaign & campaign.sample=grid', &
            'Whether motions found at a point of a grid are handed as starts to its neighbours that have none like them.'), &
      key_t('campaign', 'samples_per_period', integer_kind, '-', '256', range_t(32.0_dp, .false., 16384.0_dp, .false.), '', &
            of_campaigns, &
            'Samples of a period that a scene is judged by; where they are too few, its steps are integrated over.'), &
      key_t('campaign', 'allow_invalid', logical_kind, '', '.false.', any_number, '', of_campaigns, &
            'Whether scenes that are not valid are recorded as such; else they stop the campaign before it begins.'), &
      key_t('campaign', 'confirm_size', logical_kind, '', '.false.', any_number, '', of_campaigns, &
            'Must be true for more than ten million scenes.'), &
      key_t('campaign', 'part', integer_kind, '-', '1', at_least_1, '', of_campaigns, &
            'Which part of the campaign, or of the traces of thresholds, this run solves, as a job of an array.'), &
      key_t('campaign', 'parts', integer_kind, '-', '1', at_least_1, '', of_campaigns, &
            'Parts that the campaign, or the traces of thresholds, are divided into.'), &
      key_t('threshold', 'key', text_kind, '', 'required', any_number, '', of_thresholds, &
            'Key whose thresholds are found, as ''group.key'': any numeric key of a motion but those that &campaign varies.', &
            example='load.force_amplitude'), &
      key_t('threshold', 'first', real_kind, 'of key', 'required', any_number, '', of_thresholds, &
            'Least value of the key.', example='5.0'), &
      key_t('threshold', 'last', real_kind, 'of key', 'required', any_number, '', of_thresholds, &
            'Largest value of the key.', example='455.0'), &
      key_t('threshold', 'scale', text_kind, '', 'linear', any_number, 'linear logarithmic', of_thresholds, &
            'How the range is divided, by the scan and by halves.'), &
      key_t('threshold', 'count', integer_kind, '-', '33', range_t(2.0_dp, .false., 1.0e6_dp, .false.), '', of_thresholds, &
            'Values of the scan, both ends included; two changes between neighbours that cancel each other stay unseen.'), &
      key_t('threshold', 'tolerance', real_kind, '-', '1.0e-4', range_t(1.0e-9_dp, .false., 0.5_dp, .false.), '', of_thresholds, &
            'Largest width of a bracket, a share of the range from first to last (of its logarithm where the scale is); '// &
            'integers to the next one.'), &
      key_t('threshold', 'criterion', text_kind, '', 'class', any_number, 'class impacts '//class_words//measurable, &
            of_thresholds, &
            'What changes at a threshold: the class, whether it is the one named, whether there are impacts, a code or flag, '// &
            'or a quantity passing level.'), &
      key_t('threshold', 'level', real_kind, 'of it', '', any_number, '', of_thresholds, &
            'What a quantity that is a number has to reach.'), &
      key_t('output', 'directory', text_kind, '', 'results', any_number, '', '', &
            'Folder of the output files, relative to the working directory; made if missing.'), &
      key_t('output', 'series', logical_kind, '', '.true.', any_number, '', 'scene.task=motion', &
            'Whether the time series is written to NAME.rattle.'), &
      key_t('output', 'columns', list_kind, '', 'time applied_force film_thickness acceleration', any_number, &
            'time applied_force film_thickness squeeze_velocity acceleration film_load coast_film coast_load gear_position', &
            'scene.task=motion', &
            'Columns of the time series, any of these, in this order; those of the coast flank with contact.backlash only.'), &
      key_t('output', 'stride', integer_kind, '-', '1', at_least_1, '', 'scene.task=motion', &
            'Every how many steps a row is written; 1 writes all.'), &
      key_t('output', 'profiles', logical_kind, '', '.false.', any_number, '', 'scene.task=motion & film.model=resolved', &
            'Whether pressure, film and viscosity over the contact are written to NAME.profiles.rattle, at the largest load of '// &
            'each impact, of a flank without any at its largest load.'), &
      key_t('output', 'profile_phases', reals_kind, '-', '', range_t(0.0_dp, .true., 1.0_dp, .false.), '', &
            'scene.task=motion & film.model=resolved', &
            'Phases of the last period at which they are written instead, each larger than the one before.'), &
      key_t('output', 'profile_count', integer_kind, '-', '', range_t(1.0_dp, .false., 4096.0_dp, .false.), '', &
            'scene.task=motion & film.model=resolved', &
            'Number of equally spaced phases of the last period at which they are written instead, for moving pictures.'), &
      key_t('output', 'overwrite', logical_kind, '', '.false.', any_number, '', '', &
            'Whether output files of an earlier run may be replaced; files of any other kind never are.') &
      ]

   type(key_t), parameter, public :: keys(*) = [keys_of_gears, keys_of_drawings, keys_of_tasks]

   !> Groups that need not stand; where one does, its required keys are required.
   character(*), parameter, public :: optional_groups(3) = [character(5) :: 'gear', 'shaft', 'oil']

   public :: choice_word, find_key, find_swept_key, key_name, known_group, starts_group, nearest_key, nearest_group, resembles_group

contains

   !> Position of a key in the table, 0 if there is none.
   pure integer function find_key(name)
      !> As group.name, lower case
      character(*), intent(in) :: name
      integer :: dot

      dot = index(name, '.')
      do find_key = 1, size(keys)
         if (keys(find_key)%group == name(:dot - 1) .and. keys(find_key)%name == name(dot + 1:)) return
      end do
      find_key = 0
   end function find_key

   !> Position of the key that a sweep follows.
   pure integer function find_swept_key(name)
      !> Its name, a choice of &sweep key
      character(*), intent(in) :: name

      do find_swept_key = 1, size(keys)
         if (keys(find_swept_key)%name == name) return
      end do
   end function find_swept_key

   !> Name of a key as 'group.name'.
   pure function key_name(position) result(name)
      !> Position in the key table
      integer, intent(in) :: position
      character(:), allocatable :: name

      name = trim(keys(position)%group)//'.'//trim(keys(position)%name)
   end function key_name

   !> The word of a choice, from its code: its position among the choices of the key.
   pure function choice_word(name, code) result(word)
      !> As group.name
      character(*), intent(in) :: name
      !> Position, from 1
      integer, intent(in) :: code
      character(:), allocatable :: word
      type(word_t), allocatable :: words(:)

      allocate (words, source=split_words(keys(find_key(name))%choices))
      word = words(code)%text
   end function choice_word

   !> Whether any key lives in this group.
   pure logical function known_group(group)
      !> Namelist group, lower case
      character(*), intent(in) :: group

      known_group = any(keys%group == group)
   end function known_group

   !> Whether a key is the first of its group; the place behind the last key counts as one.
   pure logical function starts_group(position)
      !> From 1 to one more than there are keys
      integer, intent(in) :: position

      starts_group = position == 1 .or. position == size(keys) + 1
      if (.not. starts_group) starts_group = keys(position)%group /= keys(position - 1)%group
   end function starts_group

   !> Hint for a misspelt key: the nearest one of its own group, or the group where the key lives.
   pure function nearest_key(group, name) result(hint)
      !> Known group
      character(*), intent(in) :: group
      !> Name that is not in it
      character(*), intent(in) :: name
      character(:), allocatable :: hint
      integer, parameter :: shortest_word = 4
      integer :: i, distance, best, nearest

      best = huge(1)
      nearest = 0
      do i = 1, size(keys)
         if (keys(i)%name == name) then
            hint = 'this key belongs to &'//trim(keys(i)%group)
            return
         end if
         if (keys(i)%group /= group) cycle
         distance = edit_distance(name(:min(len(name), 40)), trim(keys(i)%name))
         ! A word of a longer name, such as modul, is near it, whatever else is to be added.
         if (len(name) >= shortest_word .and. index(keys(i)%name, name) > 0) distance = min(distance, 2)
         if (distance >= best) cycle
         best = distance
         nearest = i
      end do
      hint = 'the nearest known key is '//trim(keys(nearest)%name)
   end function nearest_key

   !> Known group nearest to a misspelt one.
   pure function nearest_group(group) result(nearest)
      !> Name that is not a group
      character(*), intent(in) :: group
      character(:), allocatable :: nearest
      integer :: i, distance, best

      best = huge(1)
      nearest = ''
      do i = 1, size(keys)
         if (.not. starts_group(i)) cycle
         distance = edit_distance(group(:min(len(group), 40)), trim(keys(i)%group))
         if (distance >= best) cycle
         best = distance
         nearest = trim(keys(i)%group)
      end do
   end function nearest_group

   !> Whether a word is a group, or one misspelt.
   pure logical function resembles_group(word)
      !> In any case
      character(*), intent(in) :: word
      integer, parameter :: short_word = 3

      resembles_group = len(word) > 0 .and. &
                        edit_distance(lower(word), nearest_group(lower(word))) <= merge(1, 2, len(word) <= short_word)
   end function resembles_group

end module key_table
