# SPDX-License-Identifier: MIT
# problems/run.sh and tests/run.sh against stand-ins for the system's tools, which log how they are called; and the list
# that tests/studies/mutate.py keeps. Argument: the source directory.
source=$1
. "$source/tests/tap.sh"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
repo="$work/a repo"
bin=$work/bin
log=$work/log
mkdir -p "$repo/problems" "$repo/tests" "$bin" "$work/elsewhere"
cp "$source/packages.txt" "$repo"
cp "$source/problems/setup.sh" "$source/problems/run.sh" "$repo/problems"
cp "$source/tests/run.sh" "$source/tests/count.awk" "$repo/tests"
: >"$repo/problems/demo.c"
: >"$repo/problems/other.c"

# stand_in NAME: a tool in $bin from standard input.
stand_in() {
    { echo '#!/bin/sh' && echo "echo \"$1 \$*\" >>'$log'" && cat; } >"$bin/$1"
    chmod +x "$bin/$1"
}

for tool in sh env cat rm mktemp sed awk dirname basename mkdir chmod cp sleep; do
    ln -s "$(command -v $tool)" "$bin/$tool"
done
stand_in dpkg-query <<'END'
shift 3 # -W -f FORMAT
for package; do
    grep=$(sed -n "s/^$package$/yes/p" "$INSTALLED")
    [ -n "$grep" ] && printf 'installed=%s ' "$package" || printf 'config-files=%s ' "$package"
done
END
stand_in apt-get <<'END'
[ -z "$APT_FAILS" ] || { echo "E: no network"; exit 100; }
END
stand_in id <<'END'
echo "${USER_ID:-0}"
END
stand_in meson <<'END'
case $1 in
setup)
    [ ! -e "$2/meson.lock" ] || { echo "ERROR: Some other Meson process is already using this build directory."; exit 1; }
    mkdir -p "$2/meson-logs" && : >"$2/meson.lock" && sleep ${MESON_SECONDS:-0}
    rm "$2/meson.lock" && : >"$2/build.ninja"
    ;;
test) [ -z "$TEST_LOG" ] || cp "$TEST_LOG" "$3/meson-logs/testlog.json" ;;
esac
END
stand_in ninja <<'END'
echo "compiling noise"
[ -z "$BUILD_FAILS" ] || { echo "demo.c:1: error: no"; exit 1; }
mkdir -p "$2/problems"
printf '#!/bin/sh\necho "{}"\nprintf "<%%s>" "$@" >&2\nexit 3\n' >"$2/problems/demo"
chmod +x "$2/problems/demo"
END
export INSTALLED="$work/installed"
sed 's/ *#.*//' "$source/packages.txt" >"$INSTALLED"

# run SCRIPT ARGUMENTS: from another directory, leaves $code, out, err and log.
run() {
    script=$1
    shift
    : >"$log"
    (cd "$work/elsewhere" && PATH=$bin sh "$repo/$script" "$@" >"$work/out" 2>"$work/err" </dev/null)
    code=$?
}
said() { grep -qF -e "$1" "$work/err"; }
called() { grep -qF -e "$1" "$log"; }
printed() { [ "$(cat "$work/out")" = "$1" ]; }

run problems/run.sh demo --set 'a b=c'
check "run.sh: standard output is the program's alone" printed '{}'
check "run.sh: arguments pass unchanged" said '<--set><a b=c>'
check "run.sh: so does the exit code" [ $code -eq 3 ]
check "run.sh: installs nothing when nothing is missing" eval '! called "apt-get "'
check "run.sh: configures where there is no build" called "meson setup $repo/build $repo"
check "run.sh: builds the one program" called "ninja -C $repo/build problems/demo"
check "run.sh: keeps the build's noise to itself" eval '! said noise'
run problems/run.sh demo
check "run.sh: does not configure twice" eval '! called "meson setup" && called "ninja -C"'
BUILD_FAILS=yes run problems/run.sh demo
check "run.sh: a failed build shows its log" eval 'said "demo.c:1: error: no" && [ $code -eq 1 ] && printed ""'
printf '| `demo` | shows it: at length |\n' >"$repo/README.md"
run problems/run.sh
check "run.sh: the names with what they do" said "  demo              shows it"
for name in '' nonsense ../tests/run . problems/demo; do
    run problems/run.sh $name
    check "run.sh '$name': exit 2 and the names, nothing else" eval \
        '[ $code -eq 2 ] && said "  demo" && said "  other" && printed "" && ! called "ninja -C" && ! called "apt-get "'
done


# ---- Two at once, and a lock that nobody holds
rm -rf "$repo/build"
(cd "$work/elsewhere" && MESON_SECONDS=2 PATH=$bin sh "$repo/problems/run.sh" demo >"$work/out1" 2>"$work/err1" </dev/null; echo $? >"$work/code1") &
sleep 1
run problems/run.sh demo
wait
check "two first runs at once: both work" eval '[ $code -eq 3 ] && [ "$(cat "$work/code1")" -eq 3 ]'
check "the second says that it waits" said 'Waiting for process'
check "and does not configure again" eval '! said Configuring && ! grep -q "^failed" "$work/err1"'
check "no lock is left" [ ! -e "$repo/build.lock" ]
sh -c 'echo $$' >"$work/gone"
mkdir "$repo/build.lock" && cp "$work/gone" "$repo/build.lock/holder"
run problems/run.sh demo
check "a lock whose holder is gone is taken over" eval '[ $code -eq 3 ] && ! said Waiting && [ ! -e "$repo/build.lock" ]'

