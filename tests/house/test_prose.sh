# SPDX-License-Identifier: MIT
# No measured number is typed into a page: every number with a decimal point or a per cent sign in the prose of README.md and
# results/README.md (tables and code apart) stands in what a run wrote (results/*/table.txt), in the source of a textbook problem
# or in the paper's errata. And the blocks between markers are the tables. Argument: the source directory.
root=$1
. "$root/tests/tap.sh"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$root" || exit 1

# prose FILE: its text without fenced code, rows of tables, inline code, links' targets and version numbers.
prose() {
    awk '/^```/ { fenced = !fenced; next } !fenced && !/^\|/' "$1" |
        sed 's/`[^`]*`//g; s/](\([^)]*\))/]/g; s/([0-9][0-9a-z]*)//g; s/Sec\. [A-Z0-9.-]*//g; s/\(CasADi\|PSOPT\|Ipopt\|Debian\|SUNDIALS\) [0-9][0-9.]*//g'
}

# numbers: those with a decimal point, or before a per cent sign, one a line.
numbers() {
    grep -oE '[0-9]+\.[0-9]+(e-?[0-9]+)?|[0-9]+ ?%' | sed 's/ *%//' | sort -u
}

# known NUMBER: whether it stands in a table or in a problem's source.
known() {
    grep -qwF -e "$1" "$work/corpus"
}

cat results/*/table.txt problems/classics/*.c problems/classics/*.h >"$work/corpus"
check "there are tables" [ -s "$work/corpus" ]
for page in README.md results/README.md; do
    prose "$page" | numbers >"$work/numbers"
    : >"$work/strangers"
    while read -r number; do
        known "$number" || echo "$number" >>"$work/strangers"
    done <"$work/numbers"
    check "$page: $(wc -l <"$work/numbers") numbers in prose, $(wc -l <"$work/strangers") that no run wrote" [ ! -s "$work/strangers" ]
    sed 's/^/# /' "$work/strangers"
done
echo "It gains 123.456 per cent." | numbers >"$work/numbers"
check "a number that no run wrote would be told" eval '! known "$(cat "$work/numbers")"'

for page in README.md results/README.md; do
    sed -n 's/^<!-- \([a-z0-9_]*\) -->$/\1/p' "$page" | grep -vx end >"$work/names"
    while read -r name; do
        awk -v name="$name" '$0 == "<!-- end -->" { inside = 0 } inside && !/^```/ { print } $0 == "<!-- " name " -->" { inside = 1 }' \
            "$page" >"$work/shown"
        check "$page shows results/$name/table.txt" cmp -s "$work/shown" "results/$name/table.txt"
    done <"$work/names"
done
tap_done
