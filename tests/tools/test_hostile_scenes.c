/* test_hostile_scenes.c - ted4enc --check on scenes that are broken, or were made to do harm: each
 * gives either one clear error with exit status 3, or one counted warning and the rest of the
 * scene, and never anything else. The program is taken from $TED4_BUILD; the test is skipped if
 * that is not set.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <sys/wait.h>

#include "test.h"
#include "tiny_scene.h"

static const char *build;
static tiny_folder folder; /* holds s, the case's scene, and the program's output */
static char out[8192], err[8192];

/* ---- the parts of a case ---- */

/* A scene of one layout that is valid apart from the text inserted into it. */
typedef enum { TRANSFORMS, FRAMES, CAMERAS, IMAGES, POINTS, OTHER } kind;

typedef struct {
    kind what;
    const char *text;
    const char *says;   /* part of the message */
    int warns;          /* a warning, not an error */
    void (*make)(void); /* makes further files, or the whole scene for OTHER */
} hostile;

#define POSE       "\"transform_matrix\": " TINY_POSE
#define LENS       "\"K\": [[9,0,8],[0,9,6],[0,0,1]], \"w\": 16, \"h\": 12, \"w2c\": " TINY_POSE "}"
#define A          "{\"name\": \"a\", " LENS
#define ROTATED(m) "{\"file_path\": \"1.png\", \"transform_matrix\": " m "}"

static const char *const names[] = { "s/0.png",        "s/1.png",          "s/2.png",
                                     "s/images/0.png", "s/a/images/0.png", "s/a/images/1.png" };

static void write_case(const hostile *h)
{
    static tiny_string s;
    static const struct {
        int first, end;
    } pictures[] = {
        [TRANSFORMS] = { 0, 3 }, [FRAMES] = { 0, 3 }, [CAMERAS] = { 4, 6 },
        [IMAGES] = { 3, 4 },     [POINTS] = { 3, 4 }, [OTHER] = { 0, 0 },
    };

    for (int i = pictures[h->what].first; i < pictures[h->what].end; i++)
        tiny_picture(&folder, names[i], TINY_W, TINY_H, i);
    s.n = 0;
    if (h->what == TRANSFORMS)
        tiny_text(&folder, "s/transforms.json", h->text);
    if (h->what == FRAMES) {
        tiny_add(&s,
                 "{\"fl_x\": 9, \"frames\": [{\"file_path\": \"0.png\", " POSE
                 "}, %s, {\"file_path\": \"2.png\", " POSE "}]}",
                 h->text);
        tiny_text(&folder, "s/transforms.json", s.text);
    }
    if (h->what == CAMERAS) {
        tiny_add(&s, "{%s]}", h->text);
        tiny_text(&folder, "s/cams.json", s.text);
    }
    if (h->what == IMAGES || h->what == POINTS) {
        tiny_text(&folder, "s/sparse/0/cameras.txt",
                  "1 PINHOLE 16 12 9 9 8 6\n2 PINHOLE 16 12 nan 9 8 6\n3 PINHOLE 16 12 -9 9 8 6\n");
        tiny_text(&folder, "s/sparse/0/images.txt",
                  h->what == IMAGES ? h->text : "1 1 0 0 0 0 0 0 1 0.png\n\n");
    }
    if (h->what == POINTS)
        tiny_text(&folder, "s/points3d.ply", h->text);
    if (h->make != NULL)
        h->make();
}

/* ---- cases that need more than a text ---- */

static void bytes_as(const char *name, const char *bytes, size_t n)
{
    tiny_bytes(&folder, name, bytes, n);
}

static void cut_png(void)
{
    must(truncate(tiny_path(&folder, "s/1.png"), (off_t)tiny_size(&folder, "s/1.png") - 25) == 0,
         "1.png");
}

