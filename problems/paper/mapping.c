// SPDX-License-Identifier: MIT
//
// Fig. 6: the joint distance (29) of the gait (24) and its approximations (30), (31) by one sine.
#include "mapping.h"

enum { POINTS = 361 };

void joint_distance(double l, double theta_max, double delta, double phase, double phi[DISTANCES])
{
    const double first = sin(phase), second = sin(phase + delta);
    phi[DISTANCE_29] = l * sin(theta_max * second) + l * sin(theta_max * first);
    phi[DISTANCE_30] = l * theta_max * (second + first);
    phi[DISTANCE_31] = l * sin(theta_max) * (second + first);
}

// Largest |values[DISTANCES]| so far.
static void raise(double peak[DISTANCES], const double values[DISTANCES], double less)
{
    for (int f = 0; f < DISTANCES; f++)
        peak[f] = fmax(peak[f], fabs(values[f] - less));
}

// All three forms peak where the two sines are equal, halfway between two zeros.
distance_errors distance_errors_of(double l, double theta_max, double delta)
{
    distance_errors e = {.exact_amplitude = 0};
    double peak[DISTANCES] = {0}, phi[DISTANCES];
    for (int k = 0; k < POINTS; k++) {
        joint_distance(l, theta_max, delta, 2 * M_PI * k / (POINTS - 1), phi);
        raise(e.curve, phi, phi[DISTANCE_29]);
    }
    joint_distance(l, theta_max, delta, M_PI / 2 - delta / 2, phi);
    raise(peak, phi, 0);
    e.exact_amplitude = peak[DISTANCE_29];
    for (int f = 0; f < DISTANCES; f++)
        e.amplitude[f] = peak[f] - peak[DISTANCE_29];
    return e;
}

static moray_status draw_period(paper *p)
{
    double *t, *phi, at[DISTANCES];
    MORAY_TRY(paper_numbers(p, (1 + DISTANCES) * POINTS, &t));
    phi = t + POINTS;
    for (int k = 0; k < POINTS; k++) {
        const double phase = 2 * M_PI * k / (POINTS - 1);
        t[k] = phase / p->settings->omega;
        joint_distance(100 * p->robot->l, p->settings->theta_max, p->settings->delta, phase, at);
        for (int f = 0; f < DISTANCES; f++)
            phi[f * POINTS + k] = at[f];
    }
    const moray_column columns[] = {{"t", "s", t, 1},
                                    {"(29), exact", "cm", phi, 1},
                                    {"(30), small angles", "cm", phi + POINTS, 1},
                                    {"(31), sine in the amplitude", "cm", phi + 2 * POINTS, 1}};
    const char *title =
        paper_label(p, "Fig. 6: joint distance over a period, theta_max = %.3g deg", p->settings->theta_max / DEG);
    return paper_draw(p, &(paper_graph){"fig6", title, "time [s]", "joint distance [cm]", columns, 1 + DISTANCES,
                                        POINTS, .style = MORAY_CURVE_LINE});
}

// Errors of the two approximations by theta_max, in percent of the amplitude of (29).
static moray_status draw_errors(paper *p)
{
    enum { ANGLES = 45, FORMS = 2, ROWS = 1 + 2 * FORMS, SHOWN = 3 };
    static const int shown[SHOWN] = {1, 2, 4}; // (30) is worst at its peak
    static const char *const labels[ROWS] = {"theta_max", "(30), largest error", "(31), largest error",
                                             "(30), amplitude", "(31), amplitude"};
    double values[ROWS][ANGLES];
    moray_column columns[ROWS];
    for (int k = 0; k < ANGLES; k++) {
        const distance_errors e = distance_errors_of(p->robot->l, (k + 1) * DEG, p->settings->delta);
        values[0][k] = k + 1;
        for (int f = 0; f < FORMS; f++) {
            values[1 + f][k] = 100 * e.curve[DISTANCE_30 + f] / e.exact_amplitude;
            values[1 + FORMS + f][k] = 100 * e.amplitude[DISTANCE_30 + f] / e.exact_amplitude;
        }
    }
    for (int j = 0; j < ROWS; j++)
        columns[j] = (moray_column){.name = labels[j], .unit = j ? "%" : "deg", .values = values[j]};
    return paper_draw(p, &(paper_graph){"errors", "Errors of (30) and (31) against (29)", "theta_max [deg]",
                                        "error [% of the amplitude]", columns, ROWS, ANGLES, .shown = shown,
                                        .n_shown = SHOWN});
}

static moray_status show_errors(paper *p)
{
    static const double angles[] = {10, 15, 20, 30, 40};
    enum { N_ANGLES = sizeof angles / sizeof *angles };
    moray_table_row rows[N_ANGLES];
    moray_json_open_list(p->json, "approximations");
    for (int k = 0; k < N_ANGLES; k++) {
        const distance_errors e = distance_errors_of(p->robot->l, angles[k] * DEG, p->settings->delta);
        const double amplitude = e.exact_amplitude;
        rows[k] = (moray_table_row){.label = paper_label(p, "theta_max %g deg", angles[k]),
                                    .value = {1000 * amplitude, 1000 * e.curve[DISTANCE_30],
                                              1000 * e.curve[DISTANCE_31], 100 * e.amplitude[DISTANCE_30] / amplitude,
                                              100 * e.amplitude[DISTANCE_31] / amplitude}};
        moray_json_object(p->json, NULL,
                          MORAY_MEMBERS({"theta_max_deg", angles[k]}, {"amplitude_29_m", amplitude},
                                        {"largest_error_30_m", e.curve[DISTANCE_30]},
                                        {"largest_error_31_m", e.curve[DISTANCE_31]},
                                        {"amplitude_error_30_m", e.amplitude[DISTANCE_30]},
                                        {"amplitude_error_31_m", e.amplitude[DISTANCE_31]}));
    }
    moray_json_close(p->json);
    return paper_rows(p, "Joint distance: (30) and (31) against (29)",
                      PAPER_HEADS("amplitude [mm]", "(30) [mm]", "(31) [mm]", "(30) ampl. [%]", "(31) ampl. [%]"), rows,
                      N_ANGLES);
}

// The sines of (29) are 2 sin(theta_max sin x cos(delta/2)) cos(theta_max cos x sin(delta/2)), largest at x = pi/2.
static moray_status conclude(paper *p)
{
    return paper_say(p,
                     "The amplitude of (29) is 2 l sin(theta_max cos(delta/2)): (31), and so (33), comes closer to it "
                     "than (30) as long as delta < 90 deg; here delta is %.3g deg.",
                     p->settings->delta / DEG);
}

moray_status paper_mapping(paper *p)
{
    MORAY_TRY(show_errors(p));
    MORAY_TRY(conclude(p));
    MORAY_TRY(draw_period(p));
    MORAY_TRY(draw_errors(p));
    return show_swum_amplitudes(p);
}
