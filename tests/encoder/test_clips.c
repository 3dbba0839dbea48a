/* test_clips.c - scenes with poses_bounds.npy and cams.json as found in practice: stills in place
 * of clips, fewer clips than rows, clips that start at different times or have different lengths,
 * and clips in any folder.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>
#include <unistd.h>

#include "test.h"
#include "data/video_kind.h"
#include "refuse.h"
#include "tiny_scene.h"

static ted4_dataset load(const tiny_folder *f, const ted4_dataset_options *o)
{
    ted4_dataset d;

    assert_string_equal(tiny_load(&d, f, o), "");
    return d;
}

/* Writes poses_bounds.npy for n cameras at (i, 0, 0), with pictures of w x h. */
static void write_table(const tiny_folder *f, int n, double w, double h)
{
    tiny_record r = { { 0 }, 0 };
    char head[100];

    snprintf(head, sizeof head, "{'descr': '<f8', 'fortran_order': False, 'shape': (%d, 17), }\n",
             n);
    memcpy(r.bytes, "\x93NUMPY\x01\0", r.n = 8);
    tiny_put(&r, strlen(head), 2);
    memcpy(r.bytes + r.n, head, strlen(head));
    r.n += strlen(head);
    for (int i = 0; i < n; i++) {
        const double row[17] = { 0, 1, 0, i, h, 1, 0, 0, 0, w, 0, 0, -1, 0, 20, 1, 9 };
        for (int k = 0; k < 17; k++)
            tiny_put_real(&r, row[k]);
    }
    tiny_bytes(f, "poses_bounds.npy", r.bytes, r.n);
}

/* Writes n pictures of that size into a folder of the scene. File i is named DSC(10 i).JPG but has
 * PNG content, and i identifies its picture. */
static void write_stills(const tiny_folder *f, const char *folder, int n, int w, int h)
{
    for (int i = 0; i < n; i++) {
        char name[64];
        snprintf(name, sizeof name, "%s/DSC%04d.JPG", folder, 10 * i);
        tiny_picture(f, name, w, h, i);
    }
}

static int row_of(const ted4_dataset *d, size_t i)
{
    return (int)(0.5 - d->pictures[i].camera.t[0]);
}

static void check_stills(ted4_dataset *d, const char *folder, int w, double focal)
{
    assert_string_equal(d->layout, "LLFF");
    assert_int_equal(d->n_pictures, 18);
    assert_int_equal(d->n_frames, 1);
    assert_int_equal(d->n_cameras, 18);
    assert_true(d->rate == 0);
    assert_int_equal(d->n_warnings, 0);
    for (size_t i = 0; i < d->n_pictures; i++) {
        const int row = row_of(d, i);
        char name[64];
        snprintf(name, sizeof name, "/%s/DSC%04d.JPG", folder, 10 * row);
        assert_non_null(strstr(d->pictures[i].path, name));
        assert_int_equal(d->pictures[i].is_test, row % 8 == 0);
        assert_int_equal(d->pictures[i].camera.width, w);
        assert_true(fabs(d->pictures[i].camera.fx - focal) < 1e-9);
    }
}

static void test_stills(void **state)
{
    tiny_folder f = tiny_new();
    ted4_dataset_options o = tiny_options;

    (void)state;
    write_table(&f, 18, 64, 48);
    refuse(&f, "poses_bounds.npy", "18 rows, but 0 pictures in images/");
    write_stills(&f, "images_4", 18, 16, 12);
    ted4_dataset d = load(&f, &o);
    check_stills(&d, "images_4", 16, 5);
    ted4_dataset_free(&d);
    write_stills(&f, "images", 18, 64, 48);
    d = load(&f, &o);
    check_stills(&d, "images", 64, 20);
    ted4_dataset_free(&d);
    o.downscale = 4; /* the reduced copies that exist already */
    d = load(&f, &o);
    check_stills(&d, "images_4", 16, 5);
    ted4_dataset_free(&d);
    o.downscale = 2;
    d = load(&f, &o);
    check_stills(&d, "images", 32, 10);
    ted4_dataset_free(&d);
    must(remove(tiny_path(&f, "images/DSC0030.JPG")) == 0, "a still");
    refuse(&f, "poses_bounds.npy", "18 rows, but 17 pictures in images/");
    write_stills(&f, "images", 18, 63, 48);
    refuse(&f, "images/DSC0010.JPG", "the file is 63x48, its camera says 64x48");
    tiny_free(&f);
}

