/* ray_layout.c - see ray_layout.h. The loaders in ref-encoder/data explain the formats.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "ray_layout.h"

#include <string.h>

#include "ray_picture.h"

/* The range of depths that some layouts contain, in units of the room. */
#define NEAR 0.1
#define FAR  10.0

const char *ted4_ray_layout_name(ted4_ray_layout l)
{
    static const char *const names[RAY_LAYOUTS] = { "blender",     "nerfstudio", "colmap",
                                                    "colmap-text", "hypernerf",  "neu3d",
                                                    "calibration", "llff" };

    return names[l];
}

static int n_cameras(const ted4_ray_options *o)
{
    return o->n_train + o->n_test;
}

static int is_test(const ted4_ray_options *o, int number)
{
    return number >= o->n_train;
}

/* Returns the number of the i-th camera if test cameras come first. */
static int test_first(const ted4_ray_options *o, int i)
{
    return i < o->n_test ? o->n_train + i : i - o->n_test;
}

void ted4_ray_camera_name(const ted4_ray_options *o, int number, char name[TED4_RAY_NAME])
{
    const int i = is_test(o, number) ? number - o->n_train : number + o->n_test;

    snprintf(name, TED4_RAY_NAME, n_cameras(o) > 100 ? "cam%04d" : "cam%02d", i);
}

/* Makes a name of "train", the separator and "r_003_07", with enough digits to sort names as
 * numbers. */
static void flat_name(const ted4_ray_options *o, int number, int frame, const char *separator,
                      char name[40])
{
    const int test = is_test(o, number);
    const char *const held = o->ways.split == RAY_VAL_FILE ? "val" : "test";

    snprintf(name, 40, o->n_frames > 100 ? "%s%sr_%03d_%03d" : "%s%sr_%03d_%02d",
             test ? held : "train", separator, test ? number - o->n_train : number, frame);
}

void ted4_ray_picture_name(const ted4_ray_options *o, int number, int frame,
                           char name[TED4_RAY_NAME])
{
    const char *const end = ted4_ray_ending(o);
    char camera[TED4_RAY_NAME], flat[40];

    frame -= ted4_ray_start(o, number);
    ted4_ray_camera_name(o, number, camera);
    flat_name(o, number, frame, o->layout == RAY_BLENDER ? "/" : "_", flat);
    switch (o->layout) {
    case RAY_BLENDER: snprintf(name, TED4_RAY_NAME, "%s%s", flat, end); break;
    case RAY_NERFSTUDIO: snprintf(name, TED4_RAY_NAME, "images/%s%s", flat, end); break;
    case RAY_HYPERNERF: snprintf(name, TED4_RAY_NAME, "rgb/1x/%s%s", flat, end); break;
    case RAY_COLMAP:
    case RAY_COLMAP_TEXT:
        snprintf(name, TED4_RAY_NAME, "images/%.20s/%04d%s", camera, frame, end);
        break;
    case RAY_LLFF: snprintf(name, TED4_RAY_NAME, "images/%.20s%s", camera, end); break;
    default: snprintf(name, TED4_RAY_NAME, "%.20s/images/%04d%s", camera, frame, end);
    }
}

/* ---- transforms: blender, nerfstudio ---- */

/* Makes the name of a picture as the listing states it. */
static void stated_path(const ted4_ray_options *o, int number, int frame, char path[TED4_RAY_NAME])
{
    char name[TED4_RAY_NAME];

    ted4_ray_picture_name(o, number, frame, name);
    if (o->ways.paths == RAY_NO_ENDING || o->ways.paths == RAY_NAME_ONLY ||
        (o->ways.paths == RAY_AS_USUAL && o->layout == RAY_BLENDER))
        *strrchr(name, '.') = '\0';
    if (o->ways.paths == RAY_NO_FOLDER || o->ways.paths == RAY_NAME_ONLY)
        snprintf(path, TED4_RAY_NAME, "%s", strrchr(name, '/') + 1);
    else
        snprintf(path, TED4_RAY_NAME, "./%.76s", name);
}

