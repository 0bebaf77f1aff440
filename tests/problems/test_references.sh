# SPDX-License-Identifier: MIT
# References that a steering program has to end with, of those that take little time: a result, or what stands in the way,
# within the time given. tests/studies/references.sh has them all. Arguments: the folder of the programs, the source
# directory.
programs=$1
case $programs in
/*) ;;
*) programs=$PWD/$programs ;;
esac
set -- "$programs/heading_tracking" "$2"
. "$2/tests/program.sh"

# ends CODE TEXT PROGRAM ARGUMENTS: so it ends, with TEXT in what it says.
ends() {
    wanted=$1
    text=$2
    program=$programs/$3
    shift 3
    from=$(date +%s)
    run "$@" --quiet --set starts=1 --set evaluations=1
    check "exit $wanted after $(($(date +%s) - from)) s: $(head -1 err)" eval 'case $code in $wanted) true ;; *) false ;; esac'
    check "it says '$text'" eval 'cat out err | grep -q "$text"'
}

flow='--model control --set receding=no'
# The verdict comes first, by the steady speed.
ends 1 'which makes good courses within 4[0-9.]* deg of 90 deg alone' path_following $flow --path "0,0 6,0" --current=0,0.4
ends 1 '0.3 m/s against it' path_following $flow --path "0,0 6,0" --current=-0.3,0
ends 1 'only courses within 3[0-9.]* deg of 0 deg can be made good, and the end lies at 153.4 deg' min_time_turn \
    --angle 90 --set end_m=-4,2 --current 0.4,0
# Corners that the robot cannot turn are eased for the plans, which are certified then, and those of a polyline from a file.
ends 0 'The plans are made for corners eased to a radius of' path_following $flow --path "0,0 5,0 5,5" --set radius_m=0.05
awk 'BEGIN { print "x_m,y_m"; for (x = 0; x <= 8; x += 0.4) printf "%g,%g\n", x, 1.5 * sin(x / 2.5) }' >spline.csv
ends 0 'The plans are made for corners eased to a radius of' path_following $flow --path spline.csv --set radius_m=0.2 \
    --current=-0.05,0.1
# A certificate that no plan of the path can pass says what of the path it is: in a tube corners are as they are asked for.
ends 3 'inside of the corner behind leg 1.*: the nearest point of the path jumps there' path_following \
    $flow --path "0,0 5,0 5,5" --set radius_m=0.05 --set tube_m=0.45
# Nearly back there is no room to ease, and no plan.
ends 1 'not followed: the corner behind leg 1 turns by 174' path_following $flow --path "0,0 5,0 0,0.5" --set radius_m=0.05
# The time given ends every program, and it says so.
ends 1 'in the time given' heading_tracking --time 1 --horizon 200
ends 1 'in the time given' path_following --time 1
ends 1 'in the time given' min_time_turn --time 1 --angle 360
run --help
check "every run has a time" eval 'tr -s " \n" " " <out | grep -q -e "--time SECONDS of the clock.*default 1800"'
tap_done
