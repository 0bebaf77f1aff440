// SPDX-License-Identifier: MIT
#include "moray/app/run.h"

#include <math.h>

void moray_solver_to_json(moray_json *json, const moray_solution *solution)
{
    const moray_nlp_info *info = moray_solution_info(solution);
    const moray_nlp_size size = moray_solution_size(solution);
    moray_json_open(json, "solver");
    moray_json_text(json, "status", moray_nlp_outcome_text(info->outcome));
    moray_json_members(json,
                       MORAY_MEMBERS({"iterations", info->iterations},
                                     {"objective", moray_solution_objective(solution)}, {"nvar", size.variables},
                                     {"ncon", size.constraints}, {"nnz_jac", size.nnz_jac}, {"nnz_hess", size.nnz_hess},
                                     {"time_s", info->seconds}, {"eval_time_s", info->evaluation_seconds}));
    moray_json_text(json, "linear_solver", moray_linear_solver_text(info->linear_solver));
    moray_json_text(json, "linear_fallback", moray_failed(info->linear_fallback) ? info->linear_fallback.text : NULL);
}

void moray_certificate_to_json(moray_json *json, const moray_certificate *certificate)
{
    static const moray_certificate none = {false, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, ""};
    const moray_certificate *c = certificate ? certificate : &none;
    moray_json_open(json, "certificate");
    moray_json_bool(json, "pass", c->pass);
    moray_json_members(
        json, MORAY_MEMBERS({"kkt", c->kkt}, {"mesh_error", c->mesh_error}, {"between_nodes", c->between_nodes},
                            {"resimulation", c->resimulation}, {"derivatives", c->derivatives},
                            {"directions", c->directions}, {"hamiltonian", c->hamiltonian}, {"gap", c->gap},
                            {"curvature", c->curvature}, {"composed", c->composed}, {"untold", c->untold},
                            {"unseen", c->unseen}, {"mesh_limit", c->mesh_limit}));
    moray_json_text(json, "why", c->why);
    moray_json_close(json);
}

void moray_solver_line(const moray_solution *solution, const char *scheme, int intervals, char *text, size_t size)
{
    const moray_nlp_info *info = moray_solution_info(solution);
    const moray_nlp_size n = moray_solution_size(solution);
    snprintf(text, size, "%s, %d intervals: %s in %d iterations, %.2f s (%d variables, %d constraints)%s%s", scheme,
             intervals, moray_nlp_outcome_text(info->outcome), info->iterations, info->seconds, n.variables,
             n.constraints, moray_failed(info->linear_fallback) ? "; with MUMPS, since " : "",
             info->linear_fallback.text);
}

void moray_certificate_line(const moray_certificate *c, char *text, size_t size)
{
    snprintf(text, size,
             "Certificate: %s (KKT %.1e, mesh error %.1e, its limit %.0e, between nodes %.1e, re-simulation %.1e, "
             "derivatives %.1e)",
             c->pass ? "pass" : "FAIL", c->kkt, c->mesh_error, c->mesh_limit, c->between_nodes, c->resimulation,
             c->derivatives);
}
