/* test_relay.c - the scene "relay": at each time one camera takes a picture, in rounds; what moves
 * moves smoothly, and the cameras see it. Links tools/scene/ray_*.o.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "test.h"
#include "tools/scene/ray_rig.h"

/* Numbers of solids in the order of ray_relay.c: three still ones, ball, rod, block, then drops. */
enum { N_STILL = 3, BALL = 3, ROD = 4, BLOCK = 5, FIRST_DROP = 6, N_SOLIDS = 12 };

static void world_at(ted4_ray_world *w, int frame)
{
    const ted4_ray_options o = ted4_ray_defaults(RAY_RELAY);

    ted4_ray_world_at(w, o.scene, o.seed, frame, o.n_frames);
}

/* Every time has one picture, of the camera whose turn it is; the turns repeat. */
static void test_rounds(void **state)
{
    const ted4_ray_options o = ted4_ray_defaults(RAY_RELAY);
    const int n = o.n_train + o.n_test;
    int train = 0, before = -1;

    (void)state;
    for (int frame = 0; frame < o.n_frames; frame++) {
        int taken = 0, by = -1;

        for (int number = 0; number < n; number++)
            if (ted4_ray_is_taken(&o, number, frame)) {
                taken++;
                by = number;
            }
        assert_int_equal(taken, 1);
        if (frame >= n)
            assert_true(ted4_ray_is_taken(&o, by, frame - n));
        train += by < o.n_train;
        /* A test time lies between two training times. */
        assert_false(before >= o.n_train && by >= o.n_train);
        before = by;
    }
    assert_int_equal(train, 84);
    assert_int_equal(o.n_frames, 117);
    assert_true(ted4_ray_is_taken(&o, 0, 0));
}

/* A layout without lists has all pictures, and times that --hold names have no training picture. */
static void test_other_options(void **state)
{
    ted4_ray_options o = ted4_ray_defaults(RAY_RELAY);

    (void)state;
    o.layout = RAY_CALIBRATION;
    for (int number = 0; number < o.n_train + o.n_test; number++)
        assert_true(ted4_ray_is_taken(&o, number, 8));
    o.layout = RAY_BLENDER;
    o.hold = 7; /* time 3 of 7 */
    assert_true(ted4_ray_is_taken(&o, 0, 0));
    for (int number = 0; number < o.n_train; number++)
        assert_false(ted4_ray_is_taken(&o, number, 3));
}

static int is_at(const ted4_ray_object *a, const ted4_ray_object *b)
{
    return v3_length(v3_sub(a->pos, b->pos)) == 0;
}

/* The same solids exist at all times. Three stand still; each of the others moves at every step,
 * but by less than its radius. */
static void test_motion(void **state)
{
    ted4_ray_world now, next;

    (void)state;
    for (int frame = 0; frame + 1 < 117; frame++) {
        world_at(&now, frame);
        world_at(&next, frame + 1);
        assert_int_equal(now.n, N_SOLIDS);
        for (int i = 0; i < N_SOLIDS; i++) {
            const ted4_ray_object *a = &now.object[i], *b = &next.object[i];

            assert_int_equal(a->kind, b->kind);
            assert_int_equal(is_at(a, b), i < N_STILL);
            if (i != ROD)
                assert_true(v3_length(v3_sub(a->pos, b->pos)) < a->size.x);
        }
    }
}

/* The rod leads from a fixed point to the block, and the block turns with it. */
static void test_pendulum(void **state)
{
    ted4_ray_world w;
    vec3 from = v3(0, 0, 0);
    float least = 1, most = -1;

    (void)state;
    for (int frame = 0; frame < 117; frame++) {
        world_at(&w, frame);
        const ted4_ray_object *rod = &w.object[ROD], *block = &w.object[BLOCK];
        const vec3 along = ray_rotate(rod->rot, v3(0, 0, rod->size.z));
        const vec3 top = v3_add(rod->pos, along), end = v3_sub(rod->pos, along);
        const vec3 face = v3_add(block->pos, ray_rotate(block->rot, v3(0, 0, block->size.z)));

        if (frame == 0)
            from = top;
        assert_true(v3_length(v3_sub(top, from)) < 1e-5f);
        assert_true(v3_length(v3_sub(end, face)) < 1e-5f);
        least = ray_min(least, block->pos.x);
        most = ray_max(most, block->pos.x);
    }
    assert_true(most - least > 1);
}

/* Most training pictures show the ball, and together they show every drop. */
static void test_seen(void **state)
{
    const ted4_ray_options o = ted4_ray_defaults(RAY_RELAY);
    int drops[N_SOLIDS] = { 0 }, balls = 0;

    (void)state;
    for (int frame = 0; frame < o.n_frames; frame++)
        for (int number = 0; number < o.n_train; number++) {
            ted4_ray_camera c;
            ted4_ray_world w;
            int ball = 0;

            if (!ted4_ray_is_taken(&o, number, frame))
                continue;
            ted4_ray_camera_of(&o, number, &c);
            ted4_ray_world_of(&o, frame, &w);
            for (int i = 0; i < o.width * o.height; i++) {
                const ted4_ray_sight s =
                    ted4_ray_look(&w, &c, i % o.width + 0.5, i / o.width + 0.5);

                ball += s.object == BALL;
                if (s.object >= FIRST_DROP)
                    drops[s.object] |= 1;
            }
            balls += ball > 4;
        }
    assert_true(balls > 84 * 4 / 5);
    for (int i = FIRST_DROP; i < N_SOLIDS; i++)
        assert_true(drops[i]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_rounds), cmocka_unit_test(test_other_options),
        cmocka_unit_test(test_motion), cmocka_unit_test(test_pendulum),
        cmocka_unit_test(test_seen),
    };

    return cmocka_run_group_tests_name("relay", tests, NULL, NULL);
}
