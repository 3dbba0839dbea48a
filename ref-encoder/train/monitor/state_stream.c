/* state_stream.c - see state_stream.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "state_stream.h"

#include <stdlib.h>
#include <string.h>

/* Returns 0, or -1 if memory ran out. */
static int append(ted4_state_stream *s, const void *p, size_t size)
{
    ted4_snapshot *m = s->memory;

    if (size > s->capacity - m->size) {
        const size_t capacity = 2 * s->capacity > m->size + size ? 2 * s->capacity : m->size + size;
        char *bytes = realloc(m->bytes, capacity);

        if (bytes == NULL)
            return -1;
        m->bytes = bytes;
        s->capacity = capacity;
    }
    memcpy(m->bytes + m->size, p, size);
    m->size += size;
    return 0;
}

static int get(ted4_state_stream *s, void *p, size_t size)
{
    if (size > s->memory->size - s->at)
        return -1;
    memcpy(p, s->memory->bytes + s->at, size);
    s->at += size;
    return 0;
}

void ted4_state_put(ted4_state_stream *s, void *p, size_t size)
{
    if (s->failed || size == 0)
        return;
    if (s->file != NULL)
        s->failed = (s->writing ? fwrite(p, 1, size, s->file) : fread(p, 1, size, s->file)) != size;
    else
        s->failed = (s->writing ? append(s, p, size) : get(s, p, size)) != 0;
    if (s->failed)
        return;
    s->left -= s->writing ? 0 : size;
    /* A snapshot in memory was verified as a whole (intact_memory). */
    if (s->writing || s->file != NULL)
        XXH3_64bits_update(s->hash, p, size);
}

void ted4_state_expect(ted4_state_stream *s, uint64_t value)
{
    uint64_t x = value;

    ted4_state_put(s, &x, sizeof x);
    s->failed |= x != value;
}

static int intact_memory(ted4_state_stream *s)
{
    const ted4_snapshot *m = s->memory;
    uint64_t want;

    if (m->size < sizeof want)
        return 0;
    s->left = m->size;
    XXH3_64bits_update(s->hash, m->bytes, m->size - sizeof want);
    memcpy(&want, m->bytes + m->size - sizeof want, sizeof want);
    return XXH3_64bits_digest(s->hash) == want;
}

static int intact_file(ted4_state_stream *s)
{
    uint8_t bytes[1 << 14];
    uint64_t want;
    long left = fseek(s->file, 0, SEEK_END) == 0 ? ftell(s->file) - (long)sizeof want : -1;

    if (left < 0 || fseek(s->file, 0, SEEK_SET) != 0)
        return 0;
    s->left = (uint64_t)left + sizeof want;
    while (left > 0) {
        const size_t n = left < (long)sizeof bytes ? (size_t)left : sizeof bytes;

        if (fread(bytes, 1, n, s->file) != n)
            return 0;
        XXH3_64bits_update(s->hash, bytes, n);
        left -= (long)n;
    }
    return fread(&want, 1, sizeof want, s->file) == sizeof want &&
           XXH3_64bits_digest(s->hash) == want && fseek(s->file, 0, SEEK_SET) == 0;
}

int ted4_state_intact(ted4_state_stream *s)
{
    return s->file != NULL ? intact_file(s) : intact_memory(s);
}

void ted4_state_hash(ted4_state_stream *s)
{
    uint64_t hash = XXH3_64bits_digest(s->hash);

    if (s->writing || s->file != NULL)
        ted4_state_expect(s, hash);
    else
        ted4_state_put(s, &hash, sizeof hash);
}
