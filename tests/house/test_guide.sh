# SPDX-License-Identifier: MIT
# The C of the guides compiles without a warning, and what is a whole program runs. Arguments: the source directory, the
# library, the C compiler.
root=$1
library=$2
shift 2
. "$root/tests/tap.sh"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1

# wrap BLOCK: a whole program and definitions as they stand; statements as the body of a function of what the guide speaks of.
wrap() {
    if head -n 1 "$1" | grep -q '^#include'; then
        cat "$1"
    elif head -n 1 "$1" | grep -q '^static'; then
        printf '#include <moray/moray.h>\n'
        cat "$1"
    else
        cat <<END
#include <moray/moray.h>
void block(const moray_ocp *ocp, moray_settings settings, moray_solution *solution, moray_solution *next,
           const moray_ocp *const displaced[4], const moray_ocp *other, double h, double step, moray_solution *predicted);
void block(const moray_ocp *ocp, moray_settings settings, moray_solution *solution, moray_solution *next,
           const moray_ocp *const displaced[4], const moray_ocp *other, double h, double step, moray_solution *predicted)
{
END
        cat "$1"
        echo '}'
    fi
}

compiler=$*
compile() {
    $compiler -std=gnu11 -Wall -Wextra -Werror -Wno-unused -Wno-unused-parameter -I "$root/include" "$@" 2>err
}

programs=0
for page in problems/README.md src/control/README.md; do
    rm -f block_*
    awk '/^```c$/ { inside = 1; n++; next } /^```$/ { inside = 0 } inside { print >("block_" n) }' "$root/$page"
    for block in block_*; do
        wrap "$block" >block.c
        if grep -q 'int main' "$block"; then
            programs=$((programs + 1))
            compile block.c -o program "$library" -lm
            check "$page, $block compiles: $(head -n 1 err)" [ -x program ]
            LD_LIBRARY_PATH=$(dirname "$library") ./program >out 2>err </dev/null
            check "and runs: $(tail -n 1 err)" [ $? -eq 0 ]
            said=$(sed -n 's/.*printf(.*); \/\/ \([-0-9. ]*\):.*/\1/p' "$block")
            check "and prints what the guide says: ${said:-nothing in particular}" grep -qF -e "$said" out
            rm -f program
        else
            compile -fsyntax-only block.c
            check "$page, $block compiles: $(head -n 1 err)" [ ! -s err ]
        fi
    done
done
check "whole programs among them: $programs" [ $programs -ge 2 ]
printf 'static int broken(void) { return moray_solve(1); }\n' >block_0
wrap block_0 >block.c
check "a call that is not there would be told" eval '! compile -fsyntax-only block.c'
tap_done
