# SPDX-License-Identifier: MIT
# The program path_following as a user meets it. Arguments: the program, the source directory.
. "$2/tests/program.sh"

printf 'x_m,y_m\n0,0\n5,0\n9,2\n' >way.csv
run --quiet --json --out results --path way.csv --current=-0.05,0.1 --set start_m=0,0.2 --set starts=1 --set evaluations=2 --set intervals_per_period=4 \
    --set weight_steering=3
check "solved and certified: $(cat err)" [ $code -eq 0 ]
for file in summary.json report.html trajectory.csv across.svg offset.svg path.svg joints.svg; do
    check "--out has $file" [ -s results/$file ]
done
check "the crab angle planned is that of the triangle of velocities" \
    near "$(number crab_planned_deg)" "$(number crab_by_triangle_deg)" 3
# block NAME KEY: of the trial of that name, swum on the first-principles model.
block() {
    awk -v name="\"$1\"" -v key="\"$2\"" 'index($0, name) { seen = 1 } seen && /"validated"/ { inside = 1 }
        inside && index($0, key) { sub(/.*:[ \t]*/, ""); sub(/,.*/, ""); print; exit }' out
}
check "no law is worse than its subset: $(subsets cost)" eval 'subsets cost >/dev/null'
planned=$(number first_principles_plan time_s)
check "swum blindly on its own model the plan takes as long as it says" \
    near "$(block 'first-principles plan' time_s)" "$planned" 0.1
check "and stays on the path" near "$(block 'first-principles plan' settled_largest_m)" 0 0.06
check "receding horizon arrives" near "$(block 'receding, first-principles' time_s)" "$planned" 3
check "faster than real time" eval '[ "$(number times_real_time | cut -d . -f 1)" -ge 1 ]'

run --quiet --model control --path "0,0 6,0" --current=0,0.3 --set starts=1 --set evaluations=1
check "a current too strong: exit 1" [ $code -eq 1 ]
check "said with leg and numbers: $(cat err)" eval 'one_line && grep -q "on leg 1.*0.3 m/s run across.*through the water is 0.2" err'
if thorough; then
run --quiet --model control --path "0,0 5,0 5,5" --set radius_m=0.3 --set tube_m=0.1 --set starts=1 --set evaluations=1 \
    --set receding=no --current 0,0
check "a corner too tight for the tube: exit 1" [ $code -eq 1 ]
check "said with leg and numbers: $(cat err)" eval 'one_line && grep -q "tube_m = 0.1.*behind leg 1.*0.3 m.*deg/s" err'
fi

timeout --foreground --preserve-status -s INT 1 "$program" --out interrupted >out 2>err </dev/null
code=$?
check "Ctrl-C is told and leaves nothing: $(cat err)" eval '[ $code -eq 130 ] && one_line && grep -q interrupted err && [ ! -s out ] && [ ! -e interrupted ]'

refuse 'leg 2 is 1 m long' --path "0,0 5,0 5,1 0,1"
refuse 'at least 2' --path "0,0"
refuse 'nowhere.csv' --path nowhere.csv
tap_done
