// SPDX-License-Identifier: MIT
//
// The inner loops. Tiles of up to three registers by four columns stay in registers while all pivots are subtracted.
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "base/lanes.h"
#include "linear/parts.h"

#define INLINE static inline __attribute__((always_inline))

typedef double lane8 __attribute__((vector_size(64), aligned(8)));
typedef double lane4 __attribute__((vector_size(32), aligned(8)));
typedef double lane2 __attribute__((vector_size(16), aligned(8)));
typedef double lane1;

// One matrix of a product: entry (i, k) at first[i + k step].
struct view {
    const double *first;
    size_t step;
};

// C[i + j step] -= sum over k of L(i, k) W(j, k) for i of `high` registers and j < columns. Rows from i on, as long as
// they fill the tile.
#define TILE(type)                                                                                                     \
    INLINE void tile_##type(int high, int columns, int depth, struct view L, struct view W, double *C, size_t step)    \
    {                                                                                                                  \
        enum { wide = sizeof(type) / sizeof(double) };                                                                 \
        type sum[3][4], l[3];                                                                                          \
        for (int j = 0; j < columns; j++)                                                                              \
            for (int r = 0; r < high; r++)                                                                             \
                sum[r][j] = *(const type *)(C + (size_t)j * step + r * wide);                                          \
        for (int k = 0; k < depth; k++) {                                                                              \
            const double *from = L.first + (size_t)k * L.step, *w = W.first + (size_t)k * W.step;                      \
            for (int r = 0; r < high; r++)                                                                             \
                l[r] = *(const type *)(from + r * wide);                                                               \
            for (int j = 0; j < columns; j++)                                                                          \
                for (int r = 0; r < high; r++)                                                                         \
                    sum[r][j] -= l[r] * w[j];                                                                          \
        }                                                                                                              \
        for (int j = 0; j < columns; j++)                                                                              \
            for (int r = 0; r < high; r++)                                                                             \
                *(type *)(C + (size_t)j * step + r * wide) = sum[r][j];                                                \
    }                                                                                                                  \
    INLINE int tiles_##type(int high, int i, int rows, int columns, int depth, struct view L, struct view W,           \
                            double *C, size_t step)                                                                    \
    {                                                                                                                  \
        const int tall = high * (int)(sizeof(type) / sizeof(double));                                                  \
        for (; i + tall <= rows; i += tall)                                                                            \
            tile_##type(high, columns, depth, (struct view){L.first + i, L.step}, W, C + i, step);                     \
        return i;                                                                                                      \
    }
TILE(lane8)
TILE(lane4)
TILE(lane2)
TILE(lane1)

INLINE void strip(int wide, int columns, int rows, int depth, struct view L, struct view W, double *C, size_t step)
{
    int i = 0;
    if (wide == 8)
        i = tiles_lane8(3, i, rows, columns, depth, L, W, C, step);
    if (wide == 8)
        i = tiles_lane8(1, i, rows, columns, depth, L, W, C, step);
    if (wide == 4)
        i = tiles_lane4(3, i, rows, columns, depth, L, W, C, step);
    if (wide >= 4)
        i = tiles_lane4(1, i, rows, columns, depth, L, W, C, step);
    if (wide == 2)
        i = tiles_lane2(2, i, rows, columns, depth, L, W, C, step);
    i = tiles_lane2(1, i, rows, columns, depth, L, W, C, step);
    tiles_lane1(1, i, rows, columns, depth, L, W, C, step);
}

// A strip of columns begins at its first diagonal entry; what it writes above the others is not read by anyone.
INLINE void update(int wide, int rows, int columns, int depth, struct view L, struct view W, double *C, size_t step)
{
    int j = 0;
    for (; j + 4 <= columns; j += 4)
        strip(wide, 4, rows - j, depth, (struct view){L.first + j, L.step}, (struct view){W.first + j, W.step},
              C + j + (size_t)j * step, step);
    L.first += j;
    W.first += j;
    C += j + (size_t)j * step;
    if (columns - j == 3)
        strip(wide, 3, rows - j, depth, L, W, C, step);
    else if (columns - j == 2)
        strip(wide, 2, rows - j, depth, L, W, C, step);
    else if (columns - j == 1)
        strip(wide, 1, rows - j, depth, L, W, C, step);
}

#ifdef SEVERAL_PROCESSORS
__attribute__((target("arch=x86-64-v4"))) static void update_widest(int rows, int columns, int depth, struct view L,
                                                                    struct view W, double *C, size_t step)
{
    update(8, rows, columns, depth, L, W, C, step);
}

