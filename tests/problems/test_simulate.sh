# SPDX-License-Identifier: MIT
# The program simulate: numbers of the paper's gait, schedules, files, bad input. Arguments: the program, the source
# directory.
. "$2/tests/program.sh"
simulate=$program
root=$source

# run ARGUMENTS: with JSON; leaves $code, out and err.
run() {
    "$simulate" "$@" --json >out 2>err </dev/null
    code=$?
}

# value KEY: the number, or the first of the numbers, that stands at the key where it occurs last.
value() {
    awk -v key="\"$1\":" '$1 == key { gsub(/[[,]/, "", $2); found = $2 } END { print found }' out
}

# second KEY: the second number of a pair.
second() {
    awk -v key="\"$1\":" '$1 == key { gsub(/[],]/, "", $3); print $3 }' out
}

# agree WHAT IS WANT TOLERANCE
agree() {
    check "$1 = $2, expected $3 within $4" awk -v is="$2" -v want="$3" -v by="$4" \
        'BEGIN { exit !(is != "" && want != "" && is - want <= by && want - is <= by) }'
}

# found KEY WANT TOLERANCE
found() {
    agree "$1" "$(value "$1")" "$2" "$3"
}

# The paper's gait in still water: an independent implementation.
run --model fp
check "the paper's gait runs: $(cat err)" [ $code -eq 0 ]
found speed_m_s 0.2293 0.0001
found power_W 0.2646 0.0001
found alpha_deg 13.681 0.001
found periods 5 0
agree "peak torque in the last periods" "$(awk '/peak_torque/ { print $2 + 0; exit }' out)" 0.403 0.0005
steps=$(value steps)

# Motors, a battery, unequal links.
run --model fp --set duration_s=20 --set hotel_W=1 --set motor_idle_W=0.1 --set battery_Wh=20
joints=$(value joints_or_motors_W)
check "without motors the power is that of the joints: $(cat err)" [ "$(awk '/"power_W"/ { print $2; exit }' out)" = "$joints," ]
agree "whole power" "$(value power_W)" "$(awk "BEGIN { print $joints + 1.9 }")" 1e-5
agree "endurance" "$(value endurance_h)" "$(awk "BEGIN { print 20 / ($joints + 1.9) }")" 1e-4
run --model fp --set duration_s=20 --set motor_efficiency=0.5 --set motor_speed_deg_s=0,60 --set motor_torque_N_m=0.7,0
check "power is at the motors: $(cat err)" grep -q '"power_is":.*"mean power at the motors"' out
check "half the efficiency and nothing back takes more than twice, $(value joints_or_motors_W) W, of $joints W" \
    awk -v is="$(value joints_or_motors_W)" -v was="$joints" 'BEGIN { exit !(is > 2 * was) }'
check "how near the motors come to their line: $(value motor_load)" \
    awk -v load="$(value motor_load)" 'BEGIN { exit !(load > 0.5 && load < 1.5) }'
run --model control --robot "$root/problems/robots/head_and_fin.ini" --set duration_s=5
check "the control-oriented model swims the nearest equal robot: $(cat err)" grep -q nearest_equal_link out
check "and says so" eval '"$simulate" --robot "$root/problems/robots/head_and_fin.ini" --set duration_s=5 | grep -q "9 unequal links (the control-oriented model swims the nearest equal robot"'
run --model fp --integrator paper
found speed_m_s 0.2293 0.001
found rtol 1e-4 0
check "the paper's integrator takes fewer steps, $(value steps), than $steps" [ "$(value steps)" -lt "$steps" ]
run --model fp --integrator tr-bdf2 --set rtol=1e-7 --set atol=1e-7 --duration 46 --output-step 1
found speed_m_s 0.2293 0.0001
run
found speed_m_s 0.2574 0.0002
found power_W 0.397 0.0005
found a_m 0.045 0.00001
power=$(value power_W)

# The same gait in other words.
run --set alpha_deg=13.680805733026748 --set theta_max_deg=20
found power_W "$power" 1e-9
printf '\357\273\277# the same\r\n t_s , alpha_deg ,omega_deg_s\r\n\r\n0,13.680805733026748,\r\n' >same.csv
run --schedule same.csv
check "a schedule with blanks, a comment and an empty cell: $(cat err)" [ $code -eq 0 ]
found power_W "$power" 1e-9
printf '[simulation]\nschedule = same.csv\nduration_s = 60\n[gait]\ndelta_deg = 40\n' >swim.ini
run --robot swim.ini
found power_W "$power" 1e-9
run --output-step 10
found power_W "$power" 1e-6
agree "peak force, sampled between the output steps" "$(awk '/peak_force/ { print $2 + 0; exit }' out)" 1.614 0.005

