#!/bin/sh
# SPDX-License-Identifier: MIT
# Random robots through max_speed: each is solved, certified and compared on the whole ladder, or refused with a reason.
# Links 3 to 20, fresh or salt water, links of other length and section, other drag and added mass; a few in a current.
# Takes minutes and runs by name alone:  sh tests/studies/random_robots.sh PROGRAM [FIRST [LAST]]
# PROGRAM is max_speed; robots FIRST to LAST, by default 1 to 40, are the same in every run. Ends with 1 where one of them
# ends otherwise.
set -u
case $1 in
/*) program=$1 ;;
*) program=$PWD/$1 ;;
esac
first=${2:-1} last=${3:-40}
folder=$(mktemp -d) || exit 2
trap 'rm -rf "$folder"' EXIT

# The robot of number $1 as an INI file.
robot() {
    awk -v seed="$1" '
        function between(low, high) { return low + (high - low) * rand() }
        BEGIN {
            srand(7919 * seed)
            for (i = 0; i < 10; i++)
                rand() # the first ones of seeds nearby are alike
            printf "[robot]\nlinks = %d\n", 3 + 7 * seed % 18 # all of them in turn
            printf "rho_kg_m3 = %d\n", rand() < 0.5 ? 1000 : 1025
            printf "length_m = %.4f\n", between(0.06, 0.3)
            printf "a_e_m = %.4f\nb_e_m = %.4f\n", between(0.02, 0.07), between(0.02, 0.07)
            printf "C_f = %.4f\nC_D = %.3f\nC_A = %.3f\n", between(0.01, 0.05), between(0.8, 2.2), between(0.6, 1.2)
            printf "[problem]\ncurrent = %s\n", rand() < 0.2 ? "0.01,0" : "0,0"
        }'
}

# What became of it, in one word, from exit code and output.
outcome() {
    rows=$(grep -c '"omega_deg_s":[^,]*[0-9]$' out.ladder)
    failed=$(grep -c '"left_out"' out.ladder)
    if [ "$1" -eq 0 ] && [ "$rows" -eq 15 ]; then
        echo solved
    elif [ "$1" -eq 0 ] && [ $((rows + failed)) -eq 15 ]; then
        echo partly # on some rungs there is no comparison, with a reason
    elif [ "$1" -eq 1 ] && [ -s err ]; then
        echo refused
    else
        echo "FAILED($1)"
    fi
}

cd "$folder" || exit 2
: >words
k=$first
while [ "$k" -le "$last" ]; do
    robot "$k" >robot.ini
    timeout 300 "$program" --robot robot.ini --json --quiet >out 2>err </dev/null
    code=$?
    awk '/"ladder":/ { on = 1 } on; on && /^\t+\}\]/ { exit }' out >out.ladder # the recommended gait's
    word=$(outcome $code)
    echo "$word" >>words
    reason=$(sed -n 's/.*"left_out":[^"]*"\(.*\)".*/\1/p' out | sort | uniq -c | sort -rn | head -n 1)
    printf '%2d  %-10s N %-3s %s  %s %s\n' "$k" "$word" "$(sed -n 's/^links = //p' robot.ini)" \
        "$(sed -n 's/.*"recommended":[^"]*"\(.*\)".*/\1/p' out): $(sed -n 's/^	"verdict":[^"]*"\(.*\)".*/\1/p' out | cut -c 1-200)" \
        "$(head -n 1 err)" "$reason"
    k=$((k + 1))
done
echo
sort words | uniq -c
! grep -q FAILED words
