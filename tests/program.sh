# SPDX-License-Identifier: MIT
# For sourcing: a program as a user meets it, in an empty directory. Arguments: the program, the source directory.
case $1 in
/*) program=$1 ;;
*) program=$PWD/$1 ;;
esac
source=$2
. "$source/tests/tap.sh"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1

run() {
    "$program" "$@" >out 2>err </dev/null
    code=$?
}

# number KEY: the first value of KEY in the JSON on standard output; BLOCK KEY: the first after BLOCK opens.
number() {
    [ $# -eq 1 ] && set -- . "$1"
    awk -v block="\"$1\"" -v key="\"$2\"" 'index($0, block) || block == "\".\"" { seen = 1 }
        seen && index($0, key) { sub(/.*:[ \t]*/, ""); sub(/,.*/, ""); print; exit }' out
}

# near VALUE EXPECTED TOLERANCE
near() {
    awk -v a="$1" -v b="$2" -v t="$3" 'BEGIN { exit !(a != "" && a - b <= t && b - a <= t) }'
}

# refuse TEXT ARGUMENTS: exit 2, nothing on standard output, one line on standard error with TEXT in it, no --out.
refuse() {
    text=$1
    shift
    run "$@" --json --out fresh
    check "exit 2: $(cat err)" [ $code -eq 2 ]
    check "one line that says '$text'" eval '[ "$(wc -l <err)" -eq 1 ] && grep -qF -e "$text" err'
    check "nothing printed or written" eval '[ ! -s out ] && [ ! -e fresh ]'
}
