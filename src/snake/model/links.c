// SPDX-License-Identifier: MIT
//
// Robots of unequal links: ratios to the nearest equal robot, so that what changes a coefficient of the robot changes
// it in every link.
#include "snake/model/links.h"

#include <math.h>
#include <string.h>

enum { MEANS = 9 }; // fields of a link that the robot has, the first ones of moray_link

static moray_link equal_link(const moray_robot *robot)
{
    return (moray_link){.l = robot->l,
                        .m = robot->m,
                        .J = robot->J,
                        .c_t = robot->c_t,
                        .c_n = robot->c_n,
                        .mu_n = robot->mu_n,
                        .lambda_1 = robot->lambda_1,
                        .lambda_2 = robot->lambda_2,
                        .lambda_3 = robot->lambda_3};
}

moray_link moray_robot_link(const moray_robot *robot, int i)
{
    moray_link of = equal_link(robot);
    if (!robot->link)
        return of;
    const moray_link ratio = robot->link[i];
    of.fin_c_t = of.c_t * ratio.fin_c_t;
    of.fin_c_n = of.c_n * ratio.fin_c_n;
    of.fin_mu_n = of.mu_n * ratio.fin_mu_n;
    of.l *= ratio.l;
    of.m *= ratio.m;
    of.J *= ratio.J;
    of.c_t *= ratio.c_t;
    of.c_n *= ratio.c_n;
    of.mu_n *= ratio.mu_n;
    of.lambda_1 *= ratio.lambda_1;
    of.lambda_2 *= ratio.lambda_2;
    of.lambda_3 *= ratio.lambda_3;
    of.cm = of.l * ratio.cm;
    of.cb = of.l * ratio.cb;
    of.fin_at = of.l * ratio.fin_at;
    return of;
}

static double over(double value, double mean)
{
    return value == mean ? 1 : value / mean;
}

// A coefficient that no link has stays so.
static double share(double value, double mean)
{
    return mean == 0 ? 0 : over(value, mean);
}

static moray_link ratios(const moray_link *link, const moray_robot *robot)
{
    return (moray_link){.l = over(link->l, robot->l),
                        .m = over(link->m, robot->m),
                        .J = over(link->J, robot->J),
                        .c_t = share(link->c_t, robot->c_t),
                        .c_n = share(link->c_n, robot->c_n),
                        .mu_n = share(link->mu_n, robot->mu_n),
                        .lambda_1 = share(link->lambda_1, robot->lambda_1),
                        .lambda_2 = share(link->lambda_2, robot->lambda_2),
                        .lambda_3 = share(link->lambda_3, robot->lambda_3),
                        .cm = link->cm / link->l,
                        .cb = link->cb / link->l,
                        .fin_c_t = share(link->fin_c_t, robot->c_t),
                        .fin_c_n = share(link->fin_c_n, robot->c_n),
                        .fin_mu_n = share(link->fin_mu_n, robot->mu_n),
                        .fin_at = link->fin_at / link->l};
}

// What the equal robot has of a link: the fin's coefficients with the link's.
static void means_of(const moray_link *link, double of[MEANS])
{
    const double it[MEANS] = {link->l,
                              link->m,
                              link->J,
                              link->c_t + link->fin_c_t,
                              link->c_n + link->fin_c_n,
                              link->mu_n + link->fin_mu_n,
                              link->lambda_1,
                              link->lambda_2,
                              link->lambda_3};
    memcpy(of, it, sizeof it);
}

// Of equal ones the mean is theirs to the last bit.
static void set_means(moray_robot *robot, const moray_link *link)
{
    double *const to[MEANS] = {&robot->l,    &robot->m,        &robot->J,        &robot->c_t,     &robot->c_n,
                               &robot->mu_n, &robot->lambda_1, &robot->lambda_2, &robot->lambda_3};
    double first[MEANS], of[MEANS];
    means_of(&link[0], first);
    for (int k = 0; k < MEANS; k++)
        *to[k] = 0;
    for (int i = 0; i < robot->links; i++) {
        means_of(&link[i], of);
        for (int k = 0; k < MEANS; k++)
            *to[k] += of[k] - first[k];
    }
    for (int k = 0; k < MEANS; k++)
        *to[k] = first[k] + *to[k] / robot->links;
}

void moray_robot_from_links(moray_robot *robot, moray_link *link)
{
    bool equal = true;
    set_means(robot, link);
    const moray_link mean = equal_link(robot);
    for (int i = 0; i < robot->links; i++) {
        link[i].fin_at = link[i].fin_c_t == 0 && link[i].fin_c_n == 0 && link[i].fin_mu_n == 0 ? 0 : link[i].fin_at;
        equal = equal && memcmp(&link[i], &mean, sizeof mean) == 0;
    }
    for (int i = 0; i < robot->links; i++)
        link[i] = ratios(&link[i], robot);
    robot->link = equal ? NULL : link;
}

// ---- What is allowed -----------------------------------------------------------------------------------------------

typedef struct bound {
    const char *name, *place;
    double value, most; // of the absolute value
} bound;

static moray_status check_places(const moray_link *link, int i)
{
    const bound of[] = {{"cm", "its ends", link->cm, link->l},
                        {"cb", "its ends", link->cb, link->l},
                        {"fin_at", "two lengths of its middle", link->fin_at, 4 * link->l}};
    for (unsigned k = 0; k < sizeof of / sizeof *of; k++)
        if (!(fabs(of[k].value) <= of[k].most))
            return moray_error(MORAY_INPUT, "link %d: %s = %g m from its middle: must be within %s, %g to %g m", i + 1,
                               of[k].name, of[k].value, of[k].place, -of[k].most, of[k].most);
    return moray_ok();
}

static moray_status check_link(const moray_link *link, int i)
{
    const struct {
        const char *name;
        double value;
        bool may_be_zero;
    } of[] = {{"l", link->l, false},
              {"m", link->m, false},
              {"J", link->J, false},
              {"c_t", link->c_t, true},
              {"c_n", link->c_n, true},
              {"mu_n", link->mu_n, true},
              {"lambda_1", link->lambda_1, true},
              {"lambda_2", link->lambda_2, true},
              {"lambda_3", link->lambda_3, true},
              {"fin_c_t", link->fin_c_t, true},
              {"fin_c_n", link->fin_c_n, true},
              {"fin_mu_n", link->fin_mu_n, true}};
    for (unsigned k = 0; k < sizeof of / sizeof *of; k++)
        if (!isfinite(of[k].value) || of[k].value < 0 || (of[k].value == 0 && !of[k].may_be_zero))
            return moray_error(MORAY_INPUT, "link %d: %s = %g: must be finite and %s 0", i + 1, of[k].name, of[k].value,
                               of[k].may_be_zero ? "at least" : "above");
    return check_places(link, i);
}

moray_status moray_links_check(const moray_robot *robot)
{
    for (int i = 0; i < robot->links && robot->link; i++) {
        const moray_link link = moray_robot_link(robot, i);
        MORAY_TRY(check_link(&link, i));
    }
    return moray_ok();
}