/* A COLMAP scene without images/ is loaded from the reduced copies, of whichever format: here PNG
 * under names that end as JPEG. */
static void test_copies(void **state)
{
    (void)state;
    tiny_folder f = tiny_new();
    ted4_dataset_options o = tiny_options;

    tiny_text(&f, "sparse/0/cameras.txt", "1 PINHOLE 64 48 40 40 32 24\n");
    tiny_text(&f, "sparse/0/images.txt", "1 1 0 0 0 0 0 0 1 a.JPG\n\n2 1 0 0 0 0 0 0 1 b.JPG\n\n");
    tiny_picture(&f, "images_4/a.png", 16, 12, 0), tiny_picture(&f, "images_4/b.JPG", 16, 12, 0);
    for (int downscale = 1; downscale <= 8; downscale *= 2) {
        o.downscale = downscale;
        ted4_dataset d = load(&f, &o);
        assert_int_equal(d.n_warnings, 0);
        assert_int_equal(d.n_pictures, 2);
        assert_int_equal(d.pictures[0].camera.width, downscale == 8 ? 8 : 16);
        assert_true(fabs(d.pictures[0].camera.fx - (downscale == 8 ? 5 : 10)) < 1e-12);
        ted4_dataset_free(&d);
    }
    tiny_free(&f);
}

static void write_clip(const tiny_folder *f, const char *folder, int n)
{
    for (int i = 0; i < n; i++) {
        char name[64];
        snprintf(name, sizeof name, "%s/%d.png", folder, i);
        tiny_picture(f, name, TINY_W, TINY_H, i);
    }
}

/* Rows 0 to 4, but no clip of camera 2, as the numbers in the names of clips show. */
static void test_rows(void **state)
{
    tiny_folder f = tiny_new();

    (void)state;
    write_table(&f, 5, TINY_W, TINY_H);
    write_clip(&f, "cam00/images", 2), write_clip(&f, "cam01/images", 2),
        write_clip(&f, "cam03/images", 2);
    refuse(&f, "poses_bounds.npy", "5 rows, but 3 cameras");
    write_clip(&f, "cam04/images", 2);
    assert_int_equal(warned(&f, "1 of 5 entries has no picture: ", "row 2: no clip of number 2"),
                     8);
    ted4_dataset d = load(&f, &tiny_options);
    assert_true(d.rate == 0); /* no file of this layout has one */
    for (size_t i = 0; i < d.n_pictures; i++)
        assert_int_equal(row_of(&d, i), atoi(strstr(d.pictures[i].path, "/cam") + 4));
    ted4_dataset_free(&d);
    write_clip(&f, "cam04/images", 5);
    d = load(&f, &tiny_options);
    assert_int_equal(d.n_warnings, 2);
    assert_int_equal(d.n_frames, 5);
    ted4_dataset_free(&d);
    tiny_free(&f);
}

/* A camera of cams.json; the caller appends more fields. */
#define CAMERA "\"w\": 16, \"h\": 12, \"K\": [[9,0,7.5],[0,9,5.5],[0,0,1]], \"w2c\": " TINY_POSE "}"

/* Index of the picture of a camera at a frame; -1: none. */
static int at(const ted4_dataset *d, const char *camera, uint32_t frame)
{
    for (size_t i = 0; i < d->n_pictures; i++)
        if (d->pictures[i].frame == frame && strstr(d->pictures[i].path, camera) != NULL)
            return atoi(strrchr(d->pictures[i].path, '/') + 1);
    return -1;
}

