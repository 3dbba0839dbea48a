/* test_view_subset.c - train/state/view_subset.c: view subsets contain every frame before any frame
 * twice, for any numbers of cameras and frames.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <stdlib.h>

#include "test.h"
#include "train/state/view_subset.h"

enum { MOST = 400 };

/* Pictures are sorted by camera, as in folders. One whole camera is held out, and frame 0 of the
 * first other camera, so that frames have different numbers of pictures. */
static void make(ted4_dataset *d, ted4_picture *picture, uint32_t frames, uint32_t cameras)
{
    *d = (ted4_dataset) { .pictures = picture,
                          .n_pictures = (size_t)frames * cameras,
                          .n_frames = frames };
    for (uint32_t c = 0; c < cameras; c++)
        for (uint32_t f = 0; f < frames; f++)
            picture[c * frames + f] =
                (ted4_picture) { .frame = f, .is_test = c == 1 || (c == 0 && f == 0) };
}

static void check(ted4_trainer *t, uint64_t key, size_t n, size_t frames)
{
    uint32_t item[MOST];
    unsigned times[MOST] = { 0 }, chosen[MOST] = { 0 }, least = MOST, most = 0;

    assert_int_equal(ted4_view_subset_choose(t, key, n, item), 0);
    for (size_t i = 0; i < n; i++) {
        assert_true(item[i] < t->data->n_pictures);
        assert_true(!t->data->pictures[item[i]].is_test);
        assert_int_equal(chosen[item[i]]++, 0);
        times[t->data->pictures[item[i]].frame]++;
    }
    for (size_t f = 1; f < frames; f++) { /* frame 0 has one picture less */
        least = times[f] < least ? times[f] : least;
        most = times[f] > most ? times[f] : most;
    }
    assert_true(most - least <= 1);
    assert_true(times[0] <= least + 1);
}

static void test_all_frames(void **state)
{
    static ted4_picture picture[MOST];
    ted4_dataset d;
    ted4_trainer t = { .data = &d };

    (void)state;
    for (uint32_t frames = 2; frames <= 40; frames += 2)
        for (uint32_t cameras = 3; cameras <= 9; cameras += 3) {
            make(&d, picture, frames, cameras);
            assert_int_equal(ted4_view_subset_frames(&t), frames);
            for (size_t n = 1; n <= (size_t)frames * (cameras - 1) - 1; n += 7)
                check(&t, n + cameras, n, frames);
            check(&t, 5, (size_t)frames * (cameras - 1) - 1, frames);
        }
}

/* If there are many frames, a draw contains some frames and cameras, and two draws differ. */
static void test_drawn(void **state)
{
    static ted4_picture picture[MOST];
    ted4_dataset d;
    ted4_trainer t = { .data = &d };
    uint32_t a[16], b[16];
    int same = 0, odd = 0, late = 0;

    (void)state;
    make(&d, picture, 80, 5);
    assert_int_equal(ted4_view_subset_choose(&t, 1, 16, a), 0);
    assert_int_equal(ted4_view_subset_choose(&t, 2, 16, b), 0);
    for (int i = 0; i < 16; i++) {
        same += a[i] == b[i];
        odd += picture[a[i]].frame % 2;
        late += picture[a[i]].frame >= 40;
    }
    assert_true(same < 4);
    assert_true(odd > 2);
    assert_true(odd < 14);
    assert_true(late > 2);
    assert_true(late < 14);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_all_frames),
        cmocka_unit_test(test_drawn),
    };

    return cmocka_run_group_tests_name("view_subset", tests, NULL, NULL);
}