# Currents, headings, positions: the control-oriented model knows the current through the relative velocity alone.
# A table of a uniform current swims as that current does; where it ends, the run does.
awk 'BEGIN { print "x_m,y_m,v_x_m_s,v_y_m_s"; for (x = -9; x <= 12; x += 7) for (y = -9; y <= 12; y += 7) print x "," y ",0.1,0.05" }' >uniform.csv
run --model fp --current 0.1,0.05 --duration 8 --out by_current
power=$(value power_W) along=$(value course_speed_m_s) speed=$(value speed_m_s)
run --model fp --water uniform.csv --duration 8 --out by_table
check "swims in a table: $(cat err)" [ $code -eq 0 ]
found power_W "$power" 1e-9
found course_speed_m_s "$along" 1e-9
found speed_m_s "$speed" 1e-9
found current_m_s 0.1 1e-9
check "and says in what" eval '"$simulate" --water uniform.csv --set rot_gain=40 --set rot_damping=1.15 --duration 1 |
    grep -qF "water of uniform.csv, current (0.1, 0.05) m/s in the mean of the table below"'
for kind in current table; do # what the water does to each link, as the animation shows it
    grep -o '"force":[^]]*' by_$kind/report.html >force_$kind
done
check "the drag of the animation is that of the current: $(wc -c <force_table) bytes" eval '[ -s force_table ] && cmp -s force_current force_table'
check "trajectory.csv has the current" eval 'head -1 by_table/trajectory.csv | grep -qF "V_x [m/s],V_y [m/s]" && ! grep -q "V_x" by_current/trajectory.csv'
# A shear: the speed through the water is that over ground less the mean of the currents that were met.
awk 'BEGIN { print "x_m,y_m,v_x_m_s,v_y_m_s"; for (x = -9; x <= 12; x += 7) for (y = -9; y <= 12; y += 7) print x "," y "," 0.05 * y ",0" }' >shear.csv
run --model fp --water shear.csv --duration 12 --set start_heading_deg=90 --set output_step_s=0.02 --out sheared
check "in a shear: $(cat err)" [ $code -eq 0 ]
set -- "$(awk '/"from_s"/ { print $2 + 0; exit }' out)" "$(awk '/"v_x_m_s"/ { print $2 + 0; exit }' out)" "$(awk '/"v_y_m_s"/ { print $2 + 0; exit }' out)"
found speed_m_s "$(awk -F, -v from="$1" -v vx="$2" -v vy="$3" 'NR == 1 { for (i = 1; i <= NF; i++) if ($i ~ /^V_x/) c = i; next }
    $1 >= from { if (n++) sum += ($1 - t) * ($c + last) / 2; t = $1; last = $c; begin = n == 1 ? $1 : begin }
    END { w = vx - sum / (t - begin); print sqrt(w * w + vy * vy) }' sheared/trajectory.csv)" 1e-4
run --model fp --water uniform.csv --duration 60
check "leaves the table: $(cat err)" eval '[ $code -eq 2 ] && grep -q "outside of the table: x -9 to 12, y -9 to 12 m" err'
run --water uniform.csv --current 0.1,0
check "two currents: $(cat err)" eval '[ $code -eq 2 ] && grep -q "give one of them" err'
run --water nowhere.csv
check "no table: $(cat err)" eval '[ $code -eq 2 ] && grep -q "water nowhere.csv: cannot be opened" err'
run --current 0.1,0.05 --course 90
found speed_m_s 0.2574 0.0005
found course_speed_m_s 0.05 0.01
run --set start_heading_deg=90 --set start_position_m=1,2 --duration 30
distance=$(second end_position_m)
found end_position_m 1 1e-9
found heading_deg 90 1e-6
run --duration 30
agree "distance swum at another heading" "$distance" "$(awk -v d="$(value end_position_m)" 'BEGIN { print d + 2 }')" 1e-5

# The manoeuvre of Sec. V-C: mean heading before t = 130 s, position at 190 s.
turn() {
    printf 't_s,%s\n40,%s\n70,0\n130,%s\n160,0\n' "$1" "$2" "$3" >turn.csv
    run --current 0.1,0.1 --set theta_max_deg=10 --schedule turn.csv --model "$4" --duration 130
    found heading_deg "$5" 0.3
    run --current 0.1,0.1 --set theta_max_deg=10 --schedule turn.csv --model "$4" --duration 190
    found end_position_m "$6" 0.1
    agree "p_y at 190 s" "$(second end_position_m)" "$7" 0.1
}
run --current 0.1,0.1 --schedule "$root/problems/schedules/turning.csv" --duration 190 --model fp
found end_position_m 38.27 0.1
turn phi0_deg -1.1401 1.1401 fp 26.2 38.27 23.22
turn phi0_m 0.0038063 -0.0038063 control 25.3 39.10 23.27
turn phi0_deg -1.1401 1.1401 control 25.3 39.10 23.27

