/* lab_log.c - reads facts about stability from the log of one training (ted4enc --log): see
 * lab_facts.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <jansson.h>
#include "lab_facts.h"
#include "tool/cli.h"

/* Keeps the larger value and its term. */
static void take_larger(double x, const char *term, double *most, char most_term[32])
{
    if (!(x > *most))
        return;
    *most = x;
    snprintf(most_term, 32, "%s", term);
}

/* gradients: the usual norm of each term. peaks: the largest norm since the previous line, as a
 * multiple of the usual one (run_log.h). */
static void take_gradients(const json_t *line, lab_log *l)
{
    const json_t *const peaks = json_object_get(line, "peaks");
    const char *term;
    json_t *usual;

    json_object_foreach(json_object_get(line, "gradients"), term, usual)
    {
        const double peak = json_number_value(json_object_get(peaks, term));

        take_larger(json_number_value(usual) * (peak > 1 ? peak : 1), term, &l->gradient,
                    l->gradient_term);
        take_larger(peak, term, &l->peak, l->peak_term);
    }
}

static void take_count(const json_t *line, const char *name, uint64_t *n)
{
    const json_t *const v = json_object_get(line, name);

    if (json_is_integer(v))
        *n = (uint64_t)json_integer_value(v);
}

static void take_line(const json_t *line, lab_log *l)
{
    const json_t *const loss = json_object_get(line, "loss");

    take_gradients(line, l);
    take_count(line, "rollbacks", &l->rollbacks);
    take_count(line, "skipped", &l->skipped);
    take_count(line, "clamped", &l->saturated);
    if (!json_is_number(loss))
        return;
    l->loss_last = json_number_value(loss);
    if (l->lines++ == 0)
        l->loss_first = l->loss_last;
}

int lab_read_log(const char *path, lab_log *l)
{
    FILE *const f = fopen(path, "r");
    char *line = NULL;
    size_t capacity = 0;

    *l = (lab_log) { .gradient = -1, .peak = -1 };
    if (f == NULL)
        return lab_failed(path, strerror(errno));
    while (getline(&line, &capacity, f) > 0) {
        json_t *const o = json_loads(line, 0, NULL);

        if (o == NULL)
            l->bad++;
        else
            take_line(o, l);
        json_decref(o);
    }
    free(line);
    fclose(f);
    return TED4_EXIT_FINE;
}
