// SPDX-License-Identifier: MIT
//
// Sec. V-C, Fig. 8: turning by a joint offset of a sixth of the amplitude, there and back.
#include "swim.h"

enum { CHANGES = 5 };
static const double THETA_MAX = 10 * DEG, END = 190, STEP = 0.1;

// t in [40, 70] s one way, in [130, 160] s the other. The offset is a/6 and, by erratum E3, -alpha/6.
static moray_status turn(paper *p, moray_model model, moray_swim_track **track)
{
    const double way[CHANGES] = {0, 1, 0, -1, 0}, from[CHANGES] = {0, 40, 70, 130, 160};
    moray_gait_change schedule[CHANGES];
    for (int i = 0; i < CHANGES; i++) {
        schedule[i] = (moray_gait_change){from[i], paper_gait(p, model, THETA_MAX)};
        schedule[i].gait.offset = way[i] * schedule[i].gait.amplitude / 6 * (model == MORAY_CONTROL_ORIENTED ? 1 : -1);
    }
    const paper_swim_plan plan = {.model = model, .schedule = schedule, .n_changes = CHANGES};
    return paper_swim(p, &plan, END, STEP, track);
}

// ---- Fig. 8 --------------------------------------------------------------------------------------------------------

static moray_status draw(paper *p, const paper_pair *pair)
{
    static const struct {
        paper_quantity quantity;
        const char *name, *title, *y_label;
    } figures[] = {
        {PAPER_HEADING_DEG, "orientation", "Fig. 8(b): orientation", "theta, mean link angle [deg]"},
        {PAPER_V_X, "v_x", "Fig. 8(c): velocity of the centre of mass along x", "v_x [m/s]"},
        {PAPER_V_Y, "v_y", "Fig. 8(d): velocity of the centre of mass along y", "v_y [m/s]"},
    };
    MORAY_TRY(paper_pair_csv(p, pair, PAPER_QUANTITIES));
    MORAY_TRY(paper_pair_position(p, pair, "Fig. 8(a): position", NULL));
    for (unsigned i = 0; i < sizeof figures / sizeof *figures; i++)
        MORAY_TRY(
            paper_pair_over_time(p, pair, figures[i].quantity, figures[i].name, figures[i].title, figures[i].y_label));
    return moray_ok();
}

// ---- In numbers ----------------------------------------------------------------------------------------------------

static moray_status tell(paper *p, moray_swim_track *track[2])
{
    const double period = 2 * M_PI / p->settings->omega;
    double heading[2], end[2][2];
    moray_table_row rows[3] = {{.label = "mean heading at t = 130 s", .unit = "deg"},
                               {.label = "p_x at t = 190 s", .unit = "m"},
                               {.label = "p_y at t = 190 s", .unit = "m"}};
    for (int model = 0; model < 2; model++) {
        const moray_pose *last = &track[model]->pose[track[model]->n - 1];
        heading[model] = paper_mean_heading(track[model], 130, period) / DEG;
        end[model][0] = last->p_x;
        end[model][1] = last->p_y;
        rows[0].value[1 - model] = heading[model];
        rows[1].value[1 - model] = last->p_x;
        rows[2].value[1 - model] = last->p_y;
    }
    moray_json_number(p->json, "heading_fp_deg", heading[MORAY_FIRST_PRINCIPLES]);
    moray_json_number(p->json, "heading_control_deg", heading[MORAY_CONTROL_ORIENTED]);
    moray_json_numbers(p->json, "end_fp_m", end[MORAY_FIRST_PRINCIPLES], 2);
    moray_json_numbers(p->json, "end_control_m", end[MORAY_CONTROL_ORIENTED], 2);
    return paper_rows(p, "Manoeuvre of Sec. V-C, theta_max 10 deg",
                      PAPER_HEADS(moray_model_name(MORAY_FIRST_PRINCIPLES), moray_model_name(MORAY_CONTROL_ORIENTED)),
                      rows, 3);
}

moray_status paper_turning(paper *p)
{
    moray_swim_track *track[2];
    paper_pair pair;
    for (int model = 0; model < 2; model++)
        MORAY_TRY(turn(p, (moray_model)model, &track[model]));
    MORAY_TRY(tell(p, track));
    MORAY_TRY(paper_say(p, "The offset is a/6 in the control-oriented model and, since a positive offset turns the two "
                           "models opposite ways (erratum E3), -alpha/6 in the first-principles model."));
    MORAY_TRY(paper_pair_of(p, track, &pair));
    return draw(p, &pair);
}
