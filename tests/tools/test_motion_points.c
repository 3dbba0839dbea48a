/* test_motion_points.c - initial points as structure from motion finds them (ted4scene --points
 * sfm). Links tools/scene/ray_*.o.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>
#include <string.h>

#include "test.h"
#include "tools/scene/ray_rig.h"

enum { W = 48, H = 32, N = 300 };
/* The solids that never move come first in every world up to RAY_FAIR: six of the room, the wall of
 * the occluder, and the pot in which the bar stands. */
static const int n_still[RAY_FAIR + 1] = {
    [RAY_TURN] = 6, [RAY_OCCLUDER] = 7, [RAY_POP] = 6, [RAY_BEND] = 7, [RAY_FAIR] = 6
};

static ted4_ray_options motion(ted4_ray_scene s)
{
    ted4_ray_options o = ted4_ray_defaults(s);

    o.width = W;
    o.height = H;
    o.n_train = 3;
    o.n_frames = 5;
    o.ways.points = RAY_MOTION_POINTS;
    return o;
}

/* Returns the index of the object that a point's camera sees where the point is, and its distance
 * from what is seen there: all of it, and across the ray. */
static int seen_at(const ted4_ray_options *o, const ted4_ray_point *p, float *off, float *across)
{
    const double world[3] = { (double)p->point.x, (double)p->point.y, (double)p->point.z };
    double pixel[2];
    ted4_ray_camera c;
    ted4_ray_world w;

    ted4_ray_camera_of(o, p->camera, &c);
    ted4_ray_world_of(o, p->frame, &w);
    assert_true(ted4_ray_project(&c, world, pixel) > 0);
    const ted4_ray_sight r = ted4_ray_look(&w, &c, pixel[0], pixel[1]);
    const vec3 eye = v3((float)c.matrix[0][3], (float)c.matrix[1][3], (float)c.matrix[2][3]);
    const vec3 ray = v3_unit(v3_sub(r.point, eye)), d = v3_sub(p->point, r.point);

    *off = v3_length(d);
    *across = v3_length(v3_along(d, ray, -v3_dot(d, ray)));
    return r.object;
}

/* Points lie on the room and on what stands in it, and not on what turns, bends, comes or goes. At
 * edges the pixel of a point may show its neighbour. */
static void test_still_things(void **state)
{
    (void)state;
    for (int s = RAY_TURN; s <= RAY_FAIR; s++) {
        const ted4_ray_options o = motion((ted4_ray_scene)s);
        int moving = 0, near = 0;

        assert_int_equal(ted4_ray_n_points(&o), 1000);
        for (int i = 0; i < N; i++) {
            const ted4_ray_point p = ted4_ray_point_at(&o, i);
            float off, across;

            assert_in_range(p.camera, 0, 2);
            assert_in_range(p.frame, 0, 4);
            moving += seen_at(&o, &p, &off, &across) >= n_still[s];
            near += off < 0.15f;
        }
        assert_true(moving < N / 50);
        assert_true(near > N * 9 / 10);
    }
}

/* Points are less exact along the ray: by up to 0.12, where the others are off by 0.026 at most in
 * every direction. On the ray itself, no distance is seen across it. */
static void test_noise(void **state)
{
    const ted4_ray_options o = motion(RAY_STILL);
    ted4_ray_options exact = o;
    float most = 0, sum = 0, sum_exact = 0;

    (void)state;
    exact.ways.points = RAY_ON_SURFACES;
    for (int i = 0; i < N; i++) {
        const ted4_ray_point p = ted4_ray_point_at(&o, i), q = ted4_ray_point_at(&exact, i);
        float off, across;

        seen_at(&o, &p, &off, &across);
        assert_true(across < 0.001f);
        if (off < 0.2f) {
            most = ray_max(most, off);
            sum += off;
        }
        seen_at(&exact, &q, &off, &across);
        sum_exact += off < 0.2f ? off : 0;
    }
    assert_true(most > 0.08f);
    assert_true(most < 0.2f);
    assert_true(sum > 2 * sum_exact);
}

/* The colour is what the point's camera takes: its colour matrix is in it, and no other noise. */
static void test_tint(void **state)
{
    ted4_ray_options o = motion(RAY_STILL), plain = o;
    int differ = 0;

    (void)state;
    o.tint = 1;
    for (int i = 0; i < N; i++) {
        const ted4_ray_point p = ted4_ray_point_at(&o, i), q = ted4_ray_point_at(&plain, i);

        assert_memory_equal(&p.point, &q.point, sizeof p.point);
        differ += memcmp(p.rgb, q.rgb, 3) != 0;
    }
    assert_true(differ > N * 9 / 10);
    o.ways.points = plain.ways.points = RAY_ON_SURFACES;
    for (int i = 0; i < N; i++) {
        const ted4_ray_point p = ted4_ray_point_at(&o, i), q = ted4_ray_point_at(&plain, i);

        assert_memory_equal(p.rgb, q.rgb, 3);
    }
}

/* The seed decides, and nothing else. */
static void test_seed(void **state)
{
    ted4_ray_options o = motion(RAY_FAIR);
    int same = 0;

    (void)state;
    for (int i = 0; i < N; i++) {
        o.seed = 1;
        const ted4_ray_point p = ted4_ray_point_at(&o, i), again = ted4_ray_point_at(&o, i);

        assert_memory_equal(&p.point, &again.point, sizeof p.point);
        o.seed = 2;
        const ted4_ray_point q = ted4_ray_point_at(&o, i);
        same += memcmp(&p.point, &q.point, sizeof p.point) == 0;
    }
    assert_true(same < N / 10);
}

/* Without a room, there are other things that stand still in every scene: the search ends. */
static void test_without_room(void **state)
{
    (void)state;
    for (int s = 0; s < RAY_SCENES; s++) {
        ted4_ray_options o = motion((ted4_ray_scene)s);

        o.ways.background = RAY_BLACK;
        for (int i = 0; i < N / 10; i++)
            assert_in_range(ted4_ray_point_at(&o, i).camera, 0, 2);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_still_things), cmocka_unit_test(test_noise),
        cmocka_unit_test(test_tint),         cmocka_unit_test(test_seed),
        cmocka_unit_test(test_without_room),
    };

    return cmocka_run_group_tests_name("points of structure from motion", tests, NULL, NULL);
}
