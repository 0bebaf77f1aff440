# SPDX-License-Identifier: MIT
# The program free_gait as a user meets it. Arguments: the program, the source directory.
. "$2/tests/program.sh"

# rows N: the N-th of the eight numbers of every motion in the table, from the gait (25) within the limits on.
rows() {
    awk -v n="$1" '/^gait \(25\)|^[0-9] harmonic/ && !/:/ { print $(NF - 8 + n) }' out
}

# no_worse: numbers on standard input, one a line, none below the one before.
no_worse() {
    awk 'NR > 1 && $1 < last - 1e-6 { bad = 1 } { last = $1 } END { exit bad || NR < 3 }'
}

harmonics=3
thorough || harmonics=1
run --quiet --links 5 --set harmonics=$harmonics --out results
check "solved and certified: $(cat err)" [ $code -eq 0 ]
check "every motion on the ladder" [ "$(grep -c '"verdict"' results/summary.json)" -eq $(($(grep -c '"motion"' results/summary.json) + 1)) ]
check "in words: $(grep '^In speed at the power' out)" grep -q "^In speed at the power of the paper's gait the free motion wins .*15, from" out
for file in summary.json trajectory.csv motion.csv series.csv report.html joints.svg link_angles.svg; do
    check "--out has $file" [ -s results/$file ]
done
check "its page shows the robots: $(robots results)" [ "$(robots results)" -eq 3 ]
check "the gait (25) within the limits, without harmonics and with each more, all as fast as the one before" \
    eval '[ "$(rows 1 | wc -l)" = $((harmonics + 2)) ] && rows 1 | no_worse'
check "and so on the first-principles model by simulation" eval 'rows 3 | no_worse'
limit=$(sed -n 's/.*| at most \([0-9.]*\) deg.*/\1/p' out)
check "all within the limit of the links, $limit deg" \
    eval 'rows 5 | awk -v most="$limit" "\$1 > most + 0.02 { bad = 1 } END { exit bad }"'
check "the limit is what the best gait reaches" eval 'grep -q "by theta_max reaches $limit deg" out'
check "the motion is told by joint" grep -q '^joint 1, at the tail' out
check "what it gains on the first-principles model is told" \
    eval 'grep -q "^The free motion, $harmonics harmonics*, on the first-principles model: .* faster than the paper" out'
check "beside what its own model predicted" grep -q '^The first-principles model itself predicted +' out

cp results/summary.json out
gain=$(number gain speed_percent_at_equal_power)
check "faster than the best gait (25) at its power" \
    eval '[ "$(number gain_over_best_gait speed_percent_at_equal_power | cut -c 1)" != - ]'
check "swum as predicted" near "$(number prediction_off_by)" 0 1e-5
check "speed of the collocation is that of the simulation" \
    near "$(number predicted speed_m_s)" "$(number validated speed_m_s)" 1e-5
check "and so is the power" near "$(number predicted power_W)" "$(number validated power_W)" 1e-5
check "the power is that of the paper's gait" near "$(number power_limit_W)" "$(number baseline power_W)" 1e-6
paper=$(number baseline speed_m_s)
check "the gain follows from the speeds" \
    near "$gain" "$(awk -v a="$(number validated speed_m_s)" -v b="$paper" 'BEGIN { print 100 * (a / b - 1) }')" 0.01
check "the motion swum is the series: first joint at the start" eval \
    'near "$(head -n 2 results/motion.csv | tail -n 1 | cut -d , -f 2)" \
        "$(awk -F , "\$1 == 1 { sum += \$4 } END { print sum }" results/series.csv)" 1e-6'

if thorough; then
run --json --model control --links 4 --set harmonics=1 --set link_angle_deg=25
check "on the control-oriented model: $(cat err)" [ $code -eq 0 ]
check "the first-principles result stands beside the prediction" \
    eval '[ "$(number validated model)" = "\"fp\"" ] && [ "$(number simulated_control model)" = "\"control\"" ]'
check "the prediction is kept on its own model" \
    near "$(number predicted speed_m_s)" "$(number simulated_control speed_m_s)" 1e-5
check "the limit asked for" near "$(number link_angle_limit_deg)" 25 1e-9
check "and kept there" near "$(number simulated_control max_link_angle_deg)" 25 0.02
fi

refuse 'harmonics = 0' --set harmonics=0
refuse 'link_angle_deg = 0.5' --set link_angle_deg=0.5
refuse 'joints: ' --model control --set joints=closed-loop
tap_done
