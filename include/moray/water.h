// SPDX-License-Identifier: MIT
//
// A current over place and time: splines through a table, twice continuously differentiable.
#ifndef MORAY_WATER_H
#define MORAY_WATER_H

#include <stdbool.h>

#include "moray/export.h"
#include "moray/num.h"
#include "moray/status.h"

MORAY_BEGIN

typedef struct moray_water moray_water; // constant once made: any number of threads may read it

// From comma-separated values of the columns x_m, y_m, v_x_m_s, v_y_m_s and, where the current changes, t_s: lines in
// any order that fill a grid, which need not be even. One t_s: at all times. Free with moray_water_free. Error:
// MORAY_IO; MORAY_INPUT naming the line, the column, or the point that stands twice; MORAY_MEMORY.
MORAY_API moray_status moray_water_read(moray_water **water, const char *path);
MORAY_API void moray_water_free(moray_water *water); // NULL is allowed

// Ends of the table: x, y, t; of t infinite where the current does not change.
MORAY_API void moray_water_range(const moray_water *water, double low[3], double high[3]);
MORAY_API bool moray_water_covers(const moray_water *water, double x, double y, double t);

// A point of the table's range, as typical as any.
MORAY_API void moray_water_middle(const moray_water *water, double point[3]);

// V_x and V_y [m/s] at a place [m] and a time [s], goes on straight outside of the table.
MORAY_API void moray_water_at(const moray_water *water, double x, double y, double t, double V[2]);

// The same with derivatives of each by x, y, t and xx, xy, yy, xt, yt, tt.
enum { MORAY_WATER_SLOPES = 9 };
MORAY_API void moray_water_slopes(const moray_water *water, double x, double y, double t, double V[2],
                                  double d[2][MORAY_WATER_SLOPES]);

#ifndef __cplusplus // for complex step
MORAY_API void moray_water_at_complex(const moray_water *water, moray_num x, moray_num y, moray_num t, moray_num V[2]);
#endif

MORAY_END

#endif
