// SPDX-License-Identifier: MIT
//
// What came of a gait job, in words.
#include <math.h>

#include "job.h"

enum { text_size = GAIT_TEXT };

static double percent(double value, double reference)
{
    const double change = 100 * (value / reference - 1);
    return fabs(change) < 0.005 ? 0 : change; // no -0.00
}

const char *gait_job_kind(const gait_job *job, const stage *at)
{
    if (at == &job->ladder)
        return "gait optimised for the ladder";
    return at->model == MORAY_CONTROL_ORIENTED ? "control-oriented optimum" : "first-principles optimum";
}

static bool beyond(const gait_job *job, double omega)
{
    const double rounding = 1e-3;
    return omega > job->omega[1] * (1 + rounding) || omega < job->omega[0] * (1 - rounding);
}

void gait_job_say_beyond(const gait_job *job, double omega, char *text, size_t size)
{
    if (beyond(job, omega))
        moray_text_add(text, size, " (at omega = %.4g deg/s, beyond the %.4g to %.4g allowed)", omega / DEG,
                       job->omega[0] / DEG, job->omega[1] / DEG);
}

void gait_job_verdict(const gait_job *job, const stage *at, char *text, size_t size)
{
    int further = 0;
    moray_ladder_verdict(at->ladder, at->found_on, text, size);
    for (int k = 0; k < MORAY_RUNGS; k++)
        further += beyond(job, at->ladder[k].omega);
    if (further > 0)
        moray_text_add(text, size, "; equal power takes an omega beyond the %.4g to %.4g deg/s allowed on %d of them",
                       job->omega[0] / DEG, job->omega[1] / DEG, further);
}

// "at the paper gait's power there (0.2646 W) it is 4.03 % faster" and "at its speed ... it needs 7.65 % less power",
// the first with "than the paper's gait" behind it.
static void say_gain(const gait_job *job, const moray_gait_gain *gain, bool speed, bool first, char *text)
{
    const moray_steady *there = &job->paper.steady[MORAY_FIRST_PRINCIPLES];
    const char *whose = first ? "the paper gait's" : "its", *than = first ? " than the paper's gait" : "";
    const double faster = gain->speed_percent_at_equal_power, more = gain->power_percent_at_equal_speed;
    if (speed)
        moray_text_add(text, text_size, "at %s power%s (%.4f W) it is %.2f %% %s%s", whose, first ? " there" : "",
                       there->power, fabs(faster), faster < 0 ? "slower" : "faster", than);
    else
        moray_text_add(text, text_size, "at %s speed%s (%.4f m/s) it needs %.2f %% %s power%s", whose,
                       first ? " there" : "", there->speed, fabs(more), more < 0 ? "less" : "more", than);
    gait_job_say_beyond(job, speed ? gain->omega_at_equal_power : gain->omega_at_equal_speed, text, text_size);
}

// The gain on the first-principles model, first that which the goal is about, and beside it what the model of the stage
// predicts.
static void judge(const gait_job *job, const stage *at, char *text)
{
    const bool fastest = job->goal == MORAY_GAIT_FASTEST;
    const double faster = at->gain.speed_percent_at_equal_power, less = -at->gain.power_percent_at_equal_speed;
    const double gain = fastest ? faster : less, other = fastest ? less : faster;
    const moray_steady *here = &job->paper.steady[at->model];
    if (isnan(gain)) {
        moray_text_add(text, text_size, "no comparison at equal %s on the first-principles model: %.250s",
                       fastest ? "power" : "speed", fastest ? at->gain.why_no_speed.text : at->gain.why_no_power.text);
        return;
    }
    moray_text_add(text, text_size, "%s on the first-principles model: ",
                   gain < -0.05  ? "LOSES"
                   : gain > 0.05 ? "wins"
                                 : "neither wins nor loses");
    say_gain(job, &at->gain, fastest, true, text);
    if (!isnan(other)) {
        moray_text_add(text, text_size, ", ");
        say_gain(job, &at->gain, !fastest, false, text);
    }
    moray_text_add(text, text_size, ". The %s model itself predicted %+.2f %% speed for %+.2f %% power",
                   moray_model_name(at->model), percent(at->prediction.speed, here->speed),
                   percent(at->prediction.power, here->power));
}

void gait_job_headline(const gait_job *job, char *text)
{
    const double nothing = 5e-4;
    const stage *at = recommended(job);
    const moray_gait *gait = &at->trial.gait[MORAY_FIRST_PRINCIPLES];
    const double theta_max =
        moray_theta_max_from_amplitude(&job->snake.robot, MORAY_FIRST_PRINCIPLES, gait->amplitude, gait->delta);
    char baseline[64];
    moray_text_add(
        text, text_size,
        "Recommended: the %s, theta_max %.4g deg, delta %.4g deg, omega %.4g deg/s. In speed at the power of "
        "%s it ",
        gait_job_kind(job, at), theta_max / DEG, gait->delta / DEG, gait->omega / DEG,
        gait_job_baseline(job, baseline));
    gait_job_verdict(job, at, text, text_size);
    moray_text_add(text, text_size, ".");
    if (at == &job->ladder && moray_gait_over_gain(at->solution) < nothing)
        moray_text_add(text, text_size, " No gait was found that gains on all of %.100s.", job->over);
}

void gait_job_say_stage(const gait_job *job, const stage *at, char *text)
{
    text[0] = 0;
    moray_text_add(text, text_size, "The %s ", gait_job_kind(job, at));
    gait_job_verdict(job, at, text, text_size);
    moray_text_add(text, text_size, "; ");
    judge(job, at, text);
    moray_text_add(text, text_size, ".");
}

moray_judgement gait_job_judge(int passed, int n, char *text)
{
    snprintf(text, 80, "%s: %d of %d gaits pass", passed == n ? "Solved and certified" : "Certificate failed", passed,
             n);
    return passed == n ? MORAY_JUDGED_PASS : MORAY_JUDGED_FAIL;
}
