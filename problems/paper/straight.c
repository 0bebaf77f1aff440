// SPDX-License-Identifier: MIT
//
// Sec. V-B, Fig. 7: straight motion with a link-angle amplitude that grows every 45 s; and the mean velocity that each
// amplitude comes to from rest.
#include "swim.h"

enum { AMPLITUDES = 4, PERIODS = 5 };
static const double theta_max_deg[AMPLITUDES] = {10, 15, 20, 30};
static const double HOLD = 45, STEP = 0.1; // [s] of an amplitude, between samples

// Sec. V-B shifts the models apart, "for better visibility".
static const double p_y[2] = {[MORAY_CONTROL_ORIENTED] = 5, [MORAY_FIRST_PRINCIPLES] = -5};

// ---- Fig. 7 --------------------------------------------------------------------------------------------------------

static moray_status swim_in_steps(paper *p, moray_model model, moray_swim_track **track)
{
    moray_gait_change schedule[AMPLITUDES];
    for (int i = 0; i < AMPLITUDES; i++)
        schedule[i] = (moray_gait_change){i * HOLD, paper_gait(p, model, theta_max_deg[i] * DEG)};
    const paper_swim_plan plan = {.model = model, .schedule = schedule, .n_changes = AMPLITUDES, .p_y = p_y[model]};
    return paper_swim(p, &plan, AMPLITUDES * HOLD, STEP, track);
}

static moray_status draw(paper *p)
{
    moray_swim_track *track[2];
    paper_pair pair;
    double mark[2][2 * AMPLITUDES]; // where the robots are when the amplitude has been held
    for (int model = 0; model < 2; model++)
        MORAY_TRY(swim_in_steps(p, (moray_model)model, &track[model]));
    MORAY_TRY(paper_pair_of(p, track, &pair));
    for (int k = 0; k < 2 * AMPLITUDES; k++) {
        const int model = k % 2, at = (int)lround((k / 2 + 1) * HOLD / STEP);
        mark[0][k] = pair.of[PAPER_P_X][model][at];
        mark[1][k] = pair.of[PAPER_P_Y][model][at];
    }
    const moray_curve held = {
        .label = "every 45 s", .x = mark[0], .y = mark[1], .n = 2 * AMPLITUDES, .style = MORAY_CURVE_POINTS};
    MORAY_TRY(paper_pair_csv(p, &pair, 1 + PAPER_V_X));
    MORAY_TRY(paper_pair_position(p, &pair, "Fig. 7: position; theta_max 10, 15, 20, 30 deg for 45 s each", &held));
    return paper_pair_over_time(p, &pair, PAPER_V_X, "velocity",
                                "Fig. 7: velocity; theta_max 10, 15, 20, 30 deg for 45 s each", "v_x [m/s]");
}

// ---- Each amplitude from rest --------------------------------------------------------------------------------------

static moray_status measure(paper *p, double speed[2][AMPLITUDES])
{
    for (int i = 0; i < AMPLITUDES; i++) {
        paper_progress(p, "theta_max %g deg", theta_max_deg[i]);
        for (int model = 0; model < 2; model++) {
            const moray_gait_change change = {0, paper_gait(p, (moray_model)model, theta_max_deg[i] * DEG)};
            const paper_swim_plan plan = {.model = (moray_model)model, .schedule = &change, .n_changes = 1};
            MORAY_TRY(paper_mean_velocity(p, &plan, HOLD, PERIODS, &speed[model][i]));
        }
    }
    return moray_ok();
}

static moray_status tell(paper *p, double speed[2][AMPLITUDES])
{
    moray_table_row rows[AMPLITUDES];
    double excess[AMPLITUDES];
    for (int i = 0; i < AMPLITUDES; i++) {
        const double control = speed[MORAY_CONTROL_ORIENTED][i], revolute = speed[MORAY_FIRST_PRINCIPLES][i];
        const moray_gait a = paper_gait(p, MORAY_CONTROL_ORIENTED, theta_max_deg[i] * DEG);
        const moray_gait alpha = paper_gait(p, MORAY_FIRST_PRINCIPLES, theta_max_deg[i] * DEG);
        excess[i] = 100 * (control / revolute - 1);
        rows[i] = (moray_table_row){
            .label = paper_label(p, "theta_max %g deg", theta_max_deg[i]),
            .value = {alpha.amplitude / DEG, 100 * a.amplitude, revolute, control, excess[i]},
        };
    }
    moray_json_numbers(p->json, "theta_max_deg", theta_max_deg, AMPLITUDES);
    moray_json_numbers(p->json, "v_x_fp_m_s", speed[MORAY_FIRST_PRINCIPLES], AMPLITUDES);
    moray_json_numbers(p->json, "v_x_control_m_s", speed[MORAY_CONTROL_ORIENTED], AMPLITUDES);
    moray_json_numbers(p->json, "excess_percent", excess, AMPLITUDES);
    return paper_rows(p, "Mean v_x in m/s over the last five periods of 45 s, each amplitude from rest",
                      PAPER_HEADS("alpha [deg]", "a [cm]", "first-principles", "control-oriented", "excess [%]"), rows,
                      AMPLITUDES);
}

moray_status paper_straight(paper *p)
{
    double speed[2][AMPLITUDES];
    MORAY_TRY(measure(p, speed));
    MORAY_TRY(tell(p, speed));
    MORAY_TRY(paper_say(p,
                        "The paper finds good accordance at 10 and 15 deg, and beyond them that the simplified model "
                        "overestimates the velocity: here by %.1f and %.1f %%, then by %.1f and %.1f %%.",
                        100 * (speed[0][0] / speed[1][0] - 1), 100 * (speed[0][1] / speed[1][1] - 1),
                        100 * (speed[0][2] / speed[1][2] - 1), 100 * (speed[0][3] / speed[1][3] - 1)));
    return draw(p);
}