static void bare_png(void)
{
    bytes_as("s/1.png", "\x89PNG\r\n\x1a\n", 8);
}
static void empty_png(void)
{
    bytes_as("s/1.png", "", 0);
}
static void text_png(void)
{
    bytes_as("s/1.png", "<svg></svg>", 11);
}
static void cut_jpeg(void)
{
    bytes_as("s/1.png", "\xff\xd8\xff\xe0\0\x10JFIF", 10);
}
static void cmyk_jpeg(void)
{
    bytes_as("s/1.png", "\xff\xd8\xff\xc0\0\x14\x08\0\x0c\0\x10\x04\0\0\0\0\0\0\0\0\0\0\0\0", 24);
}
static void endless_jpeg(void)
{
    bytes_as("s/1.png",
             "\xff\xd8\xff\xe1\xff\xff"
             "Exif\0\0MM\0*\xff\xff\xff\xff",
             20);
}
static void giant_png(void)
{
    bytes_as("s/1.png",
             "\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR\x7f\xff\xff\xff\x7f\xff\xff\xff\x08\x06\0\0\0\0\0\0"
             "\0",
             33);
}

static void no_pictures(void)
{
    for (int i = 0; i < 3; i++)
        must(remove(tiny_path(&folder, names[i])) == 0, names[i]);
}

static void missing_picture(void)
{
    must(remove(tiny_path(&folder, "s/1.png")) == 0, "1.png");
}

static void fifo_picture(void)
{
    missing_picture();
    must(mkfifo(tiny_path(&folder, "s/1.png"), 0600) == 0, "1.png");
}

static void folder_picture(void)
{
    missing_picture();
    must(mkdir(tiny_path(&folder, "s/1.png"), 0700) == 0, "1.png");
}

static void loop_picture(void)
{
    missing_picture();
    must(symlink("1.png", tiny_path(&folder, "s/1.png")) == 0, "1.png");
}

/* Writes a list that contains a text n times. */
static void long_list(const char *before, const char *item, size_t n, const char *after)
{
    FILE *o = fopen(tiny_path(&folder, "s/transforms.json"), "wb");

    must(o != NULL, "transforms.json");
    fputs(before, o);
    for (size_t i = 0; i < n; i++)
        fputs(item, o);
    must(fputs(after, o) >= 0 && fclose(o) == 0, "transforms.json");
}

static void ten_million(void)
{
    long_list("[0", ",0", 10000000, "]");
}
static void million_frames(void)
{
    long_list("{\"fl_x\": 9, \"frames\": [0", ",0", 1000000, "]}");
}
static void deep(void)
{
    long_list("", "[", 100000, "");
}
static void long_name(void)
{
    long_list("{\"fl_x\": 9, \"frames\": [{\"file_path\": \"0.png\", " POSE "}, {\"file_path\": \"",
              "../long", 2000, "\", " POSE "}]}");
}

static void playlist(void)
{
    tiny_text(&folder, "s/b.mp4", "#EXTM3U\n#EXTINF:1,\n/etc/passwd\n");
}
static void words(void)
{
    tiny_text(&folder, "s/b.mp4", "a letter\n");
}
static void noise(void)
{
    bytes_as("s/b.mp4",
             "\0\0\0\x20"
             "ftypisom\0\0\2\0\1\2\3",
             19);
}
static void no_bytes(void)
{
    bytes_as("s/b.mp4", "", 0);
}
static void empty_clip(void)
{
    tiny_text(&folder, "s/b/images/x.txt", "");
}
static void many_images(void)
{
    bytes_as("s/sparse/0/images.bin", "\xff\xff\xff\xff\xff\xff\xff\x7f\0\0\0\0\0\0\0\0", 16);
}

static void nothing(void)
{
    tiny_text(&folder, "s/readme.txt", "");
}
static void folder_list(void)
{
    tiny_text(&folder, "s/transforms.json/x", "");
}

static void npy(const char *shape, size_t n)
{
    static char bytes[4096];
    const int head = snprintf(bytes, sizeof bytes,
                              "%cNUMPY%c%c%c%c{'descr': '<f8', 'fortran_order': False, 'shape': "
                              "%s, }\n",
                              0x93, 1, 0, 118, 0, shape);

    memset(bytes + head, ' ', 128 - (size_t)head);
    memset(bytes + 128, 0xff, n); /* not numbers */
    bytes[127] = '\n';
    bytes_as("s/poses_bounds.npy", bytes, 128 + n);
    tiny_picture(&folder, "s/images/0.png", TINY_W, TINY_H, 0);
}

