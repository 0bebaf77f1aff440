// SPDX-License-Identifier: MIT
//
// Written by hand after CasADi's C convention: the brachistochrone's dynamics of state (x, y, v) and control u, with
// all, some and no derivatives, and functions that break the convention.
#include <math.h>

#define EXPORT __attribute__((visibility("default")))
typedef long long integer;
static const double g = 9.80665;
static int holders, memories, slides;

static const integer state[] = {3, 1, 1}, control[] = {1, 1, 0, 1, 0}; // dense in short, dense in full
static const integer by_state[] = {3, 3, 0, 0, 0, 2, 0, 1}, by_control[] = {3, 1, 0, 3, 0, 1, 2};
static const integer by_both[] = {3, 4, 0, 0, 0, 2, 5, 0, 1, 0, 1, 2};
static const integer nothing[] = {3, 1, 0, 0};
static const integer vv[] = {3, 3, 0, 0, 0, 0}, vu[] = {3, 1, 0, 1, 2}, uv[] = {1, 3, 0, 0, 0, 1, 0}, uu[] = {1, 1, 1};
static const integer state_out[] = {3, 3, 0, 0, 0, 0}, control_out[] = {1, 3, 0, 0, 0, 0};

static int slide(const double **arg, double **res)
{
    const double v = arg[0][2], u = arg[1][0];
    slides++;
    res[0][0] = v * sin(u);
    res[0][1] = -v * cos(u);
    res[0][2] = g * cos(u);
    return 0;
}

// What every function of the file has.
#define FUNCTION(name, ins, outs)                                                                                      \
    EXPORT integer name##_n_in(void);                                                                                  \
    EXPORT integer name##_n_in(void)                                                                                   \
    {                                                                                                                  \
        return ins;                                                                                                    \
    }                                                                                                                  \
    EXPORT integer name##_n_out(void);                                                                                 \
    EXPORT integer name##_n_out(void)                                                                                  \
    {                                                                                                                  \
        return outs;                                                                                                   \
    }                                                                                                                  \
    EXPORT const integer *name##_sparsity_in(integer i);                                                               \
    EXPORT const integer *name##_sparsity_out(integer i);                                                              \
    EXPORT int name(const double **arg, double **res, integer *iw, double *w, int mem)
#define SPARSITY(name, way, ...)                                                                                       \
    EXPORT const integer *name##_sparsity_##way(integer i)                                                             \
    {                                                                                                                  \
        const integer *const all[] = {__VA_ARGS__};                                                                    \
        return i >= 0 && i < (integer)(sizeof all / sizeof *all) ? all[i] : 0;                                         \
    }
#define BODY(name) EXPORT int name(const double **arg, double **res, integer *iw, double *w, int mem)

// ---- All that there may be
FUNCTION(wire, 2, 1);
SPARSITY(wire, in, state, control)
SPARSITY(wire, out, state)
EXPORT void wire_incref(void);
EXPORT void wire_incref(void)
{
    holders++;
}
EXPORT void wire_decref(void);
EXPORT void wire_decref(void)
{
    holders--;
}
EXPORT int wire_checkout(void);
EXPORT int wire_checkout(void)
{
    return memories++;
}
EXPORT void wire_release(int mem);
EXPORT void wire_release(int mem)
{
    memories -= mem >= 0;
}
EXPORT int wire_calls(void);
EXPORT int wire_calls(void)
{
    return slides;
}
EXPORT int wire_balance(void);
EXPORT int wire_balance(void)
{
    return 100 * holders + memories;
}
EXPORT int wire_work(integer *args, integer *results, integer *integers, integer *numbers);
EXPORT int wire_work(integer *args, integer *results, integer *integers, integer *numbers)
{
    *args = 4;
    *results = 3;
    *integers = 2;
    *numbers = 5;
    return 0;
}
BODY(wire)
{
    (void)mem;
    for (int k = 0; k < 2; k++) // what _work asked for may be written to
        iw[k] = k;
    for (int k = 0; k < 5; k++)
        w[k] = k;
    const int failed = slide(arg, res);
    arg[3] = arg[0];
    res[2] = res[0];
    return failed;
}
FUNCTION(jac_wire, 3, 2);
SPARSITY(jac_wire, in, state, control, nothing)
SPARSITY(jac_wire, out, by_state, by_control)
BODY(jac_wire)
{
    const double v = arg[0][2], u = arg[1][0];
    (void)iw, (void)w, (void)mem;
    res[0][0] = sin(u);
    res[0][1] = -cos(u);
    res[1][0] = v * cos(u);
    res[1][1] = v * sin(u);
    res[1][2] = -g * sin(u);
    return 0;
}
FUNCTION(jac_adj1_wire, 4, 8);
SPARSITY(jac_adj1_wire, in, state, control, nothing, state)
SPARSITY(jac_adj1_wire, out, vv, vu, state_out, state_out, uv, uu, control_out, control_out)
BODY(jac_adj1_wire)
{
    const double v = arg[0][2], u = arg[1][0], *weight = arg[3];
    (void)iw, (void)w, (void)mem;
    res[1][0] = weight[0] * cos(u) + weight[1] * sin(u);
    res[4][0] = res[1][0];
    res[5][0] = -weight[0] * v * sin(u) + weight[1] * v * cos(u) - weight[2] * g * cos(u);
    return 0;
}