static int states_each(const ted4_ray_options *o)
{
    return o->ways.k_each || o->ways.sizes;
}

static void put_lens(FILE *f, const ted4_ray_camera *c, const char *margin)
{
    fprintf(f, "%s\"w\": %d,\n%s\"h\": %d,\n%s\"fl_x\": %.17g,\n%s\"fl_y\": %.17g,\n", margin,
            c->width, margin, c->height, margin, c->focal, margin, c->focal);
    fprintf(f, "%s\"cx\": %.17g,\n%s\"cy\": %.17g,\n", margin, c->cx, margin, c->cy);
}

static void put_frame(FILE *f, const ted4_ray_options *o, int number, int frame)
{
    char name[TED4_RAY_NAME];
    ted4_ray_camera c;

    ted4_ray_camera_stated(o, number, &c);
    stated_path(o, number, frame, name);
    fprintf(f, "\n    {\n      \"file_path\": \"%s\",\n      \"time\": %.17g,\n", name,
            ted4_ray_time(frame, o->n_frames));
    if (states_each(o))
        put_lens(f, &c, "      ");
    if (o->layout == RAY_NERFSTUDIO)
        fprintf(f, "      \"camera\": %d,\n", number);
    fprintf(f, "      \"transform_matrix\": [");
    for (int r = 0; r < 4; r++)
        fprintf(f, "%s\n        [%.17g, %.17g, %.17g, %.17g]", r > 0 ? "," : "", c.matrix[r][0],
                c.matrix[r][1], c.matrix[r][2], c.matrix[r][3]);
    fprintf(f, "\n      ]\n    }");
}

static void put_transforms(FILE *f, const ted4_ray_options *o, int first, int cameras)
{
    ted4_ray_camera c;
    int n = 0;

    ted4_ray_camera_stated(o, 0, &c);
    fputs("{\n", f);
    if (o->layout == RAY_NERFSTUDIO)
        fputs("  \"camera_model\": \"OPENCV\",\n", f);
    else if (!states_each(o))
        fprintf(f, "  \"camera_angle_x\": %.17g,\n", ted4_ray_angle_x);
    if (!states_each(o) &&
        (o->layout == RAY_NERFSTUDIO || o->ways.off[0] != 0 || o->ways.off[1] != 0))
        put_lens(f, &c, "  ");
    fputs("  \"frames\": [", f);
    for (int i = 0; i < cameras * o->n_frames; i++) {
        const int number = first + i / o->n_frames, frame = i % o->n_frames;

        if (!ted4_ray_is_taken(o, number, frame))
            continue;
        fputs(n++ > 0 ? "," : "", f);
        put_frame(f, o, number, frame);
    }
    fprintf(f, "\n  ]\n}\n");
}

static void put_train(FILE *f, const ted4_ray_options *o, int number, int frame)
{
    (void)number, (void)frame;
    put_transforms(f, o, 0, o->n_train);
}

static void put_test(FILE *f, const ted4_ray_options *o, int number, int frame)
{
    (void)number, (void)frame;
    put_transforms(f, o, o->n_train, o->n_test);
}

/* ---- binary numbers ---- */

static void put_bytes(FILE *f, uint64_t v, int n)
{
    for (int i = 0; i < n; i++)
        putc((int)(v >> 8 * i & 255), f);
}

static void put_float(FILE *f, float x)
{
    uint32_t bits;

    memcpy(&bits, &x, sizeof bits);
    put_bytes(f, bits, 4);
}

static void put_double(FILE *f, double x)
{
    uint64_t bits;

    memcpy(&bits, &x, sizeof bits);
    put_bytes(f, bits, 8);
}

static void put_points(FILE *f, const ted4_ray_options *o, int number, int frame)
{
    (void)number, (void)frame;
    fprintf(f,
            "ply\nformat binary_little_endian 1.0\nelement vertex %d\n"
            "property float x\nproperty float y\nproperty float z\n"
            "property float nx\nproperty float ny\nproperty float nz\n"
            "property uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n",
            ted4_ray_n_points(o));
    for (int i = 0; i < ted4_ray_n_points(o); i++) {
        const ted4_ray_point p = ted4_ray_point_at(o, i);
        const float row[6] = { p.point.x, p.point.y, p.point.z, 0, 0, 0 };

        for (int k = 0; k < 6; k++)
            put_float(f, row[k]);
        fwrite(p.rgb, 1, 3, f);
    }
}

