# SPDX-License-Identifier: MIT
# The program max_speed as a user meets it. Arguments: the program, the source directory.
. "$2/tests/program.sh"

# ---- The control-oriented model, from the paper's gait and from random starts (an independent implementation)
starts=7
thorough || starts=3
run --model control --json --set random_starts=$starts --out results
check "solved and certified: $(cat err)" [ $code -eq 0 ]
check "speed on the control-oriented model $(number predicted speed_m_s)" near "$(number predicted speed_m_s)" 0.2597 1e-4
check "at $(number predicted power_W) W" near "$(number predicted power_W)" 0.3972 5e-5
check "delta $(number delta_deg)" near "$(number delta_deg)" 34.9 0.1
check "omega $(number omega_deg_s)" near "$(number omega_deg_s)" 104.3 0.1
check "theta_max $(number theta_max_deg) at its bound" near "$(number theta_max_deg)" 20 1e-5
check "from $(number starts_at_optimum) of $((starts + 1)) starts, all but one at most" [ "$(number starts_at_optimum)" -ge $starts ]
check "paper's gait, first-principles, $(number baseline validated)" \
    eval 'sed -n "/\"baseline\"/,\$p" out | sed -n "/\"validated\"/,/}/p" >block &&
          near "$(sed -n "s/.*\"speed_m_s\":[ \t]*\([0-9.e-]*\).*/\1/p" block)" 0.2293 1e-4 &&
          near "$(sed -n "s/.*\"power_W\":[ \t]*\([0-9.e-]*\).*/\1/p" block)" 0.2646 1e-4'
check "a loss on the first-principles model is a negative gain" \
    awk -v g="$(number gain speed_percent_at_equal_power)" 'BEGIN { exit !(g < -1 && g > -20) }'
for file in summary.json trajectory.csv start.svg ladder.svg shapes.svg joints.svg speed.svg power.svg torque.svg \
    portrait.svg mesh.svg convergence.svg report.html solution.moray; do
    check "--out has $file" [ -s results/$file ]
done
check "its page shows the robots: $(robots results)" [ "$(robots results)" -eq 2 ]
check "nothing else" [ "$(ls -A results | wc -l)" -eq 15 ]
check "summary.json is what --json prints" cmp -s out results/summary.json
check "the first line of trajectory.csv names and has units" \
    eval 'head -n 1 results/trajectory.csv | grep -q "^t \[s\],theta \[rad\],p_x \[m\]"'

# ---- The whole pipeline: control-oriented optimum, first-principles optimum, the gait optimised for several models, proof
run --json --jobs 2
check "solved and certified: $(cat err)" [ $code -eq 0 ]
if thorough; then
check "two processes find what one does" same_by_jobs
check "and from random starts" same_by_jobs --model control --over none --set random_starts=9
check "$(grep -c . by_2) lines, $(tr -d '\n\t ' <by_2 | grep -o 'iterations_of_starts[^]]*')" \
    [ "$(tr -d '\n\t ' <by_2 | grep -o 'iterations_of_starts[^]]*' | head -n 1 | tr ',' '\n' | grep -c '[0-9]$')" -eq 10 ]
fi
check "first-principles optimum gains at least 3.9 % at equal power: $(number first_principles_optimum speed_percent_at_equal_power)" \
    awk -v g="$(number first_principles_optimum speed_percent_at_equal_power)" 'BEGIN { exit !(g >= 3.9) }'
check "simulation confirms its speed" near "$(number predicted speed_m_s)" "$(number validated speed_m_s)" 1e-5
check "simulation confirms its power" near "$(number predicted power_W)" "$(number validated power_W)" 1e-5
check "far from hidden effects, in whatever direction they are looked for: $(grep -c '"unseen"' out)" \
    awk '/"unseen"/ { sub(/.*:[ \t]*/, ""); n++; bad = bad || $1 + 0 > 1e-3 } END { exit bad || n != 3 }' out
check "the control-oriented optimum is beside it" near "$(number control_oriented_optimum delta_deg)" 34.9 0.1

# The ladder: the recommended gait's and the others', as an independent code has them.
check "the gait optimised for the ladder is recommended: $(number recommended)" [ "$(number recommended)" = '"ladder_optimum"' ]
check "it wins on all: $(number verdict)" eval 'number verdict | grep -q "\"wins on all 15"'
for model in paper strip consistent; do
    check "by 1.3 % or more on $model: $(rung $model)" awk -v g="$(rung $model)" 'BEGIN { exit !(g >= 1.3) }'
