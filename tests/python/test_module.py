# SPDX-License-Identifier: MIT
"""The Python module, on problems of its own, and its structures beside those of the headers. Argument: what layout.c prints."""
import subprocess
import sys

import numpy as np

import moray

run = failed = 0


def check(good, what):
    global run, failed
    run += 1
    failed += not good
    print(f"{'' if good else 'not '}ok {run} - {what}", flush=True)


def refused(kind, text, call):
    try:
        call()
    except kind as error:
        check(text in str(error), f"refused: {error}")
    else:
        check(False, f"refused: {text}")


# ---- Structures as the headers have them
for line in open(sys.argv[1]):
    structure, size, *fields = line.split()
    mirror = moray.STRUCTURES[structure]
    ours = [f"{name.rstrip('_')}={getattr(mirror, name).offset}" for name, *_ in mirror._fields_]
    check(int(size) == moray.c.sizeof(mirror) and fields == ours, f"{structure}: {size} bytes, {len(fields)} fields")


# ---- Bryson and Denham: path constraint and integral; optimum 4 / (9 l)
def turn(l, **how):
    phase = moray.Phase(nx=2, nu=1, nc=1, nq=1, rates=lambda x, u, s, t: ([x[1], u[0]], [x[0] - l], [u[0] ** 2 / 2]),
                        t0=0, tf=1, x0=[0, 1], xf=[0, -1], c=[(None, 0)], guess=how.pop("guess", None))
    return moray.solve([phase], lambda phases, s: phases[0].q[0], **how)


found = turn(1 / 9, intervals=20)
check(found.solved and found.certified, f"Bryson and Denham: certified {found.why}")
check(abs(found.objective - 4) < 1e-5, f"optimum 4: {found.objective}")
x = found.phases[0]
check(x.x.shape == (x.t.size, 2) and x.u.shape == (x.t.size, 1) and x.costates.shape == x.x.shape, "arrays by nodes")
check(abs(x.q[0] - found.objective) < 1e-9 and abs(x.at(0.5)[0][0] - 1 / 9) < 1e-4, "its integral, and the middle")
check(set(found.certificate) >= {"kkt", "mesh_error", "resimulation"}, "the numbers of the certificate")
again = turn(1 / 9, intervals=20, guess=(x.t, x.x, x.u), scheme="radau3")
check(again.certified and abs(again.objective - 4) < 1e-5, f"from a guess, on another scheme: {again.objective}")


# ---- A parameter and an event: x' = s x from 1 to e in 1 s, x(1) = e x(0)
grow = moray.Phase(nx=1, nu=0, rates=lambda x, u, s, t: [s[0] * x[0]], t0=0, tf=1, x0=[1], x=[(0.1, 10)])
found = moray.solve([grow], lambda phases, s: (s[0] ** 2, [phases[0].xf[0] / phases[0].x0[0]]), ns=1, s=[(0.1, 3)], ne=1,
                    e=[np.e], s_guess=[0.5])
check(found.solved and abs(found.s[0] - 1) < 1e-6, f"a parameter: {found.s[0]}")

# ---- What is refused
refused(moray.Error, "u has 2 bounds: must have 1",
        lambda: moray.solve([moray.Phase(nx=1, nu=1, rates=None, tf=1, u=[0, 0])], None))
refused(moray.Error, "x0[0] = high: must be a number", lambda: moray.solve([moray.Phase(1, 0, None, x0=["high"])], None))
refused(moray.Error, "no setting intervalls", lambda: turn(1 / 9, intervalls=3))
refused(moray.Error, "scheme", lambda: turn(1 / 9, scheme="euler"))
refused(moray.Error, "1 numbers are returned, must be 2", lambda: moray.solve(
    [moray.Phase(nx=2, nu=0, rates=lambda x, u, s, t: [x[1]], t0=0, tf=1, x0=[0, 1])], lambda phases, s: 0))
refused(ZeroDivisionError, "division", lambda: moray.solve(
    [moray.Phase(nx=1, nu=0, rates=lambda x, u, s, t: [1 / 0], t0=0, tf=1, x0=[0])], lambda phases, s: 0))

# ---- The example: a cycloid x = r (a - sin a), y = r (1 - cos a) in a sqrt(r / g)
low, high = 1e-3, 2 * np.pi
for _ in range(100):
    a = (low + high) / 2
    low, high = (a, high) if a - np.sin(a) < 2 * (1 - np.cos(a)) else (low, a)
time = a * np.sqrt(5 / (1 - np.cos(a)) / 9.80665)
said = subprocess.run([sys.executable, sys.argv[2]], capture_output=True, text=True, check=False)
check(said.returncode == 0 and "certified: True" in said.stdout, f"the example: {said.stdout.strip()} {said.stderr[-300:]}")
check(abs(float((said.stdout or "0").split()[0]) - time) < 1e-5, f"the cycloid's time: {time:.6f}")
print(f"1..{run}")
sys.exit(failed > 0)
