# SPDX-License-Identifier: MIT
# The installed library serves a program built outside this tree: headers, pkg-config file, template.c, its published
# optimum. Arguments: the source directory, the build directory, the compiler with its flags.
source=$1
build=$2
shift 2
. "$source/tests/tap.sh"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1

check "meson install into an empty directory" meson install -C "$build" --no-rebuild --destdir "$work/root"
pc=$(find root -name moray.pc)
check "one pkg-config file: $pc" [ -f "$pc" ]
prefix=$work/root$(sed -n 's/^prefix=//p' "$pc")
export PKG_CONFIG_PATH="$work/${pc%/*}" PKG_CONFIG_SYSROOT_DIR="$work/root"
library=$(dirname "$(find root -name libmoray.so)")
export LD_LIBRARY_PATH="$work/$library${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}"
check "it knows nothing of the places where moray was built" eval '! grep -qF -e "$source" -e "$build" "$pc"'
check "its version is the library's" [ "$(pkg-config --modversion moray)" = \
    "$("$prefix/bin/moray" --version | sed 's/.* //')" ]
check "one command among the system's, $(ls "$prefix/bin"), from where it finds the programs" eval \
    '[ "$(ls "$prefix/bin")" = moray ] && "$prefix/bin/moray" simulate --duration 1 --json --quiet | grep -q v_x_m_s'

# ---- Headers
(cd "$prefix/include" && find . -type f | sort) >installed
(cd "$source/include" && find . -type f | sort) >public
check "the public headers are installed, each once, and no other" cmp installed public
for header in $(sed 's|^\./||' installed); do
    printf '#include <%s>\nint main(void) { return 0; }\n' "$header" >one.c
    # shellcheck disable=SC2046
    check "$header compiles from there" "$@" -std=c11 -Wall -Wextra -Werror -fsyntax-only $(pkg-config --cflags moray) one.c
done

share=$prefix/share/moray
for file in LICENSE guide.md howto.md languages.md sweeps.md template.c robots/paper.ini schedules/turning.csv python/moray.py python/brachistochrone.py; do
    check "share/moray has $file" [ -s "$share/$file" ]
done
check "a robot from there swims" eval '"$prefix/bin/moray" simulate --robot "$share/robots/paper.ini" --duration 1 --json --quiet | grep -q v_x_m_s'

# ---- A stranger's program
cp "$share/template.c" mine.c
# shellcheck disable=SC2046
check "template.c builds with pkg-config's flags alone" "$@" mine.c -o mine $(pkg-config --cflags --libs moray)

# shellcheck disable=SC2046
check "and with the static library" "$@" mine.c -o alone $(pkg-config --cflags moray) "$library/libmoray.a" \
    $(pkg-config --static --libs-only-l moray | sed 's/-lmoray//')
check "which then is all it needs of moray" eval '! ldd ./alone | grep -q moray && ./alone --json --quiet | grep -q objective'

# optimum ARGUMENTS: the objective that the program finds.
optimum() {
    ./mine --json "$@" >summary.json && awk -F: '/"objective"/ { print $2 + 0; exit }' OFMT=%.12g summary.json
}
near() {
    awk -v got="$1" -v want="$2" 'BEGIN { exit !(got != "" && got - want < 2e-6 && want - got < 2e-6) }'
}
check "it finds the published optimum 4: $(optimum)" near "$(optimum)" 4
check "and with l = 1/10, 4 / (9 l) = 4.444444: $(optimum --set l=0.1)" near "$(optimum --set l=0.1)" 4.4444444
check "certified" eval './mine --out results && [ -s results/report.html ] && grep -q "\"pass\":.true" results/summary.json'
sed -n '/^```c$/,/^```$/p' "$source/docs/tutorial.md" | grep -v '^```' >mine.c
# shellcheck disable=SC2046
check "the program of the tutorial builds" "$@" mine.c -o mine $(pkg-config --cflags --libs moray)
check "its default mesh is too coarse, as it says: exit 3" eval './mine --quiet >/dev/null 2>&1; [ $? -eq 3 ]'
check "and refined it finds 4 / (9 l) within a millionth: $(optimum --set refinements=10)" \
    eval 'optimum --set refinements=10 | awk "{ exit !(\$1 - 4 < 4e-6 && 4 - \$1 < 4e-6) }"'
sed 's/\.u = MORAY_BOUNDS(moray_free())/.u = MORAY_BOUNDS(moray_between(-2, 2))/' mine.c >weak.c
# shellcheck disable=SC2046
check "a push too weak builds" "$@" weak.c -o weak $(pkg-config --cflags --libs moray)
check "and is infeasible: exit 1" eval './weak >/dev/null 2>err; [ $? -eq 1 ] && grep -q infeasible err'
sed -n '/^```c/,/^```$/p' "$source/src/control/README.md" | grep -v '^```' >loop.c
# shellcheck disable=SC2046
check "the example of src/control builds" "$@" loop.c -o loop $(pkg-config --cflags --libs moray)
check "and prints what it says: $(./loop)" grep -qF "// $(./loop):" loop.c
sed -n '/^```c/,/^```$/p' "$share/sweeps.md" | grep -v '^```' >swept.c
# shellcheck disable=SC2046
check "the example of sweeps.md builds" "$@" swept.c -o swept $(pkg-config --cflags --libs moray-sweep moray)
check "and prints what it says: $(./swept)" grep -qF "prints \`$(./swept)\`" "$share/sweeps.md"
check "a limit that is out of reach is not solved: exit 1" eval './mine --set max_iterations=2; [ $? -eq 1 ]'
tap_done
