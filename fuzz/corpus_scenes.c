/* corpus_scenes.c - see corpus.h. If a harness takes several files of a scene, the first byte of a
 * seed says which of them it is.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <jpeglib.h>
#include <png.h>

#include "base/bytes.h"
#include "corpus.h"

#define POSE                "[[1,0,0,0],[0,1,0,0],[0,0,1,4],[0,0,0,1]]"
#define PICTURE(file, more) "{\"file_path\":\"" file "\"," more "\"transform_matrix\":" POSE "}"
#define CAMERA(name, more)                                                             \
    "{\"name\":\"" name "\",\"w\":2,\"h\":2,\"K\":[[2,0,0.5],[0,2,0.5],[0,0,1]]," more \
    "\"w2c\":" POSE "}"
#define VIEW                                                                                    \
    "\"width\":4,\"height\":3,\"fx\":2,\"fy\":2,\"cx\":2,\"cy\":1.5,\"R\":[1,0,0,0,1,0,0,0,1]," \
    "\"t\":[0,0,4],"

enum { PLAIN = -1, CAPACITY = 1 << 12 };

typedef struct {
    const char *group, *name;
    int kind; /* first byte of the seed, or PLAIN: no such byte */
    const char *text;
} text_seed;

static const text_seed colmap[] = {
    { "colmap", "cameras.txt", 0,
      "# cameras\n1 PINHOLE 2 2 2 2 1 1\n2 SIMPLE_RADIAL 4 4 3 2 2 0.01\n3 RADIAL 2 2 2 1 1 0 "
      "0\n" },
    { "colmap", "cameras_bad.txt", 0, "1 FOV 2 2 2 2 1 1\n" },
    { "colmap", "images.txt", 1,
      "# images\n1 1 0 0 0 0 0 3 1 a1.png\n1 2 3 -1 -1 -1\n2 0.70710678 0 0.70710678 0 0 0 3 1 "
      "a2.png\n\n" },
    { "colmap", "images_bad.txt", 1, "1 1 1 0 0 0 0 3 1 a1.png\n\n" },
    { "colmap", "points.txt", 2,
      "# points\n1 0 0 0 255 0 300 0.5 1 2 2 3\r\n2 -1e3 1 0.5 0 -4 0 0\n" },
    { "colmap", "points_bad.txt", 2, "1 nan 0 0 1 2 3 0\n" },
};

