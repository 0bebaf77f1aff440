#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The tests measured: faults planted in src one at a time, and which of them the tests find.

    python3 tests/studies/mutate.py [--count 200] [--seed 1] [--first 1] [--under src/ocp] [--folder DIR] [--only 3,17]
                                  [--kinds choice,term] [--whole | --near] [--plain | --sanitized]
                                  [--list | --check-list [FILE]]

Works on a copy of the source tree with a build of its own, in a folder that is left for the next run. A mutant is one
sign, factor, index, relation, logical operator, negation, term or statement changed, in the folder or file that --under
names. It is built as far as the tests of its room (tests/ROOM for src/ROOM) need it, and these run, quick ones first,
until one fails; then, where none does, all quick ones of other rooms, or with --whole every test, or with --near none.
What lives then faces the tests of its room under the sanitizers, which see reads beyond an end and leaks, as tests/run.sh
has two halves; --plain leaves that out, --sanitized all else.
Survivors are listed by their number in the sample, file, line and change, and --only NUMBERS plants these again; the
last line counts. Mutants that no caller can tell from the source are in equivalent.txt, reviewed one by one; they are
left out of the share. --check-list tells which of these the source no longer has. Runs by name alone: some ten seconds
a mutant.
"""
import argparse
import hashlib
import json
import os
import re
import select
import shutil
import signal
import subprocess
import sys
import tempfile
import time

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
QUICK = 2.0  # seconds; what the rooms' own tests let pass faces all programs of tests that are as quick
# Texts and packaging: no fault in src moves them.
UNMOVED = {"commands", "doc", "guide", "headers", "install", "ipopt_3_14", "languages", "layers", "names", "package", "prose", "scripts"}
SANITIZED = ["-Db_sanitize=address,undefined", "-Doptimization=1"]
SUPPRESSED = {"LSAN_OPTIONS": "suppressions=%s/tests/lsan.supp:print_suppressions=0" % ROOT, "UBSAN_OPTIONS": "halt_on_error=1"}
SECONDS = 300  # for a test without a mutant
EQUIVALENT = os.path.join(ROOT, "tests", "studies", "equivalent.txt")

# What is changed into what, on code without strings, characters and comments.
CHANGES = [
    ("sign", r" \+ ", " - "),
    ("sign", r" - ", " + "),
    ("sign", r"(?<=[(=,] )-(?=[a-z])", ""),
    ("sign", r" \+= ", " -= "),
    ("sign", r" -= ", " += "),
    ("factor", r" \* ", " / "),
    ("factor", r" / ", " * "),
    ("factor", r"(?<![\w.\[])2(?![\w.\]])", "3"),
    ("factor", r"(?<![\w.])0\.5(?![\w.])", "0.4"),
    ("factor", r"(?<![\w.])1e-(\d+)(?!\d)", lambda m: "1e-%d" % max(int(m.group(1)) - 3, 0)),
    ("index", r"\[0\]", "[1]"),
    ("index", r"\[1\]", "[0]"),
    ("index", r"\[([ijk])\]", r"[\1 ? \1 - 1 : 0]"),
    ("relation", r" < ", " <= "),
    ("relation", r" <= ", " < "),
    ("relation", r" > ", " >= "),
    ("relation", r" >= ", " > "),
    ("relation", r" == ", " != "),
    ("relation", r" != ", " == "),
    ("logic", r" && ", " || "),
    ("logic", r" \|\| ", " && "),
    ("logic", r"(?<=[ (])!(?=[a-z])", ""),
    ("choice", r"\bfmax\(", "fmin("),
    ("choice", r"\bfmin\(", "fmax("),
    ("choice", r"\bfabs\(", "("),
    ("term", r" [+-] [\w.>\[\]-]+(?: [*/] [\w.>\[\]-]+)*(?=;)", ""),
    ("term", r" && [^&|;]+(?=\)$)", ""),
    ("statement", r"^(\s+)(?=\S)(?!return|else|const|if|for|while|int|double|case|break|static|moray_\w+ \w+|\})[^{}=]*\);$", r"\1;"),
    ("statement", r"^(\s+)(?=\S)[\w.>\[\]-]+(?:->|\.|\[)[\w.>\[\] +*-]* [*+-]?= [^;{}]*;$", r"\1;"),
]


def end_all(process, folder):
    """Ends a test and whatever it began in its folder, in groups of their own too."""
    try:
        os.killpg(process.pid, signal.SIGKILL)
    except ProcessLookupError:
        pass
    for pid in filter(str.isdigit, os.listdir("/proc")):
        try:
            if os.readlink("/proc/%s/cwd" % pid).startswith(folder):
                os.kill(int(pid), signal.SIGKILL)
        except OSError:
            pass
    process.stdout.close()
    process.wait()


def code_lines(text):
    """Lines of function bodies, with strings and comments blanked out so that columns stay, and None elsewhere; each with
    its function."""
    blank = lambda m: re.sub(r"[^\n]", "\0", m.group())
    text = re.sub(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\])*\'', blank, text, flags=re.S)
    inside, function = False, ""
    for line in text.split("\n"):
        named = re.search(r"^\w.*?\b(?!TYPED|__attribute__)(\w+)\)?\(", line)
        if named and not inside:
            function = named.group(1)
        if line.startswith("{"):
            inside = True
        elif line.startswith("}"):
            inside = False
        yield line if inside and line.startswith(" ") and not line.lstrip().startswith("#") else None, function


def candidates(under):
    under = os.path.join(ROOT, under)
    alone = [(os.path.dirname(under), [], [os.path.basename(under)])] if os.path.isfile(under) else []
    for folder, _, names in alone or sorted(os.walk(under)):
        for name in sorted(names):
            if not name.endswith((".c", ".inc")):
                continue
            path = os.path.relpath(os.path.join(folder, name), ROOT)
            with open(os.path.join(ROOT, path), encoding="utf-8") as file:
                text = file.read()
            lines = text.split("\n")
            for number, (line, function) in enumerate(code_lines(text)):
                for kind, pattern, becomes in CHANGES if line else []:
                    for match in re.finditer(pattern, line):
                        if "\0" in match.group():
                            continue
                        new = lines[number][: match.start()] + match.expand(becomes) if isinstance(becomes, str) else (
                            lines[number][: match.start()] + becomes(match))
                        yield kind, path, number, lines[number], new + lines[number][match.end() :], function


def text_of(mutant):
    """As equivalent.txt has it."""
    _, path, _, before, after, function = mutant
    return "%s %s: %s  ->  %s" % (path, function, before.strip(), after.strip())


def equivalents(path):
    """{text of a mutant: reason} of a list as equivalent.txt describes it."""
    with open(path, encoding="utf-8") as file:
        entries = re.sub(r"(?m)^#.*\n", "", file.read()).strip().split("\n\n")
    return dict(re.fullmatch(r"(.+)\n(\S.*)", entry.strip()).groups() for entry in entries)


def stale(listed):
    """Entries that are not one line of src, as texts."""
    lines = {what: set() for what in listed}
    for mutant in candidates("src"):
        lines.get(text_of(mutant), set()).add(mutant[2])
    return ["%s\n    stands on %d lines, not 1" % (what, len(lines[what])) for what in listed if len(lines[what]) != 1]


def run(command, folder, seconds=900, **more):
    """Whether it ends well, in time; its process group ends with it."""
    process = subprocess.Popen(command, cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                               start_new_session=True, **more)
    try:
        return process.wait(seconds) == 0
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, 9)
        process.wait()
        return False


class Copy:
    """The tree that is mutated, with its build."""

    def __init__(self, folder, options):
        self.folder, self.build = folder, os.path.join(folder, "build")
        ignore = shutil.ignore_patterns("build*", "*.lock", "__pycache__")
        for name in ["src", "tests", "problems", "include", "share", "docs"]:
            self.mirror(name, ignore)
        os.makedirs(os.path.join(folder, "results"), exist_ok=True)
        for name in os.listdir(ROOT):
            if os.path.isfile(os.path.join(ROOT, name)) and name != ".git":
                self.update(name)
        if not os.path.exists(os.path.join(self.build, "build.ninja")):
            subprocess.run(["meson", "setup", "-Ddebug=false", *options, self.build], cwd=folder, check=True,
                           stdout=subprocess.DEVNULL)
        subprocess.run(["ninja", "build.ninja"], cwd=self.build, check=True, stdout=subprocess.DEVNULL)  # of new tests
        files = {target["id"]: [os.path.relpath(name, self.build) for name in target["filename"]]
                 for target in self.introspect("--targets")}
        self.tests = {test["name"]: test for test in self.introspect("--tests")}
        for test in self.tests.values():
            test["programs"] = [name for target in test["depends"] for name in files[target]]
        self.sound = set()  # tests that have passed without a mutant
        self.record = os.path.join(folder, "seconds.json")  # what each test took where it passed last
        self.seconds = {}
        if os.path.exists(self.record):
            with open(self.record, encoding="utf-8") as file:
                self.seconds = json.load(file)

    def mirror(self, name, ignore):
        """Files that differ, so that only these are built again."""
        source = os.path.join(ROOT, name)
        for folder, folders, names in os.walk(source):
            skipped = ignore(folder, folders + names)
            folders[:] = [f for f in folders if f not in skipped]
            for file in names:
                if file not in skipped:
                    self.update(os.path.relpath(os.path.join(folder, file), ROOT))

    def update(self, path):
        there, here = os.path.join(self.folder, path), os.path.join(ROOT, path)
        with open(here, "rb") as file:
            text = file.read()
        if os.path.exists(there):
            with open(there, "rb") as file:
                if file.read() == text:
                    return
        os.makedirs(os.path.dirname(there), exist_ok=True)
        shutil.copy(here, there)

    def of_room(self, path):
        """Tests of the file's room and then of the rooms around it."""
        room, found = os.path.dirname(path).replace("src/", "tests/", 1), []
        while room != "tests":
            folder = os.path.join(self.folder, room)
            names = sorted(os.listdir(folder)) if os.path.isdir(folder) else []
            here = [re.sub(r"^test_|\.(c|sh)$", "", name) for name in names if name.startswith("test_")]
            found += self.in_order([name for name in here if name in self.tests and name not in found], path)
            room = os.path.dirname(room)
        return found

    def in_order(self, names, path):
        """That of the file's name and quick ones first."""
        words = set(re.split(r"[_.]", os.path.basename(path))) - {"c", "inc"}
        took = lambda name: self.seconds.get(name, 1)
        return sorted(names, key=lambda name: (took(name) >= QUICK or not words & set(name.split("_")), took(name), name))

    def introspect(self, what):
        return json.loads(subprocess.run(["meson", "introspect", what, self.build], check=True, capture_output=True).stdout)

    def passes(self, names):
        """The first test that fails, with "(time)" where it took too long; "build" where it does not compile; or None."""
        for name in names:
            test = self.tests[name]
            if not run(["ninja"] + test["programs"], self.build):
                return "build"
            # Meson names a program by its path in the build.
            command = [os.path.join(self.build, part) if part in test["programs"] else part for part in test["cmd"]]
            begin = time.monotonic()
            folder = tempfile.mkdtemp(dir=self.folder)
            most = 15 + 10 * self.seconds[name] if name in self.seconds else SECONDS
            verdict = self.tap(command, folder, dict(os.environ, **SUPPRESSED, **test["env"]), most)
            shutil.rmtree(folder, ignore_errors=True)
            if verdict != "passed":
                return name + (" (time)" if verdict == "time" else "")
            self.seconds[name] = time.monotonic() - begin
            with open(self.record, "w", encoding="utf-8") as file:
                json.dump(self.seconds, file)
        return None

    def all(self, path):
        return self.in_order(set(self.tests) - UNMOVED, path)

    def quick(self, path):
        """Names of quick tests that are programs."""
        programs = [name for name, test in self.tests.items() if len(test["cmd"]) == 1]
        return self.in_order([name for name in programs if self.seconds.get(name, 0) < QUICK], path)

    def moved(self, names):
        """Of the tests those whose programs are out of date."""
        stale = subprocess.run(["ninja", "-n", "-v"], cwd=self.build, check=True, capture_output=True, text=True).stdout
        stale = set(re.findall(r" -o (\S+)", stale))
        return [name for name in names if stale & set(self.tests[name]["programs"])]

    @staticmethod
    def tap(command, folder, environment, seconds):
        """Until the first line that fails: "passed", "failed" or "time"."""
        process = subprocess.Popen(command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, env=environment,
                                   start_new_session=True)
        until, said, planned, failed = time.monotonic() + seconds, b"", False, False
        while not failed and time.monotonic() < until:
            if not select.select([process.stdout], [], [], 1)[0]:
                continue  # also where only what it left behind still holds the pipe, which no one who runs tests waits for
            more = os.read(process.stdout.fileno(), 1 << 16)
            if not more:
                break
            lines = (said + more).split(b"\n")
            said = lines.pop()
            planned = planned or any(line.startswith(b"1..") for line in lines)
            failed = any(line.startswith(b"not ok") for line in lines)
        late = not failed and time.monotonic() >= until
        code = None if failed or late else process.wait()
        end_all(process, folder)
        if late:
            return "time"
        return "passed" if code == 0 and planned and not failed else "failed"

    def plant(self, path, number, before, after, further):
        """What finds the mutant, "build" or None: tests of its room, and of all further ones those that it reaches."""
        while True:
            room = self.of_room(path)
            more = [name for name in further(self, path) if name not in room]
            self.write(path, number, after)
            by = self.passes(room)
            if by is None and more:
                more = self.moved(more)
                run(["ninja"] + [name for test in more for name in self.tests[test]["programs"]], self.build)  # on all cores
                by = self.passes(more)
            self.write(path, number, before)
            name = by and by.split()[0]
            if by in (None, "build") or name in self.sound:
                return by
            if self.passes([name]) is None:  # a test counts where it passes without the mutant
                self.sound.add(name)
                return by
            print("# %s fails without a mutant: left out" % name, flush=True)
            del self.tests[name]

    def write(self, path, number, line):
        with open(os.path.join(self.folder, path), encoding="utf-8") as file:
            lines = file.read().split("\n")
        lines[number] = line
        with open(os.path.join(self.folder, path), "w", encoding="utf-8") as file:
            file.write("\n".join(lines))


