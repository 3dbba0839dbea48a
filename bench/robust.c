/* robust.c - gives the decoder truncated files and files with a changed byte, and reports its
 * answers.
 *     robust FILE.ted4 [SEED]
 * Every truncation (for a large file, many of them) must be refused. Of 20,000 changes of a single
 * byte, every other one with the hash of its chunk repaired, each must be refused or decode to the
 * same integers (their hash is in ENDS). If a changed file decodes, its changed chunk is reported:
 * in NETR and BANK the integers stay the same and the weights of Tier R differ. A refusal must come
 * with an identifier and an offset inside the file.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <xxhash.h>
#include "../fuzz/fix_hashes.h"
#include "base/bytes.h"
#include "norm/coder.h"

enum {
    N_CHANGES = 20000,
    SMALL = 1 << 16,
    MANY = 4000,
    LAST = 2000,
    CUT = 0,
    CHANGED = 1,
    MENDED = 2,
    PASSES = 3
};

typedef struct {
    uint8_t *data;
    size_t size;
    uint8_t hash[16];
    uint64_t refused[PASSES][TED4_N_STATUS];
    uint64_t valid[PASSES]
                  [TED4_CHUNKS + 2]; /* by chunk type; then ancillary chunks, and the file header */
    uint64_t tried[PASSES];
    uint64_t undone,
        bad; /* undone: the changed byte was part of a hash, and repairing the hash restored it */
    uint64_t random; /* xorshift64* */
} report;

static uint32_t random_below(report *r, size_t n)
{
    r->random ^= r->random >> 12;
    r->random ^= r->random << 25;
    r->random ^= r->random >> 27;
    return (uint32_t)((r->random * 0x2545f4914f6cdd1du >> 32) * n >> 32);
}

static int place_of(const report *r, size_t chunk)
{
    int i = 0;

    if (chunk == r->size)
        return TED4_CHUNKS + 1;
    while (i < TED4_CHUNKS && memcmp(r->data + chunk, ted4_chunk_type[i], 4) != 0)
        i++;
    return i;
}

/* data: allocated on the heap with exactly that size, so that a read past its end is detected.
 * place: where the change is. */
static void decode(report *r, int pass, const uint8_t *data, size_t size, size_t at, int place)
{
    ted4_scene *s = NULL;
    ted4_error e = { TED4_OK, 0 };
    ted4_info info;
    const ted4_status verdict = ted4_decode(data, size, NULL, &s, &e);
    int good;

    r->tried[pass]++;
    if (verdict == TED4_OK) {
        ted4_scene_info(s, &info);
        good = pass != CUT && memcmp(info.hash, r->hash, sizeof info.hash) == 0;
        r->valid[pass][place]++;
    } else {
        good = s == NULL && e.code == verdict && e.offset <= size;
        r->refused[pass][verdict]++;
    }
    if (!good) {
        r->bad++;
        fprintf(stderr, "robust: %s at %zu: %s, offset %zu\n", pass == CUT ? "cut" : "changed", at,
                ted4_status_id(verdict), e.offset);
    }
    ted4_scene_free(s);
}

static uint8_t *copy(const report *r, size_t size)
{
    uint8_t *const data = malloc(size > 0 ? size : 1);

    if (data == NULL) {
        fprintf(stderr, "robust: out of memory\n");
        exit(3);
    }
    memcpy(data, r->data, size);
    return data;
}

/* Cuts the file at every length. A large file is cut at MANY evenly spaced lengths and at the LAST
 * ones. */
static void cut_everywhere(report *r)
{
    const size_t last = r->size <= SMALL ? 0 : r->size - LAST, step = last / MANY + 1;

    for (size_t i = 0; i < r->size; i += i < last ? step : 1) {
        uint8_t *const data = copy(r, i);

        decode(r, CUT, data, i, i, 0);
        free(data);
    }
}

static void change_one(report *r, int pass)
{
    uint8_t *const data = copy(r, r->size);
    const size_t at = random_below(r, r->size), chunk = ted4_chunk_holding(r->data, r->size, at);

    data[at] ^= (uint8_t)(1 + random_below(r, 255));
    if (pass == MENDED && chunk < r->size) {
        const size_t hashed = TED4_FRAME_HEAD_SIZE + (size_t)ted4_load32(r->data + chunk + 8);

        ted4_store64(data + chunk + hashed, XXH3_64bits(data + chunk, hashed));
    }
    if (memcmp(data, r->data, r->size) == 0)
        r->undone++;
    else
        decode(r, pass, data, r->size, at, place_of(r, chunk));
    free(data);
}

static void print_row(const char *name, uint64_t cut, uint64_t changed, uint64_t fixed)
{
    if (cut + changed + fixed > 0)
        printf("| %s | %" PRIu64 " | %" PRIu64 " | %" PRIu64 " |\n", name, cut, changed, fixed);
}

static void print_report(const report *r)
{
    char name[64];

    puts("| verdict | cut | byte changed | byte changed, hash mended |\n|---|---|---|---|");
    for (int s = 0; s < TED4_N_STATUS; s++)
        print_row(ted4_status_id((ted4_status)s), r->refused[CUT][s], r->refused[CHANGED][s],
                  r->refused[MENDED][s]);
    for (int i = 0; i < TED4_CHUNKS + 2; i++) {
        snprintf(name, sizeof name, "valid, same hash: %s%s",
                 i < TED4_CHUNKS    ? ted4_chunk_type[i]
                 : i == TED4_CHUNKS ? "ancillary chunk"
                                    : "file header",
                 i == TED4_NETR || i == TED4_BANK ? " (other weights)" : "");
        print_row(name, r->valid[CUT][i], r->valid[CHANGED][i], r->valid[MENDED][i]);
    }
    print_row("tried", r->tried[CUT], r->tried[CHANGED], r->tried[MENDED]);
    printf("\nNot tried, as mending put the byte back: %" PRIu64 ". Against the rules: %" PRIu64
           ".\n",
           r->undone, r->bad);
}

static int load(report *r, const char *path)
{
    FILE *f = fopen(path, "rb");
    ted4_scene *s = NULL;
    ted4_info info;
    int good;

    r->data = malloc(1 << 28);
    if (f == NULL || r->data == NULL)
        return -1;
    r->size = fread(r->data, 1, 1 << 28, f);
    fclose(f);
    good = ted4_decode(r->data, r->size, NULL, &s, NULL) == TED4_OK;
    if (good) {
        ted4_scene_info(s, &info);
        memcpy(r->hash, info.hash, sizeof r->hash);
    }
    ted4_scene_free(s);
    return good ? 0 : -1;
}

int main(int argc, char **argv)
{
    static report r;

    if (argc < 2 || load(&r, argv[1]) != 0) {
        fprintf(stderr, "robust: usage: robust FILE.ted4 [SEED], a valid file\n");
        return 3;
    }
    r.random = argc > 2 ? strtoull(argv[2], NULL, 10) * 2 + 1 : 1;
    cut_everywhere(&r);
    for (int i = 0; i < N_CHANGES; i++)
        change_one(&r, i % 2 == 0 ? CHANGED : MENDED);
    print_report(&r);
    free(r.data);
    return r.bad > 0;
}
