/* test_sweep_depths.c - train/densify/sweep_depths.h: every level judges depths exactly as the
 * definition does, which takes one point and one picture at a time.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "test.h"
#include "random_source.h"
#include "train/densify/error_view.h"
#include "train/densify/photo_votes.h"
#include "train/densify/sweep_depths.h"
#include "train/densify/view_geometry.h"

enum { VIEWS = 6, WIDTH = 37, HEIGHT = 23, DEPTHS = 45, RAYS = 400 };

static ted4_sweep_view views[VIEWS];

/* A camera about two units before the cube, which looks at it; the last one looks away. The tested
 * depths of every other one end within the cube, those of the others beyond it. */
static void aim(ted4_sweep_view *s, random_source *r, int i)
{
    const int away = i == VIEWS - 1;
    const float a = random_float(r, -0.5f, 0.5f), c = cosf(a), d = sinf(a);
    const float R[9] = { c, 0, d, 0, 1, 0, -d, 0, c };

    s->view = (ted4_view) { .width = WIDTH,
                            .height = HEIGHT,
                            .fx = 40,
                            .fy = 38,
                            .cx = 18.2f,
                            .cy = 11.9f,
                            .near_z = 0.01f };
    memcpy(s->view.R, R, sizeof R);
    s->view.t[0] = random_float(r, -0.3f, 0.3f);
    s->view.t[1] = random_float(r, -0.3f, 0.3f);
    s->view.t[2] = away ? -2.0f : random_float(r, 1.0f, 2.5f);
    s->nearest = 0.3f;
    s->farthest = i % 2 ? 1.5f : 5.0f;
    s->depths = DEPTHS;
}

/* Colours of two kinds, so that many pixels agree, and errors on both sides of the threshold. */
static void paint(ted4_sweep_view *s, random_source *r)
{
    for (size_t i = 0; i < (size_t)WIDTH * HEIGHT; i++) {
        const uint32_t grey = random_u32(r) % 2 ? 60 : 90;

        s->pixel[i] = (grey + random_u32(r) % 30) | (grey + random_u32(r) % 30) << 8 |
                      (grey + random_u32(r) % 30) << 16 |
                      (TED4_MISSING / 2 - 4 + random_u32(r) % 12) << 24;
    }
}

static int set_up(void **state)
{
    random_source r = random_seed(5);

    (void)state;
    for (int i = 0; i < VIEWS; i++) {
        views[i].pixel = malloc(sizeof(uint32_t) * WIDTH * HEIGHT);
        assert_non_null(views[i].pixel);
        aim(&views[i], &r, i);
        paint(&views[i], &r);
    }
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    for (int i = 0; i < VIEWS; i++)
        free(views[i].pixel);
    return 0;
}

static void unpack(uint32_t pixel, uint8_t colour[3])
{
    for (int c = 0; c < 3; c++)
        colour[c] = (uint8_t)(pixel >> 8 * c);
}

/* One depth, by the definition. Lane k of *d. */
static void judge(const ted4_sweep_ray *r, int depth, ted4_swept_depths *d, int k)
{
    const ted4_sweep_view *own = &r->views[r->self];
    const float part = (float)depth / (float)(own->depths - 1);
    float p[3];

    d->z[k] = 1.0f / ((1.0f - part) / own->nearest + part / own->farthest);
    ted4_ray_point(&own->view, r->ray, d->z[k], p);
    for (int c = 0; c < 3; c++)
        d->p[c][k] = p[c];
    if (depth >= own->depths || fmaxf(fmaxf(fabsf(p[0]), fabsf(p[1])), fabsf(p[2])) > 1.0f)
        return;
    for (size_t i = 0; i < r->n; i++) {
        uint8_t here[3], there[3];
        size_t pixel;
        float z;

        if (i == r->self || !ted4_view_pixel(&r->views[i].view, p, &pixel, &z))
            continue;
        unpack(r->pixel, here);
        unpack(r->views[i].pixel[pixel], there);
        d->seen[k]++;
        if (r->views[i].pixel[pixel] >> 24 < TED4_MISSING / 2 || !ted4_colour_agrees(here, there))
            continue;
        d->agree[k]++;
        d->score[k] += 1.0f - (float)ted4_colour_far(here, there) / (3.0f * TED4_COLOUR_NEAR + 1);
    }
}

/* What the rays met, so that the test cannot pass on rays that meet nothing. */
typedef struct {
    size_t unseen, seen, agree, all;
} tally;

static void compare(const ted4_sweep_ray *r, int first, tally *t)
{
    ted4_swept_depths expected = { 0 }, got;

    ted4_sweep_depths(r, first, &got);
    for (int k = 0; k < TED4_DEPTHS; k++) {
        judge(r, first + k, &expected, k);
        assert_int_equal(got.seen[k], expected.seen[k]);
        assert_int_equal(got.agree[k], expected.agree[k]);
        assert_memory_equal(&got.score[k], &expected.score[k], sizeof(float));
        assert_memory_equal(&got.z[k], &expected.z[k], sizeof(float));
        for (int c = 0; c < 3; c++)
            assert_memory_equal(&got.p[c][k], &expected.p[c][k], sizeof(float));
        t->unseen += expected.seen[k] == 0;
        t->seen += expected.seen[k] > 0;
        t->agree += expected.agree[k] > 0;
        t->all += expected.seen[k] == VIEWS - 2;
    }
}

static void test_definition(void **state)
{
    const ted4_level most = ted4_level_of_machine();

    (void)state;
    for (int level = TED4_LEVEL_BASE; level <= (int)most; level++) {
        random_source r = random_seed(9);
        tally t = { 0 };

        assert_int_equal(ted4_level_use((ted4_level)level), level);
        for (int i = 0; i < RAYS; i++) {
            ted4_sweep_ray ray = { .views = views, .n = VIEWS, .self = random_u32(&r) % VIEWS };
            const int column = (int)random_in(&r, 0, WIDTH - 1);
            const int row = (int)random_in(&r, 0, HEIGHT - 1);

            ray.pixel = views[ray.self].pixel[row * WIDTH + column];
            ted4_view_ray(&views[ray.self].view, column, row, ray.ray);
            for (int first = 0; first < DEPTHS; first += TED4_DEPTHS)
                compare(&ray, first, &t);
        }
        assert_true(t.unseen > 1000 && t.seen > 1000 && t.agree > 500 && t.all > 100);
    }
    ted4_level_use(most);
}

/* A picture whose every ray misses the cube: nothing is judged. */
static void test_outside(void **state)
{
    ted4_sweep_ray ray = { .views = views, .n = VIEWS, .self = 0, .ray = { 50, 0 } };
    ted4_swept_depths d;

    (void)state;
    ted4_sweep_depths(&ray, 0, &d);
    for (int k = 0; k < TED4_DEPTHS; k++)
        assert_true(d.seen[k] == 0 && d.agree[k] == 0 && d.score[k] == 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_definition),
        cmocka_unit_test(test_outside),
    };

    return cmocka_run_group_tests_name("sweep_depths", tests, set_up, tear_down);
}
