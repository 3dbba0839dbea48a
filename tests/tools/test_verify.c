/* test_verify.c - the comparison that the encoder makes after decoding its own file: any difference
 * in the scene is detected.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "test.h"
#include "random_scene.h"
#include "tool/verify.h"

static ted4_scene *scene;
static uint8_t *bytes;
static size_t size;

static int set_up(void **state)
{
    random_source r = random_seed(5);
    const ted4_header h = random_paper_header(200);

    (void)state;
    scene = random_scene_of(&r, &h, 0);
    return scene == NULL || ted4_encode(scene, 0, NULL, &bytes, &size, NULL) != TED4_OK;
}

static int tear_down(void **state)
{
    (void)state;
    ted4_scene_free(scene);
    free(bytes);
    return 0;
}

static int verify(void)
{
    ted4_verified v;
    char why[256] = "";
    const int result = ted4_verify(scene, bytes, size, NULL, &v, why, sizeof why);

    assert_true(result == 0 || strstr(why, "differs from the encoded one") != NULL);
    return result;
}

/* Changes the value in this place of the scene, and restores it afterwards. */
static void tamper(void *at, size_t width)
{
    uint8_t *const byte = (uint8_t *)at + width / 2;

    *byte ^= 1;
    assert_int_equal(verify(), -1);
    *byte ^= 1;
    assert_int_equal(verify(), 0);
}

static void test_header(void **state)
{
    ted4_header *h = &scene->head;

    (void)state;
    assert_int_equal(verify(), 0);
    tamper(&h->rate_num, 4);
    tamper(&h->rate_den, 4);
    tamper(&h->frames, 4);
    tamper(&h->origin[1], 4);
    tamper(&h->exponent, 1);
    tamper(&h->background[2], 1);
    tamper(&h->step[TED4_OFFSET], 4);
    tamper(&h->tile_size, 4);
    tamper(&h->context_bits, 1);
    tamper(&h->view, 1);
    tamper(&h->scale_domain, 1);
    tamper(&h->n_anchors, 0);
    tamper(&h->n_offsets, 1);
    tamper(&h->feature_dim, 1);
}

static void test_arrays(void **state)
{
    ted4_scene *s = scene;

    (void)state;
    assert_true(s->nete.n > 1);
    assert_true(s->netr.n > 1);
    assert_true(s->bank.n > 1);
    assert_true(s->shape.n_units > 1);
    tamper(&s->nete.values[1], 4);
    tamper(&s->netr.values[s->netr.n - 1], 4);
    tamper(&s->bank.values[0], 4);
    tamper(&s->nete.n, 0);
    tamper(&s->netr.n, 0);
    tamper(&s->bank.n, 0);
    tamper(&s->shift[1], 1);
    tamper(&s->position[7], 2);
    tamper(&s->dynamic[3], 1);
    tamper(&s->offset_bits[4], 2);
    for (int y = 0; y < TED4_TYPES; y++) {
        assert_true(s->shape.dim[y] > 0);
        tamper(&s->step_index[y][11], 1);
        tamper(&s->symbol[y][13], 2);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(test_header),
                                        cmocka_unit_test(test_arrays) };

    return cmocka_run_group_tests_name("comparison after encoding", tests, set_up, tear_down);
}