/* ---- poses ---- */

/* World to camera; the axes are right, down, forward. */
static void pose_of(const ted4_ray_camera *c, double R[3][3], double t[3])
{
    static const double sign[3] = { 1, -1, -1 };

    for (int i = 0; i < 3; i++) {
        t[i] = 0;
        for (int j = 0; j < 3; j++) {
            R[i][j] = sign[i] * c->matrix[j][i];
            t[i] -= R[i][j] * c->matrix[j][3];
        }
    }
}

/* Computes (w, x, y, z) from the largest component, which is at least 1/2. */
static void quaternion_of(double R[3][3], double q[4])
{
    const double trace = R[0][0] + R[1][1] + R[2][2];
    double square[4] = { 1 + trace, 0, 0, 0 };
    int k = 0;

    for (int i = 0; i < 3; i++)
        square[i + 1] = 1 + 2 * R[i][i] - trace;
    for (int i = 1; i < 4; i++)
        k = square[i] > square[k] ? i : k;
    /* These are the products 4 q[k] q[i]. */
    const double wv[3] = { R[2][1] - R[1][2], R[0][2] - R[2][0], R[1][0] - R[0][1] };
    q[k] = square[k];
    for (int i = 0; i < 3; i++)
        if (k == 0 || k == i + 1)
            q[k == 0 ? i + 1 : 0] = wv[i];
        else
            q[i + 1] = R[i][k - 1] + R[k - 1][i];
    const double norm = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    for (int i = 0; i < 4; i++)
        q[i] /= norm;
}

/* ---- colmap: one lens for all or one per camera, one image per picture, points without tracks
 * ---- */

static int n_lenses(const ted4_ray_options *o)
{
    return states_each(o) ? n_cameras(o) : 1;
}

static int lens_of(const ted4_ray_options *o, int number)
{
    return states_each(o) ? number + 1 : 1;
}

static void colmap_image(const ted4_ray_options *o, int i, double pose[7], char name[TED4_RAY_NAME])
{
    const int number = i / o->n_frames;
    double R[3][3];
    ted4_ray_camera c;

    ted4_ray_camera_stated(o, number, &c);
    pose_of(&c, R, pose + 4);
    quaternion_of(R, pose);
    ted4_ray_picture_name(o, number, i % o->n_frames, name);
}

static void put_cameras_bin(FILE *f, const ted4_ray_options *o, int number, int frame)
{
    enum { PINHOLE = 1 };
    ted4_ray_camera c;

    (void)number, (void)frame;
    put_bytes(f, (uint64_t)n_lenses(o), 8);
    for (int i = 0; i < n_lenses(o); i++) {
        ted4_ray_camera_stated(o, i, &c);
        put_bytes(f, (uint64_t)i + 1, 4), put_bytes(f, PINHOLE, 4);
        put_bytes(f, (uint64_t)c.width, 8), put_bytes(f, (uint64_t)c.height, 8);
        put_double(f, c.focal), put_double(f, c.focal), put_double(f, c.cx), put_double(f, c.cy);
    }
}

static void put_images_bin(FILE *f, const ted4_ray_options *o, int number, int frame)
{
    const int n = n_cameras(o) * o->n_frames;
    double pose[7];
    char name[TED4_RAY_NAME];

    (void)number, (void)frame;
    put_bytes(f, (uint64_t)n, 8);
    for (int i = 0; i < n; i++) {
        colmap_image(o, i, pose, name);
        put_bytes(f, (uint64_t)i + 1, 4);
        for (int k = 0; k < 7; k++)
            put_double(f, pose[k]);
        put_bytes(f, (uint64_t)lens_of(o, i / o->n_frames), 4);
        fwrite(strchr(name, '/') + 1, 1, strlen(strchr(name, '/')),
               f); /* including the terminating zero */
        put_bytes(f, 0, 8);
    }
}

