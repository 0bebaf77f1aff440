# SPDX-License-Identifier: MIT
# Lintian has nothing against the source package; what it has against the packages built is tests/studies/package.sh.
# Arguments: the source directory.
source=$1
. "$source/tests/tap.sh"
for tool in lintian dpkg-source git; do
    command -v $tool >/dev/null || { echo "1..0 # SKIP no $tool (tests/packages.txt)"; exit 0; }
done
git -C "$source" ls-files -z >/dev/null 2>&1 || { echo "1..0 # SKIP not under version control"; exit 0; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/moray"
# Of the results one page stands for all, which are half of what there is. A working tree may lack what the index has: tar
# leaves it out.
(cd "$source" && git ls-files -z . ':!results' results/max_speed/report.html | tar -c --null -T - --ignore-failed-read 2>/dev/null) | tar -x -C "$work/moray"

# ask FOLDER: makes the source package of it; what lintian says is in said.
ask() {
    (cd "$work" && dpkg-source -Zgzip -z1 -b "$1" >built 2>&1 && lintian --allow-root --fail-on error,warning moray_*.dsc >said 2>&1)
}
check "lintian: $(ask moray; echo $?) $(head -n 1 "$work/said")" eval '[ -f "$work/said" ] && [ ! -s "$work/said" ]'
rm -f "$work"/moray_*
mkdir "$work/less"
cp -R "$work/moray/debian" "$work/less"
{ printf '<html><script>' && awk 'BEGIN { for (i = 0; i < 2000; i++) printf "x = %d;", i }' && echo '</script></html>'; } >"$work/less/page.html"
check "what it has to say would be seen" eval '! ask less && grep -q "source-is-missing" "$work/said"'
tap_done