/* clang-format off */
static const text_seed transforms[] = {
    { "transforms", "blender.json", 0, "{\"camera_angle_x\":0.7,\"frames\":[" PICTURE("./a", "\"time\":0,") ","
                                       PICTURE("b.png", "\"time\":0.5,") "]}" },
    { "transforms", "nerfstudio.json", 0, "{\"fl_x\":2,\"fl_y\":2,\"cx\":1,\"cy\":1,\"w\":2,\"h\":2,\"k1\":0.1,\"k2\":-0.1,\"p1\":0.01,"
        "\"p2\":0,\"camera_model\":\"OPENCV\",\"fps\":30,\"ply_file_path\":\"points.ply\",\"applied_transform\":"
        "[[0,1,0,0],[1,0,0,1],[0,0,-1,0]],\"train_filenames\":[\"a.png\"],\"test_filenames\":[\"b.png\"],\"frames\":["
        PICTURE("a.png", "\"camera\":\"left\",") "," PICTURE("b.png", "\"camera\":7,") "]}" },
    { "transforms", "nine.json", 0, "{\"fl_x\":2,\"frames\":[" PICTURE("a.png", "\"time\":0,") "," PICTURE("a.png", "\"time\":1,") ","
        PICTURE("a.png", "\"time\":2,") "," PICTURE("a.png", "\"time\":3.5,") "," PICTURE("b.png", "\"time\":4,") ","
        PICTURE("b.png", "\"time\":9,") "]}" },
    { "transforms", "fisheye.json", 0, "{\"fl_x\":2,\"is_fisheye\":true,\"frames\":[" PICTURE("a.png", "") "]}" },
    { "transforms", "k3.json", 0, "{\"fl_x\":2,\"k3\":1,\"frames\":[" PICTURE("a.png", "") "]}" },
    { "transforms", "missing.json", 0, "{\"fl_x\":2,\"frames\":[" PICTURE("c.png", "") "]}" },
    { "transforms", "train.json", 1, "{\"camera_angle_x\":0.7,\"frames\":[" PICTURE("./a", "\"time\":0,") "]}" },
    { "transforms", "test.json", 2, "{\"camera_angle_x\":0.7,\"frames\":[" PICTURE("./a", "\"time\":0,") "]}" },
    { "transforms", "broken.json", 0, "{\"frames\":[1" },
    { "transforms", "no_pose.json", 0, "{\"fl_x\":2,\"frames\":[{\"file_path\":\"a.png\"}]}" },
    { "transforms", "short_pose.json", 0, "{\"fl_x\":2,\"frames\":[{\"file_path\":\"a.png\",\"transform_matrix\":[[1,0],[0,1]]}]}" },
    { "transforms", "last_row.json", 0, "{\"fl_x\":2,\"frames\":[{\"file_path\":\"a.png\",\"transform_matrix\":[[1,0,0,0],[0,1,0,0],[0,0,1,4],[0,0,0,2]]}]}" },
    { "transforms", "sheared.json", 0, "{\"fl_x\":2,\"frames\":[{\"file_path\":\"a.png\",\"transform_matrix\":[1,0,0,0,1,1,0,0,0,0,1,4,0,0,0,1]}]}" },
    { "transforms", "no_path.json", 0, "{\"fl_x\":2,\"frames\":[{\"transform_matrix\":" POSE "}]}" },
    { "transforms", "camera_kind.json", 0, "{\"fl_x\":2,\"frames\":[" PICTURE("a.png", "\"camera\":[],") "]}" },
    { "transforms", "frame_kind.json", 0, "{\"fl_x\":2,\"frames\":[1]}" },
    { "transforms", "no_frames.json", 0, "{\"fl_x\":2,\"frames\":[]}" },
    { "transforms", "some_times.json", 0, "{\"fl_x\":2,\"frames\":[" PICTURE("a.png", "\"time\":0,") "," PICTURE("b.png", "") "]}" },
    { "transforms", "applied.json", 0, "{\"fl_x\":2,\"applied_transform\":[[0,0,0,0],[0,1,0,0],[0,0,1,0]],\"frames\":[" PICTURE("a.png", "") "]}" },
    { "transforms", "rate.json", 0, "{\"fl_x\":2,\"fps\":-1,\"frames\":[" PICTURE("a.png", "") "]}" },
    { "transforms", "lens.json", 0, "{\"fl_x\":\"2\",\"fl_y\":0,\"k1\":\"x\",\"frames\":[" PICTURE("a.png", "") "]}" },
    { "transforms", "unknown_name.json", 0, "{\"fl_x\":2,\"train_filenames\":[\"a.png\"],\"test_filenames\":[\"z.png\"],\"frames\":[" PICTURE("./a.png", "") "," PICTURE("b.png", "") "]}" },
    { "transforms", "names_kind.json", 0, "{\"fl_x\":2,\"train_filenames\":7,\"frames\":[" PICTURE("a.png", "") "]}" },
    { "transforms", "twice_named.json", 0, "{\"fl_x\":2,\"train_filenames\":[\"a.png\",\"a.png\"],\"test_filenames\":[\"b.png\"],\"frames\":[" PICTURE("a.png", "") "," PICTURE("b.png", "") "]}" },
    { "transforms", "singular.json", 0, "{\"fl_x\":2,\"frames\":[{\"file_path\":\"a.png\",\"transform_matrix\":[[0,0,0,0],[0,0,0,0],[0,0,0,4],[0,0,0,1]]}]}" },
    { "transforms", "untimed.json", 1, "{\"camera_angle_x\":0.7,\"frames\":[" PICTURE("./a", "") "]}" },
    { "transforms", "list.json", 0, "[]" },
    { "transforms", "path_kind.json", 0, "{\"fl_x\":2,\"frames\":[{\"file_path\":7,\"transform_matrix\":" POSE "}]}" },
    { "transforms", "large.json", 0, "{\"fl_x\":2,\"k1\":1e300,\"frames\":[" PICTURE("a.png", "") "]}" },
    { "transforms", "size.json", 0, "{\"fl_x\":2,\"w\":5,\"h\":3,\"frames\":[" PICTURE("a.png", "") "]}" },
    { "transforms", "focal.json", 0, "{\"fl_x\":-2,\"frames\":[" PICTURE("a.png", "") "]}" },
    { "transforms", "all_held_out.json", 0, "{\"fl_x\":2,\"train_filenames\":[],\"test_filenames\":[\"a.png\",\"b.png\"],\"frames\":[" PICTURE("a.png", "") "," PICTURE("b.png", "") "]}" },
    { "transforms", "one_missing.json", 0, "{\"fl_x\":2,\"frames\":[" PICTURE("a.png", "") "," PICTURE("c.png", "") "]}" },
    { "transforms", "two_missing.json", 0, "{\"fl_x\":2,\"frames\":[" PICTURE("a.png", "") "," PICTURE("c.png", "") "," PICTURE("d.png", "") "]}" },
    { "transforms", "rounded.json", 0, "{\"fl_x\":2,\"frames\":[" PICTURE("a.png", "\"time\":0,") "," PICTURE("b.png", "\"time\":0.333,") ","
                                       PICTURE("b.png", "\"time\":0.667,") "," PICTURE("b.png", "\"time\":1,") "]}" },
    { "transforms", "no_step.json", 0, "{\"fl_x\":2,\"frames\":[" PICTURE("a.png", "\"time\":0,") "," PICTURE("b.png", "\"time\":0.1234567,") ","
                                       PICTURE("b.png", "\"time\":0.3333333,") "," PICTURE("b.png", "\"time\":1,") "]}" },
    { "transforms", "names_item.json", 0, "{\"fl_x\":2,\"train_filenames\":[7],\"frames\":[" PICTURE("a.png", "") "]}" },
};
/* clang-format on */

