# SPDX-License-Identifier: MIT
# The program paper: which studies run, what they leave behind, what the paper's numbers come to. Arguments: the
# program, the source directory.
case $1 in
/*) paper=$1 ;;
*) paper=$PWD/$1 ;;
esac
. "$2/tests/tap.sh"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1

# run ARGUMENTS: leaves $code, out and err.
run() {
    "$paper" "$@" >out 2>err </dev/null
    code=$?
}

# refuse TEXT ARGUMENTS: exit 2, nothing on standard output, one line on standard error with TEXT in it, no --out.
refuse() {
    text=$1
    shift
    run "$@" --json --out fresh
    check "exit 2: $(cat err)" [ $code -eq 2 ]
    check "one line that says '$text'" eval '[ $(wc -l <err) -eq 1 ] && grep -qF -e "$text" err'
    check "nothing printed or written" eval '[ ! -s out ] && [ ! -e fresh ]'
}

# balanced FILE: every brace and bracket of one JSON object closes.
balanced() {
    awk '{ n += gsub(/[{[]/, "") - gsub(/[]}]/, "") } END { exit n != 0 }' "$1" && [ "$(head -c 1 "$1")" = '{' ]
}

# value KEY: the number that stands at the key where it occurs first.
value() {
    awk -v key="\"$1\":" '$1 == key { gsub(/,/, "", $2); print $2; exit }' out
}

# near WHAT IS WANT TOLERANCE
near() {
    check "$1 = $2, expected $3 within $4" awk -v is="$2" -v want="$3" -v by="$4" \
        'BEGIN { exit !(is != "" && want != "" && is - want <= by && want - is <= by) }'
}

refuse 'unknown study mappin; did you mean mapping?' mappin
refuse 'unknown study weather; --help lists them' mapping weather
refuse '[links]: mapping is of the paper' mapping --set link_m_kg=1,9*0.7
refuse 'no study is named: must be all or some of those that --help lists'
refuse 'unknown study (empty)' ''
refuse '--scheme: paper has no use for it' mapping --scheme gauss3
refuse '--course: paper has no use for it' mapping --course 10
refuse 'links = 3: with delta = 2 pi/(N-1) = 180 deg the joints do not move; set delta_deg' mapping --links 3
refuse 'theta_max_deg = 90: must be' mapping --set theta_max_deg=90
refuse 'reading = literal: must be corrected, 23h, l or printed' mapping --set reading=literal

run --help
check "--help lists the studies" eval '[ $code -eq 0 ] && grep -q "STUDY\.\.\.$" out && grep -q "^  forces  " out &&
    grep -q "^  all  " out'

run links mapping links
check "studies run once each, in the paper's order" eval '[ $code -eq 0 ] && [ ! -s err ] &&
    [ "$(grep -o "^---- [a-z]*" out | tr "\n" " ")" = "---- mapping ---- links " ]'

run mapping forces --json --out kept
check "exit 0, one object" eval '[ $code -eq 0 ] && [ ! -s err ] && balanced out && cmp -s out kept/summary.json'
near "residual of (6)" "$(value residual_N)" 0 1e-9
near "current" "$(grep -c '"current_m_s":.\[0.1, 0.1\]' out)" 1 0
for name in forces_fig2.csv forces_fig2.svg forces_links.svg forces_shares.svg forces_terms.csv forces_terms.svg \
    mapping_errors.svg mapping_fig6.csv mapping_fig6.svg report.html summary.json; do
    check "kept/$name" [ -s "kept/$name" ]
done
check "figures name their axes" eval 'grep -q "joint distance \[cm\]" kept/mapping_fig6.svg &&
    grep -q "time \[s\]" kept/mapping_fig6.svg'
check "the report has a section a study with its figures" eval '
    [ "$(grep -c ">mapping:.*</h2>" kept/report.html)" -eq 1 ] && [ "$(grep -c "<figure " kept/report.html)" -eq 6 ] &&
    [ "$(grep -n ">forces:.*</h2>" kept/report.html | cut -d: -f1)" -gt "$(grep -n "Fig. 6" kept/report.html | head -1 | cut -d: -f1)" ]'

if [ -z "${MORAY_TESTS_BRIEF-}" ]; then # as thorough of program.sh
# (23h) as printed accelerates the robot sideways without end: nothing is ever steady.
run mapping forces errata --as-printed --out printed
check "a study that cannot run: exit 1" [ $code -eq 1 ]
check "one line why, one in the end: $(head -1 err)" eval '[ $(wc -l <err) -eq 2 ] &&
    grep -q "^paper: mapping: not steady after 200 periods: speed" err && grep -q "^paper: 1 of 3 studies failed$" err'
check "the others go on" eval 'grep -q "^Terms of (6) in the current$" out && grep -q "^E1: " out'
check "the summary says why" eval 'balanced printed/summary.json &&
    [ "$(grep -c "\"done\":.false" printed/summary.json)" -eq 1 ] &&
    [ "$(grep -c "\"done\":.true" printed/summary.json)" -eq 2 ] &&
    grep -q "\"why\":.\"not steady after 200 periods" printed/summary.json'
check "headings are whole" eval '! grep -E "<h2[^>]*>[^<]*\([^)<]*</h2>" printed/report.html'
check "so does the report" grep -q "Not done: not steady" printed/report.html
check "what was asked for is recorded" grep -q '"reading":.*"printed"' printed/summary.json

run offset
check "Property 3: first-principles" eval 'tr "\n" " " <out | grep -q "first-principles model: straight without offset: yes; a positive offset turns it clockwise: yes; faster with more offset: yes; faster at more speed: yes"'
check "Property 3: control-oriented turns the other way" eval \
    'tr "\n" " " <out | grep -q "control-oriented model: straight without offset: yes; a positive offset turns it clockwise: NO"'

# Where the wave fits on the body, sum phi = (N-1) phi_0 and (20) turns at lambda2/lambda1 phi_0 times the speed.
run offset --json
near "turning rate by (20)" "$(value control_turning_deg_s)" \
    "$(value control_speed_m_s | awk '{ print 40 / 1.15 * -0.045 / 3 * $1 * 45 / atan2(1, 1) }')" 0.03

# There, too, h_4 = 0, and (23h) as printed accelerates by -c_n/(m + mu_n) v_t,rel.
run errata --json
near "E1: dv_n by (23h)" "$(value dv_n_rms_m_s2)" \
    "$(value v_x_m_s | awk '{ print 8.4 / (0.6597 + 0.3958) * ($1 - 0.1) }')" 0.003
near "E1: v_n as printed after 45 s" "$(value v_n_m_s)" -88.16 0.05
near "E3: heading" "$(value heading_fp_as_printed_deg)" -104.8 0.2
near "E1: v_x all the same" "$(value v_x_m_s)" 0.3573 0.0003
near "E4: watts at 120 rad/s" "$(value power_W)" 1002 2
fi

mkdir bin
PATH=$work/bin run mapping --out plain
check "without gnuplot, a note: $(head -1 err)" grep -q 'gnuplot' err
check "the rest appears" eval '[ $code -eq 0 ] && [ -s plain/mapping_fig6.csv ] && [ ! -e plain/mapping_fig6.svg ]'

run mapping forces links offset errata --quiet --out all --links 6 --set theta_max_deg=15 --current 0,0
check "another robot, gait and current: $(cat err)" eval '[ $code -eq 0 ] && [ ! -s err ] && balanced all/summary.json'
check "every study leaves something" eval '
    for study in mapping forces links offset errata; do
        ls all/$study*.svg all/$study*.csv && grep -q "\"$study\":" all/summary.json || exit 1
    done'
lost ground
lost ground --json
tap_done
