// SPDX-License-Identifier: MIT
//
// The ground robot as a special case (Sec. I, end of Sec. III-C): no added mass, no current, no fluid torque, viscous
// friction in place of drag. Both models over the amplitude, at two ratios of the friction coefficients.
#include "swim.h"

enum { AMPLITUDES = 8, RATIOS = 2 };
static const double theta_max_deg[AMPLITUDES] = {5, 10, 15, 20, 25, 30, 35, 40};
static const double ratios[RATIOS] = {3, 10}; // c_n/c_t
static const double FRICTION = 1;             // c_t [kg/s]

static moray_robot ground_robot(const paper *p, double ratio)
{
    moray_robot robot = *p->robot;
    robot.mu_n = robot.lambda_1 = robot.lambda_2 = robot.lambda_3 = 0;
    robot.c_t = FRICTION;
    robot.c_n = ratio * FRICTION;
    return robot;
}

// Mean speed where Assumption 4 stands in for Assumption 5, which adds c_n theta_i^2 to the drag along the links: (16b)
// is then linear in v_t with the mean force -c_p mean(phi^T A Dbar phi'), as long as the joints sum up to zero, which
// they do with delta = 2 pi/(N-1).
static double assumption_4_speed(const moray_robot *robot, const moray_gait *gait)
{
    const int N = robot->links;
    double sum = 0; // of A Dbar_ij sin((i-j) delta), where Dbar_kj = (N-1-j)/N for k <= j and -(j+1)/N below
    for (int i = 0; i < N - 1; i++)
        for (int j = 0; j < N - 1; j++) {
            const double above = (double)(N - 1 - j) / N, below = -(double)(j + 1) / N;
            sum += ((i <= j ? above : below) + (i + 1 <= j ? above : below)) * sin((i - j) * gait->delta);
        }
    const double c_p = (robot->c_n - robot->c_t) / (4 * robot->l), a = gait->amplitude;
    return -c_p * a * a * gait->omega / 2 * sum / (N * robot->c_t);
}

// Steady speeds over the amplitude, and by how much the simplified ones exceed the first-principles ones.
typedef struct {
    double speed[2][AMPLITUDES], simpler[AMPLITUDES];      // by model [m/s]; control-oriented with Assumption 4
    double excess[AMPLITUDES], simpler_excess[AMPLITUDES]; // [%]
} findings;

static moray_status crawl(paper *p, double ratio, findings *f)
{
    const moray_robot robot = ground_robot(p, ratio);
    moray_swimmer *swimmer[2];
    for (int model = 0; model < 2; model++)
        MORAY_TRY(paper_swimmer(p, &robot, (moray_model)model, p->settings->reading, &swimmer[model]));
    for (int i = 0; i < AMPLITUDES; i++) {
        paper_progress(p, "c_n/c_t = %g, theta_max %g deg", ratio, theta_max_deg[i]);
        for (int model = 0; model < 2; model++) {
            const moray_gait gait = paper_gait(p, (moray_model)model, theta_max_deg[i] * DEG);
            const moray_swim_setup setup = {.swimmer = swimmer[model], .settings = p->rig.settings};
            moray_steady steady;
            MORAY_TRY(moray_swim_steady(&setup, &gait, 0, &steady, NULL, 0));
            f->speed[model][i] = steady.speed;
            if (model == MORAY_CONTROL_ORIENTED)
                f->simpler[i] = assumption_4_speed(&robot, &gait);
        }
        const double truth = f->speed[MORAY_FIRST_PRINCIPLES][i];
        f->excess[i] = 100 * (f->speed[MORAY_CONTROL_ORIENTED][i] / truth - 1);
        f->simpler_excess[i] = 100 * (f->simpler[i] / truth - 1);
    }
    return moray_ok();
}

static moray_status tell(paper *p, double ratio, const findings *f)
{
    moray_table_row rows[AMPLITUDES];
    for (int i = 0; i < AMPLITUDES; i++)
        rows[i] = (moray_table_row){.label = paper_label(p, "theta_max %g deg", theta_max_deg[i]),
                                    .value = {f->speed[MORAY_FIRST_PRINCIPLES][i], f->speed[MORAY_CONTROL_ORIENTED][i],
                                              f->excess[i], f->simpler[i], f->simpler_excess[i]}};
    moray_json_open(p->json, paper_label(p, "ratio_%g", ratio));
    moray_json_numbers(p->json, "theta_max_deg", theta_max_deg, AMPLITUDES);
    moray_json_numbers(p->json, "speed_fp_m_s", f->speed[MORAY_FIRST_PRINCIPLES], AMPLITUDES);
    moray_json_numbers(p->json, "speed_control_m_s", f->speed[MORAY_CONTROL_ORIENTED], AMPLITUDES);
    moray_json_numbers(p->json, "excess_percent", f->excess, AMPLITUDES);
    moray_json_numbers(p->json, "excess_assumption_4_percent", f->simpler_excess, AMPLITUDES);
    moray_json_close(p->json);
    return paper_rows(p, paper_label(p, "Speed on the ground in m/s, c_t = %g kg/s, c_n = %g c_t", FRICTION, ratio),
                      PAPER_HEADS("first-principles", "control-oriented", "excess [%]", "with Ass. 4", "excess [%]"),
                      rows, AMPLITUDES);
}

static moray_status draw(paper *p, double ratio, const findings *f)
{
    const char *const labels[] = {moray_model_name(MORAY_FIRST_PRINCIPLES), moray_model_name(MORAY_CONTROL_ORIENTED),
                                  "control-oriented with Assumption 4 in place of 5"};
    const moray_column columns[] = {
        {"theta_max", "deg", theta_max_deg, 1},
        {"speed first-principles", "m/s", f->speed[MORAY_FIRST_PRINCIPLES], 1},
        {"speed control-oriented", "m/s", f->speed[MORAY_CONTROL_ORIENTED], 1},
        {"speed control-oriented with Assumption 4", "m/s", f->simpler, 1},
    };
    return paper_draw(p,
                      &(paper_graph){paper_label(p, "%g", ratio), paper_label(p, "Ground robot, c_n/c_t = %g", ratio),
                                     "theta_max [deg]", "speed [m/s]", columns, 4, AMPLITUDES,
                                     .style = MORAY_CURVE_MARKED, .labels = labels});
}

// The last amplitude up to which all errors stay within the bound; 0 where none does.
static double covered_to(const double *excess, double percent)
{
    double covered = 0;
    for (int i = 0; i < AMPLITUDES && fabs(excess[i]) <= percent; i++)
        covered = theta_max_deg[i];
    return covered;
}

moray_status paper_ground(paper *p)
{
    for (int r = 0; r < RATIOS; r++) {
        findings f;
        MORAY_TRY(crawl(p, ratios[r], &f));
        MORAY_TRY(tell(p, ratios[r], &f));
        MORAY_TRY(paper_say(p,
                            "At c_n = %g c_t the control-oriented model's speed is within 5 %% of the first-principles "
                            "model's up to %g deg; with Assumption 4 in place of 5, up to %g deg.",
                            ratios[r], covered_to(f.excess, 5), covered_to(f.simpler_excess, 5)));
        MORAY_TRY(draw(p, ratios[r], &f));
    }
    return moray_ok();
}
