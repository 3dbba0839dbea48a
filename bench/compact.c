/* compact.c - what each means of a smaller file would gain by itself: bits of a trained file's
 * integers under it, as rows of the table in bench/compact.md. Nothing is trained again.
 *     compact FILE.ted4 [SCENE DOWNSCALE]
 * With a scene, also what held-out pictures lose when positions go to a grid, and weights to fewer
 * bits, with nothing to make up for it.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "compact.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "base/bytes.h"
#include "lab_facts.h"
#include "norm/coder.h"
#include "tool/cli.h"
#include "train/model/weight_grid.h"
#include "write/encode.h"

/* Bits of the file, of the payloads of NETE, NETR and BANK, and of the masks. */
typedef struct {
    lab_session session;
    double bits, blob[3], masks;
} file;

int lab_failed(const char *what, const char *why)
{
    fprintf(stderr, "compact: %s: %s\n", what, why);
    return TED4_EXIT_TOOL;
}

/* A row: today's bits against those with a means, per anchor and as a share of the file. */
static void row(const file *f, const char *means, double today, double with)
{
    const double n = f->session.scene->head.n_anchors;

    printf("%-41s %9.2f %9.2f %+8.2f %%\n", means, today / n, with / n,
           100 * (with - today) / f->bits);
}

static void put_positions(const file *f)
{
    const ted4_scene *const s = f->session.scene;
    const double today = 48.0 * s->head.n_anchors;
    char name[64];
    size_t shared;

    for (unsigned depth = 8; depth <= 12; depth++) {
        const double bits = compact_octree(s, depth, &shared);

        snprintf(name, sizeof name, "positions: octree, %u bits, %zu shared", depth, shared);
        row(f, name, today, bits);
    }
    row(f, "positions: octree, no loss", today, compact_octree(s, 16, &shared));
}

static void put_type(const file *f, const compact_models *m, int type, const int32_t *levels,
                     const int32_t *before)
{
    static const char *const name[TED4_TYPES] = { "feature", "scaling", "offset", "phi", "tau" };
    compact_fitted y;
    char text[64];

    compact_fit(m, type, levels, before, &y);
    snprintf(text, sizeof text, "%s: fitted again, blind", name[type]);
    row(f, text, y.today, y.blind);
    snprintf(text, sizeof text, "%s: neighbours by levels as inputs", name[type]);
    row(f, text, y.today, y.near_levels);
    snprintf(text, sizeof text, "%s: all neighbours before as inputs", name[type]);
    row(f, text, y.today, y.near_before);
    snprintf(text, sizeof text, "%s: mixed, blind", name[type]);
    row(f, text, y.today, compact_mixed(m, type, NULL));
    snprintf(text, sizeof text, "%s: mixed, neighbours by levels", name[type]);
    row(f, text, y.today, compact_mixed(m, type, levels));
}

static void put_symbols(const file *f)
{
    const ted4_scene *const s = f->session.scene;
    int32_t *const levels = compact_near_levels(s), *const before = compact_near_before(s);
    compact_models m;
    double adaptive, mixed;

    compact_models_make(&m, s);
    for (int t = 0; t < TED4_TYPES; t++)
        if (s->shape.dim[t] > 0)
            put_type(f, &m, t, levels, before);
    compact_models_free(&m);
    compact_masks(s, levels, &adaptive, &mixed);
    row(f, "masks: adaptive", f->masks, adaptive);
    row(f, "masks: mixed, neighbours by levels", f->masks, mixed);
    free(levels);
    free(before);
}

static void put_weights(const file *f)
{
    const ted4_scene *const s = f->session.scene;

    row(f, "entropy networks: adaptive", f->blob[0], compact_nete(s));
    row(f, "networks: adaptive", f->blob[1], compact_netr(s));
    if (s->bank.n > 0)
        row(f, "bank: adaptive", f->blob[2], compact_bank(s));
}

/* ---- quality ---- */

static int measure(lab_session *s, const char *what, double *base)
{
    lab_views v;
    int code;

    ted4_recon_free(s->recon);
    if (ted4_recon_new(&s->recon, s->scene, NULL) != TED4_OK)
        return TED4_EXIT_TOOL;
    code = lab_measure_views(s, NULL, &v);
    if (code != TED4_EXIT_FINE)
        return code;
    if (*base == 0)
        *base = v.mean;
    printf("%-41s %9.3f dB %+8.3f\n", what, v.mean, v.mean - *base);
    return TED4_EXIT_FINE;
}

