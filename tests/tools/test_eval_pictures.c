/* test_eval_pictures.c - ted4eval as a program: its pictures and its sheet show what its numbers
 * are about, and its numbers are those of eval/metrics.h. Poses and colours that are wrong, and
 * pictures with alpha.
 *
 * SPDX-License-Identifier: BSD-2-Clause */
#include <jansson.h>
#include <math.h>
#include <png.h>
#include <sys/stat.h>

#include "data/image_file.h"
#include "eval/metrics.h"
#include "tool_files.h"

enum { WIDTH = 64, HEIGHT = 48, PIXELS = WIDTH * HEIGHT, SIZE = 3 * PIXELS, VIEWS = 5, SHOWN = 4 };

static void save(json_t *o, const char *name)
{
    char path[PATH_SIZE];

    path_of(path, name);
    assert_int_equal(json_dump_file(o, path, JSON_INDENT(1)), 0);
    json_decref(o);
}

/* Saves a scene of pictures p0.png to p4.png in a folder, and its cameras as a list for ted4dec.
 * They look along z from places beside each other; those of the list are so many pixels further
 * right, as seen at the scene's centre. */
static void write_cameras(const char *name, double shift)
{
    const ted4_info *const info = &file[1].info;
    const double unit = ldexp(1, info->exponent), away = 2.5 * unit;
    const double y = (double)info->origin[1], z = (double)info->origin[2] - away;
    json_t *const frames = json_array(), *const list = json_array();
    char path[PATH_SIZE], file_name[64];

    for (int i = 0; i < VIEWS; i++) {
        const double x = (double)info->origin[0] + 0.05 * i * unit, time = i / (VIEWS - 1.0);
        char picture[16];

        snprintf(picture, sizeof picture, "p%d.png", i);
        json_array_append_new(
            frames, json_pack("{s:s, s:f, s:[[f,f,f,f],[f,f,f,f],[f,f,f,f],[f,f,f,f]]}",
                              "file_path", picture, "time", time, "transform_matrix", 1.0, 0.0, 0.0,
                              x, 0.0, -1.0, 0.0, y, 0.0, 0.0, -1.0, z, 0.0, 0.0, 0.0, 1.0));
        json_array_append_new(
            list, json_pack("{s:i, s:i, s:i, s:i, s:i, s:i, s:[i,i,i,i,i,i,i,i,i], s:[f,f,f], s:f}",
                            "width", WIDTH, "height", HEIGHT, "fx", WIDTH, "fy", WIDTH, "cx",
                            WIDTH / 2, "cy", HEIGHT / 2, "R", 1, 0, 0, 0, 1, 0, 0, 0, 1, "t",
                            -x - shift * away / WIDTH, -y, -z, "time", time));
    }
    path_of(path, name);
    assert_int_equal(mkdir(path, 0777), 0);
    snprintf(file_name, sizeof file_name, "%s.json", name);
    save(list, file_name);
    json_t *const scene = json_pack("{s:i, s:i, s:i, s:i, s:i, s:i, s:o}", "fl_x", WIDTH, "fl_y",
                                    WIDTH, "cx", WIDTH / 2, "cy", HEIGHT / 2, "w", WIDTH, "h",
                                    HEIGHT, "frames", frames);

    for (int test = 0; test < 2; test++) {
        snprintf(file_name, sizeof file_name, "%s/transforms_%s.json", name,
                 test ? "test" : "train");
        save(json_incref(scene), file_name);
    }
    json_decref(scene);
}

static void write_picture(const char *folder_name, int i, uint32_t format, const uint8_t *px)
{
    png_image p = {
        .version = PNG_IMAGE_VERSION, .width = WIDTH, .height = HEIGHT, .format = format
    };
    char name[64], path[PATH_SIZE];

    snprintf(name, sizeof name, "%s/p%d.png", folder_name, i);
    path_of(path, name);
    assert_true(png_image_write_to_file(&p, path, 0, px, 0, NULL));
}

/* Reads a picture of a known size, to be freed by the caller. */
static uint8_t *picture(int width, int height, const char *format, ...)
{
    char name[64], path[PATH_SIZE];
    ted4_message m;
    ted4_image image;
    va_list ap;

    va_start(ap, format);
    vsnprintf(name, sizeof name, format, ap);
    va_end(ap);
    path_of(path, name);
    if (ted4_image_read(path, &image, &m) != 0)
        fail_msg("%s", m.text);
    assert_int_equal(image.width, width);
    assert_int_equal(image.height, height);
    assert_int_equal(image.channels, 3);
    return image.bytes;
}

static double number_of(const json_t *o, const char *key)
{
    const json_t *const v = json_object_get(o, key);

    if (!json_is_number(v))
        fail_msg("no number %s in %s", key, out);
    return json_number_value(v);
}

/* The result of the last program. */
static json_t *result(void)
{
    json_t *const o = json_loads(out, 0, NULL);

    assert_non_null(o);
    return o;
}

