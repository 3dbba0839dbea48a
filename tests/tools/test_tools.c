/* test_tools.c - ted4dec and ted4eval as programs: verdicts and exit codes, hashes, exports,
 * pictures, quality of a known scene. The programs are taken from $TED4_BUILD (set by
 * tests/run.sh); the test is skipped if that is not set.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "test.h"
#include <jansson.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include "data/image_file.h"
#include "random_scene.h"
#include "render/png_file.h"
#include "render/view.h"
#include "temporary.h"
#include "tool/sh.h"

enum { WIDTH = 96, HEIGHT = 64, VIEWS = 3, MAX_TEXT = 1 << 16, PATH_SIZE = TEMPORARY_SIZE + 128 };

static char folder[TEMPORARY_SIZE];
static const char *build;

/* One file for each kind of view input (none, colour, full): its name and contents. */
static struct {
    ted4_info info;
    ted4_recon *recon;
} file[3];

static char out[MAX_TEXT]; /* standard output of the last program */

/* Runs a program in the folder. Returns its exit code. */
static int run(const char *format, ...)
{
    char command[8192];
    va_list ap;
    int n = snprintf(command, sizeof command, "cd %s && PATH=%s:$PATH && exec 2>err && ", folder,
                     build);

    va_start(ap, format);
    n += vsnprintf(command + n, sizeof command - (size_t)n, format, ap);
    va_end(ap);
    assert_true(n < (int)sizeof command);
    FILE *const f = popen(command, "r");
    assert_non_null(f);
    out[fread(out, 1, sizeof out - 1, f)] = '\0';
    const int status = pclose(f);
    assert_true(WIFEXITED(status));
    return WEXITSTATUS(status);
}

static void path_of(char path[PATH_SIZE], const char *name)
{
    snprintf(path, PATH_SIZE, "%s/%s", folder, name);
}

static uint8_t *contents(const char *name, size_t *size)
{
    uint8_t *const data = malloc(1 << 22);
    char path[PATH_SIZE];

    path_of(path, name);
    FILE *const f = fopen(path, "rb");
    assert_non_null(f);
    assert_non_null(data);
    *size = fread(data, 1, 1 << 22, f);
    fclose(f);
    return data;
}

static void write_contents(const char *name, const void *data, size_t size)
{
    char path[PATH_SIZE];

    path_of(path, name);
    FILE *const f = fopen(path, "wb");
    assert_non_null(f);
    assert_int_equal(fwrite(data, 1, size, f), size);
    fclose(f);
}

static int exists(const char *name)
{
    char path[PATH_SIZE];

    path_of(path, name);
    return access(path, F_OK) == 0;
}

/* Makes the first random scene with that view input and a few frames, as vN.ted4, and opens it with
 * the library. */
static void make_file(int view)
{
    for (uint64_t seed = 0; seed < 1000; seed++) {
        ted4_scene *s = random_scene(seed);
        uint8_t *data;
        size_t size;
        char name[16];

        assert_non_null(s);
        if (s->head.view != view || s->head.n_anchors < 50 || s->head.frames < 3 ||
            s->head.frames > 60 || abs(s->head.exponent) > 12) {
            ted4_scene_free(s);
            continue;
        }
        assert_int_equal(ted4_encode(s, 0, NULL, &data, &size, NULL), TED4_OK);
        ted4_scene_free(s);
        snprintf(name, sizeof name, "v%d.ted4", view);
        write_contents(name, data, size);
        assert_int_equal(ted4_decode(data, size, NULL, &s, &(ted4_error) { TED4_OK, 0 }), TED4_OK);
        ted4_scene_info(s, &file[view].info);
        assert_int_equal(ted4_recon_new(&file[view].recon, s, NULL), TED4_OK);
        ted4_scene_free(s);
        free(data);
        return;
    }
    fail();
}

static int setup(void **state)
{
    (void)state;
    build = getenv("TED4_BUILD");
    if (build == NULL)
        return 0;
    temporary_folder(folder, "ted4-tools");
    for (int view = 0; view < 3; view++)
        make_file(view);
    return 0;
}

static int teardown(void **state)
{
    (void)state;
    if (build == NULL)
        return 0;
    for (int view = 0; view < 3; view++)
        ted4_recon_free(file[view].recon);
    return run("rm -rf %s", folder);
}

static void need_programs(void)
{
    if (build == NULL) {
        print_message("skipped: TED4_BUILD is not set\n");
        skip();
    }
}

/* ---- ted4dec ---- */

