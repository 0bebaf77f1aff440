# SPDX-License-Identifier: MIT
# The command that runs the others. Arguments: it, the source directory.
. "$2/tests/program.sh"

# untimed: what a program prints, but for the times taken.
untimed() {
    grep -v '"[a-z_]*time_s"'
}

run --help
check "--help: exit $code" [ $code -eq 0 ]
sed -n 's/^  \([a-z_]*\)  .*/\1/p' out | sort >listed
for file in "$source"/problems/*.c; do
    name=${file##*/}
    [ "$name" = template.c ] || echo "${name%.c}"
done | sort >there
check "it lists every program of problems and no other: $(diff listed there | tr '\n' ' ')" cmp -s listed there
check "no line of more than 80 columns" eval '! grep -q "^.\{81\}" out'
run --version
check "--version: $(cat out)" eval '[ $code -eq 0 ] && grep -q "^moray [0-9.]*$" out'
version=$(sed 's/moray //' out)
while read -r name; do
    run "$name" --version
    check "$name is that program: $(cat out)" eval '[ $code -eq 0 ] && grep -q "^$name .*$version$" out'
done <there
run
check "without a name: exit $code and the list, on standard error" eval '[ $code -eq 2 ] && [ ! -s out ] && grep -q "max_speed" err'
run max_sped
check "an unknown one: $(cat err)" eval '[ $code -eq 2 ] && one_line && grep -q max_sped err && [ ! -s out ]'
run ../problems/max_speed
check "no path passes for a name" [ $code -eq 2 ]
run simulate --duration 2 --json --quiet
untimed <out >through
"${program%/*}/simulate" --duration 2 --json --quiet | untimed >alone
check "arguments pass, and it prints what the program prints alone" eval '[ -s alone ] && cmp -s through alone'
run simulate --set nonsense=1
check "so does the exit code: $(cat err)" [ $code -eq 2 ]
cp "$program" lonely
program=$PWD/lonely
run simulate --version
check "where no programs are it says so: $(cat err)" eval '[ $code -eq 2 ] && grep -q "simulate cannot be run" err'
tap_done
