// SPDX-License-Identifier: MIT
//
// Tables of currents, and the fields that they are made of.
#ifndef TESTS_WATER_TABLE_H
#define TESTS_WATER_TABLE_H

#include <stdio.h>

#include "moray/water.h"
#include "tap.h"

typedef void water_field(double x, double y, double t, double V[2]);

// A polynomial of degree 3 in each argument, which splines of not-a-knot ends repeat.
static inline void water_cubic(double x, double y, double t, double V[2])
{
    V[0] = 0.1 + 0.02 * y - 0.003 * y * y * x + 0.001 * t * x;
    V[1] = -0.05 + 0.004 * x * x - 0.002 * t * t * y + 0.0005 * x * x * x;
}

static inline void water_uniform(double x, double y, double t, double V[2])
{
    (void)x, (void)y, (void)t;
    V[0] = 0.1;
    V[1] = -0.07;
}

// x from -3 to 4.5, y from -2 to 2, and with several times t from 0 in steps of 0.7, the last of them first.
static inline moray_water *water_table(const char *path, water_field *of, int times)
{
    FILE *file = fopen(path, "w");
    fprintf(file, times > 1 ? "t_s,x_m,y_m,v_x_m_s,v_y_m_s\n" : "x_m,y_m,v_x_m_s,v_y_m_s\n");
    for (int k = times - 1; k >= 0; k--)
        for (int i = 0; i < 6; i++)
            for (int j = 0; j < 5; j++) {
                const double x = -3 + i * (1 + 0.1 * i), y = -2 + j, t = 0.7 * k;
                double V[2];
                of(x, y, t, V);
                if (times > 1)
                    fprintf(file, "%.17g,", t);
                fprintf(file, "%.17g,%.17g,%.17g,%.17g\n", x, y, V[0], V[1]);
            }
    fclose(file);
    moray_water *water;
    CHECK_OK(moray_water_read(&water, path), "a table of currents");
    return water;
}

#endif
