# SPDX-License-Identifier: MIT
# The program sea_trials as a user meets it, in as few trials as show it. Arguments: the program, the source directory.
. "$2/tests/program.sh"

few='--seeds 2 --jobs 1 --set training=1 --set starts=1 --set evaluations=1 --set duration_s=12 --set replan_periods=2
    --set look_ahead_periods=3'
run --json $few --set results=done.txt
check "swum: $(cat err)" [ $code -eq 0 ]
check "one JSON object" eval 'python3 -c "import json, sys; json.load(sys.stdin)" <out'
check "of all laws" eval '[ "$(grep -c "\"told\"" out)" -eq 11 ]'
cp out first
check "no law tuned worse than its subset" python3 - <<'END'
import json, sys
cost = {law["name"]: law.get("training_cost") for law in json.load(open("out"))["laws"]}
pairs = [("P", "P, rate fed forward"), ("P", "PID"), ("P", "P ahead"), ("P, rate fed forward", "PID and rate, ahead"),
         ("PID", "PID and rate, ahead"), ("P ahead", "PID and rate, ahead")]
sys.exit(any(cost[of] > cost[less] * (1 + 1e-6) for less, of in pairs))
END
check "every trial is in the file" eval '[ "$(grep -vc "^#" done.txt)" -eq 22 ]'
head -9 done.txt >half.txt && printf '2 3 0.1' >>half.txt
run --json $few --set results=half.txt --out drawn
check "a run that was cut off goes on to the same" eval '[ $code -eq 0 ] && cmp -s out first'
check "its page draws every law and tells the names" eval '[ "$(grep -c ">receding, \|>PID<\|>robust plan<" drawn/trials.svg)" -eq 5 ] &&
    grep -q "<dt>receding</dt>" drawn/report.html'
run --json $few --set results=half.txt --set spread=0.1
check "trials of other settings are told apart: $(cat err)" eval '[ $code -eq 2 ] && one_line && grep -q "other settings" err'
if thorough; then
run $few --seeds 1 --task path --set current_max_m_s=0.05 --set planner_current=0.02,0 --rung split2
check "a path, on a rung: $(cat err)" eval '[ $code -eq 0 ] && grep -q "^receding, estimating" out && grep -q "rung split2" out'
fi
run $few --seeds 40 --time 2 --set results=late.txt
check "the time given ends it: $(cat err)" eval '[ $code -eq 1 ] && one_line && grep -q "in the time given\|not tuned" err'
refuse 'rung = no_such' --rung no_such
refuse 'must be unknown or VX,VY' --set planner_current=some
refuse 'drop_outs' --set drop_outs=1
tap_done