static const text_seed other_json[] = {
    { "calibration", "cams.json", PLAIN,
      "{\"fps\":30,\"cameras\":[" CAMERA("cam0", "\"dist\":[0.1,0,0,0,0.01],") "," CAMERA(
          "cam1", "") "]}" },
    { "calibration", "frames.json", PLAIN,
      "{\"frames\":2,\"cameras\":[" CAMERA("cam0", "\"video\":\"x.mp4\",") "]}" },
    { "calibration", "video.json", PLAIN,
      "{\"cameras\":[" CAMERA("q", "\"video\":\"cams.json\",") "]}" },
    { "calibration", "skew.json", PLAIN,
      "{\"cameras\":[{\"name\":\"cam0\",\"w\":2,\"h\":2,\"K\":[2,1,1,0,2,1,0,0,1],\"w2c\":" POSE
      "}]}" },
    { "calibration", "no_lens.json", PLAIN, "{\"cameras\":[{\"name\":\"cam0\",\"w\":2}]}" },
    { "hypernerf", "dataset.json", 0,
      "{\"ids\":[\"a\",\"b\"],\"train_ids\":[\"a\"],\"val_ids\":[\"b\"]}" },
    { "hypernerf", "by_position.json", 0, "{\"ids\":[\"a\",\"x\",\"b\"]}" },
    { "hypernerf", "twice.json", 0, "{\"train_ids\":[\"a\",\"a\"],\"val_ids\":[\"b\"]}" },
    { "hypernerf", "metadata.json", 1,
      "{\"a\":{\"warp_id\":5,\"camera_id\":1},\"b\":{\"time\":0.25,\"appearance_id\":2}}" },
    { "hypernerf", "camera.json", 2,
      "{\"focal_length\":3,\"skew\":0.1,\"pixel_aspect_ratio\":1.1,\"image_size\":[4,4],"
      "\"principal_point\":"
      "[2,2],\"orientation\":[[0,1,0],[-1,0,0],[0,0,1]],\"position\":[1,2,3],\"radial_distortion\":"
      "[0.1,0,0],\"tangential\":[0,0.1]}" },
    { "camera_list", "views.json", PLAIN,
      "[{" VIEW "\"frame\":3},{" VIEW "\"time\":0.25},{" VIEW "\"time\":\"1/3\"}]" },
    { "camera_list", "both.json", PLAIN, "[{" VIEW "\"frame\":3,\"time\":0.5}]" },
    { "camera_list", "wide.json", PLAIN,
      "[{\"width\":16385,\"height\":3,\"fx\":2,\"fy\":2,\"cx\":2,\"cy\":1,\"R\":[1,0,0,0,1,0,0,0,1]"
      ","
      "\"t\":[0,0,4],\"frame\":0}]" },
    { "camera_list", "empty.json", PLAIN, "[]" },
    { "camera_list", "transforms.json", PLAIN,
      "{\"w\":4,\"h\":3,\"camera_angle_x\":1,\"applied_transform\":[[1,0,0,2],[0,0,1,0],[0,-1,0,0]]"
      ","
      "\"frames\":[{\"time\":0.5,\"cx\":1,\"transform_matrix\":[[1,0,0,0],[0,1,0,0],[0,0,1,4],"
      "[0,0,0,1]]}]}" },
    { "camera_list", "no_rotation.json", PLAIN,
      "[{\"width\":4,\"height\":3,\"fx\":2,\"fy\":2,\"cx\":2,\"cy\":1,\"R\":[1,0,0,0,2,0,0,0,1]}"
      "]" },
    { "camera_list", "not_object.json", PLAIN, "[1]" },
    { "camera_list", "no_focal.json", PLAIN, "[{\"width\":4,\"height\":3,\"fx\":0,\"fy\":2}]" },
    { "camera_list", "no_centre.json", PLAIN,
      "[{\"width\":4,\"height\":3,\"fx\":1,\"fy\":2,\"cx\":1e39,\"cy\":0}]" },
    { "camera_list", "no_number.json", PLAIN,
      "[{\"width\":4,\"height\":3,\"fx\":1,\"fy\":2,\"cx\":1,\"cy\":0,\"R\":[1,0,0,0,1,0,0,0,\"1\"]"
      "}]" },
    { "camera_list", "mirror.json", PLAIN,
      "[{\"width\":4,\"height\":3,\"fx\":1,\"fy\":2,\"cx\":1,\"cy\":0,\"R\":[1,0,0,0,1,0,0,0,-1]}"
      "]" },
    { "camera_list", "no_t.json", PLAIN,
      "[{\"width\":4,\"height\":3,\"fx\":1,\"fy\":2,\"cx\":1,\"cy\":0,\"R\":[1,0,0,0,1,0,0,0,1],"
      "\"t\":[0]}]" },
    { "camera_list", "pixel.json", PLAIN, "[{" VIEW "\"pixel\":0.5},{" VIEW "\"pixel\":-1}]" },
    { "camera_list", "late.json", PLAIN, "[{" VIEW "\"time\":1.5}]" },
    { "calibration", "no_pose.json", PLAIN,
      "{\"cameras\":[{\"name\":\"cam0\",\"w\":2,\"h\":2,\"K\":[[2,0,1],[0,2,1],[0,0,1]],\"w2c\":[["
      "1]]}]}" },
    { "calibration", "no_name.json", PLAIN,
      "{\"fps\":0,\"cameras\":[{\"name\":7,\"w\":2,\"h\":2}]}" },
    { "calibration", "no_list.json", PLAIN, "{\"cameras\":{}}" },
    { "ply", "ascii.ply", PLAIN,
      "ply\nformat ascii 1.0\ncomment x\nelement vertex 2\nproperty float x\nproperty double "
      "y\nproperty short z\n"
      "property uchar red\nproperty uint8 green\nproperty int blue\nelement face 1\nproperty list "
      "uchar int vertex_index\nend_header\n"
      "0 1 2 255 0 9\n-1e3 0.5 7 1 2 3\n3 0 1 0\n" },
    { "ply", "float_colours.ply", PLAIN,
      "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float "
      "z\n"
      "property float red\nproperty float green\nproperty float blue\nend_header\n1 2 3 0.5 1 "
      "0\n" },
    { "ply", "no_z.ply", PLAIN,
      "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nend_header\n1 "
      "2\n" },
    { "ply", "big_endian.ply", PLAIN, "ply\nformat binary_big_endian 1.0\nend_header\n" },
    { "ply", "too_many.ply", PLAIN,
      "ply\nformat ascii 1.0\nelement vertex 99\nproperty float x\nproperty float y\nproperty "
      "float z\nend_header\n1" },
};

