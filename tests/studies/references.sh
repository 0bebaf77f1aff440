#!/bin/sh
# SPDX-License-Identifier: MIT
# References and robots that a steering program has to end with, in the time given: a result, or what stands in the way.
# Prints for each the exit code, the seconds and, where it is no result, the reason; fails where one ends otherwise.
# Takes half an hour and runs by name alone:  sh tests/studies/references.sh BUILD_FOLDER [SECONDS [NAME...]]
build=$1/problems
limit=${2:-200}
names=
[ $# -gt 2 ] && shift 2 && names=" $* "
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
bad=0

# wanted NAME...: whether one of them is to be tried.
wanted() {
    [ -z "$names" ] && return 0
    for one; do
        case $names in
        *" $one "*) return 0 ;;
        esac
    done
    return 1
}

# try NAME PROGRAM ARGUMENTS: with few searches for the rivals, which are not what is tried here.
try() {
    name=$1
    program=$2
    shift 2
    wanted "$name" || return
    from=$(date +%s)
    "$build/$program" "$@" --time "$limit" --quiet --set starts=1 --set evaluations=2 >"$work/out" 2>"$work/err" </dev/null
    code=$?
    seconds=$(($(date +%s) - from))
    reason=$(tail -n 1 "$work/err")
    verdict=ends
    case $code in
    0) ;;
    1 | 3) [ -n "$reason" ] || verdict='SAYS NOTHING' ;;
    *) verdict='FAILS' ;;
    esac
    [ $seconds -le $((limit + limit / 4 + 10)) ] || verdict='LATE'
    [ "$verdict" = ends ] || bad=$((bad + 1))
    printf '%-22s %-12s exit %d, %3d s  %s\n' "$name" "$verdict" $code $seconds "$reason"
}

# robot NAME ARGUMENTS: its constants of (20), fitted, into a file.
robot() {
    file=$work/$1.ini
    shift
    "$build/paper" fit --set write_ini="$file" "$@" --quiet >/dev/null 2>"$work/err" || head -n 1 "$work/err"
}

awk 'BEGIN { srand(1); print "t_s,heading_deg"
    for (t = 0; t <= 60; t += 0.5) printf "%g,%.3f\n", t, 20 * sin(t / 8) + 3 * (rand() - 0.5) }' >"$work/noisy.csv"
awk 'BEGIN { print "x_m,y_m"; for (x = 0; x <= 16; x += 0.4) printf "%g,%g\n", x, 1.5 * sin(x / 2.5) }' >"$work/spline.csv"
printf 't_s,heading_deg\n0,0\n20,70\n60,-40\n' >"$work/few.csv"

try step_90 heading_tracking --reference steps:10=90 --horizon 60 --set gait_evaluations=2
try step_180 heading_tracking --reference steps:10=180 --horizon 80 --set gait_evaluations=2
try step_179 heading_tracking --reference steps:10=-179 --horizon 80 --set gait_evaluations=2
try ramp heading_tracking --reference ramps:5=0,45=180 --horizon 60 --set gait_evaluations=2
try noisy_csv heading_tracking --reference "$work/noisy.csv" --horizon 60 --set gait_evaluations=2
try few_points heading_tracking --reference "$work/few.csv" --horizon 60 --set gait_evaluations=2
try horizon_300 heading_tracking --reference steps:20=30,120=-30,220=0 --horizon 300 --set gait_evaluations=2
try turn_180 min_time_turn --angle 180 --current 0.1,0.1
try turn_180_to_pose min_time_turn --angle 180 --set end_m=0,2 --current 0.1,0.1
try turn_180_still min_time_turn --angle 180 --set end_m=0,2
try pose_in_current min_time_turn --angle 0 --set end_m=5,0 --current=0.1,-0.1
try turn_to_unreachable min_time_turn --angle 90 --set end_m=-4,2 --current 0.4,0
try path_across path_following --path "0,0 6,0" --current=0,0.4
try path_just_across path_following --path "0,0 6,0" --current=0,0.22
try path_at_its_speed path_following --path "0,0 6,0" --current=-0.2597,0
try path_against path_following --path "0,0 6,0" --current=-0.3,0
try sharp_corner path_following --path "0,0 5,0 5,5" --set radius_m=0.05
try tiny_arcs path_following --path "0,0 5,0 5,5 10,5" --set radius_m=0.01
try spline_in_current path_following --path "$work/spline.csv" --set radius_m=0.2 --current=-0.05,0.1
try u_turn path_following --path "0,0 8,0 0,1" --set radius_m=0.2
try closed_loop path_following --path "0,0 6,0 6,6 0,6 0,0.5" --set radius_m=1 --current=0.05,0.05

wanted three_links && robot three --links 3 --set delta_deg=60
wanted fifteen_links && robot fifteen --links 15
wanted five_links && robot five --links 5
wanted twenty_links && robot twenty --links 20
wanted salt_heading salt_turn salt_path && robot salt --links 6 --set rho_kg_m3=1025
try three_links heading_tracking --robot "$work/three.ini" --links 3 --horizon 60 --set gait_evaluations=2
try fifteen_links path_following --robot "$work/fifteen.ini" --links 15 --path "0,0 8,0 8,8"
try five_links heading_tracking --robot "$work/five.ini" --links 5 --horizon 60 --set gait_evaluations=2
try twenty_links heading_tracking --robot "$work/twenty.ini" --links 20 --horizon 60 --set gait_evaluations=2
try salt_heading heading_tracking --robot "$work/salt.ini" --links 6 --set rho_kg_m3=1025 --horizon 60 --set gait_evaluations=2
try salt_turn min_time_turn --robot "$work/salt.ini" --links 6 --set rho_kg_m3=1025
try salt_path path_following --robot "$work/salt.ini" --links 6 --set rho_kg_m3=1025 --path "0,0 5,0 9,2"
[ $bad -eq 0 ] || echo "$bad do not end as they should"
[ $bad -eq 0 ]
