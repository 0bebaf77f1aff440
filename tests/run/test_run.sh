# SPDX-License-Identifier: MIT
# What a program around moray_app_run gives its user. Arguments: the demo program, the source directory.
. "$2/tests/program.sh"

# says TEXT: one line on standard error with TEXT in it.
says() {
    one_line && grep -qF -e "$1" err
}

# has KEY VALUE TOLERANCE: the first value of KEY in the JSON.
has() {
    near "$(number "$1")" "$2" "$3"
}

# ---- Solved
run --json --out results
check "solved and certified: exit 0, nothing said: $(cat err)" eval '[ $code -eq 0 ] && [ ! -s err ]'
check "one JSON object" eval '[ "$(head -c 1 out)" = "{" ] && [ "$(tail -n 1 out)" = "}" ]'
check "objective 3" has objective 3 1e-6
check "parameter by its name, 1/2" has share 0.5 1e-6
check "gate after 1 s" has tf 1 1e-6
check "half of the effort to it" eval 'tr -d "\n\t" <out | grep -o "\"integrals\":\[[0-9.e-]*\]" | head -n 1 |
    sed "s/.*\[\(.*\)\]/\1/" | awk "{ exit !(\$1 > 1.499999 && \$1 < 1.500001) }"'
for key in problem version scheme intervals constants phases solver certificate iterations nvar ncon nnz_jac nnz_hess \
    time_s eval_time_s kkt mesh_error between_nodes resimulation derivatives directions hamiltonian gap curvature composed untold unseen \
    why; do
    check "summary has $key" grep -q "\"$key\":" out
done
check "certificate passes" grep -q '"pass":.true' out
check "summary.json is what --json prints" cmp out results/summary.json
check "every figure by phase and unit, and nothing else" [ "$(ls -A results | tr '\n' ' ')" = \
    "controls_1_to-the-gate.svg controls_2_beyond.svg convergence.svg costates.csv mesh.svg multipliers.csv report.html run.ini solution.moray states_1_to-the-gate.svg \
states_1_to-the-gate_2.svg states_2_beyond.svg states_2_beyond_2.svg summary.json trajectory.csv " ]
check "columns with names and units, phases of the same names share them" \
    [ "$(head -n 1 results/trajectory.csv)" = 'phase,t [s],x [m],v [m/s],u [N]' ]
# x = 3 d (t/T)^2 - 2 d (t/T)^3 with d = T = 2
check "the trajectory is the cubic" awk -F, 'NR > 1 { t = $2; e = $3 - (1.5 * t * t - 0.5 * t * t * t); n++
    if (e > 1e-6 || e < -1e-6) bad = 1 } END { exit bad || n < 400 }' results/trajectory.csv
check "from start to end" eval 'sed -n 2p results/trajectory.csv | grep -q "^1,0," && tail -n 1 results/trajectory.csv | grep -q "^2,2,"'
check "costates have names, units, a row for each node" eval '
    [ "$(head -n 1 results/costates.csv)" = "phase,t [s],costate of x [N^2 s/m],costate of v [N^2 s/(m/s)]" ] &&
    [ "$(wc -l <results/costates.csv)" -eq 83 ]'
# u = x'' = 3 - 3 t, H = u^2/2 + lambda_x v + lambda_v u: lambda_v = -u, lambda_x = -lambda_v' = -3
check "and are those of the cubic" awk -F, 'NR > 1 { e = $3 + 3; d = $4 + 3 - 3 * $2; n[$1]++
    if (e * e > 1e-10 || d * d > 1e-10) bad = 1 } END { exit bad || n[1] != 41 || n[2] != 41 }' results/costates.csv
# points FIGURE: x and y on the screen of the first curve, behind the two of its key.
points() {
    tr -d "\n" <"$1" | grep -o "rgb( *0, 114, 178)'[^>]*d='[^']*" | sed "s/.*d='//" | tr ' ' '\n' | sed -n 's/^[ML]\([0-9.]*\),\([0-9.]*\)$/\1 \2/p' | tail -n +3
}
check "a figure of the second phase shows that alone: on from the gate, and ever further" eval 'points results/states_2_beyond.svg |
    awk "NR > 1 && (\$1 < x || \$2 > y) { bad = 1 } { x = \$1; y = \$2 } END { exit bad || NR < 100 }"'
