#!/bin/sh
# Draws the pictures of the README pages anew, as input/pictures. Usage: draw_pictures.sh PROGRAM PYTHON FOLDER
# FOLDER takes the results and what else is drawn of them; newmark_outcomes stands beside PROGRAM.
set -eu
program=$1
python=$2
runs=$3
pictures=input/pictures

solve() {
    "$program" --quiet --overwrite --output "$runs" "$@"
}
plot() {
    figure=$1
    shift
    "$python" scripts/plot.py "$figure" --overwrite --output "$runs" "$@"
}
keep() {
    cp "$runs/$1" "$pictures/$2"
}

mkdir -p "$pictures" "$runs"
solve input/idle.nml input/creep.nml input/creep_false_harmonic.nml
solve --set solver.tolerance=1e-12 --set scene.name=no_line input/creep_false_harmonic.nml
for case in idle_loose=1e-7 idle_tight=1e-12; do
    solve --set solver.iteration=successive --set solver.steps_per_period=64 --set solver.tolerance=${case#*=} \
        --set scene.name=${case%=*} input/idle.nml
done
plot motion --overlay --figures 8,9 "$runs/idle.rattle" "$runs/creep.rattle"
plot tolerance --false-harmonic "$runs/creep_false_harmonic.rattle" "$runs/no_line.rattle" \
    --false-reversals "$runs/idle_loose.rattle" "$runs/idle_tight.rattle"
keep figure_08_09_overlay.png idle_and_creep.png
keep tolerance.png tolerance.png

solve --set scene.name=map_idle input/map.nml
solve --set scene.name=map_creep --set film.law=piezo-viscous input/map.nml
for map in map_idle map_creep; do
    plot campaign "$runs/$map.rattle"
    keep ${map}_map_rattle_class.png $map.png
done

solve input/gearbox_map.nml
solve input/gearbox_threshold.nml
plot campaign --together --thresholds "$runs/gearbox_threshold.rattle" "$runs/gearbox_map.rattle"
keep gearbox_map_pairs.png gearbox.png
plot threshold "$runs/gearbox_threshold.rattle"
keep threshold_gearbox_threshold.png gearbox_threshold.png

solve input/sweep.nml
plot sweep "$runs/sweep.rattle"
keep sweep_sweep.png sweep.png
solve --set scene.name=idle_teeth input/stiff_or_not.nml
solve --set scene.name=creep_teeth --set film.law=piezo-viscous input/stiff_or_not.nml
solve --set scene.name=idle_teeth_exact --set film.model=reynolds input/stiff_or_not.nml
plot sweep --panels acceleration,harmonics --mark '1.4e8=steel tooth' \
    "$runs/idle_teeth.rattle" "$runs/creep_teeth.rattle" "$runs/idle_teeth_exact.rattle"
keep sweep_overlay.png stiff_or_not.png

solve --set film.model=resolved --set film.nodes=64 --set output.profiles=true input/drive_rattle.nml
plot motion --figures profiles --width 130 "$runs/drive_rattle.rattle"
keep profiles_drive_rattle.png profiles.png
solve input/loose_gear.nml
plot motion --figures flanks "$runs/loose_gear.rattle"
plot motion --animate "$runs/loose_gear.rattle"
keep flanks_loose_gear.png loose_gear.png
keep motion_loose_gear.gif loose_gear.gif
"$python" scripts/countermeasures.py --overwrite --output "$runs" input/rattling_gear.nml > "$runs/countermeasures.txt"
keep countermeasures_rattling_gear.png countermeasures.png
solve input/gearbox_run_up.nml
plot sweep "$runs/gearbox_run_up.rattle"
keep sweep_gearbox_run_up.png run_up.png
plot waterfall "$runs/gearbox_run_up.rattle"
keep waterfall_gearbox_run_up.png run_up_waterfall.png
solve input/gearbox_orders.nml
plot orders "$runs/gearbox_orders.rattle"
keep orders_gearbox_orders.4th.png orders.png

cp input/gearbox_tolerances.nml "$runs"
"$python" scripts/sensitivity.py design --overwrite "$runs/gearbox_tolerances.nml"
solve "$runs/gearbox_tolerances_design.nml"
"$python" scripts/sensitivity.py --overwrite --output "$runs" "$runs/gearbox_tolerances_design.rattle" > "$runs/sensitivity.txt"
keep sensitivity_gearbox_tolerances_design.png sensitivity.png
"$(dirname "$program")/newmark_outcomes" input/idle.nml input/creep.nml input/creep_false_harmonic.nml > "$runs/newmark_outcomes.csv"
"$python" tests/stress/newmark_outcome_map.py "$runs/newmark_outcomes.csv" $pictures/newmark_outcomes.png
plot film-fit > "$runs/film_fit.txt"
keep film_fit.png film_fit.png
for result in gearbox_map loose_gear; do
    "$python" scripts/report.py --overwrite --output "$runs/$result.html" "$runs/$result.rattle"
done
