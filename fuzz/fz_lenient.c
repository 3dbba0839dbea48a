/* fz_lenient.c - lenient decoding of any bytes, and of a valid file that is cut where up to three
 * bytes after its chunk ENDS say (u16, counted from its end). Claims: the verdict is the strict
 * decoder's; a valid file gives its own scene; any other file gives a scene exactly if a tile could
 * be saved, with the anchors of that many tiles, and this scene can be written and read again; the
 * scene saved from a truncated valid file is a prefix of its scene.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <string.h>
#include "harness.h"
#include "fix_hashes.h"
#include "write/encode.h"

enum { TAIL = 3 };

static const ted4_options options = { .max_bytes = FUZZ_MAX_BYTES };

static size_t least(size_t a, size_t b)
{
    return a < b ? a : b;
}

/* A saved scene satisfies the same rules as any scene. */
static void check_scene(const ted4_scene *s)
{
    uint8_t *out = NULL;
    size_t n = 0;
    ted4_scene *again = NULL;

    fuzz_require(ted4_encode(s, 0, NULL, &out, &n, NULL) == TED4_OK,
                 "what is saved can be written");
    fuzz_require(ted4_decode(out, n, NULL, &again, NULL) == TED4_OK, "and read");
    fuzz_require(memcmp(again->hash, s->hash, sizeof s->hash) == 0, "the same integers");
    ted4_scene_free(again);
    free(out);
}

/* Returns the scene, or NULL. */
static ted4_scene *decode(const uint8_t *data, size_t size, ted4_salvage *w)
{
    ted4_scene *s = NULL, *strict = NULL;
    ted4_error e = { TED4_OK, 0 };
    const ted4_status verdict = ted4_decode_lenient(data, size, &options, &s, w);

    fuzz_require(ted4_decode(data, size, &options, &strict, &e) == verdict &&
                     w->verdict.code == verdict &&
                     (verdict == TED4_OK || w->verdict.offset == e.offset),
                 "the strict verdict");
    fuzz_require((w->stop.code == TED4_OK) == (verdict == TED4_OK) && w->stop.offset <= size,
                 "a place where it stopped");
    fuzz_require(w->n_tiles <= w->tiles_declared || w->tiles_declared == 0,
                 "no more tiles than there are");
    fuzz_require((s != NULL) == (w->n_tiles > 0), "a scene exactly when there is a tile");
    if (strict != NULL)
        fuzz_require(memcmp(strict->hash, s->hash, sizeof s->hash) == 0, "the same scene");
    if (s != NULL) {
        fuzz_require(s->head.n_anchors ==
                         least(w->anchors_declared, (size_t)w->n_tiles * s->head.tile_size),
                     "whole tiles");
        check_scene(s);
    }
    ted4_scene_free(strict);
    return s;
}

static void check_prefix(const ted4_scene *whole, const ted4_scene *part)
{
    const size_t n = part->head.n_anchors, all = whole->head.n_anchors;

    fuzz_require(n <= all && memcmp(part->position, whole->position, 6 * n) == 0,
                 "positions of the file");
    fuzz_require(memcmp(part->dynamic, whole->dynamic, n) == 0 &&
                     memcmp(part->offset_bits, whole->offset_bits, 2 * n) == 0,
                 "masks");
    for (int t = 0; t < TED4_TYPES; t++)
        for (size_t c = 0; c < whole->shape.dim[t]; c++)
            fuzz_require(memcmp(part->symbol[t] + c * n, whole->symbol[t] + c * all, 2 * n) == 0,
                         "symbols");
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const size_t n = ted4_without_tail(data, size, TAIL);
    fuzz_source in = { data + n, data + size };
    const size_t cut = least(n, fuzz_u16(&in));
    ted4_salvage w;
    ted4_scene *whole = decode(data, n, &w), *part;

    if (whole != NULL && w.verdict.code == TED4_OK) {
        part = decode(data, n - cut, &w);
        if (part != NULL)
            check_prefix(whole, part);
        ted4_scene_free(part);
    }
    ted4_scene_free(whole);
    return 0;
}
