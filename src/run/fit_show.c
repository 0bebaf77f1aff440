// SPDX-License-Identifier: MIT
//
// What a run shows of a fit: parameters with their intervals, and what the data leave open.
#include <math.h>
#include <string.h>

#include "run/fit.h"

bool moray_run_observes(const moray_ocp_spec *spec)
{
    for (int p = 0; p < spec->phases; p++)
        if (spec->phase[p].observed.n > 0)
            return true;
    return false;
}

// Whether observations are in the objective, so that parameters are fitted to them.
static bool fits(const moray_ocp_spec *spec)
{
    for (int p = 0; p < spec->phases; p++)
        if (spec->phase[p].observed.n > 0 && !spec->phase[p].observed.events_only)
            return true;
    return false;
}

moray_status moray_run_fit(app_run *run)
{
    const moray_nlp_outcome outcome = moray_solution_info(run->solution)->outcome;
    if (!fits(run->app->spec) || (outcome != MORAY_NLP_SOLVED && outcome != MORAY_NLP_ACCEPTABLE))
        return moray_ok();
    moray_status status = moray_fit_new(&run->fit, run->solution, run->app->known_variance);
    run->fitted = !moray_failed(status);
    if (status.code != MORAY_NUMERIC) // a matrix that cannot be factored costs the intervals, not the solution
        return status;
    fprintf(stderr, "%s: no intervals of the parameters: %s\n", run->name, status.text);
    return moray_ok();
}

// ---- Tables --------------------------------------------------------------------------------------------------------

static moray_table sum_table(const app_run *run, moray_table_row *rows)
{
    const moray_fit *fit = &run->fit;
    const moray_table_row filled[] = {
        {.label = "observations", .value = {fit->observations}},
        {.label = "free directions", .value = {fit->freedom}},
        {.label = "weighted sum of squares", .value = {fit->sum}},
        {.label = run->app->known_variance ? "variance of an observation of weight 1, known"
                                           : "variance of an observation of weight 1",
         .value = {fit->variance}},
        {.label = "not determined by the data", .text = fit->undetermined > 0 ? fit->names : "none"}};
    _Static_assert(sizeof filled / sizeof *filled == MORAY_FIT_ROWS, "room for them");
    memcpy(rows, filled, sizeof filled);
    return (moray_table){.title = "Fit", .n_columns = 1, .rows = rows, .n_rows = MORAY_FIT_ROWS};
}

// What is not determined has neither error nor interval.
static double or_blank(double value, double error)
{
    return isfinite(error) ? value : NAN;
}

int moray_run_fit_tables(const app_run *run, moray_table *table, moray_table_row *rows, struct run_text *texts)
{
    const moray_fit *fit = &run->fit;
    const char *const *units = run->app->s_units;
    table[0] = sum_table(run, rows);
    rows += table[0].n_rows;
    for (int i = 0; i < fit->ns; i++)
        rows[i] =
            (moray_table_row){.label = moray_entry_name(run->app->spec->s_names, "s", i, texts[i].label),
                              .value = {fit->value[i], or_blank(fit->error[i], fit->error[i]),
                                        or_blank(fit->lower[i], fit->error[i]), or_blank(fit->upper[i], fit->error[i])},
                              .unit = units ? units[i] : NULL};
    table[1] = (moray_table){.title = "Parameters, with intervals of 95 %",
                             .columns = {"value", "standard error", "from", "to"},
                             .n_columns = 4,
                             .rows = rows,
                             .n_rows = fit->ns};
    return fit->ns > 0 ? 2 : 1;
}

// ---- JSON ----------------------------------------------------------------------------------------------------------

void moray_run_fit_to_json(moray_json *json, const app_run *run)
{
    const moray_fit *fit = &run->fit;
    if (!moray_run_observes(run->app->spec))
        return;
    if (!run->fitted) {
        moray_json_text(json, "fit", NULL);
        return;
    }
    moray_json_open(json, "fit");
    moray_json_members(json, MORAY_MEMBERS({"observations", fit->observations}, {"free_directions", fit->freedom},
                                           {"sum_of_squares", fit->sum}, {"variance", fit->variance}));
    moray_json_bool(json, "variance_known", run->app->known_variance);
    moray_json_open(json, "parameters");
    for (int i = 0; i < fit->ns; i++) {
        char name[MORAY_ENTRY_SIZE];
        moray_json_object(json, moray_entry_name(run->app->spec->s_names, "s", i, name),
                          MORAY_MEMBERS({"value", fit->value[i]}, {"standard_error", fit->error[i]},
                                        {"lower", or_blank(fit->lower[i], fit->error[i])},
                                        {"upper", or_blank(fit->upper[i], fit->error[i])}));
    }
    moray_json_close(json);
    moray_json_open_list(json, "covariance");
    for (int i = 0; i < fit->ns; i++)
        moray_json_numbers(json, NULL, fit->covariance + i * fit->ns, fit->ns);
    moray_json_close(json);
    moray_json_open_list(json, "undetermined");
    for (int i = 0; i < fit->ns; i++) {
        char name[MORAY_ENTRY_SIZE];
        if (isinf(fit->error[i]))
            moray_json_text(json, NULL, moray_entry_name(run->app->spec->s_names, "s", i, name));
    }
    moray_json_close(json);
    moray_json_close(json);
}
