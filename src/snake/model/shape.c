// SPDX-License-Identifier: MIT
#include "snake/model/shape.h"

// w = Dbar v is the vector of zero mean with w_k - w_{k+1} = v_k; this is its first entry.
static double dbar_first(int N, const double *v)
{
    double sum = 0;
    for (int j = 0; j < N - 1; j++)
        sum += (N - 1 - j) * v[j];
    return sum / N;
}

void moray_shape_dbar(int N, const double *v, double *out)
{
    out[0] = dbar_first(N, v);
    for (int k = 0; k < N - 1; k++)
        out[k + 1] = out[k] - v[k];
}

void moray_shape_a_dbar(int N, const double *v, double *out)
{
    double w = dbar_first(N, v);
    for (int i = 0; i < N - 1; i++) {
        out[i] = 2 * w - v[i];
        w -= v[i];
    }
}

// (Dbar^T z)_i = z_0 + .. + z_i - (i+1) mean(z), with z = A^T v.
void moray_shape_a_dbar_transposed(int N, const double *v, double *out)
{
    double total = 0, running = 0;
    for (int i = 0; i < N - 1; i++)
        total += v[i];
    for (int i = 0; i < N - 1; i++) {
        running += v[i];
        out[i] = 2 * running - v[i] - 2 * total * (i + 1) / N;
    }
}

// D y = v, then D^T x = y.
void moray_shape_gram_inverse(int N, const double *v, double *out)
{
    double y = dbar_first(N, v), x = 0;
    for (int i = 0; i < N - 1; i++) {
        x += y;
        out[i] = x;
        y -= v[i];
    }
}

void moray_shape_a_dt(int N, const double *v, double *out)
{
    for (int i = 0; i < N - 1; i++)
        out[i] = (i + 1 < N - 1 ? v[i + 1] : 0) - (i > 0 ? v[i - 1] : 0);
}

void moray_shape_at(int N, const double *v, double *out)
{
    for (int k = 0; k < N; k++)
        out[k] = (k < N - 1 ? v[k] : 0) + (k > 0 ? v[k - 1] : 0);
}
