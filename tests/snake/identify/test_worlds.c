// SPDX-License-Identifier: MIT
//
// Worlds along the axes of an information that is made by hand, their file, and directions in words.
#include "tap.h"

#include <string.h>
#include <unistd.h>

#include "snake/identify/identify.h"

enum { N = 3 };
static const double half_width = 1.959964;
static const char *const path = "worlds.csv"; // in a folder of the test

// c_t, current_y and camera_x between bounds, with axes that are no coordinates.
static moray_identify made(int unknown[N])
{
    moray_identify v = {.spec = {.n = N, .start = {.robot = moray_robot_paper()}}};
    static const char *const names[N] = {"c_t", "current_y", "camera_x"};
    for (int k = 0; k < N; k++)
        v.unknown[k] = unknown[k] = moray_unknown_named(names[k]);
    memcpy(v.lower, (const double[]){1, -0.3, -3}, sizeof(double[N]));
    memcpy(v.upper, (const double[]){6, 0.25, 2}, sizeof(double[N]));
    memcpy(v.scale, (const double[]){4, 0.1, 0.5}, sizeof(double[N]));
    v.spec.start.camera[1] = 0.7; // not estimated: stays
    v.spec.start.current[0] = -0.2;
    return v;
}

static const double value[N] = {3, -0.1, 0.4};
static const double vector[N][N] = {{0.8, -0.6, 0}, {0.36, 0.48, -0.8}, {0.48, 0.64, 0.6}};
static const double eigenvalue[N] = {100, 25, 16};

static moray_information information(void)
{
    moray_information info = {.n = N};
    memcpy(info.value, eigenvalue, sizeof eigenvalue);
    memcpy(info.vector, vector, sizeof vector);
    return info;
}

static void check_world(moray_unknowns world, const double want[N], const int unknown[N], int index)
{
    for (int i = 0; i < N; i++)
        CHECK_NEAR(*moray_unknown_at(unknown[i], &world), want[i], 1e-14, moray_unknown_name(unknown[i]));
    CHECK(world.camera[1] == 0.7 && world.current[0] == -0.2 && world.robot.c_n == moray_robot_paper().c_n,
          "what is not estimated stays in world %d", index);
}

// The least known axis first, to either end of its interval, as far as half a scale and the bounds let.
static void check_axes(double inflation, int held, int most, int worlds)
{
    int unknown[N];
    const moray_identify v = made(unknown);
    moray_information info = information();
    moray_estimate at = {0};
    moray_unknowns world[2 * N + 1];
    memcpy(at.value, value, sizeof value);
    for (int k = 0; k < held; k++) // those held stand last
        info.held[k] = true;
    const int n = moray_identify_worlds(&v, &at, &info, inflation, most, world);
    CHECK(n == worlds, "%d worlds of at most %d, %d expected", n, most, worlds);
    check_world(world[0], value, unknown, 0);
    for (int w = 1; w < n; w++) {
        const int axis = N - held - (w + 1) / 2;
        const double error = inflation * half_width / sqrt(eigenvalue[axis]);
        double want[N];
        for (int i = 0; i < N; i++) {
            want[i] = value[i] + (w % 2 ? -1 : 1) * (error < 0.5 ? error : 0.5) * vector[axis][i] * v.scale[i];
            want[i] = want[i] < v.lower[i] ? v.lower[i] : want[i] > v.upper[i] ? v.upper[i] : want[i];
        }
        check_world(world[w], want, unknown, w);
    }
}

static void test_axes(void)
{
    check_axes(1, 0, 7, 7);
    check_axes(1, 0, 6, 5);
    check_axes(1, 0, 3, 3);
    check_axes(1, 0, 2, 1);
    check_axes(1, 1, 7, 5);
    check_axes(0.1, 2, 7, 3);
    check_axes(2, 0, 7, 7);
}

