#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The tests measured: faults planted in src one at a time, and which of them the tests find.

    python3 tests/studies/mutate.py [--count 200] [--seed 1] [--first 1] [--under src/ocp] [--folder DIR] [--list]

Works on a copy of the source tree with a build of its own, in a folder that is left for the next run. A mutant is one
sign, factor, index, relation, logical operator, negation, term or statement changed. It is built as far as the tests of
its room (tests/ROOM for src/ROOM) need it, and these run until one fails; then, where none does, those of SECOND.
Survivors are listed by file, line and change; the last line counts. Runs by name alone: some ten seconds a mutant.
"""
import argparse
import json
import os
import random
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
SECOND = ["gait_problem", "classics_models", "readers", "classics", "max_speed"]  # what the rooms' own tests let pass
SECONDS = 120  # for one test; a mutant may loop for ever

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


def code_lines(text):
    """Lines of function bodies, with strings and comments blanked out so that columns stay; None elsewhere."""
    blank = lambda m: re.sub(r"[^\n]", "\0", m.group())
    text = re.sub(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\])*\'', blank, text, flags=re.S)
    inside = False
    for line in text.split("\n"):
        if line.startswith("{"):
            inside = True
        elif line.startswith("}"):
            inside = False
        yield line if inside and line.startswith(" ") and not line.lstrip().startswith("#") else None


def candidates(under):
    for folder, _, names in sorted(os.walk(os.path.join(ROOT, under))):
        for name in sorted(names):
            if not name.endswith((".c", ".inc")):
                continue
            path = os.path.relpath(os.path.join(folder, name), ROOT)
            with open(os.path.join(ROOT, path), encoding="utf-8") as file:
                text = file.read()
            lines = text.split("\n")
            for number, line in enumerate(code_lines(text)):
                for kind, pattern, becomes in CHANGES if line else []:
                    for match in re.finditer(pattern, line):
                        if "\0" in match.group():
                            continue
                        new = lines[number][: match.start()] + match.expand(becomes) if isinstance(becomes, str) else (
                            lines[number][: match.start()] + becomes(match))
                        yield kind, path, number, lines[number], new + lines[number][match.end() :]


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

    def __init__(self, folder):
        self.folder, self.build = folder, os.path.join(folder, "build")
        ignore = shutil.ignore_patterns("build*", "*.lock", "__pycache__")
        for name in ["src", "tests", "problems", "include", "share", "docs"]:
            self.mirror(name, ignore)
        os.makedirs(os.path.join(folder, "results"), exist_ok=True)
        for name in os.listdir(ROOT):
            if os.path.isfile(os.path.join(ROOT, name)) and name != ".git":
                self.update(name)
        if not os.path.exists(os.path.join(self.build, "build.ninja")):
            subprocess.run(["meson", "setup", self.build], cwd=folder, check=True, stdout=subprocess.DEVNULL)
        tests = subprocess.run(["meson", "introspect", "--tests", self.build], check=True, capture_output=True).stdout
        self.tests = {test["name"]: test for test in json.loads(tests)}
        self.sound = set()  # tests that have passed without a mutant

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
        room = os.path.dirname(path).replace("src/", "tests/", 1)
        while room != "tests" and not os.path.isdir(os.path.join(self.folder, room)):
            room = os.path.dirname(room)
        names = sorted(os.listdir(os.path.join(self.folder, room))) if room != "tests" else []
        found = [re.sub(r"^test_|\.(c|sh)$", "", name) for name in names if name.startswith("test_")]
        return [name for name in found if name in self.tests]

    def targets(self, name):
        test, files = self.tests[name], set(os.listdir(os.path.join(self.build, "problems")))
        programs = [os.path.relpath(part, self.build) for part in test["cmd"] if part.startswith(self.build + "/")]
        if "problems" in programs:
            return ["all"]
        return [part for part in programs if os.path.dirname(part) in ("tests", "problems") or part in files]

    def passes(self, names):
        """The first test that fails, "build" where it does not compile, or None."""
        for name in names:
            targets = self.targets(name)
            if targets and not run(["ninja"] + targets, self.build):
                return "build"
            test = self.tests[name]
            environment = dict(os.environ, **test.get("env", {}))
            folder = tempfile.mkdtemp(dir=self.folder)
            good = self.tap(test["cmd"], folder, environment)
            shutil.rmtree(folder, ignore_errors=True)
            if not good:
                return name
        return None

    @staticmethod
    def tap(command, folder, environment):
        with tempfile.TemporaryFile() as output:
            process = subprocess.Popen(command, cwd=folder, stdout=output, stderr=subprocess.DEVNULL, env=environment,
                                       start_new_session=True)
            try:
                code = process.wait(SECONDS)
            except subprocess.TimeoutExpired:
                os.killpg(process.pid, 9)
                process.wait()
                return False
            output.seek(0)
            lines = output.read().decode(errors="replace").split("\n")
        planned = [line for line in lines if line.startswith("1..")]
        return code == 0 and bool(planned) and not any(line.startswith("not ok") for line in lines)

    def plant(self, path, number, before, after):
        """What finds the mutant, "build" or None. A test counts where it passes without one."""
        while True:
            self.write(path, number, after)
            room = self.of_room(path)
            by = self.passes(room) or self.passes([name for name in SECOND if name in self.tests and name not in room])
            self.write(path, number, before)
            if by in (None, "build") or by in self.sound:
                return by
            if self.passes([by]) is None:
                self.sound.add(by)
                return by
            print("# %s fails without a mutant: left out" % by, flush=True)
            del self.tests[by]

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
    options.add_argument("--list", action="store_true", help="only list what would be planted")
    asked = options.parse_args()
    everything = list(candidates(asked.under))
    # As many of each kind as there are kinds to share the count.
    kinds = sorted({kind for kind, *_ in everything})
    draw = random.Random(asked.seed)
    by_kind = {kind: draw.sample(m, len(m)) for kind in kinds for m in [[c for c in everything if c[0] == kind]]}
    sample = [by_kind[kinds[k % len(kinds)]].pop() for k in range(min(asked.count, len(everything)))
              if by_kind[kinds[k % len(kinds)]]]
    copy = None if asked.list else Copy(asked.folder)
    killed = survived = unbuilt = 0
    for kind, path, number, before, after in sample[asked.first - 1 :]:
        what = "%s:%d %s: %s  ->  %s" % (path, number + 1, kind, before.strip(), after.strip())
        if asked.list:
            print(what)
            continue
        by = copy.plant(path, number, before, after)
        unbuilt += by == "build"
        killed += by not in (None, "build")
        survived += by is None
        print("%-10s %s" % ("SURVIVED" if by is None else by, what), flush=True)
    if not asked.list and killed + survived > 0:
        print("\n%d of %d killed, %.0f %%; %d more did not compile; seed %d, of %d possible" % (
            killed, killed + survived, 100 * killed / (killed + survived), unbuilt, asked.seed, len(everything)))
    return 0


if __name__ == "__main__":
    sys.exit(main())
