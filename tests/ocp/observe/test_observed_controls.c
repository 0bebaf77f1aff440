// SPDX-License-Identifier: MIT
//
// Where controls may be observed: at times that have one, which gauss has between edges alone, and radau behind them.
#include "observe.h"

static void see_state_and_parameter(const moray_node *at, moray_num *y, const void *data)
{
    (void)data;
    y[0] = at->x[1] + at->s[0];
}

static void see_first(const moray_node *at, moray_num *y, const void *data)
{
    (void)data;
    y[0] = at->u[0];
}

static void see_second(const moray_node *at, moray_num *y, const void *data)
{
    (void)data;
    y[0] = at->u[1];
}

static void drive(const moray_node *at, moray_rates *out, const void *data)
{
    (void)data;
    out->f[0] = at->u[0];
    out->f[1] = at->u[1];
}

static void test_one(moray_observe_fn *function, moray_family family, const char *told)
{
    static const double time[] = {1, 0.5, 0}, value[] = {1, 2, 3};
    const moray_phase_spec phase = {.name = "drive",
                                    .nx = 2,
                                    .nu = 2,
                                    .continuous = drive,
                                    .tf = moray_fixed(1),
                                    .observed = {.n = 3, .ny = 1, .time = time, .value = value, .observe = function}};
    struct transcription *t = NULL;
    struct mesh mesh;
    moray_ocp *ocp;
    CHECK_OK(moray_ocp_new(&ocp, &(moray_ocp_spec){.phases = 1, .phase = &phase, .ns = 1, .endpoint = nothing}),
             "a drive");
    CHECK_OK(moray_mesh_uniform(&mesh, 2, (struct method){family, 2}), "mesh");
    const moray_status status = moray_transcription_new(&t, ocp, &mesh);
    CHECK(told ? status.code == MORAY_INPUT && strcmp(status.text, told) == 0 : !moray_failed(status), "told: %s",
          status.text);
    moray_transcription_free(t);
    moray_mesh_free(&mesh);
    moray_ocp_free(ocp);
}

int main(void)
{
    const char *const says =
        "observations of phase drive depend on its controls, which the scheme does not have at t = ";
    char at_end[200], at_start[200];
    snprintf(at_end, sizeof at_end, "%s1: choose a lobatto scheme", says);
    snprintf(at_start, sizeof at_start, "%s0: choose a lobatto scheme", says);
    const moray_family families[] = {MORAY_LOBATTO, MORAY_RADAU, MORAY_GAUSS};
    for (int k = 0; k < 3; k++) {
        test_one(see_state_and_parameter, families[k], NULL);
        test_one(see_first, families[k], k == 0 ? NULL : k == 1 ? at_start : at_end);
        test_one(see_second, families[k], k == 0 ? NULL : k == 1 ? at_start : at_end);
    }
    return tap_done();
}
