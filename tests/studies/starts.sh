#!/bin/sh
# SPDX-License-Identifier: MIT
# Random starts of the gait problems: how many of them end at the best optimum that is known, and what they cost. Starts are
# random gaits within the limits (random_starts of max_speed, always the same). Runs by name alone:
#   sh tests/studies/starts.sh BUILD [STARTS]
# BUILD is the folder with problems/max_speed; 30 starts a problem by default. Ends with 1 where a start finds a better gait
# than the program recommends without them.
set -u
build=$(CDPATH='' cd -- "$1" && pwd) || exit 2
starts=${2:-30}
folder=$(mktemp -d) || exit 2
trap 'rm -rf "$folder"' EXIT
cd "$folder" || exit 2

number() { # FILE KEY: the first value of it in the JSON
    awk -v key="\"$2\"" 'index($0, key) { sub(/.*:[ \t]*/, ""); sub(/,.*/, ""); print; exit }' "$1"
}

# Of the recommended gait's starts, the first in the JSON.
iterations() {
    tr -d '\n\t ' <"$1" | grep -o '"iterations_of_starts":\[[^]]*' | head -n 1 | sed 's/.*\[//' | tr ',' '\n'
}

worse=0
# study NAME ARGUMENT...
study() {
    name=$1
    shift
    "$build/problems/max_speed" --quiet --json --over none "$@" >usual 2>err || { echo "$name: $(cat err)"; worse=1; return; }
    "$build/problems/max_speed" --quiet --json --over none "$@" --set random_starts="$starts" >many 2>err ||
        { echo "$name: $(cat err)"; worse=1; return; }
    awk -v name="$name" -v usual="$(number usual course_speed_m_s)" -v best="$(number many course_speed_m_s)" \
        -v at="$(number many starts_at_optimum)" -v all="$(number many starts)" -v iterations="$(iterations many | tr '\n' ' ')" '
        BEGIN {
            n = split(iterations, of, " ")
            for (i = 1; i <= n; i++) { sum += of[i]; most = of[i] > most ? of[i] : most }
            printf "%-34s %3d of %3d (%3.0f %%)  %.5f m/s, by default %.5f  iterations: mean %.0f, most %d\n",
                name, at, all, 100 * at / all, best, usual, sum / n, most
            exit best > usual * (1 + 1e-5)
        }' || worse=1
}

study "control-oriented" --model control
study "first-principles"
study "first-principles, power 0.5 W" --set power_W=0.5
study "in a current of 0.1, 0.1 m/s" --current 0.1,0.1
study "amplitude free" --set theta_max_deg=1:60
study "consistent hydrodynamics" --hydrodynamics consistent
study "six links" --links 6
study "twenty links" --links 20
exit $worse
