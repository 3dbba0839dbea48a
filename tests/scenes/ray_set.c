/* ray_set.c - pictures, transforms and points of a scene, in files.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "ray_set.h"

#include <errno.h>
#include <png.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { MAX_PATH = 1024 };
/* Half width of the noise added to the points, in units; two thirds of a default pixel at the
 * middle. */
static const float point_noise = 0.015f;

/* One of the two splits of a set. */
typedef struct {
    const char *name;
    int cameras, is_test;
} split;

static split split_of(const ted4_ray_options *o, int is_test)
{
    if (is_test)
        return (split){ "test", o->n_test, 1 };
    return (split){ "train", o->n_train, 0 };
}

static void camera_of(const ted4_ray_options *o, const split *s, int i, ted4_ray_camera *c)
{
    if (s->is_test)
        ted4_ray_camera_test(c, i, o->n_test, o->n_train, o->width, o->height);
    else
        ted4_ray_camera_train(c, i, o->n_train, o->width, o->height);
}

/* "train/r_003_07", wide enough that names sort as numbers. */
static void picture_name(const ted4_ray_options *o, const split *s, const int camera_frame[2],
                         char name[64])
{
    const char *const format = o->n_frames > 100 ? "%s/r_%03d_%03d" : "%s/r_%03d_%02d";

    snprintf(name, 64, format, s->name, camera_frame[0], camera_frame[1]);
}

static int complain(ted4_ray_message *m, const char *path, const char *why)
{
    snprintf(m->text, sizeof m->text, "%s: %s", path, why);
    return -1;
}

static int join(char path[MAX_PATH], const char *folder, const char *name, ted4_ray_message *m)
{
    if (snprintf(path, MAX_PATH, "%s/%s", folder, name) < MAX_PATH)
        return 0;
    return complain(m, folder, "the path is too long");
}

/* Makes path and the folders above it. */
static int make_folders(const char *path, ted4_ray_message *m)
{
    char part[MAX_PATH];
    const size_t size = strlen(path);

    if (size == 0 || size >= MAX_PATH)
        return complain(m, size == 0 ? "folder" : path,
                        size == 0 ? "has no name" : "the path is too long");
    for (size_t i = 1; i <= size; i++) {
        if (path[i] != '/' && path[i] != '\0')
            continue;
        memcpy(part, path, i);
        part[i] = '\0';
        if (mkdir(part, 0777) != 0 && errno != EEXIST)
            return complain(m, part, strerror(errno));
    }
    return 0;
}

/* ---- pictures: one job each, which finds its place from its index alone ---- */

typedef struct {
    const ted4_ray_options *o;
    const char *folder;
    ted4_ray_message *failure; /* [n_train + n_test][n_frames] one a job, empty when fine */
} pictures;

static int write_png(const char *path, const ted4_ray_camera *c, const uint8_t *rgb,
                     ted4_ray_message *m)
{
    png_image png = { .version = PNG_IMAGE_VERSION, .format = PNG_FORMAT_RGB,
                      .width = (png_uint_32)c->width, .height = (png_uint_32)c->height };

    if (png_image_write_to_file(&png, path, 0, rgb, 0, NULL) == 0)
        return complain(m, path, png.message);
    return 0;
}

static void picture_job(void *arg, size_t i)
{
    const pictures *const job = arg;
    const ted4_ray_options *const o = job->o;
    const int number = (int)(i / (size_t)o->n_frames), frame = (int)(i % (size_t)o->n_frames);
    const split s = split_of(o, number >= o->n_train);
    const int place[2] = { s.is_test ? number - o->n_train : number, frame };
    uint8_t *const rgb = malloc((size_t)o->width * (size_t)o->height * 3);
    ted4_ray_camera camera;
    ted4_ray_world world;
    char name[64], file[72], path[MAX_PATH];

    picture_name(o, &s, place, name);
    snprintf(file, sizeof file, "%s.png", name);
    camera_of(o, &s, place[0], &camera);
    ted4_ray_world_at(&world, o->scene, o->seed, frame, o->n_frames);
    if (rgb == NULL) {
        complain(&job->failure[i], file, "out of memory");
    } else if (join(path, job->folder, file, &job->failure[i]) == 0) {
        ted4_ray_render(&world, &camera, rgb);
        write_png(path, &camera, rgb, &job->failure[i]);
    }
    free(rgb);
}

static int write_pictures(const ted4_ray_options *o, const char *folder, const ted4_parallel *p,
                          ted4_ray_message *m)
{
    const size_t n = (size_t)(o->n_train + o->n_test) * (size_t)o->n_frames;
    pictures job = { o, folder, calloc(n, sizeof *job.failure) };
    int status = 0;

    if (job.failure == NULL)
        return complain(m, folder, "out of memory");
    ted4_parallel_for(p, n, picture_job, &job);
    for (size_t i = 0; i < n && status == 0; i++) {
        if (job.failure[i].text[0] != '\0') {
            *m = job.failure[i];
            status = -1;
        }
    }
    free(job.failure);
    return status;
}

/* ---- transforms ---- */

