/* test_failure_scenes.c - the scenes in which methods fail contain the effect after which they are
 * named, judged by what cameras see; and the scenes for file sizes. Links tools/scene/ray_*.o.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "test.h"
#include "tools/scene/ray_lab.h"
#include "tools/scene/ray_rig.h"

enum { W = 48, H = 32, AREA = W * H, SIZE = AREA * 3, FURNITURE = 6 };

static ted4_ray_options plan_at(ted4_ray_scene s, int width, int height)
{
    ted4_ray_options o = ted4_ray_defaults(s);

    o.width = width;
    o.height = height;
    return o;
}

static ted4_ray_options plan(ted4_ray_scene s)
{
    return plan_at(s, W, H);
}

static void world_at(ted4_ray_world *w, const ted4_ray_options *o, int frame)
{
    ted4_ray_world_at(w, o->scene, o->seed, frame, o->n_frames);
}

static void picture(const ted4_ray_options *o, int number, int frame, uint8_t *rgb)
{
    ted4_ray_camera c;
    ted4_ray_world w;

    ted4_ray_camera_of(o, number, &c);
    world_at(&w, o, frame);
    ted4_ray_render(&w, &c, rgb);
}

/* Returns the share of bytes that differ by more than limit. */
static double changed(const uint8_t *a, const uint8_t *b, int limit)
{
    int n = 0;

    for (int i = 0; i < SIZE; i++)
        n += abs(a[i] - b[i]) > limit;
    return (double)n / SIZE;
}

/* The same between two times of a camera. */
static double change_of(const ted4_ray_options *o, int number, int frame, int other)
{
    static uint8_t a[SIZE], b[SIZE];

    picture(o, number, frame, a);
    picture(o, number, other, b);
    return changed(a, b, 16);
}

static double brightness(const uint8_t *rgb)
{
    double sum = 0;

    for (int i = 0; i < SIZE; i++)
        sum += rgb[i];
    return sum / SIZE;
}

/* mask[height][width]: whether a pixel shows one of the of objects that precede the last from_end
 * objects of the world. Returns the number of such pixels. */
static int find(const ted4_ray_options *o, int number, int frame, int from_end, int of,
                uint8_t *mask)
{
    ted4_ray_camera c;
    ted4_ray_world w;
    int n = 0;

    ted4_ray_camera_of(o, number, &c);
    world_at(&w, o, frame);
    for (int i = 0; i < o->width * o->height; i++) {
        const int id = ted4_ray_look(&w, &c, i % o->width + 0.5, i / o->width + 0.5).object;
        mask[i] = id <= w.n - 1 - from_end && id > w.n - 1 - from_end - of;
        n += mask[i];
    }
    return n;
}

/* ---- 1: hidden ---- */

static void test_hide(void **state)
{
    const ted4_ray_options o = plan(RAY_HIDE);
    static uint8_t mask[AREA];
    int first = 0, last = 0;

    (void)state;
    for (int camera = 0; camera < o.n_train; camera++) {
        for (int frame = 6; frame <= 10; frame++)
            assert_int_equal(find(&o, camera, frame, 0, 1, mask), 0);
        first += find(&o, camera, 0, 0, 1, mask) > 4;
        last += find(&o, camera, 15, 0, 1, mask) > 4;
    }
    assert_int_equal(first, o.n_train);
    assert_int_equal(last, o.n_train);
}

/* ---- 2, 14: what exists ---- */

static void check_jumps(ted4_ray_scene s, int camera)
{
    const ted4_ray_options o = plan(s);

    for (int frame = 0; frame < 15; frame++) {
        const int jumps = frame == 1 || (frame >= 5 && frame <= 10) || frame == 13;
        const double c = change_of(&o, camera, frame, frame + 1);
        if (jumps)
            assert_true(c > 0.02);
        else
            assert_true(c == 0);
    }
    assert_true(change_of(&o, camera, 0, 14) == 0);
}

static void test_blink(void **state)
{
    (void)state;
    check_jumps(RAY_BLINK, 2);
}

/* Whatever appears and disappears is cut by the upper edge, in every picture that shows it. */
static void test_edge(void **state)
{
    const ted4_ray_options o = plan(RAY_EDGE);
    static uint8_t mask[AREA];
    const struct {
        int frame, from_end;
    } there[] = { { 6, 0 }, { 8, 0 }, { 8, 1 }, { 8, 2 } };

    (void)state;
    check_jumps(RAY_EDGE, 3);
    for (size_t i = 0; i < sizeof there / sizeof there[0]; i++) {
        int seen = 0;

        for (int camera = 0; camera < o.n_train + o.n_test; camera++) {
            const int n = find(&o, camera, there[i].frame, there[i].from_end, 1, mask);
            int top = 0;

            for (int x = 0; x < o.width; x++)
                top += mask[x];
            assert_true(n == 0 || top > 0);
            seen += n > 20;
        }
        assert_true(seen >= 3);
    }
}

