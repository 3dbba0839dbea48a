/* test_hostile.c - files that are made to cause much work: the work of a validator, or of a decoder
 * with a trace, is bounded by their bytes. The tests take seconds; they would take hours or days if
 * the work grew with the square of the file size or with a number that the file only claims.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>
#include <xxhash.h>

#include "test.h"
#include "fuzz/fix_hashes.h"
#include "random_scene.h"

enum {
    PATIENCE = 60,
    N_CHUNKS = 1 << 20,
    N_KEYS = 1 << 20,
    FRAME = 20,
    LEVEL_AT = 11,
    HEAD_AT = 12,
    LARGE = 4
};

/* A valid file, and room for more after HEAD. */
typedef struct {
    uint8_t *data;
    size_t size, head; /* head: offset after HEAD */
} file;

static file file_of(const ted4_header *h, size_t more)
{
    random_source r = random_seed(5);
    ted4_scene *s = random_scene_of(&r, h, 0);
    uint8_t *data;
    size_t size;
    file f;

    assert_int_equal(ted4_encode(s, 0, NULL, &data, &size, NULL), TED4_OK);
    f.head = HEAD_AT + ted4_chunk_size(data, size, HEAD_AT);
    f.size = size + more;
    f.data = malloc(f.size);
    assert_non_null(f.data);
    memcpy(f.data, data, f.head);
    memset(f.data + f.head, 0, more);
    memcpy(f.data + f.head + more, data + f.head, size - f.head);
    if (more > 0)
        f.data[LEVEL_AT] = LARGE;
    free(data);
    ted4_scene_free(s);
    return f;
}

/* Counts the findings of a validator. */
typedef struct {
    const char *id;
    size_t n;
} count;

static void add(void *user, const ted4_finding *f)
{
    count *c = user;

    c->n += strcmp(f->id, c->id) == 0;
}

static size_t found(const file *f, const char *id, ted4_status wanted)
{
    count c = { id, 0 };

    (void)alarm(PATIENCE);
    assert_int_equal(ted4_validate(f->data, f->size, NULL, add, &c), wanted);
    (void)alarm(0);
    return c.n;
}

/* Each chunk has a wrong hash. */
static void chunks(void **state)
{
    const ted4_header h = random_small_header(100);
    file f = file_of(&h, (size_t)N_CHUNKS * FRAME);

    (void)state;
    for (size_t i = 0; i < N_CHUNKS; i++)
        memcpy(f.data + f.head + i * FRAME, "xabc", 4);
    assert_int_equal(found(&f, "con.chunk-hash", TED4_E_CON_CHUNK_HASH), N_CHUNKS);
    free(f.data);
}

/* Lines of META, the last of which has the key of the first. */
static void keys(void **state)
{
    enum { LINE = 9 };
    const ted4_header h = random_small_header(100);
    const size_t n = (size_t)N_KEYS * LINE;
    file f = file_of(&h, n + FRAME);
    uint8_t *chunk = f.data + f.head;

    (void)state;
    memcpy(chunk, "META\2", 5);
    ted4_store32(chunk + 8, (uint32_t)n);
    for (size_t i = 0; i < N_KEYS; i++) {
        char line[LINE + 1];

        snprintf(line, sizeof line, "%07x=\n",
                 (unsigned)(i + 1 < N_KEYS ? i * 2654435761u % N_KEYS : 0));
        memcpy(chunk + 12 + i * LINE, line, LINE);
    }
    ted4_store64(chunk + 12 + n, XXH3_64bits(chunk, 12 + n));
    assert_int_equal(found(&f, "adv.meta-key", TED4_OK), 1);
    assert_int_equal(found(&f, "adv.meta-text", TED4_OK), 0);
    free(f.data);
}

/* A file with a time for every row, and billions more; and one with fewer times than rows. */
static void frames(void **state)
{
    ted4_header h = random_small_header(100);
    file f;

    (void)state;
    h.bank_rows = 5;
    h.frames = UINT32_MAX;
    f = file_of(&h, 0);
    assert_int_equal(found(&f, "adv.bank-rows", TED4_OK), 0);
    free(f.data);
    h.frames = 3;
    f = file_of(&h, 0);
    assert_int_equal(found(&f, "adv.bank-rows", TED4_OK), 1);
    free(f.data);
}

static void see(void *user, size_t offset, const char *element, int64_t index, int64_t value)
{
    (void)offset;
    (void)element;
    (void)index;
    (void)value;
    ++*(size_t *)user;
}

/* HEAD claims 2^32 - 1 rows, which BANK does not have. */
static void claims(void **state)
{
    static const char *const name[] = { "LIM-claims-rows-0xffffffff",
                                        "LIM-claims-rows-deflated-0xffffffff",
                                        "LIM-claims-anchors-0xffffffff" };
    static uint8_t data[1 << 16];

    (void)state;
    for (size_t i = 0; i < sizeof name / sizeof *name; i++) {
        size_t calls = 0, size;
        ted4_options o = { .trace = see, .trace_user = &calls };
        ted4_scene *s;
        ted4_error e;
        char path[200];
        FILE *f;

        snprintf(path, sizeof path, "conformance/vectors/limit/%s.ted4", name[i]);
        f = fopen(path, "rb");
        assert_non_null(f);
        size = fread(data, 1, sizeof data, f);
        fclose(f);
        (void)alarm(PATIENCE);
        assert_int_equal(ted4_status_verdict(ted4_decode(data, size, &o, &s, &e)), TED4_INVALID);
        (void)alarm(0);
        assert_true(calls > 0);
        assert_true(calls <= size);
        assert_null(s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(chunks),
        cmocka_unit_test(keys),
        cmocka_unit_test(frames),
        cmocka_unit_test(claims),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