// ---- A Jacobian in one block, no Hessian
FUNCTION(half, 2, 1);
SPARSITY(half, in, state, control)
SPARSITY(half, out, state)
BODY(half)
{
    return (void)iw, (void)w, (void)mem, slide(arg, res);
}
FUNCTION(jac_half, 3, 1);
SPARSITY(jac_half, in, state, control, nothing)
SPARSITY(jac_half, out, by_both)
BODY(jac_half)
{
    const double v = arg[0][2], u = arg[1][0];
    (void)iw, (void)w, (void)mem;
    const double value[] = {sin(u), -cos(u), v * cos(u), v * sin(u), -g * sin(u)};
    for (int k = 0; k < 5; k++)
        res[0][k] = value[k];
    return 0;
}

// ---- The function alone
FUNCTION(bare, 2, 1);
SPARSITY(bare, in, state, control)
SPARSITY(bare, out, state)
BODY(bare)
{
    return (void)iw, (void)w, (void)mem, slide(arg, res);
}

// ---- Not even that: one scalar in, one out
BODY(square);
BODY(square)
{
    return (void)iw, (void)w, (void)mem, res[0][0] = arg[0][0] * arg[0][0], arg[0][0] < -9;
}

// ---- Three arguments and three results, some sparse; derivatives that take the results
static const integer diagonal[] = {2, 2, 0, 1, 2, 0, 1}, three[] = {3, 1, 1}, one[] = {1, 1, 1};
static const integer two[] = {2, 1, 1}, corner[] = {3, 2, 0, 1, 1, 1};
static const integer two_by_a[] = {2, 4, 0, 1, 1, 1, 2, 0, 1}, two_by_b[] = {2, 3, 0, 1, 2, 2, 0, 1};
static const integer corner_by_a[] = {6, 4, 0, 1, 1, 1, 2, 1, 1}, corner_by_b[] = {6, 3, 0, 0, 1, 1, 1};
static const integer one_by_a[] = {1, 4, 0, 0, 0, 0, 0}, one_by_b[] = {1, 3, 0, 0, 0, 1, 0};
static const integer two_by_c[] = {2, 1, 0, 0}, corner_by_c[] = {6, 1, 0, 0}, ac[] = {4, 1, 0, 0};
static const integer aa[] = {4, 4, 0, 1, 1, 1, 2, 3, 0}, ab[] = {4, 3, 0, 1, 3, 3, 0, 0, 3};
static const integer ba[] = {3, 4, 0, 2, 2, 2, 3, 0, 1, 1}, bb[] = {3, 3, 0, 0, 1, 1, 1}, bc[] = {3, 1, 0, 1, 2};
static const integer cc[] = {1, 1, 0, 0};
static int couplings;

static int couple_all(const double **arg, double **res)
{
    const double *a = arg[0], *b = arg[1], *c = arg[2];
    couplings++;
    res[0][0] = a[0] * b[0];
    res[0][1] = exp(b[1]) * a[1];
    res[1][0] = a[0] * a[1] * b[1];
    res[2][0] = b[2] * c[0];
    return 0;
}

// raised: exp(b[1])
static int slopes_of_couple(const double **arg, double raised, double **res)
{
    const double *a = arg[0], *b = arg[1], *c = arg[2];
    res[0][0] = b[0];
    res[0][1] = raised;
    res[1][0] = a[0];
    res[1][1] = raised * a[1];
    res[3][0] = a[1] * b[1];
    res[3][1] = a[0] * b[1];
    res[4][0] = a[0] * a[1];
    res[7][0] = c[0];
    res[8][0] = b[2];
    return 0;
}

