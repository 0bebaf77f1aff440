# SPDX-License-Identifier: MIT
# The program sweep as a user meets it. Arguments: the program, the source directory.
. "$2/tests/program.sh"

# values NAME FILE: the numbers of a variable, one a line, by a tool that is not ours.
values() {
    ncdump -v "$1" "$2" | awk -v name="$1" '$0 ~ "^ " name " =" { inside = 1; sub(/.*=/, "") } inside { print } inside && /;/ { exit }' |
        tr -d ' ;"' | tr ',' '\n' | sed '/^$/d'
}

run simulate --grid links=4,6 --grid current_x=-0.1:0.1:3 --file a.nc --json --jobs 2
check "two grids: $(cat err)" [ $code -eq 0 ]
check "of six points: $(number solved)" [ "$(number solved)" = 6 ]
check "ncdump reads the file" eval 'ncdump -h a.nc >header && grep -q "double robot_links(links, current_x)" header'
check "which has conventions, command and version" eval \
    'grep -q "Conventions = \"CF-1.8\"" header && grep -q ":command = \"sweep" header && grep -q ":version = " header'
check "every point swam with its links: $(values robot_links a.nc | tr '\n' ' ')" [ \
    "$(values robot_links a.nc | tr '\n' ' ')" = "4 4 4 6 6 6 " ]
"${program%/*}/simulate" --links 6 --current=0.1,0 --json --quiet >alone
check "and found what the program alone finds" near "$(values simulated_v_x_m_s a.nc | tail -n 1)" \
    "$(sed -n 's/.*"v_x_m_s":[[:space:]]*\([^,]*\).*/\1/p' alone | head -n 1)" 1e-13

run simulate --grid links=4,6 --grid current_x=-0.1:0.1:3 --file a.nc --json
check "once more: nothing is left to do" eval '[ $code -eq 0 ] && [ "$(number made_before)" = 6 ] && [ "$(number busy_s)" = 0 ]'
run simulate --grid links=4,7 --file a.nc
check "another sweep may not have the file: $(cat err)" eval '[ $code -eq 2 ] && grep -q "another sweep" err'

run simulate --grid links=4,6 --grid current_x=-0.1:0.1:3 --file cold.nc --quiet --out drawn --show robot.links
check "a figure of a number: $(cat err)" eval '[ $code -eq 0 ] && [ -s drawn/robot_links_1.svg ] && grep -q "<h1>sweep: simulate at 6 points</h1>" drawn/report.html'
check "the numbers of every point: $(sed -n 2p drawn/points.csv)" [ "$(sed -n 2p drawn/points.csv)" = "4,-0.10000000000000001,4" ]
run simulate --grid current_speed=0.1 --grid current_deg=-90,0,90,180 --file turned.nc --page turned.html --quiet \
    --keep 'simulated.*' --keep 'current_m_s.*' --show simulated.speed_m_s --show 'current_m_s.*' --mirror current_deg --quantiles
check "a current by its direction: $(values current_m_s_0 turned.nc | tr '\n' ' ')" [ "$(values current_m_s_0 turned.nc | tr '\n' ' ')" = "0 0.1 0 -0.1 " ]
check "opposite directions: $(grep simulated.speed_m_s out | tail -n 1)" awk \
    '/simulated.speed_m_s .* of / { seen = 1; good = $2 < 1e-6 * $4 } END { exit !(seen && good) }' out