static void test_starts(void **state)
{
    tiny_folder f = tiny_new();

    (void)state;
    write_clip(&f, "a/images", 12), write_clip(&f, "b/images", 12),
        write_clip(&f, "takes/third", 10);
    tiny_text(&f, "cams.json",
              "{\"fps\": 30, \"cameras\": [{\"name\": \"a\", \"start\": -0.1, " CAMERA
              ", {\"name\": \"b\", \"frame\": 2, " CAMERA ", {\"name\": \"c\", \"video\": "
              "\"takes/third\", " CAMERA "]}");
    ted4_dataset d = load(&f, &tiny_options);
    assert_int_equal(d.n_warnings, 0);
    assert_int_equal(d.n_frames, 17); /* a: 0 to 11, b: 5 to 16, c: 3 to 12 */
    assert_int_equal(d.n_pictures, 34);
    for (int k = 0; k < 17; k++) {
        assert_int_equal(at(&d, "/a/", (uint32_t)k), k < 12 ? k : -1);
        assert_int_equal(at(&d, "/b/", (uint32_t)k), k >= 5 ? k - 5 : -1);
        assert_int_equal(at(&d, "/third/", (uint32_t)k), k >= 3 && k < 13 ? k - 3 : -1);
    }
    for (size_t i = 0; i < d.n_pictures; i++)
        assert_int_equal(d.pictures[i].is_test, d.pictures[i].frame % 8 == 4);
    ted4_dataset_free(&d);
    /* The first five frames of the scene, of whichever cameras they are. */
    ted4_dataset_options o = tiny_options;
    o.max_frames = 5;
    d = load(&f, &o);
    assert_int_equal(d.n_frames, 5);
    assert_int_equal(d.n_pictures, 7);
    assert_int_equal(d.n_warnings, 1);
    assert_string_equal(d.warnings[0], "--max-frames 5 leaves out camera b, which has no picture "
                                       "in the first times");
    ted4_dataset_free(&d);
    o.max_frames = 1;
    d = load(&f, &o);
    assert_int_equal(d.n_pictures, 1);
    assert_int_equal(d.n_warnings, 1);
    assert_string_equal(d.warnings[0], "--max-frames 1 leaves out 2 cameras, which have no picture "
                                       "in the first times; the first: b");
    ted4_dataset_free(&d);
    tiny_text(&f, "cams.json",
              "{\"fps\": 30, \"cameras\": [{\"name\": \"a\", \"start\": 0.05, " CAMERA
              ", {\"name\": \"b\", " CAMERA "]}");
    assert_int_equal(
        warned(&f, "1 of 2 cameras start between two frames", "by up to 0.5 of a frame"), 24);
    d = load(&f, &tiny_options);
    assert_int_equal(d.n_frames, 14); /* a begins at frame 2 */
    ted4_dataset_free(&d);
    tiny_text(&f, "cams.json",
              "{\"cameras\": [{\"name\": \"a\", " CAMERA ", {\"name\": \"c\", \"video\": "
              "\"takes/third/\", " CAMERA "]}");
    assert_int_equal(warned(&f, "clips have from 10 to 12 frames", "--max-frames 10"), 22);
    tiny_free(&f);
}

/* Text is not mistaken for a video, and no list of other files or addresses is followed. */
static void test_playlists(void **state)
{
    static const char *const texts[] = { "#EXTM3U\n#EXT-X-VERSION:3\nx.ts\n",
                                         "ffconcat version 1.0\nfile b.mp4\n",
                                         "<?xml version=\"1.0\"?><MPD/>", "not a video", "" };
    tiny_folder f = tiny_new();

    (void)state;
    tiny_text(&f, "cams.json", "{\"cameras\": [{\"name\": \"a\", " CAMERA "]}");
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        tiny_text(&f, "a.mp4", texts[i]);
        refuse(&f, "a.mp4: ",
               *texts[i] == 0 ? "empty, expected a video" : "text (a playlist?), expected a video");
    }
    tiny_free(&f);
}

/* Bright pixels, uncompressed, look like text, but a signature says that they are none. Letters
 * where a transport stream has its sync bytes do not. */
