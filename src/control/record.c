// SPDX-License-Identifier: MIT
#include <stdlib.h>
#include <string.h>

#include "moray/control/closed_loop.h"

moray_status moray_closed_loop_record_new(moray_closed_loop_record *record, int nx, int nu, int capacity)
{
    *record = (moray_closed_loop_record){0};
    if (nx < 0 || nu < 0 || capacity < 0)
        return moray_error(MORAY_INPUT, "record of %d states, %d controls, %d samples: must be at least 0", nx, nu,
                           capacity);
    const size_t n = (size_t)capacity;
    record->t = calloc(n * (1 + (size_t)nx + (size_t)nu) + 1, sizeof *record->t);
    if (!record->t)
        return moray_error(MORAY_MEMORY, "no memory for a record of %d samples", capacity);
    record->x = record->t + n;
    record->u = record->x + n * (size_t)nx;
    record->capacity = capacity;
    record->nx = nx;
    record->nu = nu;
    return moray_ok();
}

void moray_closed_loop_record_free(moray_closed_loop_record *record)
{
    free(record->t);
    *record = (moray_closed_loop_record){0};
}

bool moray_closed_loop_record_add(const moray_closed_loop_sample *sample, void *self)
{
    moray_closed_loop_record *record = self;
    if (record->n >= record->capacity)
        return false;
    const size_t k = (size_t)record->n++, nx = (size_t)record->nx, nu = (size_t)record->nu;
    record->t[k] = sample->t;
    memcpy(record->x + k * nx, sample->x, nx * sizeof *record->x);
    if (nu > 0) // a sample without controls may point nowhere
        memcpy(record->u + k * nu, sample->u, nu * sizeof *record->u);
    return true;
}