check "the least and the most of a pattern" grep -q 'most current_m_s.* 4 *0.05 *0.1' out
check "the page is whole, and of a sweep that has ended" eval 'grep -q "</html>" turned.html && ! grep -q refresh turned.html'
check "numbers that were not to be kept are not there" eval '! ncdump -h turned.nc | grep -q robot_links'
cp "$2/problems/robots/paper.ini" mine.ini
run simulate --grid omega_deg_s=100,120 --file given.nc --quiet -- --robot mine.ini
check "a robot for all: $(cat err)" [ $code -eq 0 ]
echo "# changed" >>mine.ini
run simulate --grid omega_deg_s=100,120 --file given.nc --quiet -- --robot mine.ini
check "whose file was changed is another one: $(cat err)" eval '[ $code -eq 2 ] && grep -q "configuration" err'
run simulate --list "$2/problems/robots/*.ini" --file robots.nc --json
check "a list of robots: $(number points)" eval '[ $code -eq 0 ] && [ "$(number points)" -ge 1 ] && [ "$(number failed)" = 0 ]'
cp "$2/problems/robots/paper.ini" "my robot.ini"
run simulate --list "my robot.ini" "$2/problems/robots/paper.ini" --quiet --file names.nc --json
check "names of files behind --list, with spaces: $(number solved) $(cat err)" eval '[ $code -eq 0 ] && [ "$(number solved)" = 2 ]'
run simulate --random 3 --range links=4:4 --range omega_deg_s=60:120 --seed 3 --file draws.nc --json
check "random draws: $(number solved) $(cat err)" eval '[ $code -eq 0 ] && [ "$(number solved)" = 3 ]'
check "within their range: $(values omega_deg_s draws.nc | tr '\n' ' ')" awk 'BEGIN { ok = 1 } { ok = ok && $1 >= 60 && $1 <= 120; n++ } END { exit !(ok && n == 3) }' <<END
$(values omega_deg_s draws.nc)
END

run simulate --grid links=1,4,5 --file some.nc --json
check "a point that is refused costs itself: $(number failed)" eval '[ $code -eq 0 ] && [ "$(number failed)" = 1 ]'
check "and is listed with its reason" eval 'ncdump -v sweep_reason some.nc | grep -q "links = 1"'

run template --grid l=0.08:0.12:5 --file warm.nc --json --jobs 2
check "solutions of neighbours as starts: $(number held) of $(number warm)" eval \
    '[ $code -eq 0 ] && [ "$(number solved)" = 5 ] && [ "$(number warm)" = 4 ] && [ "$(number held)" = 4 ]'
# Bryson-Denham: 4 / (9 l) for l <= 1 / 6.
check "the right optimum: $(values solver_objective warm.nc | head -n 1)" near "$(values solver_objective warm.nc | head -n 1)" 5.5555556 1e-4
run template --cold --grid l=0.08:0.12:5 --file cold_template.nc --json --jobs 2
check "and each from its own" eval '[ $code -eq 0 ] && [ "$(number solved)" = 5 ] && [ "$(number warm)" = 0 ]'

if command -v mpirun >/dev/null; then
    root=
    [ "$(id -u)" -ne 0 ] || root=--allow-run-as-root
    # shellcheck disable=SC2086
    mpirun $root --oversubscribe -n 2 "$program" simulate --grid links=4,6 --grid current_x=-0.1:0.1:3 --file mpi.nc \
        --json --quiet >out 2>err
    check "two ranks: $(number ranks) $(cat err)" eval '[ "$(number ranks)" = 2 ] && [ "$(number solved)" = 6 ]'
    for file in a mpi; do
        ncdump "$file.nc" | sed '/:command/d; /^netcdf/d; /sweep_time_s =/,/;/d' >$file.txt
    done
    check "find the same" cmp a.txt mpi.txt

    # Under --enable-recovery the others outlive a rank that dies, and do what it had in hand.
    # shellcheck disable=SC2086
    timeout 60 mpirun $root --oversubscribe --enable-recovery -n 3 "$program" simulate --grid links=4,6 --grid current_x=-0.1:0.1:10 \
        --file lost.nc --silent 1 --json --quiet -- --duration 100 >out 2>err &
    until [ "$(grep -c point lost.nc.journal 2>/dev/null)" -ge 2 ] 2>/dev/null || ! kill -0 $!; do sleep 0.05; done
    # shellcheck disable=SC2046
    kill -KILL $(ps -o pid= --ppid $(ps -o pid= --ppid $!) | tail -n 1)
    wait $!
    check "a rank that dies is missed: $(number lost_ranks)" [ "$(number lost_ranks)" = 1 ]
    check "and all points are solved: $(number solved)" [ "$(number solved)" = 20 ]
    if thorough; then
        # shellcheck disable=SC2086
        timeout 60 mpirun $root --oversubscribe --enable-recovery -n 3 "$program" simulate --grid links=4,6 --grid current_x=-0.1:0.1:40 \
            --file headless.nc --silent 0.5 --json --quiet -- --duration 300 >out 2>err &
        until [ "$(grep -c point headless.nc.journal 2>/dev/null)" -ge 2 ] 2>/dev/null || ! kill -0 $!; do sleep 0.05; done
        # shellcheck disable=SC2046
        kill -KILL $(ps -o pid= --ppid $(ps -o pid= --ppid $!) | head -n 1)
        wait $!
        check "where the first one dies the others end: $(grep -c 'first rank has been silent' err) of 2" [ \
            "$(grep -c 'first rank has been silent' err)" = 2 ]
    fi
