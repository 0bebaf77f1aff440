// SPDX-License-Identifier: MIT
//
// Two of four controls are held over parts of unequal length that a mesh cuts: whose control each node has, its rows,
// their derivatives, and what is filled in for them, against the order of time.
#include "tap.h"

#include <stdlib.h>
#include <string.h>

#include "ocp/hold.h"

enum { nx = 2, nu = 4, holding = 2, holds = 3, intervals = 6 };
static const double hold_edge[] = {0, 0.25, 0.6, 1}, edge[] = {0, 0.1, 0.25, 0.6, 0.7, 0.9, 1};
static const bool held[] = {false, true, false, true};
static const int held_control[] = {1, 3};

static void move(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->u[0] + at->u[1];
    out->f[1] = at->u[2] * at->u[3];
    out->c[0] = at->x[0];
}

static void end(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].xf[1];
}

static moray_ocp *problem(const double *mesh, int parts, const bool *which)
{
    const moray_phase_spec phase = {.name = "drive",
                                    .nx = nx,
                                    .nu = nu,
                                    .nc = 1,
                                    .continuous = move,
                                    .tf = moray_fixed(2),
                                    .c = MORAY_BOUNDS(moray_at_most(1)),
                                    .held = which,
                                    .mesh = mesh,
                                    .intervals = parts};
    moray_ocp *ocp = NULL;
    CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.phases = 1, .phase = &phase, .endpoint = end}), "problem");
    return ocp;
}

static moray_status transcribe(struct transcription **t, const moray_ocp *ocp, moray_family family, const double *edges,
                               int n)
{
    struct mesh mesh;
    *t = NULL;
    CHECK_OK(moray_mesh_of(&mesh, edges, n, (struct method){family, 2}), "mesh");
    mesh.stages[n / 2] = 3;
    const moray_status status = moray_transcription_new(t, ocp, &mesh);
    moray_mesh_free(&mesh);
    return status;
}

// The collocated node before one in the same hold, or absent.
static int before(const struct phase_layout *layout, int node)
{
    int found = absent;
    for (int k = 0; k < holds; k++)
        for (int n = 0; n < node; n++)
            if (layout->node[n].collocated && layout->node[n].tau > hold_edge[k] &&
                layout->node[n].tau < hold_edge[k + 1] + 1e-12 && layout->node[node].tau > hold_edge[k] &&
                layout->node[node].tau < hold_edge[k + 1] + 1e-12)
                found = n;
    return layout->node[node].collocated ? found : absent;
}

static int column(const struct phase_layout *layout, int node, int i)
{
    return layout->node[node].x + nx + held_control[i];
}

static double entry(const moray_nlp *nlp, const double *values, int row, int col)
{
    for (int k = 0; k < nlp->nnz_jac; k++)
        if (nlp->jac_row[k] == row && nlp->jac_col[k] == col)
            return values[k];
    return 0;
}

static void test_rows(struct transcription *t)
{
    const struct phase_layout *layout = &t->layout.phase[0];
    const moray_nlp *nlp = &t->nlp;
    double *x = calloc((size_t)nlp->n, sizeof *x), *g = calloc((size_t)nlp->m, sizeof *g),
           *jac = calloc((size_t)nlp->nnz_jac, sizeof *jac), *lambda = calloc((size_t)nlp->m, sizeof *lambda),
           *gradient = calloc((size_t)nlp->n, sizeof *gradient), *expected = calloc((size_t)nlp->n, sizeof *expected);
    for (int j = 0; j < nlp->n; j++)
        x[j] = 1 / (3. + j), gradient[j] = expected[j] = j;
    for (int i = 0; i < nlp->m; i++)
        lambda[i] = 1 + i * i;
    CHECK(nlp->constraints(nlp->self, x, true, g) && nlp->jacobian(nlp->self, x, false, jac), "values");
    int row = layout->hold_row, linked = 0;
    for (int n = 0; n < layout->nodes; n++) {
        const int b = before(layout, n);
        CHECK(layout->node[n].before == b, "node %d has the controls of node %d, not of %d", n, layout->node[n].before,
              b);
        for (int i = 0; i < holding && b != absent; i++, row++, linked++) {
            const int here = column(layout, n, i), there = column(layout, b, i);
            CHECK(g[row] == x[here] - x[there], "row %d says that both are the same", row);
            CHECK(entry(nlp, jac, row, here) == 1 && entry(nlp, jac, row, there) == -1, "and so do its slopes");
            expected[here] += lambda[row], expected[there] -= lambda[row];
        }
    }
    int entries = 0;
    for (int k = 0; k < nlp->nnz_jac; k++)
        entries += nlp->jac_row[k] >= layout->hold_row && nlp->jac_row[k] < row;
    CHECK(linked > 0 && row == t->layout.events && entries == 2 * linked, "%d rows of two entries: %d", linked,
          entries);
    moray_add_holds(t, 0, lambda, gradient);
    for (int j = 0; j < nlp->n; j++)
        CHECK(fabs(gradient[j] - expected[j]) < 1e-9, "gradient %d: %g, expected %g", j, gradient[j], expected[j]);
    free(x), free(g), free(jac), free(lambda), free(gradient), free(expected);
}

