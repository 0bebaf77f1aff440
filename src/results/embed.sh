#!/bin/sh
# embed.sh HEADER NAME FILE: the lines of a file as the C array NAME, declared in that header, for a program to hold.
printf '#include "%s"\nconst char *const %s[] = {\n' "$1" "$2"
sed 's/\\/\\\\/g; s/"/\\"/g; s/^/    "/; s/$/\\n",/' "$3"
printf '    0};\n'
