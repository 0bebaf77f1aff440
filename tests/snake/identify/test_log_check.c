// SPDX-License-Identifier: MIT
//
// Names and units of columns, what of a log is refused, by its whole text, and what is noted.
#include "tap.h"

#include <string.h>
#include <unistd.h>

#include "moray/snake/identify.h"

enum { ROWS = 24, T = 0, PHI = 1, X = 3, Y = 4, HEADING = 5, U = 6, COLUMNS = 8 };
static const char *const names = "t,phi_1,phi_2,p_x,p_y,heading,u_1,u_2";
static const char *const path = "log.csv"; // in a folder of the test

typedef struct table {
    int rows;
    double at[ROWS][COLUMNS];
} table;

// Two joints that swing, 1 m/s or slower, a heading that turns about.
static table sound(void)
{
    table of = {.rows = ROWS};
    for (int k = 0; k < ROWS; k++) {
        const double row[COLUMNS] = {3 + 0.1 * k,    0.3 * sin(k), -0.2 * cos(k), 0.02 * k - 1,
                                     0.5 - 0.03 * k, 0.1 * k - 1,  2 + k,         3 - 2 * k};
        memcpy(of.at[k], row, sizeof row);
    }
    return of;
}

// Lines of the file: the names, then the rows; NAN is written as nothing.
static void put(const table *of, const char *header)
{
    FILE *file = fopen(path, "w");
    fprintf(file, "%s\n", header);
    for (int k = 0; k < of->rows; k++)
        for (int j = 0; j < COLUMNS; j++) {
            if (!isnan(of->at[k][j]))
                fprintf(file, "%.17g", of->at[k][j]);
            fputs(j + 1 < COLUMNS ? "," : "\n", file);
        }
    fclose(file);
}

static moray_swim_log_format usual(void)
{
    return (moray_swim_log_format){.joints = 2, .torque_constant = NAN};
}

static void refused(const table *of, const char *header, const moray_swim_log_format *format, const char *text)
{
    moray_swim_log log;
    put(of, header);
    const moray_status status = moray_swim_log_read(&log, path, format);
    CHECK(status.code == MORAY_INPUT && strcmp(status.text, text) == 0, "\"%s\", expected \"%s\"", status.text, text);
    moray_swim_log_free(&log);
}

static void noted(const table *of, const moray_swim_log_format *format, const char *notes)
{
    moray_swim_log log;
    put(of, names);
    CHECK_OK(moray_swim_log_read(&log, path, format), "a log with notes");
    CHECK(strcmp(log.notes, notes) == 0, "\"%s\", expected \"%s\"", log.notes, notes);
    moray_swim_log_free(&log);
}

// ---- Names and units -----------------------------------------------------------------------------------------------

// Every column is what was written times its factor.
static void check_read(const char *header, const moray_swim_log_format *format, const double factor[COLUMNS])
{
    const table of = sound();
    moray_swim_log log;
    double worst = 0;
    put(&of, header);
    CHECK_OK(moray_swim_log_read(&log, path, format), header);
    if (CHECK(log.n == ROWS && log.p_x && log.p_y && log.heading && log.u, "%s: all is found", header))
        for (int k = 0; k < ROWS; k++) {
            const double got[COLUMNS] = {log.t[k],   log.phi[2 * k], log.phi[2 * k + 1], log.p_x[k],
                                         log.p_y[k], log.heading[k], log.u[2 * k],       log.u[2 * k + 1]};
            for (int j = 0; j < COLUMNS; j++)
                worst = tap_worse(worst, fabs(got[j] - factor[j] * of.at[k][j]));
            worst = tap_worse(worst, abs(log.line[k] - k - 2));
        }
    CHECK(worst < 1e-12, "%s: each by its factor: %.1e", header, worst);
    CHECK(log.at_motors == (strstr(header, "[A]") != NULL), "%s: of motors or not", header);
    CHECK(log.reference == format->reference && log.joints == 2, "as the format says");
    CHECK(strcmp(log.name, "log.csv") == 0, "named by its path: %s", log.name);
    moray_swim_log_free(&log);
}

