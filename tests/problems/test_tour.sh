# SPDX-License-Identifier: MIT
# The tour, in its brief form: every step ends well, what is identified has its interval, what a program does not certify is
# told, and the controller that goes home does what the library does. Arguments: the command moray, the source directory,
# the library.
. "$2/tests/program.sh"
cat >moray <<END
"$program" "\$@"
code=\$?
[ "\$1" != max_speed ] || { echo "max_speed: certificate of nothing failed" >&2; exit 3; } # as though it had not passed
exit \$code
END
MORAY="sh $work/moray" LIBMORAY=$3 sh "$source/problems/tour.sh" --brief --out tour >out 2>err
code=$?
check "the tour: exit $code, $(cat err)" [ $code -eq 0 ]
sed 's/^/# /' out
check "it is told as it was printed" cmp -s out tour/report.txt
check "five steps" [ "$(grep -c '^[1-5]\. ' out)" -eq 5 ]
check "an exit code of 3 is told" grep -q '^    exit 3, not certified: max_speed: certificate of nothing failed$' out
check "no other" [ "$(grep -c 'exit 3' out)" -eq 1 ]
for name in c_t c_n mu_n; do
    check "$name within three standard errors of the truth, which are told" awk -v name=$name '$1 == name && $3 == "+-" && $5 == "identified," {
        off = $2 - $6; seen = off < 3 / 1.96 * $4 && off > -3 / 1.96 * $4 } END { exit !seen }' out
done
check "numbers of six digits: $(grep -o '^    theta_max.*' out)" eval '! grep -q "[0-9]\.[0-9]\{9\}" tour/report.txt'
check "the gait is for the robot found" eval 'grep -q "^    moray max_speed --robot identified/robot.ini --over identified/scenarios.csv" out && [ -s tour/gait/summary.json ]'
check "planners and guidance are tried" eval 'grep -q "^LOS" out && grep -q "^receding, estimating" out'
if command -v cc >/dev/null; then
    check "the controller is the library's: five differences" [ "$(grep -c '^    .*[0-9]e-1[0-9]$' out)" -eq 5 ]
fi
MORAY=false sh "$source/problems/tour.sh" --out other >out 2>err
check "a step that fails ends it: exit $?" grep -q '^tour: simulate ended with 1$' err
sh "$source/problems/tour.sh" --long >out 2>err
check "an unknown option: exit $?" grep -q 'unknown option --long' err
tap_done
