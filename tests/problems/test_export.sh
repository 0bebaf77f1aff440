# SPDX-License-Identifier: MIT
# The program export: its C header compiled without a library and swum beside the library's own controllers, its tables,
# the robot for other simulators, bad input. Arguments: the program, the source directory, the shared library, the
# program simulate, the compiler with its flags.
. "$2/tests/program.sh"
library=$3
simulate=$4
shift 4

# compiled KIND [COMPILER...]: the header in made/, freestanding, in double and in float, and needs no symbol.
calls=
compiled() {
    what=$1
    shift
    for real in double float; do
        check "$what, $real, $1: freestanding without a warning" "$@" -std=c99 -pedantic -ffreestanding -Wall -Wextra -Wconversion \
            -Wdouble-promotion -Werror -DSNAKE_REAL=$real ${calls:+"-DSTEER=$calls"} -Imade \
            -c "$source/tests/problems/export_freestanding.c" -o use.o
    done
}

# free_of_symbols: what was compiled last needs nothing (an uninstrumented compiler's).
free_of_symbols() {
    gcc -std=c99 -ffreestanding -O2 ${calls:+"-DSTEER=$calls"} -Imade -c "$source/tests/problems/export_freestanding.c" -o use.o &&
        [ -z "$(nm -u use.o)" ]
}

# swum KIND REAL COMPILER...: beside the library.
swum() {
    kind=$1
    real=$2
    shift 2
    check "builds with the library" "$@" "-DSTEERED=$kind" "-DSNAKE_REAL=$real" -Imade "-I$source/problems" "-I$source/include" \
        "$source/tests/problems/export_check.c" "$source/problems/export/gather.c" "$source/problems/export/law.c" \
        "$source/problems/export/options.c" -o beside "$library" -lm "-Wl,-rpath,$(dirname "$library")"
    ./beside --config made/run.ini >told 2>&1
    swum=$?
    sed 's/^/# /' told
    check "kind $kind, $real: as the library does" [ $swum -eq 0 ]
}

# export_to_c KIND CALLS ARGUMENTS: into made/.
export_to_c() {
    kind=$1
    calls=$2
    shift 2
    rm -rf made
    run "$@" --out made
    check "kind $kind: $(cat err)" [ $code -eq 0 ]
}

# ---- A gait --------------------------------------------------------------------------------------------------------
"$simulate" --model fp --duration 1 --set omega_deg_s=100 --set delta_deg=45 --set taper=-0.3 --set phi0_deg=2 --out swum --quiet >/dev/null
export_to_c 0 '' --from swum --set rate_hz=50
compiled "a gait" "$@"
check "it calls nothing: $(nm -u use.o | tr '\n' ' ')" free_of_symbols
if command -v arm-none-eabi-gcc >/dev/null; then
    compiled "a gait" arm-none-eabi-gcc -mcpu=cortex-m4 -mthumb
fi
swum 0 double "$@"
thorough && swum 0 float "$@"
check "version and command in the header" grep -q '^// Command: `export --from swum --set rate_hz=50`$' made/snake.h
check "the run's gait: $(grep -c . made/gait.csv) lines" eval '[ "$(grep -c . made/gait.csv)" -eq 181 ]' # 3.6 s in 1/50 s
check "an angle after a quarter of a period: alpha (1 - taper) + 2 deg" eval 'near "$(awk -F, "NR == 47 { print \$2 * 180 / 3.14159265358979 }" made/gait.csv)" \
    "$(awk "/amplitude/ { exit } END { print 2 * sin(22.5 * 3.14159265358979 / 180) * 20 * 1.3 + 2 }" /dev/null)" 1e-9'
check "the ramp begins straight and at rest" eval 'sed -n 2p made/ramp.csv | awk -F, "{ for (k = 1; k <= NF; k++) if (\$k != 0) exit 1 }"'
check "the gait goes on where the ramp ends" eval 'near "$(tail -1 made/ramp.csv | cut -d, -f5)" "$(tail -1 made/gait.csv | cut -d, -f5)" 1e-3'

# ---- The robot -----------------------------------------------------------------------------------------------------
if command -v python3 >/dev/null; then
    python3 - >robot <<'END'
import xml.etree.ElementTree as tree
urdf, mujoco = tree.parse("made/snake.urdf").getroot(), tree.parse("made/snake.xml").getroot()
bodies = mujoco.findall(".//inertial")
print(sum(float(m.get("value")) for m in urdf.iter("mass")), sum(float(b.get("mass")) for b in bodies),
      len(urdf.findall("joint")), len([j for j in mujoco.iter("joint") if j.get("name").startswith("joint_")]),
      len(urdf.findall("link")), len(bodies), len(list(mujoco.iter("motor"))),
      urdf.find(".//inertia").get("izz"), bodies[-1].get("diaginertia").split()[2], urdf.find("joint/origin").get("xyz").split()[0])
