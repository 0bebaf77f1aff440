// SPDX-License-Identifier: MIT
#include "snake/swim/options_links.h"

#include <math.h>
#include <string.h>

enum { LISTS = sizeof(moray_link_lists) / sizeof(moray_link_list) };

// In the order of moray_link_lists; what is given for all links in its place, where that can be told from a default.
static const struct {
    const char *key, *all;
    size_t given; // in moray_robot
} lists_of[LISTS] = {{"link_length_m", "l_m", offsetof(moray_robot, l)},
                     {"link_a_e_m", NULL, 0},
                     {"link_b_e_m", NULL, 0},
                     {"link_m_kg", "m_kg", offsetof(moray_robot, m)},
                     {"link_J_kg_m2", "J_kg_m2", offsetof(moray_robot, J)},
                     {"link_c_t", "c_t", offsetof(moray_robot, c_t)},
                     {"link_c_n", "c_n", offsetof(moray_robot, c_n)},
                     {"link_mu_n", "mu_n", offsetof(moray_robot, mu_n)},
                     {"link_lambda_1", "lambda_1", offsetof(moray_robot, lambda_1)},
                     {"link_lambda_2", "lambda_2", offsetof(moray_robot, lambda_2)},
                     {"link_lambda_3", "lambda_3", offsetof(moray_robot, lambda_3)},
                     {"link_cm_m", NULL, 0},
                     {"link_cb_m", NULL, 0},
                     {"fin_c_t", NULL, 0},
                     {"fin_c_n", NULL, 0},
                     {"fin_mu_n", NULL, 0},
                     {"fin_at_m", NULL, 0}};

static const double *list_at(const moray_link_lists *lists, int k)
{
    return (const double *)lists + (size_t)k * MORAY_MOST_LINKS;
}

void moray_links_none(moray_link_lists *lists)
{
    double *number = (double *)lists;
    for (int k = 0; k < LISTS * MORAY_MOST_LINKS; k++)
        number[k] = NAN;
}

bool moray_links_listed(const moray_link_lists *lists)
{
    bool any = false;
    for (int k = 0; k < LISTS; k++)
        any = any || !isnan(list_at(lists, k)[0]);
    return any;
}

static moray_status check(const moray_link_lists *lists, const moray_robot *given)
{
    for (int k = 0; k < LISTS; k++) {
        const double *list = list_at(lists, k);
        int n = 0;
        while (n < MORAY_MOST_LINKS && !isnan(list[n]))
            n++;
        if (n > 0 && n != given->links)
            return moray_error(MORAY_INPUT,
                               "%s: %d numbers where the robot has links = %d: must be one for each link, from link 1, "
                               "the tail, on (k*X for k alike)",
                               lists_of[k].key, n, given->links);
        if (n > 0 && lists_of[k].all && !isnan(*(const double *)((const char *)given + lists_of[k].given)))
            return moray_error(MORAY_INPUT, "%s: is given for all links by %s, too: one of the two", lists_of[k].key,
                               lists_of[k].all);
    }
    return moray_ok();
}

void moray_link_of_geometry(moray_robot *robot, const moray_link_geometry *geometry, const moray_robot *given)
{
    const moray_robot all = *given;
    moray_robot_from_geometry(robot, geometry);
    double *const to[] = {&robot->l,    &robot->m,        &robot->J,        &robot->c_t,     &robot->c_n,
                          &robot->mu_n, &robot->lambda_1, &robot->lambda_2, &robot->lambda_3};
    const double from[] = {all.l, all.m, all.J, all.c_t, all.c_n, all.mu_n, all.lambda_1, all.lambda_2, all.lambda_3};
    if (!isnan(all.m))
        robot->J *= all.m / robot->m; // of the same shape
    for (unsigned i = 0; i < sizeof from / sizeof *from; i++)
        if (!isnan(from[i]))
            *to[i] = from[i];
}

// The list's number, else that for all links.
static double listed(const double *list, int i, double all)
{
    return isnan(list[0]) ? all : list[i];
}

