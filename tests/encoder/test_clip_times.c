/* test_clip_times.c - the times of pictures in clips: pictures of equal numbers belong to the same
 * time, whatever pictures are missing; numbers that count no frames are not taken as times; and
 * what is said about missing pictures is true.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <sys/stat.h>

#include "test.h"
#include "refuse.h"
#include "tiny_scene.h"

/* Writes NAME.png in a folder for every word of names. */
static void clip(const tiny_folder *f, const char *folder, const char *names)
{
    char word[64], path[128];
    int used = 0;

    for (const char *at = names; sscanf(at, "%63s%n", word, &used) == 1; at += used) {
        snprintf(path, sizeof path, "%s/%s.png", folder, word);
        tiny_picture(f, path, TINY_W, TINY_H, 0);
    }
}

/* Writes cams.json for the cameras a, b, ... of which each has more fields, or NULL. */
static void cameras(const tiny_folder *f, const char *top, const char *const *more, int n)
{
    tiny_string s = { "", 0 };

    tiny_add(&s, "{%s \"fps\": 10, \"cameras\": [", top);
    for (int i = 0; i < n; i++)
        tiny_add(&s,
                 "%s{\"name\": \"%c\", %s \"w\": 16, \"h\": 12, "
                 "\"K\": [[9,0,7.5],[0,9,5.5],[0,0,1]], \"w2c\": " TINY_POSE "}",
                 i > 0 ? ", " : "", 'a' + i, more != NULL && more[i] != NULL ? more[i] : "");
    tiny_add(&s, "]}");
    tiny_text(f, "cams.json", s.text);
}

/* Appends "a2:0", camera, name and frame, for each picture of the camera in the order of frames. */
static void describe(const ted4_dataset *d, char camera, tiny_string *s)
{
    for (uint32_t frame = 0; frame < d->n_frames; frame++)
        for (size_t i = 0; i < d->n_pictures; i++) {
            const char *path = d->pictures[i].path, *name = strrchr(path, '/') + 1;
            const int length = (int)(strrchr(name, '.') - name);
            const char folder[] = { '/', camera, '/', 0 };

            if (d->pictures[i].frame == frame && strstr(path, folder) != NULL)
                tiny_add(s, "%s%c%.*s:%u", s->n > 0 ? " " : "", camera, length, name,
                         (unsigned)frame);
        }
}

static void assert_frames(const ted4_dataset *d, const char *expected)
{
    static tiny_string s;

    s.n = 0;
    s.text[0] = 0;
    for (char c = 'a'; c <= 'd'; c++)
        describe(d, c, &s);
    assert_string_equal(s.text, expected);
}

/* Asserts which picture has which frame, and the only warning (NULL: none). */
static void check(const tiny_folder *f, const ted4_dataset_options *o, const char *expected,
                  uint32_t n_frames, const char *warning)
{
    ted4_dataset d;

    assert_string_equal(tiny_load(&d, f, o), "");
    assert_frames(&d, expected);
    assert_int_equal(d.n_frames, n_frames);
    if (d.n_warnings > 0 && warning != NULL)
        assert_string_equal(d.warnings[0], warning);
    assert_int_equal(d.n_warnings, warning != NULL);
    ted4_dataset_free(&d);
}

typedef struct {
    const char *clips[3], *expected;
    uint32_t n_frames;
    const char *warning;
} clip_case;

#define LACK "clips lack pictures by the numbers in their names: "
#define ENDS(a, b)                                                                       \
    "clips have from " a " to " b " frames: at the last times some cameras are missing " \
    "(--max-frames " a " leaves these times out)"
#define ORDER(a, b)                                                                          \
    "by the numbers in their names, clips would lack " a " of " b " pictures: the pictures " \
    "of each clip are counted in their order instead"

