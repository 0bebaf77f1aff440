# SPDX-License-Identifier: MIT
# Growth over the horizon as the program benchmark measures it. Arguments: the program, the source directory.
. "$2/tests/program.sh"

run --part horizon --set repeats=1 --set most_seconds=60 --json
check "measured: $(cat err)" [ $code -eq 0 ]
check "on both models" [ "$(grep -c '"over":[[:space:]]*"seconds"' out)" -eq 2 ]
check "each at one horizon, which is solved" [ "$(grep -c '"solved":[[:space:]]*true' out)" -eq 2 ]
check "at least 100 intervals of 45 unknowns: $(number nvar)" [ "$(number nvar)" -ge 4500 ]
check "an exponent of one point is none" eval '[ "$(number exponents iteration)" = null ]'
run --set most_seconds=20
check "too short: $(cat err)" eval '[ $code -eq 2 ] && grep -q "most_seconds = 20" err'
tap_done