// What is open, of no eigenvalue or one that rounding made negative, is gone half a scale along; bounds cut on both
// sides.
static void test_open(void)
{
    for (int k = 0; k < 2; k++) {
        int unknown[N];
        moray_identify v = made(unknown);
        moray_information info = information();
        moray_estimate at = {0};
        moray_unknowns world[3];
        memcpy(at.value, value, sizeof value);
        info.value[2] = k ? -1e-3 : 0;
        v.lower[0] = 2.5, v.upper[1] = -0.08;
        CHECK(moray_identify_worlds(&v, &at, &info, 1, 3, world) == 3, "three worlds");
        check_world(world[1], (const double[]){2.5, -0.1 - 0.5 * 0.64 * 0.1, 0.4 - 0.5 * 0.6 * 0.5}, unknown, 1);
        check_world(world[2], (const double[]){3 + 0.5 * 0.48 * 4, -0.08, 0.4 + 0.5 * 0.6 * 0.5}, unknown, 2);
    }
}

// ---- Files ---------------------------------------------------------------------------------------------------------

static void put(const char *text)
{
    FILE *file = fopen(path, "w");
    fputs(text, file);
    fclose(file);
}

static void test_written(void)
{
    int unknown[N];
    moray_unknowns world[3];
    char text[400] = "";
    for (int w = 0; w < 3; w++)
        world[w] = made(unknown).spec.start, world[w].current[1] = 0.125 * w, world[w].camera[0] = -w,
        world[w].robot.c_t = 4.5 + w;
    FILE *file = fopen(path, "w+");
    moray_worlds_write(world, 3, unknown, N, file);
    rewind(file);
    const size_t length = fread(text, 1, sizeof text - 1, file);
    fclose(file);
    CHECK(length > 0 && strcmp(text, "name,c_t [kg/s],current_y [m/s],camera_x [m]\nidentified,4.5,0,0\n"
                                     "axis_1-,5.5,0.125,-1\naxis_1+,6.5,0.25,-2\n") == 0,
          "%s", text);
}

static moray_status read_worlds(int most, moray_unknowns *world, moray_world_name *name, int *n)
{
    int unknown[N];
    const moray_unknowns base = made(unknown).spec.start;
    return moray_worlds_read(path, &base, most, world, name, n);
}

static void refused(const char *text, const char *says)
{
    moray_unknowns world[2];
    moray_world_name name[2];
    int n;
    put(text);
    const moray_status status = read_worlds(2, world, name, &n);
    CHECK(status.code == MORAY_INPUT && strcmp(status.text, says) == 0, "\"%s\", expected \"%s\"", status.text, says);
}

static void test_read(void)
{
    moray_unknowns world[2];
    moray_world_name name[2];
    int n;
    put("current_x,c_n [kg/s],m[kg]\n0.25,11,1.5\n-0.5,12,1.75\n");
    CHECK_OK(read_worlds(2, world, name, &n), "without names");
    CHECK(n == 2 && strcmp(name[0].text, "row 1") == 0 && strcmp(name[1].text, "row 2") == 0, "%d: %s, %s", n,
          name[0].text, name[1].text);
    CHECK(world[0].current[0] == 0.25 && world[1].current[0] == -0.5 && world[0].robot.c_n == 11 &&
              world[1].robot.c_n == 12 && world[0].robot.m == 1.5 && world[1].robot.m == 1.75,
          "each row its own");
    CHECK(world[1].camera[1] == 0.7 && world[0].robot.c_t == moray_robot_paper().c_t, "the rest is that of the base");
    put("current_x,name\n0.25,calm\n-0.5,of a name that is longer than forty characters\n");
    CHECK_OK(read_worlds(2, world, name, &n), "with names");
    CHECK(n == 2 && strcmp(name[0].text, "calm") == 0 &&
              strcmp(name[1].text, "of a name that is longer than forty cha") == 0 && world[1].current[0] == -0.5 &&
              world[1].current[1] == 0,
          "%s, %s", name[0].text, name[1].text);
    refused("current_x\n1\n2\n3\n", "worlds.csv:4: more than 2 scenarios");
    refused("c_t,c_m\n1,2\n", "worlds.csv:1: column c_m: must be name or what can be identified (c_t, c_n, ..., "
                              "current_x, current_y)");
    put("c_t\n1\n-1\n");
    const moray_status status = read_worlds(2, world, name, &n);
    CHECK(status.code == MORAY_INPUT && strncmp(status.text, "worlds.csv:3: ", 14) == 0 && strstr(status.text, "c_t"),
          "a robot that is none: %s", status.text);
    CHECK(read_worlds(2, world, name, &n).code == MORAY_INPUT && n == 1, "one before it was read");
    remove(path);
    CHECK(read_worlds(2, world, name, &n).code == MORAY_IO && n == 0, "no file");
}