static void put_points_bin(FILE *f, const ted4_ray_options *o, int number, int frame)
{
    (void)number, (void)frame;
    put_bytes(f, (uint64_t)ted4_ray_n_points(o), 8);
    for (int i = 0; i < ted4_ray_n_points(o); i++) {
        const ted4_ray_point p = ted4_ray_point_at(o, i);

        put_bytes(f, (uint64_t)i + 1, 8);
        put_double(f, (double)p.point.x), put_double(f, (double)p.point.y),
            put_double(f, (double)p.point.z);
        fwrite(p.rgb, 1, 3, f);
        put_double(f, 0);
        put_bytes(f, 0, 8);
    }
}

static void put_cameras_text(FILE *f, const ted4_ray_options *o, int number, int frame)
{
    ted4_ray_camera c;

    (void)number, (void)frame;
    for (int i = 0; i < n_lenses(o); i++) {
        ted4_ray_camera_stated(o, i, &c);
        fprintf(f, "%d PINHOLE %d %d %.17g %.17g %.17g %.17g\n", i + 1, c.width, c.height, c.focal,
                c.focal, c.cx, c.cy);
    }
}

static void put_images_text(FILE *f, const ted4_ray_options *o, int number, int frame)
{
    double pose[7];
    char name[TED4_RAY_NAME];

    (void)number, (void)frame;
    for (int i = 0; i < n_cameras(o) * o->n_frames; i++) {
        colmap_image(o, i, pose, name);
        fprintf(f, "%d", i + 1);
        for (int k = 0; k < 7; k++)
            fprintf(f, " %.17g", pose[k]);
        fprintf(f, " %d %s\n\n", lens_of(o, i / o->n_frames), strchr(name, '/') + 1);
    }
}

static void put_points_text(FILE *f, const ted4_ray_options *o, int number, int frame)
{
    (void)number, (void)frame;
    for (int i = 0; i < ted4_ray_n_points(o); i++) {
        const ted4_ray_point p = ted4_ray_point_at(o, i);

        fprintf(f, "%d %.9g %.9g %.9g %d %d %d 0\n", i + 1, (double)p.point.x, (double)p.point.y,
                (double)p.point.z, p.rgb[0], p.rgb[1], p.rgb[2]);
    }
}

/* ---- hypernerf ---- */

static void put_ids(FILE *f, const ted4_ray_options *o, int first, int cameras)
{
    int n = 0;

    for (int i = 0; i < cameras * o->n_frames; i++) {
        const int number = first + i / o->n_frames, frame = i % o->n_frames;
        char id[40];

        if (!ted4_ray_is_taken(o, number, frame))
            continue;
        flat_name(o, number, frame, "_", id);
        fprintf(f, "%s\"%s\"", n++ > 0 ? ", " : "", id);
    }
}

static void put_dataset(FILE *f, const ted4_ray_options *o, int number, int frame)
{
    (void)number, (void)frame;
    fputs("{\"ids\": [", f);
    put_ids(f, o, 0, n_cameras(o));
    fputs("],\n\"train_ids\": [", f);
    put_ids(f, o, 0, o->n_train);
    fputs("],\n\"val_ids\": [", f);
    put_ids(f, o, o->n_train, o->n_test);
    fputs("]}\n", f);
}

static void put_metadata(FILE *f, const ted4_ray_options *o, int number, int frame)
{
    int n = 0;

    (void)number, (void)frame;
    for (int i = 0; i < n_cameras(o) * o->n_frames; i++) {
        char id[40];

        if (!ted4_ray_is_taken(o, i / o->n_frames, i % o->n_frames))
            continue;
        flat_name(o, i / o->n_frames, i % o->n_frames, "_", id);
        fprintf(f, "%s\"%s\": {\"warp_id\": %d, \"appearance_id\": %d, \"camera_id\": %d}",
                n++ > 0 ? ",\n" : "{", id, i % o->n_frames, i % o->n_frames, i / o->n_frames);
    }
    fputs("}\n", f);
}

