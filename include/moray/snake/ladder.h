// SPDX-License-Identifier: MIT
//
// The ladder: what gaits are worth on models that they were not found on. Every rung is a robot of the
// first-principles model; on each, gaits are compared with a baseline at its power there.
#ifndef MORAY_SNAKE_LADDER_H
#define MORAY_SNAKE_LADDER_H

#include <stddef.h>

#include "moray/export.h"
#include "moray/app/results.h"
#include "moray/snake/swim.h"

MORAY_BEGIN

enum { MORAY_RUNGS = 15, MORAY_RUNG_CHANGES = 0x7f80 }; // the bits of those with a coefficient changed

// In this order: the robot with the hydrodynamics paper (all as printed), split2, split3, split5 (the same, every link
// cut into so many pieces), strip (drag and added mass along the link), quadratic (the paper's with quadratic drag),
// consistent (moray_hydrodynamics_consistent); then with its own hydrodynamics and one coefficient a fifth larger or
// smaller: c_n+20, c_n-20, c_t+20, c_t-20, mu_n+20, mu_n-20, lambda+20, lambda-20 (all three of (4)).
typedef struct moray_rung {
    const char *name;
    moray_robot robot;
} moray_rung;
MORAY_API void moray_ladder(const moray_robot *robot, moray_rung rung[MORAY_RUNGS]);

// The rung of a name, or -1; and the bit 1 << rung of the one whose hydrodynamics for the first-principles model are
// the robot's own, or 0.
MORAY_API int moray_rung_named(const char *name);
MORAY_API unsigned moray_rung_of(const moray_robot *robot);

typedef struct moray_ladder_spec {
    moray_robot robot;
    double current[2];      // [m/s]
    double course;          // [rad]
    moray_gait baseline;    // of the first-principles model, as all of them; at its own omega
    const moray_gait *gait; // [gaits]
    int gaits;
    moray_swim_settings settings; // of what is simulated
    int jobs;                     // processes, as for moray_parallel
} moray_ladder_spec;

// One gait on one rung: at the omega at which its power is the baseline's there, by how much its speed through the
// water beats the baseline's. All NaN where `why` has failed: the baseline cannot be swum there, or the gait cannot, or
// has no such omega.
typedef struct moray_ladder_row {
    const char *model; // name of the rung
    double gain_percent, speed, power, omega;
    moray_status why;
} moray_ladder_row;

// Whether a gait is one to compare with. Error: MORAY_NOT_SOLVED where it makes less than a hundredth of a link a
// period.
MORAY_API moray_status moray_makes_way(const moray_robot *robot, const moray_gait *gait, const moray_steady *steady);

// Swims them all, into row[gaits][MORAY_RUNGS]: as stable periodic orbits, on which phi_0 holds the heading; where
// there is none, and with a series, from rest (moray_swim_match_power). Error: MORAY_INPUT (robot), MORAY_NUMERIC
// (moray_parallel).
MORAY_API moray_status moray_ladder_climb(const moray_ladder_spec *spec, moray_ladder_row *row);

// What a ladder says: of the n rungs that compare, on how many the gait wins, by more than 0.05 %, and the range.
// `found_on` has a bit 1 << rung for each one that the gait was optimised on; those with a coefficient changed are of
// the same model as moray_rung_of.
typedef struct moray_ladder_count {
    int n, wins, wins_elsewhere; // elsewhere: not among found_on
    double least, most;          // gain [%]; NaN where n is 0
    bool complete;               // n is MORAY_RUNGS
} moray_ladder_count;
MORAY_API moray_ladder_count moray_ladder_counted(const moray_ladder_row row[MORAY_RUNGS], unsigned found_on);

// Adds the verdict to what stands in text[size]: "wins on all 15, from +1.3 to +4.0 %", "wins on 6 of 15, from -2.1 to
// +4.0 %", "wins only on the model it was found on, 9 of 15, from -19.0 to +3.3 %" (where it was found on several:
// models), with what is left out and why behind it.
MORAY_API void moray_ladder_verdict(const moray_ladder_row row[MORAY_RUNGS], unsigned found_on, char *text,
                                    size_t size);

// "ladder": a list of {model, gain_percent_at_equal_power, speed_m_s, power_W, omega_deg_s}, with "left_out" where that
// is so.
MORAY_API void moray_ladder_to_json(moray_json *json, const moray_ladder_row row[MORAY_RUNGS]);

// What the names of the rungs stand for, for a report; up to one without a name.
MORAY_API const moray_meaning *moray_ladder_words(void);

// ladder.svg: gains of n gaits, at most MORAY_LADDER_DRAWN, rung by rung; nothing where there are none. `colours`: of
// each, or NULL. Error: those of moray_output_figure.
#define MORAY_LADDER_DRAWN 8
MORAY_API moray_status moray_ladder_draw(moray_output *output, const moray_ladder_row *const *ladders,
                                         const char *const *names, const moray_colour *colours, int n);

// Rows of a table of gains, one gait a column; returns how many.
MORAY_API int moray_ladder_rows(const moray_ladder_row *const *ladders, int n, moray_table_row rows[MORAY_RUNGS]);

MORAY_END

#endif