END
    read -r mass mass_too joints joints_too links links_too motors J J_too length <robot
    check "well-formed; 9 joints, 10 links: $joints $joints_too $motors $links $links_too" eval \
        '[ "$joints $joints_too $motors $links $links_too" = "9 9 9 10 10" ]'
    check "ten elliptic cylinders weigh $mass, $mass_too kg" eval 'near $mass 6.5973445725 1e-9 && near $mass_too 6.5973445725 1e-9'
    # m (l^2/3 + a^2/4) + lambda_1
    check "J and lambda_1: $J, $J_too" eval 'near $J 0.001490130197 1e-11 && near $J_too 0.001490130197 1e-11'
    check "links of 0.14 m: $length" near "$length" 0.14 1e-12
fi

run --robot "$source/problems/robots/head_and_fin.ini" --out unequal
# masses FILE WORD: of all links in the order of the file, which begins at the tail.
masses() {
    grep -o "$2=\"[^\"]*" "$1" | awk -F'"' '{ printf "%s%.6g", (NR > 1 ? " " : ""), $2 }'
}
for file in 'snake.urdf mass value' 'snake.xml mass'; do
    masses "unequal/${file%% *}" "${file#* }" >listed
    check "links of their own from the tail to the head, $file: $(cat listed)" \
        [ "$(cat listed)" = "0.45 0.63 0.63 0.63 0.63 0.63 0.63 0.63 1.2" ]
done
check "which could be told: $(cat err)" [ $code -eq 0 ]

# ---- A free motion -------------------------------------------------------------------------------------------------
mkdir series
printf '[run]\nprogram = free_gait\n[problem]\npower_W = 0.3\n[robot]\nlinks = 3\n[solver]\ntol = 1e-8\n' >series/run.ini
printf '{"problem": "free_gait", "harmonics": 2, "omega_deg_s": 90, "series_rad": [0.1, 0, 0.3, 0.2, 0, 0.1, 0.05, 0, 0, -0.02]}\n' >series/summary.json
export_to_c 0 '' --from series --set ramp_periods=2
thorough && swum 0 double "$@"
check "3 links of the run" grep -q 'SNAKE_JOINTS 2 ' made/snake.h
refuse 'a gait with a series has no joint offset' --from series --law heading

# ---- Steering ------------------------------------------------------------------------------------------------------
steering='"first_principles_plan": {"gait": {"alpha_deg": 14, "omega_deg_s": 130, "delta_deg": 45, "phi0_deg": 0, "taper": 0}}'
settings() {
    mkdir "$1"
    printf '[run]\nprogram = %s\n[problem]\nomega_deg_s = 30:360\nphi0_max_m = 0.02\nradius_m = 2\npath = 0,0 4,0 4,6\nphi0_rate_m_s = 0.02\n[robot]\nlinks = 10\n' "$1" >"$1/run.ini"
}
settings heading_tracking
cat >heading_tracking/summary.json <<END
{"problem": "heading_tracking", $steering, "steering": [
 {"law": "feedback", "gait": "paper", "gain_m_rad": 0.9, "lead_s": 0, "validated": {"rms_deg": 1}},
 {"law": "feedback", "gait": "found", "gain_m_rad": 0.3, "lead_s": 0, "validated": {"rms_deg": 3}},
 {"law": "feedback", "gait": "found", "gain_m_rad": 0.15, "lead_s": 1.5, "validated": {"rms_deg": 2}},
 {"law": "plan and feedback", "gait": "found", "gain_m_rad": 0.2, "lead_s": 0, "validated": {"rms_deg": 0.1}}]}
END
awk 'BEGIN { print "t [s],heading [rad],phi_0 [rad]"; for (k = 0; k <= 300; k++) printf "%.17g,%.17g,%.17g\n", k / 10, 0.1 + 0.3 * sin(k / 60), 0.04 * sin(k / 40) }' >heading_tracking/trajectory.csv
target='snake_steer(state, t, phi[0], phi[1], dphi[0])'
export_to_c 1 "$target" --from heading_tracking --set integral_1_s=0.1 --set derivative_s=0.3 --set forward_m_s_rad=0.05
check "the best law of the run: 0.15 m/rad" grep -q '"gain_m_rad":.0.15,' made/summary.json
compiled "PID" "$@"
check "it calls nothing" free_of_symbols
swum 1 double "$@"
export_to_c 3 'snake_steer(state, t, phi[0])' --from heading_tracking --law plan
compiled "a plan" "$@"
thorough && swum 3 double "$@"

