# SPDX-License-Identifier: MIT
# The commands of the documents do what they are there for: every block of README.md, docs and problems; long ones in a
# brief form. Arguments: the command moray, the source directory, the build directory, the compiler with its flags.
build=$3
. "$2/tests/program.sh"
case $build in
/*) ;;
*) build=$OLDPWD/$build ;;
esac
shift 3
mkdir bin
# What is not installed is told its place; by the compiler of the earlier PATH, or cc would call itself.
printf '#!/bin/sh\nPATH="%s" exec %s -I%s "$@"\n' "$PATH" "$*" "$source/include" >bin/cc
PATH=$work/bin:$(dirname "$program"):$PATH
export PATH PKG_CONFIG_PATH="$build/meson-uninstalled" LD_LIBRARY_PATH="$build:$build/src/sweep${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}"
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_rmaps_base_oversubscribe=1
# python_with LINE: the Python that can do it.
python_with() {
    for one in "$python3" /usr/bin/python3; do
        ! "$one" -c "$1" 2>/dev/null || { echo "$one" && return; }
    done
    return 1
}
python3=$(command -v python3)
# As a page names it: the one with numpy, if any, which finds the module.
! numpy=$(python_with 'import numpy') ||
    printf '#!/bin/sh\nPYTHONDONTWRITEBYTECODE=1 PYTHONPATH="%s" exec %s "$@"\n' "$source/share/python" "$numpy" >bin/python3
! compiler=$(command -v c++) || printf '#!/bin/sh\nPATH="%s" exec %s -I%s "$@"\n' "$PATH" "$compiler" "$source/include" >bin/c++
ln -s "$source/share" share
# The tree's own names, without its building (the tests "scripts" and "install" have that); Slurm's, by mpirun.
mkdir -p problems tests build/problems
for file in "$source"/problems/*; do
    [ "${file##*/}" = run.sh ] || ln -s "$file" problems
done
# shellcheck disable=SC2016
echo 'exec moray "$@"' >problems/run.sh
echo 'echo "the test commands is of this run"' >tests/run.sh
ln -s "$(dirname "$program")"/* build/problems
printf '#!/bin/sh\nexec sh -e "$@"\n' >bin/sbatch
printf '#!/bin/sh\nexec mpirun -n 2 "$@"\n' >bin/srun
printf '#!/bin/sh\necho "meson $*"\n' >bin/meson
chmod +x bin/*

# Brief forms, one a line; each has to be of some command.
cat >brief <<'END_BRIEF'
s/run\.sh max_speed .*/run.sh max_speed --model control --over none/
s/mpirun -n 64/mpirun -n 2/
s/--grid links=4:16:13 --file max_speed\.nc$/--grid links=8,10 --file max_speed.nc -- --model control --over none/
s/--grid current_x=-0\.2:0\.2:21 --grid links=4:16:13 --file max_speed\.nc -- /--grid current_x=0,0.01 --grid links=10 --file current.nc -- --over none /
s/sbatch problems.sweep\.slurm/sed 's|max_speed --grid.*nc|simulate --grid links=4,6 --file slurm.nc|; s|--hydro.*|--duration 1|' problems\/sweep.slurm >short \&\& sbatch short/
END_BRIEF

# blocks PAGE: its commands, each block in a file of its own, block_1, block_2, ...; behind a command "# exit code N" is
# the code that it ends with. The first C program of the page is mine.c, which blocks speak of.
blocks() {
    rm -f block_*
    awk '/^```sh$/ { inside = 1; n++; next } /^```$/ { inside = 0 } inside { print >("block_" n) }' "$1"
    awk '/^```c$/ { inside = 1; text = ""; next } /^```$/ { if (inside && text ~ /int main/) { printf "%s", text; exit } inside = 0 }
        inside { text = text $0 "\n" }' "$1" >mine.c
    awk '/^```cpp$/ { inside = 1; next } /^```$/ { inside = 0 } inside' "$1" >mine.cpp
    for block in block_*; do
        [ ! -f "$block" ] || sed -i -e 's/^\(.*[^ ]\) *# exit code \([0-9]*\)$/code=0; \1 || code=$?; [ $code -eq \2 ]/' -f brief "$block"
    done
}

