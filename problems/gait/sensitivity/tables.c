// SPDX-License-Identifier: MIT
#include <stdio.h>

#include "sensitivity.h"

// ---- Numbers -------------------------------------------------------------------------------------------------------

static const double rounding = 1e-7, steadiness = 1e-5;

// What is only noise is not shown.
static double shown(const sensitivity *run, const sensitivity_row *row, double slope, int quantity, double noise)
{
    return fabs(slope) * row->scale < noise * run->size[quantity] ? 0 : slope;
}

// Per cent of the quantity by per cent of the parameter.
static double elasticity(const sensitivity *run, const sensitivity_row *row, int quantity)
{
    return shown(run, row, row->slope[quantity], quantity, rounding) * row->scale / run->size[quantity];
}

double sensitivity_swum_share(const sensitivity *run, const sensitivity_row *row, int quantity)
{
    const moray_steady *swum = &last_stage(&run->job)->trial.steady[MORAY_FIRST_PRINCIPLES];
    const double speed = moray_course_speed(swum, run->job.snake.course);
    const double size = quantity == SLOPE_SPEED ? speed : swum->power, scale = row->current ? speed : row->scale;
    return shown(run, row, row->swum[quantity], quantity, steadiness) * scale / size;
}

int sensitivity_quantities(const sensitivity *run)
{
    const stage *at = last_stage(&run->job);
    return at->taper[0] < at->taper[1] ? SLOPES : SLOPES - 1;
}

// ---- Tables --------------------------------------------------------------------------------------------------------

// A new table of f, its title to be written.
static moray_table *open_table(sensitivity_findings *f, int columns)
{
    moray_table *table = &f->table[f->tables];
    *table = (moray_table){.title = f->title[f->tables], .n_columns = columns, .rows = f->row[f->tables]};
    f->tables++;
    return table;
}

// A new row of the last table, all blank.
static moray_table_row *add_row(sensitivity_findings *f, const char *label, const char *unit)
{
    const int t = f->tables - 1, i = f->table[t].n_rows++;
    moray_table_row *row = &f->row[t][i];
    snprintf(f->label[t][i], SENSITIVITY_LABEL, "%s", label);
    *row = (moray_table_row){.label = f->label[t][i], .unit = unit};
    for (int j = 0; j < MORAY_TABLE_COLUMNS; j++)
        row->value[j] = NAN;
    return row;
}

static void tell_optimum(const sensitivity *run, sensitivity_findings *f)
{
    const stage *at = last_stage(&run->job);
    const moray_steady *swum = &at->trial.steady[MORAY_FIRST_PRINCIPLES];
    double value[SLOPES];
    moray_table *table = open_table(f, 2);
    snprintf(f->title[f->tables - 1], sizeof *f->title, "The fastest gait on the %s model",
             moray_model_name(at->model));
    table->columns[0] = "predicted";
    table->columns[1] = "swum, first-pr.";
    sensitivity_values(&run->job, &at->prediction.gait, at->prediction.course_speed, at->prediction.power, value);
    for (int i = 0; i < sensitivity_quantities(run); i++) {
        moray_table_row *row = add_row(f, sensitivity_names[i], sensitivity_unit(&run->job, i));
        row->value[0] = fabs(value[i]) < 1e-9 * fabs(run->size[i]) ? 0 : value[i];
        if (i == SLOPE_SPEED && at->trial.held[MORAY_FIRST_PRINCIPLES])
            row->value[1] = moray_course_speed(swum, run->job.snake.course);
        if (i == SLOPE_POWER)
            row->value[1] = swum->power;
    }
}

