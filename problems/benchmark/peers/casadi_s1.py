# SPDX-License-Identifier: MIT
"""S1 of problems/benchmark/s1.c for CasADi, in Python: see casadi_s1.cpp, which states the same programme.

    python3 casadi_s1.py START.csv      (START.csv: `benchmark --part s1 --out DIR` writes s1_start.csv)

Prints objective, iterations and the processor seconds from the first line of the problem to the solution.
"""
import csv
import sys
import time
from math import cos, pi, sin

import casadi as ca

N, JOINTS, STATES, INTERVALS = 10, 9, 24, 20
DEG = pi / 180

# Sec. V-A of the paper, by the formulas for an elliptic cylinder.
L, A_E, B_E, RHO = 0.14, 0.05, 0.03, 1000
HALF = L / 2
M, MU_N = RHO * pi * A_E * B_E * L, RHO * pi * B_E**2 * L
C_T, C_N = RHO * pi * 0.03 * (A_E + B_E) / 2 * HALF, RHO * 2 * 2 * B_E * HALF
C_P, MU_P, C_N_HAT, MT = (C_N - C_T) / (2 * L), MU_N / (2 * L), C_N / (4 * L**2), M + MU_N
ROT_DAMPING, ROT_GAIN, K_P, K_D, V_X, V_Y = 1.15, 40, 200, 50, 0.1, 0.1


def dynamics():
    """State of (21): phi, theta, p_x, p_y, v_phi, v_theta, v_t, v_n. Parameters a, omega, delta, phi_0."""
    x, p, t = ca.SX.sym("x", STATES), ca.SX.sym("p", 4), ca.SX.sym("t")
    phi, theta, v_phi = x[:JOINTS], x[JOINTS], x[JOINTS + 3:2 * JOINTS + 3]
    v_theta, v_t, v_n = x[2 * JOINTS + 3], x[2 * JOINTS + 4], x[2 * JOINTS + 5]
    a, omega, delta, phi_0 = p[0], p[1], p[2], p[3]
    angle = omega * t + delta * ca.DM(range(JOINTS))
    ref, dref, ddref = a * ca.sin(angle) + phi_0, a * omega * ca.cos(angle), -a * omega**2 * ca.sin(angle)
    ubar = ddref + K_D * (dref - v_phi) + K_P * (ref - phi)  # (25) and (34)
    A, D = ca.DM.zeros(JOINTS, N), ca.DM.zeros(JOINTS, N)
    for i in range(JOINTS):
        A[i, i] = A[i, i + 1] = D[i, i] = 1
        D[i, i + 1] = -1
    Dbar = D.T @ ca.inv(D @ D.T)
    b, across = (A @ Dbar).T @ phi, A.T @ phi
    s, q, w, z = ca.sum1(phi), ca.dot(across, across), ca.dot(b, v_phi), ca.dot(b, ubar)
    v_tr = v_t - (V_X * ca.cos(theta) + V_Y * ca.sin(theta))
    v_nr = v_n - (-V_X * ca.sin(theta) + V_Y * ca.cos(theta))
    # (14a), (14b) summed over the links, solved for the accelerations of the body (erratum E1)
    coupling = 2 * MU_P * s
    det = N * N * M * MT - coupling**2
    force_t = -MU_P * z - C_P * w + 2 * C_P * s * v_nr - (N * C_T + C_N_HAT * q) * v_tr
    force_n = 2 * C_P * s * v_tr - N * C_N * v_nr
    rates = ca.vertcat(v_phi, v_theta, v_t * ca.cos(theta) - v_n * ca.sin(theta),
                       v_t * ca.sin(theta) + v_n * ca.cos(theta), ubar,
                       ROT_GAIN / (N - 1) * v_tr * s - ROT_DAMPING * v_theta,
                       (N * MT * force_t + coupling * force_n) / det, (N * M * force_n + coupling * force_t) / det)
    return ca.Function("f", [x, p, t], [rates])


def read_start(name):
    with open(name, newline="", encoding="ascii") as file:
        rows = [[float(cell) for cell in row] for row in list(csv.reader(file))[1:]]
    if len(rows) < 2 or any(len(row) != 1 + STATES for row in rows):
        sys.exit(f"{name}: not the start of S1")
    return rows


