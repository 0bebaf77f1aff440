# SPDX-License-Identifier: MIT
# The program ladder as a user meets it. Arguments: the program, the source directory.
. "$2/tests/program.sh"

# gain COLUMN RUNG: of the table of gains.
gain() {
    awk -v column="$1" -v rung="$2" '/^Gain/ { seen = 1 } seen && $1 == rung { print $(column + 1); exit }' out
}

# ---- Paper-notes, section 6: its table, rows and columns exchanged, within 0.1 points
run
check "swum: $(cat err)" [ $code -eq 0 ]
column=0
for gait in "4.03 1.09 0.62 0.39 0.26" "3.25 -14.9 -17.1 -18.1 -18.7" "10.99 1.83 0.52 -0.12 -0.49" \
    "8.41 -19.6 -22.5 -23.8 -24.5" "-5.07 -4.24 -4.10 -4.03 -3.99"; do
    column=$((column + 1))
    set -- $gait
    for rung in paper split2 split3 split5 strip; do
        check "gait $column on $rung: $(gain $column $rung) %" near "$(gain $column $rung)" "$1" 0.1
        shift
    done
done
for paper in "paper 0.2293 0.2646" "split2 0.2297 0.2919" "split3 0.2298 0.2970" "split5 0.2298 0.2996"; do
    set -- $paper
    check "the paper's gait on $1" eval "near $(awk -v rung="$1" '$1 == rung { print $2; exit }' out) $2 1e-4 &&
        near $(awk -v rung="$1" '$1 == rung { print $3; exit }' out) $3 1e-4"
done
check "in words" grep -q '^20, 51.3 deg: wins on all 15, from +0.2[0-9] to +4.7[0-9] %\.$' out

run --json --set gait_6=26,43 --jobs 1 --out results
check "a gait of one's own, as JSON and files" eval '[ $code -eq 0 ] && cmp -s out results/summary.json && [ -s results/report.html ]'
check "seven ladders of 15 rungs" [ "$(grep -c '"model":' out)" -eq $((7 * 15 + 1)) ]
check "the figure has the six gaits and every rung" eval '[ "$(grep -cE ">[0-9.]+, [0-9.]+ deg<" results/ladder.svg)" -eq 6 ] &&
    [ "$(grep -cE ">(c_n|c_t|mu_n|lambda)[+-]20<" results/ladder.svg)" -eq 8 ]'
check "the page says what rungs stand for" grep -q "<dt>c_n+20, c_n-20</dt>" results/report.html
refuse 'gait_1 = 200,40' --set gait_1=200,40
lost
tap_done
