/* spans_where.c - tests whether short-lived anchors are drawn where the scene changes: see spans.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <stdlib.h>
#include <string.h>
#include "spans.h"
#include "tool/cli.h"

enum { CHANGED = 40, FEWEST_TIMES = 5 };

/* Returns the number of held-out pictures of the camera, with their indices in which [n_pictures],
 * or 0 if the camera moves. */
static size_t where_pictures(const session *s, uint32_t camera, size_t *which)
{
    size_t n = 0;

    for (size_t i = 0; i < s->data.n_pictures; i++) {
        const ted4_picture *const p = &s->data.pictures[i];

        if (!p->is_test || p->camera_id != camera)
            continue;
        if (n > 0 && memcmp(&p->camera, &s->data.pictures[which[0]].camera, sizeof p->camera) != 0)
            return 0;
        which[n++] = i;
    }
    return n;
}

static int where_load(session *s, const size_t *which, size_t n, uint8_t *truth)
{
    const size_t size = (size_t)s->width * (size_t)s->height * 3;
    ted4_message m;

    for (size_t k = 0; k < n; k++) {
        const uint8_t *const from = ted4_dataset_pixels(&s->data, which[k], &m);

        if (from == NULL)
            return failed(s->data.pictures[which[k]].path, m.text);
        memcpy(truth + k * size, from, size);
        ted4_dataset_release(&s->data, which[k]);
    }
    return TED4_EXIT_FINE;
}

/* Returns the lower median of the n bytes at x, x + step, ... */
static int where_median(const uint8_t *x, size_t n, size_t step)
{
    size_t count[256] = { 0 }, sum = 0;
    int v = 0;

    for (size_t k = 0; k < n; k++)
        count[x[k * step]]++;
    for (; v < 255 && (sum += count[v]) <= (n - 1) / 2; v++)
        ;
    return v;
}

/* changed [n][height][width]: 1 where a channel differs strongly from its median. */
static void where_changed(const session *s, const uint8_t *truth, size_t n, uint8_t *changed)
{
    const size_t pixels = (size_t)s->width * (size_t)s->height;

    memset(changed, 0, n * pixels);
    for (size_t i = 0; i < 3 * pixels; i++) {
        const int median = where_median(truth + i, n, 3 * pixels);

        for (size_t k = 0; k < n; k++)
            changed[k * pixels + i / 3] |= abs(truth[k * 3 * pixels + i] - median) > CHANGED;
    }
}

static void short_is_white(float span, float rgb[3])
{
    rgb[0] = rgb[1] = rgb[2] = span <= SHORT ? 1.0f : 0.0f;
}

static int where_add(session *s, const ted4_picture *p, const uint8_t *changed, spans_where *w)
{
    const size_t pixels = (size_t)s->width * (size_t)s->height;
    const int code = draw_view(s, p, short_is_white, 1.0f);

    for (size_t i = 0; i < pixels && code == TED4_EXIT_FINE; i++) {
        w->share[changed[i]] += s->view[3 * i] / 255.0;
        w->count[changed[i]]++;
    }
    return code;
}

int short_lives_where(session *s, spans_where *w)
{
    const ted4_picture *const of = held_out(s, 0);
    const size_t pixels = (size_t)s->width * (size_t)s->height;
    size_t *const which = malloc(s->data.n_pictures * sizeof *which);
    const size_t n = which != NULL ? where_pictures(s, of->camera_id, which) : 0;
    uint8_t *const truth = malloc(n * pixels * 3 + 1), *const changed = malloc(n * pixels + 1);
    int code = which == NULL || truth == NULL || changed == NULL ? failed(of->path, "out of memory")
                                                                 : TED4_EXIT_FINE;

    *w = (spans_where) { { 0 }, { 0 } };
    if (code == TED4_EXIT_FINE && n >= FEWEST_TIMES) {
        code = where_load(s, which, n, truth);
        if (code == TED4_EXIT_FINE)
            where_changed(s, truth, n, changed);
        for (size_t k = 0; k < n && code == TED4_EXIT_FINE; k++)
            code = where_add(s, &s->data.pictures[which[k]], changed + k * pixels, w);
    }
    for (int k = 0; k < 2; k++)
        w->share[k] /= w->count[k] > 0 ? w->count[k] : 1;
    free(which);
    free(truth);
    free(changed);
    return code;
}