static void write_text(const text_seed *s)
{
    uint8_t data[CAPACITY];
    const size_t front = s->kind >= 0, n = strlen(s->text);

    data[0] = (uint8_t)s->kind;
    memcpy(data + front, s->text, n);
    corpus_write(s->group, s->name, data, front + n);
}

/* Writes little-endian records. */
typedef struct {
    uint8_t bytes[CAPACITY];
    size_t n;
} record;

static void put(record *r, uint64_t v, unsigned size)
{
    for (unsigned i = 0; i < size; i++)
        r->bytes[r->n++] = (uint8_t)(v >> 8 * i);
}

static void put_real(record *r, double v)
{
    uint64_t bits;

    memcpy(&bits, &v, sizeof bits);
    put(r, bits, 8);
}

static void put_text(record *r, const char *text, size_t n)
{
    memcpy(r->bytes + r->n, text, n);
    r->n += n;
}

static void binary_colmap(void)
{
    static const double pose[7] = { 1, 0, 0, 0, 0, 0, 3 };
    record c = { .bytes = { 3 }, .n = 1 }, i = { .bytes = { 4 }, .n = 1 },
           p = { .bytes = { 5 }, .n = 1 };

    put(&c, 1, 8);
    put(&c, 1, 4);
    put(&c, 4, 4); /* OPENCV */
    put(&c, 2, 8);
    put(&c, 2, 8);
    for (int k = 0; k < 8; k++)
        put_real(&c, k < 4 ? 2 - k / 2 : 0.01);
    corpus_write("colmap", "cameras.bin", c.bytes, c.n);
    put(&i, 2, 8);
    for (int k = 0; k < 2; k++) {
        put(&i, (uint64_t)k + 1, 4);
        for (int j = 0; j < 7; j++)
            put_real(&i, pose[j]);
        put(&i, 1, 4);
        put_text(&i, k == 0 ? "a1.png" : "a2.png", 7);
        put(&i, (uint64_t)k, 8);
        for (int j = 0; j < 3 * k; j++)
            put(&i, 0, 8);
    }
    corpus_write("colmap", "images.bin", i.bytes, i.n);
    put(&p, 1, 8);
    put(&p, 7, 8);
    for (int k = 0; k < 3; k++)
        put_real(&p, k);
    put(&p, 0x102030, 3);
    put_real(&p, 0.5);
    put(&p, 1, 8);
    put(&p, 0, 8);
    corpus_write("colmap", "points.bin", p.bytes, p.n);
}

