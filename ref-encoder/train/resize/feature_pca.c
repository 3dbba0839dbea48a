/* feature_pca.c - see feature_pca.h. S is the covariance of the features f, m their mean, and W the
 * stacked first layers of the heads. With S = L L^T and the eigenvectors L^T W^T W L = Q D Q^T, the
 * components z = K Q^T L^-1 (f - m) are uncorrelated, and f = m + L Q K^-1 z. The effect of z_i on
 * the heads, W L Q e_i / K_i, has the same size for all i if K = D^(1/2) / s, where s is the root
 * mean square of the columns of W.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "feature_pca.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "unit_stats.h"

/* RIDGE: minimum variance of each feature, as a share of the mean variance. LEAST: minimum D_i, as
 * a share of the largest. */
#define RIDGE 1e-6
#define LEAST 1e-8
/* Limit of the sweeps of Jacobi's method, which converges long before. */
enum { MOST_SWEEPS = 60 };

typedef struct {
    size_t n;
    double *mean, *lower, *forms,
        *vectors;      /* [n], [n][n] each: L; L^T W^T W L, later D on its diagonal; Q by columns */
    double *to, *from; /* [n][n]: K Q^T L^-1, L Q K^-1 */
    double *storage;   /* owned: memory of all of these */
} axes;

static int allocate(axes *a, size_t n)
{
    a->n = n;
    a->storage = calloc(n + 5 * n * n, sizeof *a->storage);
    if (a->storage == NULL)
        return -1;
    a->mean = a->storage;
    a->lower = a->mean + n;
    a->forms = a->lower + n * n;
    a->vectors = a->forms + n * n;
    a->to = a->vectors + n * n;
    a->from = a->to + n * n;
    return 0;
}

/* Computes L from the moments [n + 1][n + 1]. */
static void factor(axes *a, const double *moment)
{
    const size_t n = a->n, side = n + 1;
    double mean = 0;

    for (size_t i = 0; i < n; i++)
        a->mean[i] = moment[i * side + n];
    for (size_t i = 0; i < n; i++)
        mean += (moment[i * side + i] - a->mean[i] * a->mean[i]) / (double)n;
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j <= i; j++) {
            double sum = moment[i * side + j] - a->mean[i] * a->mean[j] +
                         (i == j ? RIDGE * mean + 1e-12 : 0.0);

            for (size_t k = 0; k < j; k++)
                sum -= a->lower[i * n + k] * a->lower[j * n + k];
            a->lower[i * n + j] = i == j ? sqrt(fmax(sum, 1e-15)) : sum / a->lower[j * n + j];
        }
}

/* Computes L^T W^T W L from the rows of W. Returns s^2. */
static double make_form(axes *a, const float *rows, size_t n_rows)
{
    const size_t n = a->n;
    double square = 0;

    for (size_t r = 0; r < n_rows; r++) {
        double seen[TED4_MAX_FEATURE] = { 0 };

        for (size_t i = 0; i < n; i++) {
            const double w = (double)rows[r * n + i];

            square += w * w;
            for (size_t k = 0; k <= i; k++)
                seen[k] += w * a->lower[i * n + k];
        }
        for (size_t i = 0; i < n; i++)
            for (size_t k = 0; k < n; k++)
                a->forms[i * n + k] += seen[i] * seen[k];
    }
    return square / (double)n;
}

/* Does one rotation of Jacobi's method in the plane of axes p and q. */
static void turn(axes *a, size_t p, size_t q)
{
    const size_t n = a->n;
    const double x = a->forms[p * n + q];
    const double theta = (a->forms[q * n + q] - a->forms[p * n + p]) / (2.0 * x);
    const double t = (theta >= 0 ? 1.0 : -1.0) / (fabs(theta) + sqrt(theta * theta + 1.0));
    const double c = 1.0 / sqrt(t * t + 1.0), s = t * c;

    for (size_t k = 0; k < n; k++) {
        const double u = a->forms[k * n + p], v = a->forms[k * n + q];

        a->forms[k * n + p] = c * u - s * v;
        a->forms[k * n + q] = s * u + c * v;
    }
    for (size_t k = 0; k < n; k++) {
        const double u = a->forms[p * n + k], v = a->forms[q * n + k];
        const double x_p = a->vectors[k * n + p], x_q = a->vectors[k * n + q];

        a->forms[p * n + k] = c * u - s * v;
        a->forms[q * n + k] = s * u + c * v;
        a->vectors[k * n + p] = c * x_p - s * x_q;
        a->vectors[k * n + q] = s * x_p + c * x_q;
    }
}

static void diagonalise(axes *a)
{
    const size_t n = a->n;
    double trace = 0;

    for (size_t i = 0; i < n; i++) {
        a->vectors[i * n + i] = 1.0;
        trace += a->forms[i * n + i];
    }
    for (int sweep = 0, turned = 1; turned && sweep < MOST_SWEEPS; sweep++) {
        turned = 0;
        for (size_t p = 0; p < n; p++)
            for (size_t q = p + 1; q < n; q++)
                if (fabs(a->forms[p * n + q]) > 1e-12 * trace / (double)n) {
                    turn(a, p, q);
                    turned = 1;
                }
    }
}

/* Sorts the axes by decreasing D; those of equal D stay in order. */
static void sort_axes(const axes *a, size_t *order)
{
    for (size_t i = 0; i < a->n; i++) {
        size_t at = i;

        for (; at > 0 && a->forms[order[at - 1] * (a->n + 1)] < a->forms[i * (a->n + 1)]; at--)
            order[at] = order[at - 1];
        order[at] = i;
    }
}

