// SPDX-License-Identifier: MIT
//
// Where things stand among columns and rows, and nodes in time: two phases of unlike sizes in every scheme, counted
// here once more.
#include "tap.h"

#include <string.h>

#include "moray/ocp.h"
#include "ocp/layout.h"

enum { phases = 2, intervals = 3 };
static const int nx[phases] = {2, 3}, nu[phases] = {3, 1}, nc[phases] = {1, 2}, nq[phases] = {2, 1};
static const double edges[intervals + 1] = {0, 0.3, 0.7, 1};
static const int stages[phases][intervals] = {{3, 2, 4}, {2, 5, 3}};

static void zero(const moray_node *at, moray_rates *out, const void *data)
{
    (void)at, (void)out, (void)data;
}

static void nothing(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[0].xf[0];
}

// Times and lengths of the first phase; the second's are fixed.
struct times {
    moray_bounds t0, tf, duration;
    bool length; // whether there is a row for it
};

static moray_ocp *make(const struct times *times, bool end_controls)
{
    const moray_bounds any[3] = {moray_free(), moray_free(), moray_free()};
    moray_phase_spec phase[phases];
    for (int p = 0; p < phases; p++)
        phase[p] = (moray_phase_spec){.nx = nx[p],
                                      .nu = nu[p],
                                      .nc = nc[p],
                                      .nq = nq[p],
                                      .continuous = zero,
                                      .t0 = p ? moray_fixed(2) : times->t0,
                                      .tf = p ? moray_fixed(5) : times->tf,
                                      .duration = p ? (moray_bounds){0, 0} : times->duration,
                                      .c = {any, nc[p]},
                                      .end_controls = end_controls};
    moray_ocp *ocp;
    CHECK_OK(moray_ocp_new(&ocp,
                           &(moray_ocp_spec){
                               .phases = phases, .phase = phase, .ns = 2, .ne = 3, .e = {any, 3}, .endpoint = nothing}),
             "a problem");
    return ocp;
}

static moray_status lay(struct layout *layout, const moray_ocp *ocp, moray_family family, int extra)
{
    struct mesh mesh[phases];
    for (int p = 0; p < phases; p++) {
        CHECK_OK(moray_mesh_of(&mesh[p], edges, intervals, (struct method){family, 2}), "mesh");
        for (int k = 0; k < intervals; k++)
            mesh[p].stages[k] = stages[p][k] + (p == 1 && k == 2 ? extra : 0);
    }
    const moray_status status = moray_layout_new(layout, ocp, mesh);
    for (int p = 0; p < phases; p++)
        moray_mesh_free(&mesh[p]);
    return status;
}

// ---- Columns and rows ----

struct count {
    int columns, rows;
};

static int points(moray_family family, int p, int k)
{
    return stages[p][k] + (family == MORAY_LOBATTO ? 0 : family == MORAY_RADAU ? 1 : 2);
}

// A node is collocated but for the start of the phase with Radau, and for the ends of intervals with Gauss.
static bool is_collocated(moray_family family, int p, int n)
{
    int first = 0;
    for (int k = 0; k < intervals; first += points(family, p, k++) - 1)
        if (n == first)
            return family == MORAY_LOBATTO || (family == MORAY_RADAU && n > 0);
    return family != MORAY_GAUSS || n != first;
}

static void check_nodes(const struct phase_layout *phase, moray_family family, int p, struct count *next)
{
    int nodes = 1;
    for (int k = 0; k < intervals; k++)
        nodes += points(family, p, k) - 1;
    CHECK(phase->nodes == nodes, "%d nodes", phase->nodes);
    for (int n = 0; n < nodes; n++) {
        const struct node *node = &phase->node[n];
        const bool collocated = is_collocated(family, p, n);
        CHECK(node->collocated == collocated && node->x == next->columns && node->path == next->rows &&
                  node->before == absent,
              "node %d", n);
        next->columns += nx[p] + (collocated ? nu[p] : 0);
        next->rows += collocated ? nc[p] : 0;
    }
    for (int k = 0, first = 0; k < intervals; first += points(family, p, k++) - 1) {
        CHECK(phase->interval[k].first == first && phase->interval[k].defect == next->rows, "interval %d", k);
        next->rows += nx[p] * (points(family, p, k) - 1);
    }
}