static void test_verdicts(void **state)
{
    size_t size;

    (void)state;
    need_programs();
    for (int view = 0; view < 3; view++)
        assert_int_equal(run("ted4dec --test v%d.ted4", view), 0);
    assert_string_equal(out, "");
    assert_int_equal(run("ted4dec --test --json -q v1.ted4"), 0);
    json_t *const cost = json_loads(out, 0, NULL);
    assert_true(json_real_value(json_object_get(cost, "decode_ms")) > 0);
    assert_true(json_real_value(json_object_get(cost, "peak_mib")) > 1);
    json_decref(cost);
    uint8_t *const data = contents("v1.ted4", &size);

    data[size / 2] ^= 16;
    write_contents("bad.ted4", data, size);
    free(data);
    assert_int_equal(run("ted4dec --test --json bad.ted4"), 1);
    json_t *const report = json_loads(out, 0, NULL);
    assert_non_null(report);
    assert_string_equal(json_string_value(json_object_get(report, "verdict")), "invalid");
    assert_string_equal(json_string_value(json_object_get(report, "error")), "con.chunk-hash");
    assert_true(json_integer_value(json_object_get(report, "offset")) > 0);
    json_decref(report);
    assert_int_equal(run("ted4dec bad.ted4 -o x.ply --time 0"), 1);
    assert_false(exists("x.ply"));
    assert_int_equal(run("ted4dec missing.ted4"), 3);
    assert_string_equal(out, "");
    for (int i = 0; i < 3; i++) {
        static const char *const reader[] = { "ted4dec", "ted4info", "ted4eval missing.ted4" };

        assert_int_equal(run("%s missing.ted4 --json", reader[i]), 3);
        json_t *const said = json_loads(out, 0, NULL);

        assert_string_equal(json_string_value(json_object_get(said, "verdict")), "io");
        assert_string_equal(json_string_value(json_object_get(said, "error")), "io.read");
        assert_string_equal(json_string_value(json_object_get(said, "text")),
                            "No such file or directory");
        json_decref(said);
    }
    assert_int_equal(run("ted4dec --ted4-run missing.ted4 --tiers T0"), 0);
    assert_non_null(strstr(out, "\"io.read\""));
    assert_int_equal(run("cat v1.ted4 | ted4dec - --hash"), 0);
    assert_int_equal(run("ted4dec -h"), 0);
    assert_non_null(strstr(out, "--sh-degree N"));
}

/* The contract's memory limit also holds for queries: those of this vector take more than
 * decoding. */
static void test_contract_bound(void **state)
{
    static const char query[] = "[{\"t\":[0,1],\"cam\":[0,0,0]}]";
    char here[1024];

    (void)state;
    need_programs();
    assert_non_null(getcwd(here, sizeof here));
    write_contents("query.json", (const uint8_t *)query, strlen(query));
    for (int tier = 1; tier <= 5; tier += 4) {
        assert_int_equal(
            run("ted4dec --ted4-run %s/conformance/vectors/valid/header/HDR-head_width-512.ted4 "
                "--tiers T%d --queries query.json "
                "--knob max_alloc_total=180000",
                here, tier),
            0);
        assert_non_null(strstr(out, tier == 1 ? "\"result\":\"valid\"" : "\"limit.memory\""));
    }
}

/* Runs ted4dec, which must end with status 3 and one line on stderr that holds the text. */
static void expect_refusal(const char *arguments, const char *text)
{
    const int status = run("ted4dec %s", arguments);
    size_t size;
    char *const err = (char *)contents("err", &size);

    err[size] = '\0';
    if (status != 3 || strstr(err, text) == NULL || strchr(err, '\n') != err + size - 1)
        fail_msg("%s: status %d: %s", arguments, status, err);
    free(err);
}

