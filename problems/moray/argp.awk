# SPDX-License-Identifier: MIT
# A program's help as argp prints it, each entry in one line, in the form of --help=list.
/^Usage:/ { usage = $0; next }
!told && usage != "" && /^[A-Z]/ { print "program\tsweep\t" $0; told = 1 }
/^Programs:/ { for (i = 2; i <= NF; i++) print "word\t" $i "\ta program to sweep" }
match($0, /--[a-z]+/) && /^ / {
    flag = substr($0, RSTART + 2, RLENGTH - 2)
    rest = substr($0, RSTART + RLENGTH)
    argument = ""
    if (sub(/^=/, "", rest)) {
        argument = rest
        sub(/ .*/, "", argument)
        rest = substr(rest, length(argument) + 1)
    }
    sub(/^ +/, "", rest)
    if (rest == "") {
        getline rest
        sub(/^ +/, "", rest)
    }
    print "flag\t" flag "\t" argument "\t\t" rest
}
