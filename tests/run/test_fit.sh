# SPDX-License-Identifier: MIT
# What a program around moray_app_run shows of a fit. Arguments: the demo program, the source directory.
. "$2/tests/program.sh"

# field NAME: a number of the object "rate" within "fit".
field() {
    tr -d '\n\t' <out | sed 's/.*"fit":{//; s/.*"rate":{\([^}]*\)}.*/\1/' | tr ',' '\n' | sed -n "s/^\"$1\"://p"
}

run --json --out results
check "solved and certified, nothing said: $(cat err)" eval '[ $code -eq 0 ] && [ ! -s err ]'
check "nine observations, of a start and a rate" eval 'near "$(number observations)" 9 0'
check "the rate: $(field value) +- $(field standard_error)" eval 'near "$(field value)" 0.5 0.01 &&
    near "$(field standard_error)" 0.002 0.002'
check "its interval is one of Student's with six degrees of freedom" eval '
    awk "BEGIN { half = ($(field upper) - $(field lower)) / 2 / $(field standard_error); exit !(half > 2.446 && half < 2.448) }"'
check "what is not determined is named" eval 'tr -d "\n\t" <out | grep -q "\"undetermined\":\[\"spare\"\]"'
check "residuals.csv: what was seen, predicted and left" \
    [ "$(head -n 1 results/residuals.csv)" = "t [s],level,level predicted,level residual,twice,twice predicted,twice residual" ]
check "and what is missing is so: $(grep -c nan results/residuals.csv) line" eval '
    awk -F, "NR > 1 && \$2 != \"nan\" { e = \$2 - \$3 - \$4; n++; if (e > 1e-12 || e < -1e-12) bad = 1; s += \$4 * \$4 }
             NR > 1 { s += \$7 * \$7 } END { print s; exit bad || n != 4 }" results/residuals.csv >sum'
check "their squares are the sum: $(cat sum)" eval 'near "$(number sum_of_squares)" "$(cat sum)" 1e-9'
check "a figure of each channel" eval '[ -s results/fit_1.svg ] && grep -q "fit to level" results/fit_1.svg && [ -s results/fit_2.svg ]'
cp out exact
run
check "the table: parameters with their intervals" eval 'grep -q "^Parameters, with intervals of 95 %$" out &&
    grep -qE "^rate  *0\.[0-9]+  *0\.[0-9]+  *0\.[0-9]+  *0\.[0-9]+  1/s$" out'
check "times of the only phase need not say whose" eval 'grep -qE "^initial time  *0  s$" out && grep -qE "^final time  *4  s$" out'
check "and what the data leave open by its name, without an interval" eval '
    grep -q "^not determined by the data  *spare$" out && grep -qE "^spare  *[0-9.e-]+$" out'
run --json --set gauss_newton=yes
check "gauss_newton: the same: $(field value), by $(number nnz_hess) entries" eval '[ $code -eq 0 ] && near "$(number objective)" "$(number sum_of_squares)" 1e-9 &&
    [ "$(field value | cut -c 1-8)" = "$(cp out after; cp exact out; field value | cut -c 1-8; cp after out)" ]'
run --help
check "--help has it" grep -q "^  gauss_newton" out
run --json --set max_iterations=1
check "not solved: no intervals" eval '[ $code -eq 1 ] && grep -q "\"fit\":.null" out'
tap_done
