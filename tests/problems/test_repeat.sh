# SPDX-License-Identifier: MIT
# Every run of every program leaves run.ini, and --config run.ini does the same again. Arguments: the folder of the programs,
# the source directory.
programs=$1
case $programs in
/*) ;;
*) programs=$PWD/$programs ;;
esac
set -- "$programs/simulate" "$2"
. "$2/tests/program.sh"

# numbers FOLDER: the summary without what is measured by the clock, of the memory, or of both and a machine.
numbers() {
    grep -v -E '"([a-z_]*(time|seconds|longest|_ms)[a-z_]*|(setup|function|jacobian|hessian|ipopt|linear_solver|evaluation|total|wall|floor[a-z_]*)_s|peak_[a-z_]*|[a-z_]*_over_(ours|floor)|floor_is_mostly|flops[a-z_]*|[a-z_]*_per_s|call_s)"' "$1/summary.json"
}

covered= # the programs so far

# quickly ARGUMENTS: as run, where no gnuplot is found: a page is as much a page without figures.
quickly() {
    kept=$PATH
    PATH=$work
    "$program" "$@" >out 2>err </dev/null
    code=$?
    PATH=$kept
}
# twice NAME ARGUMENTS: a run, and the same by the file that it left.
twice() {
    name=$1
    program=$programs/$1
    [ -x "$program" ] || program=$programs/moray-$1
    covered="$covered $name"
    shift
    quickly "$@" --quiet --out "$name.one"
    check "$name: $(head -1 err)" [ $code -eq 0 ]
    check "$name: run.ini has no place of its own" eval '! grep -q "$work" "$name.one/run.ini"'
    quickly --config "$name.one/run.ini" --quiet --out "$name.two"
    check "$name: the same again: $(head -1 err)" [ $code -eq 0 ]
    numbers "$name.one" >one
    numbers "$name.two" >two
    check "$name: to the digit: $(diff one two | head -3 | tr '\n' ' ')" eval '[ -s one ] && cmp one two'
    check "$name: with the same settings" cmp "$name.one/run.ini" "$name.two/run.ini"
    [ "$name" = benchmark ] || check "$name: the page has them" grep -q "^program = $name" "$name.one/report.html"
}

twice simulate --current 0.1,0 --links 7 --set duration_s=3 --set theta_max_deg=17.3 --set c_n=8.123456789012345
twice simulate --robot "$2/problems/robots/head_and_fin.ini" --model fp --set duration_s=2 --set link_c_n=7.123456789012341,8.123456789012342,8.123456789012343,8.123456789012344,8.123456789012345,8.123456789012346,8.123456789012347,2*9.5 \
    --set motor_efficiency=0.7 --set motor_speed_deg_s=0,100,300 --set motor_torque_N_m=4,3.9,0 --set hotel_W=1.5
twice max_speed --model control --set theta_max_deg=10:17.7 --set ipopt.mu_strategy=adaptive
twice classics brachistochrone --set tol=1e-9
twice paper mapping --current 0.07,0.1
quick='--set starts=1 --set evaluations=1'
twice min_energy --model control --links 6
twice search_gait --model control --links 6 --set random_starts=1 --set global=none
twice pareto --model control --links 6 --set points=2
twice free_gait --model control --links 4 --set harmonics=1 --set link_angle_deg=25
twice sensitivity --model control --links 6
twice ladder
twice min_time_turn --model control --angle 20 --set intervals_per_period=4 $quick
twice heading_tracking --model control --set receding=no --set reference=steps:3=10 --horizon 10 --set intervals_per_period=4 $quick
twice path_following --model control --path '0,0 3,0' --set intervals_per_period=4 $quick
twice sea_trials --seeds 1 --jobs 1 --set training=1 --set duration_s=12 --set replan_periods=2 --set look_ahead_periods=3 $quick
program=$programs/simulate
run --links 5 --model fp --duration 15 --log one.csv --set noise_position_m=0.005 --set noise_heading_deg=0.5 --quiet
twice identify --links 5 --logs one.csv --starts 1
twice export --from simulate.one
twice benchmark --part s1 --set repeats=1
twice template --set l=0.12
run_by_journal=sweep # which goes on, and repeats, by the journal beside its file
for name in $("$programs/moray" --help=list | cut -f 2) template; do
    check "$name is among them" eval 'echo " $covered $run_by_journal " | grep -q " $name "'
done
cp simulate.one/run.ini other.ini
program=$programs/max_speed
run --config other.ini
check "a run of another program is refused: $(cat err)" eval '[ $code -eq 2 ] && grep -q "are settings of that program" err'
# fails NAME ARGUMENTS: a run that ends without a result.
fails() {
    program=$programs/$1
    shift
    rm -rf failed
    run "$@" --quiet --out failed
    check "$(basename "$program") fails: exit $code: $(head -1 err)" [ $code -eq 1 ]
    check "and leaves its reason and its settings" eval '[ "$(ls -A failed | tr "\n" " ")" = "run.ini summary.json " ] &&
        grep -q "\"status\":.*not solved" failed/summary.json && grep -q "\"reason\":" failed/summary.json'
}
fails max_speed --model control --set power_W=1e-9
for name in min_energy search_gait pareto free_gait sensitivity; do
    fails $name --model control --links 6 --current=-0.9,0
done
fails path_following --current=-0.9,0
fails sea_trials --time 1
tap_done
