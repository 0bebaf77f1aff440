#!/bin/sh
# SPDX-License-Identifier: MIT
# Other tools beside moray, on this machine and now: CasADi on S1 (C++ and Python) and PSOPT on textbook problems, each
# with the Ipopt that it finds. What is not installed is left out, and said. sh problems/benchmark/peers/run.sh [REPEATS]
#   CasADi, C++: pkg-config knows it (PKG_CONFIG_PATH); CasADi, Python: `import casadi` works
#   PSOPT:       PSOPT_PREFIX, a folder with include/PSOPT and lib/PSOPT (/usr/local where it is not set), of the
#                version of August 2026, whose derivatives are CppAD's (CPPAD_PREFIX, the same one where it is not set)
here=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd) || exit 1
root=$(CDPATH='' cd -- "$here/../../.." && pwd) || exit 1
. "$root/problems/setup.sh"
repeats=${1:-5}
case $repeats in
'' | *[!0-9]* | 0) say "repeats = $repeats: a number of at least 1"; exit 2 ;;
esac
prefix=${PSOPT_PREFIX:-/usr/local}
cppad=${CPPAD_PREFIX:-$prefix}
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
trap 'exit 130' INT HUP TERM

install_packages && configure "$root/build" && build "$root/build" problems/moray-benchmark || exit 1
moray=$root/build/problems/moray-benchmark

compile() { # compile NAME FLAGS...: of $here/NAME.cpp
    name=$1
    shift
    c++ -std=c++17 -O2 "$here/$name.cpp" -o "$work/$name" "$@" >"$work/log" 2>&1 && return 0
    say "$name.cpp left out: $(grep -m1 -E 'error|undefined|cannot find' "$work/log")"
    return 1
}

# Of the numbers behind `key` in a file of several runs, the one in the middle.
middle() {
    awk -v key="$1" '$1 == key { print $2 }' "$2" | sort -g | awk '{ v[NR] = $1 } END { print v[int((NR + 1) / 2)] }'
}

# The number in the row of a name under a title of the benchmark's table, in the given column behind the name.
cell() {
    awk -v title="$1" -v name="$2" -v column="$3" '
        index($0, title) == 1 { inside = 1 }
        inside && $0 == "" { inside = 0 }
        inside && index($0, name " ") == 1 { sub(/^.*  +[^ ]/, "&", name); $0 = substr($0, length(name) + 1); print $column; exit }
    ' "$work/moray"
}

# beside LABEL NAME FILE: a row of the table.
beside() {
    ours=$(cell "Start to finish [ms]" "$2" 1)
    awk -v label="$1" -v ours="$ours" -v value="$(cell Programmes "$2" 6)" -v theirs="$(middle seconds "$3")" \
        -v reached="$(middle objective "$3")" -v solved="$(middle solved "$3")" \
        -v count="$(cell Programmes "$2" 1)" -v needed="$(middle iterations "$3")" 'BEGIN {
        printf "%-32s %12.7g %12.7g %10s %7s %10.4g %10.4g %8.3g%s\n", label, value, reached, count,
               needed == "" ? "-" : needed, ours, 1000 * theirs, 1000 * theirs / ours,
               solved ? "" : "  (NOT SOLVED)" }'
}

repeat() { # repeat FILE COMMAND...
    file=$1
    shift
    : >"$file"
    count=0
    while [ $count -lt "$repeats" ]; do
        (cd "$work" && "$@") >>"$file" 2>"$work/log" || { say "failed: $*: $(tail -n 1 "$work/log")"; return 1; }
        count=$((count + 1))
    done
}

title() {
    printf '%s\n%-32s %12s %12s %10s %7s %10s %10s %8s\n' "$1" "" "objective" "theirs" "iterations" "theirs" \
        "time [ms]" "theirs" "ratio"
}

"$moray" --part s1 --set repeats="$repeats" --quiet --out "$work/s1" >"$work/moray" || exit 1
title "S1, processor time from the first line of the problem to the solution: CasADi beside moray"
if pkg-config --exists casadi 2>/dev/null && compile casadi_s1 $(pkg-config --cflags --libs casadi) "-Wl,-rpath,$(pkg-config --variable=libdir casadi)" &&
    repeat "$work/found" "$work/casadi_s1" "$work/s1/s1_start.csv"; then
    beside "S1, CasADi $(middle version "$work/found") C++" S1 "$work/found"
    cp "$work/found" "$work/s1_found"
else
    say "CasADi in C++ is not installed, or failed: left out"
fi
if python3 -c 'import casadi' 2>/dev/null && repeat "$work/found" python3 "$here/casadi_s1.py" "$work/s1/s1_start.csv"; then
    beside "S1, CasADi $(middle version "$work/found") Python" S1 "$work/found"
else
    say "CasADi in Python is not installed, or failed: left out"
fi

if [ -s "$work/s1_found" ]; then
    "$moray" --part problems --set repeats="$repeats" --quiet >"$work/moray" || exit 1
    echo
    title "The same gait with its joints on it, six states in place of 24: CasADi's S1 beside moray"
    beside "joints eliminated" "max_speed, control-oriented" "$work/s1_found"
fi

"$moray" --part classics --set repeats="$repeats" --set most_intervals=30 --quiet >"$work/moray" || exit 1
echo
title "Textbook problems, the same: PSOPT beside moray"
if compile psopt_classics -DPSOPT_AD_BACKEND=2 -I "$prefix/include/PSOPT" -I "$cppad/include" -I /usr/include/eigen3 \
    -L "$prefix/lib/PSOPT" -L "$prefix/lib" -lPSOPT -L "$cppad/lib" -lcppad_lib -Wl,-rpath,"$cppad/lib" \
    $(pkg-config --cflags --libs ipopt); then
    "$work/psopt_classics" >"$work/names"
    while read -r name; do
        repeat "$work/found" "$work/psopt_classics" "$name" && beside "$name" "$name" "$work/found"
    done <"$work/names"
else
    say "PSOPT is not installed in PSOPT_PREFIX=$prefix: left out"
fi
