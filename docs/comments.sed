# SPDX-License-Identifier: MIT
# Comments of the headers as Doxygen reads them; what it would take for a command or a tag is protected.
/^ *\/\/ ----/d
/^ *\/\/ SPDX/d
/\/\//{
h
s/.*\/\///
s/[@\\<>#%]/\\&/g
x
s/\/\/.*//
G
s/\n/\/\//
s/^\( *\)\/\/\(.*\)/\1\/\/\/\2/
s/^\(.*[^ \/].*\)\/\/\([^\/].*\)/\1\/\/\/<\2/
}
