/* spans.c - how long the anchors of a file live: span = a_f - a_s of spec 11.4, kept to [0, 1]; 1 for every anchor of a file without activation.
 *     spans FILE.ted4                              one JSON line: shares of anchors with a span of at most 0.2, between, of at least 0.8; mean
 *     spans FILE.ted4 SCENE DOWNSCALE PICTURE.png  also a picture: at three times of the first held-out camera, the Gaussians in their own colours
 *                                                  (above) and in the colour of their anchor's span (below): blue 0, white 1/2, red 1, darker where
 *                                                  the Gaussian is dark. The strip at the foot is the scale, 0 to 1 from left to right.
 * Used by bench/sweep.sh.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/bytes.h"
#include "data/dataset.h"
#include "norm/syntax.h"
#include "norm/tables.h"
#include "render/png_file.h"
#include "render/view.h"
#include "tool/cli.h"
#include "train/space.h"

#define SHORT 0.2f
#define LONG  0.8f
/* What is left of the colour of a span where the Gaussian is black. */
#define DIMMEST 0.35f
enum { COLUMNS = 3, STRIP = 10 };

typedef struct {
    ted4_scene    *scene;           /* owned, as all below */
    ted4_recon    *recon;
    ted4_viewer   *viewer;
    ted4_dataset   data;
    ted4_info      info;
    float         *span;            /* [N] */
    float         *colour;          /* [3][n_gaussians] */
    int            width, height;   /* of one view */
    uint8_t       *view, *picture;  /* [height][width][3], [2 height + STRIP][3 width][3] */
} session;

static int failed(const char *what, const char *why)
{
    fprintf(stderr, "spans: %s: %s\n", what, why);
    return TED4_EXIT_TOOL;
}

/* Component c of the activation of anchor i, as spec 10.4 decodes it. */
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
    ted4_error     e = { TED4_OK, 0 };
    size_t         size;
    uint8_t *const bytes = ted4_read_file(path, &size);

    if (bytes == NULL)
        return failed(path, strerror(errno));
    if (ted4_decode(bytes, size, NULL, &s->scene, &e) == TED4_OK)
        e.code = ted4_recon_new(&s->recon, s->scene, NULL);
    free(bytes);
    if (e.code != TED4_OK)
        return ted4_report("spans", path, &e, 0);
    ted4_scene_info(s->scene, &s->info);
    s->span = malloc((s->info.n_anchors + 1) * sizeof *s->span);
    if (s->span == NULL)
        return failed(path, "out of memory");
    for (size_t i = 0; i < s->info.n_anchors; i++)
        s->span[i] = span_of(s->scene, i);
    return TED4_EXIT_FINE;
}

static void print_shares(const session *s)
{
    const double n = s->info.n_anchors;
    double       low = 0, high = 0, sum = 0;

    for (size_t i = 0; i < s->info.n_anchors; i++) {
        low += s->span[i] <= SHORT;
        high += s->span[i] >= LONG;
        sum += (double)s->span[i];
    }
    printf("{\"anchors\":%.0f,\"span_short\":%.4f,\"span_between\":%.4f,\"span_long\":%.4f,\"span_mean\":%.4f}\n",
           n, low / n, (n - low - high) / n, high / n, sum / n);
}

/* ---- the picture ---- */

static void span_colour(float span, float rgb[3])
{
    const float cold = span < 0.5f ? 2.0f * span : 1.0f, warm = span > 0.5f ? 2.0f - 2.0f * span : 1.0f;

    rgb[0] = cold;
    rgb[1] = cold < warm ? cold : warm;
    rgb[2] = warm;
}

/* Its Gaussians coloured by span; arrays of g itself stay as they are. */
static ted4_gaussians coloured(const session *s, const ted4_gaussians *g)
{
    ted4_gaussians out = *g;

    for (int c = 0; c < 3; c++)
        out.colour[c] = s->colour + (size_t)c * g->n;
    for (size_t i = 0; i < g->n; i++) {
        const float light = (g->colour[0][i] + g->colour[1][i] + g->colour[2][i]) / 3.0f;
        const float shade = DIMMEST + (1.0f - DIMMEST) * light;
        float       rgb[3];

        span_colour(s->span[g->id[i] / s->info.n_offsets], rgb);
        for (int c = 0; c < 3; c++)
            out.colour[c][i] = shade * rgb[c];
    }
    return out;
}

static void put_view(const session *s, int row, int column)
{
    const size_t line = (size_t)s->width * 3;

    for (size_t y = 0; y < (size_t)s->height; y++)
        memcpy(s->picture + (((size_t)(row * s->height) + y) * COLUMNS + (size_t)column) * line,
               s->view + y * line, line);
}

