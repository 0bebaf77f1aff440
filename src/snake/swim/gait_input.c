// SPDX-License-Identifier: MIT
#include "moray/snake/gait_input.h"

#include "moray/angle.h"

static const double AGREE = 1e-6; // relative difference of two that say the same

moray_gait_input moray_gait_input_default(void)
{
    return (moray_gait_input){.theta_max = NAN,
                              .a = NAN,
                              .alpha = NAN,
                              .omega = 120 * MORAY_DEGREE,
                              .delta = 40 * MORAY_DEGREE,
                              .phi0_m = NAN,
                              .phi0 = NAN};
}

// Something given: as it stands in its unit, and what it comes to in the model.
typedef struct {
    const char *key;
    double given, value;
} statement;

// The value that all statements agree on; `otherwise` where none is given.
static moray_status agree(const statement *said, int n, double otherwise, double *value)
{
    const statement *first = NULL;
    *value = otherwise;
    for (int i = 0; i < n; i++) {
        if (isnan(said[i].given))
            continue;
        if (first && fabs(said[i].value - *value) > AGREE * fabs(*value))
            return moray_error(MORAY_INPUT, "%s = %.10g contradicts %s = %.10g: give one of them", said[i].key,
                               said[i].given, first->key, first->given);
        if (first)
            continue;
        first = &said[i];
        *value = said[i].value;
    }
    return moray_ok();
}

// A joint amplitude in the terms of another model, through (27) and (33). NaN where the link angle that it stands for
// is no less than a right angle: the prismatic joints cannot show it.
static double convert(const moray_robot *robot, moray_model from, moray_model to, double amplitude, double delta)
{
    if (from == to)
        return amplitude;
    const double theta_max = moray_theta_max_from_amplitude(robot, from, amplitude, delta);
    return fabs(theta_max) < M_PI / 2 ? moray_amplitude_from_theta_max(robot, to, theta_max, delta) : NAN;
}

static moray_status amplitude_of(const moray_gait_input *input, const moray_robot *robot, moray_model model,
                                 double *amplitude)
{
    const double delta = input->delta;
    const statement said[] = {
        {"theta_max_deg", input->theta_max / MORAY_DEGREE,
         moray_amplitude_from_theta_max(robot, model, input->theta_max, delta)},
        {"a_m", input->a, convert(robot, MORAY_CONTROL_ORIENTED, model, input->a, delta)},
        {"alpha_deg", input->alpha / MORAY_DEGREE, convert(robot, MORAY_FIRST_PRINCIPLES, model, input->alpha, delta)},
    };
    for (int i = 0; i < 3; i++)
        if (!isnan(said[i].given) && isnan(said[i].value))
            return moray_error(
                MORAY_INPUT,
                "%s = %.10g: no link-angle amplitude below 90 deg belongs to it at delta_deg = %.10g, so "
                "it cannot be mapped to the %s model",
                said[i].key, said[i].given, delta / MORAY_DEGREE, moray_model_name(model));
    return agree(said, 3, moray_amplitude_from_theta_max(robot, model, 20 * MORAY_DEGREE, delta), amplitude);
}

// The offset in the other model of one in the model whose gait has this amplitude.
static double offset_from(const moray_robot *robot, moray_model model, const moray_gait *gait, double other_offset)
{
    const moray_model other = model == MORAY_CONTROL_ORIENTED ? MORAY_FIRST_PRINCIPLES : MORAY_CONTROL_ORIENTED;
    moray_gait mapped = moray_gait_map(robot, gait, model, other);
    mapped.offset = other_offset;
    return moray_gait_map(robot, &mapped, other, model).offset;
}

static moray_status offset_of(const moray_gait_input *input, const moray_robot *robot, moray_model model,
                              const moray_gait *gait, double *offset)
{
    statement said[] = {{"phi0_m", input->phi0_m, input->phi0_m},
                        {"phi0_deg", input->phi0 / MORAY_DEGREE, input->phi0}};
    statement *other = &said[model == MORAY_CONTROL_ORIENTED];
    const double given = other->value;
    if (!isnan(given) && given != 0) {
        other->value = offset_from(robot, model, gait, given);
        if (!isfinite(other->value) || other->value == 0)
            return moray_error(MORAY_INPUT,
                               "%s = %.10g: is mapped in the ratio of the joint amplitudes, which this gait has not; "
                               "give %s",
                               other->key, other->given, said[model != MORAY_CONTROL_ORIENTED].key);
    }
    return agree(said, 2, 0, offset);
}

moray_status moray_gait_input_make(const moray_gait_input *input, const moray_robot *robot, moray_model model,
                                   moray_gait *gait)
{
    *gait = (moray_gait){.omega = input->omega, .delta = input->delta, .taper = input->taper};
    MORAY_TRY(amplitude_of(input, robot, model, &gait->amplitude));
    return offset_of(input, robot, model, gait, &gait->offset);
}
