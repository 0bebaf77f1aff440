// SPDX-License-Identifier: MIT
//
// The gait: what is given, else what the run found, else the paper's numbers.
#include "export.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

// ---- From a run ----------------------------------------------------------------------------------------------------

static moray_status read_run(export_found *found)
{
    char path[MORAY_PATH_SIZE + 16];
    if (!found->job->from[0])
        return moray_ok();
    snprintf(path, sizeof path, "%s/summary.json", found->job->from);
    MORAY_TRY(moray_json_read(&found->run, path));
    const char *error = moray_json_text_at(found->run, "error");
    if (error)
        return moray_error(MORAY_INPUT, "--from %.100s: that run found nothing: %.200s", found->job->from, error);
    return moray_ok();
}

// Where the gait stands in the summary; NULL: nowhere.
static const char *gait_place(const moray_json_file *run)
{
    static const char *const places[] = {"gait", "first_principles_plan.gait", "control_oriented_plan.gait", NULL};
    int k = 0;
    while (places[k] && moray_json_count_at(run, places[k]) < 0)
        k++;
    return places[k];
}

static double or_that(double given, double other)
{
    return isnan(given) ? other : given;
}

static double of_gait(const export_found *found, const char *place, const char *key)
{
    char text[80];
    snprintf(text, sizeof text, "%s.%s", place, key);
    return moray_json_number_at(found->run, text);
}

static bool amplitude_given(const moray_gait_input *input)
{
    return !isnan(input->theta_max) || !isnan(input->a) || !isnan(input->alpha);
}

static moray_gait_input input_of(const export_found *found)
{
    moray_gait_input input = found->job->gait;
    const char *place = gait_place(found->run);
    if (place) {
        if (!amplitude_given(&input))
            input.alpha = of_gait(found, place, "alpha_deg") * DEG;
        if (isnan(input.phi0) && isnan(input.phi0_m))
            input.phi0 = of_gait(found, place, "phi0_deg") * DEG;
        input.omega = or_that(input.omega, of_gait(found, place, "omega_deg_s") * DEG);
        input.delta = or_that(input.delta, of_gait(found, place, "delta_deg") * DEG);
        input.taper = or_that(input.taper, of_gait(found, place, "taper"));
    }
    const moray_gait_input usual = moray_gait_input_default();
    input.omega = or_that(input.omega, usual.omega);
    input.delta = or_that(input.delta, usual.delta);
    input.taper = or_that(input.taper, usual.taper);
    return input;
}

// ---- Free motions --------------------------------------------------------------------------------------------------

// Room for the wave, of at least as many harmonics, and for a series.
static moray_status make_room(export_found *found, int harmonics)
{
    const int n = found->job->snake.robot.links - 1, size = n * (1 + 2 * harmonics);
    found->wave_at = calloc(2 * (size_t)size, sizeof *found->wave_at);
    if (!found->wave_at)
        return moray_error(MORAY_MEMORY, "no memory for a gait of %d joints", n);
    found->wave = (moray_series){n, harmonics, found->wave_at};
    found->own = (moray_series){n, harmonics, found->wave_at + size};
    return moray_ok();
}

static moray_status read_series(export_found *found)
{
    const int n = found->job->snake.robot.links - 1, given = moray_json_count_at(found->run, "series_rad");
    const double harmonics = moray_json_number_at(found->run, "harmonics");
    const double omega = moray_json_number_at(found->run, "omega_deg_s");
    if (!(harmonics >= 1 && harmonics <= MORAY_SERIES_HARMONICS && omega > 0))
        return moray_error(MORAY_INPUT, "--from %.100s: a series of %g harmonics at omega_deg_s = %g: must be 1 to %d",
                           found->job->from, harmonics, omega, MORAY_SERIES_HARMONICS);
    if (given != n * (1 + 2 * (int)harmonics))
        return moray_error(MORAY_INPUT, "--from %.100s: %d coefficients of a series, where %d joints want %d",
                           found->job->from, given, n, n * (1 + 2 * (int)harmonics));
    MORAY_TRY(make_room(found, (int)harmonics));
    double *at = found->wave_at + given;
    for (int i = 0; i < given; i++) {
        char place[32];
        snprintf(place, sizeof place, "series_rad.%d", i);
        at[i] = moray_json_number_at(found->run, place);
        if (!isfinite(at[i]))
            return moray_error(MORAY_INPUT, "--from %.100s: %s is not a number", found->job->from, place);
    }
    found->gait = (moray_gait){.omega = omega * DEG, .series = &found->own};
    return moray_ok();
}

