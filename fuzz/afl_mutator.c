/* afl_mutator.c - AFL++'s entry points to mutate.h: a library for AFL_CUSTOM_MUTATOR_LIBRARY, for
 * the harnesses whose input is a .ted4 file. AFL++ also applies mutations of its own; before such
 * an input is run, its hashes are corrected, fifteen times in sixteen.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <stdlib.h>
#include <string.h>
#include "fix_hashes.h"
#include "mutate.h"
#include "random_scene.h"

enum { CAPACITY = 1 << 16, ONE_STALE_OF = 16, MAX_TAIL = 32 };

typedef struct {
    random_source r;
    uint8_t fuzzed[CAPACITY], fixed[CAPACITY];
} state;

static random_source bytes_source;

void *afl_custom_init(void *afl, unsigned seed);
size_t afl_custom_fuzz(void *data, uint8_t *buf, size_t buf_size, uint8_t **out, uint8_t *add,
                       size_t add_size, size_t max_size);
size_t afl_custom_post_process(void *data, uint8_t *buf, size_t buf_size, uint8_t **out);
void afl_custom_deinit(void *data);

/* Used where the structure of the bytes is unknown: changes a few bytes, inserts some, or removes
 * some. */
static size_t some_bytes(uint8_t *data, size_t size, size_t max_size)
{
    random_source *r = &bytes_source;

    if (size < max_size && random_in(r, 0, 3) == 0)
        data[size++] = (uint8_t)random_u32(r);
    if (size > 0 && random_in(r, 0, 3) == 0)
        size--;
    for (uint32_t i = random_in(r, 1, 4); size > 0 && i > 0; i--)
        data[random_u32(r) % size] = (uint8_t)random_u32(r);
    return size;
}

void *afl_custom_init(void *afl, unsigned seed)
{
    state *const s = calloc(1, sizeof *s);

    (void)afl;
    if (s != NULL)
        s->r = random_seed(seed);
    bytes_source = random_seed(seed + 1u);
    return s;
}

size_t afl_custom_fuzz(void *data, uint8_t *buf, size_t buf_size, uint8_t **out, uint8_t *add,
                       size_t add_size, size_t max_size)
{
    state *s = data;
    const size_t capacity = max_size < CAPACITY ? max_size : CAPACITY;
    size_t n = buf_size < capacity ? buf_size : capacity;

    *out = s->fuzzed;
    if (add != NULL && add_size > 0 && random_in(&s->r, 0, 7) == 0) {
        const size_t crossed =
            fuzz_cross_files(buf, n, add, add_size, s->fuzzed, capacity, random_u32(&s->r));

        if (crossed > 0)
            return crossed;
    }
    memcpy(s->fuzzed, buf, n);
    return fuzz_mutate_file(s->fuzzed, n, capacity, random_u32(&s->r), some_bytes);
}

size_t afl_custom_post_process(void *data, uint8_t *buf, size_t buf_size, uint8_t **out)
{
    state *s = data;

    *out = buf;
    if (buf_size > CAPACITY || random_in(&s->r, 1, ONE_STALE_OF) == 1)
        return buf_size;
    memcpy(s->fixed, buf, buf_size);
    ted4_fix_hashes(s->fixed, ted4_without_tail(s->fixed, buf_size, MAX_TAIL));
    *out = s->fixed;
    return buf_size;
}

void afl_custom_deinit(void *data)
{
    free(data);
}