static void test_bright_video(void **state)
{
    static const char head[] = "YUV4MPEG2 W64 H48 F25:1 Ip A1:1 C420jpeg\nFRAME\n";
    uint8_t bytes[64 * 48 * 3 / 2];
    tiny_folder f = tiny_new();
    ted4_message m = { "" };

    (void)state;
    memset(bytes, 'G', sizeof bytes);
    tiny_bytes(&f, "a.mp4", bytes, sizeof bytes);
    assert_null(ted4_video_demuxer(tiny_path(&f, "a.mp4"), &m));
    assert_non_null(strstr(m.text, "a.mp4: text (a playlist?)"));
    memcpy(bytes, head, sizeof head - 1);
    tiny_bytes(&f, "a.y4m", bytes, sizeof bytes);

    const char *demuxer = ted4_video_demuxer(tiny_path(&f, "a.y4m"), &m);

    if (demuxer == NULL)
        fail_msg("%s", m.text);
    assert_string_equal(demuxer, "yuv4mpegpipe");
    tiny_free(&f);
}

/* Playlists that are not text, and some behind the first bytes of a video, for which ffmpeg is
 * started if it is there. */
static void test_disguised_playlists(void **state)
{
#define LIST "\n#EXTM3U\n#EXTINF:1,\nb.mp4\n"
#define DISGUISE(bytes, what)               \
    {                                       \
        bytes LIST, sizeof bytes LIST, what \
    }
    static const char unknown[] = "begins like no video that is known here";
    static const struct {
        const char *bytes;
        size_t size;
        const char *what;
    } disguises[] = {
        DISGUISE("\0", unknown),
        DISGUISE("\xff\xfe#\0E\0X\0T\0M\0003\0U\0", unknown),
        DISGUISE("RIFF\1\2\3\4WAVE", unknown),
        DISGUISE("\0\0\0\x14"
                 "ftypisom",
                 ""),
        DISGUISE("\x1a\x45\xdf\xa3", ""),
        DISGUISE("OggS\0", ""),
        DISGUISE("\0\0\1\xba", ""),
        DISGUISE("FLV\1", ""),
        DISGUISE("GIF89a", ""),
        DISGUISE("YUV4MPEG2 ", ""),
    };
#undef DISGUISE
#undef LIST
    tiny_folder f = tiny_new(), cache = tiny_new();

    (void)state;
    setenv("XDG_CACHE_HOME", cache.path, 1);
    tiny_text(&f, "cams.json", "{\"cameras\": [{\"name\": \"a\", " CAMERA "]}");
    for (size_t i = 0; i < sizeof disguises / sizeof disguises[0]; i++) {
        tiny_bytes(&f, "a.mp4", disguises[i].bytes, disguises[i].size);
        refuse(&f, "a.mp4: ", disguises[i].what);
    }
    unsetenv("XDG_CACHE_HOME");
    tiny_free(&cache);
    tiny_free(&f);
}

/* The example of doc/layouts.md loads, with clips of 300 frames. */
static void test_example(void **state)
{
    static char text[16384];
    tiny_folder f = tiny_new();
    FILE *in = fopen("doc/layouts.md", "rb");

    (void)state;
    assert_non_null(in);
    text[fread(text, 1, sizeof text - 1, in)] = 0;
    fclose(in);
    char *begin = strstr(text, "```json\n"), *end = begin == NULL ? NULL : strstr(begin + 8, "```");
    assert_non_null(end);
    *end = 0;
    tiny_text(&f, "cams.json", begin + 8);
    for (int i = 0; i < 600; i++) {
        char name[64];
        snprintf(name, sizeof name, "%s/%d.png", i % 2 ? "takes/GX010042.MP4" : "images/right",
                 i / 2);
        tiny_picture(&f, name, 16, 9, i);
    }
    ted4_dataset d = load(&f, &tiny_options);
    assert_int_equal(d.n_warnings, 0);
    assert_int_equal(d.n_frames, 312);
    assert_int_equal(d.n_pictures, 600);
    ted4_dataset_free(&d);
    tiny_free(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_stills),    cmocka_unit_test(test_copies),
        cmocka_unit_test(test_rows),      cmocka_unit_test(test_starts),
        cmocka_unit_test(test_playlists), cmocka_unit_test(test_disguised_playlists),
        cmocka_unit_test(test_example),   cmocka_unit_test(test_bright_video),
    };

    return cmocka_run_group_tests_name("clips", tests, NULL, NULL);
}
