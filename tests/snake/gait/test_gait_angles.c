// SPDX-License-Identifier: MIT
//
// Limits of link angles where an offset turns the links: as events of a gait in closed form, against the wave itself
// and against the form whose joints are states.
#include "tap.h"

#include <math.h>
#include <string.h>

#include "gait_ends.h"
#include "gait_optimum.h"

enum { MOST_LINKS = 12, SAMPLES = 20000 };

// Largest angle (12) of any link to the left (sign 1) or the right (-1), from the joints' motion (25) over a period.
static double largest_angle(const struct gait_endpoint *ends, const moray_gait *gait, int sign)
{
    const int n = ends->links - 1;
    double phi[MOST_LINKS], rate[MOST_LINKS], acceleration[MOST_LINKS], most = -INFINITY;
    for (int k = 0; k < SAMPLES; k++) {
        moray_gait_reference(gait, n, 2 * M_PI / gait->omega * k / SAMPLES, phi, rate, acceleration);
        for (int i = 0; i <= n; i++)
            most = fmax(most, sign * ((i > 0 ? phi[i - 1] : 0) + (i < n ? phi[i] : 0)) / (2 * ends->L));
    }
    return most;
}

// Largest of the link angles among the events, by their names.
static double largest_event(const struct gait_endpoint *ends, const double *out, const char *to)
{
    gait_name text[32];
    const char *name[32];
    double most = -INFINITY;
    moray_gait_event_names(ends, text, name);
    for (int i = 0; i < moray_gait_events(ends); i++)
        if (strstr(name[i], "link of the") && strstr(name[i], to))
            most = fmax(most, out[1 + i]);
    return most;
}

// Any gait of any number of links, with the taper and the offset that its limits allow.
static void test_wave(int links, int tapers, int sides)
{
    struct gait_endpoint ends = {.nx = 6,
                                 .position = 1,
                                 .course = {1, 0},
                                 .L = 0.14,
                                 .links = links,
                                 .head = tapers & 1,
                                 .tail = tapers & 2,
                                 .left = sides & 1,
                                 .right = sides & 2};
    unsigned long long seed = (unsigned long long)(links + 100 * tapers + 1000 * sides);
    for (int trial = 0; trial < 4; trial++) {
        const moray_gait gait = {.amplitude = tap_random(&seed, 0.01, 0.1),
                                 .omega = tap_random(&seed, 0.5, 4),
                                 .delta = tap_random(&seed, 0.1, 3),
                                 .offset = tap_random(&seed, sides & 2 ? -0.03 : 0, sides & 1 ? 0.03 : 0),
                                 .taper = tap_random(&seed, tapers & 2 ? -1 : 0, tapers & 1 ? 1 : 0)};
        double in[15 + MORAY_GAIT_PARAMETERS] = {[6] = 1, [13] = 2}, out[32];
        moray_gait_to_parameters(&gait, in + 15);
        gait_ends(&ends, in, MORAY_GAIT_PARAMETERS, out);
        for (int left = 0; left < 2; left++) {
            const double event = largest_event(&ends, out, left ? "left" : "right");
            const double angle = largest_angle(&ends, &gait, left ? 1 : -1);
            CHECK(sides & (left ? 1 : 2) ? fabs(event / angle - 1) < 1e-6 : isinf(event),
                  "%d links, taper %.3g, delta %.3g: largest link angle to the %s %.9g, of the events %.9g", links,
                  gait.taper, gait.delta, left ? "left" : "right", angle, event);
        }
    }
}

// A current across the course is met by an offset, which takes of the link angle what the wave may no longer have: the
// same in both forms.
static void test_forms(double across)
{
    moray_gait_problem_spec spec = default_spec(MORAY_CONTROL_ORIENTED, MORAY_INFINITY);
    spec.limits.link_angles = true;
    spec.limits.omega = moray_between(30 * DEG, 100 * DEG); // no faster, so that the amplitude is used
    spec.limits.taper = moray_between(-0.3, 0.3);
    spec.current[1] = across;
    const struct outcome six = solve(&spec, "lobatto5", 20);
    const moray_gait *gait = &six.prediction.gait;
    const struct gait_endpoint ends = {.L = 2 * spec.robot.l, .links = spec.robot.links};
    const double left = largest_angle(&ends, gait, 1), right = largest_angle(&ends, gait, -1);
    CHECK(six.certificate.pass, "certificate: %s", six.certificate.why);
    CHECK(fabs(gait->offset) > 1e-4 && (gait->offset > 0) == (across < 0), "an offset meets the current: %.3g m",
          gait->offset);
    CHECK(fabs(left - right) > 0.1 * DEG, "which turns the links to one side: %.4g deg, %.4g deg to the other",
          left / DEG, right / DEG);
    CHECK_NEAR(fmax(left, right) / DEG, 20, 1e-4, "the largest link angle is at its limit at some time");
    spec.joints = MORAY_JOINTS_CLOSED_LOOP;
    const struct outcome closed = solve(&spec, "lobatto5", 40);
    CHECK_RELATIVE(closed.prediction.speed, six.prediction.speed, 2e-4,
                   "the speed where 24 states have the limits at nodes, and six at any time");
    CHECK(closed.prediction.speed > six.prediction.speed - 1e-8,
          "what holds at any time is no weaker: %.9g m/s, %.9g at the nodes", six.prediction.speed,
          closed.prediction.speed);
}

int main(void)
{
    for (int links = 2; links <= MOST_LINKS; links += links < 4 ? 1 : 4)
        for (int tapers = 0; tapers < (links > 2 ? 4 : 1); tapers++)
            for (int sides = 1; sides < 4; sides++)
                test_wave(links, tapers, sides);
    test_forms(0.1);
    test_forms(-0.1);
    return tap_done();
}
