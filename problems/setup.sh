# SPDX-License-Identifier: MIT
# Sourced by problems/run.sh and tests/run.sh, which set `root`: packages, configuring, building. Everything said goes to
# standard error.

say() {
    printf '%s\n' "$*" >&2
}

# Runs a command; shows what it said only when it fails.
quietly() {
    log=$(mktemp) || return 1
    if "$@" >"$log" 2>&1; then
        rm -f "$log"
        return 0
    fi
    cat "$log" >&2
    rm -f "$log"
    say "failed: $*"
    return 1
}

# Of packages.txt, and of `more_packages`, a list of the same form.
wanted_packages() {
    sed 's/#.*//' "$root/packages.txt" ${more_packages:+"$more_packages"}
}

missing_packages() {
    # shellcheck disable=SC2046
    installed=" $(dpkg-query -W -f '${db:Status-Status}=${Package} ' $(wanted_packages) 2>/dev/null) "
    for package in $(wanted_packages); do
        case $installed in
        *" installed=$package "*) ;;
        *) printf '%s ' "$package" ;;
        esac
    done
}

install_packages() {
    if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
        say "This is no Debian system; going on in the hope that it has the counterparts of packages.txt."
        return 0
    fi
    missing=$(missing_packages)
    [ -n "$missing" ] || return 0
    as_root=
    if [ "$(id -u)" -ne 0 ]; then
        if ! command -v sudo >/dev/null; then
            say "Missing Debian packages, and neither root nor sudo to install them. As root: apt-get install $missing"
            return 1
        fi
        as_root=sudo
    fi
    say "Installing missing Debian packages${as_root:+ with sudo}: $missing"
    quietly $as_root apt-get update
    # shellcheck disable=SC2086
    quietly $as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends $missing
}

# locked DIRECTORY COMMAND...: runs it while no other script of ours works on DIRECTORY. The lock is a folder with the
# holder's process in it; one whose holder is gone is taken over.
locked() {
    lock=$1.lock
    shift
    told=
    until mkdir "$lock" 2>/dev/null; do
        holder=$(cat "$lock/holder" 2>/dev/null)
        if [ -n "$holder" ] && ! kill -0 "$holder" 2>/dev/null && [ ! -d "/proc/$holder" ]; then
            rm -rf "$lock"
            continue
        fi
        [ -n "$told" ] || say "Waiting for process ${holder:-?}, which builds here too (${lock##*/})"
        told=yes
        [ -w "$(dirname "$lock")" ] || { say "failed: $lock cannot be made"; return 1; }
        sleep 1
    done
    trap 'rm -rf "$lock"; exit 130' INT HUP TERM
    echo $$ >"$lock/holder"
    "$@"
    status=$?
    rm -rf "$lock"
    trap - INT HUP TERM
    return $status
}

# configure DIRECTORY [MESON OPTIONS]
configure() {
    [ -f "$1/build.ninja" ] || locked "$1" configure_now "$@"
}

configure_now() {
    [ -f "$1/build.ninja" ] && return 0 # by another, while this one waited
    say "Configuring $1"
    directory=$1
    shift
    # More than a hundred programs are linked: gold, which comes with Debian's binutils, takes a third of the time of ld.bfd.
    if command -v ld.gold >/dev/null; then
        CC_LD=${CC_LD-gold} quietly meson setup "$directory" "$root" "$@"
    else
        quietly meson setup "$directory" "$root" "$@"
    fi
}

# build DIRECTORY TARGET...: a terminal sees Ninja count; elsewhere a line a minute says how far it is.
build() {
    locked "$1" build_now "$@"
}

build_now() {
    if [ -t 2 ]; then
        ninja -C "$@" >&2 && return 0
        say "failed: ninja -C $*"
        return 1
    fi
    counted=$(mktemp) || return 1
    say_count "$counted" &
    if ninja -C "$@" >"$counted" 2>&1; then
        rm -f "$counted"
        return 0
    fi
    cat "$counted" >&2
    rm -f "$counted"
    say "failed: ninja -C $*"
    return 1
}

# Until the file of Ninja's lines, "[3/12] ...", or this script is gone.
say_count() {
    waited=0
    while [ -f "$1" ] && kill -0 $$ 2>/dev/null; do
        sleep 1
        waited=$((waited + 1))
        if [ $((waited % 60)) -eq 0 ] && [ -f "$1" ]; then
            say "Building: $(sed -n '$s/^\[\([0-9]*\)\/\([0-9]*\)\].*/\1 of \2/p' "$1"), $((waited / 60)) min"
        fi
    done
} >/dev/null

