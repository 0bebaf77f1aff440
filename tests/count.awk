# SPDX-License-Identifier: MIT
# Counts the results in meson's testlog.json (a test a line): "PASSED FAILED". The subtests count where a test has them;
# a test that fails without a failed subtest (a crash, a wrong plan, a timeout) is one failure more.
{
    ok = bad = 0
    result = stdout = ""
    if (match($0, /"result": "[A-Z]+"/))
        result = substr($0, RSTART + 11, RLENGTH - 12)
    if (match($0, /"stdout": "([^"\\]|\\.)*"/))
        stdout = substr($0, RSTART + 11, RLENGTH - 12)
    n = split(stdout, line, /\\n/)
    for (i = 1; i <= n; i++) {
        if (line[i] ~ /^ok( .*)? # *[Ss][Kk][Ii][Pp]/)
            continue
        ok += line[i] ~ /^ok( |$)/
        bad += line[i] ~ /^not ok( |$)/
    }
    if (result != "OK" && result != "SKIP" && bad == 0)
        bad = 1
    if (result == "OK" && ok == 0)
        ok = 1
    passed += ok
    failed += bad
}
END { print passed + 0, failed + 0 }
