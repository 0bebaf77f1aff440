# SPDX-License-Identifier: MIT
# The program min_energy as a user meets it. Arguments: the program, the source directory.
. "$2/tests/program.sh"

# ---- Both models, at the speed of the paper's gait
run --json --out results
check "solved and certified: $(cat err)" [ $code -eq 0 ]
check "at the paper gait's speed $(number predicted course_speed_m_s)" near "$(number predicted course_speed_m_s)" 0.2293 1e-4
check "less than 92.5 % of its power 0.2646 W: $(number predicted power_W)" \
    awk -v p="$(number predicted power_W)" 'BEGIN { exit !(p < 0.925 * 0.2646) }'
check "simulation confirms the speed" near "$(number predicted speed_m_s)" "$(number validated speed_m_s)" 1e-5
check "simulation confirms the power" near "$(number predicted power_W)" "$(number validated power_W)" 1e-5
check "which is the gain at equal speed" near "$(number gain power_percent_at_equal_speed)" \
    "$(awk -v p="$(number predicted power_W)" 'BEGIN { print 100 * (p / 0.2646 - 1) }')" 0.03
check "the objective is joint work per distance" near "$(number solver objective)" "$(number predicted course_cost_J_m)" 1e-9
check "the control-oriented optimum is beside it" near "$(number control_oriented_optimum delta_deg)" 34.9 0.1
check "both on the ladder" [ "$(grep -c gain_percent_at_equal_power out)" = 30 ]
check "by $(rung paper) % on the paper's model" near "$(rung paper)" "$(number gain speed_percent_at_equal_power)" 1e-3
for file in summary.json trajectory.csv start.svg report.html; do
    check "--out has $file" [ -s results/$file ]
done
check "the problem's name is in the summary" grep -q '"problem":[[:space:]]*"min_energy"' results/summary.json

if thorough; then
run --quiet --model control
check "the table leads with power at equal speed" grep -q "LOSES on the first-principles model: at the paper gait's speed" out
check "and says what was asked for" grep -q 'speed along the course at least 0.2573 m/s (control-oriented model)$' out

# ---- A speed of the user's own, reached or not
run --json --model control --set speed_m_s=0.1
check "the speed asked for: $(number predicted course_speed_m_s)" near "$(number predicted course_speed_m_s)" 0.1 1e-6
run --model control --set speed_m_s=0.5 --set omega_deg_s=30:120
check "a speed out of reach: $(cat err)" \
    eval '[ $code -eq 1 ] && grep -q "speed_m_s = 0.5: within the limits the robot makes 0.43[0-9]* m/s" err'
run --model control --current=-0.3,0
check "no speed to default to: $(cat err)" eval '[ $code -eq 1 ] && grep -q "speed_m_s: its default is that of the paper.s gait, which is left out" err'
run --json --model control --current=-0.3,0 --set speed_m_s=0.05
check "though the robot can make one, and it pays to: $(number predicted course_speed_m_s) m/s over ground" \
    near "$(number predicted course_speed_m_s)" 0.3 5e-3
run --model control --current=-2,0 --set speed_m_s=0.05
check "a head current it cannot stem: $(cat err)" eval '[ $code -eq 1 ] && grep -q "cannot stem it" err'
fi

# ---- Bad input
refuse 'speed_m_s = 0' --set speed_m_s=0
refuse 'speed_m_s = fast' --set speed_m_s=fast
refuse 'omega_deg_s = 90:60' --set omega_deg_s=90:60
tap_done
