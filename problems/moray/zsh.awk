# SPDX-License-Identifier: MIT
# Completion for zsh from the lines of --help=list of the command and of all programs.
function quoted(line) { gsub(/'/, "'\\''", line); gsub(/[\[\]:]/, "\\\\&", line); return line }
function first(line) { sub(/;.*/, "", line); return line }
$1 == "command" { commands = commands "        '" $2 ":" quoted($3) "'\n" }
$1 == "program" { name = $2; order[++n] = name }
$1 == "word" { words[name] = words[name] " " $2 }
$1 == "flag" {
    action = $4 != "" ? "(" $4 ")" : $3 ~ /FILE|DIR/ ? "_files" : $2 == "set" ? "->keys" : ""
    specs[name] = specs[name] "        '" ($2 == "set" ? "*" : "") "--" $2 "[" quoted(first($5)) "]" ($3 == "" ? "" : ":" quoted($3) ":" action) "'\n"
}
$1 == "key" { keys[name] = keys[name] " " $3 }
END {
    print "#compdef moray\n# zsh completion of moray, made from the options of its programs"
    print "local state line\nlocal -a commands specs keys"
    print "if (( CURRENT == 2 )); then\n    commands=(\n" commands "    )\n    _describe program commands\n    return\nfi"
    print "case $words[2] in"
    for (k = 1; k <= n; k++)
        print order[k] ")\n    keys=(" keys[order[k]] " )\n    specs=(\n" specs[order[k]] (words[order[k]] == "" ? "" : "        '*:word:(" words[order[k]] " )'\n") "    )\n    ;;"
    print "*) return 1 ;;\nesac"
    print "shift words\n(( CURRENT-- ))"
    print "_arguments $specs\n[[ $state != keys ]] || compadd -S = -a keys"
}