// ---- Directions in words -------------------------------------------------------------------------------------------

// Of eigenvalues [100, known, 1e-4] about three axes, the last two of which may be open.
static void told(const double first[N], bool two, int held, const char *says)
{
    static const char *const names[N] = {"c_n", "m", "current_x"};
    moray_information info = {.n = N, .rank = N - held - 1 - two};
    int unknown[N];
    char text[400] = "before";
    memcpy(info.vector + (N - held - 1) * N, first, sizeof(double[N]));
    if (two)
        info.vector[(N - held - 2) * N + 2] = -1;
    for (int k = 0; k < held; k++)
        info.held[k] = true;
    for (int k = 0; k < N; k++)
        unknown[k] = moray_unknown_named(names[k]);
    moray_information_open(&info, unknown, text, sizeof text);
    CHECK(strcmp(text, says) == 0, "\"%s\", expected \"%s\"", text, says);
}

static void test_told(void)
{
    told((const double[]){-0.6, 0.64, -0.48}, false, 0,
         "c_n, m and current_x only together: they may move by -1.00, +1.07, -0.80 of their scales at once");
    told((const double[]){0.1, -0.8, 0.6}, false, 0,
         "m and current_x only together: they may move by -1.00, +0.75 of their scales at once (what is known is their "
         "sum)");
    told((const double[]){-0.8, 0.1, -0.6}, true, 0,
         "current_x\nc_n and current_x only together: they may move by -1.00, -0.75 of their scales at once (what is "
         "known is their difference or ratio)");
    told((const double[]){0.15, 0.9, 0.16}, false, 1,
         "m and current_x only together: they may move by +1.00, +0.18 of their scales at once (what is known is their "
         "difference or ratio)");
    told((const double[]){0, 0.1, 1}, false, 2, "current_x");
    moray_information none = {.n = 2, .rank = 2};
    char text[20] = "before";
    moray_information_open(&none, (const int[]){0, 1}, text, sizeof text);
    CHECK(text[0] == 0, "nothing is open: %s", text);
}

static void test_names(void)
{
    int n = 0;
    for (; moray_unknown_name(n); n++)
        CHECK(moray_unknown_named(moray_unknown_name(n)) == n && moray_unknown_unit(n), "%s", moray_unknown_name(n));
    CHECK(n == 19 && moray_unknown_named("c") == -1 && moray_unknown_named("c_t_") == -1, "%d names", n);
    moray_robot robot = moray_robot_paper();
    for (int strips = 0; strips < 2; strips++)
        for (int model = 0; model < 2; model++)
            for (int k = 0; k < n; k++) {
                const char *name = moray_unknown_name(k);
                const bool first = model == MORAY_FIRST_PRINCIPLES, torque = strncmp(name, "lambda", 6) == 0;
                robot.hydro.rotation = strips ? MORAY_ROTATION_STRIP : MORAY_ROTATION_PAPER;
                const bool applies = torque                         ? first && !strips
                                     : strcmp(name, "J") == 0       ? first
                                     : strncmp(name, "rot", 3) == 0 ? !first
                                                                    : true;
                CHECK(moray_unknown_applies(k, &robot, (moray_model)model) == applies, "%s: felt by model %d or not",
                      name, model);
            }
}

int main(void)
{
    char folder[] = "/tmp/moray-worlds-XXXXXX";
    if (!CHECK(mkdtemp(folder) && chdir(folder) == 0, "a folder"))
        return tap_done();
    test_axes();
    test_open();
    test_written();
    test_read();
    test_told();
    test_names();
    rmdir(folder);
    return tap_done();
}
