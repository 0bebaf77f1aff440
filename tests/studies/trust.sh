#!/bin/sh
# SPDX-License-Identifier: MIT
# The figures of trust, as results/trust has them: random robots, random starts, sweeps that are killed, a long run of the
# fuzzer, what of the code the tests reach, and the mutation of the tests, each with its command and seeds. An hour and a
# half on an idle machine; runs by name alone:
#   sh tests/studies/trust.sh BUILD [ROBOTS [STARTS [MUTANTS]]]
root=$(CDPATH='' cd -- "$(dirname -- "$0")/../.." && pwd) || exit 1
build=$(CDPATH='' cd -- "$1" && pwd) || exit 2
robots=${2:-150} starts=${3:-100} mutants=${4:-200} # of each of two seeds
cd "$root" || exit 1

# part COMMAND...: what it is and what it printed.
part() {
    echo "\$ $*" | sed "s|$build|BUILD|g"
    "$@"
    echo
}

part sh tests/studies/robots.sh "$build" 1 "$robots"
part sh tests/studies/starts.sh "$build" "$starts"
part sh tests/studies/kills.sh "$build/problems/sweep" 50 1
part "$build/tests/fuzz" tests/fuzz/corpus 200000 7 | grep -v '^ok .*: ok$'
part sh tests/coverage.sh
for seed in 1 2; do
    part python3 tests/studies/mutate.py --count "$mutants" --seed $seed
done
