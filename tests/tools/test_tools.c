/* test_tools.c - ted4dec and ted4eval as programs: hashes, exports, pictures, quality of a scene
 * that is known.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <jansson.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include "data/image_file.h"
#include "render/png_file.h"
#include "render/view.h"
#include "tool_files.h"
#include "tool/sh.h"

enum { WIDTH = 96, HEIGHT = 64, VIEWS = 3 };

/* ---- ted4dec ---- */

/* The contract's bound of memory holds for queries too: those of this vector take more than
 * decoding. */
static void test_contract_bound(void **state)
{
    static const char query[] = "[{\"t\":[0,1],\"cam\":[0,0,0]}]";

    (void)state;
    need_programs();
    write_contents("query.json", (const uint8_t *)query, strlen(query));
    for (int tier = 1; tier <= 5; tier += 4) {
        assert_int_equal(
            run("ted4dec --ted4-run %s/conformance/vectors/valid/header/HDR-head_width-512.ted4 "
                "--tiers T%d --queries query.json "
                "--knob max_alloc_total=180000",
                root(), tier),
            0);
        assert_non_null(strstr(out, tier == 1 ? "\"result\":\"valid\"" : "\"limit.memory\""));
    }
}

/* With every Gaussian kept, a raw file is what the hash of the query covers. */
static void test_hash(void **state)
{
    (void)state;
    need_programs();
    for (int view = 0; view < 3; view++) {
        char want[128], hash[33];
        size_t size;

        assert_int_equal(run("ted4dec v%d.ted4 -o all%d.raw --keep-all --time 1/3 %s", view, view,
                             view == 0 ? "" : "--camera-centre 1,-2,0.5"),
                         view == 2 ? 2 : 0);
        snprintf(want, sizeof want, "all%d.raw", view);
        uint8_t *const data = contents(want, &size);

        assert_int_equal(size, file[view].info.n_gaussians * 56);
        XXH128_canonical_t c;
        XXH128_canonicalFromHash(&c, XXH3_128bits(data, size));
        free(data);
        for (int i = 0; i < 16; i++)
            snprintf(hash + 2 * i, 3, "%02x", c.digest[i]);
        snprintf(want, sizeof want, "query 1/3 1,-2,0.5 %s\n", hash);
        assert_int_equal(run("ted4dec v%d.ted4 --hash --time 1/3 --camera-centre 1,-2,0.5", view),
                         0);
        assert_non_null(strstr(out, want));
        for (int i = 0; i < 16; i++)
            snprintf(hash + 2 * i, 3, "%02x", file[view].info.hash[i]);
        snprintf(want, sizeof want, "ends %s\n", hash);
        assert_memory_equal(out, want, strlen(want));
    }
}

static void test_frames(void **state)
{
    (void)state;
    need_programs();
    assert_int_equal(run("ted4dec v1.ted4 -o f_%%03d.splat --frames 0:3:2"), 0);
    assert_true(exists("f_000.splat"));
    assert_true(exists("f_002.splat"));
    assert_true(!exists("f_001.splat"));
    assert_int_equal(run("ted4dec v1.ted4 -o f_%%03d.splat --frames 1:3"), 3); /* 2 is there */
    assert_false(exists("f_001.splat"));
    assert_int_equal(run("ted4dec v1.ted4 -o f_%%03d.splat --frames 1:3 -f"), 0);
    assert_true(exists("f_001.splat"));
    for (int i = 0; i < 3; i++) { /* all Gaussians, in the order of the scene */
        static const char *const name[] = { "f_000.splat", "f_001.splat", "f_002.splat" };
        size_t size, raw_size;
        uint8_t *const splat = contents(name[i], &size);

        assert_int_equal(run("ted4dec v1.ted4 -o all.raw --keep-all -f --frames %d", i), 0);
        uint8_t *const raw = contents("all.raw", &raw_size);

        assert_int_equal(size, file[1].info.n_gaussians * 32);
        assert_int_equal(raw_size, file[1].info.n_gaussians * 56);
        for (size_t k = 0; k < file[1].info.n_gaussians; k++)
            assert_memory_equal(splat + k * 32, raw + k * 56, 24);
        free(splat);
        free(raw);
    }
    assert_int_equal(run("ted4dec v1.ted4 -o g_%%d.splat --frames 1 --drop-faint"), 0);
    assert_int_equal(run("ted4dec v1.ted4 -o g.splat --frames 1"), 0);
    assert_int_equal(size_of("g_1.splat"), size_of("g.splat"));
    assert_true(size_of("g.splat") < file[1].info.n_gaussians * 32);
    assert_int_equal(run("ted4dec v1.ted4 -o LOUD.PLY --frames 1"), 0);
    assert_true(exists("LOUD.PLY"));
    assert_int_equal(run("ted4dec v1.ted4 -o one.glb --frames 1 --json"), 0);
    assert_non_null(strstr(out, "\"path\":\"one.glb\""));
}

