# SPDX-License-Identifier: MIT
# The program search_gait as a user meets it. Arguments: the program, the source directory.
. "$2/tests/program.sh"

# optimum N KEY: the first value of KEY in the N-th optimum of the JSON on standard output.
optimum() {
    awk -v n="$1" -v key="\"$2\"" 'index($0, "\"starts_that_end_here\"") { seen++ }
        seen == n && index($0, key) { sub(/.*:[ \t]*/, ""); sub(/,.*/, ""); print; exit }' out
}

# ---- The default on the first-principles model: two optima, the better one that of max_speed
run --json --set random_starts=6 --set global_orbits=250 --out results
check "solved and certified: $(cat err)" [ $code -eq 0 ]
check "two optima: $(number optima)" [ "$(number optima)" = 2 ]
check "every start ends at one" [ "$(($(optimum 1 starts_that_end_here) + $(optimum 2 starts_that_end_here)))" = 7 ]
check "the best $(optimum 1 value) m/s" near "$(optimum 1 value)" 0.23856 2e-5
check "at delta $(optimum 1 delta_deg)" near "$(optimum 1 delta_deg)" 51.33 0.02
check "the other $(optimum 2 value) m/s" near "$(optimum 2 value)" 0.23678 2e-5
check "at delta $(optimum 2 delta_deg)" near "$(optimum 2 delta_deg)" 86.6 0.05
check "on the ladder the best: $(optimum 1 verdict)" [ "$(optimum 1 verdict)" = '"wins on all 15' ]
check "and the other: $(optimum 2 verdict)" [ "$(optimum 2 verdict)" = '"wins only on the model it was found on' ]
check "by $(rung paper) % on the paper's model" near "$(rung paper)" "$(number gain speed_percent_at_equal_power)" 1e-3
check "search and collocation agree to $(number largest_difference)" near "$(number largest_difference)" 0 1e-7
check "simulation too" near "$(optimum 1 value)" "$(number validated course_speed_m_s)" 1e-6
check "the power is that of the paper's gait" near "$(optimum 1 power_W)" 0.26464 1e-5
check "its gain is 4.03 %" near "$(number gain speed_percent_at_equal_power)" 4.03 0.01
check "both are stable" [ "$(grep -c '"stable":[[:space:]]*true' out)" = 2 ]
check "the global search ends at the best" [ "$(optimum 1 global_ends_here)" = true ]
for file in summary.json trajectory.csv ridge.svg map.svg shapes.svg thrust.svg report.html; do
    check "--out has $file" [ -s results/$file ]
done
check "its page shows the robots: $(robots results)" [ "$(robots results)" -ge 2 ]
check "nothing else" [ "$(ls -A results | wc -l)" -eq 13 ]
check "summary.json is what --json prints" cmp -s out results/summary.json

check "two processes find what one does" same_by_jobs --set random_starts=3 --set global=none

if thorough; then
# ---- Other goal, model and methods
run --quiet --model control --set goal=economy --set random_starts=2 --set global=none --set local=cobyla
check "thrift on the control-oriented model: $(cat err)" [ $code -eq 0 ]
check "at the paper gait's speed" grep -q 'speed along the course at least 0.2573 m/s$' out
check "one optimum" grep -q '^1 optimum from 3 starts (cobyla: ' out
run --json --model control --current 0.05,0.05 --set random_starts=2 --set global=direct --set global_orbits=100
check "in a current: exit 0: $(cat err)" [ $code -eq 0 ]
check "search and collocation agree to $(number largest_difference)" near "$(number largest_difference)" 0 1e-7
fi

# ---- Currents that cannot be stemmed, bad input
run --current=-0.3,0 --model control --set random_starts=1 --set global=none
check "a head current it cannot stem: $(cat err)" eval '[ $code -eq 1 ] && grep -q "cannot stem it: within the limits" err'
run --current 0,0.5 --model control --set random_starts=1 --set global=none
check "a cross current it cannot stem: $(cat err)" eval '[ $code -eq 1 ] && grep -q "none holds the course" err'
refuse 'joints' --set joints=closed-loop
refuse 'global = annealing' --set global=annealing
refuse 'seed = 0' --set seed=0
refuse 'delta_deg = 50:30' --set delta_deg=50:30
tap_done
