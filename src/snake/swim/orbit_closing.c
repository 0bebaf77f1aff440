// SPDX-License-Identifier: MIT
#include <stddef.h>
#include <tgmath.h>

#include "moray/num.h"
#include "snake/swim/orbit.h"

// Velocity of the water relative to the axes in which the model has its velocity: body axes at the heading (16), or the
// plane's.
static void water(const moray_orbit_spec *spec, moray_num heading, moray_num V[2])
{
    const moray_num angle = spec->model == MORAY_CONTROL_ORIENTED ? heading : 0;
    const moray_num c = cos(angle), s = sin(angle);
    V[0] = spec->current[0] * c + spec->current[1] * s;
    V[1] = spec->current[1] * c - spec->current[0] * s;
}

// in = [x(0), x(T), p, w]. The axes of a velocity in the plane lag behind the body by the turn.
static void close_orbit(void *self, const moray_num *in, moray_num *out)
{
    const moray_orbit_spec *spec = self;
    const moray_num *x0 = in, *xT = in + ORBIT_STATES, turn = spec->steered ? 0 : in[ORBIT_ENDS];
    const moray_num lag = spec->model == MORAY_CONTROL_ORIENTED ? 0 : turn, c = cos(lag), s = sin(lag);
    const double course[2] = {cos(spec->course), sin(spec->course)};
    moray_num V0[2], VT[2];
    water(spec, x0[0], V0);
    water(spec, xT[0], VT);
    out[0] = x0[1];
    out[1] = x0[2];
    out[2] = xT[0] - x0[0] - turn;
    out[3] = xT[3] - x0[3];
    out[4] = xT[4] - VT[0] - c * (x0[4] - V0[0]) + s * (x0[5] - V0[1]);
    out[5] = xT[5] - VT[1] - s * (x0[4] - V0[0]) - c * (x0[5] - V0[1]);
    out[6] = -(xT[1] - x0[1]) * course[1] + (xT[2] - x0[2]) * course[0];
}

moray_status moray_orbit_closing(moray_orbit *orbit)
{
    double probe[ORBIT_ENDS + 1]; // where the pattern is looked for: anywhere but at zeros
    const int n_in = ORBIT_ENDS + !orbit->spec.steered;
    for (int k = 0; k < n_in; k++)
        probe[k] = 0.3 + 0.07 * k;
    return moray_map_from_complex(&orbit->closing, n_in, ORBIT_STATES + 1, close_orbit, &orbit->spec, NULL, probe);
}
