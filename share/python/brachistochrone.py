# SPDX-License-Identifier: MIT
"""The fastest wire for a bead from (0, 10) to (10, 5), from rest, without friction (Bryson & Ho 1975, sec. 2.7).

    python3 brachistochrone.py [FIGURE.png]      # the figure needs python3-matplotlib
"""
import sys

import numpy as np

import moray

GRAVITY = 9.80665


def slide(x, u, s, t):
    v, angle = x[2], u[0]
    return [v * np.sin(angle), -v * np.cos(angle), GRAVITY * np.cos(angle)]


wire = moray.Phase(nx=3, nu=1, rates=slide, t0=0, tf=(0.1, 10), x0=[0, 10, 0], xf=[10, 5, None], u=[(0, np.pi)],
                   x_names=["x", "y", "v"], u_names=["angle"])
found = moray.solve([wire], lambda phases, s: phases[0].tf, intervals=10, name="brachistochrone")
print(f"{found.objective:.6f} s, certified: {found.certified} {found.why}")

if len(sys.argv) > 1:
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot
    path, _ = found.phases[0].at(np.linspace(0, found.objective, 200))
    pyplot.plot(path[:, 0], path[:, 1])
    pyplot.plot(found.phases[0].x[:, 0], found.phases[0].x[:, 1], ".")
    pyplot.axis("equal")
    pyplot.xlabel("x [m]")
    pyplot.ylabel("y [m]")
    pyplot.savefig(sys.argv[1])
