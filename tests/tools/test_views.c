/* test_views.c - tool/views.h: which cameras ted4dec --orbit and --path draw, and at which times.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <jansson.h>
#include <math.h>

#include "tool/camera_path.h"
#include "tool/threads.h"
#include "tool/views.h"
#include "tool_files.h"

/* A camera with its centre at (x, 0, 0) that looks along z; more: further members, as ",\"k\":1".
 */
static void print_camera(char *text, size_t size, double focal, double x, const char *more)
{
    const size_t n = strlen(text);

    snprintf(text + n, size - n,
             "%c{\"width\":96,\"height\":64,\"fx\":%g,\"fy\":%g,\"cx\":30,\"cy\":40,"
             "\"R\":[1,0,0,0,1,0,0,0,1],\"t\":[%g,0,0]%s}",
             n == 0 ? '[' : ',', focal, focal, -x, more);
}

/* ---- around the scene ---- */

/* The two opposite cameras of --orbit 2 for a file. */
static void orbit_of(const char *name, ted4_session *s)
{
    static const ted4_settings set = { .orbit = 2, .up = { 0.0f, 0.0f, 1.0f } };

    *s = (ted4_session) { .set = &set, .info = file[1].info, .recon = file[1].recon };
    s->data = contents(name, &s->size);
    ted4_threads_init(&s->parallel, 2);
    assert_int_equal(ted4_views_make(s), 0);
    assert_int_equal(s->cameras.n, 2);
    ted4_threads_finish(&s->parallel);
    free(s->data);
}

/* The share of the opaque Gaussians at the first time whose means are in the picture. */
static double seen_share(const ted4_view *v)
{
    const ted4_query q = { 0, 1, { 0.0f, 0.0f, 0.0f } };
    ted4_gaussians g;
    size_t n = 0, seen = 0;

    assert_int_equal(ted4_recon_query(file[1].recon, &q, NULL, &g), TED4_OK);
    for (size_t i = 0; i < g.n; i++) {
        double at[3];

        for (int r = 0; r < 3; r++) {
            at[r] = (double)v->t[r];
            for (int c = 0; c < 3; c++)
                at[r] += (double)v->R[3 * r + c] * (double)g.mean[c][i];
        }
        const double x = (double)v->fx * at[0] / at[2] + (double)v->cx,
                     y = (double)v->fy * at[1] / at[2] + (double)v->cy;

        if (g.opacity[i] > 0.1f) {
            n++;
            seen += at[2] > 0.0 && x >= 0.0 && y >= 0.0 && x <= v->width && y <= v->height;
        }
    }
    assert_true(n > 0);
    return (double)seen / (double)n;
}

/* Cameras without a common point lend their lens, and the circle fits its angle of view: whatever
 * the lens, most Gaussians are in the picture, and they fill it. */
static void test_orbit(void **state)
{
    static const double focal[] = { 20, 80, 800 };
    ted4_session s;
    double a[3], b[3], without, across;

    (void)state;
    need_programs();
    orbit_of("v1.ted4", &s);
    ted4_view_centre(&s.cameras.camera[0].view, a);
    ted4_view_centre(&s.cameras.camera[1].view, b);
    without = hypot(a[0] - b[0], a[1] - b[1]) * sin(0.45);
    ted4_camera_list_free(&s.cameras);
    for (size_t i = 0; i < sizeof focal / sizeof *focal; i++) {
        char text[1024] = "";

        print_camera(text, sizeof text, focal[i], 0.0, "");
        print_camera(text, sizeof text, focal[i], 1.0, "");
        strcat(text, "]");
        write_contents("cameras.json", text, strlen(text));
        assert_int_equal(run("ted4edit v1.ted4 -o c.ted4 -f --cameras cameras.json"), 0);
        orbit_of("c.ted4", &s);
        for (int k = 0; k < 2; k++)
            assert_true(seen_share(&s.cameras.camera[k].view) >= 0.75);
        assert_true(s.cameras.camera[0].view.fx == (float)focal[i]);
        assert_true(s.cameras.camera[0].view.cx == 48.0f && s.cameras.camera[0].view.cy == 32.0f);
        ted4_view_centre(&s.cameras.camera[0].view, a);
        ted4_view_centre(&s.cameras.camera[1].view, b);
        across = hypot(a[0] - b[0], a[1] - b[1]) * sin(atan(32.0 / focal[i]));
        assert_true(fabs(across / without - 1.0) < 1e-4);
        ted4_camera_list_free(&s.cameras);
    }
}