done
check "the worst of these gains is what was maximised: $(number over_gain_percent)" near "$(number over_gain_percent)" "$(rung consistent)" 1e-4
check "simulated at equal power it gains what the ladder says" near "$(number gain speed_percent_at_equal_power)" "$(rung paper)" 1e-3
check "three ladders of 15 rungs" [ "$(grep -c gain_percent_at_equal_power out)" = 45 ]
for expected in paper:4.03 split2:1.09 split3:0.62 split5:0.39 strip:0.26; do
    check "first-principles optimum on ${expected%:*}: $(rung first_principles_optimum ${expected%:*})" \
        near "$(rung first_principles_optimum ${expected%:*})" ${expected#*:} 0.1
done
for expected in paper:-5.07 split2:-4.24 split3:-4.10 split5:-4.03 strip:-3.99; do
    check "control-oriented optimum on ${expected%:*}: $(rung control_oriented_optimum ${expected%:*})" \
        near "$(rung control_oriented_optimum ${expected%:*})" ${expected#*:} 0.1
done
if thorough; then
run --json --set theta_max_deg=1:60
check "first-principles optimum: at least 10.5 % with theta_max free: $(number first_principles_optimum speed_percent_at_equal_power)" \
    eval '[ $code -eq 0 ] && awk -v g="$(number first_principles_optimum speed_percent_at_equal_power)" "BEGIN { exit !(g >= 10.5) }"'
for model in paper strip consistent; do
    check "and the recommended gait 4.0 % or more on $model: $(rung $model)" awk -v g="$(rung $model)" 'BEGIN { exit !(g >= 4) }'
done

run --json --set theta_max_deg=1:60 --set taper=-1:1 --over none
check "at least 11.5 % with a taper as well, larger at the tail: $(number gain speed_percent_at_equal_power)" \
    eval '[ $code -eq 0 ] && awk -v g="$(number gain speed_percent_at_equal_power)" -v t="$(number gait taper)" \
        "BEGIN { exit !(g >= 11.5 && t < -0.1 && t > -0.2) }"'
check "without --over that is what is recommended" [ "$(number recommended)" = '"first_principles_optimum"' ]
fi
refuse 'over = strips: must be none or names of rungs' --over paper,strips
refuse 'paper stands there twice' --over paper,paper
refuse 'paper@0,0.0 stands there twice' --over paper,paper@0,0.0
refuse 'over = strip@0.1,: must be none' --over strip@0.1
refuse 'over = strip@0.1,paper: must be none' --over strip@0.1,paper
printf 'name,c_q\na,1\n' >bad.csv
refuse 'bad.csv:1: column c_q: must be name or what can be identified' --over bad.csv
if thorough; then
printf 'name,c_n [kg/s],current_x\nthin,6,0\nthick,10,0.05\n' >scenarios.csv
run --json --over scenarios.csv
check "a gait for scenarios of a file" eval '[ $code -eq 0 ] && [ "$(grep -c "\"model\":.*\"thi[nc]k*\"" out)" -eq 2 ]'
run --json --over paper,consistent@0.1,0.1
check "a gait for two models in two currents" [ $code -eq 0 ]
gain_on() {
    sed -n '/"scenarios"/,/"over_gain/p; /"ladder"/,$p' out | grep -A 6 "\"model\":[^a-z]*\"$1\"" |
        sed -n 's/.*"gain_percent[a-z_]*":[^-0-9]*\([-0-9.e]*\).*/\1/p' | head -n 1
}
check "the invariant model's gain is that in still water: $(gain_on consistent@0.1,0.1), $(gain_on consistent)" \
    near "$(gain_on consistent@0.1,0.1)" "$(gain_on consistent)" 1e-3
fi

# ---- Other robots: their paper's gait, and what is left out
run --json --links 5 --over none
check "the paper's gait for 5 links has delta = 2 pi/4" near "$(number baseline delta_deg)" 90 1e-9
check "and its name: $(number baseline name)" [ "$(number baseline name)" = "\"the paper's gait for 5 links\"" ]
check "delta may leave 90 deg: $(number gait delta_deg)" [ $code -eq 0 ]
run --links 3 --set power_W=0.02
check "no baseline that makes way: $code $(cat err)" eval '[ $code -eq 0 ] && grep -q "^Left out as a baseline on the first-principles model: the paper.s gait for 3 links" out'
check "and so no ladder" grep -q 'is compared on none of 15' out

if thorough; then
fit='paper fit --set write_ini=FILE'
run --links 6 --over none --current 0,0.05
check "constants tuned for another robot leave the control-oriented optimum out: $(grep '^Left out: the control' out)" \
    eval '[ $code -eq 0 ] && grep "^Left out: the control-oriented optimum: rot_damping" out | grep -q "$fit"'
refuse "$fit" --links 6 --current 0,0.05 --model control
fi

run --quiet --model control --set taper=-0.8
check "the table shows the tapered ends" eval 'grep -q "^theta_max of the tail, by (27) .* 20.* deg" out && grep -q "^taper" out'

if thorough; then
run --quiet
check "the table says plainly that the gait loses" grep -q 'LOSES on the first-principles model' out
check "and puts both models' gains side by side" grep -q 'The control-oriented model itself predicted' out
check "the headline has the range: $(grep ^Recommended out)" \
    grep -q '^Recommended: the gait optimised for the ladder, .* it wins on all 15, from +1.3[0-9] to +3.7[0-9] %\.$' out
fi

# ---- Currents
if thorough; then
run --current 0.1,0.1 --json --over none
check "a current it can stem: exit 0" [ $code -eq 0 ]
run --current 0,0.4 --over none
check "a cross current it cannot stem: $(cat err)" eval '[ $code -eq 1 ] && grep -q "cannot stem it: 0.4000 m/s of it run across" err'
fi
run --current=-0.5,0 --over none
check "a head current it cannot stem: $(cat err)" eval '[ $code -eq 1 ] && grep -q "cannot stem it: 0.5000 m/s of it run against" err'

# ---- Interrupted: ends at the next iteration and says so (timeout sends what Ctrl-C sends; a busy machine needs longer
#      until there is something to leave)
for seconds in 2 4 8 16; do
    timeout --preserve-status -s INT $seconds "$program" --model control --set random_starts=10000 --out interrupted \
        >out 2>err </dev/null
    code=$?
    [ ! -e interrupted ] || break
done
check "Ctrl-C leaves the best solution and says how to go on: $(cat err)" eval '[ $code -eq 130 ] && one_line && [ ! -s out ] &&
    grep -qF "to go on: --continue interrupted/max_speed.iterate" err && [ "$(ls -A interrupted)" = max_speed.iterate ]'
run --json --model control --continue interrupted/max_speed.iterate
check "--continue starts from it alone" eval '[ $code -eq 0 ] && grep -q "\"starts\":.1," out'
sed "1s/control-oriented/of another/" interrupted/max_speed.iterate >other
refuse "is of problem fastest gait, of another" --model control --continue other

# ---- All states, with the controller of the joints: as fast as with the joints on the gait but for what it lags
for links in 5 8; do
    run --model control --links $links --over none --json --quiet
    on_gait=$(number predicted speed_m_s)
    run --model control --links $links --over none --json --quiet --set joints=closed-loop
    check "$links links in closed loop, solved and certified: $(cat err)" [ $code -eq 0 ]
    check "$(number predicted speed_m_s) m/s, on the gait $on_gait" near "$(number predicted speed_m_s)" $on_gait 1e-7
done

# ---- Bad input
printf '[robot]\nlinks = 10\nspeed = 3\n' >unknown.ini
: >file
refuse 'unknown.ini:3' --robot unknown.ini
refuse "no_such.ini" --robot no_such.ini
refuse '--links = 1' --links 1
refuse 'm_kg = -1' --set m_kg=-1
refuse 'c_n = nan' --set c_n=nan
refuse 'delta_deg = 50:30' --set delta_deg=50:30
refuse 'theta_max_deg = 95' --set theta_max_deg=95
refuse 'taper = -2' --set taper=-2:0
refuse 'power_W = 0' --set power_W=0
refuse 'power_w' --set power_w=1
refuse 'scheme = euler' --scheme euler
run --json --out file/below
check "an unwritable --out fails before the solve: $(cat err)" \
    eval '[ $code -eq 2 ] && [ ! -s out ] && [ "$(wc -l <err)" -eq 1 ] && grep -q "file/below" err'
lost --model control
lost --help
tap_done
