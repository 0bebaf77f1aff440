# SPDX-License-Identifier: MIT
# The library owns its names: it exports what its headers declare and nothing else, and a program that has functions of
# the same names as the library's own gets the same solution. Arguments: the source directory, the build directory, the
# shared library, the compiler with its flags.
source=$1
build=$2
library=$3
shift 3
. "$source/tests/tap.sh"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1

# none FILE: whether it is empty; what it holds becomes a comment.
none() {
    [ ! -s "$1" ]
}
# tell FILE: its lines as diagnostics.
tell() {
    sed 's/^/# /' "$1"
}

# ---- What is exported
# exports LIBRARY: but for where the sections end, which gold exports too.
exports() {
    nm -D --defined-only "$1" | awk '{ print $3 }' | grep -vx -e __bss_start -e _edata -e _end | sort -u
}
exports "$library" >exported
grep -v '^moray_' exported >foreign
check "every symbol of the shared library is named moray_...: $(wc -l <foreign) foreign" none foreign
tell foreign
find "$source/include" -name '*.h' ! -name export.h ! -name sweep.h -exec cat {} + | sed 's|//.*||' | tr '\n' ' ' | tr ';' '\n' |
    sed -n 's/.*MORAY_API \(extern [^(]*\)$/\1/p; s/.*MORAY_API \([^(]*\)(.*/\1/p' | sed 's/.*[ *]//' | sort >declared
check "$(wc -l <declared) functions are declared with MORAY_API, each once" eval '[ -s declared ] && [ -z "$(uniq -d declared)" ]'
comm -3 declared exported >differ
check "they are what the library exports: $(wc -l <differ) differ" none differ
tell differ

# ---- The library of sweeps, which is one of its own
exports "$build/src/sweep/libmoray-sweep.so" >exported_sweep
sed 's|//.*||' "$source/include/moray/app/sweep.h" | tr '\n' ' ' | tr ';' '\n' | sed -n 's/.*MORAY_API \([^(]*\)(.*/\1/p' |
    sed 's/.*[ *]//' | sort >declared_sweep
comm -3 declared_sweep exported_sweep >differ
check "moray/app/sweep.h declares what it exports: $(wc -l <differ) of $(wc -l <declared_sweep) differ" eval \
    '[ -s declared_sweep ] && [ ! -s differ ]'
tell differ

# ---- Static archives of the rooms, and what they hold beside the exported
find "$build/src" -name '*.a' >archives
check "there are $(wc -l <archives) archives" [ -s archives ]
: >global
: >inner
while read -r archive; do
    nm -g --defined-only "$archive" | awk 'NF == 3 { print $3 }' | sort -u >names
    cat names >>global
    nm --defined-only "$archive" | awk 'NF == 3 && $2 ~ /[Tt]/ { print $3 }' >>inner
    grep -v '^moray_' names >foreign
    check "every global symbol of ${archive##*/} is named moray_...: $(wc -l <foreign) foreign" none foreign
    tell foreign
done <archives

# ---- A program with functions of all these names
# But for those that it calls itself, and those of the C library and of what else is linked.
check "template.c compiles" "$@" -I "$source/include" -c "$source/problems/template.c" -o template.o
ldd "$library" | awk '/=> \// { print $3 }' | xargs nm -D --defined-only 2>/dev/null |
    awk 'NF == 3 { sub(/@.*/, "", $3); print $3 }' >others
nm -u template.o | awk '{ print $2 }' >>others
sort -u others -o others
{ cat global inner exported && sed -n 's/^moray_//p' global exported &&
    printf '%s\n' is_solved mesh_copy layout_new mesh_new node_columns refine moray_mesh_copy moray_is_solved; } |
    grep -x '[a-z][a-z0-9_]*' | grep -vxE 'main|auto|break|case|char|const|continue|default|do|double|else|enum|extern|float|for|goto|if|inline|int|long|register|restrict|return|short|signed|sizeof|static|struct|switch|typedef|union|unsigned|void|volatile|while' |
    sort -u | comm -23 - others >taken
{
    echo 'void abort(void) __attribute__((noreturn));'
    sed 's/.*/int &(void);\nint &(void)\n{\n    abort();\n}/' taken
} >strangers.c
check "$(wc -l <taken) names of the library have a function of the program's" eval '[ "$(wc -l <taken)" -gt 500 ]'
check "it builds" "$@" -fno-builtin template.o strangers.c -o mine "$library" -lm \
    "-Wl,-rpath,$(dirname "$library")"
check "its names are there: is_solved, moray_mesh_copy" eval \
    'nm mine | grep -q " [Tt] is_solved$" && nm mine | grep -q " [Tt] moray_mesh_copy$"'
./mine --json --set refinements=3 >summary.json
check "it solves and certifies: exit code 0, not $?" [ $? -eq 0 ]
optimum=$(awk -F: '/"objective"/ { print $2 + 0; exit }' OFMT=%.12g summary.json)
check "finds the published optimum 4: $optimum" awk -v got="$optimum" 'BEGIN { exit !(got > 3.999998 && got < 4.000002) }'
check "and refines" eval 'grep -q "\"pass\":.true" summary.json'
tap_done
