#!/bin/sh
# SPDX-License-Identifier: MIT
# Runs what README.md and results/ show, and writes it there: results/NAME/{command.txt,table.txt,...}, and the table
# between the lines `<!-- NAME -->` and `<!-- end -->` of both README.md. sh results/update.sh [NAME...]; without names,
# all.
root=$(CDPATH='' cd -- "$(dirname -- "$0")/.." && pwd) || exit 1
cd "$root" || exit 1
wanted=" $* "

# show NAME PROGRAM [ARGUMENT...]: one run with --out; print: one that writes nothing but its table.
print() {
    files=
    show "$@"
    files=yes
}
# by SCRIPT NAME [ARGUMENT...]: another script than run.sh, which prints its table.
by() {
    runner=$1
    files=
    quiet=
    shift
    show "$@"
    runner=problems/run.sh
    quiet=--quiet
    files=yes
}
runner=problems/run.sh
quiet=--quiet
files=yes
show() {
    name=$1
    shift
    case $wanted in
    *" $name "* | "  ") ;;
    *) return 0 ;;
    esac
    mkdir -p "results/$name" || exit 1
    if ! sh $runner "$@" $quiet ${files:+--out "results/$name"} >"$name.tmp"; then
        rm -f "$name.tmp"
        echo "failed: sh $runner $*" >&2
        exit 1
    fi
    mv "$name.tmp" "results/$name/table.txt"
    echo "sh $runner $*" | sed 's/ *$//' >"results/$name/command.txt"
    for page in README.md results/README.md; do
        awk -v name="$name" -v table="results/$name/table.txt" '
            $0 == "<!-- end -->" { inside = 0 }
            !inside { print }
            $0 == "<!-- " name " -->" {
                inside = 1
                print "```text"
                while ((getline line < table) > 0) print line
                print "```"
            }' $page >"$name.tmp" && mv "$name.tmp" $page
    done
}

# swept NAME PROGRAM ...: a sweep, which goes on where it was interrupted and begins anew where it had ended.
swept() {
    ! grep -q ' finished$' "build/$1.nc.journal" 2>/dev/null || case $wanted in
    *" $1 "* | "  ") rm -f "build/$1".* ;;
    esac
    name=$1
    program=$2
    shift 2
    show "$name" sweep "$program" --file "build/$name.nc" "$@"
}
# picture NAME SECONDS: its page as it opens, at that moment of its scene, where Chromium is installed: on a desk and on a
# telephone, by day and by night.
picture() {
    case $wanted in
    *" $1 "* | "  ") ;;
    *) return 0 ;;
    esac
    command -v chromium >/dev/null || return 0
    view "$1" "$2" page 1100,1200 1
    view "$1" "$2" page-dark 1100,1200 0
    view "$1" "$2" page-phone 390,844 1
    view "$1" "$2" page-phone-dark 390,844 0
}
# view NAME SECONDS FILE WIDTH,HEIGHT SCHEME: one of these; scheme 0 is what asks pages for their dark colours.
view() {
    profile=$(mktemp -d)
    chromium --headless --no-sandbox --disable-gpu --disable-quic --no-first-run --disable-background-networking \
        --disable-component-update --disable-sync --user-data-dir="$profile" --hide-scrollbars --window-size="$4" \
        --blink-settings=preferredColorScheme="$5" --screenshot="$root/results/$1/$3.png" \
        "file://$root/results/$1/report.html#t=$2" >/dev/null 2>&1
    rm -rf "$profile"
}

show max_speed max_speed
picture max_speed 8
show max_speed_free max_speed --set theta_max_deg=1:60
show min_energy min_energy
show ladder ladder
show search_gait_consistent search_gait --hydrodynamics consistent
show search_gait_consistent_free search_gait --hydrodynamics consistent --set theta_max_deg=1:60
show search_gait search_gait
show search_gait_free search_gait --set theta_max_deg=1:60
show pareto pareto
show pareto_free pareto --set theta_max_deg=1:60
show free_gait free_gait --set harmonics=5
show free_gait_strict free_gait --set link_angle_deg=20
show free_gait_wide free_gait --set theta_max_deg=1:60 --set harmonics=5
show free_gait_control free_gait --model control
show free_gait_consistent free_gait --hydrodynamics consistent
show sensitivity sensitivity
show sensitivity_control sensitivity --model control
show heading_tracking heading_tracking --current 0.1,0.1
show heading_fig8 heading_tracking --set reference=fig8 --current 0.1,0.1
show path_following path_following --current=-0.05,0.1
picture path_following 40
show min_time_turn min_time_turn --current 0.1,0.1
show sea_trials sea_trials --seeds 10 --set training=4 --set starts=2 --set evaluations=4
show sea_trials_path sea_trials --task path --set current_max_m_s=0.1 --set duration_s=150 --seeds 12 --set training=5 --set starts=4 --set evaluations=8
few='--seeds 12 --set training=4 --set starts=2 --set evaluations=4'
none='--set spread=0 --set current_max_m_s=0 --set current_turning_deg_s=0 --set heading_deg=0 --set joints_deg=0 --set position_m=0
    --set drop_outs=0 --set delay_s=0 --set dead_time_s=0'
show sea_trials_known sea_trials $few $none
show sea_trials_consistent sea_trials $few --rung consistent
show sea_trials_control sea_trials $few --model control
show tour tour
show paper paper all
show sweep sweep measure --points 100000 --repeats 3
swept atlas max_speed --grid hydrodynamics=consistent --grid over=none --grid links=4:16:5 --grid current_speed=0.05,0.1 --grid current_deg=-135:180:8 \
    --show gait.delta_deg --show gait.omega_deg_s --show gain.speed_percent_at_equal_power --show 'ladder.*.gain_percent_at_equal_power' \
    --show validated.speed_m_s --show validated.course_speed_m_s --show validated.power_W --show validated.cost_of_transport_J_m \
    --show validated.course_cost_J_m --mirror current_deg
swept sea_sweep sea_trials --grid first_seed=1:40:40 --grid seeds=1 --grid tuned=build/sea_sweep.tuned \
    --grid training=5 --grid starts=3 --grid evaluations=6 \
    --quantiles --show laws_PID_and_rate__ahead_rms_deg_median --show laws_PID_rms_deg_median --show laws_receding__told_rms_deg_median \
    --show laws_receding__believing_rms_deg_median --show laws_receding__estimating_rms_deg_median \
    --show laws_plan_and_feedback_rms_deg_median
by tests/studies/kills.sh sweep_kills build/problems/sweep 50 1
show classics classics all
by tests/studies/iterations.sh classics_iterations results/classics_iterations/before.txt results/classics/table.txt
print benchmark_s1 benchmark --part s1 --set repeats=9
print benchmark_horizon benchmark --part horizon --set repeats=3
show benchmark benchmark --set repeats=3 --set most_intervals=1000
by problems/benchmark/peers/run.sh peers 5 # the other tools, where they are installed

# Wants debootstrap, root and a quiet machine: by name alone.
case $wanted in
*" fresh "*) by tests/studies/fresh.sh fresh ;;
esac

# Takes half an hour: by name alone.
case $wanted in
*" references "*) by tests/studies/references.sh references build 200 ;;
esac

# Take an hour and a half in all: by name alone, trust or trust_PART.
for part in robots starts kills fuzz coverage mutants; do
    case $wanted in
    *" trust "*) wanted="$wanted trust_$part " ;;
    esac
    case $wanted in
    *" trust_$part "*) by tests/studies/trust.sh "trust_$part" build "$part" ;;
    esac
done
