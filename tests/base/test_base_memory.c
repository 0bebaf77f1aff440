// SPDX-License-Identifier: MIT
//
// Every allocation of maps, tables and readers fails once, each by itself: that is told, and all that was had is freed.
// Argument: an object of functions after CasADi's convention.
#include "allocations.h"

#include <complex.h>
#include <string.h>
#include <unistd.h>

#include "base/colouring.h"
#include "base/numeric_map.h"
#include "base/triplets.h"
#include "moray/casadi.h"
#include "moray/dense.h"
#include "moray/parallel.h"
#include "moray/table.h"
#include "moray/water.h"

static const char *object;
static char spline_path[] = "/tmp/moray-spline-XXXXXX", surface_path[] = "/tmp/moray-surface-XXXXXX",
            water_path[] = "/tmp/moray-water-XXXXXX";

// ---- Maps ----------------------------------------------------------------------------------------------------------

static void complex_pair(void *self, const double complex *x, double complex *out)
{
    (void)self;
    out[0] = x[0] * x[1] + (creal(x[1]) > 5 ? x[2] * x[2] : 0);
    out[1] = x[2];
}

static void real_pair(void *self, const double *x, double *out)
{
    (void)self;
    out[0] = x[0] * x[1] + (x[1] > 5 ? x[2] * x[2] : 0);
    out[1] = x[2];
}

static const double here[] = {0.5, 2, -1}, there[] = {0.5, 6, -1};

// A map whose user's data are a block of its own, checked and widened by another branch.
static moray_status widen(bool real)
{
    moray_map map, wider;
    moray_derivative_report report;
    int found;
    void *data = counted(__real_malloc(1));
    MORAY_TRY(real ? moray_map_from_real(&map, 3, 2, real_pair, data, free, here)
                   : moray_map_from_complex(&map, 3, 2, complex_pair, data, free, here));
    moray_status status = moray_check_derivatives(&map, here, here, &report);
    if (!moray_failed(status))
        status = moray_map_widened(&wider, &map, there, 1, &found);
    if (!moray_failed(status))
        moray_map_release(&wider);
    moray_map_release(&map);
    return status;
}

static moray_status widen_complex(void)
{
    return widen(false);
}

static moray_status widen_real(void)
{
    return widen(true);
}

static moray_status join(void)
{
    moray_map one, other, map;
    MORAY_TRY(moray_map_from_complex(&one, 3, 2, complex_pair, NULL, NULL, here));
    const moray_status status = moray_map_from_real(&other, 3, 2, real_pair, NULL, NULL, here);
    if (moray_failed(status)) {
        moray_map_release(&one);
        return status;
    }
    MORAY_TRY(moray_map_join(&map, &one, (int[]){0, 1, 2}, &other, 1));
    moray_map_release(&map);
    return moray_ok();
}

// With all derivatives, with slopes alone, with none, and of an output of no entries.
static moray_status open_object(void)
{
    static const char *const names[] = {"wire", "half", "bare", "couple"};
    for (int k = 0; k < 4; k++) {
        moray_map map;
        MORAY_TRY(moray_map_from_casadi(&map, &(moray_casadi_spec){.path = object, .name = names[k]}));
        moray_map_release(&map);
    }
    return moray_ok();
}

static moray_status add_up(void)
{
    static double values[3000];
    triplets t;
    moray_triplets_record(&t);
    for (int k = 0; k < 3000; k++) // more than the first room
        triplets_put(&t, k, k % 7, 1);
    MORAY_TRY(moray_triplets_close(&t));
    moray_triplets_start(&t, values);
    moray_triplets_free(&t);
    return moray_ok();
}

// ---- Tables --------------------------------------------------------------------------------------------------------

static void write_text(char *path, const char *text)
{
    FILE *file = fdopen(mkstemp(path), "w");
    fputs(text, file);
    fclose(file);
}

static moray_status read_spline(void)
{
    moray_spline *spline;
    const moray_status status = moray_spline_read(&spline, spline_path, "x", "y", MORAY_NATURAL, MORAY_HOLD);
    CHECK(moray_failed(status) == !spline, "a spline or none");
    moray_spline_free(spline);
    return status;
}

static moray_status read_surface(void)
{
    moray_surface *surface;
    const moray_status status = moray_surface_read(&surface, surface_path, "x", "y", "z", MORAY_NATURAL, MORAY_HOLD);
    CHECK(moray_failed(status) == !surface, "a surface or none");
    moray_surface_free(surface);
    return status;
}

static moray_status read_water(void)
{
    moray_water *water;
    const moray_status status = moray_water_read(&water, water_path);
    CHECK(moray_failed(status) == !water, "a current or none");
    moray_water_free(water);
    return status;
}

// ---- Numbers -------------------------------------------------------------------------------------------------------

static moray_status find_eigenvalues(void)
{
    const double A[] = {2, 1, 1, 3};
    double value[2], vector[4];
    double complex lambda[2];
    MORAY_TRY(moray_eigenvalues(2, A, lambda));
    return moray_symmetric_eigen(2, A, value, vector);
}

static moray_status colour(void)
{
    static const bool touches[] = {true, false, true, true};
    int group[2], groups;
    return moray_colour_columns(touches, 2, 2, group, &groups);
}

static void square(int task, void *result, void *self)
{
    (void)self;
    *(int *)result = task * task;
}

static moray_status share_out(void)
{
    for (int jobs = 2; jobs < 4; jobs++) {
        int results[4];
        MORAY_TRY(moray_parallel(4, sizeof *results, results, square, NULL, jobs));
        for (int k = 0; k < 4; k++)
            if (results[k] != k * k)
                return moray_error(MORAY_NUMERIC, "task %d gives %d", k, results[k]);
    }
    return moray_ok();
}

int main(int argc, char **argv)
{
    object = argc > 1 ? argv[1] : "";
    write_text(spline_path, "x,y\n0,1\n1,2\n3,5\n4,1\n");
    write_text(surface_path, "x,y,z\n0,0,1\n0,1,2\n1,0,3\n1,1,5\n");
    write_text(water_path, "x_m,y_m,t_s,v_x_m_s,v_y_m_s\n0,0,0,1,2\n0,1,0,1,2\n1,0,0,1,2\n1,1,0,1,3\n"
                           "0,0,1,1,2\n0,1,1,1,2\n1,0,1,1,2\n1,1,1,2,3\n");
    fail_each("a complex map", false, widen_complex);
    fail_each("a real map", false, widen_real);
    fail_each("two maps joined", false, join);
    fail_each("a map of an object", false, open_object);
    fail_each("entries added up", false, add_up);
    fail_each("a spline from a file", false, read_spline);
    fail_each("a surface from a file", false, read_surface);
    fail_each("a current from a file", false, read_water);
    fail_each("eigenvalues", false, find_eigenvalues);
    fail_each("groups of columns", false, colour);
    fail_each("tasks, which one process can do", true, share_out);
    unlink(spline_path), unlink(surface_path), unlink(water_path);
    CHECK(uneven == 0, "what a run takes it frees, but for %ld", uneven);
    return tap_done();
}