/* ---- along a path ---- */

/* Draws nine pictures of a path, which ends with that status, and asserts that their times are
 * evenly spaced from first to last. */
static void expect_times(const char *options, int status, double first, double last)
{
    assert_int_equal(
        run("ted4dec v1.ted4 --render p_%%d.png -f --path path.json --views 9 --json %s", options),
        status);
    json_t *const report = json_loads(out, 0, NULL), *const views =
                                                         json_object_get(report, "views");

    assert_int_equal(json_array_size(views), 9);
    for (size_t i = 0; i < 9; i++) {
        const json_t *const view = json_array_get(views, i);
        const double t = json_number_value(json_object_get(view, "num")) /
                         json_number_value(json_object_get(view, "den"));

        assert_true(fabs(t - (first + (last - first) * (double)i / 8.0)) < 1e-6);
    }
    json_decref(report);
}

/* Writes a path of three cameras with these members. */
static void write_path(const char *a, const char *b, const char *c)
{
    char text[1024] = "";

    print_camera(text, sizeof text, 80.0, 0.0, a);
    print_camera(text, sizeof text, 80.0, 1.0, b);
    print_camera(text, sizeof text, 80.0, 2.0, c);
    strcat(text, "]");
    write_contents("path.json", text, strlen(text));
}

static int warned(const char *text)
{
    size_t size;
    char *const err = (char *)contents("err", &size);

    err[size] = '\0';
    const int found = strstr(err, text) != NULL;

    free(err);
    return found;
}

/* The times of keys count if all have one and these do not decrease, as in the player; if there are
 * some that do not count, a warning says so. */
static void test_path_times(void **state)
{
    (void)state;
    need_programs();
    write_path("", "", "");
    expect_times("", 0, 0.0, 1.0);
    write_path(",\"time\":0.25", ",\"time\":0.5", ",\"time\":0.75");
    expect_times("", 0, 0.25, 0.75);
    write_path(",\"time\":\"1/2\"", ",\"time\":0.5", ",\"time\":\"2/4\"");
    expect_times("", 0, 0.5, 0.5);
    write_path(",\"time\":0.25", "", ",\"frame\":1");
    expect_times("", 2, 0.0, 1.0);
    assert_true(warned("warning: path.json: times are left out: not all cameras have one\n"));
    expect_times("--time 0.5", 0, 0.5, 0.5);
    assert_false(warned("warning"));
    write_path(",\"time\":0.5", ",\"frame\":0", ",\"time\":1");
    expect_times("", 2, 0.0, 1.0);
    assert_true(warned("warning: path.json: times are left out: they decrease\n"));
    assert_int_equal(run("ted4edit v1.ted4 -o p.ted4 --path path.json && "
                         "ted4dec p.ted4 --render p_%%d.png -f --path file --views 2"),
                     2);
    assert_true(warned("warning: p.ted4: times are left out: they decrease\n"));
}

/* A path with a picture for each of so many frames is refused, and it is no fault of the file. */
static void test_path_length(void **state)
{
    static const char name[] = "conformance/vectors/valid/levels/LVL-frames-4294967295.ted4";

    (void)state;
    need_programs();
    write_path("", "", "");
    assert_int_equal(run("ted4dec '%s/%s' --render l_%%d.png --path path.json", root(), name), 3);
    assert_true(warned(": the path would have 4294967295 pictures; --views says how many, at most "
                       "1000000\n"));
    assert_int_equal(
        run("ted4dec '%s/%s' --render l_%%d.png --path path.json --views 2", root(), name), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_orbit),
        cmocka_unit_test(test_path_times),
        cmocka_unit_test(test_path_length),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
