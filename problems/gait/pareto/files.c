// SPDX-License-Identifier: MIT
#include <stdlib.h>

#include "pareto.h"

void pareto_values(const pareto *run, const stage *at, double value[PARETO_VALUES])
{
    const moray_gait *gait = &at->prediction.gait;
    const moray_steady *swum = &at->trial.steady[MORAY_FIRST_PRINCIPLES];
    const bool held = at->trial.held[MORAY_FIRST_PRINCIPLES];
    value[PARETO_POWER] = at->prediction.power;
    value[PARETO_SPEED] = at->prediction.course_speed;
    value[PARETO_THETA_MAX] =
        moray_theta_max_from_amplitude(&run->job.snake.robot, at->model, gait->amplitude, gait->delta) / DEG;
    value[PARETO_OMEGA] = gait->omega / DEG;
    value[PARETO_DELTA] = gait->delta / DEG;
    value[PARETO_TAPER] = fabs(gait->taper) < 1e-6 ? 0 : gait->taper;
    value[PARETO_PRICE] = at->prediction.power_price;
    value[PARETO_TRUE_SPEED] = held ? moray_course_speed(swum, run->job.snake.course) : NAN;
    value[PARETO_TRUE_POWER] = swum->power;
}

// ---- Summary -------------------------------------------------------------------------------------------------------

static void json_point(moray_json *json, const pareto *run, const stage *at)
{
    moray_json_open(json, NULL);
    moray_json_number(json, "power_limit_W", at->power);
    moray_gait_to_json(json, "gait", &run->job.snake.robot, at->trial.gait);
    gait_job_json_prediction(json, &at->prediction);
    moray_json_number(json, "speed_per_power_m_s_W", at->prediction.power_price);
    moray_steady_to_json(json, "validated", &run->job.snake.robot, MORAY_FIRST_PRINCIPLES, &at->trial,
                         run->job.snake.course);
    gait_job_json_ladder(json, &run->job, at);
    moray_certificate_to_json(json, &at->certificate);
    moray_json_close(json);
}

void pareto_summary(const void *found, moray_json *json)
{
    const pareto *run = found;
    gait_job_json_head(json, &run->job);
    moray_json_open_list(json, "fronts");
    for (int f = 0; f < run->fronts; f++) {
        const pareto_front *front = &run->front[f];
        moray_json_open(json, NULL);
        moray_json_text(json, "model", moray_model_key(front->model));
        moray_json_text(json, "kind", pareto_kinds[front->kind]);
        if (front->n == 0)
            moray_json_text(json, "left_out", front->why.text);
        moray_json_open_list(json, "points");
        for (int k = 0; k < front->n; k++)
            json_point(json, run, &front->at[k]);
        moray_json_close(json);
        moray_json_close(json);
    }
    moray_json_close(json);
}

// ---- Files ---------------------------------------------------------------------------------------------------------

static moray_status write_csv(const pareto_front *front, const double *values, moray_output *output)
{
    static const char *const names[PARETO_VALUES][2] = {[PARETO_POWER] = {"power", "W"},
                                                        [PARETO_SPEED] = {"course speed", "m/s"},
                                                        [PARETO_THETA_MAX] = {"theta_max", "deg"},
                                                        [PARETO_OMEGA] = {"omega", "deg/s"},
                                                        [PARETO_DELTA] = {"delta", "deg"},
                                                        [PARETO_TAPER] = {"taper", "1"},
                                                        [PARETO_PRICE] = {"speed per power", "m/s/W"},
                                                        [PARETO_TRUE_SPEED] = {"first-principles course speed", "m/s"},
                                                        [PARETO_TRUE_POWER] = {"first-principles power", "W"}};
    static const char *const kinds[PARETO_KINDS] = {"lateral", "eel", "free"};
    char name[40];
    FILE *file;
    moray_column columns[PARETO_VALUES];
    snprintf(name, sizeof name, "%s_%s.csv", moray_model_key(front->model), kinds[front->kind]);
    for (int i = 0; i < PARETO_VALUES; i++)
        columns[i] = (moray_column){names[i][0], names[i][1], values + i, PARETO_VALUES};
    MORAY_TRY(moray_output_file(output, name, &file));
    moray_csv_write(file, columns, PARETO_VALUES, front->n);
    return moray_ok();
}

