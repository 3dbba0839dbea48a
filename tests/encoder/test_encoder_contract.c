/* test_encoder_contract.c - spec 3.4 for random scenes, and for levels that a caller requests.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "test.h"
#include "encoder_contract.h"
#include "random_scene.h"

enum { N_SCENES = 60 };

static void random_scenes(void **state)
{
    (void)state;
    for (uint64_t seed = 0; seed < N_SCENES; seed++) {
        random_source r = random_seed(seed + 40);
        ted4_header h = random_header(&r);
        ted4_scene *s;

        if (seed % 3 == 1)
            h.frames = 65 + (uint32_t)seed; /* more than level 1 allows */
        if (seed % 3 == 2)
            h.frames = seed % 2 ? 3601 : 36001;
        s = random_scene_of(&r, &h, (int)(seed % 2));
        assert_non_null(s);
        contract_kept(s, 0);
        ted4_scene_free(s);
    }
}

/* A level that the caller requests is declared if the file satisfies it, and refused otherwise. */
static void levels_asked_for(void **state)
{
    random_source r = random_seed(9);
    ted4_header h = random_header(&r);
    ted4_scene *s;

    (void)state;
    h.frames = 601;
    s = random_scene_of(&r, &h, 0);
    for (int level = 1; level <= TED4_LEVEL_UNBOUNDED;
         level = level == 4 ? TED4_LEVEL_UNBOUNDED : level + 1) {
        uint8_t *data;
        size_t size;
        const ted4_status e = ted4_encode(s, level, NULL, &data, &size, NULL);

        assert_int_equal(e, level < 3 ? TED4_E_LVL_EXCEEDED : TED4_OK);
        if (e == TED4_OK)
            assert_int_equal(data[LEVEL_AT], level);
        free(data);
    }
    ted4_scene_free(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(random_scenes),
        cmocka_unit_test(levels_asked_for),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
