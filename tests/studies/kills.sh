#!/bin/sh
# SPDX-License-Identifier: MIT
# Sweeps that are killed: SIGKILL of the process of a point, of the first rank (without mpirun, the sweep itself), of
# another rank, or of all, at random times of a stated seed, again and again; then it is let end, and its file has to
# equal that of a sweep nobody disturbed, value by value but for the times that points took.
# Runs by name alone:  sh tests/studies/kills.sh SWEEP [RUNS [SEED]]
# SWEEP is the program; 50 runs of seed 1. Every fifth run is of a problem that is warm-started, every tenth of two ranks
# under mpirun. Prints a table, and ends with 1 where a file differs.
set -u
case $1 in
/*) sweep=$1 ;;
*) sweep=$PWD/$1 ;;
esac
runs=${2:-50} seed=${3:-1}
folder=$(mktemp -d) || exit 2
trap 'rm -rf "$folder"' EXIT
cd "$folder" || exit 2
root=
[ "$(id -u)" -ne 0 ] || root=--allow-run-as-root

# draw RUN NUMBER: an even number of [0, 1), of seed, run and number alone.
draw() {
    awk -v seed="$seed" -v run="$1" -v n="$2" 'BEGIN {
        srand(1000003 * seed + 1009 * run + n)
        for (i = 0; i < 5; i++) rand() # the first ones of seeds nearby are alike
        printf "%.6f\n", rand() }'
}

# start KIND FILE: a sweep of that kind; of problems that take a few hundredths of a second a point.
start() {
    case $1 in
    warm) set -- "$1" template --grid l=0.08:0.12:20 --file "$2" ;;
    *) set -- "$1" simulate --grid links=4,6 --grid current_x=-0.1:0.1:10 --file "$2" -- --duration 150 ;;
    esac
    kind=$1
    shift
    case $kind in
    ranks)
        # A rank that dies while mpirun starts can leave mpirun waiting for ever.
        # shellcheck disable=SC2086
        exec timeout -k 2 40 mpirun $root --oversubscribe -n 2 "$sweep" --quiet "$@"
        ;;
    *) exec "$sweep" --jobs 2 --quiet "$@" ;;
    esac
}

# What the file holds, but for times and the command.
content() {
    ncdump "$1" | awk '/:command =/ || /^netcdf/ { next }
        /^ [A-Za-z_0-9]*time_s =/ { skip = 1 }
        !skip { print }
        skip && /;/ { skip = 0 }' | sort
}

# children PID: of that process. A point leads a process group of its own.
children() { ps -o pid= --ppid "$1" | tr -d ' '; }

# sweeps PID: the processes that hand out or solve, of a sweep that was started as PID.
sweeps() {
    if [ "$kind" != ranks ]; then echo "$1"; return; fi
    for launcher in $(children "$1"); do children "$launcher"; done
}

# end WHAT PID: kills it; false where there is no such process at the moment.
end() {
    first=$(sweeps "$2" | head -n 1)
    case $1 in
    point)
        victims=$(for one in $(sweeps "$2"); do children "$one"; done | head -n 1)
        ;;
    first) victims=$first ;;
    other) victims=$(sweeps "$2" | tail -n +2 | head -n 1) ;;
    all) victims="$2 $(children "$2") $(for one in $(sweeps "$2"); do echo "$one"; children "$one"; done)" ;;
    esac
    victims=$(echo "$victims" | grep .) || return 1
    # shellcheck disable=SC2086
    kill -KILL $victims 2>/dev/null || : # some may have gone with the first
}

for kind in warm plain ranks; do
    (start $kind whole_$kind.nc) >/dev/null 2>&1 || exit 2
    content whole_$kind.nc >whole_$kind
done
bad=0 run=1
cmp -s whole_plain whole_ranks || {
    echo "two ranks find otherwise than two jobs"
    bad=1
}
echo "run  problem  killed       times  starts  attempts kept  file"
while [ "$run" -le "$runs" ]; do
    kind=plain
    [ $((run % 5)) -ne 0 ] || kind=warm
    [ $((run % 10)) -ne 3 ] || kind=ranks
    case $((run % 3))$kind in
    0*) what=point ;;
    1*) what=first ;;
    2ranks) what=other ;; # with which mpirun ends all
    2*) what=all ;;
    esac
    file=run_$run.nc
    starts=0 killed=0 number=0 most=${MORAY_KILLS:-4}
    while :; do
        starts=$((starts + 1))
        (start $kind $file) >/dev/null 2>err &
        pid=$!
        while [ $killed -lt "$most" ] && kill -0 $pid 2>/dev/null; do
            number=$((number + 1))
            sleep "$(draw $run $number)" # up to a second
            end $what $pid || continue
            killed=$((killed + 1))
            [ $what = point ] || break # the sweep has ended with it
        done
        wait $pid 2>/dev/null && break
        [ $starts -lt 50 ] || break
    done
    kept=$(grep -c '"point"' $file.journal)
    if content $file >now && cmp -s now whole_$kind; then
        verdict="as undisturbed"
    else
        verdict="DIFFERS: $(head -n 1 err | cut -c 1-100)"
        bad=$((bad + 1))
        diff now whole_$kind | head -n 4
    fi
    printf '%3d  %-8s %-12s %5d  %6d  %13d  %s\n' $run $kind $what $killed $starts "$kept" "$verdict"
    run=$((run + 1))
done
echo
echo "$runs runs of seed $seed: $bad of the files differ from those of undisturbed sweeps"
[ $bad -eq 0 ]
