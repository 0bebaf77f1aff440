# SPDX-License-Identifier: MIT
# What a user meets at the command line. Arguments: the demo program, the source directory.
. "$2/tests/program.sh"

printf '[robot]\nc_m = 3\n' >unknown.ini
printf '[robot]\nlinks = 3\nlinks = 3\n' >twice.ini
printf '[robot]\nm_kg = heavy\n' >junk.ini
mkdir directory
: >file

refuse '--links = 1: must be an integer from 2 to 1000' --links 1
refuse '--links = 12abc: must be' --links 12abc
refuse '--links = (empty): must be' --links ''
refuse '--links = (empty): must be' --links=
refuse '--links = 5.5: must be' --links 5.5
refuse 'm_kg = -1: must be a number above 0 kg' --set m_kg=-1
refuse 'm_kg = nan: must be' --set m_kg=nan
refuse 'm_kg = inf: must be' --set m_kg=inf
refuse 'm_kg = (empty): must be' --set m_kg=
refuse 'delta = 50:40: must be LOW:HIGH or one value, LOW <= HIGH' --set delta=50:40
refuse '--delta = 10:181: must be' --delta 10:181
refuse '--tol = 1: must be a number above 0 and below 1' --tol 1
refuse '--tol = 0: must be' --tol 0
refuse '--intervals = 0: must be' --intervals 0
refuse '--current = 0.1: must be X,Y' --current 0.1
refuse '--model = simple: must be control or fp' --model simple
refuse 'unknown key c_nn; did you mean c_n?' --set c_nn=3
refuse 'unknown option --lnks; did you mean --links?' --lnks 3
refuse 'unexpected argument extra' extra
refuse 'unknown option -x' -x
refuse '--json takes no value' --json=1
refuse 'unknown.ini:2: unknown key c_m; did you mean' --robot unknown.ini
refuse 'twice.ini:3: links is given twice, first in line 2' --robot twice.ini
refuse 'junk.ini:2: m_kg = heavy: must be' --robot junk.ini
refuse 'robot file absent.ini: cannot be opened: No such file' --robot absent.ini
refuse 'robot file directory: cannot be read: Is a directory' --robot directory
refuse "c_n = 1 2: must be" --set "c_n=$(printf '1\n2')"
refuse 'junk.ini:2' --robot junk.ini --set m_kg=1

for unwritable in file file/below /proc/moray; do
    run --out "$unwritable"
    check "--out $unwritable is refused before the run: $(cat err)" eval '[ $code -eq 2 ] && one_line && [ ! -s out ]'
done
run --out ''
check "an empty --out is refused: $(cat err)" eval '[ $code -eq 2 ] && one_line && [ ! -s out ]'
run --links
check "a missing value is refused: $(cat err)" eval '[ $code -eq 2 ] && one_line && [ ! -s out ]'

run --help
check "--help: exit 0, on standard output alone" eval '[ $code -eq 0 ] && [ ! -s err ] && grep -q -- "--links N" out'
run --version
check "--version: $(cat out)" eval '[ $code -eq 0 ] && grep -q "^options_demo (moray) [0-9.]*$" out'
lost
lost --json
lost --help
lost --version
lost --out lost
check "nothing printed, nothing lost" eval '"$program" --links 1 >&- 2>err; [ $? -eq 2 ] && grep -q "links = 1" err'
"$program" --json --out streams >&- 2>&- <&-
check "closed streams: exit $?, and no file takes what they lose" eval 'head -n 1 streams/trajectory.csv | grep -q "^t .s.,x .m.$"'

run --json
cp out by_default
check "--json prints one object" eval '[ $code -eq 0 ] && [ ! -s err ] && [ "$(head -c 1 out)" = "{" ]'
run --json --robot "$source/problems/robots/paper.ini"
check "paper.ini is the robot that everyone swims without it" cmp out by_default
run --set tol=1e-5 --json --robot "$source/problems/robots/paper.ini" --set c_n=9.1
check "the command line overrides" eval 'grep -q "\"tol\":.1e-05" out && grep -q "\"c_n\":.9.1," out'
run
check "the table is what a human gets" eval '[ $code -eq 0 ] && grep -q "^delta from  *20  deg$" out'

mkdir kept && echo old >kept/trajectory.csv
run --set ending=unsolved --json --out kept
check "not solved: exit 1, a line that says why" eval '[ $code -eq 1 ] && one_line && grep -q "speed hurts most" err'
check "not solved: earlier results stay, the reason comes" eval '[ "$(ls -A kept | tr "\n" " ")" = "run.ini summary.json trajectory.csv " ] &&
    grep -q old kept/trajectory.csv && grep -q "\"reason\":.*speed hurts most" kept/summary.json'
run --set ending=unsolved --out made/deep
check "not solved: a directory with the reason is left" eval '[ "$(ls -A made/deep | tr "\n" " ")" = "run.ini summary.json " ]'
run --set ending=interrupted
check "interrupted: exit 130" [ $code -eq 130 ]
run --out kept --json
check "solved: exit 0 and all files" eval '[ $code -eq 0 ] && [ "$(ls -A kept | tr "\n" " ")" = "position.svg report.html run.ini summary.json trajectory.csv " ]'
check "new files in the place of old ones" grep -q '^t \[s\],x \[m\]$' kept/trajectory.csv
mkdir bin
PATH=$work/bin run --out plain
check "without gnuplot: $(cat err)" grep -q 'gnuplot' err
check "the rest appears" eval '[ $code -eq 0 ] && [ "$(ls -A plain | tr "\n" " ")" = "report.html trajectory.csv " ]'
tap_done