def state_at(rows, t):
    i = 1
    while i + 1 < len(rows) and rows[i][0] < t:
        i += 1
    part = (t - rows[i - 1][0]) / (rows[i][0] - rows[i - 1][0])
    return [a + part * (b - a) for a, b in zip(rows[i - 1][1:], rows[i][1:])]


class Programme:
    def __init__(self):
        self.w, self.w_low, self.w_up, self.w_0, self.g, self.g_low, self.g_up = [], [], [], [], [], [], []

    def variable(self, name, low, up, start):
        self.w.append(ca.MX.sym(name, len(start)))
        self.w_low += low
        self.w_up += up
        self.w_0 += start
        return self.w[-1]

    def state(self, rows, t, first=False):
        fixed = [first and k in (JOINTS + 1, JOINTS + 2) for k in range(STATES)]
        return self.variable("x", [0 if is_fixed else -ca.inf for is_fixed in fixed],
                             [0 if is_fixed else ca.inf for is_fixed in fixed], state_at(rows, t))

    def constrain(self, g, low, up):
        self.g.append(g)
        self.g_low += [low] * g.size1()
        self.g_up += [up] * g.size1()


def main():
    if len(sys.argv) != 2:
        sys.exit("usage: casadi_s1.py START.csv")
    rows = read_start(sys.argv[1])
    begin = time.process_time()
    f, nlp = dynamics(), Programme()
    delta_0, omega_0 = 40 * DEG, 120 * DEG
    a = nlp.variable("a", [0], [L * sin(20 * DEG)], [L * cos(delta_0 / 2) * sin(10 * DEG)])
    omega = nlp.variable("omega", [30 * DEG], [180 * DEG], [omega_0])
    delta = nlp.variable("delta", [30 * DEG], [50 * DEG], [delta_0])
    phi_0 = nlp.variable("phi_0", [-0.02], [0.02], [0])
    T = nlp.variable("T", [2 * pi / (180 * DEG)], [2 * pi / (30 * DEG)], [2 * pi / omega_0])
    p, h, h_0 = ca.vertcat(a, omega, delta, phi_0), T / INTERVALS, 2 * pi / omega_0 / INTERVALS
    first = left = nlp.state(rows, 0, first=True)
    f_left = f(left, p, 0)
    for k in range(INTERVALS):  # separated Hermite-Simpson
        middle, right = nlp.state(rows, (k + 0.5) * h_0), nlp.state(rows, (k + 1) * h_0)
        f_middle, f_right = f(middle, p, (k + 0.5) * h), f(right, p, (k + 1) * h)
        nlp.constrain(middle - left - h * (5 / 24 * f_left + 1 / 3 * f_middle - 1 / 24 * f_right), 0, 0)
        nlp.constrain(right - left - h * (1 / 6 * f_left + 2 / 3 * f_middle + 1 / 6 * f_right), 0, 0)
        left, f_left = right, f_right
    for k in range(STATES):
        if k != JOINTS + 1:
            nlp.constrain(left[k] - first[k], 0, 0)
    nlp.constrain(omega * T, 2 * pi, 2 * pi)
    nlp.constrain(a / (L * ca.cos(delta / 2)), sin(1 * DEG), sin(20 * DEG))
    solver = ca.nlpsol("solver", "ipopt",
                       {"x": ca.vertcat(*nlp.w), "g": ca.vertcat(*nlp.g), "f": -left[JOINTS + 1] / T},
                       {"ipopt": {"tol": 1e-8, "mu_init": 1e-6, "print_level": 0, "linear_solver": "mumps",
                                  "sb": "yes"},
                        "print_time": False, "expand": True})
    found = solver(x0=nlp.w_0, lbx=nlp.w_low, ubx=nlp.w_up, lbg=nlp.g_low, ubg=nlp.g_up)
    seconds = time.process_time() - begin
    stats = solver.stats()
    print(f"objective {float(found['f']):.10g}\niterations {stats['iter_count']}\nseconds {seconds:.6g}\n"
          f"solved {int(stats['success'])}\nversion {ca.__version__}")


main()