static void put_strip(const session *s)
{
    const size_t width = (size_t)s->width * COLUMNS;
    uint8_t     *to = s->picture + 2 * (size_t)s->height * width * 3;

    for (int y = 0; y < STRIP; y++)
        for (size_t x = 0; x < width; x++) {
            float rgb[3];

            span_colour((float)x / (float)(width - 1), rgb);
            for (int c = 0; c < 3; c++)
                *to++ = (uint8_t)(255.0f * rgb[c] + 0.5f);
        }
}

/* The held-out picture of the first held-out picture's camera, nearest to time column / 2. */
static const ted4_picture *choose(const session *s, int column)
{
    const int64_t       want = (int64_t)(s->data.n_frames - 1) * column;
    const ted4_picture *first = NULL, *best = NULL;
    int64_t             best_far = 0;

    for (size_t i = 0; i < s->data.n_pictures; i++) {
        const ted4_picture *const p = &s->data.pictures[i];
        const int64_t             far = llabs((int64_t)p->frame * (COLUMNS - 1) - want);

        if (!p->is_test)
            continue;
        if (first == NULL)
            first = p;
        if (p->camera_id == first->camera_id && (best == NULL || far < best_far)) {
            best = p;
            best_far = far;
        }
    }
    return best;
}

static int draw_column(const session *s, int column)
{
    const ted4_picture *const p = choose(s, column);
    const uint32_t      last = s->data.n_frames > 1 ? s->data.n_frames - 1 : 1;
    const ted4_header   world = { 0 };      /* origin 0, unit 1: a view in world coordinates */
    ted4_info           black = s->info;
    ted4_view           view;
    ted4_gaussians      g;
    float               centre[3];
    ted4_status         status;

    if (p->camera.width != s->width || p->camera.height != s->height)
        return failed(p->path, "size differs from the first held-out picture");
    ted4_space_view(&world, &p->camera, &view, centre);
    memset(black.background, 0, sizeof black.background);
    status = ted4_query_for_view(s->recon, p->frame, last, &view, NULL, &g);
    if (status == TED4_OK)
        status = ted4_render_gaussians(s->viewer, &g, &s->info, &view, NULL, s->view);
    if (status != TED4_OK)
        return failed(p->path, ted4_status_id(status));
    put_view(s, 0, column);
    g = coloured(s, &g);
    status = ted4_render_gaussians(s->viewer, &g, &black, &view, NULL, s->view);
    if (status != TED4_OK)
        return failed(p->path, ted4_status_id(status));
    put_view(s, 1, column);
    return TED4_EXIT_FINE;
}

static int open_scene(session *s, const char *folder, int downscale)
{
    const ted4_dataset_options options = { .downscale = downscale, .white = 1, .cache_bytes = 1 << 20 };
    ted4_message m;

    if (ted4_dataset_load(&s->data, folder, &options, &m) != 0)
        return failed(folder, m.text);

    const ted4_picture *const p = choose(s, 0);

    if (p == NULL)
        return failed(folder, "no held-out pictures");
    s->width = p->camera.width;
    s->height = p->camera.height;
    s->view = malloc((size_t)s->width * (size_t)s->height * 3);
    s->picture = malloc((2 * (size_t)s->height + STRIP) * (size_t)s->width * COLUMNS * 3);
    s->colour = malloc((3 * s->info.n_gaussians + 1) * sizeof *s->colour);
    s->viewer = ted4_viewer_new();
    return s->view == NULL || s->picture == NULL || s->colour == NULL || s->viewer == NULL
               ? failed(folder, "out of memory") : TED4_EXIT_FINE;
}

static int draw(session *s, const char *folder, const char *downscale, const char *path)
{
    char why[256];
    int  code = open_scene(s, folder, atoi(downscale));

    for (int column = 0; column < COLUMNS && code == TED4_EXIT_FINE; column++)
        code = draw_column(s, column);
    if (code != TED4_EXIT_FINE)
        return code;
    put_strip(s);
    return ted4_png_write(path, s->width * COLUMNS, 2 * s->height + STRIP, s->picture, why, sizeof why) == 0
               ? TED4_EXIT_FINE : failed(path, why);
}

int main(int argc, char **argv)
{
    session s = { 0 };
    int     code;

    if (argc != 2 && (argc != 5 || atoi(argv[3]) < 1))
        return failed("usage", "spans FILE.ted4 [SCENE DOWNSCALE PICTURE.png]");
    code = open_file(&s, argv[1]);
    if (code == TED4_EXIT_FINE && argc == 5)
        code = draw(&s, argv[2], argv[3], argv[4]);
    if (code == TED4_EXIT_FINE)
        print_shares(&s);
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
