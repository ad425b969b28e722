!> The key table as text: a commented input (--template) and the page of all keys (--keys); and the table of quantities, on that
!> page and as CSV (--quantities).
module key_page
   use input_key, only: allowed_text, key_t, list_kind, sensible_text, text_kind
   use key_table, only: keys, optional_groups, starts_group
   use quantities, only: a_code, kind_names, quantity_t, quantity_table
   use text, only: integer_text, quoted, quoted_words
   implicit none(type, external)
   private

   character(1), parameter :: end_of_line = new_line('a')

   public :: template_text, page_text, quantities_text

contains

   !> A valid input with every key, its unit and its meaning; keys that need not be set are commented out.
   function template_text(group) result(text)
      !> One group, or empty for all
      character(*), intent(in) :: group
      character(:), allocatable :: text
      integer :: i

      text = ''
      do i = 1, size(keys)
         if (len(group) > 0 .and. keys(i)%group /= group) cycle
         if (starts_group(i)) text = text//'&'//trim(keys(i)%group)//end_of_line
         text = text//template_line(keys(i))
         if (starts_group(i + 1)) text = text//'/'//end_of_line//end_of_line
      end do
   end function template_text

   !> Meaning, then the assignment.
   function template_line(key) result(text)
      type(key_t), intent(in) :: key
      character(:), allocatable :: text
      character(:), allocatable :: value, unit

      value = trim(key%default)
      if (key%example /= '') value = trim(key%example)
      if (key%kind == list_kind) value = quoted_words(value, ' ')
      if (key%kind == text_kind .and. len(value) > 0) value = quoted(value)
      unit = trim(key%unit)
      if (unit == '-') unit = ''
      if (len(unit) > 0) unit = ' ['//unit//']'
      text = '   ! '//trim(key%sentence)//unit//' Allowed: '//allowed_text(key)//'.'//end_of_line
      ! An example is there to be run; one of another task would contradict the motion that the template solves.
      if (key%example /= '' .and. all(optional_groups /= key%group) .and. &
          (key%used_when == '' .or. index(key%used_when, 'motion') > 0)) then
         text = text//'   '//trim(key%name)//' = '//value//end_of_line
      else
         text = text//'   ! '//trim(key%name)//' = '//value//end_of_line
      end if
   end function template_line

   !> Page of all keys in Markdown: one table per group, then how the class is found.
   function page_text() result(text)
      character(:), allocatable :: text
      integer :: i

      text = '# Input keys'//end_of_line//end_of_line// &
             'An input is a file of namelist groups. SI units throughout; `!` begins a comment. This page is written by'// &
             end_of_line//'`rattle --keys`, a commented input by `rattle --template`. Every key of every ready scene in'// &
             end_of_line//'this folder is explained here. A number that is allowed but not sensible is taken with a warning'// &
             end_of_line//'in --check and log: it may be in another unit.'//end_of_line
      do i = 1, size(keys)
         if (starts_group(i)) text = text//end_of_line//'## &'//trim(keys(i)%group)//end_of_line//end_of_line// &
                                     '| key | unit | default | allowed | sensible | meaning |'//end_of_line// &
                                     '|---|---|---|---|---|---|'//end_of_line
         text = text//page_row(keys(i))
      end do
      text = text//gear_text()//quantity_rows()//class_text()
   end function page_text

   function page_row(key) result(text)
      type(key_t), intent(in) :: key
      character(:), allocatable :: text
      character(:), allocatable :: default, meaning, sensible

      sensible = sensible_text(key)
      if (len(sensible) == 0) sensible = '-'
      default = trim(key%default)
      if (default == 'required') default = '**required**'
      if (default == '') default = '-'
      meaning = trim(key%sentence)
      if (key%given_by /= '') meaning = meaning//' Follows from `&'//trim(key%given_by)//'` where that stands.'
      if (key%used_when /= '') meaning = meaning//' Only with `'//without_bars(trim(key%used_when), ' or ')//'`.'
      text = '| `'//trim(key%name)//'` | '//trim(key%unit)//' | '//default//' | '//allowed_text(key)//' | '// &
             sensible//' | '//meaning//' |'//end_of_line
   end function page_row

   !> Quantities for people: a table in Markdown.
   function quantity_rows() result(text)
      character(:), allocatable :: text
      type(quantity_t) :: quantity
      integer :: i

      text = end_of_line//'## Quantities'//end_of_line//end_of_line// &
             'What is told of a scene. A summary has words where tables have codes, .true. and .false. where they have 1 and 0.'// &
             end_of_line//end_of_line//'| quantity | unit | told in | meaning |'//end_of_line//'|---|---|---|---|'//end_of_line
      do i = 1, size(quantity_table)
         quantity = quantity_table(i)
         text = text//'| `'//trim(quantity%name)//'` | '//trim(quantity%unit)//' | '//trim(quantity%told_in)//' | '// &
                trim(quantity%meaning)
         if (quantity%kind == a_code) text = text//' '//without_bars(words_with_codes(quantity), '; ')//'.'
         text = text//' |'//end_of_line
      end do
   end function quantity_rows

   !> Words with another separator for each bar, which would end a cell of a table.
   pure function without_bars(words, separator) result(list)
      character(*), intent(in) :: words
      character(*), intent(in) :: separator
      character(:), allocatable :: list
      integer :: k

      list = ''
      do k = 1, len(words)
         if (words(k:k) == '|') then
            list = list//separator
         else
            list = list//words(k:k)
         end if
      end do
   end function without_bars

   !> Quantities for programs, as CSV.
   function quantities_text() result(text)
      character(:), allocatable :: text
      type(quantity_t) :: quantity
      integer :: i

      text = 'name,unit,kind,words,meaning'//end_of_line
      do i = 1, size(quantity_table)
         quantity = quantity_table(i)
         text = text//trim(quantity%name)//','//trim(quantity%unit)//','//trim(kind_names(quantity%kind))//',"'// &
                words_with_codes(quantity)//'","'//trim(quantity%meaning)//'"'//end_of_line
      end do
   end function quantities_text

   !> Words of the codes, each behind its code, a bar between two.
   pure function words_with_codes(quantity) result(words)
      type(quantity_t), intent(in) :: quantity
      character(:), allocatable :: words
      integer :: code, k

      words = ''
      if (quantity%kind /= a_code) return
      code = quantity%first_code
      words = integer_text(code)//' '
      do k = 1, len_trim(quantity%words)
         words = words//quantity%words(k:k)
         if (quantity%words(k:k) /= '|') cycle
         code = code + 1
         words = words//integer_text(code)//' '
      end do
   end function words_with_codes

   !> How the data of a gear pair become a scene: the pair of loose_pair.nml by hand.
   pure function gear_text() result(text)
      character(:), allocatable :: text

      text = end_of_line// &
         '## From a gear to a scene'//end_of_line// &
         end_of_line// &
         '`&gear`, `&shaft` and `&oil` take what a drawing, an engine and a data sheet tell. What follows from '// &
         'them is told by'//end_of_line// &
         '`rattle --check` and stands in the summary; the keys that it replaces are refused. Gear 1 is on the '// &
         'shaft and drives, gear 2'//end_of_line// &
         'is loose. This is the pair of `loose_pair.nml` by hand, in SI units, angles in degrees; index t is the '// &
         'transverse plane:'//end_of_line// &
         end_of_line// &
         '| what | by hand | `loose_pair.nml` |'//end_of_line// &
         '|---|---|---|'//end_of_line// &
         '| base radii | m_t = m_n/cos beta, tan alpha_t = tan alpha_n/cos beta, r_b = m_t z cos(alpha_t)/2 | '// &
         '0.014510, 0.050124 |'//end_of_line// &
         '| centre distance | `centre_distance`, or m_t (z_1 + z_2)/2 | 0.070003 |'//end_of_line// &
         '| working pressure angle | cos alpha_wt = (r_b1 + r_b2)/a | 22.587 |'//end_of_line// &
         '| base helix angle | sin beta_b = sin beta cos alpha_n | 27.065 |'//end_of_line// &
         '| radii of curvature | rho_1 = r_b1 tan alpha_wt + xi, rho_2 = r_b2 tan alpha_wt - xi | 0.0060360, '// &
         '0.020852 |'//end_of_line// &
         '| `contact.radius` R | rho_1 rho_2/((rho_1 + rho_2) cos beta_b) | 0.0052565 |'//end_of_line// &
         '| `contact.length` l | face width times lines in contact/cos beta_b | 0.017968 |'//end_of_line// &
         '| speeds of the flanks | u_1 = omega_1 rho_1, u_2 = omega_1 (z_1/z_2) rho_2 | 0.50566, 0.50566 |'//end_of_line// &
         '| `kinematics.entrainment_speed` U | (u_1 + u_2)/2 | 0.50566 |'//end_of_line// &
         '| `load.mass` m | J_2/(r_b2 cos beta_b)^2 | 0.86081 |'//end_of_line// &
         '| `load.steady_force` Q | T_d/(r_b2 cos beta_b) | 2.2404 |'//end_of_line// &
         '| `load.force_amplitudes` | m cos(beta_b) r_b1 times each angular acceleration | 6.6734, 1.1122, 0.55611 '// &
         '|'//end_of_line// &
         '| `load.frequency` | greatest common divisor of the engine orders times n/60; the engine orders over that divisor '// &
         'are the harmonics `load.force_orders` | 26.667; 1, 2, 3 |'//end_of_line// &
         '| viscosity at T | log10 log10(nu + 0.7) is linear in log10(T + 273.15) through both data; rho = rho_15 '// &
         '- 0.7 (T - 15) | 0.049445 |'//end_of_line// &
         '| alpha at T | ISO/TR 15144-1 by the kind of oil; `oil.pressure_viscosity` overrides it | 1.7734e-8 |'//end_of_line// &
         end_of_line// &
         'What this takes for granted: the shaft is so heavy against the loose gear that its motion is given; the '// &
         'contact stays at one'//end_of_line// &
         'place of the line of action and has as many lines as `contact_lines` says; the drag is that of the mean speed; '// &
         'gravity does nothing'//end_of_line// &
         'to a gear on its bearing (`load.gravity` is 0); oil is there and as warm as `temperature_celsius`. '// &
         'Every acceleration'//end_of_line// &
         'that is told is that of the loose gear relative to the shaft, along the line of action. '// &
         '`backlash` is measured along'//end_of_line// &
         'the normal of the flanks: circumferential backlash at the reference circle times cos(alpha_t) '// &
         'cos(beta_b). A cycle that was '// &
         'measured takes the place'//end_of_line// &
         'of the engine orders: `signal` names its CSV file. With `load.force_scale` campaigns vary all accelerations at '// &
         'once. Without'//end_of_line// &
         '`tooth_stiffness` teeth are rigid: the hot gearbox of `gearbox_map.nml` then has up to ten times '// &
         'the acceleration, and few irregular motions.'//end_of_line// &
         end_of_line// &
         'Several `&gear` are a gearbox: each pair is a scene NAME.GEAR, and one table tells class, film, acceleration, '// &
         'film force and'//end_of_line// &
         'power of all, and what they do together (`gearbox.nml`): the sum of their powers, and two sums of their forces, '// &
         'each along its own'//end_of_line// &
         'line of action. Uncorrelated is the root of the sum of their squares; in phase is the rms of the sum of the '// &
         'force signals, as all pairs'//end_of_line// &
         'follow one shaft: over the periods after which all repeat, or the window of those that were not seen to. In '// &
         'campaigns and'//end_of_line// &
         'thresholds the pair is the first axis (`gearbox_map.nml`). `task = ''threshold''` finds at which speed, oil or '// &
         'drag the motion changes.'//end_of_line// &
         end_of_line// &
         'Which film law? At rest the four films of this pair are 2.86 um (published iso-viscous), 0.23 um '// &
         '(published piezo-viscous) and'//end_of_line// &
         '4.89 and 4.90 um (exact, `model = ''reynolds''`, iso- and piezo-viscous). Where alpha p at the steady '// &
         'film, told by `--check`,'//end_of_line// &
         'is below 0.1, pressure hardly thickens the oil: both Reynolds films are one, and `iso-viscous` with '// &
         '`reynolds` is the law. The'//end_of_line// &
         'published piezo-viscous film is no guide where the pressure is low: for this pair it is off by a factor of '// &
         '20. From'//end_of_line// &
         'alpha p = 0.1 to 1 take `piezo-viscous` with `reynolds`. From 1 on no film of rigid flanks is right: the '// &
         'regime check says so'//end_of_line// &
         'after the motion, and `stiffness_matters` says where teeth would give way. The published laws are there '// &
         'for the paper''s scenes.'//end_of_line
   end function gear_text

   !> How the class is found, and why the limits are what they are.
   pure function class_text() result(text)
      character(:), allocatable :: text

      text = end_of_line//'## How the class is found'//end_of_line//end_of_line// &
         'The window is the last `&spectrum periods` whole periods of the force. a_n is the single-sided amplitude of'// &
         end_of_line//'the acceleration at n times the forcing frequency, for every n that the samples resolve (the'// &
         end_of_line//'summary lists the first 40). The questions are asked in this order:'//end_of_line//end_of_line// &
         '1. subharmonic or irregular, if the share of power off the harmonics exceeds `irregular_limit`. A motion with'// &
         end_of_line//'   the period of the force leaves less than 1e-6 there once it is steady; a doubled period or a chaotic'// &
         end_of_line//'   motion leaves far more than 1 %, so the limit of 0.01 is not delicate. It is subharmonic if it is'// &
         end_of_line//'   known to repeat after 2 to 8 periods (`orbit_period`): because the run went on until it was steady,'// &
      end_of_line//'   or because a stable motion that does was found at its end. Else it is followed for 100 periods beside a'// &
         end_of_line//'   neighbouring motion. It is irregular if the two part for good: their `lyapunov_exponent` is positive'// &
         end_of_line//'   by two standard errors of its blocks of 5 periods, in both halves and in the last quarter; that'// &
         end_of_line//'   is verified if the windows behind the one that is judged are off the harmonics, too. It may settle'// &
         end_of_line//'   later still. Else it is irregular_so_far, never verified: it settles, or no more is known.'// &
         end_of_line// &
         '2. quiet, if the harmonic distortion sqrt(a_2^2 + a_3^2 + ...)/a_1 is below `quiet_limit`. With a tenth of'// &
         end_of_line//'   the static load as amplitude the canonical scenes have 0.25 (idle) and 0.12 (creep), with nine'// &
         end_of_line//'   tenths of it 2.8 and 1.9; 0.35 lies between. Under a force of several harmonics all lines at those'// &
         end_of_line//'   of at least a hundredth of its largest are forced, the others held against them.'//end_of_line// &
         '3. idle, if at least `idle_harmonics` harmonics exceed `harmonic_threshold` times the first (of several forced ones '// &
            'the'// &
         end_of_line//'   largest, which alone of them is counted). The canonical idle scene'// &
         end_of_line//'   has 30 such harmonics, 21 even with the Reynolds film; the canonical creep scene has 12; 20 lies '// &
            'between.'// &
         end_of_line//'4. creep otherwise.'//end_of_line//end_of_line// &
         'A class counts only if it does not change when the time step and the tolerance shrink: see the figure on'// &
         end_of_line//'the tolerance in the README. A scene without motion (below 1e-12 of the load over the mass) is'// &
         end_of_line//'quiet and has no ratios.'//end_of_line//end_of_line// &
         'An impact may be a millionth of a period long and fall between all samples. The extremes in the summary are'// &
         end_of_line//'those of the steps of the solution and of the polynomials between their ends. Where the samples of a'// &
         end_of_line//'motion by the default method miss its lines (their mean or their power is not that of the steps),'// &
         end_of_line//'twice as many are taken, up to 16384 a period, and else the first 40 lines come from integrals over'// &
         end_of_line//'the steps (`harmonics_by_integrals`). `harmonic_count_is_bound` and `harmonic_distortion_is_bound` say '// &
            'where'// &
         end_of_line//'there may be more. `series_coarse` says that the series is coarser than the motion: its extremes'// &
         end_of_line//'stand in rows behind the others, and its samples carry no class. `sampling_sufficient` is false where'// &
         end_of_line//'the harmonics are those of too few samples (Newmark''s method). A class is verified only if the window'// &
         end_of_line//'closes: the integral of the acceleration is the change of velocity, and the work of the film is that'// &
         end_of_line//'of the forces; a window of one period, which cannot tell what is off the harmonics, only if it ends'// &
         end_of_line//'with the films with which it began. Errors are twice the difference from a tighter solution, and'// &
         end_of_line//'what that may be off by, for a coast film the last digit of the drive film too;'// &
         end_of_line//'relative ones are shares of the smaller number. Where the two solutions part, the error says how far'// &
         end_of_line//'such motions lie apart, and is no bound: `verification_text` says by how much the film differs.'// &
         end_of_line//end_of_line// &
         '`model_limit` says where a motion leaves what the model can mean: `too_wide` (the film grows beyond a tenth'// &
         end_of_line//'of the radius, where the parabolic gap of a line contact ends), `too_narrow` (it falls below 1 nm,'// &
         end_of_line//'where no oil film is left), or both; in tables 1, 2 and 3, and 0 within the model.'// &
         end_of_line//end_of_line// &
         '## How the regime is found'//end_of_line//end_of_line// &
         'After the motion the exact pressure of the iso-viscous film is taken over the window. Below'// &
         end_of_line//'alpha p = 0.1 the film is iso-viscous (the Reynolds piezo-viscous load is then 3.2 % higher), below 1'// &
         end_of_line//'piezo-viscous; from 1 on no piezo-viscous film of rigid flanks exists, and neither does where the'// &
         end_of_line//'flanks give way by more than a tenth of the film (4): elastohydrodynamic. `law_contradicted` is'// &
         end_of_line//'true where the law of the scene is not the one of its regime. `pressure_maximum` is p for an'// &
         end_of_line//'iso-viscous law and q of (31) for a piezo-viscous one, left out where q does not exist; the'// &
         end_of_line//'deflection is then that of p, a lower bound.'//end_of_line
   end function class_text

end module key_page
