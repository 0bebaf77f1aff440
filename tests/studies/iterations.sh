#!/bin/sh
# SPDX-License-Identifier: MIT
# Iterations of the textbook problems in two tables of `classics all`, an older one and a newer, and what they sum up to
# over the problems that both have.
# Runs by name alone:  sh tests/studies/iterations.sh OLDER NEWER
awk '
# Name, iterations and verdict of a line; the verdict may be two words or three.
function read_line(    i) {
    name = $1
    for (i = 5; i < NF && $(i + 2) != "s"; i++) ;
    iterations = $i
    verdict = $NF == "passes" ? "passes" : /fixed mesh/ ? "fixed mesh" : "fails"
    return i < NF && iterations ~ /^[0-9]+$/
}
FNR == 1 { file++; next }
!read_line() { next }
file == 1 { before[name] = iterations; next }
{ order[++n] = name; after[name] = iterations; now[name] = verdict }
END {
    printf "%-21s %8s %8s  %s\n", "problem", "before", "after", "certificate"
    for (i = 1; i <= n; i++) {
        name = order[i]
        printf "%-21s %8s %8d  %s\n", name, name in before ? before[name] : "-", after[name], now[name]
        if (name in before) { older += before[name]; newer += after[name] }
    }
    printf "%-21s %8d %8d\n", "those in both", older, newer
}' "$1" "$2"
