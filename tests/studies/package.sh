#!/bin/sh
# SPDX-License-Identifier: MIT
# The Debian packages, built in a bare Debian 12 with what debian/control names and no more, asked by lintian, installed and
# tried. Runs by name alone, by root, with debootstrap:  sh tests/studies/package.sh [FOLDER]
# With FOLDER the packages are left there. Prints what lintian says and what was tried; ends with 1 where the build fails,
# lintian has an error, or what is installed does not work.
root=$(CDPATH='' cd -- "$(dirname -- "$0")/../.." && pwd) || exit 2
. "$root/tests/studies/bare.sh"
to=${1-}
work=$(mktemp -d) || exit 2
trap 'away "$work/debian"; rm -rf "$work"' EXIT
trap 'exit 130' INT TERM
failed=0
# step WHAT COMMAND...
step() {
    what=$1
    shift
    if "$@" >"$work/said" 2>&1; then
        echo "$what: yes"
    else
        echo "$what: NO"
        tail -n 20 "$work/said"
        failed=1
    fi
}
in_tree() { inside "$work/debian" sh -ec "cd /moray; $1"; }

bare "$work/debian"
tree "$work/debian"
step "what debian/control names is there" in_tree 'apt-get update && apt-get install -y --no-install-recommends build-essential lintian && apt-get build-dep -y --no-install-recommends .'
step "dpkg-buildpackage builds" in_tree 'dpkg-buildpackage -us -uc -b'
step "and the source package" in_tree 'dpkg-buildpackage -us -uc -S -d'
in_tree 'lintian --fail-on error --allow-root ../moray_*.changes' >"$work/lintian" 2>&1 || failed=1
sed 's/^/lintian: /' "$work/lintian"
echo "lintian: $(grep -c '^E:' "$work/lintian") errors, $(grep -c '^W:' "$work/lintian") warnings"
[ ! -d "$to" ] || cp "$work"/debian/*.deb "$to"
inside "$work/debian" sh -c 'ls -s --block-size=1K /*.deb' | sed 's|/||'
step "the packages install" in_tree 'apt-get install -y --no-install-recommends /*.deb man-db netcdf-bin'
step "and work: debian/tests/installed" in_tree 'mv /moray /elsewhere && cd / && sh /elsewhere/debian/tests/installed'
exit $failed
