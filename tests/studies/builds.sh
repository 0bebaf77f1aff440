#!/bin/sh
# SPDX-License-Identifier: MIT
# Other ways of building: compilers and levels, each with the whole suite; the rounding of an old processor; and whether the
# library comes out the same from two folders. Runs by name alone, some minutes a way:
# sh tests/studies/builds.sh [gcc-O0|gcc-O3|clang-O2|old-processor|same]...
root=$(CDPATH='' cd -- "$(dirname -- "$0")/../.." && pwd) || exit 1
. "$root/problems/setup.sh"
[ $# -gt 0 ] || set -- gcc-O0 gcc-O3 clang-O2 old-processor same
failed=0

# way NAME COMPILER [MESON OPTIONS]: builds without warnings, tests, prints a line.
way() {
    name=$1
    CC=$2
    export CC
    directory=$root/build-$1
    shift 2
    if configure "$directory" -Dwerror=true -Ddebug=false "$@" && build "$directory"; then
        rm -f "$directory/meson-logs/testlog.json"
        meson test -C "$directory" --no-rebuild --timeout-multiplier 8 >&2
        counts=$(awk -f "$root/tests/count.awk" "$directory/meson-logs/testlog.json") || counts="0 1"
    else
        counts="0 1"
    fi
    echo "$name: ${counts% *} passed, ${counts#* } failed"
    [ "${counts#* }" -eq 0 ] || failed=1
}

# The mathematical functions and BLAS choose their code by the processor, and round by it.
old_processor() {
    (
        export GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX512F,-AVX2,-AVX2_Usable,-FMA,-FMA_Usable,-FMA4 OPENBLAS_CORETYPE=Prescott
        way old-processor gcc
        exit $failed
    ) || failed=1
}

# The library from two copies of the tree, byte by byte; without what a debugger reads, which names the folder where no
# -ffile-prefix-map is given, as Debian's builds do.
same() {
    work=$(mktemp -d) || exit 1
    export CCACHE_DISABLE=1 # compiled twice, not found again
    for copy in one another/deeper; do
        mkdir -p "$work/$copy"
        (cd "$root" && tar -cf - --exclude='./build*' --exclude=./.git .) | tar -xf - -C "$work/$copy"
        quietly meson setup -Ddebug=false "$work/$copy/build" "$work/$copy" && quietly ninja -C "$work/$copy/build" libmoray.a || failed=1
    done
    find "$work/one/build" -maxdepth 1 -name 'libmoray.*' -type f >"$work/list"
    while read -r file; do
        if cmp "$file" "$work/another/deeper/build/${file##*/}" >&2; then
            echo "same: ${file##*/} is the same from two folders"
        else
            echo "same: ${file##*/} differs"
            failed=1
        fi
    done <"$work/list"
    [ -s "$work/list" ] || failed=1
    rm -rf "$work"
}

for wanted; do
    case $wanted in
    gcc-O0) way gcc-O0 gcc -Doptimization=0 ;;
    gcc-O3) way gcc-O3 gcc -Doptimization=3 -Dc_args=-march=native ;;
    clang-O2) way clang-O2 clang ;;
    old-processor) old_processor ;;
    same) same ;;
    *) say "$wanted: must be gcc-O0, gcc-O3, clang-O2, old-processor or same" && exit 2 ;;
    esac
done
exit $failed
