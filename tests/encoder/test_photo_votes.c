/* test_photo_votes.c - train/densify/photo_votes.c: the span in which a colour is present at a
 * point, from the number of cameras that look and the number that agree at each time.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <string.h>

#include "test.h"
#include "train/densify/photo_votes.h"

enum { FRAMES = 12, CAMERAS = 6 };

/* One point, with one letter per time: '#' all cameras agree, '+' five of six, '-' four, '=' three,
 * '.' none, '?' too few cameras see the point to decide. */
static ted4_photo_votes seen(const char *times, uint16_t look[FRAMES], uint16_t hits[FRAMES])
{
    assert_int_equal(strlen(times), FRAMES);
    for (int f = 0; f < FRAMES; f++) {
        look[f] = times[f] == '?' ? TED4_CAMERAS_NEEDED - 1 : CAMERAS;
        hits[f] = times[f] == '#'   ? 6
                  : times[f] == '+' ? 5
                  : times[f] == '-' ? 4
                  : times[f] == '=' ? 3
                  : times[f] == '?' ? 2
                                    : 0;
    }
    return (ted4_photo_votes) { .n = 1, .n_frames = FRAMES, .hits = hits, .seen = look };
}

static void expect_span(const char *times, uint32_t frame, const char *wanted)
{
    uint16_t look[FRAMES], hits[FRAMES];
    const ted4_photo_votes s = seen(times, look, hits);
    ted4_span span;
    char got[40] = "none";

    if (ted4_photo_votes_span(&s, 0, frame, &span))
        snprintf(got, sizeof got, "%u-%u before %u after %u", span.from, span.to, span.before,
                 span.after);
    if (strcmp(got, wanted) != 0)
        fail_msg("%s at %u: %s, not %s", times, frame, got, wanted);
}

static void test_run(void **state)
{
    (void)state;
    expect_span("..##+.......", 2, "2-4 before 1 after 1");
    expect_span("..##+.......", 4, "2-4 before 1 after 1");
    expect_span("..##+.......", 5, "none");
    expect_span("##..........", 0, "0-1 before 1 after 1");
    expect_span("..........##", 11, "10-11 before 1 after 1");
    expect_span("............", 3, "none");
}

/* If clearly fewer cameras agree than at the best time, they agree by chance; if the best time is
 * no better, half of the cameras suffice. */
static void test_chance(void **state)
{
    (void)state;
    expect_span("...=#=......", 4, "4-4 before 1 after 1");
    expect_span("...=#=......", 5, "none");
    expect_span("...-+-......", 4, "3-5 before 1 after 1");
    expect_span("...===......", 4, "3-5 before 1 after 1");
}

static void test_stays(void **state)
{
    (void)state;
    expect_span("######------", 2, "0-5 before 1 after 1");
    expect_span("#######-----", 2, "none");
    expect_span("#######.-.--", 2, "none");
    expect_span("#######.-..-", 2, "0-6 before 1 after 1");
    expect_span("#########...", 2, "0-8 before 1 after 1");
    expect_span("##########..", 2, "none");
    expect_span("#####...####", 2, "0-4 before 1 after 1");
    expect_span("#####..#####", 2, "none");
}

/* A colour that returns has two spans; the one with the given best time is found. */
static void test_comes_back(void **state)
{
    (void)state;
    expect_span(".#.....++...", 1, "1-1 before 1 after 1");
    expect_span(".#.....++...", 8, "7-8 before 1 after 1");
}

static void test_unknown(void **state)
{
    (void)state;
    expect_span("..#?#.......", 2, "2-4 before 1 after 1");
    expect_span("..#??.......", 2, "2-2 before 1 after 3");
    expect_span(".?#.........", 2, "2-2 before 2 after 1");
    expect_span("?##.........", 2, "0-2 before 1 after 1");
    expect_span(".........#??", 9, "9-11 before 1 after 1");
    expect_span("..#???????..", 2, "2-2 before 1 after 8");
    expect_span("..#.????????", 2, "2-2 before 1 after 1");
    expect_span("..##????????", 2, "2-11 before 1 after 1");
    expect_span(".####???????", 2, "none"); /* absent at less than a quarter of the known times */
    expect_span("..#?#.......", 3, "none");
}

static void test_best(void **state)
{
    uint16_t look[FRAMES], hits[FRAMES];
    const ted4_photo_votes s = seen(".=?-##..+...", look, hits);

    (void)state;
    assert_int_equal(ted4_photo_votes_best(&s, 0), 4);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_run),     cmocka_unit_test(test_chance),
        cmocka_unit_test(test_stays),   cmocka_unit_test(test_comes_back),
        cmocka_unit_test(test_unknown), cmocka_unit_test(test_best),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
