// SPDX-License-Identifier: MIT
#include "ocp/observe/sight.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "ocp/observe/observed.h"

static const double beyond = 1e-6; // of an interval, by which a datum may lie outside of its own

moray_status moray_place_sights(struct layout *layout, struct phase_layout *phase, const struct phase *p)
{
    const double T = phase->mesh.tf - phase->mesh.t0;
    if (!moray_data_move(p))
        return moray_ok();
    phase->sight = calloc((size_t)p->observed.n, sizeof *phase->sight);
    if (!phase->sight)
        return moray_error(MORAY_MEMORY, "no memory for %d observations", p->observed.n);
    for (int k = 0; k < p->observed.n; k++) {
        const double tau = T > 0 ? (p->observed.time[k] - phase->mesh.t0) / T : 0;
        struct sight *sight = &phase->sight[k];
        while (sight->interval + 1 < phase->mesh.intervals && tau >= phase->mesh.edge[sight->interval + 1])
            sight->interval++;
        sight->x = layout->columns;
        sight->row = layout->rows;
        layout->columns += p->nx + p->nu;
        layout->rows += p->nx + p->nu;
    }
    return moray_ok();
}

// ---- One datum ----

// Where it is: tau in the phase, and the polynomials of its interval there.
struct view {
    const struct sight *sight;
    const struct interval *interval;
    const moray_scheme *scheme;
    double tau, T, w;
    double ell[MORAY_MAX_STAGES + 2], integral[MORAY_MAX_STAGES + 2];
    double slope[MORAY_MAX_STAGES + 2], bend[MORAY_MAX_STAGES + 2]; // of ell by sigma
};

static double product_without(const moray_scheme *scheme, double sigma, int j, int a, int b)
{
    double product = 1;
    for (int k = scheme->first; k <= scheme->last; k++)
        if (k != j && k != a && k != b)
            product *= (sigma - scheme->node[k]) / (scheme->node[j] - scheme->node[k]);
    return product;
}

// Adds to slope and bend, which are 0.
static void differentiate(struct view *v, double sigma)
{
    const moray_scheme *s = v->scheme;
    for (int j = s->first; j <= s->last; j++) {
        for (int a = s->first; a <= s->last; a++) {
            if (a == j)
                continue;
            v->slope[j] += product_without(s, sigma, j, a, a) / (s->node[j] - s->node[a]);
            for (int b = s->first; b <= s->last; b++)
                if (b != j && b != a)
                    v->bend[j] +=
                        product_without(s, sigma, j, a, b) / (s->node[j] - s->node[a]) / (s->node[j] - s->node[b]);
        }
    }
}

static struct view look(const struct transcription *t, int p, int k)
{
    const struct phase_layout *layout = &t->layout.phase[p];
    const struct sight *sight = &layout->sight[k];
    const struct interval *interval = &layout->interval[sight->interval];
    struct view v = {.sight = sight, .interval = interval, .scheme = interval->scheme, .w = interval->width};
    v.T = t->phase[p].tf - t->phase[p].t0;
    v.tau = v.T > 0 ? (t->ocp->phase[p].observed.time[k] - t->phase[p].t0) / v.T : 0;
    const double sigma = (v.tau - layout->mesh.edge[sight->interval]) / v.w;
    moray_scheme_basis(v.scheme, sigma, v.ell, v.integral);
    differentiate(&v, sigma);
    return v;
}

static int sights(const struct transcription *t, int p)
{
    return t->layout.phase[p].sight ? t->ocp->phase[p].observed.n : 0;
}

static const double *f_at(const struct transcription *t, int p, const struct view *v, int j)
{
    return t->phase[p].out + (v->interval->first + j) * t->phase[p].map->n_out;
}

static int control_of(const struct transcription *t, int p, const struct view *v, int j)
{
    return t->layout.phase[p].node[v->interval->first + j].x + t->ocp->phase[p].nx;
}

static int start_of(const struct transcription *t, int p, const struct view *v)
{
    return t->layout.phase[p].node[v->interval->first].x;
}

// sum_j weight_j f_j of state r, and sum_j weight_j u_j of control r.
static double sum_of_f(const struct transcription *t, int p, const struct view *v, const double *weight, int r)
{
    double sum = 0;
    for (int j = v->scheme->first; j <= v->scheme->last; j++)
        sum += weight[j] * f_at(t, p, v, j)[r];
    return sum;
}

static double sum_of_u(const struct transcription *t, int p, const struct view *v, const double *weight, int r)
{
    double sum = 0;
    for (int j = v->scheme->first; j <= v->scheme->last; j++)
        sum += weight[j] * t->x[control_of(t, p, v, j) + r];
    return sum;
}

// d tau / d t0 and d tau / d tf.
static void tau_slopes(const struct view *v, double by[2])
{
    by[0] = v->T > 0 ? -(1 - v->tau) / v->T : 0;
    by[1] = v->T > 0 ? -v->tau / v->T : 0;
}

