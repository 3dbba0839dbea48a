/* fz_decode_chunked.c - a file that arrives in pieces, whose sizes follow from up to three bytes
 * after its chunk ENDS (R-DEC-004). Decoding begins when the file is complete (13.1), so the pieces
 * are gathered first. What a decoder could say in between is its verdict on the bytes that have
 * arrived so far, a truncated file. Claims: the gathered bytes are those that were sent, and none
 * if the stream breaks; at the end of each piece and chunk the verdict is con.truncated at that
 * place, or one of pass 1 that no later byte changes; or the file was complete there, and the
 * verdict on further bytes is con.trailing. What ted4_read_ted4() leaves unread of a longer file
 * does not change the verdict.
 * SPDX-License-Identifier: BSD-2-Clause */
#define _GNU_SOURCE /* fopencookie(): a stream with its own read function; memfd_create() */
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>
#include "lcg.h"
#include "harness.h"
#include "fix_hashes.h"
#include "read/container.h"
#include "tool/cli.h"

enum { TAIL = 3, MOST_ENDS = 24, MOST_BYTES = 1 << 20 };

/* A stream of size bytes that are read in pieces. */
typedef struct {
    const uint8_t *data;
    size_t size, at;
    uint32_t seed;    /* of the generator of the sizes of pieces */
    unsigned bits;    /* a piece has up to 2^bits bytes */
    size_t breaks_at; /* reading fails from this offset on; SIZE_MAX: never */
} pieces;

static size_t next_piece(pieces *p)
{
    const size_t left = p->size - p->at;
    const size_t n = 1 + (lcg_next(&p->seed) >> 8) % (1u << p->bits);

    return n < left ? n : left;
}

static ssize_t hand_over(void *cookie, char *to, size_t capacity)
{
    pieces *const p = cookie;
    size_t n = next_piece(p);

    if (p->at >= p->breaks_at)
        return -1;
    n = n < capacity ? n : capacity;
    memcpy(to, p->data + p->at, n);
    p->at += n;
    return (ssize_t)n;
}

static uint8_t *gather(pieces p, size_t *size)
{
    FILE *const f = fopencookie(&p, "rb", (cookie_io_functions_t) { .read = hand_over });
    uint8_t *const data = f != NULL ? ted4_read_stream(f, size) : NULL;

    fuzz_require(f != NULL, "memory");
    fclose(f);
    return data;
}

/* Returns the verdict on the first n bytes, which are copied to memory of exactly that size. */
static ted4_error verdict_of(const uint8_t *data, size_t n, int *pass_1)
{
    const ted4_options o = { .max_bytes = FUZZ_MAX_BYTES };
    uint8_t *const copy = malloc(n > 0 ? n : 1);
    ted4_error e = { TED4_OK, 0 };
    ted4_scene *s = NULL;
    ted4_reader r;

    fuzz_require(copy != NULL, "memory");
    memcpy(copy, data, n);
    ted4_reader_init(&r, copy, 0, n, 1);
    ted4_container_check(&r);
    *pass_1 = r.base.error.code == TED4_OK;
    (void)ted4_decode(copy, n, &o, &s, &e);
    ted4_scene_free(s);
    free(copy);
    return e;
}

static void check_end(const uint8_t *data, size_t n, ted4_error whole)
{
    int pass_1;
    const ted4_error e = verdict_of(data, n, &pass_1);

    if (e.code == TED4_E_CON_TRUNCATED)
        fuzz_require(e.offset == n, "truncated where it ends");
    else if (pass_1)
        fuzz_require(whole.code == TED4_E_CON_TRAILING && whole.offset == n,
                     "all that comes behind a complete file is too much");
    else
        fuzz_require(e.code == whole.code && e.offset == whole.offset,
                     "what pass 1 has found stays");
}

/* Zeros behind the bytes make the file longer than the reader's first buffer. */
static void check_longer_file(const uint8_t *data, size_t n)
{
    enum { ZEROS = 1 << 16 };
    const int file = memfd_create("fuzz", 0);
    uint8_t *const all = calloc(n + ZEROS, 1), *some;
    char path[40];
    size_t size = 0;
    int pass_1;

    fuzz_require(file >= 0 && all != NULL, "memory");
    memcpy(all, data, n);
    fuzz_require(write(file, all, n + ZEROS) == (ssize_t)(n + ZEROS), "a file");
    snprintf(path, sizeof path, "/proc/self/fd/%d", file);
    some = ted4_read_ted4(path, &size);
    fuzz_require(some != NULL && size <= n + ZEROS && memcmp(some, all, size) == 0,
                 "the bytes of the file");

    const ted4_error whole = verdict_of(all, n + ZEROS, &pass_1);
    const ted4_error part = verdict_of(some, size, &pass_1);

    fuzz_require(part.code == whole.code && part.offset == whole.offset, "the verdict on all");
    fuzz_require(whole.code != TED4_E_CON_TRAILING || size == n + ZEROS,
                 "a file that its level allows is read whole");
    close(file);
    free(some);
    free(all);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const size_t n = ted4_without_tail(data, size, TAIL);
    fuzz_source in = { data + n, data + size };
    pieces p = { .data = data, .size = n, .breaks_at = SIZE_MAX };
    size_t got = 0;
    uint8_t *all;
    ted4_error whole;
    int pass_1;

    if (n > MOST_BYTES) /* larger files may exceed a level's bound, which is checked first */
        return 0;
    p.seed = fuzz_u16(&in);
    p.bits = fuzz_u8(&in) % 14;
    all = gather(p, &got);
    fuzz_require(all != NULL && got == n && memcmp(all, data, n) == 0, "the bytes that came");
    whole = verdict_of(all, n, &pass_1);
    free(all);
    for (int i = 0; i < MOST_ENDS && p.at < n; i++) {
        p.at += next_piece(&p);
        if (p.at < n)
            check_end(data, p.at, whole);
    }
    for (size_t at = TED4_FILE_HEADER_SIZE, chunks = 0;
         ted4_chunk_size(data, n, at) > 0 && chunks < MOST_ENDS; chunks++) {
        at += ted4_chunk_size(data, n, at);
        if (at < n)
            check_end(data, at, whole);
    }
    check_longer_file(data, n);
    p.breaks_at = n / 2;
    p.at = 0;
    fuzz_require(n == 0 || gather(p, &got) == NULL, "nothing of a stream that breaks");
    return 0;
}
