#!/bin/sh
# SPDX-License-Identifier: MIT
# The figures of trust, as results/trust_* have them, each with its command and seeds: random robots, random starts,
# sweeps that are killed, a long run of the fuzzer, what of the code the tests reach, and the mutation of the tests. All
# parts, or those named; an hour and a half on an idle machine. Runs by name alone:
#   sh tests/studies/trust.sh BUILD [robots | starts | kills | fuzz | coverage | mutants]...
root=$(CDPATH='' cd -- "$(dirname -- "$0")/../.." && pwd) || exit 1
build=$(CDPATH='' cd -- "$1" && pwd) || exit 2
shift
cd "$root" || exit 1

# part COMMAND...: what it is and what it printed.
part() {
    echo "\$ $*" | sed "s|$build|BUILD|g"
    "$@"
    echo
}

[ $# -gt 0 ] || set -- robots starts kills fuzz coverage mutants
for name; do
    case $name in
    robots) part sh tests/studies/robots.sh "$build" 1 150 ;;
    starts) part sh tests/studies/starts.sh "$build" 100 ;;
    kills) part sh tests/studies/kills.sh "$build/problems/sweep" 50 1 ;;
    fuzz) part "$build/tests/fuzz" tests/fuzz/corpus 200000 7 | grep -v '^ok .*: ok$' ;;
    coverage) part sh tests/coverage.sh ;;
    mutants) part python3 tests/studies/mutate.py --count 100 --seed 8 ;; # for its survivors no test was written
    *) echo "trust.sh: no part $name" >&2 && exit 2 ;;
    esac
done
