/* test_canonical.c - R-BIT-002 over every valid vector of the suite, of either profile: a writer
 * that is based on annex J alone reproduces the file from its elements (T0), including ancillary
 * chunks and minor version; and the encoder, which gets only a decoded scene, writes the file
 * without these, bit for bit.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "test.h"
#include "fuzz/fix_hashes.h"
#include "base/bytes.h"
#include "norm/syntax.h"
#include "vector_files.h"
#include "write/encode.h"

enum {
    MAX_FILE = MAX_VECTOR,
    MAX_T0 = 8 * MAX_FILE,
    MAX_ID = 256,
    FEW_FILES = 800,
    MINOR_AT = 9,
    PROFILE_AT = 10
};

/* Bytes of an element that is a number, by annex J.2; 0 if the element consists of bytes, or does
 * not exist. */
static unsigned width_of[MAX_ID];
static int known[MAX_ID];

/* Parses a kind, such as "number u8", "bytes (8)", "number: the four bytes as u32". */
static unsigned number_width(const char *kind)
{
    static const struct {
        const char *name;
        unsigned width;
    } type[] = { { "u8", 1 }, { "i8", 1 }, { "u16", 2 }, { "f16", 2 }, { "u32", 4 }, { "f32", 4 } };

    for (size_t i = 0; strncmp(kind, "number", 6) == 0 && i < sizeof type / sizeof *type; i++)
        if (strstr(kind, type[i].name) != NULL)
            return type[i].width;
    return 0;
}

/* A row of the annex: | 16 | chunk_type | number: the four bytes as u32 | 5.2 | */
static int read_annex(void **state)
{
    FILE *const f = fopen("spec/annex-j-dumps.md", "r");
    char line[1024], kind[200];
    int n = 0;

    (void)state;
    while (f != NULL && fgets(line, sizeof line, f) != NULL) {
        unsigned id;

        if (sscanf(line, "| %u | %*s | %199[^|]", &id, kind) != 2 || id >= MAX_ID)
            continue;
        known[id] = 1;
        width_of[id] = number_width(kind);
        n++;
    }
    if (f != NULL)
        fclose(f);
    return n > 60 ? 0 : -1;
}

/* The bytes of a file, of its tier T0, and of the file written back from that. */
static struct {
    uint8_t file[MAX_FILE], t0[MAX_T0], back[MAX_FILE];
    size_t size, n_t0, n_back;
} x;

static void gather(void *user, const void *bytes, size_t size)
{
    (void)user;
    assert_true(size <= sizeof x.t0 - x.n_t0);
    memcpy(x.t0 + x.n_t0, bytes, size);
    x.n_t0 += size;
}

/* Writes the file that consists of these elements. */
static void write_elements(void)
{
    size_t at = 0;

    x.n_back = 0;
    while (at < x.n_t0) {
        const unsigned id = ted4_load16(x.t0 + at);
        const uint32_t value = ted4_load32(x.t0 + at + 2),
                       n = width_of[id % MAX_ID] > 0 ? width_of[id % MAX_ID] : value;

        assert_true(id < MAX_ID);
        assert_true(known[id]);
        assert_true(n <= sizeof x.back - x.n_back);
        at += 6;
        if (width_of[id] > 0) {
            for (uint32_t i = 0; i < n; i++)
                x.back[x.n_back + i] = (uint8_t)(value >> 8 * i);
        } else {
            memcpy(x.back + x.n_back, x.t0 + at, n);
            at += n;
        }
        x.n_back += n;
    }
    assert_int_equal(at, x.n_t0);
}

/* Without ancillary chunks a file can have too many symbols per byte for its level. */
static void write_scene(const ted4_scene *s)
{
    const size_t n = ted4_plain_file(x.back, x.file, x.size);
    uint8_t *out;
    size_t size;
    const ted4_status verdict = ted4_encode(s, s->level, NULL, &out, &size, NULL);

    assert_true(verdict == TED4_OK || (verdict == TED4_E_LVL_EXCEEDED && n < x.size));
    assert_int_equal(size, verdict == TED4_OK ? n : 0);
    if (verdict == TED4_OK)
        assert_memory_equal(out, x.back, n);
    free(out);
}

static int n_valid, n_compact, n_ancillary, n_minor;

static void write_back(const uint8_t *data, size_t size, const char *path)
{
    ted4_scene *s;

    (void)path;
    memcpy(x.file, data, size);
    x.size = size;
    if (ted4_decode(x.file, x.size, NULL, &s, NULL) != TED4_OK)
        return;
    x.n_t0 = 0;
    assert_int_equal(ted4_dump_syntax(x.file, x.size, NULL, gather, NULL, NULL), TED4_OK);
    write_elements();
    assert_int_equal(x.n_back, x.size);
    assert_memory_equal(x.back, x.file, x.size);
    write_scene(s);
    ted4_scene_free(s);
    n_valid++;
    n_compact += x.file[PROFILE_AT] == TED4_PROFILE_COMPACT;
    n_minor += x.file[MINOR_AT] != 0;
    n_ancillary += ted4_plain_file(x.back, x.file, x.size) < x.size;
}

static void valid_vectors(void **state)
{
    (void)state;
    each_vector("! -path '*/invalid/*'", write_back);
    assert_true(n_valid > FEW_FILES);
    assert_true(n_compact > 200);
    assert_true(n_ancillary > 10);
    assert_true(n_minor > 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test_setup(valid_vectors, read_annex) };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
