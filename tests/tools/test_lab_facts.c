/* test_lab_facts.c - the measurements of bench/lab_facts, where the answer is known: anchors that
 * leave every picture and how far they move, on tracks made by hand; pictures that equal what the
 * file shows, except one; symbols set to the ends of their ranges; a log of a few lines.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "test.h"
#include "bench/lab_facts.h"
#include "ball_scene.h"
#include "random_scene.h"
#include "render/png_file.h"
#include "train/model/normalise.h"

/* Error function of the measuring files; no error may occur here. */
int lab_failed(const char *what, const char *why)
{
    fail_msg("%s: %s", what, why);
    return 1;
}

/* ---- anchors ---- */

enum { TIMES = 4, ANCHORS = 9, BLIND = 3 }; /* there are no training pictures at time BLIND */

/* A camera that looks along z from x = at, with a field of view of 90 degrees: it sees at - z < x <
 * at + z. */
static ted4_camera camera_at(double at)
{
    return (ted4_camera) { .width = 100,
                           .height = 100,
                           .fx = 50,
                           .fy = 50,
                           .cx = 50,
                           .cy = 50,
                           .R = { 1, 0, 0, 0, 1, 0, 0, 0, 1 },
                           .t = { -at, 0, 0 } };
}

/* x and z of each anchor at times 0, 1, 2, and whether it is drawn then; y is 0. At time 3 all are
 * at x = 1000, and drawn, but there is no camera. Cameras: one at x = 0 and one at x = 10; at time
 * 2 the second is at x = 20. */
static const struct {
    float x[3], z[3];
    int drawn[3], counts, out;
    double way;
} made[ANCHORS] = {
    { { 1, 1, 1 }, { 4, 4, 4 }, { 1, 1, 1 }, 1, 0, 0 },  /* does not move */
    { { 1, -5, 1 }, { 4, 4, 4 }, { 1, 1, 1 }, 1, 1, 6 }, /* leaves the pictures, and returns */
    { { 1, -5, 2 }, { 4, 4, 4 }, { 1, 0, 1 }, 1, 0, 1 }, /* the same, but is not drawn in between */
    { { 1, 8, 1 }, { 4, 4, 4 }, { 1, 1, 1 }, 1, 0, 7 },  /* moves from one picture to another */
    { { -9, -8, -9 }, { 4, 4, 4 }, { 1, 1, 1 }, 1, 0, 1 },    /* was never in any picture */
    { { 10, 10, 10 }, { 4, 4, 4 }, { 1, 1, 1 }, 1, 0, 0 },    /* the camera moves away from it */
    { { 1, 1, 1 }, { 4, -4, 4 }, { 1, 1, 1 }, 1, 1, 8 },      /* moves behind the cameras */
    { { 1, 1, 1 }, { 4, 4, 4 }, { 0, 0, 0 }, 0, 0, 0 },       /* is drawn only without cameras */
    { { 0, 0, 0 }, { 4, 0.25f, 4 }, { 1, 1, 1 }, 1, 1, 3.75 } /* comes too near */
};