__attribute__((target("arch=x86-64-v3"))) static void update_wide(int rows, int columns, int depth, struct view L,
                                                                  struct view W, double *C, size_t step)
{
    update(4, rows, columns, depth, L, W, C, step);
}
#endif

static void update_plain(int rows, int columns, int depth, struct view L, struct view W, double *C, size_t step)
{
    update(OWN_LANES, rows, columns, depth, L, W, C, step);
}

// Four columns of L at a time: first the triangle that they make with each other, then all rows below.
FOR_EACH_PROCESSOR
static void forward(int height, int pivots, const double *L, int ldl, double *restrict x)
{
    const size_t step = (size_t)ldl;
    int k = 0;
    for (; k + 4 <= pivots; k += 4, L += 4 * step + 4) {
        const double *M = L + step, *N = M + step, *O = N + step;
        double *y = x + k;
        const double a = y[0], b = y[1] -= L[1] * a, c = y[2] -= L[2] * a + M[2] * b;
        const double d = y[3] -= L[3] * a + M[3] * b + N[3] * c;
        for (int i = 4; i < height - k; i++)
            y[i] -= L[i] * a + M[i] * b + N[i] * c + O[i] * d;
    }
    for (; k < pivots; k++, L += step + 1)
        for (int i = 1; i < height - k; i++)
            x[k + i] -= L[i] * x[k];
}

FOR_EACH_PROCESSOR
static void backward(int height, int pivots, const double *L, int ldl, double *restrict x)
{
    const size_t step = (size_t)ldl;
    int k = pivots;
    for (; k % 4 > 0; k--) {
        const double *column = L + (size_t)(k - 1) * (step + 1), *y = x + k - 1;
        double sum = 0;
#pragma omp simd reduction(+ : sum)
        for (int i = 1; i <= height - k; i++)
            sum += column[i] * y[i];
        x[k - 1] -= sum;
    }
    for (; k > 0; k -= 4) {
        const double *A = L + (size_t)(k - 4) * (step + 1), *B = A + step, *C = B + step, *D = C + step;
        double *y = x + k - 4, a = 0, b = 0, c = 0, d = 0;
#pragma omp simd reduction(+ : a, b, c, d)
        for (int i = 4; i < height - k + 4; i++) {
            a += A[i] * y[i];
            b += B[i] * y[i];
            c += C[i] * y[i];
            d += D[i] * y[i];
        }
        y[3] -= d;
        y[2] -= c + C[3] * y[3];
        y[1] -= b + B[3] * y[3] + B[2] * y[2];
        y[0] -= a + A[3] * y[3] + A[2] * y[2] + A[1] * y[1];
    }
}

// Absolute values without their sign bit are in the order of their bits as whole numbers, whose maximum every compiler
// takes several at a time.
FOR_EACH_PROCESSOR
static double largest(int n, const double *x)
{
    int64_t most = 0;
    double found;
    for (int i = 0; i < n; i++) {
        int64_t bits;
        memcpy(&bits, x + i, sizeof bits);
        bits &= INT64_MAX;
        most = bits > most ? bits : most;
    }
    memcpy(&found, &most, sizeof found);
    return found;
}

// gcc exports functions made for several processors whatever their visibility, and a program's own of the same name
// would be called: those are static, and these lead to them.

void moray_ldl_kernel_update(int rows, int columns, int depth, const double *L, int ldl, const double *W, int ldw,
                             double *C, int ldc)
{
    const struct view left = {L, (size_t)ldl}, kept = {W, (size_t)ldw};
#ifdef SEVERAL_PROCESSORS
    const int lanes = processor_lanes();
    if (lanes == 8) {
        update_widest(rows, columns, depth, left, kept, C, (size_t)ldc);
        return;
    }
    if (lanes == 4) {
        update_wide(rows, columns, depth, left, kept, C, (size_t)ldc);
        return;
    }
#endif
    update_plain(rows, columns, depth, left, kept, C, (size_t)ldc);
}

void moray_ldl_kernel_forward(int height, int pivots, const double *L, int ldl, double *x)
{
    forward(height, pivots, L, ldl, x);
}

void moray_ldl_kernel_backward(int height, int pivots, const double *L, int ldl, double *x)
{
    backward(height, pivots, L, ldl, x);
}

double moray_ldl_kernel_largest(int n, const double *x)
{
    return largest(n, x);
}
