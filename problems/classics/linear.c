// SPDX-License-Identifier: MIT
#include "linear.h"

void linear_solve3(moray_num M[3][3], moray_num *b)
{
    for (int k = 0; k < 3; k++)
        for (int i = k + 1; i < 3; i++) {
            const moray_num factor = M[i][k] / M[k][k];
            for (int j = k; j < 3; j++)
                M[i][j] -= factor * M[k][j];
            b[i] -= factor * b[k];
        }
    for (int i = 2; i >= 0; i--) {
        for (int j = i + 1; j < 3; j++)
            b[i] -= M[i][j] * b[j];
        b[i] /= M[i][i];
    }
}