static void npy_large(void)
{
    npy("(9223372036854775807, 17)", 136);
}
static void npy_nan(void)
{
    npy("(1, 17)", 136);
}
static void npy_short(void)
{
    npy("(3, 17)", 136);
}

static void hypernerf_gap(void)
{
    tiny_text(&folder, "s/dataset.json",
              "{\"ids\": [\"../0\"], \"train_ids\": [\"../0\"], \"val_ids\": []}");
    tiny_text(&folder, "s/metadata.json", "{}");
    tiny_text(&folder, "s/camera/x.json", "{}");
    tiny_picture(&folder, "s/rgb/1x/0.png", TINY_W, TINY_H, 0);
    tiny_picture(&folder, "s/rgb/0.png", TINY_W, TINY_H, 0);
}

#define FINE "{\"file_path\": \"1.png\", " POSE "}"

static const hostile cases[] = {
    /* pictures */
    { FRAMES, FINE, "warning: 1 of 3 entries has no picture: s/transforms.json: frames[1]: 1.png",
      1, missing_picture },
    { FRAMES, FINE,
      "none of 3 entries has a picture; the first: s/transforms.json: frames[0]: 0.png", 0,
      no_pictures },
    { FRAMES, FINE, "s/1.png: PNG: ", 0, cut_png },
    { FRAMES, FINE, "s/1.png: PNG without a complete IHDR chunk", 0, bare_png },
    { FRAMES, FINE, "s/1.png: neither PNG nor JPEG", 0, empty_png },
    { FRAMES, FINE, "s/1.png: neither PNG nor JPEG", 0, text_png },
    { FRAMES, FINE, "s/1.png: JPEG without a frame header", 0, cut_jpeg },
    { FRAMES, FINE, "s/1.png: JPEG of 4 colours", 0, cmyk_jpeg },
    { FRAMES, FINE, "s/1.png: JPEG without a frame header", 0, endless_jpeg },
    { FRAMES, FINE, "s/1.png: picture of 2147483647x2147483647 pixels", 0, giant_png },
    { FRAMES, FINE, "1 of 3 entries has no picture: ", 1, fifo_picture },
    { FRAMES, FINE, "1 of 3 entries has no picture: ", 1, folder_picture },
    { FRAMES, FINE, "1 of 3 entries has no picture: ", 1, loop_picture },
    /* names */
    { FRAMES, "{\"file_path\": \"../../../../../../../../etc/passwd\", " POSE "}",
      "passwd: neither PNG nor JPEG", 0, NULL },
    { FRAMES, "{\"file_path\": \"/dev/zero\", " POSE "}", "frames[1]: /dev/zero", 1, NULL },
    { FRAMES, "{\"file_path\": \"%s%n%s%n/%99999d\", " POSE "}", "frames[1]: %s%n%s%n/%99999d", 1,
      NULL },
    { FRAMES, "{\"file_path\": \"\", " POSE "}", "1 of 3 entries has no picture", 1, NULL },
    { FRAMES, "{\"file_path\": \"..\", " POSE "}", "1 of 3 entries has no picture", 1, NULL },
    { FRAMES, "{\"file_path\": \"1.png\\u0000x\", " POSE "}", "transforms.json:1: not valid JSON",
      0, NULL },
    { TRANSFORMS, "", "1 of 2 entries has no picture", 1, long_name },
    /* cameras */
    { FRAMES, "{\"file_path\": \"1.png\", \"fl_x\": -9, " POSE "}", "s/1.png: focal lengths -9, -9",
      0, NULL },
    { FRAMES, "{\"file_path\": \"1.png\", \"fl_x\": 0, " POSE "}", "s/1.png: focal lengths 0, 0", 0,
      NULL },
    { FRAMES, "{\"file_path\": \"1.png\", \"fl_x\": \"9\", " POSE "}",
      "frames[1].fl_x: expected a number", 0, NULL },
    { FRAMES, "{\"file_path\": \"1.png\", \"w\": 1e300, \"h\": 12, " POSE "}",
      "w, h are 1e+300, 12", 0, NULL },
    { FRAMES, "{\"file_path\": \"1.png\", \"w\": 17, \"h\": 12, " POSE "}",
      "s/1.png: the file is 16x12, its camera says 17x12", 0, NULL },
    { FRAMES, ROTATED("[[NaN,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]"),
      "transforms.json:1: not valid JSON", 0, NULL },
    { FRAMES, ROTATED("[[1,0,0,1e999],[0,1,0,0],[0,0,1,0],[0,0,0,1]]"),
      "transforms.json:1: not valid JSON", 0, NULL },
    { FRAMES, ROTATED("[[1,0,0,1e30],[0,1,0,0],[0,0,1,0],[0,0,0,1]]"),
      "s/1.png: its camera is 1e+30 units away", 0, NULL },
    { FRAMES, ROTATED("[[0,0,0,0],[0,0,0,0],[0,0,0,0],[0,0,0,1]]"),
      "frames[1].transform_matrix: its 3x3 part is singular", 0, NULL },
    { FRAMES, ROTATED("[[1,0,0,0],[0,1,0,0],[0,0,-1,0],[0,0,0,1]]"),
      "its 3x3 part is a mirror image", 0, NULL },
    { FRAMES, ROTATED("[1,0,0,0]"), "frames[1].transform_matrix: expected 4x4 numbers", 0, NULL },
    { FRAMES, "{\"file_path\": \"1.png\", \"time\": 0.5, " POSE "}",
      "frames[0].time: missing, while 1 of 3", 0, NULL },
    { FRAMES, "null", "frames[1]: expected an object", 0, NULL },
    { FRAMES, "{}", "frames[1].file_path: missing", 0, NULL },
    /* the list itself */
    { TRANSFORMS, "{\"fl_x\": 9, \"frames\": [{\"file_path\": \"0.p",
      "transforms.json:1: not valid JSON", 0, NULL },
    { TRANSFORMS, "", "transforms.json:1: not valid JSON", 0, NULL },
    { TRANSFORMS, "\xff\xfe{}", "transforms.json:1: not valid JSON", 0, NULL },
    { TRANSFORMS, "{\"frames\": [], \"frames\": []}", "duplicate", 0, NULL },
    { TRANSFORMS, "{\"fl_x\": 9, \"frames\": []}", "expected a list with at least one frame", 0,
      NULL },
    { TRANSFORMS, "{\"fl_x\": 9, \"frames\": {\"0\": 1}}",
      "expected a list with at least one frame", 0, NULL },
    { TRANSFORMS, "", "expected an object with a list", 0, ten_million },
    { TRANSFORMS, "", "frames[0]: expected an object", 0, million_frames },
    { TRANSFORMS, "", "transforms.json:1: not valid JSON", 0, deep },
    /* clips */
    { CAMERAS, "\"cameras\": [" A ", {\"name\": \"b\", " LENS, "cameras[1]: b: no such video", 1,
      NULL },
    { CAMERAS, "\"cameras\": [" A ", {\"name\": \"b\", " LENS,
      "b.mp4: text (a playlist?), expected a video", 0, playlist },
    { CAMERAS, "\"cameras\": [" A ", {\"name\": \"b\", " LENS,
      "b.mp4: text (a playlist?), expected a video", 0, words },
    { CAMERAS, "\"cameras\": [" A ", {\"name\": \"b\", " LENS, "b.mp4: empty, expected a video", 0,
      no_bytes },
    { CAMERAS, "\"cameras\": [" A ", {\"name\": \"b\", " LENS, "b.mp4: ", 0, noise },
    { CAMERAS, "\"cameras\": [" A ", {\"name\": \"b\", " LENS, "s/b/images: no pictures here", 0,
      empty_clip },
    { CAMERAS, "\"cameras\": [" A ", {\"name\": \"../../../etc\", " LENS,
      "cameras[1]: ../../../etc: no such video", 1, NULL },
    { CAMERAS, "\"frames\": 3, \"cameras\": [" A, "cameras[0]: 2 frames, expected 3", 0, NULL },
    { CAMERAS, "\"frames\": -1, \"cameras\": [" A, "cams.json.frames: -1", 0, NULL },
    { CAMERAS, "\"fps\": 1e300, \"cameras\": [" A, "cams.json.fps: 1e+300", 0, NULL },
    { CAMERAS, "\"cameras\": [7", "cameras[0]: no name", 0, NULL },
    { CAMERAS, "\"cameras\": [{\"name\": \"a\", \"frame\": 1e300, " LENS, "1e+300 frames", 0,
      NULL },
    { CAMERAS, "\"cameras\": [", "expected a list with at least one camera", 0, NULL },
    /* COLMAP */
    { IMAGES, "", "the scene (layout colmap) has no pictures", 0, NULL },
    { IMAGES, "1 1 0 0 0 0 0 0 1 0.png\n\n2 1 0 0 0 0 0 0 1 1.png\n\n",
      "1 of 2 entries has no picture", 1, NULL },
    { IMAGES, "1 1 0 0 0 0 0 0 7 0.png\n\n", "its camera 7 is not in the cameras file", 0, NULL },
    { IMAGES, "1 1 0 0 0 0 0 0 2 0.png\n\n", "0.png: focal lengths nan, 9", 0, NULL },
    { IMAGES, "1 1 0 0 0 0 0 0 3 0.png\n\n", "0.png: focal lengths -9, 9", 0, NULL },
    { IMAGES, "1 nan 0 0 0 0 0 0 1 0.png\n\n", "images.txt:1", 0, NULL },
    { IMAGES, "1 1 0 0 0 0 0 0 1 ../../s\n\n", "a folder, expected a picture", 0, NULL },
    { IMAGES, "1 1 0 0 0 0 0 0 1 0.png\n\n", "images.bin", 0, many_images },
    { POINTS,
      "ply\nformat ascii 1.0\nelement vertex 4000000000000\nproperty float x\nproperty float "
      "y\nproperty float z\nend_header\n1 2 3\n",
      "points3d.ply", 0, NULL },
    /* tables */
    { OTHER, "", "poses_bounds.npy", 0, npy_large },
    { OTHER, "", "poses_bounds.npy", 0, npy_nan },
    { OTHER, "", "poses_bounds.npy", 0, npy_short },
    { OTHER, "", "s/camera/../0.json: No such file", 0, hypernerf_gap },
    { OTHER, "", "no scene recognised", 0, nothing },
    { OTHER, "", "no scene recognised", 0, folder_list },
};