iterations() { number iterations; }
run --json --continue results/solution.moray
check "--continue from the solution that --out leaves: $(iterations) iterations" eval '[ $code -eq 0 ] && has objective 3 1e-6 &&
    [ "$(iterations)" -le 3 ] && grep -q "\"scheme\":.\"continued\"" out'
run --json
cold=$(iterations)
run --json --guess results/solution.moray --scheme radau4 --intervals 9
check "--guess, multipliers included, on another mesh: $(iterations) iterations of $cold" \
    eval '[ $code -eq 0 ] && has objective 3 1e-6 && has intervals 9 0 && [ "$(iterations)" -lt "$cold" ] && grep -q radau4 out'
run --json --guess results/trajectory.csv
check "--guess, from a trajectory" eval '[ $code -eq 0 ] && has objective 3 1e-6'
run --guess results/solution.moray --continue results/solution.moray
check "not both: $(cat err)" eval '[ $code -eq 2 ] && says "must be one of them"'
sed '20s|.*|x 2|' results/solution.moray >mangled
run --guess mangled
check "a mangled file is refused with its line: $(cat err)" eval '[ $code -eq 2 ] && says "mangled, line 20: a finite number expected"'
sed '1s/ 1 / 2 /' results/solution.moray >newer
run --guess newer
check "so is another version of it: $(cat err)" eval '[ $code -eq 2 ] && says "line 1: moray-solution 1 expected"'
check "the report has the table, the figures, the command line" eval '
    grep -q "Certificate: pass" results/report.html && grep -q "<svg" results/report.html &&
    grep -q "<pre>run_demo" results/report.html'
run
check "the table: objective by its name" grep -q '^effort  *[0-9.]*  *N^2 s$' out
check "the table: integral of each phase" grep -q '^integral q\[0\] of beyond  *1\.5[0-9]*  *N^2 s$' out
check "the table: certificate" grep -q '^Certificate: pass$' out
check "the table: no mesh history where there is one mesh" eval '! grep -q "^Meshes" out'
run --json --set gate=1.2 --scheme radau4 --intervals 7 --tol 1e-9
check "--set reaches the functions, other options the solver" \
    eval '[ $code -eq 0 ] && has gate 1.2 0 && has intervals 7 0 && grep -q radau4 out && has tf 1.1341378 1e-6'

# ---- Options of Ipopt by their names, and no option file
printf 'max_iter 3\ntol 1e-2\nprint_level 5\n' >ipopt.opt
run --json
check "ipopt.opt in the working directory decides nothing" \
    eval '[ $code -eq 0 ] && [ "$(head -c 1 out)" = "{" ] && has objective 3 1e-6 && [ ! -s err ]'
rm ipopt.opt
run --json --set ipopt.max_iter=1
check "--set ipopt.KEY: $(cat err)" eval '[ $code -eq 1 ] && [ "$(iterations)" -eq 1 ]'
run --json --set ipopt.max_iter=1 --set ipopt.max_iter=100 --set ipopt.mu_strategy=adaptive
check "the last one counts, a text" eval '[ $code -eq 0 ] && has objective 3 1e-6'
printf '[ipopt]\nmax_iter = 1\n' >one.ini
run --json --config one.ini
check "in an INI file" eval '[ $code -eq 1 ] && [ "$(iterations)" -eq 1 ]'
run --json --config one.ini --set ipopt.max_iter=100
check "which the command line overrides" [ $code -eq 0 ]
run --json --set ipopt.print_level=5
check "its log stands on standard error" eval '[ $code -eq 0 ] && [ "$(head -c 1 out)" = "{" ] && grep -q "EXIT: Optimal" err'
run --set ipopt.tolerance=1
check "an unknown key: $(cat err)" eval '[ $code -eq 2 ] && [ ! -s out ] && says "ipopt.tolerance: Ipopt has no such option"'
run --set ipopt.tol=tiny
check "a bad value: $(cat err)" eval '[ $code -eq 2 ] && [ ! -s out ] && says "ipopt.tol = tiny: not a value"'
run --set ipopt.tol
check "no value: $(cat err)" eval '[ $code -eq 2 ] && [ ! -s out ] && says "must be KEY=VALUE"'
printf '[ipopt]\ntol = 1e-9\ntol = 1e-8\n' >twice.ini
run --config twice.ini
check "twice in a file: $(cat err)" eval '[ $code -eq 2 ] && says "twice.ini:3: tol is given twice"'