/* A line of the last program's text has the number of a result. */
static void check_line(const char *name, double want, int digits)
{
    const char *at = strncmp(out, name, strlen(name)) == 0 ? out : strchr(out, '\n');

    while (at != NULL && strncmp(at + (*at == '\n'), name, strlen(name)) != 0)
        at = strchr(at + 1, '\n');
    if (at == NULL)
        fail_msg("no line %s in:\n%s", name, out);

    const double got = strtod(at + (*at == '\n') + strlen(name), NULL);

    if (!(fabs(got - want) <= 0.6 * pow(10, -digits) + 1e-5 * fabs(want)))
        fail_msg("%s: %g, not %g", name, got, want);
}

/* The part of a sheet in a row and a column is that picture. */
static int shows(const uint8_t *sheet, int row, int column, const uint8_t *rgb)
{
    for (int y = 0; y < HEIGHT; y++)
        if (memcmp(sheet + 3 * ((row * HEIGHT + y) * 3 * WIDTH + column * WIDTH),
                   rgb + 3 * y * WIDTH, 3 * WIDTH) != 0)
            return 0;
    return 1;
}

/* What a check of pictures has seen: rows of the sheet, and errors that are cut off at 255 and that
 * are not. */
typedef struct {
    int rows, full, part;
    ted4_metrics mean;
} looked;

/* Picture i among those written, and in the sheet. */
static void check_picture(int i, const uint8_t *truth, const uint8_t *sheet, looked *l)
{
    uint8_t *const given = picture(WIDTH, HEIGHT, "shown/truth/%05d.png", i),
                   *const ours = picture(WIDTH, HEIGHT, "shown/ours/%05d.png", i),
                   *const off = picture(WIDTH, HEIGHT, "shown/error/%05d.png", i);
    ted4_metrics m;

    assert_memory_equal(given, truth, SIZE);
    for (int k = 0; k < SIZE; k++) {
        const int five = 5 * abs(truth[k] - ours[k]);

        assert_int_equal(off[k], five < 255 ? five : 255);
        l->full += five > 255;
        l->part += five > 0 && five < 255;
    }
    for (int row = 0; row < SHOWN; row++)
        if (shows(sheet, row, 0, given)) {
            l->rows++;
            assert_true(shows(sheet, row, 1, ours));
            assert_true(shows(sheet, row, 2, off));
        }
    assert_int_equal(ted4_metrics_compare(given, ours, WIDTH, HEIGHT, NULL, &m), 0);
    l->mean.psnr += m.psnr / VIEWS;
    l->mean.ssim += m.ssim / VIEWS;
    l->mean.ssim2 += m.ssim2 / VIEWS;
    l->mean.ms_ssim += m.ms_ssim / VIEWS;
    l->mean.l1 += m.l1 / VIEWS;
    free(given);
    free(ours);
    free(off);
}

static void near(double got, double want)
{
    if (!(fabs(got - want) <= 1e-5 * fabs(want)))
        fail_msg("%.9g, not %.9g", got, want);
}

/* Colours that differ from what the file shows by little and by much. */
static void test_pictures(void **state)
{
    static uint8_t truth[VIEWS][SIZE];
    looked l = { 0 };

    (void)state;
    need_programs();
    write_cameras("scene", 0);
    for (int i = 0; i < VIEWS; i++) {
        for (int k = 0; k < SIZE; k++)
            truth[i][k] = (uint8_t)(k / 3 % WIDTH * 3 + k / 3 / WIDTH * (k % 3 + 1) + 40 * i);
        write_picture("scene", i, PNG_FORMAT_RGB, truth[i]);
    }
    assert_int_equal(run("ted4eval v1.ted4 scene --anyway --json --images shown --sheet sheet.png"),
                     0);
    json_t *const o = result();
    uint8_t *const sheet = picture(3 * WIDTH, SHOWN * HEIGHT, "sheet.png");

    for (int i = 0; i < VIEWS; i++)
        check_picture(i, truth[i], sheet, &l);
    assert_true(l.full > 1000 && l.part > 100);
    assert_int_equal(l.rows, SHOWN);
    near(number_of(o, "psnr"), l.mean.psnr);
    near(number_of(o, "ssim"), l.mean.ssim);
    near(number_of(o, "ssim2"), l.mean.ssim2);
    near(number_of(o, "ms_ssim"), l.mean.ms_ssim);
    near(number_of(o, "l1"), l.mean.l1);
    assert_int_equal(run("ted4eval v1.ted4 scene --anyway"), 0);
    check_line("psnr ", l.mean.psnr, 4);
    check_line("ssim ", l.mean.ssim, 5);
    check_line("ssim2 ", l.mean.ssim2, 5);
    check_line("ms_ssim ", l.mean.ms_ssim, 5);
    json_decref(o);
    free(sheet);
}

