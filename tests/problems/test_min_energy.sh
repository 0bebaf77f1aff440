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
run --model control --current=-2,0
check "nor with any speed a current that no gait stems: $(cat err)" eval '[ $code -eq 1 ] && grep -q "cannot stem it" err'
run --model control --current=-2,0 --set speed_m_s=0.05
check "a head current it cannot stem: $(cat err)" eval '[ $code -eq 1 ] && grep -q "cannot stem it" err'
fi

# ---- A way through water that is not uniform: against the current where it is strong the gait is faster, and one gait
# swum through the table itself takes the time and the work that were added up place by place
awk 'BEGIN { print "x_m,y_m,v_x_m_s,v_y_m_s"; for (x = -6; x <= 12; x += 1.5) for (y = -2; y <= 2; y += 1) printf "%g,%g,%.12g,0\n", x, y, -0.08 * sin(x / 2) }' >along.csv
run --json --water along.csv --way '0,0 8,0' --set hotel_W=0.3 --set places=5 --set theta_max_deg=20 --set delta_deg=45 --out way
check "along a way: exit $code, $(cat err)" [ $code -eq 0 ]
check "--out has report, figure and table of the way: $(ls way | tr '\n' ' ')" eval '[ -s way/report.html ] && [ -s way/way.svg ] && [ "$(wc -l <way/way.csv)" -eq 6 ]'
check "the faster, the more there is against it" eval 'awk "/\"along_m\"/ { n++ } /\"current_m_s\"/ { sub(/.*\[[ \t]*/, \"\"); v[n] = \$0 + 0 } /\"omega_deg_s\"/ { sub(/.*:[ \t]*/, \"\"); if (n && !w[n]) w[n] = \$0 + 0 }
    END { for (i = 1; i <= 5; i++) for (j = 1; j <= 5; j++) if (v[i] < v[j] - 0.01 && !(w[i] > w[j])) exit 1; exit n != 5 }" out'
own=$(number adapted work_J) one=$(number one_gait work_J)
check "a gait for each place takes less: $own J beside $one J, the paper's $(number paper work_J) J" \
    awk -v a="$own" -v b="$one" -v c="$(number paper work_J)" 'BEGIN { exit !(a > 0 && a < b && b < c) }'
seconds=$(number one_gait time_s)
"$(dirname "$program")/simulate" --model fp --water along.csv --set start_position_m=-5,0 --duration 54 --quiet --out through \
    --set theta_max_deg=20 --set delta_deg=45 --set "omega_deg_s=$(number one_gait omega_deg_s)" --set output_step_s=0.1 >told 2>&1 || cat told
set -- $(awk -F, 'NR == 1 { for (i = 1; i <= NF; i++) { if ($i ~ /^p_x/) x = i; if ($i ~ /^energy/) e = i } next }
    NR > 2 && was < 0 && $x >= 0 { s = -was / ($x - was); t0 = t + s * ($1 - t); e0 = work + s * ($e - work) }
    NR > 2 && was < 8 && $x >= 8 { s = (8 - was) / ($x - was); print t + s * ($1 - t) - t0, work + s * ($e - work) - e0 + 0.3 * (t + s * ($1 - t) - t0) }
    { was = $x; t = $1; work = $e }' through/trajectory.csv)
check "one gait through the table: ${1-} s, $seconds s by places" awk -v a="${1-}" -v b="$seconds" 'BEGIN { d = a / b - 1; exit !(d * d < 0.01 ^ 2) }'
check "its work: ${2-} J, $one J by places" awk -v a="${2-}" -v b="$one" 'BEGIN { d = a / b - 1; exit !(d * d < 0.01 ^ 2) }'

# A current that turns: who hurries before it does spends less than who heeds each place alone
awk 'BEGIN { print "x_m,y_m,t_s,v_x_m_s,v_y_m_s"; for (x = -1; x <= 9; x += 10) for (y = -1; y <= 1; y += 2) for (t = 0; t <= 60; t += 30)
    printf "%g,%g,%g,%g,0\n", x, y, t, 0.1 - 0.2 * t / 30 }' >tide.csv
run --json --water tide.csv --way '0,0 8,0' --set hotel_W=0.3 --set places=3
check "in a tide: exit $code, $(cat err)" [ $code -eq 0 ]
check "a gait for each place, $(number adapted work_J) J, takes less than one kept, $(number one_gait work_J) J" \
    awk -v a="$(number adapted work_J)" -v b="$(number one_gait work_J)" 'BEGIN { exit !(a > 0 && a < b) }'
check "as a second later costs on the rest of the way: $(number time_price_W) W" awk -v p="$(number time_price_W)" 'BEGIN { exit !(p > 0.05) }'

# ---- Bad input
refuse '--water FILE and --way' --water along.csv
refuse '--water FILE and --way' --way '0,0 8,0'
refuse 'give one of them' --water along.csv --way '0,0 8,0' --current 0.1,0
refuse 'outside of the table' --water along.csv --way '0,0 20,0'
refuse '--continue and --solution' --water along.csv --way '0,0 8,0' --solution here
refuse 'speed_m_s = 0' --set speed_m_s=0
refuse 'speed_m_s = fast' --set speed_m_s=fast
refuse 'omega_deg_s = 90:60' --set omega_deg_s=90:60
tap_done