/* A .npy file. kind: the first byte of the seed, or PLAIN; type: as NumPy writes it, <f4 or any
 * whose numbers have 8 bytes. */
typedef struct {
    const char *group, *name;
    int kind;
    const char *type, *is_fortran, *shape;
    const double *v;
    size_t n;
} numpy_seed;

static void numpy(const numpy_seed *s)
{
    record r = { .n = 0 };
    char header[100];
    const int size = snprintf(header, sizeof header,
                              "{'descr': '%s', 'fortran_order': %s, 'shape': %s, }\n", s->type,
                              s->is_fortran, s->shape);

    if (s->kind >= 0)
        put(&r, (uint64_t)s->kind, 1);
    put_text(&r, "\x93NUMPY\1\0", 8);
    put(&r, (uint64_t)size, 2);
    put_text(&r, header, (size_t)size);
    for (size_t i = 0; i < s->n; i++)
        if (strcmp(s->type, "<f4") == 0)
            put(&r, ted4_float_bits((float)s->v[i]), 4);
        else
            put_real(&r, s->v[i]);
    corpus_write(s->group, s->name, r.bytes, r.n);
}

static void all_numpy(void)
{
    /* Three equal rows of poses_bounds.npy. */
#define ROW 0, 1, 0, 0, 2, 1, 0, 0, 0, 2, 0, 0, -1, 0, 3, 1, 9
    static const double rows[51] = { ROW, ROW, ROW };
#undef ROW
    static const double endless[3] = { 0, NAN, 1 };
    static const numpy_seed seeds[] = {
        { "npy", "poses_bounds.npy", PLAIN, "<f8", "False", "(2, 17)", rows, 34 },
        { "npy", "points.npy", PLAIN, "<f4", "False", "(2, 3)", rows, 6 },
        { "npy", "trailing.npy", PLAIN, "<f4", "False", "(2, 3)", rows, 7 },
        { "npy", "fortran.npy", PLAIN, "<f4", "True", "(2, 3)", rows, 6 },
        { "npy", "one_row.npy", PLAIN, "<f8", "False", "(1, 17)", rows, 17 },
        { "npy", "three.npy", PLAIN, "<f8", "False", "(3, 17)", rows, 51 },
        { "npy", "four.npy", PLAIN, "<f8", "False", "(4, 17)", rows, 51 },
        { "npy", "endless.npy", PLAIN, "<f4", "False", "(1, 3)", endless, 3 },
        { "npy", "one_axis.npy", PLAIN, "<f4", "False", "(3,)", rows, 3 },
        { "npy", "integers.npy", PLAIN, "<i8", "False", "(1, 3)", rows, 3 },
        { "hypernerf", "points.npy", 3, "<f4", "False", "(2, 3)", rows, 6 },
    };

    for (size_t i = 0; i < sizeof seeds / sizeof *seeds; i++)
        numpy(&seeds[i]);
    corpus_write("npy", "version2.npy",
                 "\x93NUMPY\2\0\x3a\0\0\0{'descr': '<f4', 'fortran_order': False, 'shape': (1, 3)}"
                 "\n\0\0\0\0\0\0\0\0\0\0\0\0",
                 82);
    corpus_write("npy", "cut.npy", "\x93NUMPY\1\0\xff\0{", 11);
    corpus_write("npy", "neither", "not an array", 12);
}

