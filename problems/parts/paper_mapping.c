// SPDX-License-Identifier: MIT
//
// Fig. 6: the joint distance (29) of the gait (24) and its approximations (30), (31) by one sine.
#include "paper.h"

enum { POINTS = 361, EXACT = 0, BY_30, BY_31, FORMS };

// (29), (30), (31) of joint 1 at time t.
static void joint_distance(const paper *p, double theta_max, double t, double phi[FORMS])
{
    const double l = p->robot->l, a = sin(p->settings->omega * t), b = sin(p->settings->omega * t + p->settings->delta);
    phi[EXACT] = l * sin(theta_max * b) + l * sin(theta_max * a); // (29)
    phi[BY_30] = l * theta_max * (b + a);                         // (30)
    phi[BY_31] = l * sin(theta_max) * (b + a);                    // (31)
}

typedef struct errors {
    double curve[FORMS], amplitude[FORMS]; // against (29) [m]
} errors;

static errors sweep(const paper *p, double theta_max, double *t, double *phi)
{
    errors e = {{0}, {0}};
    double peak[FORMS] = {0};
    for (int k = 0; k < POINTS; k++) {
        double *at = phi + k * FORMS;
        t[k] = 2 * M_PI / p->settings->omega * k / (POINTS - 1);
        joint_distance(p, theta_max, t[k], at);
        for (int f = 0; f < FORMS; f++) {
            e.curve[f] = fmax(e.curve[f], fabs(at[f] - at[EXACT]));
            peak[f] = fmax(peak[f], fabs(at[f]));
        }
    }
    for (int f = 0; f < FORMS; f++)
        e.amplitude[f] = peak[f] - peak[EXACT];
    return e;
}

static moray_status draw(paper *p, double theta_max, const double *t, const double *phi)
{
    const char *const labels[FORMS] = {"(29), exact", "(30), small angles", "(31), sine in the amplitude"};
    moray_curve curves[FORMS];
    moray_column columns[FORMS + 1] = {{.name = "t", .unit = "s", .values = t}};
    for (int f = 0; f < FORMS; f++) {
        curves[f] = (moray_curve){.label = labels[f], .x = t, .y = phi + f, .n = POINTS, .stride = FORMS};
        columns[f + 1] = (moray_column){.name = labels[f], .unit = "m", .values = phi + f, .stride = FORMS};
    }
    (void)theta_max;
    MORAY_TRY(paper_csv(p, NULL, columns, FORMS + 1, POINTS));
    return paper_figure(p, &(moray_figure){.title = "Fig. 6: joint distance over a period",
                                           .x_label = "time [s]",
                                           .y_label = "joint distance [m]",
                                           .curves = curves,
                                           .n_curves = FORMS});
}

moray_status paper_mapping(paper *p)
{
    double *t, *phi;
    MORAY_TRY(paper_numbers(p, POINTS, &t));
    MORAY_TRY(paper_numbers(p, (size_t)POINTS * FORMS, &phi));
    const errors e = sweep(p, p->settings->theta_max, t, phi);
    const moray_table_row rows[] = {
        {.label = "largest error over a period", .value = {1000 * e.curve[BY_30], 1000 * e.curve[BY_31]}, .unit = "mm"},
        {.label = "error of the amplitude",
         .value = {1000 * e.amplitude[BY_30], 1000 * e.amplitude[BY_31]},
         .unit = "mm"},
    };
    MORAY_TRY(paper_table(p, &(moray_table){.title = "Approximations of the joint distance (29)",
                                            .columns = {"(30)", "(31)"},
                                            .n_columns = 2,
                                            .rows = rows,
                                            .n_rows = 2}));
    moray_json_number(p->json, "error_30_m", e.curve[BY_30]);
    moray_json_number(p->json, "error_31_m", e.curve[BY_31]);
    return draw(p, p->settings->theta_max, t, phi);
}
