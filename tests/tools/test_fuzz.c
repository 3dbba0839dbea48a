/* test_fuzz.c - runs every fuzzing harness of fuzz/list.def over its seeds and its regressions, and
 * those of the decoder over changed copies of its seeds, so that no harness becomes outdated; also
 * tests those seeds themselves. Runs in the project's root, as `make test` does.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <dirent.h>
#include <stdio.h>
#include <sys/stat.h>

#include "test.h"
#include "fuzz/inputs.h"
#include "fuzz/fix_hashes.h"
#include "fuzz/mutate.h"
#include "norm/coder.h"
#include "random_scene.h"

#define CORPUS      "fuzz/corpus/ted4"
#define REGRESSIONS "fuzz/regressions"

enum { MAX_FILES = 64, MAX_SIZE = 1 << 13, CHANGES = 400, PROFILE_AT = 10 };

static struct {
    uint8_t data[MAX_SIZE];
    size_t size;
} file[MAX_FILES];
static int n_files;

static int setup(void **state)
{
    DIR *const d = opendir(CORPUS);
    struct dirent *e;
    char path[512];

    (void)state;
    while (d != NULL && (e = readdir(d)) != NULL && n_files < MAX_FILES) {
        FILE *f;

        if (e->d_name[0] == '.')
            continue;
        (void)snprintf(path, sizeof path, CORPUS "/%s", e->d_name);
        f = fopen(path, "rb");
        if (f == NULL)
            return -1;
        file[n_files].size = fread(file[n_files].data, 1, MAX_SIZE, f);
        n_files++;
        fclose(f);
    }
    if (d != NULL)
        closedir(d);
    return n_files > 0 ? 0 : -1;
}

static void run_all(const uint8_t *data, size_t size)
{
    assert_int_equal(fuzz_find("decode")(data, size), 0);
    assert_int_equal(fuzz_find("container")(data, size), 0);
    assert_int_equal(fuzz_find("roundtrip")(data, size), 0);
}

static ted4_status decode(const uint8_t *data, size_t size, ted4_info *info)
{
    ted4_scene *s;
    const ted4_status verdict = ted4_decode(data, size, NULL, &s, NULL);

    if (verdict == TED4_OK)
        ted4_scene_info(s, info);
    ted4_scene_free(s);
    return verdict;
}

/* The corpus is valid, small, and covers the settings of a header. */
static void test_corpus(void **state)
{
    unsigned motion = 0, view = 0, activation = 0, dynamic = 0;

    (void)state;
    assert_true(n_files >= 12);
    for (int i = 0; i < n_files; i++) {
        ted4_info info;

        assert_true(file[i].size < 2048);
        assert_int_equal(decode(file[i].data, file[i].size, &info), TED4_OK);
        motion |= 1u << info.motion;
        view |= 1u << info.view;
        activation |= 1u << info.activation;
        dynamic |= info.n_dynamic > 0 && info.n_dynamic < info.n_anchors;
    }
    assert_int_equal(motion, 15);
    assert_int_equal(view, 7);
    assert_int_equal(activation, 3);
    assert_true(dynamic);
}

/* Returns how many inputs the list of regressions has of a harness, each of which must be there and
 * hold something; NULL: of all. */
static size_t count_listed(const char *harness)
{
    FILE *const f = fopen(REGRESSIONS "/list.txt", "r");
    char line[256], path[512];
    size_t n = 0;

    assert_non_null(f);
    while (fgets(line, sizeof line, f) != NULL) {
        struct stat s;

        line[strcspn(line, "\n")] = '\0';
        const size_t length = strcspn(line, "/");
        if (harness != NULL && (length != strlen(harness) || strncmp(line, harness, length) != 0))
            continue;
        (void)snprintf(path, sizeof path, REGRESSIONS "/%s", line);
        if (stat(path, &s) != 0 || !S_ISREG(s.st_mode) || s.st_size == 0)
            fail_msg("%s is listed, but is not there", path);
        n++;
    }
    fclose(f);
    return n;
}

/* Runs the regressions of a harness, which are those of the list. Returns their number. */
static size_t run_regressions(const fuzz_harness *h)
{
    const size_t listed = count_listed(h->name);
    char path[512];
    struct stat s;
    size_t n = 0;

    (void)snprintf(path, sizeof path, REGRESSIONS "/%s", h->name);
    if (listed > 0 || stat(path, &s) == 0)
        assert_int_equal(fuzz_replay(h->run, path, &n), 0);
    assert_int_equal(n, listed);
    return n;
}

/* A claim that does not hold ends the process; its message comes before the name of the harness
 * here. */
static void test_harnesses(void **state)
{
    char path[512];
    size_t n_regressions = 0;

    (void)state;
    for (const fuzz_harness *h = fuzz_list; h->name != NULL; h++) {
        size_t n = 0;

        printf("%s\n", h->name);
        fflush(stdout);
        (void)snprintf(path, sizeof path, "fuzz/corpus/%s", h->seeds);
        assert_int_equal(fuzz_replay(h->run, path, &n), 0);
        assert_true(n > 0);
        n_regressions += run_regressions(h);
        (void)h->run((const uint8_t *)"", 0);
    }
    assert_true(n_regressions > 0);
    assert_int_equal(n_regressions, count_listed(NULL));
}

/* Changed bytes with correct hashes reach every part of the decoder; some of the files are
 * valid. */
