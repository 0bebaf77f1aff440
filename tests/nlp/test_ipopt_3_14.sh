# SPDX-License-Identifier: MIT
# What calls Ipopt compiles against the C interface of 3.14, too. Arguments: the source directory, the compiler.
source=$1
shift
. "$source/tests/tap.sh"

flags="-std=gnu11 -Wall -Wextra -Wpedantic -Wconversion -Wno-sign-conversion -Wno-deprecated-declarations -Werror -fsyntax-only"
files=$(grep -l -E 'IpStdCInterface.h|IpoptConfig.h|ipopt_(linear|log|options|user|version).h' "$source"/src/nlp/*.c)
check "there are $(echo "$files" | wc -l) files" [ "$(echo "$files" | wc -l)" -ge 5 ]
for file in $files; do
    said=$("$@" $flags -I "$source/tests/nlp/ipopt_3_14" -I "$source/include" -I "$source/src" "$file" 2>&1)
    check "${file#"$source"/} $said" [ -z "$said" ]
done
tap_done