static moray_link make_link(const moray_link_lists *lists, const moray_link_geometry *geometry,
                            const moray_robot *given, int i)
{
    moray_link_geometry of = *geometry;
    moray_robot own = *given, made = *given;
    of.length = listed(lists->length, i, of.length);
    of.a_e = listed(lists->a_e, i, of.a_e);
    of.b_e = listed(lists->b_e, i, of.b_e);
    own.m = listed(lists->m, i, own.m);
    own.J = listed(lists->J, i, own.J);
    own.c_t = listed(lists->c_t, i, own.c_t);
    own.c_n = listed(lists->c_n, i, own.c_n);
    own.mu_n = listed(lists->mu_n, i, own.mu_n);
    own.lambda_1 = listed(lists->lambda_1, i, own.lambda_1);
    own.lambda_2 = listed(lists->lambda_2, i, own.lambda_2);
    own.lambda_3 = listed(lists->lambda_3, i, own.lambda_3);
    moray_link_of_geometry(&made, &of, &own);
    made.link = NULL;
    moray_link link = moray_robot_link(&made, i);
    link.cm = listed(lists->cm, i, 0);
    link.cb = listed(lists->cb, i, 0);
    link.fin_c_t = listed(lists->fin_c_t, i, 0);
    link.fin_c_n = listed(lists->fin_c_n, i, 0);
    link.fin_mu_n = listed(lists->fin_mu_n, i, 0);
    link.fin_at = listed(lists->fin_at, i, 0);
    return link;
}

moray_status moray_links_make(const moray_link_lists *lists, const moray_link_geometry *geometry,
                              const moray_robot *given, moray_link *link)
{
    MORAY_TRY(check(lists, given));
    for (int i = 0; i < given->links; i++)
        link[i] = make_link(lists, geometry, given, i);
    return moray_ok();
}

// ---- Telling -------------------------------------------------------------------------------------------------------

const char *moray_snake_links_text(const moray_robot *robot, char text[MORAY_LINKS_TEXT])
{
    text[0] = 0;
    moray_text_add(text, MORAY_LINKS_TEXT, robot->link ? "%d unequal links" : "%d links", robot->links);
    if (robot->link)
        moray_text_add(text, MORAY_LINKS_TEXT,
                       " (the control-oriented model swims the nearest equal robot: as long, as heavy, with as much "
                       "drag and added "
                       "mass in all, links of %.4g m and %.4g kg)",
                       2 * robot->l, robot->m);
    if (robot->motor.fitted)
        moray_text_add(text, MORAY_LINKS_TEXT,
                       " with motors (the control-oriented model, whose joints are not rotary, has none)");
    return text;
}

static void link_to_json(moray_json *json, const char *key, const moray_link *link)
{
    moray_json_object(json, key,
                      MORAY_MEMBERS({"length_m", 2 * link->l}, {"m_kg", link->m}, {"J_kg_m2", link->J},
                                    {"c_t", link->c_t}, {"c_n", link->c_n}, {"mu_n", link->mu_n},
                                    {"lambda_1", link->lambda_1}, {"lambda_2", link->lambda_2},
                                    {"lambda_3", link->lambda_3}, {"cm_m", link->cm}, {"cb_m", link->cb},
                                    {"fin_c_t", link->fin_c_t}, {"fin_c_n", link->fin_c_n},
                                    {"fin_mu_n", link->fin_mu_n}, {"fin_at_m", link->fin_at}));
}

static void robot_to_json(moray_json *json, const moray_robot *robot)
{
    moray_json_open(json, "robot");
    moray_json_number(json, "links", robot->links);
    if (robot->link) {
        moray_robot equal = *robot;
        equal.link = NULL;
        const moray_link mean = moray_robot_link(&equal, 0);
        moray_json_open_list(json, "link");
        for (int i = 0; i < robot->links; i++) {
            const moray_link link = moray_robot_link(robot, i);
            link_to_json(json, NULL, &link);
        }
        moray_json_close(json);
        link_to_json(json, "nearest_equal_link", &mean);
    }
    moray_json_close(json);
}

void moray_snake_to_json(moray_json *json, const moray_snake_options *options)
{
    moray_json_text(json, "model", moray_model_key(options->model));
    robot_to_json(json, &options->robot);
    moray_json_numbers(json, "current_m_s", options->current, 2);
}