static void binary_ply(void)
{
    record r = { .n = 0 };
    static const char header[] = "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty "
                                 "float x\nproperty float y\nproperty double z\n"
                                 "property char a\nproperty uchar red\nproperty ushort "
                                 "green\nproperty uint blue\nend_header\n";

    put_text(&r, header, sizeof header - 1);
    put(&r, ted4_float_bits(1.5f), 4);
    put(&r, ted4_float_bits(-2.0f), 4);
    put_real(&r, 0.25);
    put(&r, 0x00000007000809fe, 8);
    corpus_write("ply", "binary.ply", r.bytes, r.n);
}

static void png(const char *name, uint32_t format)
{
    uint8_t pixels[6 * 6 * 8], map[4 * 256], file[CAPACITY];
    png_alloc_size_t n = sizeof file;
    png_image p;

    for (size_t i = 0; i < sizeof pixels; i++)
        pixels[i] = (uint8_t)(format & PNG_FORMAT_FLAG_COLORMAP ? i % 4 : i * 7);
    for (size_t i = 0; i < sizeof map; i++)
        map[i] = (uint8_t)(i * 50);
    memset(&p, 0, sizeof p);
    p.version = PNG_IMAGE_VERSION;
    p.width = 5;
    p.height = 3;
    p.format = format;
    p.colormap_entries = 4;
    if (png_image_write_to_memory(&p, file, &n, 0, pixels, 0, map))
        corpus_write("image", name, file, n);
}