static void put_scene(FILE *f, const ted4_ray_options *o, int number, int frame)
{
    const double scale = ted4_ray_scale(o);

    (void)number, (void)frame;
    fprintf(f, "{\"scale\": 1.0, \"center\": [0.0, 0.0, 0.0], \"near\": %.1f, \"far\": %.1f}\n",
            NEAR * scale, FAR * scale);
}

void ted4_ray_hypernerf_camera_name(const ted4_ray_options *o, int number, int frame,
                                    char name[TED4_RAY_NAME])
{
    char id[40];

    flat_name(o, number, frame, "_", id);
    snprintf(name, TED4_RAY_NAME, "camera/%s.json", id);
}

void ted4_ray_put_hypernerf_camera(FILE *f, const ted4_ray_options *o, int number, int frame)
{
    double R[3][3], t[3];
    ted4_ray_camera c;

    (void)frame;
    ted4_ray_camera_stated(o, number, &c);
    pose_of(&c, R, t);
    fputs("{\"orientation\": [", f);
    for (int i = 0; i < 3; i++)
        fprintf(f, "%s[%.17g, %.17g, %.17g]", i > 0 ? ", " : "", R[i][0], R[i][1], R[i][2]);
    fprintf(f,
            "],\n\"position\": [%.17g, %.17g, %.17g],\n\"focal_length\": %.17g, "
            "\"principal_point\": [%.17g, %.17g],\n"
            "\"skew\": 0.0, \"pixel_aspect_ratio\": 1.0, \"radial_distortion\": [0.0, 0.0, 0.0],\n"
            "\"tangential_distortion\": [0.0, 0.0], \"image_size\": [%d, %d]}\n",
            c.matrix[0][3], c.matrix[1][3], c.matrix[2][3], c.focal, c.cx, c.cy, c.width, c.height);
}

/* ---- one clip per camera ---- */

static void put_poses(FILE *f, const ted4_ray_options *o, int number, int frame)
{
    enum { HEADER = 128 }; /* including the 10 bytes before it */
    const double scale = ted4_ray_scale(o);
    char text[HEADER];

    (void)number, (void)frame;
    const int n = snprintf(text, sizeof text,
                           "{'descr': '<f8', 'fortran_order': False, 'shape': (%d, 17), }",
                           n_cameras(o));
    fwrite("\x93NUMPY\x01", 1, 7, f);
    put_bytes(f, 0, 1), put_bytes(f, HEADER - 10, 2);
    fprintf(f, "%-*s\n", HEADER - 11, n > 0 ? text : "");
    for (int i = 0; i < n_cameras(o); i++) {
        ted4_ray_camera c;

        ted4_ray_camera_stated(o, test_first(o, i), &c);
        const double size[3] = { c.height, c.width, c.focal };
        for (int r = 0; r < 3; r++) {
            const double *const m = c.matrix[r]; /* right, up, back, centre */
            put_double(f, -m[1]), put_double(f, m[0]), put_double(f, m[2]), put_double(f, m[3]);
            put_double(f, size[r]);
        }
        put_double(f, NEAR * scale), put_double(f, FAR * scale);
    }
}

