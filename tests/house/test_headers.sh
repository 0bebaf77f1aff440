# SPDX-License-Identifier: MIT
# Each public header stands alone and bears being included twice; moray.h and snake.h have them all. Arguments: the source
# directory, the compiler.
source=$1
shift
. "$source/tests/tap.sh"

# alone COMPILER...
alone() {
    printf '#include "%s"\n#include "%s"\nint main(void) { return 0; }\n' "$header" "$header" |
        "$@" -std=c11 -Wall -Wextra -Wpedantic -Wstrict-prototypes -Werror -fsyntax-only -I "$source/include" -x c -
}

for path in $(cd "$source/include" && find moray -name "*.h"); do
    header=$path
    check "$header compiles alone as C11" alone "$@"
    case $header in
    moray/moray.h | moray/snake.h) continue ;;
    moray/snake/*) all=moray/snake.h ;;
    *) all=moray/moray.h ;;
    esac
    check "$header is part of $all" grep -qF "#include \"$header\"" "$source/include/$all"
done
tap_done
