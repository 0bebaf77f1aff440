// SPDX-License-Identifier: MIT
#include "snake/gait/endpoint.h"

#include <math.h>

// 1 / (L cos(delta/2)) of (33), or 1 / (2 sin(delta/2)) of (27)
static moray_num amplitude_reciprocal(const struct gait_endpoint *e, moray_num delta)
{
    return e->revolute ? 1 / (2 * csin(delta / 2)) : 1 / (e->L * ccos(delta / 2));
}

// cot(delta/2) / (2 sin(delta/2) (N-2)) or tan(delta/2) / (L cos(delta/2) (N-2)), what a taper adds across
static moray_num across_taper(const struct gait_endpoint *e, moray_num delta)
{
    const moray_num tangent = ctan(delta / 2);
    return amplitude_reciprocal(e, delta) * (e->revolute ? 1 / tangent : tangent) / (e->links - 2);
}

// Square of the link-angle amplitude at the head (side 1) or the tail (-1): a^2 (r^2 g^2 + p^2 taper^2), where r is
// amplitude_reciprocal, p across_taper and g = 1 + side taper (N-1)/(N-2).
static moray_num end_link_angle(const struct gait_endpoint *e, const moray_num *s, double side)
{
    const moray_num a = s[0], delta = s[2], taper = s[4];
    const moray_num r = amplitude_reciprocal(e, delta) * (1 + side * taper * (e->links - 1) / (e->links - 2));
    const moray_num p = across_taper(e, delta) * taper;
    return a * a * (r * r + p * p);
}

moray_bounds moray_gait_amplitude_bounds(const struct gait_endpoint *e, moray_bounds theta_max)
{
    if (e->revolute)
        return theta_max;
    return moray_between(sin(theta_max.lower), sin(theta_max.upper));
}

// Amplitude of a link angle (12) next to the head (side 1) or the tail (-1): of the end link, which has one joint, or
// of its neighbour, whose two joints are delta apart. Since the taper is linear, no link between swings further than
// these.
static moray_num link_amplitude(const struct gait_endpoint *e, const moray_num *s, double side, bool end)
{
    const moray_num a = s[0], delta = s[2], taper = s[4];
    const moray_num last = 1 + side * taper;
    if (end)
        return a * last / (2 * e->L);
    const moray_num next = last - side * taper * 2 / (e->links - 2);
    return a * csqrt(last * last + next * next + 2 * last * next * ccos(delta)) / (2 * e->L);
}

// The largest link angles to either side, amplitude and offset. Returns how many.
static int link_angle_events(const struct gait_endpoint *e, const moray_num *s, moray_num *out)
{
    int n = 0;
    for (int side = 1; side >= -1; side -= 2)
        for (int joints = 1; joints <= 2 && joints < e->links; joints++) {
            if (side < 0 ? !e->tail : e->tail && !e->head)
                continue;
            const moray_num amplitude = link_amplitude(e, s, side, joints == 1), offset = joints * s[3] / (2 * e->L);
            if (e->left)
                out[n++] = amplitude + offset;
            if (e->right)
                out[n++] = amplitude - offset;
        }
    return n;
}

// The events that not every problem has. Returns how many.
static int optional_events(const struct gait_endpoint *e, const moray_num *s, moray_num power, moray_num speed,
                           moray_num *out)
{
    int n = 0;
    if (!e->series)
        out[n++] = s[0] * amplitude_reciprocal(e, s[2]);
    if (e->head)
        out[n++] = end_link_angle(e, s, 1);
    if (e->tail)
        out[n++] = end_link_angle(e, s, -1);
    if (e->power)
        out[n++] = power;
    if (e->rate && (e->head || !e->tail))
        out[n++] = s[0] * s[1] * (e->head ? 1 + s[4] : 1);
    if (e->rate && e->tail)
        out[n++] = s[0] * s[1] * (1 - s[4]);
    if (e->speed)
        out[n++] = speed;
    return n + link_angle_events(e, s, out + n);
}

void moray_gait_ends(const moray_ends *at, moray_end_values *out, const void *data)
{
    const struct gait_endpoint *e = data;
    const moray_phase_ends *period = &at->phase[0];
    const moray_num *x0 = period->x0, *xf = period->xf, T = period->tf, work = period->q[0];
    const int p = e->position;
    const moray_num dx = xf[p] - x0[p], dy = xf[p + 1] - x0[p + 1];
    const moray_num along = e->course[0] * dx + e->course[1] * dy;
    int n = 0;
    out->objective = e->goal == MORAY_GAIT_FASTEST ? -along / T : (work + e->constant * T) / along;
    for (int r = 0; r < e->nx; r++)
        if (r != p && r != p + 1)
            out->e[n++] = xf[r] - x0[r];
    out->e[n++] = e->course[0] * dy - e->course[1] * dx;
    out->e[n++] = (e->series ? at->s[0] : at->s[1]) * T;
    optional_events(e, at->s, work / T, along / T, out->e + n);
}

int moray_gait_events(const struct gait_endpoint *e)
{
    const moray_num s[MORAY_GAIT_PARAMETERS] = {1, 1, 1};
    moray_num events[GAIT_OPTIONAL_EVENTS];
    return e->nx + optional_events(e, s, 0, 0, events);
}

int moray_gait_power_event(const struct gait_endpoint *e)
{
    return e->nx + !e->series + e->head + e->tail;
}
