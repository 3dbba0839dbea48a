/* test_fuzz.c - the fuzzing harnesses of fuzz/, which are part of this file, over the committed corpus and over changed copies of it, so
 * that they cannot rot; and the corpus itself. Runs in the project's root, as `make test` does.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>
#include <dirent.h>

#define LLVMFuzzerTestOneInput fuzz_decode
#include "../fuzz/fz_decode.c"
#undef LLVMFuzzerTestOneInput
#define LLVMFuzzerTestOneInput fuzz_container
#include "../fuzz/fz_container.c"
#undef LLVMFuzzerTestOneInput
#define LLVMFuzzerTestOneInput fuzz_roundtrip
#include "../fuzz/fz_roundtrip.c"
#undef LLVMFuzzerTestOneInput
#include "../fuzz/mend.h"

#define CORPUS "fuzz/corpus"

enum { MAX_FILES = 64, MAX_SIZE = 1 << 13, CHANGES = 400 };

static struct {
    uint8_t data[MAX_SIZE];
    size_t  size;
} file[MAX_FILES];
static int n_files;

static int setup(void **state)
{
    DIR *const     d = opendir(CORPUS);
    struct dirent *e;
    char           path[512];

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
    assert_int_equal(fuzz_decode(data, size), 0);
    assert_int_equal(fuzz_container(data, size), 0);
}

static ted4_status decode(const uint8_t *data, size_t size, ted4_info *info)
{
    ted4_scene       *s;
    const ted4_status verdict = ted4_decode(data, size, NULL, &s, NULL);

    if (verdict == TED4_OK)
        ted4_scene_info(s, info);
    ted4_scene_free(s);
    return verdict;
}

/* The corpus is valid, small, and covers what a header can say. */
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

static void test_harnesses(void **state)
{
    (void)state;
    run_all(NULL, 0);
    for (int i = 0; i < n_files; i++) {
        run_all(file[i].data, file[i].size);
        assert_int_equal(fuzz_roundtrip(file[i].data, file[i].size), 0);
    }
    assert_int_equal(fuzz_roundtrip((const uint8_t *)"\377\377\377\377\377\377\377\377", 8), 0);
}

/* Changed bytes behind mended hashes reach every part of the decoder; some of the files are valid. */
static void test_changes(void **state)
{
    random_source  r = random_seed(4);
    uint8_t *const data = malloc(MAX_SIZE);
    ted4_info      info;
    int            n_valid = 0, n_unmended = 0;

    (void)state;
    assert_non_null(data);
    for (int i = 0; i < n_files; i++)
        for (int j = 0; j < CHANGES; j++) {
            const size_t size = file[i].size;

            memcpy(data, file[i].data, size);
            data[random_in(&r, 12, (uint32_t)size - 1)] ^= (uint8_t)(1u << random_in(&r, 0, 7));
            n_unmended += decode(data, size, &info) == TED4_OK;
            ted4_mend_chunks(data, size);
            run_all(data, size);
            ted4_mend_ends(data, size);
            run_all(data, size);
            n_valid += decode(data, size, &info) == TED4_OK;
        }
    assert_int_equal(n_unmended, 0);
    assert_true(n_valid > n_files * CHANGES / 20);
    free(data);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_corpus),
        cmocka_unit_test(test_harnesses),
        cmocka_unit_test(test_changes),
    };

    return cmocka_run_group_tests_name("fuzz", tests, setup, NULL);
}