static void test_anchors(void **state)
{
    static float centre[TIMES * ANCHORS * 3];
    static uint8_t drawn[TIMES * ANCHORS];
    const ted4_camera here = camera_at(0), there = camera_at(10), gone = camera_at(20);
    const ted4_camera *both[2] = { &here, &there }, *later[2] = { &here, &gone };
    lab_rig rig[TIMES] = { { both, 2 }, { both, 2 }, { later, 2 }, { NULL, 0 } };
    lab_tracks t = {
        .n_times = TIMES, .centre = centre, .drawn = drawn, .rig = rig, .near_z = 0.5, .size = 2
    };
    lab_anchors a;

    (void)state;
    for (size_t i = 0; i < ANCHORS; i++) {
        /* Each alone, so that a wrong one is identified by its number. */
        t.n = 1;
        for (size_t time = 0; time < TIMES; time++) {
            centre[3 * time] = time == BLIND ? 1000 : made[i].x[time];
            centre[3 * time + 2] = time == BLIND ? 4 : made[i].z[time];
            drawn[time] = time == BLIND ? 1 : (uint8_t)made[i].drawn[time];
        }
        assert_int_equal(lab_judge_anchors(&t, &a), 0);
        if (a.drawn != (size_t)made[i].counts || a.out != (size_t)made[i].out ||
            fabs(a.displacement - made[i].way / t.size) > 1e-12)
            fail_msg("anchor %zu: drawn %zu, out %zu, displacement %g", i, a.drawn, a.out,
                     a.displacement);
    }
    t.n = ANCHORS;
    for (size_t time = 0; time < TIMES; time++)
        for (size_t i = 0; i < ANCHORS; i++) {
            centre[3 * (time * ANCHORS + i)] = time == BLIND ? 1000 : made[i].x[time];
            centre[3 * (time * ANCHORS + i) + 2] = time == BLIND ? 4 : made[i].z[time];
            drawn[time * ANCHORS + i] = time == BLIND ? 1 : (uint8_t)made[i].drawn[time];
        }
    assert_int_equal(lab_judge_anchors(&t, &a), 0);
    assert_int_equal(a.drawn, 8);
    assert_int_equal(a.out, 3);
    assert_true(fabs(a.displacement - 4) < 1e-12);
    assert_true(fabs(a.displacement_99 - 3.5) < 1e-12);
}

/* ---- a file ---- */

/* A scene written by ted4_encode and read by ted4_decode. change: applied to it before, or NULL. */
static void open_random(lab_session *s, void (*change)(ted4_scene *))
{
    random_source r = random_seed(7);
    const ted4_header h = random_small_header(300);
    ted4_scene *made_scene = random_scene_of(&r, &h, 0);
    uint8_t *bytes;

    memset(s, 0, sizeof *s);
    assert_non_null(made_scene);
    if (change != NULL)
        change(made_scene);
    assert_int_equal(ted4_encode(made_scene, 0, NULL, &bytes, &s->bytes, NULL), TED4_OK);
    ted4_scene_free(made_scene);
    assert_int_equal(ted4_decode(bytes, s->bytes, NULL, &s->scene, NULL), TED4_OK);
    free(bytes);
    assert_int_equal(ted4_recon_new(&s->recon, s->scene, NULL), TED4_OK);
    ted4_scene_info(s->scene, &s->info);
}

static void close_session(lab_session *s)
{
    ted4_dataset_free(&s->data);
    ted4_recon_free(s->recon);
    ted4_scene_free(s->scene);
}

/* Overwrites the picture's file with what the scene shows there, with every value off by one if
 * wrong is set. Returns how many values differ from that of the previous pixel. */
static size_t show(lab_session *s, const ted4_picture *p, ted4_viewer *viewer, int wrong)
{
    const ted4_header world = { 0 };
    uint8_t rgb[3 * BALL_W * BALL_H];
    ted4_view view;
    float centre[3];
    char why[256];
    size_t edges = 0;

    ted4_normalise_view(&world, &p->camera, &view, centre);
    assert_int_equal(ted4_render_query(viewer, s->recon, &s->info, p->frame, s->data.n_frames - 1,
                                       &view, NULL, rgb),
                     TED4_OK);
    for (size_t k = 0; k < sizeof rgb; k++) {
        edges += k > 2 && rgb[k] != rgb[k - 3];
        if (wrong)
            rgb[k] = (uint8_t)(rgb[k] < 255 ? rgb[k] + 1 : 254);
    }
    assert_int_equal(ted4_png_write(p->path, BALL_W, BALL_H, rgb, why, sizeof why), 0);
    return edges;
}

