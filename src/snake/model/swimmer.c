// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "snake/model/model.h"
#include "snake/model/torque.h"

struct moray_swimmer {
    moray_robot robot;
    moray_model kind;
    const snake_model *model;
    double current[2];
    moray_swimmer_extra_fn *extra; // NULL: none
    void *scratch;                 // of the model
    double *reference;             // phi, phi_ref and their rates, N-1 each
    torque_limit torque;
    double *real; // accelerations of the joints, N-1, where torques are limited
};

static const snake_model *model_of(moray_model model)
{
    return model == MORAY_CONTROL_ORIENTED ? &moray_control_model : &moray_fp_model;
}

moray_status moray_swimmer_new(moray_swimmer **swimmer, const moray_robot *robot, moray_model model)
{
    *swimmer = NULL;
    MORAY_TRY(moray_robot_check(robot));
    moray_swimmer *made = calloc(1, sizeof *made);
    if (made == NULL)
        return moray_error(MORAY_MEMORY, "a swimmer of %d links: no memory", robot->links);
    made->robot = *robot;
    made->kind = model;
    made->model = model_of(model);
    made->scratch = malloc(made->model->scratch_bytes(robot->links));
    made->reference = malloc(4 * (size_t)(robot->links - 1) * sizeof(double));
    if (made->scratch == NULL || made->reference == NULL) {
        moray_swimmer_free(made);
        return moray_error(MORAY_MEMORY, "a swimmer of %d links: no memory", robot->links);
    }
    if (made->model->prepare)
        made->model->prepare(&made->robot, made->scratch);
    *swimmer = made;
    return moray_ok();
}

void moray_swimmer_free(moray_swimmer *swimmer)
{
    if (swimmer == NULL)
        return;
    free(swimmer->scratch);
    free(swimmer->reference);
    free(swimmer->torque.room);
    free(swimmer);
}

moray_status moray_swimmer_set_robot(moray_swimmer *swimmer, const moray_robot *robot)
{
    MORAY_TRY(moray_robot_check(robot));
    if (robot->links != swimmer->robot.links)
        return moray_error(MORAY_INPUT, "links = %d: the swimmer was made for %d", robot->links, swimmer->robot.links);
    swimmer->robot = *robot;
    if (swimmer->model->prepare)
        swimmer->model->prepare(&swimmer->robot, swimmer->scratch);
    return moray_ok();
}

const moray_robot *moray_swimmer_robot(const moray_swimmer *swimmer)
{
    return &swimmer->robot;
}

moray_model moray_swimmer_model(const moray_swimmer *swimmer)
{
    return swimmer->kind;
}

int moray_swimmer_states(const moray_swimmer *swimmer)
{
    return 2 * swimmer->robot.links + 4;
}

void moray_swimmer_set_current(moray_swimmer *swimmer, double V_x, double V_y)
{
    swimmer->current[0] = V_x;
    swimmer->current[1] = V_y;
}

void moray_swimmer_current(const moray_swimmer *swimmer, double V[2])
{
    V[0] = swimmer->current[0];
    V[1] = swimmer->current[1];
}

void moray_swimmer_set_extra(moray_swimmer *swimmer, moray_swimmer_extra_fn *extra)
{
    swimmer->extra = extra;
}

moray_status moray_swimmer_set_torque(moray_swimmer *swimmer, double most)
{
    const int n = swimmer->robot.links - 1;
    if (!(most >= 0))
        return moray_error(MORAY_INPUT, "torque = %g N m: must be at least 0", most);
    if (most > 0 && swimmer->kind != MORAY_FIRST_PRINCIPLES)
        return moray_error(MORAY_INPUT, "torque = %g N m: the control-oriented model has no torques", most);
    if (most > 0 && !swimmer->torque.room) {
        swimmer->torque.room = malloc((TORQUE_ROOM(n) + (size_t)n) * sizeof(double));
        if (!swimmer->torque.room)
            return moray_error(MORAY_MEMORY, "torques of %d joints: no memory", n);
        swimmer->real = swimmer->torque.room + TORQUE_ROOM(n);
    }
    swimmer->torque.n = n;
    swimmer->torque.most = most;
    return moray_ok();
}

double moray_swimmer_torque(const moray_swimmer *swimmer)
{
    return swimmer->torque.most;
}

void moray_swimmer_rest(const moray_swimmer *swimmer, double theta, double p_x, double p_y, double *x)
{
    swimmer->model->rest(swimmer->robot.links, theta, p_x, p_y, x);
}