// ---- Rows and their derivatives ----

void moray_assemble_sights(const struct transcription *t, int p, double *g)
{
    const int nx = t->ocp->phase[p].nx, nu = t->ocp->phase[p].nu;
    for (int k = 0; k < sights(t, p); k++) {
        const struct view v = look(t, p, k);
        double *row = g + v.sight->row;
        const double *seen = t->x + v.sight->x, *start = t->x + start_of(t, p, &v);
        for (int r = 0; r < nx; r++)
            row[r] = seen[r] - start[r] - v.T * v.w * sum_of_f(t, p, &v, v.integral, r);
        for (int r = 0; r < nu; r++)
            row[nx + r] = seen[nx + r] - sum_of_u(t, p, &v, v.ell, r);
    }
}

// The slope of a row by t0 (end 0) or tf, but for what f does with time.
static double slope_by(const struct transcription *t, int p, const struct view *v, int r, int end)
{
    const int nx = t->ocp->phase[p].nx;
    double by[2];
    tau_slopes(v, by);
    if (r >= nx)
        return -sum_of_u(t, p, v, v->slope, r - nx) * by[end] / v->w;
    const double length = end ? 1 : -1;
    return -length * v->w * sum_of_f(t, p, v, v->integral, r) - v->T * by[end] * sum_of_f(t, p, v, v->ell, r);
}

static void walk_dynamics(const struct transcription *t, int p, const struct view *v, triplets *out)
{
    const struct phase_layout *layout = &t->layout.phase[p];
    const moray_map *map = t->phase[p].map;
    for (int j = v->scheme->first; j <= v->scheme->last; j++) {
        const struct node *node = &layout->node[v->interval->first + j];
        const double *jac = t->phase[p].jac + (v->interval->first + j) * map->jac.nnz;
        const int *column = moray_node_columns(t, p, node);
        for (int e = 0; e < map->jac.nnz; e++)
            if (map->jac.row[e] < t->ocp->phase[p].nx)
                moray_put_input(t, p, node, column, v->sight->row + map->jac.row[e], map->jac.col[e],
                                -v->T * v->w * v->integral[j] * jac[e], out);
    }
}

void moray_walk_sights(const struct transcription *t, int p, triplets *out)
{
    const struct phase_layout *layout = &t->layout.phase[p];
    const int nx = t->ocp->phase[p].nx, nu = t->ocp->phase[p].nu;
    for (int k = 0; k < sights(t, p); k++) {
        const struct view v = look(t, p, k);
        for (int r = 0; r < nx + nu; r++) {
            triplets_put(out, v.sight->row + r, v.sight->x + r, 1);
            if (layout->t0 != absent)
                triplets_put(out, v.sight->row + r, layout->t0, slope_by(t, p, &v, r, 0));
            if (layout->tf != absent)
                triplets_put(out, v.sight->row + r, layout->tf, slope_by(t, p, &v, r, 1));
        }
        for (int r = 0; r < nx; r++)
            triplets_put(out, v.sight->row + r, start_of(t, p, &v) + r, -1);
        for (int j = v.scheme->first; j <= v.scheme->last; j++)
            for (int r = 0; r < nu; r++)
                triplets_put(out, v.sight->row + nx + r, control_of(t, p, &v, j) + r, -v.ell[j]);
        walk_dynamics(t, p, &v, out);
    }
}

void moray_add_sights_to_dynamics(const struct transcription *t, int p, const double *lambda, double *lambda_f)
{
    const int nx = t->ocp->phase[p].nx;
    for (int k = 0; k < sights(t, p); k++) {
        const struct view v = look(t, p, k);
        for (int j = v.scheme->first; j <= v.scheme->last; j++)
            for (int r = 0; r < nx; r++)
                lambda_f[(v.interval->first + j) * nx + r] -= v.T * v.w * v.integral[j] * lambda[v.sight->row + r];
    }
}

// Through f the times come with its multipliers; here is sigma's part of state rows, and all of control rows.
void moray_add_sights(const struct transcription *t, int p, const double *lambda, double *gradient)
{
    const struct phase_layout *layout = &t->layout.phase[p];
    const int nx = t->ocp->phase[p].nx, nu = t->ocp->phase[p].nu, time[] = {layout->t0, layout->tf};
    for (int k = 0; k < sights(t, p); k++) {
        const struct view v = look(t, p, k);
        const double *own = lambda + v.sight->row;
        double by[2];
        tau_slopes(&v, by);
        for (int r = 0; r < nx + nu; r++) {
            gradient[v.sight->x + r] += own[r];
            for (int end = 0; end < 2; end++)
                if (time[end] != absent)
                    gradient[time[end]] +=
                        own[r] * (r < nx ? -v.T * by[end] * sum_of_f(t, p, &v, v.ell, r) : slope_by(t, p, &v, r, end));
        }
        for (int r = 0; r < nx; r++)
            gradient[start_of(t, p, &v) + r] -= own[r];
        for (int j = v.scheme->first; j <= v.scheme->last; j++)
            for (int r = 0; r < nu; r++)
                gradient[control_of(t, p, &v, j) + r] -= v.ell[j] * own[nx + r];
    }
}

