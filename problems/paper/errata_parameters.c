// SPDX-License-Identifier: MIT
//
// Errata in the parameters: sign of the offset, unit of omega, lambda_1..3.
#include "errata.h"

static const double DURATION = 30, STEP = 0.25; // of turning [s]

// ---- E3 ------------------------------------------------------------------------------------------------------------

// Heading [deg] from rest in still water with an offset of `ratio` of the amplitude, on a model of a robot.
static moray_status turn(paper *p, const moray_robot *robot, moray_model model, double ratio, moray_swim_track **track,
                         double **heading)
{
    moray_gait_change change = {0, p->gait[model]};
    change.gait.offset = ratio * change.gait.amplitude;
    paper_swim_plan plan = {.model = model, .schedule = &change, .n_changes = 1};
    MORAY_TRY(paper_swimmer(p, robot, model, p->settings->reading, &plan.swimmer));
    moray_swimmer_set_current(plan.swimmer, 0, 0);
    MORAY_TRY(paper_swim(p, &plan, DURATION, STEP, track));
    return paper_series(p, *track, PAPER_HEADING_DEG, heading);
}

static moray_status draw_turns(paper *p, const moray_swim_track *track, double *const heading[3])
{
    const moray_column columns[] = {
        {.name = "t", .unit = "s", .values = track->t},
        {.name = "first-principles, phi_0 = alpha/6", .unit = "deg", .values = heading[0]},
        {.name = "control-oriented, phi_0 = a/6", .unit = "deg", .values = heading[1]},
        {.name = "first-principles, phi_0 = -alpha/6", .unit = "deg", .values = heading[2]}};
    return paper_draw(p, &(paper_graph){"e3", "E3: the same offset turns the two models opposite ways", "time [s]",
                                        "heading [deg]", columns, 4, track->n, .style = MORAY_CURVE_LINE});
}

moray_status erratum_offset_sign(paper *p)
{
    static const double ratio[3] = {1. / 6, 1. / 6, -1. / 6};
    static const moray_model model[3] = {MORAY_FIRST_PRINCIPLES, MORAY_CONTROL_ORIENTED, MORAY_FIRST_PRINCIPLES};
    moray_swim_track *track;
    double *heading[3], end[3];
    for (int c = 0; c < 3; c++) {
        MORAY_TRY(turn(p, p->robot, model[c], ratio[c], &track, &heading[c]));
        end[c] = paper_mean_heading(track, DURATION, 2 * M_PI / p->settings->omega) / DEG;
    }
    const moray_table_row rows[] = {
        {.label = paper_label(p, "mean heading at %g s", DURATION), .value = {end[0], end[2], end[1]}, .unit = "deg"}};
    moray_json_object(p->json, "e3",
                      MORAY_MEMBERS({"heading_fp_as_printed_deg", end[0]}, {"heading_fp_corrected_deg", end[2]},
                                    {"heading_control_deg", end[1]}));
    MORAY_TRY(paper_rows(p,
                         "E3: Sec. V-C gives both models the same offset, a sixth of the "
                         "amplitude",
                         PAPER_HEADS("as printed, alpha/6", "corrected, -alpha/6", "control, a/6"), rows, 1));
    return draw_turns(p, track, heading);
}

// ---- E4 ------------------------------------------------------------------------------------------------------------

static moray_steady swim_at(paper *p, double omega, moray_status *status)
{
    moray_gait gait = p->gait[MORAY_FIRST_PRINCIPLES];
    moray_steady steady;
    moray_swim_track *orbit;
    gait.omega = omega;
    *status = paper_orbit(p, MORAY_FIRST_PRINCIPLES, &gait, 2, &steady, &orbit);
    return moray_failed(*status) ? (moray_steady){.v_x = NAN, .power = NAN, .peak_effort = NAN} : steady;
}

static void json_frequency(moray_json *json, const char *key, double omega, const moray_steady *steady)
{
    moray_json_object(json, key,
                      MORAY_MEMBERS({"omega_rad_s", omega}, {"v_x_m_s", steady->v_x}, {"power_W", steady->power}));
}

// That nothing steady comes of the number as printed is a finding, too.
moray_status erratum_frequency(paper *p)
{
    const double printed = p->settings->omega / DEG, corrected = p->settings->omega; // the number as rad/s, as deg/s
    moray_status why, status;
    const moray_steady fast = swim_at(p, printed, &why), steady = swim_at(p, corrected, &status);
    if (moray_failed(status))
        return status;
    const moray_table_row rows[] = {
        {.label = "omega", .value = {printed, corrected}, .unit = "rad/s"},
        {.label = "mean v_x, first-principles", .value = {fast.v_x, steady.v_x}, .unit = "m/s"},
        {.label = "mean joint power", .value = {fast.power, steady.power}, .unit = "W"},
        {.label = "peak joint torque", .value = {fast.peak_effort, steady.peak_effort}, .unit = "N m"},
    };
    moray_json_open(p->json, "e4_omega");
    json_frequency(p->json, "as_printed", printed, &fast);
    json_frequency(p->json, "corrected", corrected, &steady);
    moray_json_close(p->json);
    MORAY_TRY(paper_rows(p,
                         paper_label(p,
                                     "E4: omega = %g is a number of deg/s, not of rad/s (Fig. 7 stays "
                                     "below 0.5 m/s)",
                                     printed),
                         PAPER_HEADS("rad/s", "deg/s"), rows, 4));
    return moray_failed(why) ? paper_say(p, "E4: as rad/s it is not swum: %s.", why.text) : moray_ok();
}

moray_status erratum_lambda(paper *p)
{
    moray_robot printed = *p->robot;
    moray_swim_track *track;
    double *heading, end[2];
    printed.rot_damping = printed.lambda_1 / (1 + printed.lambda_3); // as (20) defines them by (19)
    printed.rot_gain = printed.lambda_2 / (1 + printed.lambda_3);
    const moray_robot *const robots[2] = {&printed, p->robot};
    for (int c = 0; c < 2; c++) {
        MORAY_TRY(turn(p, robots[c], MORAY_CONTROL_ORIENTED, 1. / 6, &track, &heading));
        end[c] = paper_mean_heading(track, DURATION, 2 * M_PI / p->settings->omega) / DEG;
    }
    const moray_table_row rows[] = {
        {.label = "first constant of (20)", .value = {printed.rot_damping, p->robot->rot_damping}, .unit = "1/s"},
        {.label = "second constant of (20)", .value = {printed.rot_gain, p->robot->rot_gain}, .unit = "1/(m^2 s)"},
        {.label = paper_label(p, "mean heading at %g s, phi_0 = a/6", DURATION),
         .value = {end[0], end[1]},
         .unit = "deg"},
    };
    moray_json_open(p->json, "e4_lambda");
    moray_json_numbers(p->json, "heading_printed_corrected_deg", end, 2);
    moray_json_close(p->json);
    return paper_rows(p, "E4: lambda_1..3 of (19) are not those of (4), whose values Sec. V-A gives",
                      PAPER_HEADS("those of (4)", "1.15 and 40"), rows, 3);
}
