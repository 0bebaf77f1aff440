# SPDX-License-Identifier: MIT
# Manual pages and completions, made from the option tables. Arguments: the command, the source directory, complete.bash.
complete=$3
. "$2/tests/program.sh"
[ "${complete#/}" != "$complete" ] || complete=$OLDPWD/$complete
pages=$work/pages
mkdir pages
check "the pages are made" sh "$source/problems/moray/pages.sh" "$program" "$source/problems/moray" "$pages" 0.0.0

# with TOOL "what is claimed" COMMAND...: skipped, and said so, where the tool is missing.
with() {
    tool=$1
    shift
    if command -v "$tool" >/dev/null; then
        check "$@"
    else
        echo "ok $((tap_run += 1)) - $1 # SKIP no $tool"
    fi
}

run --help=list
names=$(cut -f 2 out)
check "one page for each of $(echo $names)" [ "$(ls "$pages"/*.1 | wc -l)" -eq $(($(echo "$names" | wc -l) + 1)) ]
for page in "$pages"/*.1; do
    check "${page##*/} has its sections" eval '[ "$(grep -cE "^.SH (NAME|SYNOPSIS|DESCRIPTION|SEE ALSO)$" "$page")" -eq 4 ]'
    with groff "groff has nothing against it" eval '[ -z "$(groff -man -ww -Tutf8 -z "$page" 2>&1)" ]'
    with mandoc "nor has mandoc" mandoc -T lint -W error "$page"
done
run max_speed --help=list
check "--help=list: exit $code, fields by tabs" eval \
    '[ $code -eq 0 ] && awk -F "\t" "/^flag/ && NF != 5 || /^key/ && NF != 6 { exit 1 }" out'
"$program" max_speed --help >help
check "it lists the flags of --help, no other" [ "$(sed -n 's/^  --\([a-z_-]*\).*/\1/p' help | tr '\n' ' ')" = \
    "$(awk -F '\t' '$1 == "flag" { printf "%s ", $2 }' out)" ]
page=$pages/moray-max_speed.1
for flag in $(awk -F '\t' '$1 == "flag" { print $2 }' out); do
    check "--$flag is on the page and in every completion" eval 'grep -qF -e "$(echo "$flag" | sed "s/-/\\\\-/g")" "$page" &&
        grep -qF -e "--$flag" "$pages/moray.bash" && grep -qF -e "--$flag" "$pages/_moray" && grep -qF -e "-l $flag" "$pages/moray.fish"'
done
run max_speed --help=nonsense
check "another form of help is refused: $(cat err)" eval '[ $code -eq 2 ] && grep -q "must be nothing or list" err'

# ---- Completion
with bash "bash reads its completion" bash -n "$pages/moray.bash"
with zsh "so does zsh" zsh -n "$pages/_moray"
with fish "so does fish" fish --no-execute "$pages/moray.fish"
# offered WORD...: what bash offers for the last of the words.
offered() { bash "$complete" "$pages/moray.bash" moray "$@" | tr '\n' ' '; }
with bash "a program: $(offered max)" [ "$(offered max)" = "max_speed " ]
with bash "its flag: $(offered max_speed --hydro)" [ "$(offered max_speed --hydro)" = "--hydrodynamics " ]
with bash "a flag's values: $(offered max_speed --hydrodynamics '')" [ "$(offered max_speed --hydrodynamics '')" = "paper consistent " ]
with bash "a key: $(offered max_speed --set linear_s)" [ "$(offered max_speed --set linear_s)" = "linear_solver= " ]
with bash "a key's values: $(offered max_speed --set linear_solver = m)" [ "$(offered max_speed --set linear_solver = m)" = "moray mumps ma57 " ]
with bash "a word: $(offered paper err)" [ "$(offered paper err)" = "errata " ]
: >robot.ini
with bash "a file: $(offered max_speed --robot rob)" [ "$(offered max_speed --robot rob)" = "robot.ini " ]
with bash "nothing of another program: $(offered simulate --schem)" [ "$(offered simulate --schem)" = " " ]
tap_done