FUNCTION(couple, 3, 3);
SPARSITY(couple, in, diagonal, three, one)
SPARSITY(couple, out, two, corner, one)
BODY(couple)
{
    return (void)iw, (void)w, (void)mem, couple_all(arg, res);
}
FUNCTION(jac_couple, 6, 9);
SPARSITY(jac_couple, in, diagonal, three, one, two, corner, one)
SPARSITY(jac_couple, out, two_by_a, two_by_b, two_by_c, corner_by_a, corner_by_b, corner_by_c, one_by_a, one_by_b, one)
BODY(jac_couple)
{
    const double *a = arg[0], *b = arg[1], *first = arg[3], *second = arg[4], *third = arg[5];
    (void)iw, (void)w, (void)mem, slopes_of_couple(arg, first[1] / a[1], res);
    res[3][0] = second[0] / a[0];
    res[4][0] = second[0] / b[1];
    res[7][0] = third[0] / b[2];
    return 0;
}
FUNCTION(jac_adj1_couple, 9, 27);
SPARSITY(jac_adj1_couple, in, diagonal, three, one, two, corner, one, two, corner, one)
SPARSITY(jac_adj1_couple, out, aa, ab, ac, cc, cc, cc, cc, cc, cc, ba, bb, bc, cc, cc, cc, cc, cc, cc, one_by_a,
         one_by_b, cc, cc, cc, cc, cc, cc, cc)
BODY(jac_adj1_couple)
{
    const double *a = arg[0], *b = arg[1], raised = arg[3][1] / a[1], *weight = arg[6], of_corner = arg[7][0];
    (void)iw, (void)w, (void)mem;
    res[0][0] = res[0][1] = of_corner * b[1];
    res[1][0] = res[9][0] = weight[0];
    res[1][1] = res[9][1] = of_corner * a[1];
    res[1][2] = res[9][2] = weight[1] * raised + of_corner * a[0];
    res[10][0] = weight[1] * raised * a[1];
    res[11][0] = res[19][0] = arg[8][0];
    return 0;
}

// ---- The same without a Hessian, whose Jacobian takes no results
FUNCTION(lame, 3, 3);
SPARSITY(lame, in, diagonal, three, one)
SPARSITY(lame, out, two, corner, one)
BODY(lame)
{
    return (void)iw, (void)w, (void)mem, couple_all(arg, res);
}
FUNCTION(jac_lame, 6, 9);
SPARSITY(jac_lame, in, diagonal, three, one, two_by_c, cc, cc)
SPARSITY(jac_lame, out, two_by_a, two_by_b, two_by_c, corner_by_a, corner_by_b, corner_by_c, one_by_a, one_by_b, one)
BODY(jac_lame)
{
    return (void)iw, (void)w, (void)mem, slopes_of_couple(arg, exp(arg[1][1]), res);
}
EXPORT int lame_calls(void);
EXPORT int lame_calls(void)
{
    return couplings;
}

// ---- What breaks the convention
static const integer unsound[] = {3, 1, 0, 2, 1, 7};
FUNCTION(crooked, 1, 1);
SPARSITY(crooked, in, unsound)
SPARSITY(crooked, out, state)
BODY(crooked)
{
    return (void)arg, (void)res, (void)iw, (void)w, (void)mem, 1;
}
static const integer negative[] = {-1, 1, 1};
FUNCTION(hollow, 1, 1);
SPARSITY(hollow, in, negative)
SPARSITY(hollow, out, state)
BODY(hollow)
{
    return (void)arg, (void)res, (void)iw, (void)w, (void)mem, 1;
}
FUNCTION(odd, 2, 1);
SPARSITY(odd, in, state, control)
SPARSITY(odd, out, state)
BODY(odd)
{
    return (void)iw, (void)w, (void)mem, slide(arg, res);
}
FUNCTION(jac_odd, 3, 2);
SPARSITY(jac_odd, in, state, control, nothing)
SPARSITY(jac_odd, out, by_control, by_state)
BODY(jac_odd)
{
    return (void)arg, (void)res, (void)iw, (void)w, (void)mem, 1;
}
