#!/bin/sh
# SPDX-License-Identifier: MIT
# test_reasons.sh PROGRAMS SOURCE: what cannot be is refused at once, in one line that says why, and no nonsense is printed
# in its place; exit codes and the "pass" of the JSON agree.
programs=$1
set -- "$programs/max_speed" "$2"
. "$2/tests/program.sh"

# nonsense: whether infinite or absurd numbers stand in what was printed.
nonsense() {
    grep -Eq '[-+ ]inf|[-+ ]nan|[0-9]{7,}\.[0-9]+ %|e[+][0-9]+ %' out err
}

for name in max_speed min_energy pareto search_gait sensitivity free_gait ladder heading_tracking min_time_turn path_following; do
    program=$programs/$name
    run --links 2 --quiet
    check "$name: two links cannot swim: exit $code: $(cat err)" \
        eval '[ $code -eq 1 ] && one_line && grep -q "links = 2: two links cannot swim" err && [ ! -s out ]'
done
program=$programs/simulate
run --links 2 --quiet
check "but they can be simulated" [ $code -eq 0 ]

program=$programs/max_speed
if thorough; then
run --links 3 --quiet --over none
check "a baseline that makes no way is compared with nothing" eval '[ $code -eq 0 ] && ! nonsense'
run --quiet --over none --set omega_deg_s=30:60
check "a gain at an omega beyond the limits says so: $(grep -c beyond out)" \
    eval 'grep -q "slower than the paper.s gait (at omega = 104.7 deg/s, beyond the 30 to 60 allowed)" out &&
        grep -q "^Recommended.*equal power takes an omega beyond the 30 to 60 deg/s allowed on 15 of them" out'
run --json --quiet --over none --set omega_deg_s=30:60
check "and the JSON has it: $(number gain omega_deg_s_at_equal_power)" near "$(number gain omega_deg_s_at_equal_power)" 104.7 0.1
run --quiet --over none
check "none does within them" eval '! grep -q beyond out'

# A limit of the power is that of the model asked for, whatever the other one needs.
run --json --quiet --over none --set power_W=0.3
check "power_W = 0.3 on the first-principles model: $code $(cat err)" \
    eval '[ $code -eq 0 ] && near "$(number predicted power_W)" 0.3 1e-6'
# A baseline that cannot hold the course takes nothing from the optimum that can.
run --json --quiet --links 5 --current 0.1,0.1 --set power_W=0.3
check "five links in a cross current that the paper's gait cannot hold: $code $(cat err)" \
    eval '[ $code -eq 0 ] && [ "$(number certificate pass)" = true ] && grep -q "cannot hold the course" out'

# Both optima along delta are tried, and every start tells what it cost.
run --json --quiet --over none --links 20
check "twenty links end in the better of two optima: $(number predicted course_speed_m_s)" \
    eval 'near "$(number predicted course_speed_m_s)" 0.51772 1e-4'
check "iterations of each of $(number starts) starts: $(tr -d "\n\t " <out | grep -o "iterations_of_starts[^]]*" | head -n 1)" \
    [ "$(tr -d '\n\t ' <out | grep -o 'iterations_of_starts[^]]*' | head -n 1 | tr ',' '\n' | grep -c '[0-9]$')" = "$(number starts)" ]
fi

# An auxiliary stage that is not certified leaves the exit code to what was asked for; what was asked for does not, and
# says so on standard error.
run --json --quiet --over none --tol 0.01
check "exit $code and pass $(number certificate pass) agree: $(cat err)" \
    eval '[ $code -eq 3 ] && [ "$(number certificate pass)" = false ] && one_line && grep -q "certificate of the first-pr" err'
tap_done
