# SPDX-License-Identifier: MIT
# Each public header stands alone and bears being included twice, in C11; moray.h and snake.h, which have them all, in every
# standard of C and C++, by gcc and clang. Arguments: the source directory, the compiler. What is not installed is
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
# of HEADERS LANGUAGE STANDARDS COMPILER...: each under each standard.
of() {
    some=$1
    language=$2
    standards=$3
    shift 3
    if ! "$@" --version >/dev/null 2>&1; then
        echo "ok $((tap_run += 1)) - $1 # SKIP not installed"
        return
    fi
    for standard in $standards; do
        wrong=
        for header in $some; do
            alone "$language" "$@" "-std=$standard" >/dev/null 2>&1 || wrong="$wrong $header"
        done
        check "$(echo "$some" | wc -w) headers compile alone and twice, $* -std=$standard$wrong" [ -z "$wrong" ]
    done
}

headers=$(cd "$source/include" && find moray -name "*.h" | sort)
check "there are $(echo "$headers" | wc -l) public headers" [ -n "$headers" ]
of "$headers" c c11 "$@"
for compiler in gcc clang; do
    of "moray/moray.h moray/snake.h" c "c99 c11 c17" $compiler -Wstrict-prototypes
done
for compiler in g++ clang++; do
    of "moray/moray.h moray/snake.h" c++ "c++11 c++17" $compiler
done
for header in $headers; do
    case $header in
    moray/moray.h | moray/snake.h | moray/app/sweep.h) continue ;; # the last is of a library of its own
    moray/snake/*) all=moray/snake.h ;;
    *) all=moray/moray.h ;;
    esac
    check "$header is part of $all" grep -qF "#include \"$header\"" "$source/include/$all"
done
tap_done
