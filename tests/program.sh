# SPDX-License-Identifier: MIT
# For tests of one program, sourced with its path in $1 and the source directory in $2: an own working directory, and
# the words below.
case $1 in
/*) program=$1 ;;
*) program=$PWD/$1 ;;
esac
source=$2
. "$source/tests/tap.sh"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1

# run ARGUMENTS: leaves $code, out and err.
run() {
    "$program" "$@" >out 2>err </dev/null
    code=$?
}

# False in the sanitizers' half of tests/run.sh, for long runs of what shorter ones reach too.
thorough() {
    [ -z "${MORAY_TESTS_BRIEF-}" ]
}

# Standard error is one line that begins with the program's name.
one_line() {
    [ "$(wc -l <err)" -eq 1 ] && grep -q "^$(basename "$program"): " err
}

# refuse TEXT ARGUMENTS: exit 2, nothing on standard output, one line on standard error with TEXT in it, no --out.
refuse() {
    text=$1
    shift
    run "$@" --json --out fresh
    check "exit 2: $(cat err)" [ $code -eq 2 ]
    check "one line that says '$text'" eval 'one_line && grep -qF -e "$text" err'
    check "nothing printed or written" eval '[ ! -s out ] && [ ! -e fresh ]'
}

# same_by_jobs ARGUMENTS: whether two processes print the JSON that one does, but for the times taken.
same_by_jobs() {
    for jobs in 1 2; do
        "$program" "$@" --json --jobs $jobs 2>err </dev/null | grep -vE '"([a-z_]*time_s|longest_s|times_real_time)"' >by_$jobs
    done
    [ -s by_1 ] && cmp -s by_1 by_2
}

# subsets KEY: whether no law of the steering in the JSON of `out` has a larger `validated` KEY than one that leaves some of its
# numbers out, on the same gait and plan; prints those that have, and how many pairs there are.
subsets() {
    python3 - "$1" <<'END'
import json, sys
numbers = {"plan": "", "plan and feedback": "g", "feedback": "g", "feedback and rate": "gf", "PID": "gid", "PID and rate": "gfid",
           "bang-bang": "h", "bang-bang, braking": "hb", "line of sight": "gla"}
laws = []
for t in json.load(open("out"))["steering"]:
    if t["law"] not in numbers or "cut_short" in t:
        continue
    own = set(numbers[t["law"]])
    if t["law"] != "plan" and t.get("reference_known_ahead") and not t["plan"]:
        own.add("lead")
    if t.get("name", "").startswith("ILOS"):
        own.add("integral")
    laws.append(((t.get("gait"), t["plan"]), own, t["validated"][sys.argv[1]], t["law"]))
pairs = [(a, b) for a in laws for b in laws if a[0] == b[0] and a[1] < b[1]]
worse = ["%s %g worse than %s %g" % (b[3], b[2], a[3], a[2]) for a, b in pairs if b[2] > a[2] * (1 + 1e-9)]
print(len(pairs), "pairs", *worse)
sys.exit(not pairs or bool(worse))
END
}

# number KEY: the first value of KEY in the JSON on standard output; BLOCK KEY: the first after BLOCK opens.
number() {
    [ $# -eq 1 ] && set -- . "$1"
    awk -v block="\"$1\"" -v key="\"$2\"" 'index($0, block) || block == "\".\"" { seen = 1 }
        seen && index($0, key) { sub(/.*:[ \t]*/, ""); sub(/,.*/, ""); print; exit }' out
}

# robots FOLDER: how many swim on its page.
robots() {
    grep -o '"colour":[0-9]' "$1/report.html" | wc -l
}

# rung MODEL: its gain in the first ladder of the JSON; BLOCK MODEL: in the first after BLOCK opens.
rung() {
    [ $# -eq 1 ] && set -- . "$1"
    awk -v block="\"$1\":" -v model="\"$2\"" 'index($0, block) || block == "\".\":" { seen = 1 }
        seen && /"model"/ && index($0, model) { found = 1 }
        found && /gain_percent/ { sub(/.*:[ \t]*/, ""); sub(/,.*/, ""); print; exit }' out
}

# near VALUE EXPECTED TOLERANCE
near() {
    awk -v is="$1" -v want="$2" -v by="$3" 'BEGIN { exit !(is != "" && want != "" && is - want <= by && want - is <= by) }'
}

# lost ARGUMENTS: what is printed to a full disk or to nowhere is missed: exit 2 and one line that says so.
lost() {
    "$program" "$@" >/dev/full 2>err </dev/null
    code=$?
    check "full standard output: exit $code: $(cat err)" eval '[ $code -eq 2 ] && one_line && grep -q "standard output cannot be written" err'
    "$program" "$@" >&- 2>err </dev/null
    code=$?
    check "closed standard output: exit $code: $(cat err)" eval '[ $code -eq 2 ] && one_line && grep -q "standard output cannot be written" err'
}