static float float_at(const uint8_t *p)
{
    float v;

    memcpy(&v, &(uint32_t) { p[0] | p[1] << 8 | p[2] << 16 | (uint32_t)p[3] << 24 }, sizeof v);
    return v;
}

/* Fitted spherical harmonics, in some direction, against colours decoded for a camera far away in
 * that direction. */
static void test_fitted_colours(void **state)
{
    const ted4_info *const info = &file[1].info;
    const double d[3] = { 0.48, -0.6, 0.64 };
    double basis[TED4_SH_MAX_COEFS], far[3], sum = 0.0, spread = 0.0;
    size_t size;

    (void)state;
    need_programs();
    for (int c = 0; c < 3; c++)
        far[c] = (double)info->origin[c] - ldexp(d[c], 18 + info->exponent);
    assert_int_equal(run("ted4dec v1.ted4 -o fit.ply --sh-degree 3 --keep-all --time 0"), 0);
    assert_int_equal(
        run("ted4dec v1.ted4 -o far.raw --keep-all --time 0 --camera-centre %.9g,%.9g,%.9g", far[0],
            far[1], far[2]),
        0);
    uint8_t *const ply = contents("fit.ply", &size);
    const uint8_t *const values = (const uint8_t *)strstr((const char *)ply, "end_header\n") + 11;

    assert_int_equal(ply + size - values, info->n_gaussians * 4 * 62);
    uint8_t *const raw = contents("far.raw", &size);

    ted4_sh_basis(d, 3, basis);
    for (size_t i = 0; i < info->n_gaussians; i++) {
        for (size_t c = 0; c < 3; c++) {
            const double want = (double)float_at(raw + i * 56 + 44 + c * 4);
            const double flat = 0.5 + basis[0] * (double)float_at(values + i * 248 + 24 + c * 4);
            double got = flat;

            for (size_t k = 1; k < TED4_SH_MAX_COEFS; k++)
                got += basis[k] * (double)float_at(values + i * 248 + 36 + (c * 15 + k - 1) * 4);
            sum += (got - want) * (got - want);
            spread += (flat - want) * (flat - want);
        }
    }
    assert_true(sqrt(sum / (3.0 * (double)info->n_gaussians)) < 0.02);
    assert_true(sum < 0.1 * spread); /* and it is the direction that makes the difference */
    free(ply);
    free(raw);
}

/* ---- pictures ---- */

/* View i looks at the scene from one of three sides, at time i / 2. */
static void camera_make(const ted4_info *info, int i, ted4_view *v, double centre[3])
{
    static const float R[VIEWS][9] = {
        { 1, 0, 0, 0, 1, 0, 0, 0, 1 },
        { 0, 0, 1, 0, 1, 0, -1, 0, 0 },
        { -1, 0, 0, 0, 1, 0, 0, 0, -1 },
    };
    double t[3] = { 0.0, 0.0, 0.0 };

    *v = (ted4_view) { .width = WIDTH, .height = HEIGHT, .fx = 80, .fy = 80, .cx = 48, .cy = 32 };
    memcpy(v->R, R[i], sizeof v->R);
    for (int k = 0; k < 3; k++) {
        /* As a float, so that text files carry it exactly. */
        centre[k] = (double)(float)((double)info->origin[k] -
                                    ldexp(2.5 * (double)R[i][6 + k], info->exponent));
        for (int r = 0; r < 3; r++)
            t[r] -= (double)R[i][3 * r + k] * centre[k];
    }
    for (int r = 0; r < 3; r++)
        v->t[r] = (float)t[r];
}