# unfenced PAGE: lines that are commands in a block which this test does not find.
unfenced() {
    awk '/^```/ { fenced = !fenced; ours = fenced && $0 != "```"; next }
        fenced ? !ours : /^    / { if ($1 ~ /^(sh|moray|cc|c\+\+|meson|ninja|mpirun|sbatch|python3|octave-cli|\.\/[a-z]*)$/) print }' "$1"
}
printf '    sh problems/run.sh demo\n```\nmoray demo\n```\n```c\n    moray status;\n```\n' >page
check "a command that would not be run would be told" [ "$(unfenced page | wc -l)" -eq 2 ]

# runs BLOCK: not what compiles in the sanitizers' half, whose library no other compiler's program can load, nor what is of
# a language that is not installed.
runs() {
    thorough || ! grep -qE '^(cc|c\+\+|python3) ' "$1" || return 1
    ! grep -q '^octave-cli ' "$1" || command -v octave-cli >/dev/null || return 1
    for tool in c++ python3; do
        ! grep -qF "$tool " "$1" || [ -x "bin/$tool" ] || return 1
    done
}

for page in "$source"/README.md "$source"/docs/*.md "$source"/problems/*.md; do
    name=${page#"$source/"}
    check "$name: no command in a block that is not run: $(unfenced "$page" | head -n 1)" [ -z "$(unfenced "$page")" ]
    cp "$page" page
    cat "$page" >>pages
    blocks page
    n=0
    while block=block_$((n += 1)) && [ -f "$block" ]; do
        runs "$block" || continue
        sh -e "$block" >out 2>err </dev/null
        code=$?
        check "$name: $(grep -v '^#' "$block" | tail -n 1): exit $code $(tail -n 1 err)" [ $code -eq 0 ]
        check "it says or leaves something" eval '[ -s out ] || [ -n "$(find . -newer "$block" -size +0 ! -name "block_*" ! -name err)" ]'
    done
done
for page in "$source"/results/*.md "$source"/src/*.md "$source"/src/*/*.md; do
    check "${page#"$source/"}: no command that is not run" eval '! grep -q "^ *\`\`\`sh" "$page"'
done
check "there are commands to run: $tap_run" [ $tap_run -ge 30 ]
check "the simulated path is there" [ -s swum/trajectory.csv ]
check "and the sweeps' files" eval '[ -s links.nc ] && [ -s max_speed.nc ] && [ -s slurm.nc ]'
while read -r form; do
    check "a brief form is of some command: $form" eval '! sed "$form" pages | cmp -s - pages'
done <brief

# Commands within a paragraph, but for those with words to be put in: they begin to work, and end well or are at it.
if thorough; then
    grep -ohE '`moray [a-z_]+ [^`]*`' "$source"/README.md "$source"/docs/*.md "$source"/problems/*.md | tr -d '`' | grep -vE ' [A-Z]{2,}' | sort -u >inline
    while read -r command; do
        # shellcheck disable=SC2086
        eval "timeout 1 $command" >out 2>err </dev/null
        code=$?
        check "$command: exit $code: $(tail -n 1 err)" eval '[ $code -eq 0 ] || [ $code -eq 124 ]'
    done <inline
    check "there are some: $(wc -l <inline)" [ "$(wc -l <inline)" -ge 5 ]
fi
if python=$(python_with 'import xarray, netCDF4'); then
    awk '/^```python$/ { inside = 1; next } /^```$/ { inside = 0 } inside' "$source/docs/sweeps.md" >read.py
    check "xarray reads it as sweeps.md says: $("$python" read.py 2>&1 | tail -n 1)" eval '"$python" read.py | grep -q "^ *0\.1 *0\.[0-9]"'
else
    echo "ok $((tap_run += 1)) - xarray reads it # SKIP no Python with xarray and netCDF4 (Debian's python3-xarray, python3-netcdf4)"
fi
if thorough && [ -x bin/python3 ]; then
    awk '/^```python$/ { inside = 1; next } /^```$/ { inside = 0 } inside' "$source/docs/languages.md" >problem.py
    said=$(python3 problem.py 2>&1)
    check "the problem in Python says what the page tells: $said" grep -qF "prints \`$said\`" "$source/docs/languages.md"
fi
tap_done
