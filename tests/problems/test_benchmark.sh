# SPDX-License-Identifier: MIT
# The program benchmark as a user meets it. Arguments: the program, the source directory.
. "$2/tests/program.sh"
ln -s "$program" benchmark # which is what it calls itself
program=$work/benchmark

run --part s1 --json --set repeats=3
check "S1 is measured: $(cat err)" [ $code -eq 0 ]
check "and solved: $(number S1 objective)" near "$(number S1 objective)" -0.603772 1e-5
check "in $(number S1 iterations) iterations" [ "$(number S1 iterations)" -le 12 ]
check "of 960 defects and more" [ "$(number S1 ncon)" -ge 960 ]
check "as with MUMPS beside it" near "$(number with_mumps objective)" "$(number S1 objective)" 1e-9
check "which costs $(number with_mumps total_over_ours) times as much" awk -v r="$(number with_mumps total_over_ours)" \
    'BEGIN { exit !(r > 0) }' # told, not asserted: how fast is the benchmark's matter
check "the pieces make the floor" awk -v a="$(number S1 floor_factorisation_s)" -v b="$(number S1 floor_streaming_s)" \
    -v c="$(number S1 floor_functions_s)" -v f="$(number S1 floor_s)" \
    'BEGIN { d = f - a - b - c; exit !(a > 0 && b > 0 && c > 0 && d * d < 1e-20) }'
check "below which nothing goes: $(number S1 total_over_floor)" awk -v t="$(number S1 total_s)" -v f="$(number S1 floor_s)" \
    -v r="$(number S1 total_over_floor)" 'BEGIN { d = r - t / f; exit !(r > 1 && d * d < 1e-12 * r * r) }'
check "evaluations are function, Jacobian and Hessian" awk -v e="$(number S1 evaluation_s)" -v a="$(number S1 function_s)" \
    -v b="$(number S1 jacobian_s)" -v c="$(number S1 hessian_s)" 'BEGIN { d = e - a - b - c; exit !(d * d < 1e-20) }'

run --part intervals --json --out results --set repeats=1 --set most_intervals=20
check "growth over intervals: $(cat err)" [ $code -eq 0 ]
check "with exponents" [ -n "$(number exponents iteration)" ]
check "of two sizes" [ "$(grep -c '"intervals":[[:space:]]*[0-9]' out)" -eq 4 ]
for file in summary.json growth_intervals.svg; do
    check "--out has $file" [ -s results/$file ]
done
check "the summary is the output" cmp out results/summary.json

if thorough; then
run --part classics --set repeats=1 --set most_intervals=20
check "textbook problems as a table: $(cat err)" [ $code -eq 0 ]
check "those of 20 intervals" eval 'grep -q "^brachistochrone " out && ! grep -q "^bryson-denham " out'
check "all of them solved" eval '! grep -q "NOT SOLVED" out'
fi

run --part states --json --set repeats=1 --set most_states=20
check "growth over states: $(cat err)" [ $code -eq 0 ]
check "at two numbers of them, both solved" [ "$(grep -c '"solved":[[:space:]]*true' out)" -eq 2 ]
check "twice the states, twice the memory at most and some" awk -v e="$(number exponents memory)" 'BEGIN { exit !(e < 2) }'

run --part simulation --json --set repeats=1 --set most_links=5
check "with simulated seconds a second" awk -v r="$(number simulated_s_per_s)" 'BEGIN { exit !(r > 0) }'

refuse 'repeats = 0' --set repeats=0
refuse 'most_links = 4' --set most_links=4
refuse 'part = everything' --part everything
lost --part simulation --set repeats=1 --set most_links=5
for wrong in --links=3 --robot=x; do
    run $wrong
    check "no options of a robot here: $(cat err)" eval '[ $code -eq 2 ] && grep -q "unknown option" err'
done
tap_done