static void test_names(void)
{
    const double one[COLUMNS] = {1, 1, 1, 1, 1, 1, 1, 1}, degree = M_PI / 180;
    moray_swim_log_format f = usual();
    check_read(names, &f, one);
    check_read("Time,joint1,joint2,x,y,yaw,torque_1,torque_2", &f, one);
    check_read("time (ms),phi1 [deg],phi2 (deg),p_x [cm],p_y[mm],theta [rad],u1 [mNm],u2 [N m]", &f,
               (const double[]){1e-3, degree, degree, 1e-2, 1e-3, 1, 1e-3, 1});
    f.torque_constant = 0.7;
    f.units = "p_x=m";
    check_read("t [us],joint_1,joint_2 [deg],x [m],y [cm],heading [deg],motor_current_1 [A],motor_current_2 [A]", &f,
               (const double[]){1e-6, 1, degree, 1, 1e-2, degree, 0.7, 0.7});
    f.columns = "phi=servo#deg,u=#,p_x=east,t=clock,heading=h";
    f.units = "p_x=mm,t=s,phi=deg,heading=rad";
    check_read("clock [ms],servo1deg,servo2deg,east,y,h [deg],1,2", &f,
               (const double[]){1, degree, degree, 1e-3, 1, 1, 1, 1});
    f = (moray_swim_log_format){.joints = 2, .reference = true, .torque_constant = NAN};
    check_read("t,phi_ref_1,reference_2,p_x,p_y,heading,u_1,u_2", &f, one);
}

static void test_bad_lists(void)
{
    const table of = sound();
    moray_swim_log_format f = usual();
    f.columns = "p_x=east,phi";
    refused(&of, names, &f, "columns: phi: must be KEY=NAME with KEY one of t, phi, phi_ref, p_x, p_y, heading, u");
    f.columns = "p_x=,phi=a#";
    refused(&of, names, &f, "columns: p_x=: must be KEY=NAME with KEY one of t, phi, phi_ref, p_x, p_y, heading, u");
    f.columns = NULL;
    f.units = "p=mm";
    refused(&of, names, &f, "units: p=mm: must be KEY=UNIT with KEY one of t, phi, phi_ref, p_x, p_y, heading, u");
    f.units = "p_x=a_unit_of_a_name_that_is_a_good_deal_longer_than_sixty_characters,t=s";
    f.columns = NULL;
    refused(&of, names, &f, "log.csv:1: column p_x: unit a_unit_of_a_name_that_is_a_goo; must be one of m, cm, mm");
    f.units = "x=a_unit_of_a_name_that_is_a_good_deal_longer_than_sixty_characters,t=s";
    refused(&of, names, &f,
            "units: x=a_unit_of_a_name_that_is_a_good_deal_longer_than_sixty_cha: must be KEY=UNIT with KEY one of t, "
            "phi, phi_ref, p_x, p_y, heading, u");
    f.units = NULL;
    refused(&of, "t,phi_1,phi_2,p_x,p_y,heading,u_1,u_2 [A]", &f,
            "log.csv:1: column u_2 [A]: in A, but no torque constant was given: --set torque_constant_N_m_A=K");
    refused(&of, "t [h],phi_1,phi_2,p_x,p_y,heading,u_1,u_2", &f,
            "log.csv:1: column t [h]: unit h; must be one of s, ms, us");
    refused(&of, "t,phi_1,phi_3,p_x,p_y,heading,u_1,u_2", &f,
            "log.csv:1: no column for phi, number 2: looked for phi_#|phi#|joint_#|joint#; name it with --columns "
            "phi=NAME, # for the number");
    refused(&of, "tt,phi_1,phi_2,p_x,p_y,heading,u_1,u_2", &f,
            "log.csv:1: no column for t: looked for t|time|Time; name it with --columns t=NAME");
    refused(&of, "t,phi_1,phi_2,p_x,p_y,heading,u_1,u_3", &f,
            "log.csv:1: no column for u, number 2: looked for u_#|u#|torque_#|motor_current_#; name it with --columns "
            "u=NAME, # for the number");
    f.columns = "p_x=east";
    refused(&of, names, &f, "log.csv:1: no column for p_x: looked for east; name it with --columns p_x=NAME");
}

