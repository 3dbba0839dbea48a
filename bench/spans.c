/* spans.c - measures how long the anchors of a file are active: span = a_f - a_s of spec 11.4,
 * clamped to [0, 1]; 1 for every anchor of a file without activation.
 *     spans FILE.ted4                              one JSON line: shares of anchors with a span of
 *                                                  at most 0.2, between, of at least 0.8; mean
 *     spans FILE.ted4 SCENE DOWNSCALE PICTURE.png  also a picture: at three times of the first
 *                                                  held-out camera, the Gaussians in their own
 *                                                  colours (above) and in the colour of their
 *                                                  anchor's span (below): blue 0, white 1/2, red 1,
 *                                                  darker where the Gaussian is dark. The strip at
 *                                                  the bottom is the scale, 0 to 1 from left to
 *                                                  right. If that camera does not move, the line
 *                                                  also reports the share of pixels and times at
 *                                                  which the scene has changed, the share of their
 *                                                  light that comes from short-lived anchors, and
 *                                                  that share where nothing has changed (spans.h).
 * SPDX-License-Identifier: BSD-2-Clause */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include "base/bytes.h"
#include "norm/syntax.h"
#include "norm/tables.h"
#include "render/png_file.h"
#include "open_decoded.h"
#include "spans.h"
#include "tool/cli.h"

/* Returns component c of the activation of anchor i, decoded as in spec 10.4. */
static float tau(const ted4_scene *s, size_t i, size_t c)
{
    const float q = s->head.step[TED4_TAU] * ted4_bits_float(ted4_step[s->step_index[TED4_TAU][i]]);

    return (float)s->symbol[TED4_TAU][c * s->head.n_anchors + i] * q;
}

static float span_of(const ted4_scene *s, size_t i)
{
    const float span = s->head.activation ? tau(s, i, 2) - tau(s, i, 0) : 1.0f;

    return span < 0.0f ? 0.0f : span > 1.0f ? 1.0f : span;
}

static int open_file(session *s, const char *path)
{
    decoded d = { NULL, NULL, { 0 }, 0 };
    const int code = open_decoded("spans", path, &d);

    s->scene = d.scene;
    s->recon = d.recon;
    s->info = d.info;
    if (code != TED4_EXIT_FINE)
        return code;
    s->span = malloc((s->info.n_anchors + 1) * sizeof *s->span);
    if (s->span == NULL)
        return failed(path, "out of memory");
    for (size_t i = 0; i < s->info.n_anchors; i++)
        s->span[i] = span_of(s->scene, i);
    return TED4_EXIT_FINE;
}

static void print_shares(const session *s, const spans_where *w)
{
    const double n = s->info.n_anchors;
    double low = 0, high = 0, sum = 0;

    for (size_t i = 0; i < s->info.n_anchors; i++) {
        low += s->span[i] <= SHORT;
        high += s->span[i] >= LONG;
        sum += (double)s->span[i];
    }
    printf("{\"anchors\":%.0f,\"span_short\":%.4f,\"span_between\":%.4f,\"span_long\":%.4f,\"span_"
           "mean\":%.4f",
           n, low / n, (n - low - high) / n, high / n, sum / n);
    if (w->count[0] > 0 && w->count[1] > 0)
        printf(",\"changed\":%.4f,\"short_changed\":%.4f,\"short_same\":%.4f",
               w->count[1] / (w->count[0] + w->count[1]), w->share[1], w->share[0]);
    printf("}\n");
}

static int open_scene(session *s, const char *folder, int downscale)
{
    const ted4_dataset_options options = { .downscale = downscale,
                                           .white = 1,
                                           .cache_bytes = 1 << 20 };
    ted4_message m;

    if (ted4_dataset_load(&s->data, folder, &options, &m) != 0)
        return failed(folder, m.text);

    const ted4_picture *const p = held_out(s, 0);

    if (p == NULL)
        return failed(folder, "no held-out pictures");
    s->width = p->camera.width;
    s->height = p->camera.height;
    s->view = malloc((size_t)s->width * (size_t)s->height * 3);
    s->picture = malloc((2 * (size_t)s->height + STRIP) * (size_t)s->width * COLUMNS * 3);
    s->colour = malloc((3 * s->info.n_gaussians + 1) * sizeof *s->colour);
    s->viewer = ted4_viewer_new();
    return s->view == NULL || s->picture == NULL || s->colour == NULL || s->viewer == NULL
               ? failed(folder, "out of memory")
               : TED4_EXIT_FINE;
}

static int draw(session *s, const char *path)
{
    char why[256];
    const int code = draw_picture(s);

    if (code != TED4_EXIT_FINE)
        return code;
    return ted4_png_write(path, s->width * COLUMNS, 2 * s->height + STRIP, s->picture, why,
                          sizeof why) == 0
               ? TED4_EXIT_FINE
               : failed(path, why);
}

int main(int argc, char **argv)
{
    session s = { 0 };
    spans_where where = { { 0 }, { 0 } };
    int code;

    if (argc != 2 && (argc != 5 || atoi(argv[3]) < 1))
        return failed("usage", "spans FILE.ted4 [SCENE DOWNSCALE PICTURE.png]");
    code = open_file(&s, argv[1]);
    if (code == TED4_EXIT_FINE && argc == 5)
        code = open_scene(&s, argv[2], atoi(argv[3]));
    if (code == TED4_EXIT_FINE && argc == 5)
        code = draw(&s, argv[4]);
    if (code == TED4_EXIT_FINE && argc == 5)
        code = short_lives_where(&s, &where);
    if (code == TED4_EXIT_FINE)
        print_shares(&s, &where);
    ted4_viewer_free(s.viewer);
    ted4_dataset_free(&s.data);
    ted4_recon_free(s.recon);
    ted4_scene_free(s.scene);
    free(s.span);
    free(s.colour);
    free(s.view);
    free(s.picture);
    return code;
}