static void tell_slopes(const sensitivity *run, sensitivity_findings *f)
{
    const int n = sensitivity_quantities(run);
    moray_table *table = open_table(f, n + 1);
    snprintf(f->title[f->tables - 1], sizeof *f->title,
             "Change of the optimum (m/s, W, deg, deg/s, deg, %s) per unit of each parameter",
             sensitivity_unit(&run->job, SLOPE_OFFSET));
    for (int i = 0; i < n; i++)
        table->columns[i] = sensitivity_names[i];
    table->columns[n] = "deviation";
    for (int k = 0; k < run->rows; k++) {
        const sensitivity_row *from = &run->row[k];
        char label[SENSITIVITY_LABEL];
        snprintf(label, sizeof label, "%s [%s]", from->name, from->unit);
        moray_table_row *slope = add_row(f, label, NULL), *again = add_row(f, "  solved again", NULL),
                        *swum = add_row(f, "  swum, first-principles", NULL);
        for (int i = 0; i < n; i++) {
            slope->value[i] = shown(run, from, from->slope[i], i, rounding);
            again->value[i] = shown(run, from, from->again[i], i, rounding);
        }
        for (int i = 0; i < 2; i++)
            swum->value[i] = shown(run, from, from->swum[i], i, steadiness);
        again->value[n] = from->deviation;
    }
}

static void tell_shares(const sensitivity *run, sensitivity_findings *f)
{
    static const int every[] = {SLOPE_SPEED, SLOPE_POWER, SLOPE_THETA_MAX, SLOPE_OMEGA, SLOPE_DELTA, SLOPE_TAPER};
    const int n = sensitivity_quantities(run) == SLOPES ? 6 : 5;
    moray_table *table = open_table(f, n + 2);
    snprintf(f->title[f->tables - 1], sizeof *f->title,
             "Per cent of change when a parameter grows by 1 %%, a current by 1 %% of the speed");
    for (int i = 0; i < n; i++)
        table->columns[i] = sensitivity_names[every[i]];
    table->columns[n] = "f.-p. speed";
    table->columns[n + 1] = "f.-p. power";
    for (int k = 0; k < run->rows; k++) {
        const sensitivity_row *from = &run->row[k];
        moray_table_row *row = add_row(f, from->name, NULL);
        for (int i = 0; i < n; i++)
            row->value[i] = elasticity(run, from, every[i]);
        for (int i = 0; i < 2; i++)
            row->value[n + i] = sensitivity_swum_share(run, from, i);
    }
}

static void tell_forecast(const sensitivity *run, sensitivity_findings *f)
{
    const sensitivity_forecast *forecast = &run->forecast;
    const char *const heads[SENSITIVITY_GAITS] = {"kept", "predicted", "solved again"};
    const int n = sensitivity_quantities(run);
    moray_table *table = open_table(f, SENSITIVITY_GAITS);
    snprintf(f->title[f->tables - 1], sizeof *f->title, "The gait for a current of (%g, %g) m/s", forecast->current[0],
             forecast->current[1]);
    for (int k = 0; k < SENSITIVITY_GAITS; k++)
        table->columns[k] = heads[k];
    for (int i = 0; i < n; i++)
        add_row(f, sensitivity_names[i], sensitivity_unit(&run->job, i));
    f->row[f->tables - 1][SLOPE_SPEED].label = "speed, predicted";
    f->row[f->tables - 1][SLOPE_POWER].label = "power, predicted";
    add_row(f, "speed swum, first-principles", "m/s");
    add_row(f, "power swum, first-principles", "W");
    moray_table_row *rows = f->row[f->tables - 1];
    for (int k = 0; k < SENSITIVITY_GAITS; k++) {
        const moray_gait_prediction *prediction = &forecast->prediction[k];
        const moray_steady *swum = &forecast->trial[k].steady[MORAY_FIRST_PRINCIPLES];
        double value[SLOPES];
        sensitivity_values(&run->job, &prediction->gait, prediction->course_speed, prediction->power, value);
        for (int i = 0; i < n; i++)
            rows[i].value[k] = fabs(value[i]) < 1e-9 * fabs(run->size[i]) ? 0 : value[i];
        if (!forecast->trial[k].held[MORAY_FIRST_PRINCIPLES])
            continue;
        rows[n].value[k] = moray_course_speed(swum, run->job.snake.course);
        rows[n + 1].value[k] = swum->power;
    }
}

void sensitivity_tables(const sensitivity *run, sensitivity_findings *found)
{
    tell_optimum(run, found);
    tell_slopes(run, found);
    tell_shares(run, found);
    if (run->forecast.asked && !run->forecast.why.code)
        tell_forecast(run, found);
}