// ---- What must hold ------------------------------------------------------------------------------------------------

static void test_time(void)
{
    const moray_swim_log_format f = usual();
    moray_swim_log_format said = f;
    table of = sound();
    of.at[9][T] = of.at[8][T];
    refused(&of, names, &f,
            "log.csv:11: t = 3.8 s: not after 3.8 s in line 10; rows must be in the order of time, no time twice");
    of = sound();
    of.rows = 19;
    refused(&of, names, &f, "log log.csv: 19 rows; needs 20 at least");
    of.rows = 20;
    noted(&of, &f, "");
    of = sound();
    for (int k = 0; k < ROWS; k++)
        of.at[k][T] = 1 + 2.5 * k;
    refused(&of, names, &f,
            "log.csv:1: t: rows are 2.5 s apart, more than 2: is it in ms? Say --units t=ms (or t=s if it is right)");
    said.units = "t=s";
    noted(&of, &said, "");
    for (int k = 0; k < ROWS; k++)
        of.at[k][T] = 1 + 2 * k;
    noted(&of, &f, "");
}

static void test_gaps(void)
{
    const moray_swim_log_format f = usual();
    table of = sound();
    for (int k = 0; k < ROWS; k++)
        of.at[k][T] = 0.125 * k + (k > 8 ? 0.5 : 0); // exactly five steps are none
    noted(&of, &f, "");
    for (int k = 0; k < ROWS; k++)
        of.at[k][T] = 0.125 * k + (k > 8 ? 0.625 : 0);
    noted(&of, &f, "log.csv: 1 gap in time, the widest of 0.75 s before line 11 (usual step 0.125 s)");
    for (int k = 0; k < ROWS; k++)
        of.at[k][T] = 0.125 * k + (k > 3 ? 0.75 : 0) + (k > 8 ? 1 : 0) + (k > 12 ? 1 : 0);
    noted(&of, &f, "log.csv: 3 gaps in time, the widest of 1.125 s before line 11 (usual step 0.125 s)");
}

static void test_angles(void)
{
    const moray_swim_log_format f = usual();
    moray_swim_log_format said = f;
    table of = sound();
    of.at[2][PHI + 1] = -2 * M_PI;
    noted(&of, &f, "");
    of.at[2][PHI + 1] = -6.3;
    refused(&of, names, &f,
            "log.csv:4: phi, number 2: -6.3 rad is an angle beyond 2 pi: is it in deg? Say --units phi=deg (or phi=rad "
            "if it is right)");
    said.units = "phi=rad";
    noted(&of, &said, "");
    said.reference = true;
    said.units = NULL;
    refused(&of, "t,phi_ref_1,phi_ref_2,p_x,p_y,heading,u_1,u_2", &said,
            "log.csv:4: phi_ref, number 2: -6.3 rad is an angle beyond 2 pi: is it in deg? Say --units phi_ref=deg (or "
            "phi_ref=rad if it is right)");
    of = sound();
    of.at[5][HEADING] = 7;
    refused(&of, names, &f,
            "log.csv:7: heading: 7 rad is an angle beyond 2 pi: is it in deg? Say --units heading=deg (or heading=rad "
            "if it is right)");
}

// Half of the steps, those without a value or without a way left out.
static void test_speed(void)
{
    const moray_swim_log_format f = usual();
    moray_swim_log_format said = f;
    table of = sound();
    for (int k = 0; k < ROWS; k++)
        of.at[k][T] = 0.125 * k, of.at[k][X] = -0.375 * k, of.at[k][Y] = 0.5 * k;
    noted(&of, &f, ""); // at exactly 5 m/s
    for (int k = 0; k < ROWS; k++)
        of.at[k][X] = -0.75 * k, of.at[k][Y] = k;
    const char *const fast = "log.csv:1: p_x: the robot moves at 10 m/s from row to row, more than 5: is it in mm or "
                             "cm? Say --units p_x=mm,p_y=mm (or p_x=m if it is right)";
    refused(&of, names, &f, fast);
    said.units = "p_x=m";
    noted(&of, &said, "");
    of.at[7][Y] = of.at[8][X] = NAN;
    refused(&of, names, &f, fast);
    for (int k = 0; k < ROWS; k++)
        of.at[k][X] = -0.75 * (k / 3 * 3), of.at[k][Y] = k / 3 * 3; // two of three rows do not move
    refused(&of, names, &f,
            "log.csv:1: p_x: the robot moves at 30 m/s from row to row, more than 5: is it in mm or cm? Say --units "
            "p_x=mm,p_y=mm (or p_x=m if it is right)");
}

