# SPDX-License-Identifier: MIT
# The program pareto as a user meets it. Arguments: the program, the source directory.
. "$2/tests/program.sh"

# column FILE NUMBER: the column of a CSV file without its head.
column() {
    tail -n +2 "$1" | cut -d , -f "$2"
}

# rising, falling: the numbers on standard input, one a line, each at least or at most the one before.
rising() {
    awk 'NR > 1 && $1 < last - 1e-5 * last { bad = 1 } { last = $1 } END { exit bad || NR < 2 }'
}
falling() {
    awk 'NR > 1 && $1 > last + 1e-5 * last { bad = 1 } { last = $1 } END { exit bad || NR < 2 }'
}

run --quiet --set points=6 --set theta_max_deg=1:60 --out results
check "solved and certified: $(cat err)" [ $code -eq 0 ]
check "every gait on the ladder" [ "$(grep -c '"gain_percent_at_equal_power"' results/summary.json)" -eq \
    $((15 * $(grep -c '"speed_per_power_m_s_W"' results/summary.json))) ]
check "and the fronts in words" [ "$(grep -c 'gaits win on all models; gains from' out)" -ge 4 ]
for file in summary.json report.html front.svg omega.svg delta.svg theta_max.svg taper.svg; do
    check "--out has $file" [ -s results/$file ]
done
check "its page shows the robots: $(robots results)" [ "$(robots results)" -eq 4 ]
for model in control fp; do
    for kind in lateral eel free; do
        csv=results/${model}_$kind.csv
        check "$model, $kind: power falls" eval 'column $csv 1 | falling'
        check "$model, $kind: and with it the speed" eval 'column $csv 2 | falling'
        check "$model, $kind: a watt is worth ever more, the front is concave" eval 'column $csv 7 | rising'
        check "$model, $kind: omega leaves its bound and falls" eval 'column $csv 4 | falling'
        check "$model, $kind: it begins at the bound" near "$(column $csv 4 | head -n 1)" 360 1e-3
    done
    check "$model: delta rises while omega is at its bound" \
        eval 'awk -F , "NR > 1 && \$4 > 359.9 { print \$5 }" results/${model}_lateral.csv | rising'
    check "$model: the fastest eel is slower than the fastest lateral gait, and cheaper" eval \
        '[ "$(paste -d , results/${model}_lateral.csv results/${model}_eel.csv |
            awk -F , "NR == 2 { print (\$11 < \$2 && \$10 / \$11 < \$1 / \$2) }")" = 1 ]'
    check "$model: a free taper does no worse than none" \
        eval '[ "$(paste -d , results/${model}_lateral.csv results/${model}_free.csv |
            awk -F , "NR > 2 && \$11 < \$2 * (1 - 1e-6) { bad = 1 } END { print bad + 0 }")" = 0 ]'
done
check "gaits of the first-principles model swim as predicted" eval \
    'awk -F , "NR > 1 && ((\$8 - \$2)^2 > 1e-10 || (\$9 - \$1)^2 > 1e-8) { bad = 1 } END { exit bad }" results/fp_lateral.csv'
check "those of the control-oriented one do not" eval \
    'awk -F , "NR > 1 && \$8 > 0.9 * \$2 { bad = 1 } END { exit bad }" results/control_lateral.csv'
check "the table is told" grep -q '^first-principles optima, eel-like: by mean joint power' out
check "and the eel beside the lateral gait" grep -q 'fastest eel-like gait against fastest lateral one: -' out

run --json --model control --set points=3 --set taper=0 --set eel_taper=-0.5
check "one model, no free taper, another eel: two fronts" eval '[ $code -eq 0 ] && [ "$(grep -c "\"kind\"" out)" = 2 ]'
check "the taper is that asked for" eval '[ "$(grep -c "\"taper\":[[:space:]]*-0.5" out)" = 3 ]'

run --json --links 6 --current 0,0.05 --set points=2 --set taper=0
check "a front that cannot be had is left out, and nothing else: $code $(cat err)" \
    eval '[ $code -eq 0 ] && [ "$(grep -c "\"left_out\":.*rot_damping" out)" -eq 2 ] && [ "$(grep -c "\"taper\":" out)" -ge 3 ]'

check "two processes find what one does" same_by_jobs --set points=3

refuse 'points = 1' --set points=1
refuse 'least_share = 2' --set least_share=2
refuse 'eel_taper = -3' --set eel_taper=-3
tap_done
