# SPDX-License-Identifier: MIT
# Each public header stands alone and bears being included twice; moray.h has them all. Arguments: the source
# directory, the compiler.
source=$1
shift
. "$source/tests/tap.sh"

# alone COMPILER...
alone() {
    printf '#include "%s"\n#include "%s"\nint main(void) { return 0; }\n' "$header" "$header" |
        "$@" -std=c11 -Wall -Wextra -Wpedantic -Wstrict-prototypes -Werror -fsyntax-only -I "$source/include" -x c -
}

for path in "$source"/include/moray/*.h; do
    header=moray/${path##*/}
    check "$header compiles alone as C11" alone "$@"
    [ $header = moray/moray.h ] || check "$header is part of moray/moray.h" \
        grep -qF "#include \"$header\"" "$source/include/moray/moray.h"
done
tap_done
