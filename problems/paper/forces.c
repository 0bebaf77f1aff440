// SPDX-License-Identifier: MIT
#include "forces.h"

const char *const term_names[TERMS] = {"I", "II", "III", "IV", "V", "VI", "VII", "VIII"};

void force_terms_of_link(const moray_robot *robot, const double current[2], const chain_link *link, double term[TERMS])
{
    const double c = cos(link->theta[0]), s = sin(link->theta[0]), w = link->theta[1];
    const double mu_n = robot->mu_n, c_t = robot->c_t, c_n = robot->c_n;
    const double Fa_11 = mu_n * s * s, Fa_12 = -mu_n * s * c;                    // (3)
    const double Far_11 = mu_n * s * c * w, Far_12 = mu_n * s * s * w;           //
    const double Fd_11 = c_t * c * c + c_n * s * s, Fd_12 = (c_t - c_n) * s * c; //
    term[0] = -Fa_11 * link->x[2];
    term[1] = -Fa_12 * link->y[2];
    term[2] = -Fd_11 * link->x[1];
    term[3] = -Fd_12 * link->y[1];
    term[4] = Far_11 * current[0];
    term[5] = Far_12 * current[1];
    term[6] = Fd_11 * current[0];
    term[7] = Fd_12 * current[1];
}

// Adds up one sample; magnitude[j] is the sum of |term j| over the links.
static void add_sample(const moray_robot *robot, const chain *c, int k, force_terms *f, double magnitude[TERMS])
{
    double term[TERMS], total = 0;
    for (int i = 0; i < c->N; i++) {
        force_terms_of_link(robot, c->current, &c->link[k * c->N + i], term);
        for (int j = 0; j < TERMS; j++) {
            f->over_time[j * CHAIN_POINTS + k] += term[j];
            total += term[j];
            if (k == 0)
                f->at_once[j * c->N + i] = term[j];
            if (k == CHAIN_PERIOD)
                continue;
            f->of_link[j * c->N + i] += term[j] / CHAIN_PERIOD;
            magnitude[j] += fabs(term[j]) / CHAIN_PERIOD;
        }
    }
    f->residual = fmax(f->residual, fabs(total - c->force[k]));
}

static void summarise(force_terms *f, const double magnitude[TERMS])
{
    for (int j = 0; j < TERMS; j++) {
        double sum = 0;
        for (int k = 0; k < CHAIN_PERIOD; k++) {
            const double at = fabs(f->over_time[j * CHAIN_POINTS + k]);
            sum += at / CHAIN_PERIOD;
            f->peak[j] = fmax(f->peak[j], at);
        }
        f->mean[j] = chain_mean(f->over_time + j * CHAIN_POINTS);
        f->cancelled[j] = magnitude[j] > 0 ? 1 - sum / magnitude[j] : NAN;
        f->thrust += fmax(f->mean[j], 0);
    }
    for (int j = 0; j < TERMS; j++)
        f->share[j] = f->mean[j] / f->thrust;
}

moray_status force_terms_of(paper *p, const chain *c, force_terms *f)
{
    double magnitude[TERMS] = {0};
    *f = (force_terms){.residual = 0};
    MORAY_TRY(paper_numbers(p, CHAIN_POINTS * TERMS, &f->over_time));
    MORAY_TRY(paper_numbers(p, (size_t)(c->N * TERMS), &f->of_link));
    MORAY_TRY(paper_numbers(p, (size_t)(c->N * TERMS), &f->at_once));
    for (int k = 0; k < CHAIN_POINTS; k++)
        add_sample(p->robot, c, k, f, magnitude);
    summarise(f, magnitude);
    return moray_ok();
}
