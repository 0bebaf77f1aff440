// SPDX-License-Identifier: MIT
//
// How large a kink is to be beside slopes, bends and jumps, at an iterate set by hand; and its words.
#include "tap.h"

#include <string.h>

#include "moray/ocp.h"

#include "ocp/diagnosis/diagnosis.h"

enum shape { corner, waves, ramp, jump, rounded, smooth, steepening, flattening };
static const double low = -3, high = 5, piece = 0.5; // of the range that is looked at, a sixteenth

// A function of one input, from one node of the phase on.
struct bent {
    enum shape shape;
    double size, at;
    int of, in;   // output, input
    double after; // time
};

// Bent all along, by 4 from piece to piece, and by size in the middle: down by 100 and half of that in the last.
static double steepen(double past, double size)
{
    const double last = past - (high - low) / 2 + piece / 2;
    return -100 * past - 4 / piece * last * last / 2 - size * fabs(past) / 2;
}

static double bend(const struct bent *bent, double z)
{
    const double past = z - bent->at;
    switch (bent->shape) {
    case corner: // between slopes of 100 and more
        return 100 * past + (past > 0 ? bent->size * past : 0);
    case waves: // at the foot of one, whose bend adds to that of the corner
        return fabs(past) * bent->size / 2 - cos(past / piece);
    case ramp:
        return fmin(fmax(past, 0), bent->size);
    case jump:
        return past > 0 ? bent->size : 0;
    case rounded:
        return hypot(past, bent->size);
    case steepening:
        return steepen(past, bent->size);
    case flattening:
        return -steepen(-past, bent->size);
    default:
        return exp(past);
    }
}

static void rates(const moray_node *at, moray_rates *out, const void *data)
{
    const struct bent *bent = data;
    const double in[] = {creal(at->x[0]), creal(at->x[1]), creal(at->u[0]), creal(at->u[1])};
    const double value = creal(at->t) >= bent->after ? bend(bent, in[bent->in]) : 0;
    out->f[0] = bent->of == 0 ? value : 0;
    out->f[1] = bent->of == 1 ? value : 7;
    out->c[0] = bent->of == 2 ? value : 0;
    out->g[0] = bent->of == 3 ? value : at->x[0];
}

static void still(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = 0 * at->x[0];
}

static void total(const moray_ends *at, moray_end_values *out, const void *data)
{
    (void)data;
    out->objective = at->phase[1].q[0];
}

static void set_iterate(moray_solution *solution, int moving)
{
    const struct transcription *t = solution->transcription;
    const struct phase_layout *layout = &t->layout.phase[1];
    for (int n = 0; n < layout->nodes; n++)
        for (int i = 0; i < 4 && (i < 2 || layout->node[n].collocated); i++)
            solution->iterate.x[layout->node[n].x + i] = i == moving ? low + (high - low) * layout->node[n].tau : 0.2;
    CHECK(moray_transcription_jacobians(solution->transcription, solution->iterate.x), "finite");
    solution->diagnosis[0] = 0;
}

static bool find(const struct bent *bent, char said[diagnosis_size])
{
    const moray_bounds none = moray_free();
    const moray_phase_spec phases[] = {{.name = "before", .nx = 1, .continuous = still, .tf = moray_fixed(1)},
                                       {.name = "bent",
                                        .nx = 2,
                                        .nu = 2,
                                        .nc = 1,
                                        .nq = 1,
                                        .continuous = rates,
                                        .t0 = moray_fixed(1),
                                        .tf = moray_fixed(2),
                                        .c = MORAY_BOUNDS(none)}};
    moray_settings settings = moray_settings_default();
    moray_ocp *ocp = NULL;
    moray_solution *solution = NULL;
    settings.max_iterations = 0;
    settings.intervals = 6;
    CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.phases = 2, .phase = phases, .endpoint = total, .data = bent}),
             "two phases");
    CHECK_OK(moray_solve(ocp, &settings, NULL, &solution), "begun");
    set_iterate(solution, bent->in);
    const bool found = moray_has_kink(&(struct evidence){.solution = solution, .t = solution->transcription});
    memcpy(said, solution->diagnosis, sizeof solution->diagnosis);
    moray_solution_free(solution);
    moray_ocp_free(ocp);
    return found;
}

