# SPDX-License-Identifier: MIT
# Sourced by studies that want a bare Debian 12, with `root` set: a folder with nothing but what debootstrap brings, and
# this source tree in it. Needs debootstrap and a superuser; says so and ends with 2 without.

say() { printf '%s\n' "$*" >&2; }

# bare FOLDER: makes it; the mirror is this machine's.
bare() {
    command -v debootstrap >/dev/null || { say "debootstrap is not installed"; exit 2; }
    [ "$(id -u)" -eq 0 ] || { say "to be run by root"; exit 2; }
    mirror=$(sed -n 's/^URIs: *//p; s/^deb \(\[[^]]*\] \)\?\(http[^ ]*\) .*/\2/p' /etc/apt/sources.list.d/debian.sources /etc/apt/sources.list 2>/dev/null |
        grep -m 1 '/debian/*$')
    debootstrap --variant=minbase bookworm "$1" "${mirror:-http://deb.debian.org/debian}" >"$1.log" 2>&1 ||
        { tail -n 5 "$1.log" >&2; exit 2; }
    cp /etc/resolv.conf "$1/etc/resolv.conf"
    mount -t proc proc "$1/proc" || mount --bind /proc "$1/proc" || exit 2
}

# tree FOLDER: what is under version control, as it stands, into FOLDER/moray.
tree() {
    mkdir -p "$1/moray" && git -C "$root" ls-files -z | (cd "$root" && tar -c --null -T - --ignore-failed-read) 2>/dev/null | tar -x -C "$1/moray"
}

# inside FOLDER COMMAND...: there, with an environment of its own.
inside() {
    folder=$1
    shift
    chroot "$folder" /usr/bin/env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin DEBIAN_FRONTEND=noninteractive LC_ALL=C.UTF-8 "$@"
}

# away FOLDER
away() {
    umount "$1/proc" 2>/dev/null
    rm -rf --one-file-system "$1" "$1.log"
}
