/* lenient.c - salvages the first tiles of a file that is not valid, up to its first error
 * (spec 3.3).
 * SPDX-License-Identifier: BSD-2-Clause */
#include <string.h>
#include "norm/limits.h"
#include "norm/scene.h"
#include "read/decode.h"

/* Runs both passes at once: checks each chunk, then decodes it, up to the first error in the order
 * of the file. Returns that error. */
static ted4_error read_while_good(ted4_decoder *d, int truncated)
{
    ted4_reader frames = d->file;
    int before = -1;
    ted4_error e;

    d->s->level = ted4_container_header(&frames, &d->s->profile);
    /* The full size of a truncated file is not known. The bounds of its level are checked for the
     * largest file size that the level allows, for which they are the least strict. */
    if (frames.base.error.code == TED4_OK && truncated)
        d->file_bytes = ted4_limits_of(d->s->level)->file_bytes;
    while (frames.base.error.code == TED4_OK && d->file.base.error.code == TED4_OK &&
           before != TED4_ENDS) {
        const ted4_chunk_place p = ted4_container_judge(&frames, &before);

        if (frames.base.error.code == TED4_OK)
            ted4_decoder_chunk(d, &p);
    }
    ted4_decoder_finish(d);
    ted4_require(&frames.base, frames.base.pos == frames.end, TED4_E_CON_TRAILING, frames.base.pos);
    /* An error of a payload lies before that of a frame, behind which no payload is read. */
    e = d->file.base.error;
    ted4_fail(&e, frames.base.error.code, frames.base.error.offset);
    return e;
}

/* Keeps only the first n anchors of a scene; they must be whole tiles. */
static void keep_anchors(ted4_scene *s, uint32_t n)
{
    const size_t before = s->head.n_anchors;

    for (int t = 0; t < TED4_TYPES; t++)
        for (size_t c = 0; c < s->shape.dim[t]; c++)
            memmove(s->symbol[t] + c * n, s->symbol[t] + c * before, n * sizeof *s->symbol[t]);
    s->head.n_anchors = n;
    ted4_shape_make(&s->shape, &s->head);
    ted4_scene_hash(s, s->hash);
}

static void salvage(const void *data, size_t size, const ted4_options *o, ted4_scene **scene,
                    ted4_salvage *what)
{
    const int truncated = what->verdict.code == TED4_E_CON_TRUNCATED;
    ted4_options quiet;
    ted4_decoder d;
    uint64_t n;

    memset(&quiet, 0, sizeof quiet);
    if (o != NULL)
        quiet = *o;
    quiet.trace = NULL;
    if (!ted4_decoder_init(&d, data, size, &quiet)) {
        what->stop = d.file.base.error;
        return;
    }
    what->stop = read_while_good(&d, truncated);
    what->n_tiles = d.n_good;
    if (d.s->shape.n_tiles > 0) { /* HEAD was right */
        what->tiles_declared = d.s->shape.n_tiles;
        what->anchors_declared = d.s->head.n_anchors;
    }
    if (d.n_good == 0) {
        ted4_scene_free(d.s);
        return;
    }
    n = (uint64_t)d.n_good * d.s->head.tile_size;
    keep_anchors(d.s, n < d.s->head.n_anchors ? (uint32_t)n : d.s->head.n_anchors);
    *scene = d.s;
}

ted4_status ted4_decode_lenient(const void *data, size_t size, const ted4_options *o,
                                ted4_scene **scene, ted4_salvage *what)
{
    memset(what, 0, sizeof *what);
    if (ted4_decode(data, size, o, scene, &what->verdict) == TED4_OK) {
        what->n_tiles = what->tiles_declared = (*scene)->shape.n_tiles;
        what->anchors_declared = (*scene)->head.n_anchors;
    } else if (ted4_status_verdict(what->verdict.code) == TED4_INVALID) {
        salvage(data, size, o, scene, what);
    } else {
        what->stop = what->verdict;
    }
    return what->verdict.code;
}
