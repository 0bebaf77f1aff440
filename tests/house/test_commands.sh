# SPDX-License-Identifier: MIT
# The commands of the docs do what they are there for. Arguments: the command moray, the source directory.
. "$2/tests/program.sh"
PATH=$(dirname "$program"):$PATH
export PATH

# blocks FILE: its commands, each block in a file of its own, block_1, block_2, ...
blocks() {
    rm -f block_*
    awk '/^```sh$/ { inside = 1; n++; next } /^```$/ { inside = 0 } inside { print >("block_" n) }' "$1"
}

for page in "$source"/docs/*.md; do
    blocks "$page"
    for block in block_*; do
        [ -f "$block" ] || continue
        sh -e "$block" >out 2>err </dev/null
        code=$?
        check "${page##*/}: $(grep moray "$block" | tail -n 1): $(tail -n 1 err)" [ $code -eq 0 ]
        check "it says or leaves something" eval '[ -s out ] || [ -n "$(find . -newer "$block" -size +0 ! -name "block_*" ! -name err)" ]'
    done
done
check "there are commands to run" [ $tap_run -ge 8 ]
check "the simulated path is there" [ -s swum/trajectory.csv ]
check "and the sweep's file" [ -s links.nc ]
tap_done
