# SPDX-License-Identifier: MIT
# The program classics as a user meets it. Arguments: the program, the source directory.
. "$2/tests/program.sh"

# ---- A table
run brachistochrone rayleigh hang-glider-50
check "exit 0: $(cat err)" [ $code -eq 0 ]
check "a line a problem" [ "$(wc -l <out)" -eq 4 ]
check "with optimum, published value, difference and verdict" \
    grep -qE '^brachistochrone +1\.801603[0-9]* +1\.80160312 +-?[0-9.]+e-09 agrees ' out
check "a value that the data do not give" grep -qE '^rayleigh +44\.804[0-9]* +44\.77625 +2\.8e-02 by the data ' out
check "intervals of every mesh, and the certificate" grep -qE '^rayleigh .* s +20 [0-9]+ [0-9 ]*passes$' out
check "a mesh of COPS without a published value" grep -qE '^hang-glider-50 +128[0-9.]+ +- +- +solved .* fixed mesh: ' out
check "no progress where there is no terminal" [ ! -s err ]

# ---- JSON and files
run moon-lander --json --out results
check "exit 0: $(cat err)" [ $code -eq 0 ]
check "optimum $(number moon-lander optimum)" near "$(number moon-lander optimum)" 1.4203125990 1.5e-7
check "beside what was printed" [ "$(number moon-lander published)" = 1.4204 ]
check "meshes from 20 intervals" [ "$(number meshes intervals)" -eq 20 ]
check "to an error below 1e-6" awk '/"mesh_error"/ { sub(/.*:/, ""); last = $0 + 0 } END { exit !(last < 1e-6) }' out
check "summary and report" [ -s results/summary.json ] && [ -s results/report.html ]

run brachistochrone --scheme trapezoid --intervals 10 --refinements 0
check "a coarse mesh differs: $(cat err)" eval '[ $code -eq 1 ] && grep -q "0 of 1 not solved, 1 differ" err'

# ---- Bad input
refuse 'no-such-problem' no-such-problem
refuse 'refinements = 101' brachistochrone --refinements 101
refuse 'scheme' brachistochrone --scheme simpson
for wrong in --links=3 --robot=x --current=1,1 --model=fp; do
    run brachistochrone $wrong
    check "no robots here: $(cat err)" eval '[ $code -eq 2 ] && one_line && grep -q "unknown option" err'
done
run --help
check "--help knows no robot" eval '! grep -qi "snake\|--robot\|--links" out'

lost rayleigh
lost rayleigh --json
lost --version
tap_done
