# SPDX-License-Identifier: MIT
# Programs in other dialects than moray's own are linked with it and get their solutions. Arguments: the source directory,
# the shared library, further flags. Compilers that are not installed are skipped.
source=$1
library=$2
shift 2
. "$source/tests/tap.sh"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# serves PROGRAM STANDARD COMPILER FLAGS...: the compiler builds the program, and it runs to success.
serves() {
    program=$1
    standard=$2
    shift 2
    if ! command -v "$1" >/dev/null; then
        echo "ok $((tap_run += 1)) - $1 $standard # SKIP not installed"
        return
    fi
    rm -f "$work/program"
    check "$program builds with $1 -std=$standard" "$@" "-std=$standard" -Wall -Wextra -Wpedantic -Werror \
        -I "$source/include" "$source/tests/house/$program" -o "$work/program" "$library" -lm \
        "-Wl,-rpath,$(dirname "$library")"
    check "it solves" "$work/program"
}

for compiler in gcc clang; do
    for standard in c99 c17; do
        serves languages.c $standard $compiler "$@"
    done
done
for standard in c++11 c++17; do
    serves cplusplus.cpp $standard g++ "$@"
done
serves cplusplus.cpp c++17 clang++ "$@"
tap_done