static json_t *numbers(const float *v, int n)
{
    json_t *const list = json_array();

    for (int i = 0; i < n; i++)
        json_array_append_new(list, json_real((double)v[i]));
    return list;
}

static void save(json_t *o, const char *name)
{
    char path[PATH_SIZE];

    path_of(path, name);
    assert_int_equal(json_dump_file(o, path, JSON_INDENT(1)), 0);
    json_decref(o);
}

static uint8_t *drawn(int i)
{
    uint8_t *const rgb = malloc(WIDTH * HEIGHT * 3);
    ted4_viewer *const viewer = ted4_viewer_new();
    double centre[3];
    ted4_view v;

    assert_non_null(rgb);
    assert_non_null(viewer);
    camera_make(&file[1].info, i, &v, centre);
    assert_int_equal(ted4_render_query(viewer, file[1].recon, &file[1].info, (uint32_t)i, VIEWS - 1,
                                       &v, NULL, rgb),
                     TED4_OK);
    ted4_viewer_free(viewer);
    return rgb;
}

/* A member of the first camera says how large its pixels are (annex I.4). cameras: three, already
 * drawn as view_N.png. */
static void check_pixel(const json_t *cameras)
{
    json_t *const list = json_deep_copy(cameras), *const first = json_array_get(list, 0);

    json_object_set_new(first, "pixel", json_real(1));
    save(json_incref(list), "pixel.json");
    assert_int_equal(run("ted4dec v1.ted4 --render pix_%%d.png --camera pixel.json && "
                         "cmp pix_0.png view_0.png"),
                     0);
    json_object_set_new(first, "pixel", json_real(2));
    save(json_incref(list), "pixel.json");
    assert_int_equal(run("ted4dec v1.ted4 --render pix_%%d.png -f --camera pixel.json && "
                         "cmp pix_1.png view_1.png"),
                     0);
    assert_int_equal(run("cmp -s pix_0.png view_0.png"), 1);
    json_object_set_new(first, "pixel", json_real(0));
    save(json_incref(list), "pixel.json");
    assert_int_equal(run("ted4dec v1.ted4 --render pix_%%d.png -f --camera pixel.json 2>&1 | "
                         "grep -q 'camera 0 has a pixel that is not a number above 0'"),
                     0);
    json_decref(list);
}

static void test_render(void **state)
{
    json_t *const list = json_array();
    int colours = 0;

    (void)state;
    need_programs();
    for (int i = 0; i < VIEWS; i++) {
        double centre[3];
        ted4_view v;
        char time[8];

        camera_make(&file[1].info, i, &v, centre);
        snprintf(time, sizeof time, "%d/%d", i, VIEWS - 1);
        json_array_append_new(list,
                              json_pack("{s:i, s:i, s:f, s:f, s:f, s:f, s:o, s:o, s:s}", "width",
                                        v.width, "height", v.height, "fx", (double)v.fx, "fy",
                                        (double)v.fy, "cx", (double)v.cx, "cy", (double)v.cy, "R",
                                        numbers(v.R, 9), "t", numbers(v.t, 3), "time", time));
    }
    save(json_incref(list), "cameras.json");
    assert_int_equal(run("ted4dec v1.ted4 --render view_%%d.png --camera cameras.json"), 0);
    check_pixel(list);
    json_decref(list);
    assert_int_equal(run("ted4dec v1.ted4 --render view_%%d.png --camera cameras.json"), 3);
    for (int i = 0; i < VIEWS; i++) {
        uint8_t *const want = drawn(i);
        char name[32], path[PATH_SIZE];
        ted4_message m;
        ted4_image image;

        snprintf(name, sizeof name, "view_%d.png", i);
        path_of(path, name);
        assert_int_equal(ted4_image_read(path, &image, &m), 0);
        assert_int_equal(image.width, WIDTH);
        assert_int_equal(image.height, HEIGHT);
        assert_int_equal(image.channels, 3);
        assert_memory_equal(image.bytes, want, WIDTH * HEIGHT * 3);
        for (int k = 3; k < WIDTH * HEIGHT * 3; k++)
            colours += want[k] != want[k - 3];
        free(image.bytes);
        free(want);
    }
    assert_true(colours > 1000); /* something is to be seen */
}