static void put_calibration(FILE *f, const ted4_ray_options *o, int number, int frame)
{
    (void)number, (void)frame;
    fputs("{", f);
    if (!o->ways.starts) /* otherwise, clips differ in length */
        fprintf(f, "\"frames\": %d, ", o->n_frames);
    fputs("\"fps\": 30, \"cameras\": [", f);
    for (int i = 0; i < n_cameras(o); i++) {
        double R[3][3], t[3];
        char name[TED4_RAY_NAME];
        ted4_ray_camera c;

        ted4_ray_camera_stated(o, test_first(o, i), &c);
        ted4_ray_camera_name(o, test_first(o, i), name);
        pose_of(&c, R, t);
        fprintf(f, "%s\n{\"name\": \"%s\", ", i > 0 ? "," : "", name);
        if (o->video)
            fprintf(f, "\"video\": \"%s.mp4\", ", name);
        fprintf(f, "\"w\": %d, \"h\": %d,\n", c.width, c.height);
        fprintf(f, " \"K\": [[%.17g, 0, %.17g], [0, %.17g, %.17g], [0, 0, 1]],", c.focal,
                c.cx - 0.5, c.focal, c.cy - 0.5);
        fputs(" \"dist\": [0, 0, 0, 0],\n ", f);
        if (o->ways.starts)
            fprintf(f, "\"start\": %.9g, ", ted4_ray_start(o, test_first(o, i)) / 30.0);
        fputs("\"w2c\": [", f);
        for (int r = 0; r < 3; r++)
            fprintf(f, "[%.17g, %.17g, %.17g, %.17g], ", R[r][0], R[r][1], R[r][2], t[r]);
        fputs("[0, 0, 0, 1]]}", f);
    }
    fputs("\n]}\n", f);
}

/* ---- which files ---- */

static int has_points(const ted4_ray_options *o)
{
    return o->ways.points != RAY_NO_POINTS;
}

/* Test cameras may have no turn, and no time to hold out, among few frames. A list without pictures
 * would be an error where it is read. */
static int has_held_pictures(const ted4_ray_options *o)
{
    for (int i = 0; i < o->n_test * o->n_frames; i++) {
        if (ted4_ray_is_taken(o, o->n_train + i / o->n_frames, i % o->n_frames))
            return 1;
    }
    return 0;
}

static int has_test(const ted4_ray_options *o)
{
    return o->ways.split != RAY_VAL_FILE && has_held_pictures(o);
}

static int has_val(const ted4_ray_options *o)
{
    return o->ways.split == RAY_VAL_FILE && has_held_pictures(o);
}

/* The file by which a folder is recognised as a scene comes last. */
static const ted4_ray_file files[RAY_LAYOUTS][6] = {
    [RAY_BLENDER] = { { "points3d.ply", put_points, 0, 0, has_points },
                      { "transforms_test.json", put_test, 0, 0, has_test },
                      { "transforms_val.json", put_test, 0, 0, has_val },
                      { "transforms_train.json", put_train, 0, 0, NULL } },
    [RAY_NERFSTUDIO] = { { "points3d.ply", put_points, 0, 0, has_points },
                         { "transforms_test.json", put_test, 0, 0, has_test },
                         { "transforms_val.json", put_test, 0, 0, has_val },
                         { "transforms_train.json", put_train, 0, 0, NULL } },
    [RAY_COLMAP] = { { "sparse/0/points3D.bin", put_points_bin, 0, 0, NULL },
                     { "sparse/0/images.bin", put_images_bin, 0, 0, NULL },
                     { "sparse/0/cameras.bin", put_cameras_bin, 0, 0, NULL } },
    [RAY_COLMAP_TEXT] = { { "sparse/0/points3D.txt", put_points_text, 0, 0, NULL },
                          { "sparse/0/images.txt", put_images_text, 0, 0, NULL },
                          { "sparse/0/cameras.txt", put_cameras_text, 0, 0, NULL } },
    [RAY_HYPERNERF] = { { "points3D_downsample.ply", put_points, 0, 0, has_points },
                        { "scene.json", put_scene, 0, 0, NULL },
                        { "metadata.json", put_metadata, 0, 0, NULL },
                        { "dataset.json", put_dataset, 0, 0, NULL } },
    [RAY_NEU3D] = { { "points3D_downsample2.ply", put_points, 0, 0, has_points },
                    { "poses_bounds.npy", put_poses, 0, 0, NULL } },
    [RAY_LLFF] = { { "points3D_downsample2.ply", put_points, 0, 0, has_points },
                   { "poses_bounds.npy", put_poses, 0, 0, NULL } },
    [RAY_CALIBRATION] = { { "points3d.ply", put_points, 0, 0, has_points },
                          { "cams.json", put_calibration, 0, 0, NULL } },
};

const ted4_ray_file *ted4_ray_layout_files(ted4_ray_layout l)
{
    return files[l];
}