static void test_filled(const struct transcription *t)
{
    const struct phase_layout *layout = &t->layout.phase[0];
    const double control[] = {10, 20, 30, 40};
    double *rows = calloc((size_t)t->nlp.m, sizeof *rows), *x = calloc((size_t)t->nlp.n, sizeof *x);
    for (int j = 0; j < t->nlp.n; j++)
        x[j] = j;
    moray_fill_holds(layout, &t->ocp->phase[0], control, rows);
    for (int i = 0; i < t->nlp.m; i++)
        CHECK(rows[i] == (i < layout->hold_row ? 0 : (i - layout->hold_row) % 2 ? 40 : 20), "row %d: %g", i, rows[i]);
    moray_guess_holds(t, 0, x);
    for (int n = 0; n < layout->nodes; n++) {
        int first = n;
        while (before(layout, first) != absent)
            first = before(layout, first);
        for (int r = 0; r < nx + (layout->node[n].collocated ? nu : 0); r++) {
            const bool of_first = r == nx + 1 || r == nx + 3;
            CHECK(x[layout->node[n].x + r] == layout->node[of_first ? first : n].x + r, "entry %d of node %d", r, n);
        }
    }
    free(rows), free(x);
}

static void test_scheme(const moray_ocp *ocp, moray_family family)
{
    struct transcription *t;
    CHECK_OK(transcribe(&t, ocp, family, edge, intervals), "transcribed");
    test_rows(t);
    test_filled(t);
    moray_transcription_free(t);
}

// ---- Where holds begin and end ----

static void test_edges(const struct phase *uneven)
{
    static const struct {
        double tau;
        bool holds;
    } at[] = {{0, true},
              {1e-9, true},
              {1.1e-9, false},
              {0.25 - 5e-10, true},
              {0.25 + 5e-10, true},
              {0.25 - 2e-9, false},
              {0.25 + 2e-9, false},
              {0.6, true},
              {0.5, false},
              {1, true},
              {0.99, false},
              {0.3, false}};
    moray_ocp *even = problem(NULL, 4, held), *none = problem(hold_edge, holds, NULL);
    for (size_t k = 0; k < sizeof at / sizeof *at; k++) {
        CHECK(moray_holds_at(uneven, at[k].tau) == at[k].holds, "at %.12g", at[k].tau);
        CHECK(!moray_holds_at(&none->phase[0], at[k].tau), "nothing is held");
    }
    for (int k = 0; k <= 8; k++)
        CHECK(moray_holds_at(&even->phase[0], k / 8.) == (k % 2 == 0), "of equal parts at %d/8", k);
    for (int control = 0; control <= nu; control++) {
        CHECK(moray_is_held(uneven, control) == (control == 1 || control == 3), "control %d", control);
        CHECK(!moray_is_held(&none->phase[0], control), "control %d of none", control);
    }
    moray_ocp_free(even);
    moray_ocp_free(none);
}

static void check_mesh(const moray_ocp *ocp, moray_family family, const double *edges, int n, const char *text)
{
    struct transcription *t;
    const moray_status status = transcribe(&t, ocp, family, edges, n);
    CHECK(status.code == (text ? MORAY_INPUT : MORAY_OK) && (!text || strcmp(status.text, text) == 0), "%s",
          status.text);
    moray_transcription_free(t);
}

static void test_meshes(const moray_ocp *ocp)
{
    check_mesh(ocp, MORAY_RADAU, (double[]){0, 0.25 + 5e-10, 0.6 - 5e-10, 1}, 3, NULL);
    check_mesh(ocp, MORAY_GAUSS, (double[]){0, 0.25, 0.6, 1}, 3, NULL);
    check_mesh(ocp, MORAY_RADAU, (double[]){0, 0.1, 0.25 + 2e-9, 0.6, 1}, 4,
               "phase drive holds controls until 0.25 of its length, where the mesh has no edge");
    check_mesh(ocp, MORAY_GAUSS, (double[]){0, 0.25, 0.5, 0.8, 1}, 4,
               "phase drive holds controls until 0.6 of its length, where the mesh has no edge");
    check_mesh(ocp, MORAY_LOBATTO, (double[]){0, 0.25, 0.6, 1}, 3,
               "phase drive holds controls, which jump, and this scheme has one control on both sides of an edge: the "
               "scheme must be radau<s> or gauss<s>");
}

int main(void)
{
    moray_ocp *ocp = problem(hold_edge, holds, held);
    test_scheme(ocp, MORAY_RADAU);
    test_scheme(ocp, MORAY_GAUSS);
    test_edges(&ocp->phase[0]);
    test_meshes(ocp);
    moray_ocp_free(ocp);
    return tap_done();
}