static void write_scene_file(const char *name)
{
    json_t *const frames = json_array();

    for (int i = 0; i < VIEWS; i++) {
        json_t *const rows = json_array();
        double centre[3];
        ted4_view v;
        char picture[16];

        camera_make(&file[1].info, i, &v, centre);
        for (int r = 0; r < 3; r++) /* columns right, up, backward, centre */
            json_array_append_new(rows, json_pack("[f,f,f,f]", (double)v.R[r], -(double)v.R[3 + r],
                                                  -(double)v.R[6 + r], centre[r]));
        json_array_append_new(rows, json_pack("[f,f,f,f]", 0.0, 0.0, 0.0, 1.0));
        snprintf(picture, sizeof picture, "p%d.png", i);
        json_array_append_new(frames, json_pack("{s:s, s:f, s:o}", "file_path", picture, "time",
                                                i / (VIEWS - 1.0), "transform_matrix", rows));
    }
    save(json_pack("{s:f, s:f, s:f, s:f, s:i, s:i, s:o}", "fl_x", 80.0, "fl_y", 80.0, "cx", 48.0,
                   "cy", 32.0, "w", WIDTH, "h", HEIGHT, "frames", frames),
         name);
}

/* A path of a file is drawn with pixels of another width if the file's cameras, at half its size,
 * tell what was learnt (annex I.4); and so is a path whose first camera says it. */
static void check_path_pixel(void)
{
    char path[PATH_SIZE];
    json_t *list, *camera, *value;
    const char *member;
    size_t i;

    path_of(path, "cameras.json");
    list = json_load_file(path, 0, NULL);
    assert_non_null(list);
    json_array_foreach(list, i, camera) json_object_foreach(camera, member, value)
    {
        if (json_is_integer(value))
            json_integer_set(value, 2 * json_integer_value(value));
        else if (json_is_real(value))
            json_real_set(value, 2.0 * json_real_value(value));
    }
    save(json_incref(list), "large.json");
    json_object_set_new(json_array_get(list, 0), "pixel", json_real(0.5));
    save(list, "halves.json");
    assert_int_equal(run("ted4edit v1.ted4 -o l.ted4 --cameras cameras.json --path large.json && "
                         "ted4dec l.ted4 --render l_%%d.png --path file --views 3 && "
                         "ted4dec v1.ted4 --render h_%%d.png --path halves.json --views 3 && "
                         "cmp l_0.png h_0.png && cmp l_1.png h_1.png && cmp l_2.png h_2.png && "
                         "ted4info l.ted4 --path >said.json && "
                         "ted4dec v1.ted4 --render m_%%d.png --path said.json --views 3 && "
                         "for i in 0 1 2; do cmp l_$i.png m_$i.png || exit 9; done"),
                     0);
    assert_int_equal(run("ted4edit v1.ted4 -o g.ted4 --path large.json && "
                         "ted4dec g.ted4 --render g_%%d.png --path file --views 3 && "
                         "cmp -s g_0.png l_0.png"),
                     1);
}

/* The same cameras as a list, as a transforms file, with sizes from pictures, and as the file
 * itself says: the same pictures. */