static void test_channels(void)
{
    const table of = sound();
    const moray_swim_log_format f = usual();
    refused(&of, "t,phi_1,phi_2,p_x,q,heading,u_1,u_2", &f, "log.csv:1: p_x without p_y: a position has both");
    refused(&of, "t,phi_1,phi_2,q,p_y,heading,u_1,u_2", &f, "log.csv:1: p_y without p_x: a position has both");
    refused(&of, "t,phi_1,phi_2,a,b,c,d,e", &f,
            "log.csv:1: nothing is measured: needs p_x and p_y, or heading, or u_1 ... u_2 beside t and the joints");
    static const char *const one_of_them[] = {"t,phi_1,phi_2,p_x,p_y,c,d,e", "t,phi_1,phi_2,a,b,heading,d,e",
                                              "t,phi_1,phi_2,a,b,c,u_1,u_2"};
    for (int k = 0; k < 3; k++) {
        moray_swim_log log;
        put(&of, one_of_them[k]);
        CHECK_OK(moray_swim_log_read(&log, path, &f), one_of_them[k]);
        CHECK(!log.p_x == (k != 0) && !log.p_y == (k != 0) && !log.heading == (k != 1) && !log.u == (k != 2),
              "%s: that alone is there", one_of_them[k]);
        moray_swim_log_free(&log);
    }
}

// ---- Notes ---------------------------------------------------------------------------------------------------------

static void test_notes(void)
{
    const moray_swim_log_format f = usual();
    table of = sound();
    for (int k = 0; k < ROWS; k++)
        of.at[k][PHI] = -0.0125 + 0.001 * (k % 2), of.at[k][PHI + 1] = 0.0025 * (k % 3 - 1);
    noted(&of, &f, "log.csv: no joint angle is beyond 0.716 deg: is the unit right?");
    of.at[3][PHI] = -0.02;
    noted(&of, &f, "");
    of = sound();
    for (int k = 0; k < ROWS; k++)
        of.at[k][PHI + 1] = k % 5 == 4 ? NAN : -0.25;
    noted(&of, &f,
          "log.csv: joint 2 is at -14.32 deg in every row: does it move?\nlog.csv: phi has no value in 4 of 48 places");
    of = sound();
    of.at[4][X] = of.at[7][X] = of.at[8][X] = of.at[0][Y] = of.at[0][HEADING] = of.at[1][HEADING] = NAN;
    of.at[ROWS - 1][U] = of.at[ROWS - 1][U + 1] = of.at[5][U] = of.at[6][U + 1] = NAN;
    noted(&of, &f,
          "log.csv: p_x has no value in 3 of 24 places\nlog.csv: p_y has no value in 1 of 24 places\n"
          "log.csv: heading has no value in 2 of 24 places\nlog.csv: u has no value in 4 of 48 places");
}

// Jumps of turns go, from the first value on, across what is missing.
static void test_unwrapped(void)
{
    const moray_swim_log_format f = usual();
    table of = sound();
    moray_swim_log log;
    double worst = 0;
    for (int k = 0; k < ROWS; k++)
        of.at[k][HEADING] = k == 0 || k == 9 ? NAN : remainder(2.5 + 0.45 * k, 2 * M_PI);
    put(&of, names);
    CHECK_OK(moray_swim_log_read(&log, path, &f), "a heading that wraps");
    for (int k = 1; k < ROWS; k++)
        if (k != 9)
            worst = tap_worse(worst, fabs(log.heading[k] - 2.5 - 0.45 * k));
    CHECK(worst < 1e-12 && isnan(log.heading[0]) && isnan(log.heading[9]), "goes on without jumps: %.1e", worst);
    moray_swim_log_free(&log);
}