void moray_swimmer_joints(const moray_swimmer *swimmer, const double *x, double *phi, double *v_phi)
{
    swimmer->model->joints(swimmer->robot.links, x, phi, v_phi);
}

void moray_state_body(moray_model model, int links, const double *x, double body[MORAY_BODY_STATES])
{
    model_of(model)->body(links, x, body);
}

void moray_swimmer_on_gait(const moray_swimmer *swimmer, const moray_gait *gait, double t,
                           const double body[MORAY_BODY_STATES], double *x)
{
    const int n = swimmer->robot.links - 1;
    double *phi = swimmer->reference, *v_phi = phi + n;
    moray_gait_reference(gait, n, t, phi, v_phi, v_phi + n);
    swimmer->model->assemble(n + 1, phi, v_phi, body, x);
}

void moray_swimmer_with_joints(const moray_swimmer *swimmer, const double *phi, const double *v_phi,
                               const double body[MORAY_BODY_STATES], double *x)
{
    swimmer->model->assemble(swimmer->robot.links, phi, v_phi, body, x);
}

static bool all_finite(const double *values, int n)
{
    for (int i = 0; i < n; i++)
        if (!isfinite(values[i]))
            return false;
    return true;
}

typedef struct state {
    moray_swimmer *swimmer;
    const double *x;
    double *dx; // scratch
} state;

static bool efforts(void *self, const double *ubar, double *u)
{
    const state *at = self;
    moray_swimmer *swimmer = at->swimmer;
    return swimmer->model->rates(&swimmer->robot, swimmer->current, at->x, ubar, at->dx, u, swimmer->scratch);
}

bool moray_swimmer_rates(moray_swimmer *swimmer, const double *x, const double *ubar, double *dx, double *u)
{
    state at = {swimmer, x, dx};
    bool regular = true;
    if (swimmer->torque.most > 0) {
        memcpy(swimmer->real, ubar, (size_t)swimmer->torque.n * sizeof *ubar);
        regular = moray_torque_limited(&swimmer->torque, efforts, &at, swimmer->real);
        ubar = swimmer->real;
    }
    regular = efforts(&at, ubar, u) && regular;
    if (swimmer->extra)
        swimmer->extra(swimmer, x, dx);
    return regular && all_finite(dx, moray_swimmer_states(swimmer)) &&
           (u == NULL || all_finite(u, swimmer->robot.links - 1));
}

bool moray_swimmer_water_forces(moray_swimmer *swimmer, const double *x, const double *ubar, double *along,
                                double *across)
{
    const snake_model *model = swimmer->model;
    const int N = swimmer->robot.links;
    return model->water && model->water(&swimmer->robot, swimmer->current, x, ubar, along, across, swimmer->scratch) &&
           all_finite(along, N) && all_finite(across, N);
}

double moray_swimmer_power(const moray_swimmer *swimmer, const double *u, const double *v_phi)
{
    const moray_motor *motor = &swimmer->robot.motor;
    const bool fitted = motor->fitted && swimmer->kind == MORAY_FIRST_PRINCIPLES;
    double power = 0;
    for (int i = 0; i < swimmer->robot.links - 1; i++)
        power += fitted ? moray_motor_power(motor, u[i], v_phi[i]) : u[i] * v_phi[i];
    return power;
}

void moray_swimmer_control(const moray_swimmer *swimmer, const moray_gait *gait, double t, const double *x,
                           double *ubar)
{
    const int n = swimmer->robot.links - 1;
    const double k_p = swimmer->robot.k_p, k_d = swimmer->robot.k_d;
    double *phi = swimmer->reference, *v_phi = phi + n, *phi_ref = v_phi + n, *dphi_ref = phi_ref + n;
    moray_swimmer_joints(swimmer, x, phi, v_phi);
    moray_gait_reference(gait, n, t, phi_ref, dphi_ref, ubar);
    for (int i = 0; i < n; i++) // (34)
        ubar[i] += k_d * (dphi_ref[i] - v_phi[i]) + k_p * (phi_ref[i] - phi[i]);
}

moray_pose moray_swimmer_pose(const moray_swimmer *swimmer, const double *x)
{
    return swimmer->model->pose(&swimmer->robot, x);
}

double moray_swimmer_half_length(const moray_swimmer *swimmer, int i)
{
    const moray_robot *robot = &swimmer->robot;
    return swimmer->kind == MORAY_FIRST_PRINCIPLES ? moray_robot_link(robot, i).l : robot->l;
}

void moray_swimmer_links(const moray_swimmer *swimmer, const double *x, double *x_i, double *y_i, double *angle_i)
{
    swimmer->model->links(&swimmer->robot, x, x_i, y_i, angle_i);
}