static int same_solid(const ted4_ray_object *a, const ted4_ray_object *b)
{
    return a->kind == b->kind && a->pos.x == b->pos.x && a->pos.y == b->pos.y &&
           a->pos.z == b->pos.z && memcmp(a->rot, b->rot, sizeof a->rot) == 0;
}

static void test_change(void **state)
{
    const ted4_ray_options o = plan(RAY_CHANGE);
    ted4_ray_world first, last;

    (void)state;
    world_at(&first, &o, 0);
    world_at(&last, &o, o.n_frames - 1);
    assert_true(first.n >= FURNITURE + 2);
    assert_true(last.n >= FURNITURE + 2);
    for (int i = FURNITURE; i < first.n; i++)
        for (int j = FURNITURE; j < last.n; j++)
            assert_false(same_solid(&first.object[i], &last.object[j]));
    for (int camera = 0; camera < o.n_train; camera++)
        assert_true(change_of(&o, camera, 0, 15) > 0.15);
}

/* Nothing appears or disappears next to a time that is held out. */
static void test_held_times(void **state)
{
    (void)state;
    for (int s = RAY_HIDE; s < RAY_SCENES; s++) {
        const ted4_ray_options o = plan((ted4_ray_scene)s);
        int held = 0;
        for (int frame = 0; frame < o.n_frames; frame++) {
            ted4_ray_world at, near;
            if (!ted4_ray_is_held(&o, frame))
                continue;
            held++;
            assert_true(frame > 0);
            assert_true(frame < o.n_frames - 1);
            assert_false(ted4_ray_is_held(&o, frame + 1));
            world_at(&at, &o, frame);
            for (int side = -1; side <= 1; side += 2) {
                world_at(&near, &o, frame + side);
                assert_int_equal(at.n, near.n);
                for (int i = 0; i < at.n; i++)
                    assert_int_equal(at.object[i].kind, near.object[i].kind);
            }
        }
        assert_int_equal(held,
                         ted4_ray_plan_of((ted4_ray_scene)s)->hold == 0 ? 0 : (o.n_frames + 3) / 8);
    }
    ted4_ray_options o = plan(RAY_BLINK);
    o.n_frames = 13;
    assert_true(ted4_ray_is_held(&o, 4));
    assert_false(ted4_ray_is_held(&o, 12));
}

/* ---- 3: fast ---- */

typedef struct {
    double x, y, width, height;
} extent;

static extent extent_of(const uint8_t *mask, int width, int height)
{
    int low[2] = { width, height }, high[2] = { -1, -1 };
    double sum[2] = { 0, 0 };
    int n = 0;

    for (int i = 0; i < width * height; i++) {
        if (!mask[i])
            continue;
        for (int k = 0; k < 2; k++) {
            const int v = k == 0 ? i % width : i / width;
            low[k] = v < low[k] ? v : low[k];
            high[k] = v > high[k] ? v : high[k];
            sum[k] += v;
        }
        n++;
    }
    return (extent) { sum[0] / n, sum[1] / n, high[0] - low[0] + 1, high[1] - low[1] + 1 };
}

/* Ball (the last solid but one) and box: between successive times they move further than their
 * width or height, in the room and in the picture. */
static void test_fast(void **state)
{
    const ted4_ray_options o = plan_at(RAY_FAST, 96, 64);
    const int camera = 3;
    static uint8_t mask[96 * 64];

    (void)state;
    for (int which = 0; which < 2; which++) {
        extent before = { 0 };
        int pairs = 0;
        for (int frame = 0; frame < 10; frame++) {
            ted4_ray_world a, b;
            world_at(&a, &o, frame);
            world_at(&b, &o, frame + 1);
            const ted4_ray_object *const p = &a.object[a.n - 1 - which],
                                         *const q = &b.object[b.n - 1 - which];
            assert_true(v3_length(v3_sub(p->pos, q->pos)) > 1.45f * 2 * p->size.x);

            const int n = find(&o, camera, frame, which, 1, mask);
            const extent now = extent_of(mask, o.width, o.height);
            if (frame > 0 && n > 0 && before.width > 0) {
                assert_true(fabs(now.x - before.x) > fmin(now.width, before.width) ||
                            fabs(now.y - before.y) > fmin(now.height, before.height));
                pairs++;
            }
            before = n > 0 ? now : (extent) { 0 };
        }
        assert_true(pairs >= 7);
    }
}