# What a short run is measured over.
run --duration 2
found periods 0 0
found from_s 0 0
run --schedule turn.csv --duration 45
found periods 1 0
found from_s 42 1e-12
run --schedule turn.csv --duration 20
check "gaits after the end do not count" [ "$(grep -c '"t_s"' out)" -eq 1 ]
run --schedule turn.csv
found duration_s 220 0

# Files.
run --duration 3.03 --output-step 0.5 --model fp --links 5 --out files
check "every file: $(ls files | tr '\n' ' ')" eval \
    '[ "$(ls -A files | tr "\n" " ")" = "effort.svg heading.svg path.svg report.html run.ini summary.json trajectory.csv velocity.svg " ]'
check "trajectory.csv: a line of names, one an output step, one at the end" [ "$(wc -l <files/trajectory.csv)" -eq 9 ]
check "trajectory.csv: pose, work, states, efforts" eval \
    'head -1 files/trajectory.csv | tr , "\n" | wc -l | grep -qx 22 && grep -q "energy \[J\],theta_1 \[rad\]" files/trajectory.csv'
check "trajectory.csv ends at the end" eval 'tail -1 files/trajectory.csv | grep -q "^3.03,"'
check "summary.json is what --json prints" cmp files/summary.json out
"$simulate" --duration 1 >out 2>err
check "the table names unit and integrator" eval 'grep -q "peak joint force .* N$" out && grep -q "explicit, rtol 1e-10" out'

# schedule LINES: writes s.csv.
schedule() {
    printf "$1" >s.csv
}

refuse 'paper fit --set write_ini=FILE' --links 6 --current 0,0.1
refuse 'paper fit --set write_ini=FILE' --set m_kg=0.5 --set phi0_m=0.01
refuse 'theta_max_deg = 20: give one of them' --set theta_max_deg=20 --set a_m=0.04
refuse 'alpha_deg = 10 contradicts a_m = 0.04' --set alpha_deg=10 --set a_m=0.04
refuse 'phi0_deg = 1 contradicts phi0_m = 0.01' --set phi0_deg=1 --set phi0_m=0.01
refuse 'phi0_deg = 1: is mapped in the ratio' --set phi0_deg=1 --set theta_max_deg=0
refuse 'a_m = 0.2: no link-angle amplitude below 90 deg' --set a_m=0.2 --model fp
refuse 'omega_deg_s = -3: must be' --set omega_deg_s=-3
refuse '--duration = 0: must be' --duration 0
refuse 'samples; there may be' --output-step 1e-9
refuse '--integrator = euler: must be explicit, tr-bdf2 or paper' --integrator euler
refuse '--intervals: simulate has no use for it' --intervals 30
refuse 'schedule none.csv: cannot be opened' --schedule none.csv
refuse 'schedule .: cannot be read' --schedule .
schedule ''
refuse 's.csv: needs a line of names' --schedule s.csv
schedule 't_s,delta_deg\n'
refuse 's.csv: needs a line of names' --schedule s.csv
schedule 'delta_deg\n40\n'
refuse 's.csv:1: a schedule needs a column t_s' --schedule s.csv
schedule 't_s,delta_dg\n0,40\n'
refuse 's.csv:1: unknown key delta_dg; did you mean delta_deg?' --schedule s.csv
schedule 't_s,a_m,t_s\n0,1,2\n'
refuse 's.csv:1: column t_s is named twice' --schedule s.csv
schedule 't_s,delta_deg\n0,40\n10\n'
refuse 's.csv:3: 1 field, but line 1 names 2 columns' --schedule s.csv
schedule 't_s,delta_deg\n0,40,3\n'
refuse 's.csv:2: 3 fields, but line 1 names 2 columns' --schedule s.csv
schedule 't_s,delta_deg\n0,wide\n'
refuse 's.csv:2: delta_deg = wide: must be a number from -180 to 180 deg' --schedule s.csv
schedule 't_s,delta_deg\n,40\n'
refuse 's.csv:2: t_s is empty' --schedule s.csv
schedule 't_s,delta_deg\n5,40\n5,30\n'
refuse 's.csv:3: t_s = 5: must lie after that of the line before, 5' --schedule s.csv
schedule 't_s,delta_deg\n0,40\n0,30\n'
refuse 's.csv:3: t_s = 0: must lie after that of the line before, 0' --schedule s.csv
schedule 't_s,a_m,alpha_deg\n0,0.04,10\n'
refuse 's.csv:2: alpha_deg = 10 contradicts a_m = 0.04' --schedule s.csv
if command -v script >/dev/null; then # a terminal
    script -qec "'$program' --duration 1 --out seen" /dev/null >on_terminal </dev/null
    check "on a terminal the page is told" grep -q "simulate: seen/report.html shows it" on_terminal
    script -qec "'$program' --duration 1 --quiet --out seen" /dev/null >on_terminal </dev/null
    check "unless it is to be quiet" eval '! grep -q "shows it" on_terminal'
fi
lost --duration 1
lost --duration 1 --json
tap_done
