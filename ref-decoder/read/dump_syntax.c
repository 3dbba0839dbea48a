/* dump_syntax.c - writes tier T0 of spec J.2, the syntax elements of a file, from the trace of the
 * decoder.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <string.h>
#include "base/bytes.h"
#include "norm/syntax.h"

enum { BYTES = 0, REST = 254, SUBSTREAM = 255, MAX_SUBSTREAMS = 24, DEFLATED = -1 };

/* width is the width of a number in bytes. It is BYTES for an element of size bytes, and SUBSTREAM
 * for a substream, whose size is given by a "size" element of the file, and REST for one that takes
 * the rest of the payload. */
typedef struct {
    const char *name;
    uint16_t id;
    uint8_t width;
    uint8_t size;
} element;

static const element table[] = {
    { "major", 2, 1, 0 },
    { "minor", 3, 1, 0 },
    { "profile", 4, 1, 0 },
    { "level", 5, 1, 0 },
    { "chunk_type", 16, 4, 0 },
    { "chunk_flags", 17, 4, 0 },
    { "chunk_size", 18, 4, 0 },
    { "chunk_hash", 20, BYTES, 8 },
    { "n_anchors", 32, 4, 0 },
    { "tile_size", 33, 4, 0 },
    { "n_offsets", 34, 1, 0 },
    { "feature_dim", 35, 1, 0 },
    { "motion", 36, 1, 0 },
    { "phi_dim", 37, 1, 0 },
    { "bank_rows", 38, 4, 0 },
    { "bank_dim", 39, 2, 0 },
    { "deform_layers", 40, 1, 0 },
    { "deform_width", 41, 2, 0 },
    { "temporal_mask", 42, 1, 0 },
    { "offset_mask", 43, 1, 0 },
    { "activation", 44, 1, 0 },
    { "view", 45, 1, 0 },
    { "head_layers", 46, 1, 0 },
    { "head_width", 47, 2, 0 },
    { "scale_domain", 48, 1, 0 },
    { "prior", 49, 1, 0 },
    { "pe_octaves", 50, 1, 0 },
    { "hyper_layers", 51, 1, 0 },
    { "hyper_width", 52, 2, 0 },
    { "n_slices", 53, 1, 0 },
    { "slice", 54, 1, 0 },
    { "ar_width", 55, 2, 0 },
    { "context_bits", 56, 1, 0 },
    { "step", 57, 4, 0 },
    { "frames", 58, 4, 0 },
    { "rate_num", 59, 4, 0 },
    { "rate_den", 60, 4, 0 },
    { "origin", 61, 4, 0 },
    { "exponent", 62, 1, 0 },
    { "background", 63, 1, 0 },
    { "reserved", 64, 1, 0 },
    { "shift", 96, 1, 0 },
    { "mode", 97, 1, 0 },
    { "nete", 98, 4, 0 },
    { "netr", 100, 4, 0 },
    { "bank", 102, 4, 0 },
    { "unit_exponent", 104, 1, 0 },
    { "weights_substream", 105, REST, 0 },
    { "position", 112, 2, 0 },
    { "grid", 113, 1, 0 },
    { "tree_substream", 114, REST, 0 },
    { "tile_index", 128, 4, 0 },
    { "dynamic_prob", 129, 2, 0 },
    { "offset_prob", 130, 2, 0 },
    { "size", 131, 4, 0 },
    { "mask_substream", 132, SUBSTREAM, 0 },
    { "feature_substream", 133, SUBSTREAM, 0 },
    { "scaling_substream", 134, SUBSTREAM, 0 },
    { "offset_substream", 135, SUBSTREAM, 0 },
    { "phi_substream", 136, SUBSTREAM, 0 },
    { "tau_substream", 137, SUBSTREAM, 0 },
};

enum {
    N_TABLE = sizeof table / sizeof *table,
    ID_MAGIC = 1,
    ID_ANCILLARY = 19,
    ID_ENDS_HASH = 160
};

typedef struct {
    const uint8_t *data; /* borrowed: the file */
    ted4_sink *sink;
    void *user;
    uint32_t size[MAX_SUBSTREAMS]; /* sizes of the substreams of the tile */
    unsigned n_opened;
    uint32_t chunk_size;
    size_t payload; /* offset of the chunk's payload */
    int last;       /* entry of the last element: the search for the next one begins there */
} dump;

static void put_number(dump *d, uint16_t id, uint32_t value)
{
    uint8_t record[6];

    ted4_store16(record, id);
    ted4_store32(record + 2, value);
    d->sink(d->user, record, sizeof record);
}

static void put_bytes(dump *d, uint16_t id, size_t offset, uint32_t size)
{
    put_number(d, id, size);
    if (size > 0)
        d->sink(d->user, d->data + offset, size);
}

/* Returns the entry of a name, or -1 if it is a symbol or part of an array that gives one record.
 */
static int find(const dump *d, const char *name)
{
    for (int i = 0; i < N_TABLE; i++) {
        const int at = (d->last + i) % N_TABLE;

        if (strcmp(table[at].name, name) == 0)
            return at;
    }
    return -1;
}

/* Writes the elements that are traced byte by byte, or whose traced value is their size. */
static void put_special(dump *d, size_t offset, const char *name, int64_t index, int64_t value)
{
    if (strcmp(name, "magic") == 0 && index == 0)
        put_bytes(d, ID_MAGIC, offset, 8);
    if (strcmp(name, "ends_hash") == 0 && index == 0)
        put_bytes(d, ID_ENDS_HASH, offset, 16);
    if (strcmp(name, "ancillary") == 0)
        put_bytes(d, ID_ANCILLARY, offset, (uint32_t)value);
}

static void trace(void *user, size_t offset, const char *name, int64_t index, int64_t value)
{
    dump *d = user;
    const int at = find(d, name);

    if (at < 0) {
        put_special(d, offset, name, index, value);
        return;
    }
    const element *e = &table[at];

    d->last = at;
    if (e->width == SUBSTREAM) {
        put_bytes(d, e->id, offset, d->size[d->n_opened++]);
    } else if (e->width == REST) {
        put_bytes(d, e->id, offset, (uint32_t)(d->payload + d->chunk_size - offset));
    } else if (e->width == BYTES) {
        if (d->chunk_size ==
            0) /* only an ancillary chunk can be empty, and an empty one is not traced */
            put_bytes(d, ID_ANCILLARY, offset, 0);
        put_bytes(d, e->id, offset, e->size);
    } else if (index == DEFLATED) {
        put_bytes(d, (uint16_t)(e->id + 1), offset, (uint32_t)value);
    } else {
        put_number(d, e->id, (uint32_t)value);
    }
    if (strcmp(name, "chunk_size") == 0) {
        d->chunk_size = (uint32_t)value;
        d->payload = offset + 4;
    }
    if (strcmp(name, "size") == 0) {
        d->size[index] = (uint32_t)value;
        d->n_opened = 0;
    }
}

ted4_status ted4_dump_syntax(const void *data, size_t size, const ted4_options *o, ted4_sink *sink,
                             void *user, ted4_error *e)
{
    dump d = { .data = data, .sink = sink, .user = user };
    ted4_options own;
    ted4_scene *s;

    memset(&own, 0, sizeof own);
    if (o != NULL)
        own = *o;
    own.trace = trace;
    own.trace_user = &d;

    const ted4_status verdict = ted4_decode(data, size, &own, &s, e);

    ted4_scene_free(s);
    return verdict;
}
