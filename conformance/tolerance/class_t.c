/* class_t.c - see class_t.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "spec_tolerance.h" /* first: fail() is a function there */
#include "class_t.h"

_Static_assert((int)TOL_GROUPS == (int)CLASS_T_GROUPS, "groups of R-TOL-002");

struct class_t {
    spec_model model;
};

static const char *const group_name[TOL_GROUPS + 1] = { "position", "scale",  "rotation",
                                                        "opacity",  "colour", "not finite" };

class_t *class_t_open(const uint8_t *data, size_t size, const char **id, uint64_t *offset)
{
    class_t *const c = calloc(1, sizeof *c);

    *id = NULL;
    if (c == NULL)
        return NULL;
    spec_model_decode(&c->model, data, size);
    *id = c->model.p.v.id;
    *offset = c->model.p.v.offset;
    if (*id == NULL)
        return c;
    class_t_close(c);
    return NULL;
}

void class_t_close(class_t *c)
{
    if (c != NULL)
        spec_model_free(&c->model);
    free(c);
}

/* Whether the query's time is one (R-REC-002). */
static int in_range(const class_t_query *q)
{
    return q->den >= 1 && q->den < 1u << 24 && q->num <= q->den;
}

/* All four evaluations; t is to be freed with tol_free in any case. 1, or 0: class X has no result.
 */
static int evaluate(const class_t *c, const class_t_query *q, tol_reference *t)
{
    memset(t, 0, sizeof *t);
    return in_range(q) && tol_make(t, &c->model.p.s, q->num, q->den, q->camera);
}

int class_t_bounds(const class_t *c, const class_t_query *q, class_t_thresholds *out)
{
    tol_reference t;
    const int result = evaluate(c, q, &t);

    out->n = t.n;
    memcpy(out->peak, t.peak, sizeof out->peak);
    memcpy(out->rms, t.rms, sizeof out->rms);
    tol_free(&t);
    return result;
}

/* Records as numbers; NULL: no memory. To be freed. */
static float (*numbers(const uint8_t *records, size_t size))[14]
{
    float(*const y)[14] = calloc(size / sizeof *y + 1, sizeof *y);

    for (size_t i = 0; y != NULL && i < size / 4; i++)
        (&y[0][0])[i] = from_bits(load32(records + 4 * i));
    return y;
}

const char *class_t_judge(const class_t *c, const class_t_query *q, const uint8_t *records,
                          size_t size)
{
    tol_reference t;
    const char *verdict = "kept";

    if (!in_range(q))
        return records == NULL ? verdict : "out of range";
    if (evaluate(c, q, &t)) {
        if (records == NULL || size != 14 * sizeof(float) * t.n) {
            verdict = records == NULL ? "missing" : "count";
        } else {
            float(*const y)[14] = numbers(records, size);
            const int group = y != NULL ? tol_judge(&t, y) : -1;

            verdict = y == NULL ? "no memory" : group >= 0 ? group_name[group] : verdict;
            free(y);
        }
    }
    tol_free(&t);
    return verdict;
}
