#!/bin/sh
# SPDX-License-Identifier: MIT
# Which lines the tests reach: a build and one run of the suite in build-cov, then a line a folder on standard output and every
# line of code in build-cov/coverage.html.
root=$(CDPATH='' cd -- "$(dirname -- "$0")/.." && pwd) || exit 1
. "$root/problems/setup.sh"
more_packages=$root/tests/packages.txt
build=$root/build-cov
install_packages && configure "$build" -Db_coverage=true && build "$build" || exit 1
find "$build" -name '*.gcda' -delete
say "Testing $build"
meson test -C "$build" --no-rebuild --timeout-multiplier 8 >&2
cd "$root" || exit 1
gcovr --root "$root" --filter 'src/' --filter 'problems/' --exclude-unreachable-branches --html-details "$build/coverage.html" \
    --csv "$build/coverage.csv" "$build" >&2 || exit 1
awk -F, '
    function room(path) { sub(/\/[^\/]*$/, "", path); return path }
    NR == 1 { for (i = 1; i <= NF; i++) column[$i] = i; next }
    { r = room($column["filename"]); lines[r] += $column["line_total"]; reached[r] += $column["line_covered"] }
    END {
        for (r in lines) { printf "%-32s %6d lines %6.1f %%\n", r, lines[r], 100 * reached[r] / lines[r] | "sort"; n += lines[r]; k += reached[r] }
        close("sort")
        if (n == 0) exit 1
        printf "%-32s %6d lines %6.1f %%\n", "all", n, 100 * k / n
    }' "$build/coverage.csv"
