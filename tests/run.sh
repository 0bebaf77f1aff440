#!/bin/sh
# SPDX-License-Identifier: MIT
# Builds without warnings and runs every test, twice: as users have it, and under the address and undefined-behaviour
# sanitizers. The last line counts: "N passed, N failed".
root=$(CDPATH='' cd -- "$(dirname -- "$0")/.." && pwd) || exit 1
. "$root/problems/setup.sh"
export LSAN_OPTIONS="suppressions=$root/tests/lsan.supp:print_suppressions=0"
export UBSAN_OPTIONS=print_stacktrace=1:halt_on_error=1
passed=0
failed=0

# suite DIRECTORY [MESON OPTIONS]
suite() {
    build=$1
    rm -f "$build/meson-logs/testlog.json"
    if ! configure "$@" || ! build "$build"; then
        failed=$((failed + 1))
        return
    fi
    say "Testing $build"
    # One more than there are cores, for some tests wait.
    meson test -C "$build" --no-rebuild --num-processes $(($(nproc) + 1)) --print-errorlogs --timeout-multiplier 4
    counts=$(awk -f "$root/tests/count.awk" "$build/meson-logs/testlog.json") || counts="0 1"
    passed=$((passed + ${counts% *}))
    failed=$((failed + ${counts#* }))
}

if install_packages; then
    suite "$root/build-ci" -Dwerror=true -Ddebug=false # a third of the compiler's time goes into what a debugger reads
    export MORAY_TESTS_BRIEF=yes
    suite "$root/build-san" -Db_sanitize=address,undefined -Doptimization=1 -Ddebug=false -Dc_args=-g1 # lines are enough
else
    failed=1
fi
echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ] && [ "$passed" -gt 0 ]
