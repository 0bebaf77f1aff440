#!/bin/sh
# SPDX-License-Identifier: MIT
# Random robots through max_speed: what became of each, and the share of those that can be done that is solved and
# certified. Links 2 to 50, fresh or salt water, links of any length and section, drag and added mass, half of them in a
# current of up to 0.4 m/s from anywhere, a quarter with consistent hydrodynamics, a third each with other limits of
# theta_max, of omega and of the power.
# A refusal is checked by simulation: random gaits within all limits are swum in still water, and where one is fast enough
# for the current the refusal is false. Takes some seconds a robot and runs by name alone:
#   sh tests/studies/robots.sh BUILD [FIRST [LAST]]
# BUILD is the folder with problems/max_speed and problems/simulate; FIRST to LAST are seeds, by default 1 to 40. What
# MORAY_ARGUMENTS holds goes to max_speed as well. Ends with 1 where a refusal is false, or a run ends without a reason.
set -u
build=$(CDPATH='' cd -- "$1" && pwd) || exit 2
max_speed=$build/problems/max_speed simulate=$build/problems/simulate
first=${2:-1} last=${3:-40}
folder=$(mktemp -d) || exit 2
trap 'rm -rf "$folder"' EXIT
cd "$folder" || exit 2

# Numbers between low and high, always the same of one seed, whichever awk it is.
between='function rand_of() { state = state * 16807 % 2147483647; return state / 2147483647 }
         function between(low, high) { return low + (high - low) * rand_of() }
         BEGIN { state = 1 + seed; for (i = 0; i < 20; i++) rand_of() }'

# The robot of seed $1 as robot.ini, and where and within what it swims as place.ini.
draw() {
    awk -v seed="$1" "$between"'
        BEGIN {
            printf "[robot]\nlinks = %d\n", int(exp(between(log(2), log(51)))) > "robot.ini"
            printf "rho_kg_m3 = %d\n", rand_of() < 0.5 ? 1000 : 1025 > "robot.ini"
            printf "length_m = %.4f\n", between(0.06, 0.3) > "robot.ini"
            printf "a_e_m = %.4f\nb_e_m = %.4f\n", between(0.02, 0.07), between(0.02, 0.07) > "robot.ini"
            printf "C_f = %.4f\nC_D = %.3f\nC_A = %.3f\n", between(0.01, 0.05), between(0.8, 2.2), between(0.6, 1.2) > "robot.ini"
            printf "hydrodynamics = %s\n", rand_of() < 0.75 ? "paper" : "consistent" > "robot.ini"
            pace = rand_of() < 0.5 ? 0 : between(0, 0.4); from = between(0, 6.283185307)
            printf "[problem]\ncurrent = %.4f,%.4f\n", pace * cos(from), pace * sin(from) > "place.ini"
            printf "theta_max_deg = 1:%.1f\n", rand_of() < 0.33 ? between(15, 40) : 20 > "place.ini"
            printf "omega_deg_s = 30:%.0f\n", rand_of() < 0.33 ? between(90, 360) : 360 > "place.ini"
            printf "power = %.3f\n", rand_of() < 0.33 ? between(0.3, 3) : 1 > "share" # of the power of the paper gait
        }'
    paper=$(swim 20 120 "$(awk -v n="$(links)" 'BEGIN { print 360 / (n - 1) }')" | cut -d ' ' -f 2)
    power=$(awk -v paper="$paper" '{ printf "%.5g", $3 * paper }' share)
    awk '$3 == 1' share | grep -q . || [ "$power" = 0 ] || echo "power_W = $power" >>place.ini # two links have none
}

links() {
    sed -n 's/^links = //p' robot.ini
}

number() { # KEY: the first value of it in the JSON `swum`
    awk -v key="\"$1\"" 'index($0, key) { sub(/.*:[ \t]*/, ""); sub(/,.*/, ""); print; exit }' swum
}

# swim THETA_MAX OMEGA DELTA [deg]: speed and power in still water.
swim() {
    "$simulate" --robot robot.ini --model fp --json --quiet --duration 40 --set theta_max_deg="$1" --set omega_deg_s="$2" \
        --set delta_deg="$3" >swum 2>swum.err && echo "$(number speed_m_s) $(number power_W)"
}

# Whether some gait within the limits can hold course 0: a false refusal. Its speed has to exceed what is needed by 5 %,
# as the current itself changes power and speed a little.
contradicted() {
    [ "$(links)" -gt 2 ] || return 1
    awk -v seed="$1" -v links="$(links)" -F '[ =:,]+' "$between"'
        /theta_max/ { theta = $3 } /omega/ { omega = $3 }
        END {
            for (k = 0; k < 12; k++)
                print theta * between(0.5, 1), between(30, omega), between(0.375, 2.25) * 360 / (links - 1)
        }' place.ini >gaits
    while read -r theta omega delta; do
        swim "$theta" "$omega" "$delta"
    done <gaits >swims
    awk -v limit="$power" -F '[ =,]+' '
        FNR == NR { if (/current/) { along = $2; across = $3 < 0 ? -$3 : $3 } next }
        { U = $1 / 1.05 }
        $2 <= 0.98 * limit && U > across && sqrt(U * U - across * across) + along > 0.01 { found = 1 }
        END { exit !found }' place.ini FS=' ' swims
}

# What became of it, in a word: from exit code and output.
outcome() { # CODE SEED
    case $1 in
    0) grep -q '"pass":.true' out && echo solved || echo FAULT ;;
    1)
        if ! grep -q 'cannot stem\|cannot swim\|makes no way' err; then
            echo unsolved
        elif contradicted "$2"; then
            echo FALSE-REFUSAL
        else
            echo cannot
        fi
        ;;
    3) [ -s err ] && echo uncertified || echo FAULT ;;
    *) echo FAULT ;;
    esac
}

: >causes
k=$first
while [ "$k" -le "$last" ]; do
    draw "$k"
    # shellcheck disable=SC2086 # words on purpose
    timeout 300 "$max_speed" --robot robot.ini --config place.ini --json --quiet ${MORAY_ARGUMENTS:-} >out 2>err </dev/null
    code=$?
    word=$(outcome $code "$k")
    reason=$(head -n 1 err | cut -d ' ' -f 2- | cut -c 1-150)
    # A cause is the message without its numbers.
    echo "$word $(echo "$reason" | sed 's/[-+]*[0-9][0-9.,e+-]*/#/g' | cut -c 1-60)" >>causes
    printf '%3d  %-13s N %-3s %s  %s\n' "$k" "$word" "$(links)" \
        "$(sed -n 's/^current = //p' place.ini)" "$reason"
    k=$((k + 1))
done
echo
sort causes | uniq -c | sort -rn
awk '{ n++; count[$1]++ }
    END { can = n - count["cannot"]
        printf "\n%d of %d can be done; solved and certified: %d, %.0f %%\n", can, n, count["solved"], 100 * count["solved"] / can }' causes
! grep -q 'FAULT\|FALSE' causes