/* Changes the colours of pictures that the file shows: no fit explains all of it. */
static void change(const char *name, int gain, int add)
{
    for (int i = 0; i < VIEWS; i++) {
        uint8_t *const px = picture(WIDTH, HEIGHT, "%s/p%d.png", name, i);

        for (int k = 0; k < SIZE; k++)
            px[k] = (uint8_t)(add + px[k] * gain / 10 + (k % 5 == 0 ? 3 : 0));
        write_picture(name, i, PNG_FORMAT_RGB, px);
        free(px);
    }
}

/* Cameras that stand a pixel and a half aside: aligned, the file is far better, and the half that
 * is judged is about as good as the whole. */
static void test_aligned(void **state)
{
    (void)state;
    need_programs();
    write_cameras("aside", 1.5);
    assert_int_equal(run("ted4dec v1.ted4 --render aside/p%%d.png --camera aside.json"), 0);
    change("aside", 9, 5);
    assert_int_equal(run("ted4eval v1.ted4 aside --anyway --json --align"), 0);

    json_t *const o = result();

    if (!(number_of(o, "psnr_aligned") > number_of(o, "psnr_half") + 2))
        fail_msg("%s", out);
    assert_true(fabs(number_of(o, "psnr_half") - number_of(o, "psnr")) < 1);
    assert_int_equal(run("ted4eval v1.ted4 aside --anyway --align"), 0);
    check_line("half ", number_of(o, "psnr_half"), 4);
    check_line("aligned ", number_of(o, "psnr_aligned"), 4);
    json_decref(o);
}

/* Pictures with less contrast: with fitted colours, the file is far better. */
static void test_fitted(void **state)
{
    (void)state;
    need_programs();
    write_cameras("pale", 0);
    assert_int_equal(run("ted4dec v1.ted4 --render pale/p%%d.png --camera pale.json"), 0);
    change("pale", 8, 20);
    assert_int_equal(run("ted4eval v1.ted4 pale --anyway --json --colours"), 0);

    json_t *const o = result();

    if (!(number_of(o, "psnr_fitted") > number_of(o, "psnr_raw") + 2))
        fail_msg("%s", out);
    assert_true(fabs(number_of(o, "psnr_raw") - number_of(o, "psnr")) < 1e-3);
    assert_int_equal(run("ted4eval v1.ted4 pale --anyway --colours"), 0);
    check_line("raw ", number_of(o, "psnr_raw"), 4);
    check_line("fitted ", number_of(o, "psnr_fitted"), 4);
    json_decref(o);
}

/* v1.ted4 with a grey or a black background. */
static void write_background(const char *name, uint8_t grey)
{
    size_t size;
    uint8_t *data = contents("v1.ted4", &size);
    ted4_scene *s;

    assert_int_equal(ted4_decode(data, size, NULL, &s, NULL), TED4_OK);
    free(data);
    memset(s->head.background, grey, sizeof s->head.background);
    assert_int_equal(ted4_encode(s, 0, NULL, &data, &size, NULL), TED4_OK);
    ted4_scene_free(s);
    write_contents(name, data, size);
    free(data);
}

/* Pictures with alpha lie on white or black, whichever is nearer to the file's background; their
 * colours are multiplied by alpha unless they are already. */
static void test_alpha(void **state)
{
    static uint8_t px[4 * PIXELS];

    (void)state;
    need_programs();
    write_cameras("clear", 0);
    for (int k = 0; k < PIXELS; k++) {
        px[4 * k + 3] = (uint8_t)(k % 256);
        for (int c = 0; c < 3; c++)
            px[4 * k + c] = (uint8_t)(px[4 * k + 3] * (c + 1) / 4);
    }
    for (int i = 0; i < VIEWS; i++)
        write_picture("clear", i, PNG_FORMAT_RGBA, px);
    write_background("light.ted4", 128);
    write_background("dark.ted4", 127);
    for (int way = 0; way < 6; way++) {
        static const char *const option[] = { "", "--alpha straight", "--alpha premultiplied" };
        const int light = way % 2;
        uint8_t *got;

        assert_int_equal(run("ted4eval %s.ted4 clear --anyway --json --images a%d %s",
                             light ? "light" : "dark", way, option[way / 2]),
                         0);
        got = picture(WIDTH, HEIGHT, "a%d/truth/00001.png", way);
        for (int k = 0; k < SIZE; k++) {
            const double alpha = px[k / 3 * 4 + 3] / 255.0;
            const double colour = px[k / 3 * 4 + k % 3] * (way < 4 ? alpha : 1);
            const double want = colour + (light ? 255 * (1 - alpha) : 0);

            if (!(fabs(got[k] - want) <= 1))
                fail_msg("way %d, value %d: %d, not %g", way, k, got[k], want);
        }
        free(got);
    }
    assert_int_equal(run("ted4eval dark.ted4 clear --alpha none"), 3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_pictures),
        cmocka_unit_test(test_aligned),
        cmocka_unit_test(test_fitted),
        cmocka_unit_test(test_alpha),
    };

    return cmocka_run_group_tests(tests, setup, teardown);
}