else
    echo "ok $((tap_run += 1)) - two ranks # SKIP mpirun is not installed"
fi

if thorough; then
    # Rivals tuned once serve all points, and trials apart are those of one run.
    tiny="--grid first_seed=1,2 --grid seeds=1 --grid training=1 --grid starts=1 --grid evaluations=1 --grid duration_s=20"
    # shellcheck disable=SC2086
    run sea_trials $tiny --grid tuned=sea.tuned --file sea.nc --json --jobs 1
    check "sea trials: $(number solved) $(cat err)" eval '[ "$(number solved)" = 2 ] && [ -s sea.tuned ]'
    # shellcheck disable=SC2086
    run sea_trials $tiny --grid tuned=sea.tuned --file sea.nc --json --jobs 1
    check "which is theirs, so that they can be gone on with: $(number made_before) $(cat err)" [ "$(number made_before)" = 2 ]
    sh "$2/tests/studies/kills.sh" "$program" 3 5 >kills 2>&1
    check "killed at random times: $(tail -n 1 kills)" grep -q ' 0 of the files differ' kills
fi
(ulimit -f 20 && "$program" simulate --grid links=4,6 --grid current_x=-0.1:0.1:5 --file limited.nc --quiet >out 2>err)
code=$?
check "files that may not grow: exit $code: $(cat err)" eval '[ $code -eq 2 ] && one_line && grep -q "cannot be written" err'
ln -s /dev/zero zero.nc.journal
refuse 'not a regular file' simulate --grid links=4,6 --file zero.nc

run max_speed --grid links=4,5 --grid current_y=0.3 --file none.nc --quiet --jobs 1
check "no point solved: exit $code: $(cat err)" eval '[ $code -eq 1 ] && one_line && grep -q "no point is solved" err'

refuse 'no program nothing' nothing --grid links=4,5
refuse 'which program' --grid links=4,5
refuse 'nothing is varied' simulate
refuse 'must be LOW:HIGH:COUNT' simulate --grid links=4:6
refuse 'must rise or fall' simulate --grid links=4,6,6
refuse 'must rise or fall' simulate --grid links=4,8,6
refuse 'must be LOW:HIGH:COUNT' simulate --grid current_x=nan:1:3
refuse 'must be LOW:HIGH:COUNT' simulate --grid current_x=0:1:0
refuse 'more than' simulate --grid current_x=0:1:1000000 --grid current_y=0:1:1000000
refuse 'is there twice' simulate --list same.ini same.ini
refuse 'varied twice' simulate --grid links=4,5 --grid links=6,7
refuse 'whose speed is missing' simulate --grid current_deg=0,90
refuse 'not both' simulate --grid current_speed=0.1 --grid current_y=0,0.1
refuse 'one of them' simulate --grid current_y=0,0.1 -- --current 0.1,0
refuse 'must be KEY=LOW:HIGH' simulate --random 2 --range omega_deg_s=60:nan
refuse 'unknown key link' simulate --grid link=4,5 --file wrong.nc
check "of which no file is left" [ ! -e wrong.nc ]
refuse 'either needs the other' simulate --random 5 --grid links=4,5
refuse 'must be a whole number' simulate --jobs 1.5 --grid links=4,5
tap_done
