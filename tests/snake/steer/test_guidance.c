// SPDX-License-Identifier: MIT
//
// Line of sight along a path with a bend, by hand: the course further on, the distance across, and its integral.
#include "tap.h"

#include "moray/snake/path.h"

static moray_swim_sample sample_at(double x, double y)
{
    return (moray_swim_sample){.t = 3, .pose = {.p_x = x, .p_y = y}};
}

// Before the bend, where the place looked at lies in it or beyond.
static void test_target(void)
{
    moray_path path;
    CHECK_OK(moray_path_read(&path, "0,0 4,0 4,5", 1), "a path");
    static const double places[][2] = {{1, 0.3}, {2.4, -0.5}, {3.1, 0.2}, {4.3, 2.5}, {3.8, 4}};
    for (int k = 0; k < 5; k++) {
        for (int ahead = 0; ahead < 3; ahead++) {
            moray_guidance guidance = {
                .path = &path, .lookahead = 1.4, .ahead = 0.7 * ahead, .gain = 0.3, .period = 0.25, .integral = -0.6};
            const moray_swim_sample sample = sample_at(places[k][0], places[k][1]);
            double along = 0, across; // sought from there
            moray_path_project(&path, places[k][0], places[k][1], &along, &across);
            const double course = creal(moray_path_at(&path, along + 0.7 * ahead).course), bent = across - 0.3 * 0.6;
            CHECK_NEAR(moray_guidance_target(&sample, &guidance), course - atan2(bent, 1.4), 1e-14, "heading to steer");
            CHECK_NEAR(guidance.integral, -0.6 + 0.25 * 1.4 * across / (bent * bent + 1.96), 1e-14, "integral");
            CHECK(fabs(guidance.along - along) < 1e-12, "along the path: %g m", guidance.along);
        }
    }
    moray_path_free(&path);
}

// Until the end of the path.
static void test_seek(void)
{
    moray_path path;
    CHECK_OK(moray_path_read(&path, "0,0 2,0", 1), "a leg");
    moray_path_seeker seeker = {.path = &path};
    const moray_swim_sample before = sample_at(1.5, 0.4), end = sample_at(2, -0.1), beyond = sample_at(2.5, 0);
    CHECK(moray_path_seek(&before, &seeker) && seeker.along == 1.5, "on its way");
    CHECK(!moray_path_seek(&end, &seeker) && seeker.along == 2, "at the end");
    CHECK(!moray_path_seek(&beyond, &seeker), "beyond it");
    moray_path_free(&path);
}

int main(void)
{
    test_target();
    test_seek();
    return tap_done();
}
