# SPDX-License-Identifier: MIT
# Completion for fish from the lines of --help=list of the command and of all programs.
function quoted(line) { gsub(/\\/, "\\\\", line); gsub(/'/, "\\'", line); return "'" line "'" }
function first(line) { sub(/;.*/, "", line); return line }
function inside(name) { return "complete -c moray -n '__fish_seen_subcommand_from " name "'" }
BEGIN { print "# fish completion of moray, made from the options of its programs" }
$1 == "command" { print "complete -c moray -f -n __fish_use_subcommand -a " $2 " -d " quoted($3) }
$1 == "program" { name = $2 }
$1 == "word" { print inside(name) " -f -a " $2 " -d " quoted($3) }
$1 == "flag" {
    print inside(name) " -l " $2 ($3 == "" ? " -f" : $3 ~ /FILE|DIR/ ? " -r" : " -x") ($4 == "" ? "" : " -a " quoted($4)) " -d " quoted(first($5))
}
$1 == "key" { keys[name] = keys[name] $3 "= " }
END { for (name in keys) print inside(name) " -l set -x -a " quoted(keys[name]) }