static const clip_case cases[] = {
    /* the first pictures are missing */
    { { "0 1 2 3", "2 3" },
      "a0:0 a1:1 a2:2 a3:3 b2:2 b3:3",
      4,
      LACK "2 of 8; the first: b has none of number 0" },
    /* as ffmpeg counts, and in the middle; 10 comes after 9 */
    { { "f8 f9 f10 f11", "f8 f11" },
      "af8:0 af9:1 af10:2 af11:3 bf8:0 bf11:3",
      4,
      LACK "2 of 8; the first: b has none of number 9" },
    /* of all clips */
    { { "1 2 4", "1 2 4" },
      "a1:0 a2:1 a4:3 b1:0 b2:1 b4:3",
      4,
      LACK "2 of 8; the first: a has none of number 3" },
    /* every tenth frame */
    { { "0 10 20 30", "0 20 30" },
      "a0:0 a10:1 a20:2 a30:3 b0:0 b20:2 b30:3",
      4,
      LACK "1 of 8; the first: b has none of number 10" },
    { { "5 15 25", "5 15 25" }, "a5:0 a15:1 a25:2 b5:0 b15:1 b25:2", 3, NULL },
    /* only the last pictures are missing */
    { { "0 1 2", "0" }, "a0:0 a1:1 a2:2 b0:0", 3, ENDS("1", "3") },
    { { "0 1 2 3 4 5 6 7 8 9", "0", "0" },
      "a0:0 a1:1 a2:2 a3:3 a4:4 a5:5 a6:6 a7:7 a8:8 a9:9 b0:0 c0:0",
      10,
      ENDS("1", "10") },
    /* names without numbers, with the same number, with different things, with long numbers */
    { { "x y z", "y z" }, "ax:0 ay:1 az:2 by:0 bz:1", 3, ENDS("2", "3") },
    { { "0 1 2", "x y z" }, "a0:0 a1:1 a2:2 bx:0 by:1 bz:2", 3, NULL },
    { { "f1_v2 f3_v2", "f1_v2 f4_v2" }, "af1_v2:0 af3_v2:1 bf1_v2:0 bf4_v2:1", 2, NULL },
    { { "f1_08 f2_07", "f1_08 f2_07" }, "af1_08:0 af2_07:1 bf1_08:0 bf2_07:1", 2, NULL },
    { { "1000000000000000000 1000000000000000002", "1000000000000000001 1000000000000000002" },
      "a1000000000000000000:0 a1000000000000000002:1 b1000000000000000001:0 "
      "b1000000000000000002:1",
      2,
      NULL },
    /* each camera counts for itself; times in milliseconds; one picture a camera */
    { { "100 101 102", "731 732 733" },
      "a100:0 a101:1 a102:2 b731:0 b732:1 b733:2",
      3,
      ORDER("631", "637") },
    { { "1000 1033 1066", "1004 1038 1071" },
      "a1000:0 a1033:1 a1066:2 b1004:0 b1038:1 b1071:2",
      3,
      ORDER("133", "139") },
    { { "0", "1", "2" }, "a0:0 b1:0 c2:0", 1, ORDER("3", "6") },
    { { "4 5 7" }, "a4:0 a5:1 a7:3", 4, LACK "1 of 4; the first: a has none of number 6" },
};

static void test_numbers(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        tiny_folder f = tiny_new();
        int n = 0;

        for (; n < 3 && cases[i].clips[n] != NULL; n++) {
            char folder[16];
            snprintf(folder, sizeof folder, "images/%c", 'a' + n);
            clip(&f, folder, cases[i].clips[n]);
        }
        cameras(&f, "", NULL, n);
        check(&f, &tiny_options, cases[i].expected, cases[i].n_frames, cases[i].warning);
        tiny_free(&f);
    }
}

#define STRAY(what)                                                                           \
    what ": the numbers in names are not used, and the pictures of each clip are counted in " \
         "their order"

/* A single picture whose number does not fit switches counting off, and is named. */
static void test_strays(void **state)
{
    static const struct {
        const char *clips[2], *stray, *expected, *what;
    } strays[] = {
        { { "000 001 003", "001 002 003" },
          "images/a/bg.png",
          "abg:0 a000:1 a001:2 a003:3 b001:0 b002:1 b003:2",
          "images/a/bg.png has no number" },
        { { "0 1 3", "1 2 3" },
          "images/b/cover.png",
          "a0:0 a1:1 a3:2 b1:0 b2:1 b3:2 bcover:3",
          "images/b/cover.png has no number" },
        { { "0 1 3", "1 2 3" },
          "images/b/2.PNG",
          "a0:0 a1:1 a3:2 b1:0 b2:1 b2:2 b3:3",
          "images/b/2.png has no larger number than 2.PNG before it" },
        { { "x y z", "1 2 3" },
          "images/b/all.png",
          "ax:0 ay:1 az:2 b1:0 b2:1 b3:2 ball:3",
          "images/b/all.png has no number" },
        { { "0 1 2", "1 2" },
          "images/b/1000000000000000.png",
          "a0:0 a1:1 a2:2 b1:0 b2:1 b1000000000000000:2",
          "images/b/1000000000000000.png has a number of more than 15 digits" },
    };

    (void)state;
    for (size_t i = 0; i < sizeof strays / sizeof strays[0]; i++) {
        tiny_folder f = tiny_new();
        char text[800];
        ted4_dataset d;

        clip(&f, "images/a", strays[i].clips[0]), clip(&f, "images/b", strays[i].clips[1]);
        tiny_picture(&f, strays[i].stray, TINY_W, TINY_H, 0);
        cameras(&f, "", NULL, 2);
        assert_string_equal(tiny_load(&d, &f, &tiny_options), "");
        assert_true(d.n_warnings > 0);
        snprintf(text, sizeof text, STRAY("%s/%s"), f.path, strays[i].what);
        assert_string_equal(d.warnings[0], text);
        assert_frames(&d, strays[i].expected);
        ted4_dataset_free(&d);
        tiny_free(&f);
    }
}

/* A clip's start is the time of the scene's smallest number. Clips may end when they like. */
static void test_starts(void **state)
{
    static const char *const starts[] = { "\"start\": 0,", "\"start\": 0.2,", "\"frame\": -1," };
    tiny_folder f = tiny_new();

    (void)state;
    clip(&f, "images/a", "1 2 3 4"), clip(&f, "images/b", "3 4"), clip(&f, "images/c", "1 2");
    cameras(&f, "", starts, 3);
    check(&f, &tiny_options, "a1:1 a2:2 a3:3 a4:4 b3:5 b4:6 c1:0 c2:1", 7,
          LACK "2 of 10; the first: b has none of number 1");
    tiny_free(&f);
}

