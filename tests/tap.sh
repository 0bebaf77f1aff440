# SPDX-License-Identifier: MIT
# Test Anything Protocol for shell: check "what is claimed" COMMAND...; the script ends with tap_done.
tap_run=0
tap_failed=0

check() {
    tap_what=$1
    shift
    tap_run=$((tap_run + 1))
    if "$@" >/dev/null 2>&1; then
        echo "ok $tap_run - $tap_what"
    else
        echo "not ok $tap_run - $tap_what"
        tap_failed=$((tap_failed + 1))
    fi
}

tap_done() {
    echo "1..$tap_run"
    [ $tap_failed -eq 0 ]
}
