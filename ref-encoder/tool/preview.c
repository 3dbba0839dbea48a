/* preview.c - see preview.h. In stage 2 the model is finished as at the end of training, like in
 * trials of the model search, so that the quality is that of quantised values; then the saved state
 * is restored.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "preview.h"

#include <stdlib.h>
#include <string.h>

#include "base/bytes.h"
#include "norm/coder.h"
#include "train/state/picture.h"
#include "train/monitor/checkpoint.h"
#include "train/step/export_scene.h"
#include "write/encode.h"

/* Adds the sizes of payloads of a file [size] that was just written (spec 5.2). */
static void add_chunks(const uint8_t *file, size_t size, ted4_preview *p)
{
    size_t at = TED4_FILE_HEADER_SIZE;

    p->positions = p->networks = 0;
    while (at < size) {
        const double payload = (double)ted4_load32(file + at + 8);

        if (memcmp(file + at, ted4_chunk_type[TED4_POSN], 4) == 0)
            p->positions += payload;
        for (ted4_chunk c = TED4_NETE; c <= TED4_BANK; c++)
            if (memcmp(file + at, ted4_chunk_type[c], 4) == 0)
                p->networks += payload;
        at += TED4_FRAME_HEAD_SIZE + (size_t)payload + TED4_FRAME_HASH_SIZE;
    }
}

/* Codes the scene and sets the sizes in *p. Returns 0, or -1 if the scene cannot be coded. */
static int count_bytes(const ted4_scene *s, const ted4_parallel *parallel, ted4_preview *p)
{
    uint8_t *file;
    size_t size;
    ted4_bits bits;
    ted4_error e = { TED4_OK, 0 };

    if (ted4_encode(s, 0, parallel, &file, &size, &e) != TED4_OK)
        return -1;
    add_chunks(file, size, p);
    free(file);
    if (ted4_count(s, parallel, &bits, &e) != TED4_OK)
        return -1;
    p->bytes = (double)size;
    p->masks = bits.mask / 8.0;
    p->frame = p->bytes - p->positions - p->masks - p->networks;
    for (int y = 0; y < TED4_TYPES; y++) {
        p->type[y] = bits.type[y] / 8.0;
        p->frame -= p->type[y];
    }
    return 0;
}

static int draw(ted4_trainer *t, int n, ted4_preview *p)
{
    p->train = 1;
    for (size_t i = 0; i < t->data->n_pictures; i++)
        p->train &= !t->data->pictures[i].is_test;
    p->psnr = ted4_trainer_preview(t, n);
    return p->psnr < 0 ? -1 : 0;
}

int ted4_preview_make(ted4_trainer *t, int n, ted4_preview *p)
{
    ted4_snapshot before = { 0 };
    ted4_scene *scene;

    if (!t->phase.stage2)
        return draw(t, n, p);
    if (ted4_state_take(t, &before) != 0)
        return -1;
    if (ted4_export_scene(t, &scene) == 0) {
        (void)count_bytes(scene, t->parallel, p);
        ted4_scene_free(scene);
    }
    t->is_empty = 0; /* later steps may keep Gaussians */

    const int drawn = draw(t, n, p), bad = ted4_state_restore(t, &before) != 0 || drawn != 0;

    ted4_snapshot_free(&before);
    return bad ? -1 : 0;
}