settings path_following
cat >path_following/summary.json <<END
{"problem": "path_following", $steering, "steering": [
 {"law": "line of sight", "gait": "found", "gain_m_rad": 0.06, "lookahead_m": 0.7, "ahead_m": 0.4, "integral_gain_m_s": 0.03, "validated": {"cost": 3}},
 {"law": "line of sight", "gait": "found", "gain_m_rad": 0.02, "lookahead_m": 0.2, "ahead_m": 0.7, "integral_gain_m_s": 0, "validated": {"cost": 4}},
 {"law": "plan and feedback", "gait": "found", "gain_m_rad": 0.02, "lookahead_m": 0.2, "ahead_m": null, "integral_gain_m_s": null, "validated": {"cost": 2}}]}
END
export_to_c 2 'snake_steer(state, t, phi[0], phi[1], dphi[0])' --from path_following
check "path and limits of the run" eval 'grep -q "SNAKE_PIECES 3 " made/snake.h && grep -q "SNAKE_SIGHT_INTEGRAL SNAKE_C(0.03)" made/snake.h'
compiled "line of sight" "$@"
check "it calls nothing" free_of_symbols
if command -v arm-none-eabi-gcc >/dev/null; then
    compiled "line of sight" arm-none-eabi-gcc -mcpu=cortex-m4 -mthumb
fi
swum 2 double "$@"
thorough && swum 2 float "$@"
run --from path_following --set trial=2 --json
check "the second law is chosen" near "$(number gain_m_rad)" 0.02 1e-12
run --from path_following --set gain_m_rad=0.11 --json
check "what is given comes first" eval 'near "$(number gain_m_rad)" 0.11 1e-12 && near "$(number lookahead_m)" 0.7 1e-12'

# Of trials at sea the law that costs least is one with a plan, whose gain is nothing without it.
cp -r path_following trials
cat >trials/summary.json <<END
{"problem": "sea_trials", $steering, "laws": [
 {"name": "ILOS", "told": "nothing", "gain_m_rad": 0.07, "lookahead_m": 0.6, "ahead_m": 0.3, "integral_m_s": 0.01, "training_cost": 3},
 {"name": "plan and feedback", "told": "beliefs", "gain_m_rad": 0.5, "lookahead_m": 1.5, "training_cost": 1}]}
END
run --from trials --law path --json
check "the law without a plan: $(cat err)" eval '[ $code -eq 0 ] && near "$(number gain_m_rad)" 0.07 1e-12 && near "$(number lookahead_m)" 0.6 1e-12'

# ---- Bad input -----------------------------------------------------------------------------------------------------
refuse 'nowhere/run.ini: cannot be opened' --from nowhere
mkdir empty && cp series/run.ini empty
refuse 'JSON file empty/summary.json: cannot be read' --from empty
echo '{' >empty/summary.json
refuse 'is not JSON' --from empty
echo '{"problem": "max_speed", "error": "no gait"}' >empty/summary.json
refuse 'that run found nothing: no gait' --from empty
printf '{"problem": "free_gait", "harmonics": 2, "omega_deg_s": 90, "series_rad": [0.1, 0]}' >empty/summary.json
refuse '2 coefficients of a series, where 2 joints want 10' --from empty
printf '{"problem": "free_gait", "harmonics": 2, "omega_deg_s": 90, "series_m": [0.1, 0]}' >empty/summary.json
refuse 'a series of the control-oriented model' --from empty
printf '[robot]\nlinks = many\n' >empty/run.ini
refuse 'links = many' --from empty
refuse 'trial = 3: of the 3 laws' --from path_following --set trial=3
refuse 'trial = 7: of the 3 laws' --from path_following --set trial=7
refuse '--law path: --path must tell' --law path
refuse '--law plan: --plan FILE or --from DIR' --law plan
refuse 'no column t' --law plan --plan "$source/problems/schedules/turning.csv"
refuse 'phi0_deg = 2: the law of steering sets the joint offset' --law heading --set phi0_deg=2
refuse '--name My-robot: must be small letters' --name My-robot
refuse 'omega_deg_s = 0: must be above 0' --set omega_deg_s=0
refuse 'alpha_deg = 0' --law heading --set alpha_deg=0
lost
tap_done