static void check(const struct bent *bent, bool kink, const char *what)
{
    static const char *const outputs[] = {"dynamics of state x[0]", "dynamics of state x[1]", "path constraint c[0]",
                                          "integrand g[0]"};
    static const char *const inputs[] = {"state x[0]", "state x[1]", "control u[0]", "control u[1]"};
    char said[diagnosis_size], told[400] = "";
    const bool found = find(bent, said);
    CHECK(found == kink, "%s of %g is%s a kink: %s", what, bent->size, kink ? "" : " not", said);
    if (kink)
        snprintf(told, sizeof told,
                 "Try: a smooth form of the %s of phase bent, which has a kink in %s at %.2g (|u|: of two controls of "
                 "one sign each).\n",
                 outputs[bent->of], inputs[bent->in], bent->at);
    CHECK(!strcmp(said, told), "%s expected %s", said, told);
}

// At the joint of two pieces, where the change is all of it.
static void test_sizes(void)
{
    for (int sign = -1; sign <= 1; sign += 2) {
        // A twentieth of the steepest slope, which is 100 or more.
        check(&(struct bent){corner, 4.8 * sign, 1, 2, 3, 0}, false, "a corner");
        check(&(struct bent){corner, 5.5 * sign, 1, 2, 3, 0}, true, "a corner");
    }
    check(&(struct bent){corner, -5, 1, 2, 3, 0}, false, "a corner"); // in binary numbers: a twentieth exactly
    for (int shape = steepening; shape <= flattening; shape++) {      // a twentieth of the steepest piece, at an end
        check(&(struct bent){shape, 5, 1, 3, 2, 0}, false, "a corner");
        check(&(struct bent){shape, 5.3, 1, 3, 2, 0}, true, "a corner");
    }
    check(&(struct bent){ramp, piece / 10, 1, 3, 0, 0}, false, "a ramp");
    // Between pieces of 1/2 waves bend by (2 - 2 cos(1)) 2, a corner by all that it is: a fifth of both is the least.
    const double most = (2 - 2 * cos(1)) * 2;
    check(&(struct bent){waves, 0.24 * most, 1, 1, 2, 0}, false, "a corner in waves");
    check(&(struct bent){waves, 0.26 * most, 1, 1, 2, 0}, true, "a corner in waves");
    // A ramp shorter than a tenth of a piece is a jump, a longer one has corners.
    check(&(struct bent){ramp, piece / 12, 1, 3, 0, 0}, false, "a ramp");
    check(&(struct bent){ramp, piece / 8, 1, 3, 0, 0}, true, "a ramp");
    check(&(struct bent){jump, 1, 1, 3, 0, 0}, false, "a jump");
    check(&(struct bent){rounded, 1e-5 * (high - low), 1, 3, 0, 0}, true, "a corner that is hardly round");
    check(&(struct bent){rounded, 1e-4 * (high - low), 1, 3, 0, 0}, false, "a round one");
    check(&(struct bent){smooth, 1, 1, 3, 0, 0}, false, "an exponential");
}

static void test_places(void)
{
    for (int of = 0; of < 4; of++)
        for (int in = 0; in < 4; in++)
            for (int late = 0; late < 2; late++)
                check(&(struct bent){corner, -150, late ? 3.1 : -1.37, of, in, late ? 1.7 : 0}, true, "a corner");
    check(&(struct bent){corner, -150, high + 1, 0, 1, 0}, false, "a corner beyond where the input is");
    check(&(struct bent){corner, -150, low - 1, 0, 1, 0}, false, "one below");
    check(&(struct bent){corner, -150, 1, 0, 1, 1.99}, false, "one behind all nodes that are looked at");
}

int main(void)
{
    test_sizes();
    test_places();
    return tap_done();
}
