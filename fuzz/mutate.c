/* mutate.c - see mutate.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "mutate.h"

#include "fields.h"
#include "fix_hashes.h"
#include "mutate_scene.h"
#include "norm/coder.h"
#include "parse.h"

enum { MAX_FIELDS = 1 << 13, MAX_TAIL = 32, ONE_STALE_OF = 16, PROFILE_BYTE = 10 };

/* A file that is being changed. */
typedef struct {
    uint8_t *data;
    size_t size, max_size;
    random_source r;
    int coded; /* bytes of a substream may have been changed */
} file;

static uint64_t load(const uint8_t *p, unsigned width)
{
    uint64_t v = 0;

    for (unsigned i = 0; i < width; i++)
        v |= (uint64_t)p[i] << 8 * i;
    return v;
}

static void store(uint8_t *p, unsigned width, uint64_t v)
{
    for (unsigned i = 0; i < width; i++)
        p[i] = (uint8_t)(v >> 8 * i);
}

static void change_field(file *f)
{
    static fuzz_field fields[MAX_FIELDS];
    const size_t n = fuzz_fields(f->data, f->size, fields, MAX_FIELDS);
    const fuzz_field *x, *y;
    uint64_t v;

    if (n == 0)
        return;
    /* Most fields are weights and positions, so half of the time one of the first 100 is chosen. */
    x = &fields[random_in(&f->r, 0, (uint32_t)(random_in(&f->r, 0, 1) && n > 100 ? 99 : n - 1))];
    y = &fields[random_in(&f->r, 0, (uint32_t)n - 1)];
    v = load(f->data + x->at, x->width);
    switch (random_in(&f->r, 0, 5)) {
    case 0: v += 1; break;
    case 1: v -= 1; break;
    case 2: v ^= (uint64_t)1 << random_in(&f->r, 0, 8 * x->width - 1); break;
    case 3: v = load(f->data + y->at, y->width); break;
    default: v = fuzz_boundary(&f->r); break;
    }
    store(f->data + x->at, x->width, v);
}

/* Parses the file, changes some of the scene, and writes it again. */
static void change_scene(file *f)
{
    size_t ends, n = 0;
    ted4_scene *const s = fuzz_parse(f->data, f->size, 0, &ends);
    uint8_t *out = NULL;

    if (s == NULL)
        return;
    fuzz_change_scene(&f->r, s);
    if (ted4_encode(s, 0, NULL, &out, &n, NULL) == TED4_OK && n <= f->max_size) {
        memcpy(f->data, out, n);
        f->size = n;
    }
    free(out);
    ted4_scene_free(s);
}

/* Replaces the file by another scene with any header. */
static void make_scene(file *f)
{
    ted4_scene *const s = fuzz_any_scene(&f->r);
    uint8_t *out = NULL;
    size_t n = 0;

    if (s != NULL && ted4_encode(s, 0, NULL, &out, &n, NULL) == TED4_OK && n <= f->max_size) {
        memcpy(f->data, out, n);
        f->size = n;
    }
    free(out);
    ted4_scene_free(s);
}

/* Replaces [at, at + old) by n bytes, if they fit. Returns 1 if it was done. */
static int splice(file *f, size_t at, size_t old, const uint8_t *with, size_t n)
{
    uint8_t *const copy = malloc(n > 0 ? n : 1);

    if (copy == NULL || f->size - old + n > f->max_size) {
        free(copy);
        return 0;
    }
    if (n > 0)
        memcpy(copy, with, n); /* the source may lie in the file itself */
    memmove(f->data + at + n, f->data + at + old, f->size - at - old);
    memcpy(f->data + at, copy, n);
    f->size += n - old;
    free(copy);
    return 1;
}

/* Returns the offset of a random chunk, or size if there is none. */
static size_t any_chunk(file *f)
{
    return f->size == 0
               ? 0
               : ted4_chunk_holding(f->data, f->size, random_in(&f->r, 0, (uint32_t)f->size - 1));
}

static void change_chunks(file *f)
{
    static const uint8_t extra[TED4_FRAME_HEAD_SIZE + 4 + TED4_FRAME_HASH_SIZE] =
        "META\2\0\0\0\4\0\0\0a=b\n";
    const size_t at = any_chunk(f), to = any_chunk(f);
    const size_t n = at < f->size ? ted4_chunk_size(f->data, f->size, at) : 0;

    if (n == 0 || to >= f->size)
        return;
    switch (random_in(&f->r, 0, 4)) {
    case 0: (void)splice(f, at, n, NULL, 0); break;
    case 1: (void)splice(f, to, 0, f->data + at, n); break;
    case 2: (void)splice(f, at, 0, extra, sizeof extra); break;
    case 3: f->data[at + random_in(&f->r, 0, 3)] ^= (uint8_t)(1u << random_in(&f->r, 0, 6)); break;
    default:
        f->data[at + 4 + random_in(&f->r, 0, 3)] ^= (uint8_t)(1u << random_in(&f->r, 0, 7));
        break;
    }
}

/* Returns whether a chunk has substreams: a TILE, or one of those that have them in profile Compact
 * only. */
static int has_substreams(const file *f, size_t at)
{
    if (memcmp(f->data + at, ted4_chunk_type[TED4_TILE], 4) == 0)
        return 1;
    for (int i = TED4_NETE; i <= TED4_POSN; i++)
        if (memcmp(f->data + at, ted4_chunk_type[i], 4) == 0)
            return f->data[PROFILE_BYTE] == TED4_PROFILE_COMPACT;
    return 0;
}