# ---- Streams that are closed, folders that are not there
run --json
cp out usual
for closed in '<&-' '2>&-' '<&- 2>&-'; do
    eval "\"\$program\" --json --out closed $closed >out"
    code=$?
    check "with $closed: as ever" eval '[ $code -eq 0 ] && has objective 3 1e-6 && cmp closed/summary.json out && [ ! -e closed/.part ]'
    rm -rf closed
done
(unset HOME; TMPDIR=/no/such LC_ALL=xx_XX.UTF-8 POSIXLY_CORRECT=1 OMP_NUM_THREADS=3 "$program" --json >out 2>err)
check "without HOME, with odd TMPDIR, locale and threads" \
    eval 'grep -v "_s\":\|time\|seconds\|threads" usual >a && grep -v "_s\":\|time\|seconds\|threads" out >b && cmp a b'

run --json --scheme trapezoid --intervals 3 --set mesh_tol=1e-4 --set refinements=20
check "a coarse mesh is refined: $(grep -c '"nodes"' out) meshes" \
    eval '[ $code -eq 0 ] && [ $(grep -c "\"nodes\":" out) -gt 1 ] && has objective 3 1e-3'
meshes=$(grep -c '"nodes"' out)
run --scheme trapezoid --intervals 3 --set mesh_tol=1e-4 --set refinements=20
check "the table: every mesh, the first of 6 intervals and 8 nodes" eval '
    grep -A 2 "^Meshes$" out | tail -n 2 | tr -s " " | tr "\n" ";" |
        grep -qE "^ intervals nodes error iterations time \[s\];solved 6 8 [0-9.e-]+ [0-9]+ [0-9.e-]+;$" &&
    [ "$(grep -c "^solved  " out)" -eq "$meshes" ]'
run --json --scheme trapezoid --intervals 3 --set mesh_tol=1e-4
check "and only when asked for" eval '[ $code -eq 3 ] && [ $(grep -c "\"nodes\":" out) -eq 1 ]'
run --check
check "--check finds exact derivatives" eval '[ $code -eq 0 ] && grep -q "^first derivatives differ by at most [0-9.]*e-1" out'
run --check --set crooked=1
check "--check names the wrong one: exit 1" \
    eval '[ $code -eq 1 ] && says "derivatives are wrong" && grep -q "dynamics of state v.*control u" out'

# ---- Not certified, not solved, interrupted, not stated
run --json --set mesh_tol=1e-300
check "certificate failed: exit 3 and a line that says what to try: $(cat err)" \
    eval '[ $code -eq 3 ] && says "certificate failed" && says "try" && grep -q "\"pass\":.false" out'
run --set gate=0
check "a phase without length: $(cat err)" eval '[ $code -eq 3 ] && says "no length" && says "bound its duration"'
run --set ipopt.mu_target=1e-2 --tol 1e-3
check "stopped inside the constraints: $(cat err)" eval '[ $code -eq 3 ] && says "stopped inside" && says "try a smaller tol"'
run --tol 1e-15 --set ipopt.acceptable_iter=1 --set ipopt.acceptable_tol=1e-7
check "solved to a looser tolerance, and as good as the certificate asks: exit 0" eval '[ $code -eq 0 ] &&
    grep -q "looser tolerance" out && grep -q "^Certificate: pass" out'
run --json --set gate=9 --out unsolved
check "not solved: exit 1 and a line that names the constraint: $(cat err)" eval '[ $code -eq 1 ] && says "Largest violation"'
check "not solved: the summary says so, and its certificate is empty" \
    eval 'grep -q "\"status\":.\"infeasible\"" out && grep -q "\"kkt\":.null" out && grep -q "\"pass\":.false" out &&
          cmp out unsolved/summary.json'