static int put_grids(lab_session *s, double *base)
{
    const size_t size = 3 * (size_t)s->scene->head.n_anchors * sizeof *s->scene->position;
    uint16_t *const kept = compact_need(size, 1);
    int code = TED4_EXIT_FINE;
    char name[64];

    memcpy(kept, s->scene->position, size);
    for (unsigned depth = 9; code == TED4_EXIT_FINE && depth <= 12; depth++) {
        snprintf(name, sizeof name, "positions on a grid of %u bits", depth);
        compact_move_to_grid(s->scene, depth);
        code = measure(s, name, base);
        memcpy(s->scene->position, kept, size);
    }
    free(kept);
    return code;
}

/* Networks and bank on ever coarser grids: quality, and bits deflated and adaptive. */
static int put_rounded(const file *f, lab_session *s, double *base)
{
    ted4_scene *const scene = s->scene;
    int code = TED4_EXIT_FINE;
    char name[64];

    for (int bits = 12; code == TED4_EXIT_FINE && bits >= 6; bits -= 2) {
        const int grids[TED4_WEIGHT_GRIDS] = { bits, bits, bits, bits };

        ted4_weight_grid_scene(&scene->shape, grids, scene->netr.values, scene->bank.values);
        snprintf(name, sizeof name, "networks, bank: %d bits", bits);
        code = measure(s, name, base);
        row(f, "  deflated, adaptive",
            compact_deflated(&scene->netr) + compact_deflated(&scene->bank),
            compact_netr(scene) + (scene->bank.n > 0 ? compact_bank(scene) : 0));
    }
    return code;
}

static int put_quality(const file *f, lab_session *s, const char *folder, unsigned downscale)
{
    const ted4_dataset_options options = { .downscale = downscale,
                                           .white = s->info.background[0] > 127,
                                           .cache_bytes = 16 << 20 };
    ted4_message m;
    double base = 0;
    int code;

    if (ted4_dataset_load(&s->data, folder, &options, &m) != 0)
        return lab_failed(folder, m.text);
    code = measure(s, "held-out pictures", &base);
    if (code == TED4_EXIT_FINE)
        code = put_grids(s, &base);
    if (code == TED4_EXIT_FINE)
        code = put_rounded(f, s, &base);
    ted4_dataset_free(&s->data);
    return code;
}

/* ---- the file ---- */

/* Bits of the chunks of a type. */
static double chunk_bits(const uint8_t *data, size_t size, const char *type)
{
    double bits = 0;

    for (size_t at = TED4_FILE_HEADER_SIZE; at < size;) {
        const size_t payload = ted4_load32(data + at + 8);

        if (memcmp(data + at, type, 4) == 0)
            bits += 8.0 * (double)payload;
        at += TED4_FRAME_HEAD_SIZE + payload + TED4_FRAME_HASH_SIZE;
    }
    return bits;
}

static int open_file(file *f, const char *path)
{
    ted4_error e = { TED4_OK, 0 };
    ted4_bits counted = { .mask = 0 };
    size_t size = 0;
    uint8_t *const data = ted4_read_file(path, &size);

    if (data == NULL)
        return ted4_report_unread("compact", path, 0);
    f->bits = 8.0 * (double)size;
    if (ted4_decode(data, size, NULL, &f->session.scene, &e) == TED4_OK &&
        ted4_count(f->session.scene, NULL, &counted, &e) == TED4_OK) {
        f->masks = counted.mask;
        f->blob[0] = chunk_bits(data, size, "NETE");
        f->blob[1] = chunk_bits(data, size, "NETR");
        f->blob[2] = chunk_bits(data, size, "BANK");
        ted4_scene_info(f->session.scene, &f->session.info);
    }
    free(data);
    return e.code == TED4_OK ? TED4_EXIT_FINE : ted4_report("compact", path, &e, 0);
}

int main(int argc, char **argv)
{
    file f = { .masks = 0 };
    int code;

    if (argc != 2 && argc != 4) {
        fprintf(stderr, "compact: usage: compact FILE.ted4 [SCENE DOWNSCALE]\n");
        return TED4_EXIT_TOOL;
    }
    code = open_file(&f, argv[1]);
    if (code == TED4_EXIT_FINE) {
        printf("%.0f bytes, %" PRIu32 " anchors\n%-41s %9s %9s %10s\n", f.bits / 8,
               f.session.scene->head.n_anchors, "bits an anchor", "today", "with", "of file");
        put_positions(&f);
        put_symbols(&f);
        put_weights(&f);
        if (argc == 4)
            code = put_quality(&f, &f.session, argv[2], (unsigned)atoi(argv[3]));
    }
    ted4_recon_free(f.session.recon);
    ted4_scene_free(f.session.scene);
    return code;
}