typedef struct picture {
    const char *name, *title, *y_label;
    int value;
    bool truth; // with what the control-oriented gaits make on the first-principles model
} picture;

static moray_status draw(const pareto *run, const picture *what, double *const values[PARETO_FRONTS],
                         moray_output *output)
{
    moray_curve curves[2 * PARETO_FRONTS];
    char labels[2 * PARETO_FRONTS][100];
    int n = 0;
    for (int f = 0; f < run->fronts; f++) {
        const pareto_front *front = &run->front[f];
        const bool control = front->model == MORAY_CONTROL_ORIENTED;
        if (front->n == 0 ||
            (front->kind == 2 && (control || pareto_is_lateral(front)))) // no more curves than the palette tells apart
            continue;
        for (int truth = 0; truth <= (what->truth && control); truth++, n++) {
            snprintf(labels[n], sizeof labels[n], "%s, %s%s", pareto_kinds[front->kind],
                     control ? "control-oriented optima" : "first-principles optima",
                     truth ? ", swum on the first-principles model" : "");
            curves[n] = (moray_curve){.label = labels[n],
                                      .x = values[f] + (truth ? PARETO_TRUE_POWER : PARETO_POWER),
                                      .y = values[f] + (truth ? PARETO_TRUE_SPEED : what->value),
                                      .n = front->n,
                                      .stride = PARETO_VALUES,
                                      .style = MORAY_CURVE_MARKED};
        }
    }
    return moray_output_figure(output, &(moray_figure){.name = what->name,
                                                       .title = what->title,
                                                       .x_label = "mean power [W]",
                                                       .y_label = what->y_label,
                                                       .log_x = true,
                                                       .log_y = what->value == PARETO_SPEED,
                                                       .curves = curves,
                                                       .n_curves = n});
}

// Calls `use` with the values of all points of all fronts.
static moray_status with_values(const pareto *run, moray_output *output,
                                moray_status (*use)(const pareto *, double *const[PARETO_FRONTS], moray_output *))
{
    double *values[PARETO_FRONTS], *block = calloc((size_t)(run->fronts * run->points * PARETO_VALUES), sizeof *block);
    if (!block)
        return moray_error(MORAY_MEMORY, "no memory for %d fronts", run->fronts);
    for (int f = 0; f < run->fronts; f++) {
        values[f] = block + f * run->points * PARETO_VALUES;
        for (int k = 0; k < run->front[f].n; k++)
            pareto_values(run, &run->front[f].at[k], values[f] + k * PARETO_VALUES);
    }
    const moray_status status = use(run, values, output);
    free(block);
    return status;
}

static moray_status write_all(const pareto *run, double *const values[PARETO_FRONTS], moray_output *output)
{
    for (int f = 0; f < run->fronts; f++)
        if (run->front[f].n > 0)
            MORAY_TRY(write_csv(&run->front[f], values[f], output));
    return moray_ok();
}

static moray_status draw_all(const pareto *run, double *const values[PARETO_FRONTS], moray_output *output)
{
    static const picture pictures[] = {
        {"front", "Fronts of speed against power", "speed along the course [m/s]", PARETO_SPEED, true},
        {"omega", "Along the fronts: frequency", "omega [deg/s]", PARETO_OMEGA, false},
        {"delta", "Along the fronts: phase shift", "delta [deg]", PARETO_DELTA, false},
        {"theta_max", "Along the fronts: link-angle amplitude in the middle", "theta_max [deg]", PARETO_THETA_MAX,
         false},
        {"taper", "Along the fronts: taper of the amplitude", "taper", PARETO_TAPER, false}};
    for (size_t k = 0; k < sizeof pictures / sizeof *pictures; k++)
        MORAY_TRY(draw(run, &pictures[k], values, output));
    return moray_ok();
}

moray_status pareto_write(const void *run, moray_output *output)
{
    return with_values(run, output, write_all);
}

moray_status pareto_draw(const void *run, moray_output *output)
{
    return with_values(run, output, draw_all);
}
