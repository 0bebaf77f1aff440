# SPDX-License-Identifier: MIT
# A manual page from the lines of --help=list. -v version=V -v does=WHAT IT DOES
function text(line) { # no character of it is a request, an escape or a hyphen that may become another
    gsub(/\\/, "\\e", line)
    gsub(/-/, "\\-", line)
    sub(/^[.']/, "\\\\\\&&", line)
    return line
}
function begin(name, does, synopsis) {
    title = toupper(name)
    print ".TH " text(title) " 1 \"\" \"moray " text(version) "\" \"User Commands\""
    print ".SH NAME\n" text(name) " \\- " text(does)
    print ".SH SYNOPSIS\n.B " synopsis
}
function section(name) { if (name != now) print ".SH " name; now = name }
function entry(bold, italic, words) { print ".TP\n" (italic == "" ? ".B " text(bold) : ".BI \"" text(bold) "\" \"" text(italic) "\"") "\n" text(words) }
$1 == "program" {
    begin("moray-" $2, does, "moray " text($2) "\n[\\fIOPTION\\fR]...")
    summary = $3
    print ".SH DESCRIPTION\n" text(summary)
    now = "DESCRIPTION"
}
$1 == "word" { section("ARGUMENTS"); entry($2, "", $3) }
$1 == "flag" { section("OPTIONS"); entry("--" $2 ($3 == "" ? "" : " "), $3, $5) }
$1 == "key" {
    section("KEYS")
    if (!keys++)
        print "For\n.B \\-\\-set\n.IR KEY = VALUE ,\nand in INI files under the section in brackets."
    if ($2 != part)
        print ".SS \"[" text($2) "]\""
    part = $2
    entry($3 "=", $4, $5)
}
$1 == "note" { section("NOTES"); print (notes++ ? ".PP\n" : "") text($2) }
$1 == "command" {
    if (!commands++) {
        begin("moray", "trajectory optimisation, of the gaits of swimming snake robots above all", "moray\n.I PROGRAM\n[\\fIOPTION\\fR]...")
        print ".SH DESCRIPTION\nRuns one of its programs. What each of them takes,\n.B moray\n.I PROGRAM\n.B \\-\\-help\ntells.\n.SH PROGRAMS"
    }
    entry($2, "", $3)
    others[commands] = $2
}
END {
    print ".SH SEE ALSO"
    if (!commands)
        print ".BR moray (1)"
    for (k = 1; k <= commands; k++)
        print ".BR moray\\-" text(others[k]) " (1)" (k < commands ? "," : "")
}