static void put_transforms(FILE *f, const ted4_ray_options *o, const split *s)
{
    const int n = s->cameras * o->n_frames;

    fprintf(f, "{\n  \"camera_angle_x\": %.17g,\n  \"frames\": [", ted4_ray_angle_x);
    for (int i = 0; i < n; i++) {
        const int place[2] = { i / o->n_frames, i % o->n_frames };
        ted4_ray_camera c;
        char name[64];

        camera_of(o, s, place[0], &c);
        picture_name(o, s, place, name);
        fprintf(f, "%s\n    {\n      \"file_path\": \"./%s\",\n      \"time\": %.17g,\n"
                "      \"transform_matrix\": [", i > 0 ? "," : "", name,
                ted4_ray_time(place[1], o->n_frames));
        for (int r = 0; r < 4; r++)
            fprintf(f, "%s\n        [%.17g, %.17g, %.17g, %.17g]", r > 0 ? "," : "",
                    c.matrix[r][0], c.matrix[r][1], c.matrix[r][2], c.matrix[r][3]);
        fprintf(f, "\n      ]\n    }");
    }
    fprintf(f, "\n  ]\n}\n");
}

static void put_train(FILE *f, const ted4_ray_options *o)
{
    const split s = split_of(o, 0);

    put_transforms(f, o, &s);
}

static void put_test(FILE *f, const ted4_ray_options *o)
{
    const split s = split_of(o, 1);

    put_transforms(f, o, &s);
}

/* ---- points ---- */

ted4_ray_point ted4_ray_point_at(const ted4_ray_options *o, int i)
{
    const uint32_t seed = o->seed + 77;
    ted4_ray_point p = { .camera = i % o->n_train };
    ted4_ray_camera c;
    ted4_ray_world w;
    ted4_ray_sight s;

    p.frame = (int)(ray_hash(i, 0, 0, seed) % (uint32_t)o->n_frames);
    ted4_ray_camera_train(&c, p.camera, o->n_train, o->width, o->height);
    ted4_ray_world_at(&w, o->scene, o->seed, p.frame, o->n_frames);
    s = ted4_ray_look(&w, &c, (double)ray_random(i, 1, 0, seed) * o->width,
                      (double)ray_random(i, 2, 0, seed) * o->height);
    ted4_ray_bytes(s.colour, p.rgb);
    p.point = v3_along(s.point,
                       v3(ray_random(i, 3, 0, seed) - 0.5f, ray_random(i, 4, 0, seed) - 0.5f,
                          ray_random(i, 5, 0, seed) - 0.5f),
                       2 * point_noise);
    return p;
}

static void put_float(FILE *f, float x)
{
    uint32_t bits;

    memcpy(&bits, &x, sizeof bits);
    for (int i = 0; i < 4; i++)
        putc((int)(bits >> 8 * i & 255), f);
}

static void put_points(FILE *f, const ted4_ray_options *o)
{
    fprintf(f,
            "ply\nformat binary_little_endian 1.0\nelement vertex %d\n"
            "property float x\nproperty float y\nproperty float z\n"
            "property float nx\nproperty float ny\nproperty float nz\n"
            "property uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n",
            TED4_RAY_POINTS);
    for (int i = 0; i < TED4_RAY_POINTS; i++) {
        const ted4_ray_point p = ted4_ray_point_at(o, i);
        const float row[6] = { p.point.x, p.point.y, p.point.z, 0, 0, 0 };

        for (int k = 0; k < 6; k++)
            put_float(f, row[k]);
        fwrite(p.rgb, 1, 3, f);
    }
}

/* ---- the folder ---- */

typedef struct {
    const char *name;
    void (*put)(FILE *f, const ted4_ray_options *o);
} text_file;

/* The transforms come last: without them a folder is not taken for a scene. */
static const text_file files[3] = { { "points3d.ply", put_points },
                                    { "transforms_test.json", put_test },
                                    { "transforms_train.json", put_train } };

static int write_file(const ted4_ray_options *o, const char *folder, const text_file *file,
                      ted4_ray_message *m)
{
    char path[MAX_PATH];
    FILE *f;
    int broken;

    if (join(path, folder, file->name, m) != 0)
        return -1;
    f = fopen(path, "wb");
    if (f == NULL)
        return complain(m, path, strerror(errno));
    file->put(f, o);
    broken = ferror(f);
    if (fclose(f) != 0 || broken)
        return complain(m, path, "cannot write all of it (disk full?)");
    return 0;
}

static int remove_file(const char *folder, const char *name, ted4_ray_message *m)
{
    char path[MAX_PATH];

    if (join(path, folder, name, m) != 0)
        return -1;
    if (unlink(path) != 0 && errno != ENOENT)
        return complain(m, path, strerror(errno));
    return 0;
}

int ted4_ray_write(const ted4_ray_options *o, const char *folder, const ted4_parallel *p,
                   ted4_ray_message *m)
{
    char path[MAX_PATH];

    m->text[0] = '\0';
    if (make_folders(folder, m) != 0)
        return -1;
    for (int is_test = 0; is_test < 2; is_test++) {
        if (join(path, folder, split_of(o, is_test).name, m) != 0 || make_folders(path, m) != 0)
            return -1;
    }
    for (int i = 0; i < 3; i++) {
        if (remove_file(folder, files[i].name, m) != 0)
            return -1;
    }
    if (write_pictures(o, folder, p, m) != 0)
        return -1;
    for (int i = 0; i < 3; i++) {
        if (write_file(o, folder, &files[i], m) != 0)
            return -1;
    }
    return 0;
}
