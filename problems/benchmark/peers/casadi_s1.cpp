// SPDX-License-Identifier: MIT
//
// S1 of problems/benchmark/s1.c for CasADi, in C++: the same model, scheme, mesh, start, barrier there, limits and
// tolerance, with CasADi's own derivatives and Ipopt as CasADi calls it.
//
//   c++ -O2 casadi_s1.cpp $(pkg-config --cflags --libs casadi) -o casadi_s1
//   ./casadi_s1 START.csv        START.csv: `benchmark --part s1 --out DIR` writes s1_start.csv
//
// Prints objective, iterations and the processor seconds from the first line of the problem to the solution.
#include <casadi/casadi.hpp>
#include <cmath>
#include <ctime>
#include <fstream>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

using casadi::DM;
using casadi::MX;
using casadi::Slice;
using casadi::SX;

static const int N = 10, joints = N - 1, states = 2 * N + 4, intervals = 20;
static const double pi = 3.14159265358979323846, deg = pi / 180;

// Sec. V-A of the paper, by the formulas for an elliptic cylinder.
static const double L = 0.14, l = L / 2, a_e = 0.05, b_e = 0.03, rho = 1000;
static const double m = rho * pi * a_e * b_e * L, mu_n = rho * pi * b_e * b_e * L;
static const double c_t = rho * pi * 0.03 * (a_e + b_e) / 2 * l, c_n = rho * 2 * 2 * b_e * l;
static const double c_p = (c_n - c_t) / (2 * L), mu_p = mu_n / (2 * L), c_n_hat = c_n / (4 * L * L), mt = m + mu_n;
static const double rot_damping = 1.15, rot_gain = 40, k_p = 200, k_d = 50, V_x = 0.1, V_y = 0.1;

// State of (21): phi, theta, p_x, p_y, v_phi, v_theta, v_t, v_n. Parameters a, omega, delta, phi_0.
static SX dynamics(const SX &x, const SX &p, const SX &t)
{
    SX phi = x(Slice(0, joints)), theta = x(joints), v_phi = x(Slice(joints + 3, 2 * joints + 3));
    SX v_theta = x(2 * joints + 3), v_t = x(2 * joints + 4), v_n = x(2 * joints + 5);
    SX a = p(0), omega = p(1), delta = p(2), phi_0 = p(3), ubar = SX::zeros(joints);
    for (int i = 0; i < joints; i++) { // (25) and (34)
        SX angle = omega * t + i * delta;
        SX ref = a * sin(angle) + phi_0, dref = a * omega * cos(angle), ddref = -a * omega * omega * sin(angle);
        ubar(i) = ddref + k_d * (dref - v_phi(i)) + k_p * (ref - phi(i));
    }
    DM A = DM::zeros(joints, N), D = DM::zeros(joints, N);
    for (int i = 0; i < joints; i++) {
        A(i, i) = A(i, i + 1) = 1;
        D(i, i) = 1;
        D(i, i + 1) = -1;
    }
    DM Dbar = mtimes(D.T(), inv(mtimes(D, D.T())));
    SX b = SX::mtimes(SX(mtimes(A, Dbar).T()), phi), across = SX::mtimes(SX(A.T()), phi);
    SX s = sum1(phi), q = dot(across, across), w = dot(b, v_phi), z = dot(b, ubar);
    SX v_tr = v_t - (V_x * cos(theta) + V_y * sin(theta)), v_nr = v_n - (-V_x * sin(theta) + V_y * cos(theta));
    // (14a), (14b) summed over the links, solved for the accelerations of the body (erratum E1)
    SX coupling = 2 * mu_p * s, det = N * N * m * mt - coupling * coupling;
    SX force_t = -mu_p * z - c_p * w + 2 * c_p * s * v_nr - (N * c_t + c_n_hat * q) * v_tr;
    SX force_n = 2 * c_p * s * v_tr - N * c_n * v_nr;
    return vertcat(std::vector<SX>{v_phi, v_theta, v_t * cos(theta) - v_n * sin(theta),
                                   v_t * sin(theta) + v_n * cos(theta), ubar,
                                   rot_gain / (N - 1) * v_tr * s - rot_damping * v_theta,
                                   (N * mt * force_t + coupling * force_n) / det,
                                   (N * m * force_n + coupling * force_t) / det});
}

struct start {
    std::vector<double> t;
    std::vector<std::vector<double>> x;
};

static start read_start(const char *name)
{
    start orbit;
    std::ifstream file(name);
    std::string line, cell;
    std::getline(file, line); // names
    while (std::getline(file, line)) {
        std::stringstream cells(line);
        std::vector<double> row;
        while (std::getline(cells, cell, ','))
            row.push_back(std::stod(cell));
        if ((int)row.size() != 1 + states)
            throw std::runtime_error(std::string(name) + ": a row has " + std::to_string(row.size()) + " numbers");
        orbit.t.push_back(row[0]);
        orbit.x.emplace_back(row.begin() + 1, row.end());
    }
    if (orbit.t.size() < 2)
        throw std::runtime_error(std::string(name) + ": no start in it");
    return orbit;
}

