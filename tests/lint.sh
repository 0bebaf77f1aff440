#!/bin/sh
# SPDX-License-Identifier: MIT
# The checks of .clang-tidy and the format of .clang-format over all sources, or over the files given. Exit 1 where one fails.
root=$(CDPATH='' cd -- "$(dirname -- "$0")/.." && pwd) || exit 1
. "$root/problems/setup.sh"
more_packages=$root/tests/packages.txt
build=$root/build-tidy
export CC=clang
install_packages && configure "$build" || exit 1
cd "$root" || exit 1
[ $# -gt 0 ] || set -- $(git ls-files 'src/*.[ch]' 'problems/*.[ch]' 'tests/*.[ch]' 'include/*.h')
clang-format --dry-run -Werror "$@"
failed=$?
for file; do
    case $file in
    *.c) printf '%s\n' "$file" ;;
    esac
done | xargs -P "$(nproc)" -n 4 clang-tidy --quiet -p "$build" || failed=1
exit $failed