// Missing values by their texts, a joint in the first column, and text that is no number.
static void test_texts(void)
{
    static const char *const nothing[] = {"", "nan", "NaN", "na", "NA", "n"};
    const moray_swim_log_format f = usual();
    table of = sound();
    for (int k = 0; k < 6; k++) {
        moray_swim_log log;
        FILE *file = fopen(path, "w");
        fputs("phi_1,t,heading,phi_2\n", file);
        for (int row = 0; row < ROWS; row++)
            fprintf(file, "%.17g,%.17g,%s,%.17g\n", of.at[row][PHI], of.at[row][T], row == 5 ? nothing[k] : "0.5",
                    of.at[row][PHI + 1]);
        fclose(file);
        const moray_status status = moray_swim_log_read(&log, path, &f);
        if (k < 5)
            CHECK(!moray_failed(status) && log.phi[4] == of.at[2][PHI] && log.phi[5] == of.at[2][PHI + 1] &&
                      isnan(log.heading[5]) && log.heading[4] == 0.5 && log.t[3] == of.at[3][T],
                  "\"%s\" is no value: %s", nothing[k], status.text);
        else
            CHECK(status.code == MORAY_INPUT && strstr(status.text, "log.csv:7: ") == status.text, "%s", status.text);
        moray_swim_log_free(&log);
    }
}

// Of a path as long as there is room for, and longer; of a folder that is not there.
static void test_not_saved(void)
{
    const moray_swim_log_format f = usual();
    const table of = sound();
    moray_swim_log log;
    static char name[4300];
    put(&of, names);
    CHECK_OK(moray_swim_log_read(&log, path, &f), "a log");
    moray_status status = moray_swim_log_save(&log, "nowhere/log.csv");
    CHECK(status.code == MORAY_IO && strcmp(status.text, "log nowhere/log.csv: No such file or directory") == 0, "%s",
          status.text);
    for (int longer = 0; longer < 2; longer++) {
        memset(name, 'x', sizeof name);
        name[4195 + longer] = 0;
        status = moray_swim_log_save(&log, name);
        CHECK(status.code == (longer ? MORAY_INPUT : MORAY_IO), "%s", status.text);
    }
    moray_swim_log_free(&log);
}

// A log saved is read again to the last bit.
static void test_saved(void)
{
    for (int reference = 0; reference < 2; reference++) {
        moray_swim_log log, again;
        moray_swim_log_format f = usual();
        table of = sound();
        f.reference = reference;
        of.at[3][Y] = NAN;
        put(&of, reference ? "t,phi_ref_1,phi_ref_2,p_x,p_y,q,u_1,u_2" : "t,phi_1,phi_2,p_x,p_y,heading,d,e");
        CHECK_OK(moray_swim_log_read(&log, path, &f), "a log");
        CHECK_OK(moray_swim_log_save(&log, path), "saved");
        CHECK_OK(moray_swim_log_read(&again, path, &f), "and read again");
        const size_t size = ROWS * sizeof(double);
        CHECK(memcmp(log.t, again.t, size) == 0 && memcmp(log.phi, again.phi, 2 * size) == 0, "time and joints");
        CHECK(memcmp(log.p_x, again.p_x, size) == 0 && isnan(again.p_y[3]) &&
                  memcmp(log.p_y + 4, again.p_y + 4, size - 4 * sizeof(double)) == 0,
              "positions");
        if (reference)
            CHECK(!again.heading && again.u && memcmp(log.u, again.u, 2 * size) == 0, "torques");
        else
            CHECK(!again.u && again.heading && memcmp(log.heading, again.heading, size) == 0, "headings");
        moray_swim_log_free(&log);
        moray_swim_log_free(&again);
    }
}

int main(void)
{
    char folder[] = "/tmp/moray-log-XXXXXX";
    if (!CHECK(mkdtemp(folder) && chdir(folder) == 0, "a folder"))
        return tap_done();
    test_names();
    test_bad_lists();
    test_time();
    test_gaps();
    test_angles();
    test_speed();
    test_channels();
    test_notes();
    test_unwrapped();
    test_saved();
    test_texts();
    test_not_saved();
    remove(path);
    rmdir(folder);
    return tap_done();
}