static void test_usage(void **state)
{
    static const char *const wrong[][2] = {
        { "", "expected one file, found 0" },
        { "v1.ted4 v0.ted4", "expected one file, found 2" },
        { "v1.ted4 out.ply", "expected one file; -o out.ply writes Gaussians" },
        { "v1.ted4 -o a.doc",
          "bad value a.doc; expected a name that ends in .ply, .splat, .glb or" },
        { "v1.ted4 -o a%s.ply", "a%s.ply; expected at most one %d" },
        { "v1.ted4 -o a.ply", "several frames need a %d in the name" },
        { "v1.ted4 --hash --frames 0:999", "--frames" },
        { "v1.ted4 --hash --frames 1 --time 0", "only one of them" },
        { "v1.ted4 --time 1.5", "--time: bad value 1.5; expected 0 to 1" },
        { "v1.ted4 --render a.png", "both or none" },
        { "v1.ted4 --sh-degree 4",
          "--sh-degree: bad value 4; expected a whole number from 0 to 3" },
        { "v1.ted4 -j x", "--threads: bad value x; expected a whole number from 0 to 256" },
        { "v1.ted4 -j 257", "--threads" },
        { "v1.ted4 --frames 2-4", "--frames: bad value 2-4; expected one frame, or A:B:STEP" },
        { "v1.ted4 --max-memory 1G", "--max-memory: bad value 1G; expected a whole number from 1" },
        { "v1.ted4 --test --trace --json", "only one of them" },
        { "v1.ted4 --test -o a.ply --time 0", "--test" },
        { "v1.ted4 --camera-centre 1,2", "--camera-centre: bad value 1,2; expected three" },
        { "v1.ted4 -o missing/a.ply --time 0", "missing/a.ply" },
        { "v1.ted4 --render a.png --camera v1.ted4", "v1.ted4: line 1: " },
        { "v1.ted4 --render a.png --camera nope.json", "nope.json: No such file or directory" },
        /* What would have no effect. */
        { "v1.ted4 --render a.png --camera x.json --frames 0", "--frames: only with -o or --hash" },
        { "v1.ted4 --render a.png --camera x.json --time 0", "--time: only with -o or --hash" },
        { "v1.ted4 --render a.jpg --camera x.json", "--render: bad value a.jpg; expected a name" },
        { "v1.ted4 --time 0", "--time: only with -o or --hash" },
        { "v1.ted4 --test --frames 0", "--frames: only with -o or --hash" },
        { "v1.ted4 --keep-all", "--keep-all: only with -o" },
        { "v1.ted4 --hash --sh-degree 1", "--sh-degree: only with -o" },
        { "v1.ted4 --hash --camera-centre 1,2,3", "--hash needs --frames or --time" },
        { "v1.ted4 --time 0 -o a.raw --sh-degree 0", "more than .raw can hold" },
        { "v1.ted4 --time 0 -o a.splat --sh-degree 1", "more than .splat can hold" },
        { "v1.ted4 --time 0 -o a.ply --camera-centre 1,2,3", "--camera-centre: has no effect" },
        { "v1.ted4 -q -v", "-q and -v" },
    };

    (void)state;
    need_programs();
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        expect_refusal(wrong[i][0], wrong[i][1]);
    assert_int_equal(run("ted4dec v1.ted4 --nothing"), 3);
    assert_int_equal(run("ted4dec v1.ted4 -o"), 3);
}

/* If every Gaussian is kept, a raw file contains the bytes that the hash of the query covers. */
static void test_hash(void **state)
{
    (void)state;
    need_programs();
    for (int view = 0; view < 3; view++) {
        char want[128], hash[33];
        size_t size;

        assert_int_equal(
            run("ted4dec v%d.ted4 -o all%d.raw --keep-all --time 1/3 --camera-centre 1,-2,0.5",
                view, view),
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
    assert_int_equal(run("ted4dec v1.ted4 -o f_%%03d.splat --frames 1:3"), 3); /* file 2 exists */
    assert_false(exists("f_001.splat"));
    assert_int_equal(run("ted4dec v1.ted4 -o f_%%03d.splat --frames 1:3 -f"), 0);
    assert_true(exists("f_001.splat"));
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

/* Compares fitted spherical harmonics, in some direction, with colours decoded for a camera far
 * away in that direction. */
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
    assert_true(sum < 0.1 * spread); /* and the colour depends on the direction */
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
        /* Rounded to float, so that text files represent it exactly. */
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
    save(list, "cameras.json");
    assert_int_equal(run("ted4dec v1.ted4 --render view_%%d.png --camera cameras.json"), 0);
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
    assert_true(colours > 1000); /* the picture is not empty */
}

/* ---- ted4eval ---- */

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

static double result(const char *key)
{
    json_t *const o = json_loads(out, 0, NULL);

    assert_non_null(o);
    const json_t *const v = json_object_get(o, key);
    const double value = json_is_number(v) ? json_number_value(v) : -1.0;

    json_decref(o);
    return value;
}

/* Pictures that differ from what the file shows by one step in every value. */
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
    /* The vector belongs to no scene. */
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
    path_of(path, "sheet.png");
    assert_int_equal(ted4_image_probe(path, &sheet, &m), 0);
    assert_int_equal(sheet.width, 3 * WIDTH);
    assert_int_equal(sheet.height, 3 * HEIGHT);
    assert_true(exists("pictures/truth/00002.png"));
    assert_true(exists("pictures/ours/00002.png"));
    assert_true(exists("pictures/error/00002.png"));
    /* The contact sheet exists by now. */
    assert_int_equal(run("ted4eval v1.ted4 scene --anyway --split train --sheet sheet.png"), 3);
    assert_int_equal(run("ted4eval v1.ted4 scene --anyway --split train --sheet sheet.png -f"), 0);
    assert_non_null(strstr(out, "psnr"));
    assert_int_equal(run("ted4eval bad.ted4 scene"), 1);
    assert_int_equal(run("ted4eval v1.ted4 missing"), 3);
    assert_int_equal(run("ted4eval v1.ted4 scene --split both"), 3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_verdicts), cmocka_unit_test(test_contract_bound),
        cmocka_unit_test(test_usage),    cmocka_unit_test(test_hash),
        cmocka_unit_test(test_frames),   cmocka_unit_test(test_fitted_colours),
        cmocka_unit_test(test_render),   cmocka_unit_test(test_eval),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
