# SPDX-License-Identifier: MIT
# What bash offers, a line each, by the completion in $1 for the words that follow, the last of which is being typed. bash
# hands KEY=VALUE over as three words.
. "$1"
shift
compopt() { :; }
COMP_WORDS=("$@")
COMP_CWORD=$(($# - 1))
_moray
printf '%s\n' "${COMPREPLY[@]}"
