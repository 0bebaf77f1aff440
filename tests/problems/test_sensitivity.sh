# SPDX-License-Identifier: MIT
# The program sensitivity as a user meets it. Arguments: the program, the source directory.
. "$2/tests/program.sh"

# slope PARAMETER BLOCK QUANTITY: a number of one parameter in the JSON on standard output; BLOCK slope, solved_again or
# swum, or . for what belongs to none.
slope() {
    awk -v parameter="\"$1\"" -v block="\"$2\"" -v key="\"$3\"" '
        index($0, "\"parameter\"") { mine = index($0, parameter); seen = block == "\".\"" }
        mine && index($0, block) { seen = 1 }
        mine && seen && index($0, key) { sub(/.*:[ \t]*/, ""); sub(/,.*/, ""); print; exit }' out
}

# alike A B SHARE: they differ by at most that share of B.
alike() {
    awk -v a="$1" -v b="$2" -v by="$3" 'BEGIN { d = a - b; exit !(a != "" && b != "" && d * d <= by * by * b * b) }'
}

# ---- The first-principles optimum
run --json --out results
check "the gait's ladder: $(number verdict)" eval 'number verdict | grep -q "wins on all 15"'
check "solved, certified, confirmed by solving again: $(cat err)" [ $code -eq 0 ]
for file in summary.json trajectory.csv shapes.svg mesh.svg convergence.svg report.html; do
    check "--out has $file" [ -s results/$file ]
done
check "its page shows the robots: $(robots results)" [ "$(robots results)" -eq 3 ]
check "summary.json is what --json prints" cmp -s out results/summary.json
for parameter in c_t c_n mu_n m_kg length_m power_W 'theta_max_deg, upper'; do
    for quantity in speed omega delta; do
        check "d $quantity / d $parameter: $(slope "$parameter" slope $quantity), solved again" \
            alike "$(slope "$parameter" slope $quantity)" "$(slope "$parameter" solved_again $quantity)" 1e-4
    done
    check "d speed / d $parameter: $(slope "$parameter" swum speed), swum" \
        alike "$(slope "$parameter" swum speed)" "$(slope "$parameter" slope speed)" 1e-4
done
check "power is that allowed: $(slope power_W slope power)" near "$(slope power_W slope power)" 1 1e-8
check "more drag, less speed" awk -v s="$(slope c_t slope speed)" 'BEGIN { exit !(s < -0.5 && s > -0.8) }'
check "a current along carries the robot: $(slope 'current V_x' slope speed)" near "$(slope 'current V_x' slope speed)" 1 0.01
check "by symmetry one across does nothing to the speed" near "$(slope 'current V_y' slope speed)" 0 1e-9
check "limits that are not reached are told" grep -q '"not_reached":.*omega_deg_s, upper' out
check "the predicted gait, $(number gait_predicted omega_deg_s) deg/s, is that solved again" \
    alike "$(number gait_predicted omega_deg_s)" "$(number gait_solved_again omega_deg_s)" 1e-3
check "and swims as fast: $(number gait_predicted course_speed_m_s)" \
    alike "$(number gait_predicted course_speed_m_s)" "$(number gait_solved_again course_speed_m_s)" 1e-3

if thorough; then
# ---- The control-oriented one, beside what the first-principles model says to it; about to reach a limit
run --quiet --model control --set delta_deg=15:34.95 --set predict_current=0.05,0
check "solved and certified: $(cat err)" [ $code -eq 0 ]
check "every parameter is solved again and swum" eval \
    '[ "$(grep -c "^  solved again" out)" -ge 10 ] && [ "$(grep -c "^  swum, first-principles" out)" = "$(grep -c "^  solved again" out)" ]'
check "the optimum is shown on both models" grep -q '^ *predicted  swum, first-pr.' out
check "the limit that is near is told" grep -q '^WARNING: the slopes hold only up to c_n .*: parameter delta would pass its upper bound' out
check "the prediction is swum" grep -q 'Swum on the first-principles model, it is off by [+-]0\.0' out
check "and where the model errs most is said" grep -q 'swum on the first-principles model are .* differ most for' out
check "parameters of the other model are not there" eval '! grep -q lambda_ out && grep -q "^rot_damping" out'
fi

if thorough; then
run --quiet --robot "$source/problems/robots/head_and_fin.ini"
check "links of their own have no common length: exit $code, $(cat err)" eval '[ $code -eq 0 ] && grep -q "^Without slopes: length_m (the links have lengths of their own)" out'
fi

refuse 'predict_current = fast' --set predict_current=fast
refuse 'power_W = 0' --set power_W=0
tap_done
