# SPDX-License-Identifier: MIT
# The program identify as a user meets it: synthetic logs of simulate, estimates, files, bad logs. Arguments: the
# program, the source directory, the program simulate.
. "$2/tests/program.sh"
case $3 in
/*) simulate=$3 ;;
*) simulate=$OLDPWD/$3 ;;
esac

# log FILE ARGUMENTS: a log of five links, of 8 s.
log() {
    file=$1
    shift
    "$simulate" --model fp --links 5 --current 0.05,-0.03 --duration 13 --log "$file" --set log_step_s=0.1 \
        --set noise_position_m=0.004 --set noise_heading_deg=0.5 --set noise_torque_N_m=0.01 "$@" >/dev/null 2>err || cat err
}
log one.csv --set theta_max_deg=25
log two.csv --set theta_max_deg=20 --set delta_deg=60 --set phi0_deg=3 --set start_heading_deg=60 --set log_seed=2
log three.csv --set theta_max_deg=22 --set omega_deg_s=140 --set log_seed=3

# within NAME VALUE: the estimate is within three standard errors of the value: one of 400 is not.
within() {
    awk -v name="\"$1\"" -v want="$2" 'index($0, "\"name\":") && index($0, name) { seen = 1 }
        seen && /"value":/ { value = $2 + 0 } seen && /"standard_error":/ { error = $2 + 0; exit }
        END { exit !(error > 0 && want - value < 3 * error && value - want < 3 * error) }' FS=: out
}

# ---- A robot from two logs, and a third predicted
run --links 5 --logs one.csv,two.csv --validate three.csv --starts 2 --json --out results
check "identified: exit $code, $(cat err)" [ $code -eq 0 ]
for pair in "c_t 0.2638937829" "c_n 8.4" "mu_n 0.3958406744" "current_x 0.05" "current_y -0.03"; do
    check "the interval holds $pair" within $pair
done
check "residuals pass" eval '[ "$(number residuals pass)" = true ]'
check "the held-out run is predicted" eval 'near $(number held_out predicted_speed_m_s) $(number held_out speed_m_s) 0.005'
check "files" eval '[ -s results/robot.ini ] && [ -s results/residuals.csv ] && [ -s results/report.html ] && cmp -s out results/summary.json'
check "the robot is one for every program" eval '"$simulate" --robot results/robot.ini --model fp --duration 5 --json >swum &&
    grep -q "\"links\":.5" swum && grep -q "^c_n = 8\." results/robot.ini'

# ---- The experiment to swim next, and scenarios of what is left open
run --links 5 --logs one.csv --starts 1 --json --out designed --design --set evaluations=18 --set duration_s=8
check "an experiment is told: exit $code" eval '[ $code -eq 0 ] && [ "$(number next_experiment alpha_deg)" != "" ]'
narrower() { # standard errors of all unknowns: as they are, and as they would be
    awk '/"next_experiment"/ { on = 1 } on && /"before":/ { before = $2 + 0 }
        on && /"after":/ { n++; if (!(before > 0 && $2 + 0 < before)) exit 1 } END { if (n != 5) exit 1 }' FS=: out
}
check "with it every interval is narrower" narrower
check "scenarios of two axes" eval '[ "$(wc -l <designed/scenarios.csv)" -eq 6 ] && grep -q "^identified,0.2" designed/scenarios.csv'

# ---- Other names and units, and a model that is too simple
awk -F, 'NR == 1 { gsub(/phi_/, "servo "); gsub(/ \[[^]]*\]/, ""); sub(/p_x/, "cam x"); sub(/p_y/, "cam y"); print; next }
    { $2 *= 1000; $3 *= 1000; for (i = 5; i <= 8; i++) $i *= 57.29577951308232; print }' OFS=, OFMT=%.15g CONVFMT=%.15g one.csv >named.csv
run --links 5 --logs named.csv,two.csv --starts 1 --json
check "names that are not known are told" eval '[ $code -eq 2 ] && grep -q "named.csv:1: no column for phi, number 1" err'
run --links 5 --logs named.csv --starts 1 --json --columns 'phi=servo #,p_x=cam x,p_y=cam y' --units phi=deg,p_x=mm,p_y=mm
check "names and units as told: exit $code, $(cat err)" eval '[ $code -eq 0 ] && within c_n 8.4'
run --links 5 --logs one.csv,two.csv --starts 1 --json --set drag=quadratic
check "another drag is told by its residuals: exit $code" eval '[ $code -eq 3 ] && grep -q "too simple" out && one_line && grep -q "residuals fail" err'

run --links 5 --logs one.csv --starts 1 --set c_t=0.9 --bounds c_t=0.8:2
check "a coefficient at its bound is told: exit $code" grep -q '^At a bound: c_t. The intervals of the others hold only where that is right' out

# ---- Bad logs
spoil() {
    awk "$1" FS=, OFS=, one.csv >bad.csv
}
spoil 'NR == 30 { $1 = 5 } { print }'
refuse 'bad.csv:30: t [s] = 5 s: not after' --links 5 --logs bad.csv
spoil 'NR == 12 { $4 = "north" } { print }'
refuse 'bad.csv:12: heading [rad] = north: not a finite number' --links 5 --logs bad.csv
spoil 'NR > 1 { $5 *= 57.3 } { print }'
refuse 'is it in deg? Say --units phi=deg' --links 5 --logs bad.csv
spoil 'NR > 1 { $2 *= 1000; $3 *= 1000 } { print }'
refuse 'is it in mm or cm?' --links 5 --logs bad.csv
spoil 'NR > 1 { $1 *= 1000 } { print }'
refuse 'rows are 100 s apart, more than 2: is it in ms? Say --units t=ms' --links 5 --logs bad.csv
spoil 'NR > 1 { $4 = "" } { print }'
refuse 'log bad.csv: heading: 0 values are too few for a spline; leave the column out' --links 5 --logs bad.csv
spoil 'NR > 1 { $6 = 0.1 } { print }'
run --links 5 --logs bad.csv --starts 1
check "a joint that does not move is told: exit $code" grep -q 'joint 2 is at 5.73 deg in every row: does it move?' out
spoil 'NR < 12 { print }'
refuse '10 rows; needs 20 at least' --links 5 --logs bad.csv
spoil 'NR == 40 { $0 = $0 ",1" } { print }'
refuse 'bad.csv:40: 13 fields' --links 5 --logs bad.csv
spoil '{ $3 = ""; print }'
refuse 'has no name' --links 5 --logs bad.csv
refuse 'estimate: speed' --links 5 --logs one.csv --estimate c_t,speed
refuse 'no column for phi, number 5' --links 6 --logs one.csv
refuse 'logs: none given' --links 5
refuse 'rot_gain' --links 5 --logs one.csv --estimate rot_gain
run --links 5 --logs one.csv --estimate c_t,c_n --set motor_efficiency=0.8 --quiet --out powered
check "the robot found keeps its motor" grep -q "^motor_efficiency = 0.8" powered/robot.ini

# ---- Unequal links: what moves is the mean, every link in its ratio
fin=$source/problems/robots/head_and_fin.ini
"$simulate" --robot "$fin" --model fp --current 0.05,-0.03 --duration 12 --log unequal.csv --set log_step_s=0.1 \
    --set noise_position_m=0.004 --set noise_heading_deg=0.5 --set noise_torque_N_m=0.01 --json >swum 2>err || cat err
mean() { # KEY: of the nearest equal robot of swum
    awk -v key="\"$1\":" '/nearest_equal_link/ { on = 1 } on && index($0, key) { sub(/.*:[ \t]*/, ""); sub(/,.*/, ""); print; exit }' swum
}
c_t=$(mean c_t) c_n=$(mean c_n)
run --robot "$fin" --logs unequal.csv --estimate c_t,c_n,current --starts 1 --json --out unequal
check "unequal links: exit $code, $(cat err)" [ $code -eq 0 ]
check "c_t = $c_t" within c_t "$c_t"
check "c_n = $c_n" within c_n "$c_n"
found=$(awk '/"name":.*"c_n"/ { on = 1 } on && /"value":/ { sub(/.*:[ \t]*/, ""); sub(/,.*/, ""); print; exit }' out)
"$simulate" --robot unequal/robot.ini --model fp --duration 12 --json >swum 2>err
check "its file is the robot found: c_n = $found, $(mean c_n); $(cat err)" near "$(mean c_n)" "$found" 1e-12
check "fin and head are in their ratio" eval 'grep -q "^fin_c_n = " unequal/robot.ini && [ "$(grep -c "^c_n" unequal/robot.ini)" -eq 0 ] &&
    grep -q "^; mean of the links: c_n = .* +- " unequal/robot.ini'
tap_done
