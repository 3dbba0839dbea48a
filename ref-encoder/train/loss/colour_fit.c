/* colour_fit.c - see colour_fit.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "colour_fit.h"

#include <math.h>

/* Replaces the lower triangle of a by its Cholesky factor L, a = L L^T. */
static void factorise(double a[4][4])
{
    for (int j = 0; j < 4; j++)
        for (int i = j; i < 4; i++) {
            for (int k = 0; k < j; k++)
                a[i][j] -= a[i][k] * a[j][k];
            a[i][j] = i == j ? sqrt(a[i][j]) : a[i][j] / a[j][j];
        }
}

/* Solves L L^T x = b for each column of b, in place. */
static void substitute(const double a[4][4], double b[4][3])
{
    for (int c = 0; c < 3; c++) {
        for (int i = 0; i < 4; i++) {
            for (int k = 0; k < i; k++)
                b[i][c] -= a[i][k] * b[k][c];
            b[i][c] /= a[i][i];
        }
        for (int i = 3; i >= 0; i--) {
            for (int k = i + 1; k < 4; k++)
                b[i][c] -= a[k][i] * b[k][c];
            b[i][c] /= a[i][i];
        }
    }
}

void ted4_colour_solve(ted4_colour_sums *s, ted4_colour_map map)
{
    for (int i = 0; i < 4; i++)
        s->left[i][i] += TED4_COLOUR_RIDGE * s->weight;
    factorise(s->left);
    substitute((const double(*)[4])s->left, s->right);
    for (int r = 0; r < 4; r++)
        for (int c = 0; c < 3; c++)
            map[3 * r + c] = (float)s->right[r][c];
}