static void test_cameras(void **state)
{
    (void)state;
    need_programs();
    write_scene_file("transforms.json");
    assert_int_equal(run("ted4dec v1.ted4 --render t_%%d.png --camera transforms.json && "
                         "for i in 0 1 2; do cmp t_$i.png view_$i.png || exit 9; "
                         "cp t_$i.png p$i.png; done"),
                     0);
    assert_int_equal(
        run("sed '/\"[wh]\": /d; /\"c[xy]\": /d; /\"fl_y\"/d' transforms.json >bare.json"
            " && ted4dec v1.ted4 --render t_%%d.png -f --camera ./bare.json && "
            "cmp t_2.png view_2.png"),
        0);
    /* Distortion is left out, with a warning; a lens that is not perspective is refused. */
    assert_int_equal(run("sed 's/\"fl_x\"/\"k1\": 0.1, \"fl_x\"/' transforms.json >bent.json && "
                         "ted4dec v1.ted4 --render t_%%d.png -f --camera bent.json"),
                     2);
    assert_int_equal(run("cmp t_2.png view_2.png"), 0);
    assert_int_equal(
        run("sed 's/\"fl_x\"/\"is_fisheye\": true, \"fl_x\"/' transforms.json >eye.json;"
            " ted4dec v1.ted4 --render t_%%d.png -f --camera eye.json"),
        3);
    assert_int_equal(run("ted4edit v1.ted4 -o c.ted4 --cameras cameras.json --path cameras.json && "
                         "ted4dec c.ted4 --render t_%%d.png -f --camera file && "
                         "cmp t_1.png view_1.png && ted4info c.ted4 --cameras >list.json && "
                         "ted4dec v1.ted4 --render t_%%d.png -f --camera list.json && "
                         "cmp t_1.png view_1.png && ted4info c.ted4 --path >path.json && "
                         "sed 's/,\"pixel\":[0-9.e-]*//' path.json | cmp - list.json"),
                     0);
    /* A path through these cameras, of as many pictures, at their times; and at one time. */
    assert_int_equal(run("ted4dec c.ted4 --render p_%%d.png --path file --views 3 && "
                         "cmp p_0.png view_0.png && cmp p_2.png view_2.png && "
                         "ted4dec c.ted4 --render q_%%d.png --path list.json --views 3 --time 0 && "
                         "cmp q_0.png view_0.png && ! cmp -s q_2.png view_2.png"),
                     0);
    check_path_pixel();
    assert_int_equal(run("ted4dec v1.ted4 --render f_%%02d.png --path list.json"), 0);
    for (uint32_t i = 0; i <= file[1].info.frames; i++) {
        char name[32];

        snprintf(name, sizeof name, "f_%02u.png", (unsigned)i);
        assert_int_equal(exists(name), i < file[1].info.frames);
    }
    /* Around the scene: with the size of the file's cameras, or without any camera. */
    assert_int_equal(run("ted4dec c.ted4 --render o_%%d.png --orbit 2 && "
                         "ted4dec v1.ted4 --render u_%%d.png --orbit 2 --up z"),
                     0);
    assert_true(exists("o_1.png") && exists("u_1.png"));
    assert_int_equal(run("ted4dec v1.ted4 --render n.png --camera file"), 3);
    assert_int_equal(run("ted4dec v1.ted4 --render n.png --path file"), 3);
    assert_int_equal(run("ted4info v1.ted4 --cameras"), 3);
}

/* ---- ted4eval ---- */

static double result(const char *key)
{
    json_t *const o = json_loads(out, 0, NULL);

    assert_non_null(o);
    const json_t *const v = json_object_get(o, key);
    const double value = json_is_number(v) ? json_number_value(v) : -1.0;

    json_decref(o);
    return value;
}

/* No pose explains that pictures are brighter: the fit finds next to nothing. psnr: of the pictures
 * without it. */
static void check_aligned(double psnr)
{
    assert_int_equal(run("ted4eval v1.ted4 scene --anyway --json --align"), 0);
    assert_true(result("psnr") == psnr);
    assert_true(fabs(result("psnr_half") - psnr) < 0.01);
    assert_true(result("psnr_aligned") > psnr - 0.5);
    assert_int_equal(run("ted4eval v1.ted4 scene --anyway --align"), 0);
    assert_non_null(strstr(out, "half       "));
    assert_non_null(strstr(out, "aligned    "));
}

