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
# about NAME: what README.md says that it does, to its first comma, colon or semicolon.
about() {
    [ ! -f "$root/README.md" ] || awk -F '|' -v cell=" \`$1\` " '$2 == cell { gsub(/^ | *([:;,].*)?$/, "", $3); print $3; exit }' "$root/README.md"
}
if [ -z "$known" ]; then
    say "Usage: sh problems/run.sh NAME [OPTION]...${name:+ There is no problem $name.} NAME is one of:"
    for source in "$root"/problems/*.c "$root/problems/tour.sh"; do
        one=$(basename "${source%.*}")
        [ ! -f "$source" ] || say "$(printf '  %-17s %s' "$one" "$(about "$one")")"
    done
    say "NAME --help tells the options of each."
    exit 2
fi
shift

program=problems/$name
[ "$name" != benchmark ] || program=problems/moray-benchmark # Meson keeps the short name to itself
install_packages && configure "$root/build" && build "$root/build" "$program" || exit 1
exec "$root/build/$program" "$@"
