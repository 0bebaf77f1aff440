// SPDX-License-Identifier: MIT
#include "sea.h"

// Every law by the median of its trials and by what nine in ten keep below.
moray_status sea_draw_figures(const void *found, moray_output *output)
{
    const sea_job *job = found;
    const sea_law *laws;
    const int n = sea_laws(job, &laws), by = sea_judged_by(job);
    const char *names[SEA_LAWS];
    double row[SEA_LAWS], median[SEA_LAWS], high[SEA_LAWS];
    for (int law = 0; law < n; law++) {
        names[law] = laws[law].name;
        row[law] = law;
        median[law] = sea_quantile(job, law, -1, by, 0.5);
        high[law] = sea_quantile(job, law, -1, by, 0.9);
    }
    const moray_curve curves[] = {{.label = "median of the draws",
                                   .x = median,
                                   .y = row,
                                   .n = n,
                                   .style = MORAY_CURVE_POINTS,
                                   .colour = MORAY_COLOUR_BEST},
                                  {.label = "90th percentile",
                                   .x = high,
                                   .y = row,
                                   .n = n,
                                   .style = MORAY_CURVE_POINTS,
                                   .colour = MORAY_COLOUR_BASELINE}};
    return moray_output_figure(output, &(moray_figure){.name = "trials",
                                                       .title = "Trials under every law",
                                                       .x_label = sea_judged_name(job),
                                                       .y_names = names,
                                                       .n_y_names = n,
                                                       .curves = curves,
                                                       .n_curves = 2});
}
