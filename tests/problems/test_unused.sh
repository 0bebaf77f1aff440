# SPDX-License-Identifier: MIT
# What a program has no use for it refuses, by flag and by key, and does not list. Arguments: the folder of the programs,
# the source directory.
programs=$1
case $programs in
/*) ;;
*) programs=$PWD/$programs ;;
esac
set -- "$programs/simulate" "$2"
. "$2/tests/program.sh"

# useless PROGRAM OPTION...: those that other programs have.
useless() {
    program=$programs/$1
    name=$1
    shift
    "$program" --help=list >list
    for option; do
        case $option in
        ipopt) set -- --set ipopt.max_iter=3 ;;
        linear_solver) set -- --set linear_solver=mumps ;;
        scheme) set -- --scheme radau3 ;;
        tol) set -- --tol 1e-6 ;;
        model) set -- --model fp ;;
        current) set -- --current 0.1,0 ;;
        *) set -- "--$option" 20 ;;
        esac
        run "$@" --out fresh
        check "$name, $option: exit 2: $(cat err)" eval \
            '[ $code -eq 2 ] && one_line && grep -q ": $name has no use for it; --help lists the options$" err && [ ! -e fresh ]'
        check "$name: its help leaves $option out" eval '! cut -f 1-3 list | grep -qE "^(flag.$option|key.[a-z]*.$option(\.KEY)?)(	|$)"'
        [ "$1" = --set ] && continue
        run --set "$option=$2" --out fresh
        check "$name, as a key: $(cat err)" eval '[ $code -eq 2 ] && grep -q "^$name: $option: $name has no use for it" err'
    done
}

useless heading_tracking course
useless path_following course
useless min_time_turn course
useless sea_trials current course scheme intervals tol linear_solver ipopt
useless ladder model scheme intervals tol linear_solver ipopt
useless simulate scheme intervals tol linear_solver ipopt
useless paper model course scheme intervals tol linear_solver ipopt

# idle PROGRAM KEY OPTION...: a mode in which the key has no use, given by flag, by key and in a file.
idle() {
    program=$programs/$1
    name=$1
    key=$2
    shift 2
    run "$@" --out fresh
    check "$name, $key: exit 2: $(cat err)" eval '[ $code -eq 2 ] && one_line && grep -q "^$name: $key: $name has no use for it" err && [ ! -e fresh ]'
}

idle sea_trials path --set "path=0,0 9,0"
idle sea_trials radius_m --set radius_m=3
idle sea_trials hydrodynamics --rung split3 --hydrodynamics consistent
idle sea_trials drag --rung split3 --set drag=both
idle heading_tracking replan_periods --set receding=no --set replan_periods=2
idle heading_tracking look_ahead_periods --set receding=no --set look_ahead_periods=9
idle heading_tracking intervals_per_period --intervals 40 --set intervals_per_period=3
idle heading_tracking gait_evaluations --model control --set gait_evaluations=3
idle heading_tracking theta_max_deg --reference fig8 --set theta_max_deg=9
idle heading_tracking gait_evaluations --reference fig8 --set gait_evaluations=3
idle path_following replan_periods --set receding=no --set replan_periods=2
idle path_following find_gait --model control --set find_gait=no
idle path_following current --water water.csv --current 0.1,0
idle min_time_turn current --water water.csv --current 0.1,0
idle min_time_turn intervals_per_period --intervals 40 --set intervals_per_period=3
printf '[problem]\nradius_m = 4\n' >file.ini
idle sea_trials radius_m --config file.ini
# A run's own file, in which every key stands, is taken again.
program=$programs/sea_trials
run --seeds 1 --jobs 1 --set training=1 --set starts=1 --set evaluations=1 --set duration_s=10 --set replan_periods=3 --out done --quiet
run --config done/run.ini --seeds 1 --set planner_current=some
check "run.ini is taken: $(cat err)" eval 'grep -q planner_current err'

# A number that the program chooses is no default of 0, which would be refused.
for name in heading_tracking path_following min_time_turn classics; do
    program=$programs/$name
    run --help
    check "$name: intervals by the program" eval 'tr -s " \n" " " <out | grep -q "collocation intervals; [^;]*; default by the program"'
    refuse 'intervals = 0' $([ $name = classics ] && echo brachistochrone) --intervals 0
done

# The robot swims in still water unless told otherwise, in every program that steers.
for name in heading_tracking path_following min_time_turn; do
    program=$programs/$name
    run --help
    check "$name: still water" eval 'tr -s " \n" " " <out | grep -q "current in the global frame; [^;]*; default 0,0"'
done
tap_done
