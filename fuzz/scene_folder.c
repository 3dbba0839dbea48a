/* scene_folder.c - see scene_folder.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "scene_folder.h"

#include <math.h>
#include <png.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include "data/image_file.h"
#include "data/video.h"
#include "harness.h"

enum { MOST = 64, CAPACITY = 512 };

/* What was written, so that it can be removed. */
static struct {
    char base[CAPACITY];  /* empty: not created yet */
    char scene[CAPACITY]; /* the folder chosen last */
    char made[MOST][CAPACITY];
    int n;
} folder;

/* A clip that is a video would be unpacked by another program, which must not run here. This
 * function is linked in its place (-Wl,--wrap); since the linker compares no types, it is declared
 * with __typeof__. */
extern __typeof__(ted4_video_unpack) __wrap_ted4_video_unpack;

char *__wrap_ted4_video_unpack(const char *video, size_t most, const ted4_dataset_options *o,
                               ted4_message *m)
{
    (void)most;
    (void)o;
    (void)snprintf(m->text, sizeof m->text, "%.900s: no videos while fuzzing", video);
    return NULL;
}

static void remove_all(void)
{
    while (folder.n > 0)
        (void)remove(folder.made[--folder.n]);
    (void)rmdir(folder.base);
}

static void note(const char *path)
{
    for (int i = 0; i < folder.n; i++)
        if (strcmp(folder.made[i], path) == 0)
            return;
    fuzz_require(folder.n < MOST, "room for names");
    (void)snprintf(folder.made[folder.n++], CAPACITY, "%.500s", path);
}

const char *fuzz_scene(const char *name)
{
    const char *base = getenv("TMPDIR");

    if (folder.base[0] == 0) {
        (void)snprintf(folder.base, sizeof folder.base, "%s/ted4fuzzXXXXXX",
                       base != NULL ? base : "/tmp");
        fuzz_require(mkdtemp(folder.base) != NULL, "a folder for scenes");
        (void)atexit(remove_all);
    }
    (void)snprintf(folder.scene, sizeof folder.scene, "%.300s/%.50s", folder.base, name);
    if (mkdir(folder.scene, 0700) == 0)
        note(folder.scene);
    return folder.scene;
}

static const char *path_of(const char *name)
{
    static char path[CAPACITY];

    (void)snprintf(path, sizeof path, "%.400s/%.100s", folder.scene, name);
    for (char *s = path + strlen(folder.scene) + 1; (s = strchr(s, '/')) != NULL; *s++ = '/') {
        *s = 0;
        if (mkdir(path, 0700) == 0)
            note(path);
    }
    note(path);
    return path;
}

void fuzz_no_file(const char *name)
{
    (void)remove(path_of(name));
}

const char *fuzz_file(const char *name, const void *bytes, size_t size)
{
    const char *path = path_of(name);
    FILE *const f = fopen(path, "wb");

    fuzz_require(f != NULL && fwrite(bytes, 1, size, f) == size && fclose(f) == 0,
                 "a file of a scene");
    return path;
}

const char *fuzz_text(const char *name, const char *text)
{
    return fuzz_file(name, text, strlen(text));
}

const char *fuzz_picture(const char *name)
{
    static const uint8_t pixels[12] = { 255, 0, 0, 0, 255, 0, 0, 0, 255, 90, 90, 90 };
    const char *path = path_of(name);
    png_image p;

    memset(&p, 0, sizeof p);
    p.version = PNG_IMAGE_VERSION;
    p.width = p.height = 2;
    p.format = PNG_FORMAT_RGB;
    fuzz_require(png_image_write_to_file(&p, path, 0, pixels, 0, NULL) != 0,
                 "a picture of a scene");
    return path;
}

void fuzz_check_message(const ted4_message *m)
{
    fuzz_require(memchr(m->text, 0, sizeof m->text) != NULL && m->text[0] != 0, "a message");
}

static int all_finite(const double *v, size_t n)
{
    for (size_t i = 0; i < n; i++)
        if (!isfinite(v[i]))
            return 0;
    return 1;
}

static void check_pictures(const ted4_dataset *d)
{
    for (size_t i = 0; i < d->n_pictures; i++) {
        const ted4_picture *p = &d->pictures[i];
        const ted4_camera *c = &p->camera;
        const double lens[4] = { c->fx, c->fy, c->cx, c->cy };

        fuzz_require(c->width >= 1 && c->height >= 1 && c->width <= TED4_IMAGE_MAX_SIDE &&
                         c->height <= TED4_IMAGE_MAX_SIDE,
                     "sizes");
        fuzz_require(all_finite(lens, 4) && c->fx > 0 && c->fy > 0, "a lens");
        fuzz_require(all_finite(c->R, 9) && all_finite(c->t, 3), "a pose");
        fuzz_require(p->frame < d->n_frames && p->camera_id < d->n_cameras && p->path != NULL,
                     "frame and camera");
    }
}

static void check_dataset(ted4_dataset *d)
{
    ted4_message m;

    fuzz_require(d->n_pictures > 0 && d->n_frames > 0 && d->n_cameras > 0 && d->layout != NULL,
                 "a dataset");
    fuzz_require(d->pictures[0].is_test == 0, "a picture to train on");
    fuzz_require(isfinite(d->rate) && d->rate >= 0, "a rate");
    check_pictures(d);
    for (size_t i = 0; i < 3 * d->n_points; i++)
        fuzz_require(isfinite(d->points[i]), "points");
    (void)ted4_dataset_digest(d);
    if (ted4_dataset_pixels(d, 0, &m) != NULL)
        ted4_dataset_release(d, 0);
    else
        fuzz_check_message(&m);
}

int fuzz_load_scene(void)
{
    static const ted4_dataset_options o = {
        .downscale = 1, .white = 1, .seed = 7, .cache_bytes = 1 << 20
    };
    ted4_dataset d;
    ted4_message m;
    const int result = ted4_dataset_load(&d, folder.scene, &o, &m);

    fuzz_require(result == 0 || result == -1, "0 or -1");
    if (result == 0)
        check_dataset(&d);
    else {
        fuzz_check_message(&m);
        fuzz_require(d.pictures == NULL && d.n_pictures == 0 && d.points == NULL,
                     "an empty dataset");
    }
    ted4_dataset_free(&d);
    return result;
}
