#!/bin/sh
# SPDX-License-Identifier: MIT
# From a bare Debian 12 to the first animated report: how long  sh problems/run.sh max_speed --out results  takes, with the
# packages that it installs and what it builds. Runs by name alone, by root, with debootstrap:  sh tests/studies/fresh.sh
# Prints a table; the network and what else the machine does are in the times. Ends with 1 where there is no report.
root=$(CDPATH='' cd -- "$(dirname -- "$0")/../.." && pwd) || exit 2
. "$root/tests/studies/bare.sh"
work=$(mktemp -d) || exit 2
trap 'away "$work/debian"; rm -rf "$work"' EXIT
trap 'exit 130' INT TERM
bare "$work/debian"
tree "$work/debian"

now() { date +%s; }
first=$(now)
# What it says, with the second at which it says it.
inside "$work/debian" sh -c 'cd /moray && sh problems/run.sh max_speed --out results' 2>&1 >/dev/null |
    while IFS= read -r line; do echo "$(now) $line"; done >"$work/said"
last=$(now)
report=$work/debian/moray/results/report.html
if ! grep -q 'id="scene"' "$report" 2>/dev/null; then
    tail -n 20 "$work/said" >&2
    exit 1
fi
built=$(stat -c %Y "$work/debian/moray/build/problems/max_speed")
awk -v first="$first" -v built="$built" -v last="$last" -v cores="$(nproc)" -v load="$(cut -d ' ' -f 2 /proc/loadavg)" '
    / Configuring / { configured = $1 }
    function row(what, seconds) { printf "%-32s %5.1f  min\n", what, seconds / 60 }
    END {
        row("Debian packages", configured - first)
        row("configuring and building", built - configured)
        row("optimising, proving, drawing", last - built)
        row("until the page can be opened", last - first)
        printf "%d cores, mean load of the last five minutes %s\n", cores, load
    }' "$work/said"