/* The first times are those of the smallest numbers, not each clip's first pictures. */
static void test_most(void **state)
{
    tiny_folder f = tiny_new();
    ted4_dataset_options o = tiny_options;

    (void)state;
    clip(&f, "images/a", "0 1 2 3"), clip(&f, "images/b", "0 2 3"), clip(&f, "images/c", "2 3");
    cameras(&f, "", NULL, 3);
    o.max_frames = 2;
    check(&f, &o, "a0:0 a1:1 b0:0", 2, LACK "3 of 6; the first: b has none of number 1");
    tiny_free(&f);
}

/* The frames that cams.json states are counted by numbers, so that a picture may be missing; but a
 * clip that ends early, or that begins later, is refused. */
static void test_stated(void **state)
{
    tiny_folder f = tiny_new();

    (void)state;
    clip(&f, "images/a", "0 1 2 3"), clip(&f, "images/b", "0 2 3"), clip(&f, "images/c", "2 3");
    cameras(&f, "\"frames\": 4,", NULL, 3);
    check(&f, &tiny_options, "a0:0 a1:1 a2:2 a3:3 b0:0 b2:2 b3:3 c2:2 c3:3", 4,
          LACK "3 of 12; the first: b has none of number 1");
    cameras(&f, "\"frames\": 3,", NULL, 3);
    check(&f, &tiny_options, "a0:0 a1:1 a2:2 b0:0 b2:2 c2:2", 3,
          LACK "3 of 9; the first: b has none of number 1");
    must(remove(tiny_path(&f, "images/b/3.png")) == 0, "3.png");
    check(&f, &tiny_options, "a0:0 a1:1 a2:2 b0:0 b2:2 c2:2", 3,
          LACK "3 of 9; the first: b has none of number 1");
    cameras(&f, "\"frames\": 4,", NULL, 3);
    refuse(&f, "cams.json: cameras[1]: 3 frames, expected 4 by the file's frames", "");
    cameras(&f, "\"frames\": 2,", NULL, 3);
    refuse(&f, "cams.json: cameras[2]: 0 frames, expected 2 by the file's frames", "");
    /* Names without numbers are counted. */
    clip(&f, "images/d", "x y z");
    cameras(&f, "\"frames\": 4,", NULL, 4);
    refuse(&f, "cams.json: cameras[1]: 2 frames, expected 4 by the file's frames", "");
    tiny_free(&f);
}

/* Frames of a video are counted; the numbers of other clips begin where they like. */
static void test_video(void **state)
{
    static const char *const videos[] = { NULL, "\"video\": \"b.mp4\"," };
    tiny_folder f = tiny_new(), cache = tiny_new();
    char *path = ted4_text_copy(getenv("PATH"));
    tiny_string s = { "", 0 };

    (void)state;
    must(path != NULL, "PATH");
    clip(&f, "images/a", "40 41 43"), clip(&cache, "b", "1");
    tiny_bytes(&f, "b.mp4",
               "\0\0\0\x18"
               "ftypmp42",
               12);
    tiny_add(&s, "#!/bin/sh\nfor i in 1 2 3; do cp '%s/b/1.png' 00000$i.png; done\n", cache.path);
    tiny_text(&cache, "bin/ffmpeg", s.text);
    must(chmod(tiny_path(&cache, "bin/ffmpeg"), 0755) == 0, "ffmpeg");
    s.n = 0;
    tiny_add(&s, "%s:%s", tiny_path(&cache, "bin"), path);
    setenv("PATH", s.text, 1);
    setenv("XDG_CACHE_HOME", cache.path, 1);
    cameras(&f, "", videos, 2);
    ted4_dataset d;
    assert_string_equal(tiny_load(&d, &f, &tiny_options), "");
    assert_int_equal(d.n_pictures, 6);
    assert_int_equal(d.n_frames, 4);
    for (size_t i = 0; i < d.n_pictures; i++) {
        const int number = atoi(strrchr(d.pictures[i].path, '/') + 1);
        assert_int_equal(d.pictures[i].frame, number >= 40 ? number - 40 : number - 1);
    }
    assert_int_equal(d.n_warnings, 2);
    assert_string_equal(d.warnings[0], LACK "1 of 7; the first: a has none of number 42");
    assert_string_equal(d.warnings[1], ENDS("3", "4"));
    ted4_dataset_free(&d);
    setenv("PATH", path, 1);
    unsetenv("XDG_CACHE_HOME");
    free(path);
    tiny_free(&cache);
    tiny_free(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_numbers), cmocka_unit_test(test_strays),
        cmocka_unit_test(test_starts),  cmocka_unit_test(test_most),
        cmocka_unit_test(test_stated),  cmocka_unit_test(test_video),
    };

    return cmocka_run_group_tests_name("times of clips", tests, NULL, NULL);
}