/* Changes bytes of one payload, and corrects its size. */
static void change_payload(file *f, fuzz_bytes_fn *bytes)
{
    const size_t at = any_chunk(f);
    size_t old, capacity, n;
    uint8_t *payload;

    if (at >= f->size)
        return;
    f->coded = has_substreams(f, at);
    old = ted4_load32(f->data + at + 8);
    capacity = old + (f->max_size - f->size);
    payload = malloc(capacity > 0 ? capacity : 1);
    if (payload == NULL)
        return;
    memcpy(payload, f->data + at + TED4_FRAME_HEAD_SIZE, old);
    n = bytes(payload, old, capacity);
    if (splice(f, at + TED4_FRAME_HEAD_SIZE, old, payload, n))
        ted4_store32(f->data + at + 8, (uint32_t)n);
    free(payload);
}

/* Breaks again one of the things that fixing hashes corrects. */
static void leave_stale(file *f)
{
    const size_t at = any_chunk(f);
    size_t n;

    if (at >= f->size)
        return;
    n = ted4_chunk_size(f->data, f->size, at);
    if (random_in(&f->r, 0, 1))
        f->data[at + n - 1 - random_in(&f->r, 0, 7)] ^= (uint8_t)random_in(&f->r, 1, 255);
    else {
        f->data[at + n - 9] ^=
            (uint8_t)random_in(&f->r, 1, 255); /* in the last word, or in the hash in ENDS */
        ted4_fix_hashes(f->data, f->size);
    }
}

static void make_right(file *f)
{
    ted4_fix_hashes(f->data, f->size);
    if (f->coded && random_in(&f->r, 0, 2))
        f->size = ted4_fix_range_codes(f->data, f->size, f->max_size);
    if (random_in(&f->r, 0, 3))
        ted4_fix_rans_ends(f->data, f->size);
    if (random_in(&f->r, 1, ONE_STALE_OF) == 1)
        leave_stale(f);
}

/* Keeps the bytes after ENDS, or chooses new ones. Returns the whole size. */
static size_t add_tail(file *f, const uint8_t *tail, size_t n)
{
    uint8_t other[MAX_TAIL];
    uint32_t n_other = random_in(&f->r, 0, 3) == 0 ? MAX_TAIL : random_in(&f->r, 1, 3);

    if (random_in(&f->r, 0, 7) > 0) {
        n_other = (uint32_t)n;
        memcpy(other, tail, n);
    } else {
        for (uint32_t i = 0; i < n_other; i++)
            other[i] = (uint8_t)random_u32(&f->r);
    }
    if (n_other > f->max_size - f->size)
        n_other = (uint32_t)(f->max_size - f->size);
    memcpy(f->data + f->size, other, n_other);
    return f->size + n_other;
}

size_t fuzz_mutate_file(uint8_t *data, size_t size, size_t max_size, uint32_t seed,
                        fuzz_bytes_fn *bytes)
{
    file f = { data, ted4_without_tail(data, size, MAX_TAIL), max_size, random_seed(seed), 0 };
    const size_t n_tail = size - f.size;
    uint8_t tail[MAX_TAIL];

    if (n_tail > 0)
        memcpy(tail, data + f.size, n_tail);
    for (int i = 0; i < 4; i++) /* the first numbers of similar seeds are similar */
        (void)random_u32(&f.r);
    switch (random_in(&f.r, 0, 15)) {
    case 0: f.size = bytes(data, f.size, max_size); break;
    case 1: make_scene(&f); break;
    case 2:
    case 3: change_chunks(&f); break;
    case 4:
    case 5:
    case 6:
    case 7: change_payload(&f, bytes); break;
    case 8:
    case 9:
    case 10:
    case 11: change_scene(&f); break;
    default: change_field(&f); break;
    }
    make_right(&f);
    return add_tail(&f, tail, n_tail);
}

size_t fuzz_mutate_frames(uint8_t *data, size_t size, size_t max_size, uint32_t seed,
                          fuzz_bytes_fn *bytes)
{
    file f = { data, size, max_size, random_seed(seed), 0 };

    for (int i = 0; i < 4; i++)
        (void)random_u32(&f.r);
    switch (random_in(&f.r, 0, 3)) {
    case 0: f.size = bytes(data, size, max_size); break;
    case 1: change_payload(&f, bytes); break;
    default: change_chunks(&f); break;
    }
    if (random_in(&f.r, 1, ONE_STALE_OF) > 1)
        ted4_fix_hashes(f.data, f.size);
    return f.size;
}

size_t fuzz_cross_files(const uint8_t *a, size_t a_size, const uint8_t *b, size_t b_size,
                        uint8_t *to, size_t max_size, uint32_t seed)
{
    file f = { to, ted4_without_tail(a, a_size, MAX_TAIL), max_size, random_seed(seed), 0 };
    size_t from, at, n;

    if (f.size > max_size || b_size == 0)
        return 0;
    memcpy(to, a, f.size);
    (void)random_u32(&f.r);
    from = ted4_chunk_holding(b, b_size, random_in(&f.r, 0, (uint32_t)b_size - 1));
    n = from < b_size ? ted4_chunk_size(b, b_size, from) : 0;
    for (at = TED4_FILE_HEADER_SIZE; n > 0 && at < f.size; at += ted4_chunk_size(to, f.size, at)) {
        const size_t old = ted4_chunk_size(to, f.size, at);

        if (old == 0)
            return 0;
        if (memcmp(to + at, b + from, 4) != 0)
            continue;
        f.coded = has_substreams(&f, at);
        if (!splice(&f, at, random_in(&f.r, 0, 7) ? old : 0, b + from, n))
            return 0;
        make_right(&f);
        return f.size;
    }
    return 0;
}
