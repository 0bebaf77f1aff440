#!/bin/sh
# SPDX-License-Identifier: MIT
# Which lines the tests reach, and how many of the ways out of every condition: a build and one run of the suite in build-cov,
# then a line a folder on standard output and every line of code in build-cov/coverage.html.
root=$(CDPATH='' cd -- "$(dirname -- "$0")/.." && pwd) || exit 1
. "$root/problems/setup.sh"
more_packages=$root/tests/packages.txt
build=$root/build-cov
install_packages && configure "$build" -Db_coverage=true && build "$build" || exit 1
find "$build" -name '*.gcda' -delete
say "Testing $build"
meson test -C "$build" --no-rebuild --timeout-multiplier 8 >&2
cd "$root" || exit 1
# Processes that a test ends by a signal may leave a count half written.
gcovr --root "$root" --filter 'src/' --filter 'problems/' --exclude-unreachable-branches --gcov-ignore-parse-errors \
    --html-details "$build/coverage.html" --csv "$build/coverage.csv" "$build" >&2 || exit 1
awk -F, '
    function room(path) { sub(/\/[^\/]*$/, "", path); return path }
    function share(reached, all) { return all > 0 ? 100 * reached / all : 100 }
    function row(r) { return sprintf("%-32s %6d lines %6.1f %% %6d branches %6.1f %%", r, n[r], share(k[r], n[r]), b[r], share(taken[r], b[r])) }
    function count(r) {
        n[r] += $column["line_total"]; k[r] += $column["line_covered"]; b[r] += $column["branch_total"]; taken[r] += $column["branch_covered"]
    }
    NR == 1 { for (i = 1; i <= NF; i++) column[$i] = i; next }
    {
        path = $column["filename"]
        rooms[room(path)]; count(room(path)); count("all of " substr(path, 1, index(path, "/") - 1))
    }
    END {
        for (r in rooms) print row(r) | "sort"
        close("sort")
        print row("all of problems") "\n" row("all of src")
        exit n["all of src"] == 0
    }' "$build/coverage.csv"
