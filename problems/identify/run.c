// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "identify.h"

static const double same_cost = 1e-3; // of the best: another start came to the same

static moray_status read_logs(const identify *run, const char *list, moray_swim_log *log, int *n)
{
    const moray_swim_log_format format = {.joints = run->snake.robot.links - 1,
                                          .columns = run->columns,
                                          .units = run->units,
                                          .reference = run->reference,
                                          .torque_constant = run->torque_constant};
    char text[MORAY_PATH_SIZE], *rest = NULL;
    snprintf(text, sizeof text, "%s", list);
    for (char *path = strtok_r(text, ",", &rest); path; path = strtok_r(NULL, ",", &rest)) {
        if (*n == LOGS)
            return moray_error(MORAY_INPUT, "%.200s: at most %d logs", list, LOGS);
        MORAY_TRY(moray_swim_log_read(&log[(*n)++], path, &format));
    }
    return moray_ok();
}

static moray_status fit(identify *run)
{
    const moray_identify_spec spec = identify_spec(run);
    MORAY_TRY(moray_identify_new(&run->fitted, &spec, run->log, run->n_logs));
    moray_ticker_show(&run->ticker, "identify: %d unknowns of %d logs from %d starts", run->n, run->n_logs,
                      run->starts);
    MORAY_TRY(moray_identify_search(run->fitted, run->starts, run->jobs, run->at));
    if (!run->at[0].converged)
        return moray_error(MORAY_NOT_SOLVED, "no start converged within %d iterations", spec.max_iterations);
    for (int k = 0; k < run->starts; k++)
        run->best_starts += run->at[k].cost <= run->at[0].cost * (1 + same_cost);
    run->world = moray_identify_world(run->fitted, &run->at[0]);
    return moray_ok();
}

// Larger residuals than told: so are the errors, where outliers are not the cause.
static moray_status examine(identify *run)
{
    MORAY_TRY(moray_identify_information(run->fitted, &run->at[0], &run->info));
    MORAY_TRY(moray_identify_residuals(run->fitted, &run->at[0], &run->fit));
    run->inflation = 1;
    if (run->fit.chi2 > run->fit.limit && run->loss == LOSS_SQUARES)
        run->inflation = sqrt(run->fit.chi2 / run->fit.freedom);
    return moray_ok();
}

double identify_half_width(const identify *run, const moray_information *info, int k)
{
    return moray_student_95(0) * run->inflation * info->error[k];
}

bool identify_certified(const identify *run)
{
    return run->at[0].converged && !run->fit.simple;
}

static moray_status design(identify *run)
{
    const moray_design_spec spec = {.lower = {run->alpha[0], run->omega[0], run->delta[0], run->phi_0[0]},
                                    .upper = {run->alpha[1], run->omega[1], run->delta[1], run->phi_0[1]},
                                    .most_rate = run->rate,
                                    .duration = run->duration,
                                    .least = run->criterion == E_OPTIMAL,
                                    .evaluations = run->evaluations};
    moray_ticker_show(&run->ticker, "identify: the experiment to swim next, of %d gaits", run->evaluations);
    return moray_identify_design(run->fitted, &run->at[0], &run->info, &spec, &run->next, &run->after);
}

moray_status identify_run(identify *run)
{
    if (!run->logs[0])
        return moray_error(MORAY_INPUT, "logs: none given; --logs FILE,FILE with a log of swimming in each");
    MORAY_TRY(identify_choose(run));
    MORAY_TRY(read_logs(run, run->logs, run->log, &run->n_logs));
    MORAY_TRY(read_logs(run, run->validate, run->held, &run->n_held));
    MORAY_TRY(fit(run));
    MORAY_TRY(examine(run));
    for (int k = 0; k < run->n_held; k++)
        MORAY_TRY(identify_validate(run, k, &run->validation[k]));
    if (run->design)
        MORAY_TRY(design(run));
    return moray_ok();
}

void identify_release(identify *run)
{
    moray_identify_fit_free(&run->fit);
    moray_identify_free(run->fitted);
    for (int k = 0; k < run->n_logs; k++)
        moray_swim_log_free(&run->log[k]);
    for (int k = 0; k < run->n_held; k++)
        moray_swim_log_free(&run->held[k]);
}