/* An exact picture counts as if one of its values were off by one. */
static void test_views(void **state)
{
    tiny_folder f = tiny_new();
    ted4_viewer *const viewer = ted4_viewer_new();
    ted4_dataset_options options = tiny_options;
    const double all_wrong = 20 * log10(255), right = all_wrong + 10 * log10(3 * BALL_W * BALL_H);
    lab_session s;
    lab_views v;
    size_t last = 0, n = 0, edges = 0;

    (void)state;
    ball_scene(&f, 5, 0);
    open_random(&s, NULL);
    options.white = s.info.background[0] > 127;
    assert_string_equal(tiny_load(&s.data, &f, &options), "");
    for (size_t i = 0; i < s.data.n_pictures; i++)
        if (s.data.pictures[i].is_test) {
            last = i;
            n++;
        }
    for (size_t i = 0; i < s.data.n_pictures; i++)
        edges += show(&s, &s.data.pictures[i], viewer, i == last);
    assert_true(edges > 1000); /* the picture is not empty */

    const uint32_t frame = s.data.pictures[last].frame, camera = s.data.pictures[last].camera_id;

    ted4_dataset_free(&s.data);
    assert_string_equal(tiny_load(&s.data, &f, &options), "");
    assert_int_equal(lab_measure_views(&s, tiny_path(&f, "strip.png"), &v), 0);
    assert_true(n > 1);
    assert_int_equal(v.views, n);
    assert_int_equal(v.exact, n - 1);
    assert_int_equal(v.refused, 0);
    assert_int_equal(v.worst_frame, frame);
    assert_int_equal(v.worst_camera, camera);
    assert_true(fabs(v.worst - all_wrong) < 1e-9);
    assert_true(fabs(v.mean - (right * (double)(n - 1) + all_wrong) / (double)n) < 1e-9);
    assert_true(tiny_size(&f, "strip.png") > 100);
    close_session(&s);
    ted4_viewer_free(viewer);
    tiny_free(&f);
}

/* The tracks of a file are those of its Gaussians: an anchor is at their mean, and moves by the
 * same path as each of them. */
static void test_tracks(void **state)
{
    tiny_folder f = tiny_new();
    lab_session s;
    lab_tracks t;
    lab_gaussians count;
    ted4_gaussians g;
    const ted4_query end = { .num = 1, .den = 1 };
    float *first;
    size_t moved = 0;
    double middle = 0;

    (void)state;
    ball_scene(&f, 5, 0);
    open_random(&s, NULL);
    assert_string_equal(tiny_load(&s.data, &f, &tiny_options), "");
    assert_int_equal(lab_make_tracks(&s, &t, &count), 0);
    assert_int_equal(t.n, 300);
    assert_int_equal(t.n_times, 5);
    assert_int_equal(count.gaussians, s.info.n_gaussians);
    assert_int_equal(count.refused, 0);
    first = malloc(s.info.n_gaussians * sizeof *first);
    assert_int_equal(ted4_recon_query(s.recon, &(ted4_query) { .num = 0, .den = 1 }, NULL, &g),
                     TED4_OK);
    memcpy(first, g.mean[1], g.n * sizeof *first);
    assert_int_equal(ted4_recon_query(s.recon, &end, NULL, &g), TED4_OK);
    for (size_t i = 0; i < g.n; i++) {
        const size_t anchor = g.id[i] / s.info.n_offsets;
        const float way = t.centre[3 * (4 * t.n + anchor) + 1] - t.centre[3 * anchor + 1];

        assert_true(fabsf(way - (g.mean[1][i] - first[i])) < 1e-4f);
        assert_true(t.drawn[4 * t.n + anchor] || g.opacity[i] < TED4_RASTER_ALPHA_MIN);
        moved += fabsf(way) > 0.1f;
        middle += (double)g.mean[0][i] - (double)t.centre[3 * (4 * t.n + anchor)];
        if (i + 1 == g.n || g.id[i + 1] / s.info.n_offsets != anchor) {
            assert_true(fabs(middle) < 1e-4);
            middle = 0;
        }
    }
    assert_true(moved > 20);
    free(first);
    lab_free_tracks(&t);
    close_session(&s);
    tiny_free(&f);
}

/* ---- symbols ---- */

/* Two scalings at the ends of the range of symbols; three widths far below their minimum, two of
 * which belong to the same anchor. */
