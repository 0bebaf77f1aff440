# SPDX-License-Identifier: MIT
# The program heading_tracking as a user meets it. Arguments: the program, the source directory.
. "$2/tests/program.sh"

# rms LAW N: validated RMS of the Nth steering in the JSON of LAW.
rms() {
    awk -v law="\"$1\"" -v nth="$2" '/"law":/ { seen = index($0, law) > 0 && ++n == nth; inside = 0 }
        /"validated":/ { inside = 1 }
        seen && inside && /"rms_deg":/ { sub(/.*:[ \t]*/, ""); sub(/,.*/, ""); print; exit }' out
}

# less A B: A is a number below B.
less() {
    awk -v a="$1" -v b="$2" 'BEGIN { exit !(a != "" && b != "" && a + 0 < b + 0) }'
}

short='--horizon 18 --set starts=1 --set evaluations=2'

# ---- Both models, with a gait that is given
run --json --out results $short --current 0.1,0.1 --set reference=steps:6=20 --set theta_max_deg=20 \
    --set omega_deg_s=120 --set delta_deg=40
check "solved and certified: $(cat err)" [ $code -eq 0 ]
check "one JSON object" eval 'python3 -c "import json, sys; json.load(sys.stdin)" <out'
check "summary.json is what --json prints" cmp -s out results/summary.json
check "no law is worse than its subset: $(subsets rms_deg)" eval 'subsets rms_deg >/dev/null'
for file in report.html trajectory.csv heading.svg offset.svg path.svg joints.svg; do
    check "--out has $file" [ -s results/$file ]
done
check "the reference is in the figure" grep -q reference results/heading.svg
check "and the current in that of the path" grep -q 'current, 0.141 m/s' results/path.svg
check "the first-principles plan, $(rms plan 2) deg, beats feedback, $(rms feedback 1) deg" \
    less "$(rms plan 2)" "$(rms feedback 1)"
check "and the control-oriented plan, $(rms plan 1) deg" less "$(rms plan 2)" "$(rms plan 1)"
check "feedback mends that: $(rms 'plan and feedback' 1) deg" less "$(rms 'plan and feedback' 1)" "$(rms plan 1)"
check "replanning on the first-principles model keeps what its plan predicts: $(rms receding 2) deg" \
    near "$(rms receding 2)" "$(rms plan 2)" 0.1
check "blind replanning does not do without knowing: $(rms receding 3) deg" less "$(rms receding 2)" "$(rms receding 3)"
check "three times of replanning" \
    eval '[ "$(sed -n "s/.*\"times_real_time\":[ \t]*\([0-9.]*\).*/\1/p" out | awk "\$1 > 0" | wc -l)" -eq 3 ]'
check "what feeds forward the rate of steps, which have none, is feedback alone: $(rms 'feedback and rate' 1) deg" \
    [ "$(rms 'feedback and rate' 1)" = "$(rms feedback 1)" ]
check "and is not searched" [ "$(number 'feedback and rate' forward_m_s_rad)" = 0 ]
check "a gait that is given is kept" near "$(number first_principles_plan omega_deg_s)" 120 1e-6
check "what limits it is said" grep -q 'A jump of 20 deg takes' out

if thorough; then
# ---- The control-oriented model alone, its gait found
run $short --quiet --model control --set receding=no --set reference=steps:6=20
check "solved and certified: $(cat err)" [ $code -eq 0 ]
check "nothing on standard error" [ ! -s err ]
check "the table has the paper's gait and that found" grep -q "paper's  control opt." out
check "and how it steers" eval 'grep -q "^control-oriented plan " out && grep -q "^PID ahead, rate fed forward " out'
check "and what was tuned" grep -q '^Tuned on the first-principles model' out
check "and a conclusion" grep -q '^First-principles model, same limits, RMS heading error' out
fi

quick="--json --model control --horizon 16 --set receding=no --set starts=1 --set evaluations=1"
if thorough; then
# ---- A CSV file says the same as a text
printf 't_s,heading_deg\n0,0\n8,0\n12,20\n' >ramp.csv
run $quick --set reference=ramps:8=0,12=20
objective=$(number objective)
run $quick --set reference=ramp.csv
check "the same plan from a file: objective $(number objective)" eval '[ $code -eq 0 ] && near "$(number objective)" "$objective" 1e-9'

# ---- Fig. 8: more offset than the paper's is asked of the control-oriented model, as it turns more slowly
run --json --model control --horizon 75 --set receding=no --set starts=1 --set evaluations=1 --set reference=fig8 --out fig8
check "solved and certified: $(cat err)" [ $code -eq 0 ]
check "the paper's offset is a sixth of a: $(number fig8_offset paper_m) m" near "$(number fig8_offset paper_m)" 0.0038074 1e-7
check "found: $(number fig8_offset turning_m) m" near "$(number fig8_offset turning_m)" 0.00406 0.0001
check "and none straight on: $(number fig8_offset straight_m) m" near "$(number fig8_offset straight_m)" 0 0.00005
check "and drawn" [ -s fig8/manoeuvre.svg ]
fi

# ---- What the robot cannot do
run $quick --set reference=ramps:5=0,8=60 --set max_error_deg=5
check "faster than it turns: $(cat err)" eval '[ $code -eq 1 ] && one_line && [ ! -s out ] && grep -q "max_error_deg = 5 cannot be kept: the reference turns at up to 20 deg/s, the robot with its offset at the limit at 7" err'
run $quick --set reference=steps:5=60 --set max_error_deg=20
check "a jump over the tube: $(cat err)" eval '[ $code -eq 1 ] && one_line && grep -q "jumps by 60 deg, and no heading is within 20 deg of both" err'
if thorough; then
run $quick --set reference=ramps:5=0,8=60
check "without a tube the fast reference is told beside the result" \
    eval '[ $code -eq 0 ] && grep -q "turns at up to 20.00 deg/s, beyond that: there the error grows" out'
run $quick --set reference=steps:5=10 --current 0,0.4 --out driven
check "a current that it cannot stem is told" \
    eval '[ $code -eq 0 ] && grep -q "The current of 0.4 m/s is stronger than the robot" out'
check "and drawn though it is across" grep -q 'current, 0.4 m/s' driven/path.svg
fi
run --set power_W=1e-6 --set reference=steps:5=10 --horizon 16 --set starts=1 --set evaluations=1
check "no power: $(cat err)" eval '[ $code -eq 1 ] && one_line && grep -q "power" err'

check "two processes find what one does" same_by_jobs $short --set reference=steps:6=20 --set gait_evaluations=1

# ---- Interrupted
timeout --foreground --preserve-status -s INT 2 "$program" --out interrupted >out 2>err </dev/null
code=$?
check "Ctrl-C is told and leaves nothing: $(cat err)" eval '[ $code -eq 130 ] && one_line && grep -q interrupted err && [ ! -s out ] && [ ! -e interrupted ]'

# ---- Bad input
printf 't_s,heading_deg\n0,0\n1;2\n' >bad.csv
refuse 'paper fit --set write_ini=FILE' --links 6
refuse 'bad.csv:3' --set reference=bad.csv
refuse 'no_such.csv' --set reference=no_such.csv
refuse 'T=H' --set reference=steps:3
refuse 'above 0' --set reference=sine:20,0
refuse 'horizon_s = 0' --set horizon_s=0
refuse 'phi0_max_m = 0' --set phi0_max_m=0
refuse 'scheme = euler' --scheme euler
refuse 'weight_steering' --set weight_steering=-1
refuse 'look_ahead_periods' --set look_ahead_periods=0
refuse 'referense' --set referense=steps:1=2
tap_done