static moray_status make_gait(export_found *found)
{
    const export_job *job = found->job;
    const bool series = moray_json_count_at(found->run, "series_rad") > 0;
    if (moray_json_count_at(found->run, "series_m") > 0)
        return moray_error(MORAY_INPUT,
                           "--from %.100s: a series of the control-oriented model, in m, has no joint angles: take a "
                           "run with --model fp",
                           job->from);
    if (series && !amplitude_given(&job->gait))
        return read_series(found);
    const moray_gait_input input = input_of(found);
    MORAY_TRY(moray_gait_input_make(&input, &job->snake.robot, MORAY_FIRST_PRINCIPLES, &found->gait));
    if (fabs(found->gait.offset) < 1e-9 * DEG) // what a solver leaves of none
        found->gait.offset = 0;
    return make_room(found, 1);
}

// ---- All -----------------------------------------------------------------------------------------------------------

static moray_status check_name(const char *name)
{
    bool good = islower((unsigned char)name[0]);
    for (const char *c = name; *c; c++)
        good = good && (islower((unsigned char)*c) || isdigit((unsigned char)*c) || *c == '_');
    if (good)
        return moray_ok();
    return moray_error(MORAY_INPUT, "--name %.40s: must be small letters, digits and _, a letter first", name);
}

void export_ramp(double t, double length, double ramp[3])
{
    const double x = length > 0 ? t / length : 1;
    ramp[0] = x <= 0 ? 0 : 1;
    ramp[1] = ramp[2] = 0;
    if (x <= 0 || x >= 1)
        return;
    ramp[0] = x * x * x * (10 + x * (6 * x - 15));
    ramp[1] = 30 * x * x * (1 - x) * (1 - x) / length;
    ramp[2] = 60 * x * (1 - x) * (1 - 2 * x) / (length * length);
}

// Largest angle, rate and acceleration over a period.
static moray_status find_peaks(export_found *found)
{
    enum { points = 720 };
    const int n = found->job->snake.robot.links - 1;
    double *phi = malloc(3 * (size_t)n * sizeof *phi);
    if (!phi)
        return moray_error(MORAY_MEMORY, "no memory for a gait of %d joints", n);
    for (int k = 0; k < points; k++) {
        moray_gait_reference(&found->gait, n, k * found->period / points, phi, phi + n, phi + 2 * n);
        for (int i = 0; i < n; i++) {
            found->peak_angle = fmax(found->peak_angle, fabs(phi[i]));
            found->peak_rate = fmax(found->peak_rate, fabs(phi[n + i]));
            found->peak_acceleration = fmax(found->peak_acceleration, fabs(phi[2 * n + i]));
        }
    }
    free(phi);
    return moray_ok();
}

moray_status export_gather(export_found *found, const export_job *job)
{
    *found = (export_found){.job = job};
    MORAY_TRY(check_name(job->name));
    MORAY_TRY(read_run(found));
    MORAY_TRY(make_gait(found));
    if (!(found->gait.omega > 0))
        return moray_error(MORAY_INPUT, "omega_deg_s = %g: must be above 0 for a gait to be exported",
                           found->gait.omega / DEG);
    found->period = 2 * M_PI / found->gait.omega;
    found->step = found->period / fmax(round(found->period * job->rate), 1);
    MORAY_TRY(export_gather_law(found));
    moray_series_of_gait(&found->gait, found->wave.joints, found->wave.harmonics, found->wave_at);
    return find_peaks(found);
}

void export_release(export_found *found)
{
    moray_json_file_free(found->run);
    moray_path_free(&found->path);
    free(found->wave_at);
    free(found->plan);
    *found = (export_found){0};
}
