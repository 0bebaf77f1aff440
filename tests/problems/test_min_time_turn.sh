# SPDX-License-Identifier: MIT
# The program min_time_turn as a user meets it. Arguments: the program, the source directory.
. "$2/tests/program.sh"

# The motors' speed, far from reached, limits the plan only, which is said.
run --quiet --json --out results --angle 45 --current 0.1,0.1 --set starts=1 --set evaluations=2 --set motor_rate_deg_s=90
check "solved and certified: $(cat err)" [ $code -eq 0 ]
for file in summary.json report.html trajectory.csv heading.svg offset.svg path.svg joints.svg; do
    check "--out has $file" [ -s results/$file ]
done
check "what motors limit is said" grep -q 'plan keeps to what the motors give and how fast they turn' results/report.html
check "no law is worse than its subset: $(subsets weighted_s)" eval 'subsets weighted_s >/dev/null'
steady=$(awk -v rate="$(number first_principles_plan turn_rate_deg_s)" 'BEGIN { print 45 / rate }')
check "the turn takes about as long as steady turning, and the ramps" near "$(number first_principles_plan time_s)" "$steady" 4
heading=$(grep -n '"plan":[[:space:]]*"fp"' out | head -n 1 | cut -d : -f 1)
final=$(tail -n "+$heading" out | grep -A 6 '"validated"' | awk '/final_deg/ { sub(/.*:[ \t]*/, ""); sub(/,.*/, ""); print; exit }')
check "swum blindly on its own model the plan comes to its heading" near "$final" 0 0.5
check "the offset keeps its limit" eval \
    'awk -F , "NR > 1 && (\$7 > 0.0797 || \$7 < -0.0797) { bad = 1 } END { exit bad }" results/trajectory.csv'

if thorough; then
run --quiet --model control --current 0,0 --angle -30 --set starts=1 --set evaluations=1
check "the other way round: $(cat err)" [ $code -eq 0 ]
check "it says what limits the turn" grep -q 'limit of the offset decides\|rate of the offset decides\|decide together' out
check "and how the undulation counts" grep -q 'heading swings with every stroke' out

run --quiet --model control --current 0,0 --angle 45 --set end_m=4,1.5 --set starts=1 --set evaluations=1
check "from pose to pose: $(cat err)" [ $code -eq 0 ]
check "near the end position" grep -q 'control-oriented plan comes within\|plan + feedback comes within' out
fi

run --quiet --model control --angle 90 --set end_m=-4,2 --current 0.4,0 --set starts=1 --set evaluations=1
check "a current too strong: exit 1" [ $code -eq 1 ]
check "said with its numbers: $(cat err)" eval 'one_line && grep -q "current of 0.4 m/s is stronger than the robot" err'

timeout --foreground --preserve-status -s INT 1 "$program" --out interrupted >out 2>err </dev/null
code=$?
check "Ctrl-C is told and leaves nothing: $(cat err)" eval '[ $code -eq 130 ] && one_line && grep -q interrupted err && [ ! -s out ] && [ ! -e interrupted ]'

refuse 'angle_deg = 0' --angle 0
refuse 'band_deg' --set band_deg=0
lost --help
tap_done