/* Writes the beginning of a picture that was written before. */
static void cut_png(void)
{
    static const uint8_t head[] = "\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\5\0\0\0\3\10\2\0\0\0\0\0\0\0"
                                  "\0\0\0\7tRNS\0\0\0\0\0\0\0\0\0\0\0";

    corpus_write("image", "short.png", head, sizeof head - 1);
    corpus_write("image", "shorter.png", head, 20);
    corpus_write("image", "neither", "GIF89a", 6);
    corpus_write("image", "exif", "Exif\0\0MM\0*\0\0\0\10\0\1\1\22\0\3\0\0\0\1\0\3\0\0", 28);
    corpus_write("image", "wide.png",
                 "\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\1\0\0\0\0\0\3\10\2\0\0\0\0\0\0\0\0", 34);
}

/* Writes a JPEG. components: 1 grey, 3 colour, 4 inks. bytes: upper bound on the size of the
 * file. */
static void jpeg(const char *name, int components, int progressive, size_t bytes)
{
    struct jpeg_compress_struct c;
    struct jpeg_error_mgr e;
    static const uint8_t exif[] = "Exif\0\0II*\0\10\0\0\0\1\0\x12\1\3\0\1\0\0\0\6\0\0\0";
    uint8_t row[32], *file = NULL;
    unsigned long n = 0;
    JSAMPROW at = row;

    c.err = jpeg_std_error(&e);
    jpeg_create_compress(&c);
    jpeg_mem_dest(&c, &file, &n);
    c.image_width = 8;
    c.image_height = 9;
    c.input_components = components;
    c.in_color_space = components == 1 ? JCS_GRAYSCALE : components == 3 ? JCS_RGB : JCS_CMYK;
    jpeg_set_defaults(&c);
    if (progressive)
        jpeg_simple_progression(&c);
    jpeg_start_compress(&c, TRUE);
    if (progressive)
        jpeg_write_marker(&c, JPEG_APP0 + 1, exif, sizeof exif - 1);
    for (int y = 0; y < 9; y++) {
        for (size_t i = 0; i < sizeof row; i++)
            row[i] = (uint8_t)(i * 9 + (size_t)y * 20);
        jpeg_write_scanlines(&c, &at, 1);
    }
    jpeg_finish_compress(&c);
    jpeg_destroy_compress(&c);
    corpus_write("image", name, file, n < bytes ? n : bytes);
    free(file);
}

/* Seeds of fz_checkpoint.c: changes of a valid checkpoint. */
static void checkpoints(void)
{
    corpus_write("checkpoint", "stage1", "\0", 1);
    corpus_write("checkpoint", "stage2", "\1", 1);
    corpus_write("checkpoint", "wrong_hash", "\2", 1);
    corpus_write("checkpoint", "short", "\1\0\2\0\xff", 5);
    corpus_write("checkpoint", "magic", "\0\0\0\0\1x", 6);
}

void corpus_scenes(void)
{
    for (size_t i = 0; i < sizeof colmap / sizeof *colmap; i++)
        write_text(&colmap[i]);
    for (size_t i = 0; i < sizeof transforms / sizeof *transforms; i++)
        write_text(&transforms[i]);
    for (size_t i = 0; i < sizeof other_json / sizeof *other_json; i++)
        write_text(&other_json[i]);
    binary_colmap();
    all_numpy();
    binary_ply();
    png("rgb.png", PNG_FORMAT_RGB);
    png("rgba.png", PNG_FORMAT_RGBA);
    png("grey.png", PNG_FORMAT_GRAY);
    png("deep.png", PNG_FORMAT_LINEAR_RGB_ALPHA);
    png("palette.png", PNG_FORMAT_RGBA_COLORMAP);
    cut_png();
    jpeg("rgb.jpg", 3, 0, CAPACITY);
    jpeg("grey.jpg", 1, 0, CAPACITY);
    jpeg("progressive.jpg", 3, 1, CAPACITY);
    jpeg("inks.jpg", 4, 0, CAPACITY);
    jpeg("short.jpg", 1, 0, 340);
    jpeg("shorter.jpg", 1, 0, 40);
    checkpoints();
}