static void test_changes(void **state)
{
    random_source r = random_seed(4);
    uint8_t *const data = malloc(MAX_SIZE);
    ted4_info info;
    int n_valid = 0, n_unfixed = 0;

    (void)state;
    assert_non_null(data);
    for (int i = 0; i < n_files; i++)
        for (int j = 0; j < CHANGES; j++) {
            const size_t size = file[i].size;

            memcpy(data, file[i].data, size);
            data[random_in(&r, 12, (uint32_t)size - 1)] ^= (uint8_t)(1u << random_in(&r, 0, 7));
            n_unfixed += decode(data, size, &info) == TED4_OK;
            ted4_fix_hashes(data, size);
            run_all(data, size);
            ted4_fix_rans_ends(data, size);
            run_all(data, size);
            n_valid += decode(data, size, &info) == TED4_OK;
        }
    assert_int_equal(n_unfixed, 0);
    assert_true(n_valid > n_files * CHANGES / 20);
    free(data);
}

/* The mutator stays within its memory and gives the same result for the same seed. Most of its
 * files are valid, or are refused for something other than a hash. The code that the specification
 * prints gives the same verdict on them as the decoder. */
static void test_mutator(void **state)
{
    enum { CAPACITY = 4 * MAX_SIZE, ROUNDS = 60 };
    uint8_t *const a = malloc(CAPACITY), *const b = malloc(CAPACITY);
    uint64_t met[TED4_N_STATUS] = { 0 };
    size_t kinds = 0;
    ted4_info info;

    (void)state;
    assert_non_null(a);
    assert_non_null(b);
    for (uint32_t i = 0; i < (uint32_t)(n_files * ROUNDS); i++) {
        const int n = (int)i % n_files;
        size_t size;

        memcpy(a, file[n].data, file[n].size);
        memcpy(b, file[n].data, file[n].size);
        size = fuzz_mutate_file(a, file[n].size, CAPACITY, i, fuzz_flip_middle);
        assert_true(size <= CAPACITY);
        assert_int_equal(fuzz_mutate_file(b, file[n].size, CAPACITY, i, fuzz_flip_middle), size);
        assert_memory_equal(a, b, size);
        met[decode(a, ted4_without_tail(a, size, 32), &info)]++;
        (void)fuzz_find("two_decoders")(a, size);
        const int other = (n + 1 + (int)i / n_files) % n_files;

        size = fuzz_cross_files(file[n].data, file[n].size, file[other].data, file[other].size, a,
                                CAPACITY, i);
        assert_true(size <= CAPACITY);
        (void)decode(a, size, &info);
    }
    for (int i = 0; i < TED4_N_STATUS; i++)
        kinds += met[i] > 0;
    assert_true(met[TED4_OK] > (uint64_t)(n_files * ROUNDS / 4));
    assert_true(met[TED4_E_CON_CHUNK_HASH] < (uint64_t)(n_files * ROUNDS / 8));
    assert_true(kinds > 12);
    free(a);
    free(b);
}

/* Fills the payload of the first chunk of a type with any bytes, from byte first on, and corrects
 * its hash. Returns 0 if there is none, or if it is a blob without a substream. */
static int fill_chunk(random_source *r, uint8_t *data, size_t size, const char *type, size_t first)
{
    const int is_blob = strcmp(type, "NETR") == 0 || strcmp(type, "BANK") == 0;
    size_t at = TED4_FILE_HEADER_SIZE;

    while (at < size && memcmp(data + at, type, 4) != 0)
        at += ted4_chunk_size(data, size, at);
    if (at >= size || (is_blob && data[at + TED4_FRAME_HEAD_SIZE] != TED4_BLOB_CODED))
        return 0;
    for (size_t i = TED4_FRAME_HEAD_SIZE + first;
         i + TED4_FRAME_HASH_SIZE < ted4_chunk_size(data, size, at); i++)
        data[at + i] = (uint8_t)random_u32(r);
    ted4_fix_hashes(data, size);
    return 1;
}

/* Any bytes in the substreams of a chunk of profile Compact, behind the grid or the mode, can be
 * turned into places or weights of a valid file. Returns how many chunks were tried. */
static int fix_adaptive(random_source *r, const uint8_t *from, size_t size)
{
    static const char *const type[] = { "NETR", "BANK", "POSN" };
    uint8_t *const data = malloc(2 * MAX_SIZE);
    ted4_info info;
    int n = 0;

    assert_non_null(data);
    for (size_t i = 0; from[PROFILE_AT] == 1 && i < sizeof type / sizeof *type; i++) {
        memcpy(data, from, size);
        if (!fill_chunk(r, data, size, type[i], 1) || decode(data, size, &info) == TED4_OK)
            continue;
        assert_int_equal(decode(data, ted4_fix_range_codes(data, size, 2 * MAX_SIZE), &info),
                         TED4_OK);
        n++;
    }
    free(data);
    return n;
}

/* Any bytes in the substreams can be turned into symbols of a valid file. */
static void test_fix_range_codes(void **state)
{
    random_source r = random_seed(9);
    uint8_t *const data = malloc(2 * MAX_SIZE);
    ted4_info info;
    int n_adaptive = 0;

    (void)state;
    assert_non_null(data);
    for (int i = 0; i < n_files; i++) {
        size_t size = file[i].size;

        memcpy(data, file[i].data, size);
        assert_true(fill_chunk(&r, data, size, "TILE", 0));
        assert_int_not_equal(decode(data, size, &info), TED4_OK);
        size = ted4_fix_range_codes(data, size, 2 * MAX_SIZE);
        assert_int_equal(decode(data, size, &info), TED4_OK);
        n_adaptive += fix_adaptive(&r, file[i].data, file[i].size);
    }
    assert_true(n_adaptive > 12);
    free(data);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_corpus),          cmocka_unit_test(test_harnesses),
        cmocka_unit_test(test_changes),         cmocka_unit_test(test_mutator),
        cmocka_unit_test(test_fix_range_codes),
    };

    return cmocka_run_group_tests_name("fuzz", tests, setup, NULL);
}