sed -i '/nlopt/d; /^gcc$/d' "$INSTALLED"
run problems/run.sh demo
check "packages: the missing ones alone are installed" eval \
    'called "apt-get update" && called "apt-get install -y --no-install-recommends gcc libnlopt-dev"'
check "packages: and it says so" said 'Installing missing Debian packages: gcc libnlopt-dev'
USER_ID=1000 run problems/run.sh demo
check "packages: without root and sudo it says what to do" eval \
    '[ $code -eq 1 ] && said "apt-get install gcc libnlopt-dev" && ! called "apt-get " && ! called "ninja -C"'
stand_in sudo <<'END'
"$@"
END
USER_ID=1000 run problems/run.sh demo
check "packages: sudo where there is one" eval \
    'called "sudo env DEBIAN_FRONTEND=noninteractive apt-get install" && said "with sudo" && [ $code -eq 3 ]'
APT_FAILS=yes run problems/run.sh demo
check "packages: a failed installation shows why and ends it" eval '[ $code -eq 1 ] && said "E: no network" && ! called "ninja -C"'
APT_FAILS=yes run tests/run.sh
check "tests: also there, with a count" eval '[ $code -eq 1 ] && printed "0 passed, 1 failed"'
mv "$bin/dpkg-query" "$work"
run problems/run.sh demo
check "packages: another system goes on" eval '[ $code -eq 3 ] && said "no Debian system" && ! called "apt-get "'
mv "$work/dpkg-query" "$bin"
sed 's/ *#.*//' "$source/packages.txt" >"$INSTALLED"

export TEST_LOG="$work/testlog.json"
cat >"$TEST_LOG" <<'END'
{"name": "good", "stdout": "ok 1 - a \"quoted\" ok 2\nnoise, not ok\nok 2 - b\n1..2\n", "parent": "x", "result": "OK", "returncode": 0}
{"name": "skips", "stdout": "ok 1 # SKIP no gnuplot\nok 2\n1..2\n", "result": "OK", "returncode": 0}
{"name": "plain", "stdout": "", "result": "OK", "returncode": 0}
END
last_line() { [ "$(sed -n '$p' "$work/out")" = "$1" ]; }
run tests/run.sh
check "tests: both runs are summed: $(sed -n '$p' "$work/out")" eval '[ $code -eq 0 ] && last_line "8 passed, 0 failed"'
check "tests: warnings are errors in one run" called "meson setup $repo/build-ci $repo -Dwerror=true"
check "tests: the other has sanitizers" called "meson setup $repo/build-san $repo -Db_sanitize=address,undefined"
cat >>"$TEST_LOG" <<'END'
{"name": "bad", "stdout": "ok 1\nnot ok 2 - \"result\": \"OK\"\nnot ok 3\n1..3\n", "result": "FAIL", "returncode": 1}
{"name": "crash", "stdout": "ok 1 - then it crashed\n", "result": "ERROR", "returncode": -11}
{"name": "slow", "result": "TIMEOUT", "returncode": -9}
END
run tests/run.sh
check "tests: failures and crashes count: $(sed -n '$p' "$work/out")" eval '[ $code -ne 0 ] && last_line "12 passed, 8 failed"'
BUILD_FAILS=yes run tests/run.sh
check "tests: a failed build counts: $(sed -n '$p' "$work/out")" eval '[ $code -ne 0 ] && last_line "0 passed, 2 failed"'
check "tests: and shows its log" said 'demo.c:1: error: no'
: >"$TEST_LOG"
run tests/run.sh
check "tests: nothing run is no success" eval '[ $code -ne 0 ] && last_line "0 passed, 0 failed"'
TEST_LOG='' run tests/run.sh
check "tests: no log at all is a failure" eval '[ $code -ne 0 ] && last_line "0 passed, 2 failed"'
check "the last line stands alone" eval '[ "$(wc -l <"$work/out")" -eq 1 ]'

# ---- The list of mutants that are left out of the share of tests/studies/mutate.py
mutants() { python3 -B "$source/tests/studies/mutate.py" "$@" >"$work/out" 2>"$work/err"; }
check "mutants: all that are listed as equivalent are some of src: $(mutants --check-list; sed -n '$p' "$work/out")" \
    mutants --check-list
sed 's/return i < j ? i : j;/return i < gone ? i : j;/' "$source/tests/studies/equivalent.txt" >"$work/stale.txt"
check "mutants: one that is not is refused by name" eval \
    '! mutants --check-list "$work/stale.txt" && grep -q "^src/linear/basis.c variable_of: .*gone" "$work/out" && [ "$(wc -l <"$work/out")" -eq 3 ]'
tap_done