static double at(const start &orbit, int k, double t)
{
    size_t i = 1;
    while (i + 1 < orbit.t.size() && orbit.t[i] < t)
        i++;
    const double part = (t - orbit.t[i - 1]) / (orbit.t[i] - orbit.t[i - 1]);
    return orbit.x[i - 1][k] + part * (orbit.x[i][k] - orbit.x[i - 1][k]);
}

struct programme {
    std::vector<MX> g, w;
    std::vector<double> g_low, g_up, w_low, w_up, w_0;
};

static void constrain(programme &nlp, const MX &g, double low, double up)
{
    nlp.g.push_back(g);
    nlp.g_low.insert(nlp.g_low.end(), g.size1(), low);
    nlp.g_up.insert(nlp.g_up.end(), g.size1(), up);
}

static MX variable(programme &nlp, const char *name, double low, double up, double begin)
{
    nlp.w.push_back(MX::sym(name));
    nlp.w_low.push_back(low);
    nlp.w_up.push_back(up);
    nlp.w_0.push_back(begin);
    return nlp.w.back();
}

static MX state(programme &nlp, const start &orbit, double t, bool first)
{
    nlp.w.push_back(MX::sym("x", states));
    for (int k = 0; k < states; k++) {
        const bool origin = first && (k == joints + 1 || k == joints + 2);
        nlp.w_low.push_back(origin ? 0 : -casadi::inf);
        nlp.w_up.push_back(origin ? 0 : casadi::inf);
        nlp.w_0.push_back(at(orbit, k, t));
    }
    return nlp.w.back();
}

int main(int argc, char **argv)
{
    if (argc != 2) {
        std::cerr << "usage: casadi_s1 START.csv\n";
        return 2;
    }
    const start orbit = read_start(argv[1]);
    const std::clock_t begin = std::clock();

    SX x = SX::sym("x", states), s = SX::sym("p", 4), t = SX::sym("t");
    casadi::Function f("f", {x, s, t}, {dynamics(x, s, t)});

    programme nlp;
    const double delta_0 = 40 * deg, omega_0 = 120 * deg;
    MX a = variable(nlp, "a", 0, L * std::sin(20 * deg), L * std::cos(delta_0 / 2) * std::sin(10 * deg));
    MX omega = variable(nlp, "omega", 30 * deg, 180 * deg, omega_0);
    MX delta = variable(nlp, "delta", 30 * deg, 50 * deg, delta_0);
    MX phi_0 = variable(nlp, "phi_0", -0.02, 0.02, 0);
    MX T = variable(nlp, "T", 2 * pi / (180 * deg), 2 * pi / (30 * deg), 2 * pi / omega_0);
    MX p = vertcat(std::vector<MX>{a, omega, delta, phi_0}), h = T / intervals;
    const double h_0 = 2 * pi / omega_0 / intervals;

    MX first = state(nlp, orbit, 0, true), left = first, f_left = f(std::vector<MX>{left, p, MX(0)})[0];
    for (int k = 0; k < intervals; k++) { // separated Hermite-Simpson
        MX middle = state(nlp, orbit, (k + 0.5) * h_0, false), right = state(nlp, orbit, (k + 1) * h_0, false);
        MX f_middle = f(std::vector<MX>{middle, p, (k + 0.5) * h})[0];
        MX f_right = f(std::vector<MX>{right, p, (k + 1) * h})[0];
        constrain(nlp, middle - left - h * (5. / 24 * f_left + 1. / 3 * f_middle - 1. / 24 * f_right), 0, 0);
        constrain(nlp, right - left - h * (1. / 6 * f_left + 2. / 3 * f_middle + 1. / 6 * f_right), 0, 0);
        left = right;
        f_left = f_right;
    }
    for (int k = 0; k < states; k++)
        if (k != joints + 1)
            constrain(nlp, left(k) - first(k), 0, 0);
    constrain(nlp, omega * T, 2 * pi, 2 * pi);
    constrain(nlp, a / (L * cos(delta / 2)), std::sin(1 * deg), std::sin(20 * deg));

    casadi::Dict ipopt{
        {"tol", 1e-8}, {"mu_init", 1e-6}, {"print_level", 0}, {"linear_solver", "mumps"}, {"sb", "yes"}};
    casadi::Function solver = casadi::nlpsol(
        "solver", "ipopt",
        casadi::MXDict{{"x", vertcat(nlp.w)}, {"g", vertcat(nlp.g)}, {"f", -left(joints + 1) / T}},
        casadi::Dict{{"ipopt", ipopt}, {"print_time", false}, {"expand", true}});
    casadi::DMDict found = solver(casadi::DMDict{
        {"x0", nlp.w_0}, {"lbx", nlp.w_low}, {"ubx", nlp.w_up}, {"lbg", nlp.g_low}, {"ubg", nlp.g_up}});

    const double seconds = double(std::clock() - begin) / CLOCKS_PER_SEC;
    std::cout.precision(10);
    std::cout << "objective " << double(found.at("f")) << "\niterations " << int(solver.stats().at("iter_count"))
              << "\nseconds " << seconds << "\nsolved " << bool(solver.stats().at("success")) << "\nversion "
              << casadi::CasadiMeta::version() << "\n";
    return 0;
}
