#include "sensitivity.h"
#include <stdio.h>
moray_status sensitivity_report(gait_job *job)
{
    sensitivity *run = (sensitivity *)job;
    for (int k = 0; k < run->rows; k++) {
        sensitivity_row *r = &run->row[k];
        printf("%-20s %10.4g %s\n", r->name, r->value, r->unit);
        for (int i = 0; i < SLOPES; i++) printf(" %12.5g", r->slope[i]);
        printf("\n");
        for (int i = 0; i < SLOPES; i++) printf(" %12.5g", r->again[i]);
        printf("\n");
        for (int i = 0; i < 2; i++) printf(" %12.5g", r->swum[i]);
        printf("  dev %.2e  [%g %s | %g %s]\n", r->deviation, r->down.step, r->down.what, r->up.step, r->up.what);
    }
    printf("weak: %s\nunreached: %s\n", run->weak, run->unreached);
    return moray_ok();
}