/* A map of colours explains that pictures are brighter, if its camera has training pictures. psnr:
 * of the pictures without it. */
static void check_colours(double psnr)
{
    assert_int_equal(run("ted4eval v1.ted4 scene --anyway --json --colours"), 0);
    assert_true(result("psnr") == psnr);
    assert_true(fabs(result("psnr_raw") - psnr) < 1e-3);
    assert_true(result("psnr_fitted") > psnr + 1.0);
    assert_true(result("views_fitted") == VIEWS);
    assert_int_equal(run("ted4eval v1.ted4 scene --anyway --colours --hold-out p0"), 0);
    assert_non_null(strstr(out, "of         0 views"));
    assert_null(strstr(out, "fitted "));
    assert_int_equal(run("ted4eval v1.ted4 scene --anyway --json --colours --hold-out p0"), 0);
    assert_true(result("views_fitted") == 0);
    assert_true(result("psnr_fitted") == -1.0); /* null */
    assert_int_equal(run("ted4eval v1.ted4 scene --anyway --colours --hold-out p0 2>&1 | "
                         "grep -c 'by 1 camera without training pictures'"),
                     0);
}

/* Cameras with one picture each have no median. Six pictures of one camera have: p1 is the one that
 * differs, and what the file shows is as near to p0 as before. */
static void check_moving(double psnr)
{
    json_t *root, *frame;
    char path[PATH_SIZE];

    assert_int_equal(run("ted4eval v1.ted4 scene --anyway --json --moving"), 0);
    assert_true(result("psnr") == psnr);
    assert_true(result("views_moving") == 0);
    assert_true(result("psnr_moving") == -1.0); /* null */
    assert_int_equal(run("mkdir before && for i in 0 1 2 3 4; do cp scene/p0.png before/q$i.png; "
                         "done && cp scene/p1.png before/q5.png"),
                     0);
    path_of(path, "scene/transforms_test.json");
    root = json_load_file(path, 0, NULL);
    assert_non_null(root);
    frame = json_deep_copy(json_array_get(json_object_get(root, "frames"), 0));
    json_array_clear(json_object_get(root, "frames"));
    for (int i = 0; i < 6; i++) {
        char name[16];

        snprintf(name, sizeof name, "q%d.png", i);
        json_object_set_new(frame, "file_path", json_string(name));
        json_object_set_new(frame, "time", json_real(0.1 * i));
        json_array_append_new(json_object_get(root, "frames"), json_deep_copy(frame));
    }
    json_decref(frame);
    json_incref(root); /* save releases it */
    save(root, "before/transforms_train.json");
    save(root, "before/transforms_test.json");
    assert_int_equal(run("ted4eval v1.ted4 before --anyway --json --moving --images moved"), 0);
    assert_true(result("views_moving") == 6);
    assert_true(result("pixels_moving") > 0);
    assert_true(result("pixels_moving") < WIDTH * HEIGHT);
    assert_true(result("psnr_moving") > 0 && result("psnr_moving") < result("psnr"));
    assert_true(exists("moved/moving/00005.png"));
    assert_int_equal(run("cmp moved/moving/00000.png moved/moving/00004.png"), 0);
    assert_int_equal(run("cmp -s moved/moving/00000.png moved/moving/00005.png"), 1);
    assert_int_equal(run("ted4eval v1.ted4 before --anyway --moving"), 0);
    assert_non_null(strstr(out, "moving     "));
    assert_non_null(strstr(out, "pixels in 6 views"));
}

