# SPDX-License-Identifier: MIT
# Each public header stands alone and bears being included twice, in C99, C11 and C17 by gcc and clang and in C++11 and
# C++17; moray.h and snake.h have them all. Arguments: the source directory, the compiler. What is not installed is
# skipped.
source=$1
shift
. "$source/tests/tap.sh"

# alone LANGUAGE COMPILER...
alone() {
    language=$1
    shift
    printf '#include "%s"\n#include "%s"\nint main(void) { return 0; }\n' "$header" "$header" |
        "$@" -Wall -Wextra -Wpedantic -Werror -fsyntax-only -I "$source/include" -x "$language" -
}
# of_all LANGUAGE STANDARDS COMPILER...: every header under each standard.
of_all() {
    language=$1
    standards=$2
    shift 2
    if ! "$@" --version >/dev/null 2>&1; then
        echo "ok $((tap_run += 1)) - $1 # SKIP not installed"
        return
    fi
    for standard in $standards; do
        wrong=
        for header in $headers; do
            alone "$language" "$@" "-std=$standard" >/dev/null 2>&1 || wrong="$wrong $header"
        done
        check "every header compiles alone and twice, $* -std=$standard$wrong" [ -z "$wrong" ]
    done
}

headers=$(cd "$source/include" && find moray -name "*.h" | sort)
check "there are $(echo "$headers" | wc -l) public headers" [ -n "$headers" ]
of_all c c11 "$@"
for compiler in gcc clang; do
    of_all c "c99 c11 c17" $compiler -Wstrict-prototypes
done
of_all c++ "c++11 c++17" g++
of_all c++ c++17 clang++
for header in $headers; do
    case $header in
    moray/moray.h | moray/snake.h | moray/app/sweep.h) continue ;; # the last is of a library of its own
    moray/snake/*) all=moray/snake.h ;;
    *) all=moray/moray.h ;;
    esac
    check "$header is part of $all" grep -qF "#include \"$header\"" "$source/include/$all"
done
tap_done