static void check_ends(const struct phase_layout *phase, moray_family family, int p, bool end_controls,
                       struct count *next)
{
    for (int end = 0; end < 2; end++) {
        const bool of_node = family == MORAY_LOBATTO || (family == MORAY_RADAU && end), own = !of_node && end_controls;
        const struct node *node = &phase->node[end ? phase->nodes - 1 : 0];
        CHECK(phase->u_end[end] == (of_node ? node->x + nx[p]
                                    : own   ? next->columns
                                            : absent) &&
                  phase->u_row[end] == (own ? next->rows : absent),
              "controls at end %d", end);
        next->columns += own ? nu[p] : 0;
        next->rows += own ? nu[p] : 0;
    }
    CHECK(phase->hold_row == next->rows && phase->node[phase->nodes - 1].hold == next->rows, "no holds");
}

static bool is_fixed(moray_bounds bounds)
{
    return bounds.lower == bounds.upper;
}

static void check_places(const struct layout *layout, moray_family family, const struct times *times, bool end_controls)
{
    struct count next = {0, 0};
    for (int p = 0; p < phases; p++) {
        const struct phase_layout *phase = &layout->phase[p];
        check_nodes(phase, family, p, &next);
        CHECK(phase->q == next.columns && phase->integral_row == next.rows, "integrals");
        next.columns += nq[p];
        next.rows += nq[p];
        check_ends(phase, family, p, end_controls, &next);
        CHECK(phase->t0 == (p || is_fixed(times->t0) ? absent : next.columns++), "a free start");
        CHECK(phase->tf == (p || is_fixed(times->tf) ? absent : next.columns++), "a free end");
        CHECK(phase->length_row == (!p && times->length ? next.rows++ : absent), "a length");
    }
    CHECK(layout->s == next.columns && layout->columns == next.columns + 2, "parameters stand last");
    CHECK(layout->events == next.rows && layout->rows == next.rows + 3, "events stand last");
}

// ---- Time ----

static void check_time(const struct layout *layout)
{
    for (int p = 0; p < phases; p++) {
        const struct phase_layout *phase = &layout->phase[p];
        double sum = 0, moment = 0;
        for (int n = 0; n < phase->nodes; n++) {
            sum += phase->node[n].weight;
            moment += phase->node[n].weight * phase->node[n].tau * phase->node[n].tau;
        }
        CHECK_NEAR(sum, 1, 1e-14, "weights of a phase");
        CHECK_NEAR(moment, 1. / 3, phase->mesh.method.family == MORAY_LOBATTO ? 0.02 : 1e-14, "their second moment");
        for (int k = 0; k < intervals; k++) {
            const struct interval *interval = &phase->interval[k];
            const struct node *node = &phase->node[interval->first];
            CHECK(node->tau == edges[k] && node[interval->scheme->points - 1].tau == edges[k + 1],
                  "an interval from edge to edge, exactly");
            CHECK(interval->scheme->stages == stages[p][k] && interval->width == edges[k + 1] - edges[k],
                  "in its scheme");
            for (int j = 1; j < interval->scheme->points; j++)
                CHECK_NEAR(node[j].tau, edges[k] + (edges[k + 1] - edges[k]) * interval->scheme->node[j], 1e-15,
                           "a node");
        }
    }
}