def main():
    options = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    options.add_argument("--count", type=int, default=200)
    options.add_argument("--seed", type=int, default=1)
    options.add_argument("--first", type=int, default=1, help="of the sample, to go on where a run was ended")
    options.add_argument("--under", default="src")
    options.add_argument("--folder", default="/var/tmp/moray-mutants")
    options.add_argument("--only", help="numbers in the sample, with commas")
    options.add_argument("--kinds", help="of changes, with commas: " + ", ".join(dict.fromkeys(kind for kind, *_ in CHANGES)))
    options.add_argument("--whole", action="store_true", help="what the room's tests let pass faces every test")
    options.add_argument("--near", action="store_true", help="only the room's tests")
    options.add_argument("--plain", action="store_true", help="not under the sanitizers")
    options.add_argument("--sanitized", action="store_true", help="under the sanitizers alone")
    options.add_argument("--list", action="store_true", help="only list what would be planted")
    options.add_argument("--check-list", nargs="?", const=EQUIVALENT, metavar="FILE",
                         help="only tell which equivalent mutants the source has no longer")
    asked = options.parse_args()
    # What a shell starts in the background ignores it, and so would the programs that tests interrupt.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    listed = equivalents(asked.check_list or EQUIVALENT)
    unknown = stale(listed)
    if unknown or asked.check_list:
        print("\n".join(unknown + ["%d of %d equivalent mutants stand as listed" % (len(listed) - len(unknown), len(listed))]))
        return 1 if unknown else 0
    chosen = asked.kinds.split(",") if asked.kinds else [kind for kind, *_ in CHANGES]
    everything = [mutant for mutant in candidates(asked.under) if mutant[0] in chosen]
    # As many of each kind as there are kinds to share the count.
    kinds = sorted({kind for kind, *_ in everything})
    # In an order that hangs on each mutant's own text, so that a change elsewhere leaves the sample.
    order = lambda m: hashlib.sha256(("%d %s %s %s %s" % (asked.seed, m[0], m[1], m[3], m[4])).encode()).digest()
    by_kind = {kind: sorted((m for m in everything if m[0] == kind), key=order) for kind in kinds}
    sample = [by_kind[kinds[k % len(kinds)]].pop() for k in range(min(asked.count, len(everything)))
              if by_kind[kinds[k % len(kinds)]]]
    wanted = [int(n) for n in asked.only.split(",")] if asked.only else range(asked.first, len(sample) + 1)
    # Where a mutant is planted, one after the other, and what it meets there beside the tests of its room.
    further = Copy.all if asked.whole else (lambda *_: []) if asked.near else Copy.quick
    places = [] if asked.list or asked.sanitized else [(Copy(asked.folder, []), further)]
    if not asked.list and not asked.plain:
        places.append((Copy(asked.folder + "-sanitized", SANITIZED), lambda *_: []))
    killed = survived = late = unbuilt = equal = 0
    begin = time.monotonic()
    for place in wanted:
        kind, path, number, before, after, _ = sample[place - 1]
        what = "%d %s:%d %s: %s  ->  %s" % (place, path, number + 1, kind, before.strip(), after.strip())
        if asked.list:
            print(what)
            continue
        if text_of(sample[place - 1]) in listed:
            equal += 1
            print("%-10s %s  (%s)" % ("equal", what, listed[text_of(sample[place - 1])]), flush=True)
            continue
        by = None
        for copy, further in places:
            by = by or copy.plant(path, number, before, after, further)
        unbuilt += by == "build"
        killed += by not in (None, "build")
        late += by is not None and by.endswith("(time)")
        survived += by is None
        print("%-10s %s" % ("SURVIVED" if by is None else by, what), flush=True)
    if not asked.list and killed + survived > 0:
        print("\n%d of %d killed, %.1f %%, of them %d by their time; %d more did not compile, %d are equivalent; seed %d, of %d possible; %.0f s" % (
            killed, killed + survived, 100 * killed / (killed + survived), late, unbuilt, equal, asked.seed, len(everything),
            time.monotonic() - begin))
    return 0


if __name__ == "__main__":
    sys.exit(main())