run --set max_iterations=2
check "iteration limit: exit 1: $(cat err)" eval '[ $code -eq 1 ] && says "iteration limit after 2"'
run --json --set raise=1 --out interrupted
check "SIGINT: exit 130: $(cat err)" eval '[ $code -eq 130 ] && says "interrupted after"'
check "SIGINT: what there is is written" eval 'cmp out interrupted/summary.json && grep -q "\"status\":.\"interrupted\"" out &&
    [ -s interrupted/trajectory.csv ] && [ -s interrupted/report.html ]'
check "SIGINT: the best iterate is written, and how to go on is told" eval 'says "to go on: --continue interrupted/run_demo.iterate" &&
    [ -s interrupted/run_demo.iterate ] && [ -z "$(find . -name "*.part")" ]'
stopped=$(number iterations)
run --json --set raise=1 --set signal=15 --out terminated
check "SIGTERM is answered likewise: $(cat err)" eval '[ $code -eq 130 ] && says "--continue terminated/run_demo.iterate" &&
    grep -q "\"status\":.\"interrupted\"" terminated/summary.json && [ -s terminated/run_demo.iterate ]'
run --json --continue interrupted/run_demo.iterate
check "--continue goes on to the optimum, on the mesh of the file: $(number iterations) iterations after $stopped" \
    eval '[ $code -eq 0 ] && has objective 3 1e-6 && grep -q "\"scheme\":.\"continued\"" out && has intervals 0 0 && has nodes 82 0'
run --json --continue interrupted/run_demo.iterate --intervals 7 --scheme radau4
check "or on another" eval '[ $code -eq 0 ] && has objective 3 1e-6 && has intervals 7 0 && grep -q radau4 out'
run --set raise=1 --intervals 30
check "without --out the iterate is in the working directory, and it has its mesh" \
    eval '[ $code -eq 130 ] && says "--continue run_demo.iterate" && run --json --continue run_demo.iterate &&
          [ $code -eq 0 ] && has objective 3 1e-6 && has nodes 122 0'
refuse "nowhere: cannot be opened: No such file" --continue nowhere
head -n 20 run_demo.iterate >cut
refuse "line 21: more expected" --continue cut
echo "x,y" >other
refuse "line 1: moray-solution 1 expected" --continue other
sed "1s/run_demo/brachistochrone/" run_demo.iterate >other
refuse "is of problem brachistochrone, not of run_demo" --continue other
run --set raise=2 --out twice
check "SIGINT twice: ends at once, nothing is left" eval '[ $code -eq 130 ] && [ ! -s out ] && [ ! -e twice ]'
run --set raise=2 --set signal=15 --out twice
check "SIGTERM twice, too" eval '[ $code -eq 143 ] && [ ! -s out ] && [ ! -e twice ]'
run --set undefined=1 --out reason
check "functions not finite at the guess: exit 1: $(cat err)" eval '[ $code -eq 1 ] && says "not finite"'
check "which is left with the settings, and nothing else" eval '[ "$(ls -A reason | tr "\n" " ")" = "run.ini summary.json " ] &&
    grep -q "^undefined = 1" reason/run.ini && grep -q "\"reason\":.*not finite" reason/summary.json'
for wrong in --links=3 --robot=x --current=1,1; do
    run $wrong
    check "no robots here: $(cat err)" eval '[ $code -eq 2 ] && says "unknown option"'
done
run --set gat=1
check "unknown key: exit 2: $(cat err)" eval '[ $code -eq 2 ] && says "did you mean gate"'
run --scheme euler --json --out euler
check "bad scheme: exit 2, nothing printed or written: $(cat err)" \
    eval '[ $code -eq 2 ] && says "scheme = euler: must be" && [ ! -s out ] && [ ! -e euler ]'
run --help
check "--help has the constants and nothing of robots" eval '[ $code -eq 0 ] && grep -q "^  gate=X" out && ! grep -qiE "robot|model|^Solution" out'
run --version
check "--version: $(cat out)" eval '[ "$(wc -l <out)" -eq 1 ] && grep -q "^run_demo (moray) [0-9.]*$" out'
run --quiet --out d
check "a folder may have one letter" [ -s d/summary.json ]
(ulimit -f 1 && "$program" --quiet --out limited >out 2>err)
code=$?
check "files that may not grow: exit 2, not a signal: $(cat err)" eval '[ $code -eq 2 ] && says "cannot be written"'
lost
lost --json
lost --help
lost --check
tap_done
