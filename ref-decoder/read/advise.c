/* advise.c - reports what is doubtful in a valid file: its level, its chunks, and coded parts that
 * the scene does not need (spec 3.4, R-ENC-004). advise_symbols.c checks the symbols,
 * advise_meta.c the ancillary chunks.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "read/advise.h"

#include <string.h>
#define ZLIB_CONST
#include <zlib.h>
#include "base/bytes.h"
#include "norm/limits.h"
#include "norm/scene.h"
#include "norm/tables.h"
#include "read/advise_parts.h"
#include "read/inflate.h"

enum { MINOR_AT = 9, LEVEL_AT = 11, HEAD_AT = 12 };

/* An element of HEAD that is not an array, and its offset in the file. */
typedef struct {
    const char *name;
    size_t offset;
} sought;

static void seek(void *user, size_t offset, const char *element, int64_t index, int64_t value)
{
    sought *s = user;

    (void)index;
    (void)value;
    if (strcmp(element, s->name) == 0)
        s->offset = offset;
}

static size_t offset_of(const ted4_findings *f, const char *element)
{
    sought s = { element, 0 };
    ted4_header h;
    ted4_shape shape;
    ted4_reader r;

    ted4_reader_init(&r, f->data, HEAD_AT + TED4_FRAME_HEAD_SIZE, f->size, 1);
    r.base.trace = seek;
    r.base.trace_user = &s;
    memset(&h, 0, sizeof h);
    ted4_walk_header(&r.base, &h, &shape, TED4_LEVEL_UNBOUNDED, UINT64_MAX);
    return s.offset;
}

/* Writes n bytes of the shuffled values (spec 7.2), beginning with byte at. A blob of a file has at
 * least one value. */
static void shuffle(const ted4_blob *b, size_t at, uint8_t *bytes, size_t n)
{
    size_t i = at % (size_t)b->n, j = at / (size_t)b->n;

    for (size_t k = 0; k < n; k++) {
        bytes[k] = (uint8_t)(ted4_float_bits(b->values[i]) >> 8 * j);
        if (++i == b->n) {
            i = 0;
            j++;
        }
    }
}

/* Returns the size of the values after shuffling and zlib compression, which gets them in pieces.
 * Returns their raw size and sets f->starved if memory runs out. */
static size_t deflated_size(ted4_findings *f, const ted4_blob *b, ted4_arena *a)
{
    enum { PIECE = 1 << 14 };
    const size_t raw = 4 * (size_t)b->n;
    uint8_t *piece = ted4_arena_alloc(a, 2, PIECE);
    size_t size = 0, at = 0;
    z_stream z;

    memset(&z, 0, sizeof z);
    z.zalloc = ted4_zlib_alloc;
    z.zfree = ted4_zlib_free;
    z.opaque = a;
    if (piece == NULL || deflateInit(&z, 9) != Z_OK) {
        size = at = raw;
        f->starved = 1;
    }
    while (at < raw) {
        const size_t n = raw - at < PIECE ? raw - at : PIECE;

        shuffle(b, at, piece, n);
        at += n;
        z.next_in = piece;
        z.avail_in = (unsigned)n;
        do {
            z.next_out = piece + PIECE;
            z.avail_out = PIECE;
            (void)deflate(&z, at < raw ? Z_NO_FLUSH : Z_FINISH);
            size += PIECE - z.avail_out;
        } while (z.avail_out == 0);
    }
    (void)deflateEnd(&z);
    ted4_arena_release(a, piece);
    return size;
}

static void advise_blob(ted4_findings *f, const ted4_blob *b, const ted4_chunk_place *p,
                        ted4_arena *a)
{
    size_t size;

    if (b->mode != TED4_BLOB_RAW)
        return;
    size = deflated_size(f, b, a);
    if (size < 4 * b->n)
        ted4_find_advice(f, TED4_ADV_BLOB_RAW, ted4_chunk_type[p->type], p->at, 2,
                         (int64_t)(4 * b->n), (int64_t)size);
}

static void advise_chunks(ted4_findings *f, const ted4_scene *s, ted4_arena *a)
{
    ted4_reader r;
    int minor = 0; /* the lowest that has the file's profile and chunk types (R-CON-007) */

    ted4_reader_init(&r, f->data, TED4_FILE_HEADER_SIZE, f->size, 1);
    while (r.base.pos < f->size) {
        const ted4_chunk_place p = ted4_container_next(&r);

        switch (p.type) {
        case TED4_NETE: advise_blob(f, &s->nete, &p, a); break;
        case TED4_NETR: advise_blob(f, &s->netr, &p, a); break;
        case TED4_BANK: advise_blob(f, &s->bank, &p, a); break;
        case TED4_CHUNKS: minor |= ted4_advise_ancillary(f, &p, a); break;
        default: break;
        }
    }
    if (s->profile != TED4_PROFILE_MAIN)
        minor = 2;
    if (f->data[MINOR_AT] != minor)
        ted4_find_advice(f, TED4_ADV_MINOR, NULL, MINOR_AT, 2, f->data[MINOR_AT], minor);
}