// Controls that are straight in time come to their values at the ends.
static void check_polynomials_at_ends(const struct layout *layout)
{
    for (int p = 0; p < phases; p++)
        for (int end = 0; end < 2; end++) {
            const struct phase_layout *phase = &layout->phase[p];
            double ell[MORAY_MAX_STAGES + 2], sum = 0;
            const struct interval *interval = moray_layout_end(phase, end, ell);
            CHECK(interval == &phase->interval[end ? intervals - 1 : 0], "the interval at end %d", end);
            for (int j = 0; j < interval->scheme->points; j++)
                sum += ell[j] * (3 - 2 * phase->node[interval->first + j].tau);
            CHECK_NEAR(sum, end ? 1 : 3, 1e-13, "a control there");
        }
}

static void check_span(const struct layout *layout, const moray_ocp *ocp, const struct times *times)
{
    double x[200] = {0}, t0, tf;
    const struct phase_layout *phase = &layout->phase[0];
    if (phase->t0 != absent)
        x[phase->t0] = -0.25;
    if (phase->tf != absent)
        x[phase->tf] = 1.75;
    const double begin = is_fixed(times->t0) ? times->t0.lower : -0.25,
                 end = is_fixed(times->tf) ? times->tf.lower : 1.75;
    moray_layout_span(layout, ocp, x, 0, &t0, &tf);
    CHECK(t0 == begin && tf == end, "from %g to %g", t0, tf);
    CHECK_NEAR(moray_layout_time(layout, ocp, x, 0, 0.125), begin + 0.125 * (end - begin), 1e-15, "a time between");
    moray_layout_span(layout, ocp, x, 1, &t0, &tf);
    CHECK(t0 == 2 && tf == 5 && moray_layout_time(layout, ocp, x, 1, 0.5) == 3.5, "fixed ones");
}

static void test_layout(const struct times *times)
{
    for (int family = MORAY_LOBATTO; family <= MORAY_GAUSS; family++)
        for (int end_controls = 0; end_controls < 2; end_controls++) {
            struct layout layout;
            moray_ocp *ocp = make(times, end_controls);
            CHECK_OK(lay(&layout, ocp, (moray_family)family, 0), "laid out");
            check_places(&layout, (moray_family)family, times, end_controls);
            check_time(&layout);
            check_polynomials_at_ends(&layout);
            check_span(&layout, ocp, times);
            moray_layout_free(&layout);
            CHECK(!layout.phase && layout.columns == 0 && !layout.scheme[family][2].node, "nothing is left");
            moray_ocp_free(ocp);
        }
}

static void test_stages(void)
{
    const struct times times = {{0, 0}, {1, 1}, {0, 0}, false};
    moray_ocp *ocp = make(&times, false);
    struct layout layout;
    const int extra[] = {-3, MORAY_MAX_STAGES - 2};
    static const char *const texts[] = {"stages = 0: must be 1 to 64", "stages = 65: must be 1 to 64"};
    for (int k = 0; k < 2; k++) {
        const moray_status status = lay(&layout, ocp, MORAY_RADAU, extra[k]);
        CHECK(status.code == MORAY_INPUT && strcmp(status.text, texts[k]) == 0 && !layout.phase, "%s", status.text);
    }
    for (int k = 0; k < 2; k++) {
        CHECK_OK(lay(&layout, ocp, MORAY_RADAU, k ? MORAY_MAX_STAGES - 3 : -2), "as few and as many as there may be");
        moray_layout_free(&layout);
    }
    moray_ocp_free(ocp);
}

int main(void)
{
    static const struct times times[] = {
        {{-1, 0}, {1, 2}, {0, 0}, false},     {{-1, 1}, {1, 2}, {0, 0}, false}, {{-1, 1.5}, {1, 2}, {0, 0}, true},
        {{-1, 0}, {1, 2}, {1.5, 2}, true},    {{0, 0}, {1, 2}, {0, 0}, false},  {{-1, 0}, {1, 1}, {0, 0}, false},
        {{-1, 3}, {1.5, 1.5}, {0, 0}, false}, {{0, 0}, {1, 1}, {0, 0}, false},
    };
    for (unsigned k = 0; k < sizeof times / sizeof *times; k++)
        test_layout(&times[k]);
    test_stages();
    return tap_done();
}
