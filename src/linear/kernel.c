// SPDX-License-Identifier: MIT
//
// The inner loops. Tiles of eight rows and four columns stay in registers while all pivots are subtracted; on
// processors with wide registers the loader takes the version made for them.
#include <stddef.h>
#include <string.h>

#include "linear/parts.h"

#if defined(__x86_64__) && defined(__GLIBC__) && defined(__GNUC__) && !defined(__clang__)
#define FOR_EACH_PROCESSOR __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define FOR_EACH_PROCESSOR
#endif
#define INLINE static inline __attribute__((always_inline))

typedef double lane8 __attribute__((vector_size(64), aligned(8)));
typedef double lane4 __attribute__((vector_size(32), aligned(8)));

// One matrix of a product: entry (i, k) at first[i + k step].
struct view {
    const double *first;
    size_t step;
};

#define TILE(type)                                                                                                     \
    INLINE void tile_##type(int columns, int depth, struct view L, struct view W, double *C, size_t step)              \
    {                                                                                                                  \
        type sum[4];                                                                                                   \
        for (int j = 0; j < columns; j++)                                                                              \
            sum[j] = *(const type *)(C + (size_t)j * step);                                                            \
        for (int k = 0; k < depth; k++) {                                                                              \
            const type l = *(const type *)(L.first + (size_t)k * L.step);                                              \
            for (int j = 0; j < columns; j++)                                                                          \
                sum[j] -= l * W.first[(size_t)j + (size_t)k * W.step];                                                 \
        }                                                                                                              \
        for (int j = 0; j < columns; j++)                                                                              \
            *(type *)(C + (size_t)j * step) = sum[j];                                                                  \
    }
TILE(lane8)
TILE(lane4)
TILE(double)

INLINE void strip(int columns, int rows, int depth, struct view L, struct view W, double *C, size_t step)
{
    int i = 0;
    for (; i + 8 <= rows; i += 8)
        tile_lane8(columns, depth, (struct view){L.first + i, L.step}, W, C + i, step);
    for (; i + 4 <= rows; i += 4)
        tile_lane4(columns, depth, (struct view){L.first + i, L.step}, W, C + i, step);
    for (; i < rows; i++)
        tile_double(columns, depth, (struct view){L.first + i, L.step}, W, C + i, step);
}

// A strip of columns begins at its first diagonal entry; what it writes above the others is not read by anyone.
FOR_EACH_PROCESSOR
static void update(int rows, int columns, int depth, const double *L, int ldl, const double *W, int ldw, double *C,
                   int ldc)
{
    const size_t step = (size_t)ldc;
    int j = 0;
    for (; j + 4 <= columns; j += 4)
        strip(4, rows - j, depth, (struct view){L + j, (size_t)ldl}, (struct view){W + j, (size_t)ldw},
              C + j + (size_t)j * step, step);
    const struct view left = {L + j, (size_t)ldl}, kept = {W + j, (size_t)ldw};
    double *rest = C + j + (size_t)j * step;
    if (columns - j == 3)
        strip(3, rows - j, depth, left, kept, rest, step);
    else if (columns - j == 2)
        strip(2, rows - j, depth, left, kept, rest, step);
    else if (columns - j == 1)
        strip(1, rows - j, depth, left, kept, rest, step);
}

FOR_EACH_PROCESSOR
static void subtract(int rows, int columns, const double *L, int ldl, const double *x, double *y)
{
    const size_t step = (size_t)ldl;
    int k = 0;
    for (; k + 4 <= columns; k += 4, L += 4 * step)
        for (int i = 0; i < rows; i++)
            y[i] -= L[i] * x[k] + L[i + step] * x[k + 1] + L[i + 2 * step] * x[k + 2] + L[i + 3 * step] * x[k + 3];
    for (; k < columns; k++, L += step)
        for (int i = 0; i < rows; i++)
            y[i] -= L[i] * x[k];
}

FOR_EACH_PROCESSOR
static void subtract_transposed(int rows, int columns, const double *L, int ldl, const double *y, double *x)
{
    const size_t step = (size_t)ldl;
    int k = 0;
    for (; k + 4 <= columns; k += 4, L += 4 * step) {
        double a = 0, b = 0, c = 0, d = 0;
#pragma omp simd reduction(+ : a, b, c, d)
        for (int i = 0; i < rows; i++) {
            a += L[i] * y[i];
            b += L[i + step] * y[i];
            c += L[i + 2 * step] * y[i];
            d += L[i + 3 * step] * y[i];
        }
        x[k] -= a, x[k + 1] -= b, x[k + 2] -= c, x[k + 3] -= d;
    }
    for (; k < columns; k++, L += step) {
        double sum = 0;
#pragma omp simd reduction(+ : sum)
        for (int i = 0; i < rows; i++)
            sum += L[i] * y[i];
        x[k] -= sum;
    }
}

// What is left of eight lanes is looked at again together with some before: a maximum does not mind.
FOR_EACH_PROCESSOR
static double largest(int n, const double *x)
{
    double lane[8] = {0}, most = 0;
    for (int i = 0; i < n && n >= 8; i += 8)
        for (int k = 0, from = i + 8 <= n ? i : n - 8; k < 8; k++)
            lane[k] = __builtin_fabs(x[from + k]) > lane[k] ? __builtin_fabs(x[from + k]) : lane[k];
    for (int k = 0; k < 8; k++)
        most = lane[k] > most ? lane[k] : most;
    for (int i = 0; i < n && n < 8; i++)
        most = __builtin_fabs(x[i]) > most ? __builtin_fabs(x[i]) : most;
    return most;
}

// gcc exports functions made for several processors whatever their visibility, and a program's own of the same name
// would be called: those are static, and these lead to them.

void moray_ldl_kernel_update(int rows, int columns, int depth, const double *L, int ldl, const double *W, int ldw,
                             double *C, int ldc)
{
    update(rows, columns, depth, L, ldl, W, ldw, C, ldc);
}

void moray_ldl_kernel_subtract(int rows, int columns, const double *L, int ldl, const double *x, double *y)
{
    subtract(rows, columns, L, ldl, x, y);
}

void moray_ldl_kernel_subtract_transposed(int rows, int columns, const double *L, int ldl, const double *y, double *x)
{
    subtract_transposed(rows, columns, L, ldl, y, x);
}

double moray_ldl_kernel_largest(int n, const double *x)
{
    return largest(n, x);
}
