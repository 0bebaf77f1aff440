# SPDX-License-Identifier: MIT
# The reference is made of the headers without a warning. Arguments: the source directory, the configured Doxyfile.
source=$1
doxyfile=$2
. "$source/tests/tap.sh"
command -v doxygen >/dev/null || { echo "1..0 # SKIP no doxygen"; exit 0; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
{ cat "$doxyfile" && echo "OUTPUT_DIRECTORY = $work"; } | doxygen - >"$work/out" 2>"$work/err"
check "doxygen has no warning: $(head -n 1 "$work/err")" [ ! -s "$work/err" ]
check "the start page teaches" grep -q "From a problem to a certified solution" "$work/reference/index.html"
for header in $(cd "$source/include/moray" && find . -name '*.h'); do
    page=$(basename "$header" .h | sed 's/_/__/g')_8h.html
    check "$header has its page" eval '[ -n "$(find "$work/reference" -name "*$page")" ]'
done
comment=$(sed -n 's|^// \(Transcribes and solves from\).*|\1|p' "$source/include/moray/ocp.h")
check "and functions their comments" eval '[ -n "$comment" ] && grep -q "$comment" "$work/reference/ocp_8h.html"'
printf '/// \\nonsense\nint moray_x(void);\n' >"$work/bad.h"
check "a warning would be seen" eval '{ cat "$doxyfile" && echo "OUTPUT_DIRECTORY = $work/bad
INPUT = $work/bad.h
FILTER_PATTERNS =
USE_MDFILE_AS_MAINPAGE ="; } | doxygen - 2>&1 | grep -q warning'
tap_done