static void push(ted4_scene *s)
{
    const size_t n = s->head.n_anchors;

    s->symbol[TED4_SCALING][0] = 32767;
    s->symbol[TED4_SCALING][1] = -32767;
    s->symbol[TED4_TAU][n + 3] = -32000;
    s->symbol[TED4_TAU][3 * n + 3] = -32000;
    s->symbol[TED4_TAU][n + 4] = -32000;
}

static void test_symbols(void **state)
{
    lab_session s;
    lab_symbols plain, pushed;

    (void)state;
    open_random(&s, NULL);
    assert_int_equal(lab_count_symbols(&s, &plain), 0);
    close_session(&s);
    open_random(&s, push);
    assert_int_equal(lab_count_symbols(&s, &pushed), 0);
    close_session(&s);
    assert_int_equal(plain.symbols, pushed.symbols);
    assert_true(plain.symbols > 300 * (8 + 6 + 4));
    assert_int_equal(plain.contexts, 300 * 3);
    assert_int_equal(plain.steps, 300 * 5);
    assert_int_equal(plain.symbol_ends, 0);
    assert_int_equal(pushed.symbol_ends, 2);
    assert_int_equal(pushed.escapes, plain.escapes + 5);
    assert_int_equal(plain.widths, 600);
    assert_int_equal(pushed.width_ends, plain.width_ends + 3);
    assert_int_equal(pushed.sigma_ends, plain.sigma_ends);
}

/* ---- log ---- */

static void test_log(void **state)
{
    static const char lines[] =
        "{\"step\":250,\"loss\":0.5,\"gradients\":{\"heads\":1.5,\"prior\":0.5},\"peaks\":{"
        "\"heads\":1,\"prior\":12},\"rollbacks\":0,\"skipped\":1,\"clamped\":9}\n"
        "{\"step\":500,\"loss\":nan,\"gradients\":{\"heads\":1},\"peaks\":{\"heads\":nan}}\n"
        "{\"step\":500,\"event\":\"rollback\",\"rollbacks\":2,\"failed\":700,\"cause\":"
        "\"exploded\",\"term\":\"loss\",\"anchor\":null,\"factor\":0.25}\n"
        "{\"step\":750,\"loss\":0.25,\"gradients\":{\"heads\":4,\"prior\":0},\"peaks\":{\"heads\":"
        "2,\"prior\":0},\"rollbacks\":2}\n"
        "{\"step\":1000,\"loss\":0.75,\"gradients\":{\"heads\":2,\"prior\":3},\"peaks\":{\"heads\":"
        "3,\"prior\":0.5},\"rollbacks\":2,\"skipped\":4,\"clamped\":7}\n";
    tiny_folder f = tiny_new();
    lab_log l;

    (void)state;
    tiny_text(&f, "a.jsonl", lines);
    assert_int_equal(lab_read_log(tiny_path(&f, "a.jsonl"), &l), 0);
    assert_int_equal(l.lines, 3);
    assert_int_equal(l.bad, 1);
    assert_true(l.loss_first == 0.5);
    assert_true(l.loss_last == 0.75);
    assert_int_equal(l.rollbacks, 2);
    assert_true(l.gradient == 8);
    assert_true(l.peak == 12);
    assert_int_equal(l.skipped, 4);
    assert_int_equal(l.saturated, 7);
    assert_string_equal(l.gradient_term, "heads");
    assert_string_equal(l.peak_term, "prior");
    tiny_text(&f, "b.jsonl", "{\"step\":250,\"loss\":0.5}\n");
    assert_int_equal(lab_read_log(tiny_path(&f, "b.jsonl"), &l), 0);
    assert_int_equal(l.lines, 1);
    assert_true(l.gradient < 0);
    assert_true(l.peak < 0);
    assert_int_equal(l.rollbacks, 0);
    tiny_free(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_anchors), cmocka_unit_test(test_views), cmocka_unit_test(test_tracks),
        cmocka_unit_test(test_symbols), cmocka_unit_test(test_log),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
