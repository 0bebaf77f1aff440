#!/bin/sh
# SPDX-License-Identifier: MIT
# Solves a problem: problems/run.sh NAME [OPTION]... Installs and builds what is missing first. Standard output is the
# program's alone.
root=$(CDPATH='' cd -- "$(dirname -- "$0")/.." && pwd) || exit 1
. "$root/problems/setup.sh"

name=${1-}
if [ "$name" = tour ] && [ -f "$root/problems/tour.sh" ]; then # of several programs
    shift
    exec sh "$root/problems/tour.sh" "$@"
fi
case $name in
'' | */*) known= ;;
*) [ -f "$root/problems/$name.c" ] && known=yes || known= ;;
esac
if [ -z "$known" ]; then
    say "Usage: sh problems/run.sh NAME [OPTION]...${name:+ There is no problem $name.} NAME is one of:"
    for source in "$root"/problems/*.c; do
        [ -f "$source" ] && say "  $(basename "$source" .c)"
    done
    [ ! -f "$root/problems/tour.sh" ] || say "  tour"
    exit 2
fi
shift

program=problems/$name
[ "$name" != benchmark ] || program=problems/moray-benchmark # Meson keeps the short name to itself
install_packages && configure "$root/build" && build "$root/build" "$program" || exit 1
exec "$root/build/$program" "$@"
