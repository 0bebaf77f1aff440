// SPDX-License-Identifier: MIT
#include "benchmark.h"

static moray_status solve(void *self, moray_linear_solver linear, bool timed, moray_solution **solution)
{
    classic_case *c = self;
    moray_settings settings = classic_settings(c->classic);
    settings.max_refinements = 0;
    settings.timing = timed;
    settings.linear_solver = linear;
    return classic_first_solution(c->classic, &settings, &c->ocp, solution);
}

static void forget(void *self)
{
    classic_case *c = self;
    moray_ocp_free(c->ocp);
    c->ocp = NULL;
}

subject classic_subject(classic_case *c)
{
    return (subject){NULL, solve, forget, NULL, c};
}
