#!/bin/sh
# embed.sh NAME FILE: the lines of a file as the C array moray_NAME, for the report to hold.
printf '#include "results/page.h"\nconst char *const moray_%s[] = {\n' "$1"
sed 's/\\/\\\\/g; s/"/\\"/g; s/^/    "/; s/$/\\n",/' "$2"
printf '    0};\n'
