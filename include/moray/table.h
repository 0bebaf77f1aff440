// SPDX-License-Identifier: MIT
//
// Functions given by numbers: splines of one and two arguments with two continuous derivatives, for use in user
// functions. A table is constant once made: any number of threads may read it.
#ifndef MORAY_TABLE_H
#define MORAY_TABLE_H

#include "moray/export.h"
#include "moray/num.h"
#include "moray/status.h"

MORAY_BEGIN

typedef enum moray_table_ends {
    MORAY_NOT_A_KNOT, // the first two and the last two pieces are one cubic each
    MORAY_NATURAL,    // no curvature at the ends
    MORAY_MONOTONE    // of one argument: slopes lessened where the spline would leave the order of its numbers (Fritsch
                      // and Carlson); the second derivative jumps at the numbers then
} moray_table_ends;

// What the function is outside of its range.
typedef enum moray_table_outside {
    MORAY_HOLD,   // its value at the end: a kink there
    MORAY_LINEAR, // straight on, by the slope at the end
    MORAY_NAN     // not a number, which a solver takes as outside of the domain
} moray_table_outside;

typedef struct moray_spline moray_spline;
typedef struct moray_surface moray_surface;

// Through y[n] at ascending x[n], n >= 2 (2 numbers: straight, 3: a parabola unless natural). Copies both. Error:
// MORAY_INPUT naming the number that does not ascend or is not finite; MORAY_MEMORY.
MORAY_API moray_status moray_spline_new(moray_spline **spline, int n, const double *x, const double *y,
                                        moray_table_ends ends, moray_table_outside outside);
MORAY_API void moray_spline_free(moray_spline *spline);

// The columns named x and y of comma-separated values, whose first line is names (a unit in brackets may follow), x
// ascending. Error: those of moray_spline_new; MORAY_IO; MORAY_INPUT naming the line, or the column that is missing.
MORAY_API moray_status moray_spline_read(moray_spline **spline, const char *path, const char *x, const char *y,
                                         moray_table_ends ends, moray_table_outside outside);

// The first and the last number that it was made from.
MORAY_API void moray_spline_range(const moray_spline *spline, double range[2]);

// Value at x, with first and second derivatives in d[2] unless NULL; the second is that of the right at a jump.
MORAY_API double moray_spline_real(const moray_spline *spline, double x, double *d);

// Through z[nx][ny] over ascending x[nx] and y[ny]: a cubic spline in each direction of splines in the other.
MORAY_API moray_status moray_surface_new(moray_surface **surface, int nx, const double *x, int ny, const double *y,
                                         const double *z, moray_table_ends ends, moray_table_outside outside);
MORAY_API void moray_surface_free(moray_surface *surface);

// From lines x, y, z in any order that fill a grid. Errors as of moray_spline_read, and of a point that is missing or
// stands twice.
MORAY_API moray_status moray_surface_read(moray_surface **surface, const char *path, const char *x, const char *y,
                                          const char *z, moray_table_ends ends, moray_table_outside outside);

// Value at (x, y), with d[5] = dx, dy, dxx, dxy, dyy unless NULL.
MORAY_API double moray_surface_real(const moray_surface *surface, double x, double y, double *d);

#ifndef __cplusplus
// The same for complex step: the piece is that of the real part, and derivatives of any order along imaginary parts
// come out of its polynomial.
MORAY_API moray_num moray_spline_at(const moray_spline *spline, moray_num x);
MORAY_API moray_num moray_surface_at(const moray_surface *surface, moray_num x, moray_num y);
#endif

MORAY_END

#endif
