# SPDX-License-Identifier: MIT
# Completion for bash from the lines of --help=list of the command and of all programs.
function add(list, key, word) { list[key] = list[key] (list[key] == "" ? "" : " ") word }
$1 == "command" { add(all, "", $2) }
$1 == "program" { name = $2; order[++n] = name }
$1 == "word" { add(words, name, $2) }
$1 == "flag" { add(words, name, "--" $2); if ($3 ~ /FILE|DIR/) add(files, name, "--" $2) }
$1 == "flag" && $4 != "" { values[name] = values[name] "        --" $2 ") choices='" $4 "' ;;\n" }
$1 == "key" { add(keys, name, $3 "=") }
$1 == "key" && $5 != "" { values[name] = values[name] "        " $3 "=) choices='" $5 "' ;;\n" }
END {
    print "# bash completion of moray, made from the options of its programs"
    print "_moray()\n{"
    print "    local current=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]} words= keys= files= choices="
    print "    COMPREPLY=()"
    print "    # bash takes KEY=VALUE apart"
    print "    if [[ $current == = ]]; then current= before=$before=;"
    print "    elif [[ $before == = ]]; then before=${COMP_WORDS[COMP_CWORD-2]}=; fi"
    print "    [[ $before != --*= ]] || before=${before%=}"
    print "    if [[ $COMP_CWORD -eq 1 ]]; then"
    print "        COMPREPLY=($(compgen -W '" all[""] " --help --version' -- \"$current\"))"
    print "        return\n    fi"
    print "    case ${COMP_WORDS[1]} in"
    for (k = 1; k <= n; k++) {
        name = order[k]
        print "    " name ")\n        words='" words[name] "'\n        keys='" keys[name] "'\n        files=' " files[name] " '"
        if (values[name] != "")
            printf "        case $before in\n%s        esac\n", values[name]
        print "        ;;"
    }
    print "    *) return ;;\n    esac"
    print "    if [[ -n $choices ]]; then\n        COMPREPLY=($(compgen -W \"$choices\" -- \"$current\"))"
    print "    elif [[ $before == --set ]]; then\n        COMPREPLY=($(compgen -W \"$keys\" -- \"$current\"))\n        compopt -o nospace"
    print "    elif [[ $files == *\" $before \"* ]]; then\n        COMPREPLY=($(compgen -f -- \"$current\"))\n        compopt -o filenames"
    print "    else\n        COMPREPLY=($(compgen -W \"$words\" -- \"$current\"))\n    fi"
    print "}\ncomplete -F _moray moray"
}