/* Pictures that differ from what the file shows by one step everywhere. */
static void test_eval(void **state)
{
    char path[PATH_SIZE], why[256];
    ted4_message m;
    size_t size;
    ted4_image_header sheet;

    (void)state;
    need_programs();
    path_of(path, "scene");
    assert_int_equal(mkdir(path, 0777), 0);
    for (int i = 0; i < VIEWS; i++) {
        uint8_t *const rgb = drawn(i);
        char name[32];

        for (int k = 0; k < WIDTH * HEIGHT * 3; k++)
            rgb[k] = (uint8_t)(rgb[k] < 255 ? rgb[k] + 1 : 254);
        snprintf(name, sizeof name, "scene/p%d.png", i);
        path_of(path, name);
        assert_int_equal(ted4_png_write(path, WIDTH, HEIGHT, rgb, why, sizeof why), 0);
        free(rgb);
    }
    write_scene_file("scene/transforms_train.json");
    write_scene_file("scene/transforms_test.json");
    /* The vector is of no scene at all. */
    assert_int_equal(run("ted4eval v1.ted4 scene"), 3);
    assert_int_equal(
        run("ted4eval v1.ted4 scene --anyway --json --images pictures --sheet sheet.png"), 0);
    free(contents("v1.ted4", &size));
    assert_true(fabs(result("psnr") - 20.0 * log10(255.0)) < 1e-3);
    assert_true(result("ssim") > 0.99);
    assert_true(result("ssim") < 1.0);
    assert_true(result("ssim2") > 0.99);
    assert_true(result("ms_ssim") > 0.99);
    assert_true(fabs(result("l1") - 1.0 / 255.0) < 1e-6);
    assert_true(result("bytes") == (double)size);
    assert_true(result("views") == VIEWS);
    assert_true(result("decode_ms") > 0.0);
    assert_true(result("render_fps") > 0.0);
    assert_true(result("psnr_aligned") < 0);
    assert_true(result("psnr_fitted") < 0);
    const double psnr = result("psnr");

    check_aligned(psnr);
    check_colours(psnr);
    check_moving(psnr);
    path_of(path, "sheet.png");
    assert_int_equal(ted4_image_probe(path, &sheet, &m), 0);
    assert_int_equal(sheet.width, 3 * WIDTH);
    assert_int_equal(sheet.height, 3 * HEIGHT);
    assert_true(exists("pictures/truth/00002.png"));
    assert_true(exists("pictures/ours/00002.png"));
    assert_true(exists("pictures/error/00002.png"));
    /* The sheet is there by now. */
    assert_int_equal(run("ted4eval v1.ted4 scene --anyway --split train --sheet sheet.png"), 3);
    assert_int_equal(run("ted4eval v1.ted4 scene --anyway --split train --sheet sheet.png -f"), 0);
    assert_non_null(strstr(out, "psnr"));
    write_contents("bad.ted4", "no", 2);
    assert_int_equal(run("ted4eval bad.ted4 scene"), 1);
    assert_int_equal(run("ted4eval v1.ted4 missing"), 3);
    assert_int_equal(run("ted4eval v1.ted4 scene --split both"), 3);
}

/* Smaller pictures are closer to what the file shows if its Gaussians are widened as they were in
 * training (annex I.4). */
static void test_trained_downscale(void **state)
{
    double psnr, without;

    (void)state;
    need_programs();
    assert_int_equal(run("ted4eval v1.ted4 scene --anyway --json"), 0);
    psnr = result("psnr");
    assert_int_equal(run("ted4eval v1.ted4 scene --anyway --json --trained-downscale 1"), 0);
    assert_true(result("psnr") == psnr);
    assert_int_equal(run("ted4eval v1.ted4 scene --anyway --json --downscale 2"), 0);
    without = result("psnr");
    assert_int_equal(
        run("ted4eval v1.ted4 scene --anyway --json --downscale 2 --trained-downscale 1"), 0);
    assert_true(result("psnr") > without + 3.0);
    assert_int_equal(run("ted4eval v1.ted4 scene --trained-downscale 0"), 3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_contract_bound), cmocka_unit_test(test_hash),
        cmocka_unit_test(test_frames),         cmocka_unit_test(test_fitted_colours),
        cmocka_unit_test(test_render),         cmocka_unit_test(test_cameras),
        cmocka_unit_test(test_eval),           cmocka_unit_test(test_trained_downscale),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
