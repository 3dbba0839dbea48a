/* transcode.c - see transcode.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "transcode.h"

#include <stdlib.h>
#include <string.h>

#include "edit.h"
#include "norm/half.h"
#include "write/coded.h"
#include "write/encode.h"
#include "write/snap.h"

/* Sorts an array of n entries of size bytes; entry i comes from order[i]. copy: room for it. */
static void permute(void *array, size_t n, size_t size, const uint32_t *order, void *copy)
{
    if (array == NULL)
        return;
    memcpy(copy, array, n * size);
    for (size_t i = 0; i < n; i++)
        memcpy((char *)array + i * size, (const char *)copy + order[i] * size, size);
}

static int is_sorted(const ted4_scene *s)
{
    for (size_t i = 1; i < s->head.n_anchors; i++)
        if (ted4_morton(s->position + 3 * i) <= ted4_morton(s->position + 3 * i - 3))
            return 0;
    return 1;
}

/* Sorts the anchors of a scene by R-POS-002. Probabilities of masks are counted again, as tiles
 * hold other anchors than before. Returns 0, or -1 if there is no memory. */
static int sort(ted4_scene *s)
{
    const size_t n = s->head.n_anchors;
    uint32_t *const order = malloc(n * sizeof *order);
    void *const copy = malloc(n * 3 * sizeof *s->position);
    const int good = order != NULL && copy != NULL &&
                     ted4_positions_sort(s->position, n, order) == n;

    if (good) {
        permute(s->position, n, 3 * sizeof *s->position, order, copy);
        permute(s->dynamic, n, 1, order, copy);
        permute(s->offset_bits, n, sizeof *s->offset_bits, order, copy);
        for (int t = 0; t < TED4_TYPES; t++) {
            permute(s->step_index[t], n, 1, order, copy);
            for (size_t c = 0; c < s->shape.dim[t]; c++)
                permute(s->symbol[t] + c * n, n, sizeof *s->symbol[t], order, copy);
        }
        memset(s->prob, 0, s->shape.n_tiles * TED4_PROBS * sizeof *s->prob);
    }
    free(order);
    free(copy);
    return good ? 0 : -1;
}

/* Returns whether the chunk says nothing about critical chunks that another profile changes. */
static int stays_true(const ted4_chunk_view *c)
{
    return (c->flags & TED4_CHUNK_IS_SAFE) != 0 || strcmp(c->type, "CAMS") == 0 ||
           strcmp(c->type, "THMB") == 0;
}

/* Adds to e the ancillary chunks of the file that stay true, in their order. Returns 0, or -1. */
static int add_chunks(ted4_edit *e, const uint8_t *file, size_t size, size_t *dropped)
{
    ted4_chunk_view c;

    for (size_t at = TED4_FILE_HEADER; ted4_chunks_next(file, size, &at, &c);) {
        uint8_t *payload;

        if ((c.flags & TED4_CHUNK_IS_CRITICAL) != 0)
            continue;
        if (!stays_true(&c)) {
            ++*dropped;
            continue;
        }
        payload = malloc(c.size > 0 ? c.size : 1);
        if (payload == NULL)
            return -1;
        memcpy(payload, c.payload, c.size);
        if (ted4_edit_add(e, c.type, c.flags, payload, c.size) != 0)
            return -1;
    }
    return 0;
}

/* R-ENC-006: chooses the smallest mode of a blob; deflated bytes that stay are copied (R-EDT-003).
 */
static void choose_mode(ted4_scene *s, ted4_blob *b)
{
    if (b->mode != TED4_BLOB_DEFLATED)
        b->mode = TED4_BLOB_AUTO;
    else if (s->profile == TED4_PROFILE_COMPACT)
        (void)ted4_blob_code(s, b, &s->arena, b->deflated_size);
}

/* Writes the critical chunks. Returns NULL or what is wrong. */
static const char *write_scene(ted4_scene *s, int profile, const ted4_parallel *p, uint8_t **out,
                               size_t *size, int *sorted)
{
    ted4_error e = { TED4_OK, 0 };

    *sorted = profile == TED4_PROFILE_MAIN && !is_sorted(s);
    if (*sorted && sort(s) != 0)
        return "out of memory";
    s->profile = (uint8_t)profile;
    s->grid = 0;
    choose_mode(s, &s->nete);
    choose_mode(s, &s->netr);
    choose_mode(s, &s->bank);
    return ted4_encode(s, 0, p, out, size, &e) == TED4_OK ? NULL : ted4_status_text(e.code);
}

int ted4_transcode(const uint8_t *file, size_t size, int profile, const ted4_parallel *p,
                   uint8_t **out, size_t *out_size, int *sorted, size_t *dropped, ted4_error *e,
                   const char **why)
{
    const ted4_options options = { .max_bytes = UINT64_MAX, .parallel = p };
    ted4_scene *s;
    uint8_t *bare = NULL;
    size_t bare_size = 0;
    ted4_edit edit;

    *dropped = 0;
    *why = NULL;
    if (ted4_decode(file, size, &options, &s, e) != TED4_OK)
        return -1;
    *why = write_scene(s, profile, p, &bare, &bare_size, sorted);
    ted4_scene_free(s);
    if (*why != NULL)
        return -1;
    if (ted4_edit_begin(&edit, bare, bare_size) != 0 || add_chunks(&edit, file, size, dropped) != 0)
        *why = "out of memory";
    else
        (void)ted4_edit_write(&edit, out, out_size, why);
    ted4_edit_finish(&edit);
    free(bare);
    return *why == NULL ? 0 : -1;
}