/* Computes the maps from features to components and back. s: average effect of one step of a
 * feature. */
static void make_ways(axes *a, double s)
{
    const size_t n = a->n;
    size_t order[TED4_MAX_FEATURE];

    sort_axes(a, order);

    const double largest = fmax(a->forms[order[0] * (n + 1)], 1e-30);

    for (size_t i = 0; i < n; i++) {
        const size_t axis = order[i];
        const double k = sqrt(fmax(a->forms[axis * (n + 1)], LEAST * largest)) / s;
        double x[TED4_MAX_FEATURE]; /* L^-T q: the row of Q^T L^-1 */

        for (size_t r = n; r-- > 0;) {
            x[r] = a->vectors[r * n + axis];
            for (size_t j = r + 1; j < n; j++)
                x[r] -= a->lower[j * n + r] * x[j];
            x[r] /= a->lower[r * n + r];
        }
        for (size_t j = 0; j < n; j++) {
            double sum = 0;

            for (size_t r = 0; r <= j; r++)
                sum += a->lower[j * n + r] * a->vectors[r * n + axis];
            a->to[i * n + j] = k * x[j];
            a->from[j * n + i] = sum / k;
        }
    }
}

static void turn_anchors(ted4_trainer *t, const axes *a)
{
    const int first = t->layout.first[TED4_FEATURE];

    for (size_t i = 0; i < t->anchors.n; i++) {
        double x[TED4_MAX_FEATURE];

        for (size_t c = 0; c < a->n; c++)
            x[c] = (double)*ted4_anchor_value(&t->anchors, TED4_ROW_VALUE, i, first + (int)c) -
                   a->mean[c];
        for (size_t c = 0; c < a->n; c++) {
            double sum = 0;

            for (size_t k = 0; k < a->n; k++)
                sum += a->to[c * a->n + k] * x[k];
            *ted4_anchor_value(&t->anchors, TED4_ROW_VALUE, i, first + (int)c) = (float)sum;
        }
    }
}

/* Adapts the first layer of a head: replaces W by W a->from, and b by b + W a->mean. */
static void turn_reader(float *w, size_t in, size_t out, const axes *a)
{
    float *b = w + in * out;

    for (size_t o = 0; o < out; o++, w += in) {
        double x[TED4_MAX_FEATURE], shift = 0;

        for (size_t c = 0; c < a->n; c++) {
            x[c] = (double)w[c];
            shift += x[c] * a->mean[c];
        }
        b[o] += (float)shift;
        for (size_t c = 0; c < a->n; c++) {
            double sum = 0;

            for (size_t k = 0; k < a->n; k++)
                sum += x[k] * a->from[k * a->n + c];
            w[c] = (float)sum;
        }
    }
}

/* Adapts the last layer of F_deform, of which the rows from 3 on are changes of the feature. */
static void turn_maker(float *w, size_t in, size_t out, const axes *a)
{
    for (size_t i = 0; i <= in; i++) {
        const size_t stride = i < in ? in : 1;
        float *at = i < in ? w + 3 * in + i : w + in * out + 3;
        double x[TED4_MAX_FEATURE];

        for (size_t c = 0; c < a->n; c++)
            x[c] = (double)at[c * stride];
        for (size_t c = 0; c < a->n; c++) {
            double sum = 0;

            for (size_t k = 0; k < a->n; k++)
                sum += a->to[c * a->n + k] * x[k];
            at[c * stride] = (float)sum;
        }
    }
}

static void turn_networks(ted4_trainer *t, const axes *a)
{
    const ted4_net_shape *deform = &t->layout.shape.netr[TED4_NET_DEFORM];
    float *netr = t->net.value + t->layout.netr, *w = netr + deform->first;

    for (int i = TED4_NET_OPACITY; i <= TED4_NET_COLOUR; i++) {
        const ted4_net_shape *s = &t->layout.shape.netr[i];

        turn_reader(netr + s->first, s->dim[0], s->dim[1], a);
    }
    if (deform->n_layers == 0)
        return;
    for (int i = 0; i + 1 < deform->n_layers; i++)
        w += ted4_layer_size(deform, (unsigned)i);
    turn_maker(w, deform->dim[deform->n_layers - 1], deform->dim[deform->n_layers], a);
}

int ted4_feature_pca(ted4_trainer *t)
{
    const ted4_site site = { TED4_SITE_FEATURE, 0, 0 };
    const size_t n = t->layout.head.feature_dim, side = n + 1;
    double *moment = malloc(side * side * sizeof *moment);
    float *rows = NULL;
    const int count = moment != NULL ? ted4_site_readers(t, site, &rows) : -1;
    axes a = { 0 };
    int bad = count < 0 || allocate(&a, n) != 0;

    if (bad)
        ted4_trainer_fail(t, "no memory to turn features");
    bad = bad || ted4_site_moment(t, site, moment) != 0;
    if (!bad) {
        factor(&a, moment);

        const double square = make_form(&a, rows, (size_t)count);

        if (square > 0) {
            diagonalise(&a);
            make_ways(&a, sqrt(square));
            turn_anchors(t, &a);
            turn_networks(t, &a);
        }
    }
    free(moment);
    free(rows);
    free(a.storage);
    return bad ? -1 : 0;
}