// ---- Second derivatives ----

void moray_sights_by_time(const struct transcription *t, int p, const double *lambda, double *by_time)
{
    const int nx = t->ocp->phase[p].nx;
    memset(by_time, 0, (size_t)t->layout.phase[p].nodes * 2 * (size_t)nx * sizeof *by_time);
    for (int k = 0; k < sights(t, p); k++) {
        const struct view v = look(t, p, k);
        double by[2];
        tau_slopes(&v, by);
        for (int j = v.scheme->first; j <= v.scheme->last; j++)
            for (int end = 0; end < 2; end++)
                for (int r = 0; r < nx; r++)
                    by_time[(2 * (v.interval->first + j) + end) * nx + r] -=
                        v.T * by[end] * v.ell[j] * lambda[v.sight->row + r];
    }
}

// d2 / d (t0, tf)^2 of the rows with f and u held: with Y the polynomial of T f's integral, Y'' tau' tau' is left of a
// state's, and of a control's that and its slope times tau''.
static double bend_by(const struct transcription *t, int p, const struct view *v, int r, int one, int other)
{
    const int nx = t->ocp->phase[p].nx;
    const double T = v->T, w = v->w, twice[] = {-2 * (1 - v->tau), 1 - 2 * v->tau, 2 * v->tau};
    double by[2];
    tau_slopes(v, by);
    if (r < nx)
        return -T / w * by[one] * by[other] * sum_of_f(t, p, v, v->slope, r);
    return -sum_of_u(t, p, v, v->bend, r - nx) * by[one] * by[other] / (w * w) -
           sum_of_u(t, p, v, v->slope, r - nx) * (T > 0 ? twice[one + other] / (T * T) : 0) / w;
}

void moray_bend_sights(const struct transcription *t, int p, const double *lambda, triplets *out)
{
    const struct phase_layout *layout = &t->layout.phase[p];
    const int nx = t->ocp->phase[p].nx, nu = t->ocp->phase[p].nu, time[] = {layout->t0, layout->tf};
    for (int k = 0; k < sights(t, p); k++) {
        const struct view v = look(t, p, k);
        const double *own = lambda + v.sight->row;
        double by[2];
        tau_slopes(&v, by);
        for (int one = 0; one < 2; one++) {
            for (int other = 0; other <= one; other++) {
                double sum = 0;
                for (int r = 0; r < nx + nu; r++)
                    sum += own[r] * bend_by(t, p, &v, r, one, other);
                if (time[one] != absent && time[other] != absent)
                    triplets_put_lower(out, time[one], time[other], sum);
            }
            for (int j = v.scheme->first; j <= v.scheme->last && time[one] != absent; j++)
                for (int r = 0; r < nu; r++)
                    triplets_put_lower(out, time[one], control_of(t, p, &v, j) + r,
                                       -own[nx + r] * v.slope[j] * by[one] / v.w);
        }
    }
}

// ---- Places ----

void moray_fill_sights(const struct phase_layout *layout, const struct phase *phase, const double *size, bool of_rows,
                       double *filled)
{
    for (int k = 0; layout->sight && k < phase->observed.n; k++)
        memcpy(filled + (of_rows ? layout->sight[k].row : layout->sight[k].x), size,
               (size_t)(phase->nx + phase->nu) * sizeof *size);
}

bool moray_sights_left(const struct transcription *t, struct mesh *meshes)
{
    bool left = false;
    for (int p = 0; p < t->ocp->phases; p++) {
        const struct phase_layout *layout = &t->layout.phase[p];
        for (int k = 0; k < sights(t, p); k++) {
            const struct view v = look(t, p, k);
            const double *edge = layout->mesh.edge + v.sight->interval, slack = beyond * v.w;
            const bool before = v.tau < edge[0] - slack && v.sight->interval > 0;
            const bool after = v.tau > edge[1] + slack && v.sight->interval + 1 < layout->mesh.intervals;
            left = left || before || after;
        }
        meshes[p].t0 = t->phase[p].t0;
        meshes[p].tf = t->phase[p].tf;
    }
    return left;
}

double moray_sight_error(const struct transcription *t, int p, int k, const double *x, const double *u,
                         const double *size)
{
    const int nx = t->ocp->phase[p].nx, nu = t->ocp->phase[p].nu;
    const double *seen = t->x + t->layout.phase[p].sight[k].x;
    double worst = 0;
    for (int r = 0; r < nx + nu; r++)
        worst = fmax(worst, fabs(seen[r] - (r < nx ? x[r] : u[r - nx])) / (size[r] > 0 ? size[r] : 1));
    return worst;
}