/* ---- 4: topology ---- */

static void flood(uint8_t *mask, int width, int height, int x, int y)
{
    if (x < 0 || y < 0 || x >= width || y >= height || !mask[y * width + x])
        return;
    mask[y * width + x] = 0;
    flood(mask, width, height, x - 1, y);
    flood(mask, width, height, x + 1, y);
    flood(mask, width, height, x, y - 1);
    flood(mask, width, height, x, y + 1);
}

/* Returns the number of connected parts of at least 4 pixels, and clears the mask. */
static int parts(uint8_t *mask, int width, int height)
{
    int n = 0;

    for (int i = 0; i < width * height; i++) {
        if (!mask[i])
            continue;
        int before = 0, after = 0;
        for (int j = 0; j < width * height; j++)
            before += mask[j];
        flood(mask, width, height, i % width, i / width);
        for (int j = 0; j < width * height; j++)
            after += mask[j];
        n += before - after >= 4;
    }
    return n;
}

/* The two halves, then the two balls, are the last solids. */
static void test_split(void **state)
{
    const ted4_ray_options o = plan(RAY_SPLIT);
    static uint8_t mask[AREA];
    ted4_ray_world w;

    (void)state;
    find(&o, 3, 0, 2, 2, mask);
    assert_int_equal(parts(mask, W, H), 1);
    find(&o, 3, 9, 2, 2, mask);
    assert_int_equal(parts(mask, W, H), 2);
    find(&o, 3, 0, 0, 2, mask);
    assert_int_equal(parts(mask, W, H), 2);
    find(&o, 3, 15, 0, 2, mask);
    assert_int_equal(parts(mask, W, H), 1);
    world_at(&w, &o, 15);
    assert_true(same_solid(&w.object[w.n - 1], &w.object[w.n - 2]));
}

/* ---- 6, 7: light, texture ---- */

static void test_flicker(void **state)
{
    const ted4_ray_options o = plan(RAY_FLICKER), steady = plan(RAY_FAR);
    static uint8_t a[SIZE], b[SIZE];

    (void)state;
    for (int frame = 0; frame < 15; frame++) {
        picture(&o, 2, frame, a);
        picture(&o, 2, frame + 1, b);
        const double share = brightness(a) / brightness(b);
        assert_true(frame % 2 == 0 ? share > 1.15 : share < 1 / 1.15);
    }
    picture(&steady, 2, 0, a);
    picture(&steady, 2, 1, b);
    assert_true(fabs(brightness(a) / brightness(b) - 1) < 0.02);
}

/* Returns the share of neighbouring pixels on the walls of the room that differ by more than 12. At
 * shadows and solids they differ even without texture. */
static double roughness(ted4_ray_scene s)
{
    const ted4_ray_options o = plan_at(s, 96, 64);
    static uint8_t rgb[96 * 64 * 3];
    ted4_ray_camera c;
    ted4_ray_world w;
    int n = 0, rough = 0;

    ted4_ray_camera_of(&o, 2, &c);
    world_at(&w, &o, 0);
    ted4_ray_render(&w, &c, rgb);
    for (int i = 0; i < 95 * 40; i++) {
        const int x = i % 95, y = i / 95, at = 3 * (y * 96 + x);
        const ted4_ray_sight p = ted4_ray_look(&w, &c, x + 0.5, y + 0.5),
                             q = ted4_ray_look(&w, &c, x + 1.5, y + 0.5);
        if (p.object != -1 || q.object != -1 || p.point.z < 0.1f || q.point.z < 0.1f)
            continue;
        n++;
        rough += abs(rgb[at] - rgb[at + 3]) > 12;
    }
    assert_true(n > 1000);
    return (double)rough / n;
}

static void test_bare(void **state)
{
    (void)state;
    assert_true(roughness(RAY_BARE) < 0.08);
    assert_true(roughness(RAY_FAR) > 0.25);
}

/* ---- 12: wires ---- */

/* Rods are thinner than a pixel of the default picture, and still visible. */
static void test_wires(void **state)
{
    const ted4_ray_options o = plan_at(RAY_WIRES, 96, 64);
    static uint8_t a[96 * 64 * 3], b[96 * 64 * 3];
    ted4_ray_camera c;
    ted4_ray_world w, without;
    int rods = 0, n = 0;

    (void)state;
    ted4_ray_camera_of(&o, 2, &c);
    world_at(&w, &o, 0);
    without = w;
    without.n = 0;
    for (int i = 0; i < w.n; i++) {
        if (w.object[i].kind == RAY_CYLINDER && w.object[i].size.x < 0.05f) {
            rods++;
            assert_true(2 * (double)w.object[i].size.x * c.focal / ted4_ray_radius < 1);
        } else {
            without.object[without.n++] = w.object[i];
        }
    }
    assert_true(rods >= 12);
    ted4_ray_render(&w, &c, a);
    ted4_ray_render(&without, &c, b);
    for (int i = 0; i < 96 * 64 * 3; i++)
        n += abs(a[i] - b[i]) > 16;
    assert_true(n > 96 * 64 * 3 / 25);
}