static void advise_masks(ted4_findings *f, const ted4_scene *s)
{
    const ted4_header *h = &s->head;
    const unsigned all = (1u << h->n_offsets) - 1;
    uint32_t moving = 0, whole = 0, empty = 0;

    for (size_t i = 0; i < h->n_anchors; i++) {
        moving += s->dynamic[i];
        whole += s->offset_bits[i] == all;
        empty += s->offset_bits[i] == 0;
    }
    if (h->motion != TED4_MOTION_NONE && moving == 0)
        ted4_find_advice(f, TED4_ADV_STILL, "HEAD", offset_of(f, "motion"), 1, h->motion, 0);
    if (h->temporal_mask && moving == h->n_anchors)
        ted4_find_advice(f, TED4_ADV_TEMPORAL_MASK, "HEAD", offset_of(f, "temporal_mask"), 0, 0, 0);
    if (h->offset_mask && whole == h->n_anchors)
        ted4_find_advice(f, TED4_ADV_OFFSET_MASK, "HEAD", offset_of(f, "offset_mask"), 0, 0, 0);
    if (empty > 0)
        ted4_find_advice(f, TED4_ADV_EMPTY_ANCHORS, "POSN", offset_of(f, "n_anchors"), 2, empty,
                         h->n_anchors);
}

/* Returns the value of component comp of tau of anchor i (spec 10.4). */
static float tau(const ted4_scene *s, unsigned comp, size_t i)
{
    const float step = ted4_bits_float(ted4_step[s->step_index[TED4_TAU][i]]);
    const float q = s->head.step[TED4_TAU] * step;

    return (float)s->symbol[TED4_TAU][(size_t)comp * s->head.n_anchors + i] * q;
}

static void advise_time(ted4_findings *f, const ted4_scene *s)
{
    const ted4_header *h = &s->head;
    size_t always = 0;

    if (h->frames == 1 && (h->motion != TED4_MOTION_NONE || h->activation))
        ted4_find_advice(f, TED4_ADV_ONE_FRAME, "HEAD", offset_of(f, "frames"), 2, h->motion,
                         h->activation);
    if (!h->activation)
        return;
    while (always < h->n_anchors && tau(s, 0, always) <= 0 && tau(s, 2, always) >= 1)
        always++;
    if (always == h->n_anchors)
        ted4_find_advice(f, TED4_ADV_ACTIVATION, "HEAD", offset_of(f, "activation"), 0, 0, 0);
}

/* Returns the number of bank rows that no frame uses: rows are interpolated between the two that
 * enclose the time of a frame (spec 11.2). */
static uint32_t rows_unseen(const ted4_header *h)
{
    const uint64_t last = h->bank_rows - 1, end = h->frames > 1 ? h->frames - 1 : 1;
    uint64_t next = 0; /* first row after those that the frames so far use */
    uint32_t unseen = 0;

    if (h->frames > 1 && last <= end) /* frames are at most one row apart */
        return 0;                     /* otherwise there are fewer frames than rows */
    for (uint64_t j = 0; j < h->frames; j++) {
        const uint64_t g = j * last, row = g / end;

        if (row > next)
            unseen += (uint32_t)(row - next);
        next = row + (g % end != 0) + 1;
    }
    return unseen + (uint32_t)(next <= last ? last + 1 - next : 0);
}

static void advise_bank(ted4_findings *f, const ted4_scene *s)
{
    const ted4_header *h = &s->head;
    const size_t row = h->bank_dim * sizeof(float),
                 at = s->shape.n_bank > 0 ? offset_of(f, "bank_rows") : 0;
    uint32_t same = 1, unseen;

    if (s->shape.n_bank == 0)
        return;
    while (same < h->bank_rows &&
           memcmp(s->bank.values, s->bank.values + (size_t)same * h->bank_dim, row) == 0)
        same++;
    if (same == h->bank_rows && same > 1)
        ted4_find_advice(f, TED4_ADV_BANK_CONSTANT, "BANK", at, 1, h->bank_rows, 0);
    unseen = rows_unseen(h);
    if (unseen > 0)
        ted4_find_advice(f, TED4_ADV_BANK_ROWS, "BANK", at, 2, unseen, h->bank_rows);
}

void ted4_advise(ted4_findings *f, const ted4_scene *s, const ted4_options *o)
{
    const unsigned lowest = ted4_level_lowest(&s->head, &s->shape, f->size);
    ted4_arena a;

    if (s->level != lowest)
        ted4_find_advice(f, TED4_ADV_LEVEL, NULL, LEVEL_AT, 2, s->level, lowest);
    ted4_arena_init(&a, o);
    advise_chunks(f, s, &a);
    ted4_arena_finish(&a);
    advise_masks(f, s);
    advise_time(f, s);
    advise_bank(f, s);
    ted4_advise_symbols(f, s, o);
}
