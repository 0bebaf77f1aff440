#!/bin/sh
# SPDX-License-Identifier: MIT
# The whole way of a robot that nobody knows: problems/tour.sh [--out DIR] [--brief]. It swims two logged gaits, is identified from the
# logs, gets a gait that holds for all that they leave open, follows a path in currents that it does not know, and its
# controller goes home as C, which is swum beside the library's own. Each step is a command to be given by hand, too. With
# --brief the robot is short, and so is every step: a test. MORAY is the command in place of problems/run.sh, LIBMORAY the
# library that the controller is swum beside.
root=$(CDPATH='' cd -- "$(dirname -- "$0")/.." && pwd) || exit 1
out=tour
brief=
while [ $# -gt 0 ]; do
    case $1 in
    --out) out=${2-}; shift 2 || exit 2 ;;
    --out=*) out=${1#--out=}; shift ;;
    --brief) brief=yes; shift ;;
    --quiet) shift ;;
    --help)
        echo "Usage: sh problems/run.sh tour [--out DIR] [--brief]"
        sed -n '3,/^root=/s/^# //p' "$0"
        exit 0
        ;;
    *) echo "tour: unknown option $1; problems/tour.sh [--out DIR] [--brief]" >&2; exit 2 ;;
    esac
done
[ -n "$out" ] && mkdir -p "$out" && cd "$out" || { echo "tour: --out DIR: cannot be made" >&2; exit 2; }
moray=${MORAY-sh "$root/problems/run.sh"}
library=${LIBMORAY-$root/build/libmoray.so}
links=10 swims=20 trials='--set duration_s=80 --seeds 3 --set training=2'
if [ -n "$brief" ]; then
    links=7 trials='--set duration_s=15 --seeds 1 --set training=1'
fi
story=$(mktemp) || exit 1
trap 'rm -f "$story"' EXIT

tell() {
    printf '%s\n' "$*" | tee -a "$story"
}

# step WHAT NAME ARGUMENTS: runs a program and tells it; a certificate that fails (3) is told, not the end.
step() {
    what=$1
    shift
    [ -z "$what" ] || tell "$what"
    tell "    moray $*"
    eval "$moray \"\$@\"" --quiet >step.txt 2>step.err </dev/null
    code=$?
    [ $code -ne 3 ] || tell "    exit 3, not certified: $(tail -1 step.err)"
    [ $code -eq 0 ] || [ $code -eq 3 ] || { cat step.err >&2; echo "tour: $1 ended with $code" >&2; exit 1; }
}

# number FILE KEY: the first in a summary.json, to six digits.
number() {
    awk -v key="\"$2\":" '$1 == key { gsub(/[,[]/, "", $2); printf "%.6g\n", $2; exit }' "$1"
}

# setting FILE KEY: of an INI file.
setting() {
    awk -v key="$2" '$1 == key && $2 == "=" { print $3; exit }' "$1"
}

# interval FILE KEY: what stands behind its number, "+- 0.02".
interval() {
    awk -v key="$2" '$1 == key && $2 == "=" { sub(/.*; /, ""); print; exit }' "$1"
}

# ---- 1. A robot, of which only links and geometry are known -----------------------------------------------------------
# It is built like the paper's, whose constants of turning a planner takes for a start; the water treats it otherwise.
printf '[robot]\nlinks = %s\nrot_damping = 1.15\nrot_gain = 40\n' $links >drawn.ini
{ cat drawn.ini && printf 'c_t = 0.33\nc_n = 7.2\nmu_n = 0.5\n'; } >unknown.ini # nobody but the simulation reads this one
noise='--set noise_position_m=0.005 --set noise_heading_deg=0.5'
step "1. It swims two gaits in an unknown current; a camera and a compass look on." simulate --robot unknown.ini --model fp \
    --current 0.05,-0.03 --duration $swims --log one.csv $noise
step "" simulate --robot unknown.ini --model fp --current 0.05,-0.03 --duration $swims --log two.csv $noise \
    --set delta_deg=60 --set phi0_deg=4 --set log_seed=2
for log in one two; do # this robot does not measure torques: t, p_x, p_y, heading and the joints
    cut -d , -f 1-$((links + 3)) $log.csv >cut.csv && mv cut.csv $log.csv
done

# ---- 2. Identification ------------------------------------------------------------------------------------------------
step "2. It is identified from the logs." identify --robot drawn.ini --logs one.csv,two.csv --estimate c_t,c_n,mu_n,current \
    --out identified
for key in c_t c_n mu_n; do
    true=$(setting unknown.ini $key) found=$(setting identified/robot.ini $key)
    tell "    $(awk -v k=$key -v is="$found" -v within="$(interval identified/robot.ini $key)" -v was="$true" 'BEGIN { printf "%-5s %.4g %s identified, %.4g in truth: %+.2f %%", k, is, within, was, 100 * (is / was - 1) }')"
done

# ---- 3. A robust gait -------------------------------------------------------------------------------------------------
step "3. One gait for all robots that the logs leave open." max_speed --robot identified/robot.ini --over identified/scenarios.csv \
    --out gait
tell "    theta_max $(number gait/summary.json theta_max_deg) deg, omega $(number gait/summary.json omega_deg_s) deg/s, delta $(number gait/summary.json delta_deg) deg"
step "   In truth:" simulate --robot unknown.ini --model fp --duration 40 --out swum \
    --set "theta_max_deg=$(number gait/summary.json theta_max_deg)" --set "omega_deg_s=$(number gait/summary.json omega_deg_s)" \
    --set "delta_deg=$(number gait/summary.json delta_deg)"
tell "    $(number swum/summary.json speed_m_s) m/s at $(number swum/summary.json power_W) W"

# ---- 4. A path in currents that it does not know ----------------------------------------------------------------------
share() {
    awk -v is="$(setting identified/robot.ini "$1")" -v was="$(setting unknown.ini "$1")" 'BEGIN { printf "%.6g", is / was }'
}
step "4. The planner believes the robot identified and follows a path in currents that it has to estimate." sea_trials \
    --task path --robot unknown.ini --set spread=0 --set "planner_c_t=$(share c_t)" --set "planner_c_n=$(share c_n)" \
    --set "planner_mu_n=$(share mu_n)" --set current_max_m_s=0.06 $trials \
    --set starts=1 --set evaluations=4 --out trials
awk '/^Trials/ { on = 1 } on && !NF { exit } on' step.txt | tee -a "$story"

# ---- 5. Home ----------------------------------------------------------------------------------------------------------
step "5. Gait and tuned guidance go home." export --from gait --set rate_hz=100 --name gait --out home
step "" export --from trials --law path --name snake --out controller
header=controller/snake.h
if command -v cc >/dev/null && [ -e "$library" ]; then
    cc -DSTEERED=2 -Icontroller -I"$root/problems" -I"$root/include" "$root/tests/problems/export_check.c" \
        "$root/problems/export/gather.c" "$root/problems/export/law.c" "$root/problems/export/options.c" -o beside \
        "$library" -lm "-Wl,-rpath,$(dirname "$library")" && ./beside --config controller/run.ini >step.txt ||
        { cat step.txt >&2; echo "tour: $header does not do what the library does" >&2; exit 1; }
    rm -f beside
    tell "   $header, compiled and swum beside the library's controller; the largest differences:"
    sed 's/^/    /' step.txt | tee -a "$story"
fi
rm -f step.txt step.err
cp "$story" report.txt