/* ---- 15: nothing to see ---- */

static void test_empty(void **state)
{
    const ted4_ray_options o = plan(RAY_EMPTY);
    static uint8_t rgb[SIZE];

    (void)state;
    for (int camera = 0; camera < o.n_train; camera++) {
        int lit = 0;
        picture(&o, camera, 5, rgb);
        for (int i = 0; i < SIZE; i++)
            lit += rgb[i] > 0;
        if (camera == o.n_train - 1)
            assert_int_equal(lit, 0);
        else
            assert_true(lit > SIZE / 4);
        assert_int_equal(ted4_ray_is_blind(&o, camera), camera == o.n_train - 1);
    }
    for (int i = 0; i < 500; i++) {
        const ted4_ray_point p = ted4_ray_point_at(&o, i);
        assert_int_not_equal(p.camera, o.n_train - 1);
        assert_true(isfinite(p.point.x));
        assert_true(isfinite(p.point.y));
        assert_true(isfinite(p.point.z));
    }
}

/* ---- file sizes ---- */

static int moving(const ted4_ray_options *o, int frame, int other)
{
    ted4_ray_world a, b;
    int n = 0;

    world_at(&a, o, frame);
    world_at(&b, o, other);
    assert_int_equal(a.n, FURNITURE + 8);
    assert_int_equal(b.n, a.n);
    for (int i = 0; i < a.n; i++)
        n += !same_solid(&a.object[i], &b.object[i]);
    return n;
}

static void test_things(void **state)
{
    static const int count[] = { 0, 1, 2, 4, 8 };
    static uint8_t a[SIZE], b[SIZE];
    double before = -1;

    (void)state;
    for (int k = 0; k < 5; k++) {
        const ted4_ray_options o = plan((ted4_ray_scene)(RAY_THINGS0 + k));
        double sum = 0;
        for (int frame = 1; frame < 16; frame++) {
            assert_int_equal(moving(&o, 0, frame), count[k]);
            assert_int_equal(moving(&o, frame - 1, frame), count[k]);
        }
        for (int camera = 0; camera < o.n_train; camera++)
            sum += change_of(&o, camera, 0, 8);
        assert_true(sum > before);
        assert_true(count[k] > 0 || sum == 0);
        before = sum;
        picture(&o, 1, 0, k == 0 ? a : b);
        if (k > 0)
            assert_memory_equal(a, b, SIZE);
    }
}

/* The first half of rest is things4. Its second half does not move; that of things4 of the same
 * length does. */
static void test_rest(void **state)
{
    const ted4_ray_options rest = plan(RAY_REST), four = plan(RAY_THINGS4);
    ted4_ray_options more = four;
    static uint8_t a[SIZE], b[SIZE];

    (void)state;
    more.n_frames = rest.n_frames;
    assert_int_equal(rest.n_frames, 2 * four.n_frames);
    for (int frame = 0; frame < four.n_frames; frame += 5) {
        picture(&rest, 2, frame, a);
        picture(&four, 2, frame, b);
        assert_memory_equal(a, b, SIZE);
        picture(&more, 2, frame, b);
        assert_memory_equal(a, b, SIZE);
    }
    for (int frame = four.n_frames + 1; frame < rest.n_frames; frame++) {
        assert_int_equal(moving(&rest, four.n_frames, frame), 0);
        assert_int_equal(moving(&more, frame - 1, frame), 4);
    }
    assert_true(change_of(&rest, 2, 16, 31) == 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_hide),       cmocka_unit_test(test_blink),
        cmocka_unit_test(test_change),     cmocka_unit_test(test_edge),
        cmocka_unit_test(test_held_times), cmocka_unit_test(test_fast),
        cmocka_unit_test(test_split),      cmocka_unit_test(test_flicker),
        cmocka_unit_test(test_bare),       cmocka_unit_test(test_wires),
        cmocka_unit_test(test_empty),      cmocka_unit_test(test_things),
        cmocka_unit_test(test_rest),
    };

    return cmocka_run_group_tests_name("failure scenes", tests, NULL, NULL);
}
