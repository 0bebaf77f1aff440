# SPDX-License-Identifier: MIT
# The Python module with the library just built. Arguments: the source directory, the shared library, the compiler.
source=$1
library=$2
shift 2
skip() {
    echo "1..0 # SKIP $1"
    exit 0
}
python=
for one in python3 /usr/bin/python3; do
    [ -n "$python" ] || ! "$one" -c 'import numpy' 2>/dev/null || python=$one
done
[ -n "$python" ] || skip "no Python with numpy (Debian's python3-numpy)"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export MORAY_LIBRARY="$library" PYTHONPATH="$source/share/python" PYTHONDONTWRITEBYTECODE=1

# A C program that prints size and offsets of what the module mirrors, under the names that the headers have.
"$python" - >"$work/layout.c" <<'END' || exit 1
import moray
print('#include <stddef.h>\n#include <stdio.h>\n#include <moray/moray.h>\nint main(void)\n{')
for name, mirror in moray.STRUCTURES.items():
    print(f'    printf("{name} %zu", sizeof({name}));')
    for field, *_ in mirror._fields_:
        real = field.rstrip('_')
        print(f'    printf(" {real}=%zu", offsetof({name}, {real}));')
    print('    puts("");')
print('}')
END
"$@" -I "$source/include" "$work/layout.c" -o "$work/layout" && "$work/layout" >"$work/layout.txt" || exit 1
"$python" "$source/tests/python/test_module.py" "$work/layout.txt" "$source/share/python/brachistochrone.py"
