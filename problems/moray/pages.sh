# SPDX-License-Identifier: MIT
# Manual pages and completions of the command, from what it and the programs list of themselves. Arguments: the command,
# the folder of this script, the folder to write into, the version,
# the programs that there are.
moray=$1
here=$2
to=$3
version=$4
shift 4
export ASAN_OPTIONS=detect_leaks=0
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT

# list PROGRAM: its lines; those of sweep, whose arguments are argp's own, are made of its help.
list() {
    if [ "$1" = sweep ]; then
        ARGP_HELP_FMT=rmargin=2000,opt-doc-col=2,header-col=0 "$moray" sweep --help | awk -f "$here/argp.awk"
    else
        "$moray" "$1" --help=list
    fi
}

"$moray" --help=list >"$work/commands" || exit 1
for name; do
    cut -f 2 "$work/commands" | grep -qx "$name" || { echo "$name is not in the table of problems/moray/moray.c" >&2; exit 1; }
done
for name in $(cut -f 2 "$work/commands"); do
    list "$name" >"$work/$name" && [ -s "$work/$name" ] || { echo "$name does not tell its options" >&2; exit 1; }
    cat "$work/$name" >>"$work/all"
    does=$(awk -F '\t' -v name="$name" '$2 == name { print $3 }' "$work/commands")
    awk -F '\t' -v version="$version" -v does="$does" -f "$here/man.awk" "$work/$name" >"$to/moray-$name.1" || exit 1
done
awk -F '\t' -v version="$version" -f "$here/man.awk" "$work/commands" >"$to/moray.1" || exit 1
for shell in bash zsh fish; do
    awk -F '\t' -f "$here/$shell.awk" "$work/commands" "$work/all" >"$to/moray.$shell" || exit 1
done
mv "$to/moray.zsh" "$to/_moray" # the name that zsh looks for