enum { N_CASES = sizeof cases / sizeof cases[0] };

/* ---- running them ---- */

static void slurp(const char *name, char *text, size_t size)
{
    FILE *f = fopen(tiny_path(&folder, name), "rb");

    assert_non_null(f);
    text[fread(text, 1, size - 1, f)] = 0;
    fclose(f);
}

static size_t lines(const char *text)
{
    size_t n = 0;

    for (; *text != 0; text++)
        n += *text == '\n';
    return n;
}

static void check_case(int number, const hostile *h)
{
    char command[1024];

    write_case(h);
    snprintf(
        command, sizeof command,
        "cd '%s' && XDG_CACHE_HOME='%s'/cache '%s'/ted4enc s --check -q -j 1 >out.txt 2>err.txt "
        "</dev/null",
        folder.path, folder.path, build);
    const int status = system(command);
    slurp("out.txt", out, sizeof out);
    slurp("err.txt", err, sizeof err);
    const int code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    const char *begin = h->warns ? "ted4enc: warning: " : "ted4enc: ";
    const int fine = code == (h->warns ? 0 : 3) && lines(err) == 1 &&
                     strncmp(err, begin, strlen(begin)) == 0 &&
                     (h->warns || strncmp(err, "ted4enc: warning", 16) != 0) &&
                     strstr(err, h->says) != NULL && (!h->warns || strncmp(out, "layout ", 7) == 0);
    if (!fine)
        fail_msg("case %d: exit %d, \"%s\", expected \"%s\"", number, code, err, h->says);
    tiny_remove_path(tiny_path(&folder, "s"));
}

static void test_cases(void **state)
{
    (void)state;
    if (build == NULL) {
        print_message("skipped: TED4_BUILD is not set\n");
        skip();
    }
    for (int i = 0; i < N_CASES; i++)
        check_case(i, &cases[i]);
    print_message("%d scenes\n", N_CASES);
}

int main(void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test(test_cases) };

    build = getenv("TED4_BUILD");
    folder = tiny_new();
    const int failed = cmocka_run_group_tests_name("hostile scenes", tests, NULL, NULL);
    tiny_free(&folder);
    return failed;
}
