# SPDX-License-Identifier: MIT
# What debian/ says of moray is true: packages needed, version, names of the libraries, files. That it builds is
# tests/studies/package.sh. Arguments: the source directory, the build directory, the libraries.
source=$1
build=$2
shift 2
. "$source/tests/tap.sh"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$source" || exit 1

# field NAME FILE: the packages of the fields of that name, one a line, without versions.
field() {
    awk -v name="$1:" '/^[^ ]/ || /^$/ { inside = $1 == name; sub(/^[^:]*:/, "") } inside' "$2" | sed 's/([^)]*)//g; s/|.*//' | tr ',' '\n' | sed 's/ //g; /^$/d; /^\$/d' | sort -u
}
# needed FILE: of a list in the form of packages.txt.
needed() { sed 's/#.*//; s/ //g; /^$/d' "$1" | sort -u; }
# strangers: packages that building needs, by packages.txt or by debian/control alone; a C compiler and its library any
# build of Debian's has, and what is run, not built with, is of the packages that are installed.
strangers() {
    { field Build-Depends "$2" && field Depends "$2" && field Recommends "$2" && printf '%s\n' gcc libc6-dev; } | sort -u >"$work/named"
    needed "$1" >"$work/needed"
    comm -23 "$work/needed" "$work/named"
    field Build-Depends "$2" | grep -v '^debhelper-compat$' | comm -13 "$work/needed" -
}
check "Build-Depends has packages: $(field Build-Depends debian/control | wc -l)" [ "$(field Build-Depends debian/control | wc -l)" -gt 5 ]
check "they and packages.txt are the same: $(strangers packages.txt debian/control | tr '\n' ' ')" [ -z "$(strangers packages.txt debian/control)" ]
grep -v 'libnlopt-dev' packages.txt >"$work/less"
echo unheard-of >>"$work/less"
check "one more and one less would be told" [ "$(strangers "$work/less" debian/control | tr '\n' ' ')" = "unheard-of libnlopt-dev " ]

version=$(sed -n "s/^  version: '\(.*\)',$/\1/p" meson.build)
check "the version is that of meson.build: $version" grep -q "^moray ($version\(-[0-9]*\)\?) " debian/changelog
for library; do
    name=$(objdump -p "$library" | awk '$1 == "SONAME" { print $2 }')
    check "$name is in a package of that name" grep -q "^Package: $(echo "$name" | sed 's/\.so\.//')$" debian/control
done

# Every file of an installation is of one package, or not packaged on purpose.
meson introspect --installed "$build" | tr ',' '\n' | sed -n 's|.*: "\(.*\)".*|\1|p' | sed 's|^/usr/local/|usr/|' | sort -u >"$work/installed"
check "an installation has files: $(wc -l <"$work/installed")" [ "$(wc -l <"$work/installed")" -gt 20 ]
cat debian/*.install debian/not-installed | sed 's|usr/lib/\*/|usr/lib/[^/]*/|; s|\.so\.\*|.so.[0-9.]*|' >"$work/packaged"
# homeless FILE: those of no package, or of several.
homeless() {
    awk 'NR == FNR { pattern[NR] = "^" $0 "(/|$)"; patterns = NR; next }
        { n = 0; for (k = 1; k <= patterns; k++) n += $0 ~ pattern[k]; if (n != 1) print $0 ": " n }' "$work/packaged" "$1"
}
check "each is of one package: $(homeless "$work/installed" | head -n 3 | tr '\n' ' ')" [ -z "$(homeless "$work/installed")" ]
echo usr/share/moray/new.txt >"$work/new"
check "one of none would be told" [ -n "$(homeless "$work/new")" ]
tap_done
