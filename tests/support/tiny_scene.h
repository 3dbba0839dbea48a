/* tiny_scene.h - writes scenes of a few pixels into a temporary folder, for tests of what reads
 * datasets. A failure to write ends the test program.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_TINY_SCENE_H
#define TED4_TINY_SCENE_H

#include <dirent.h>
#include <png.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include "data/data_util.h"
#include "temporary.h"

enum { TINY_W = 16, TINY_H = 12 };

typedef struct {
    char path[256];
} tiny_folder;

static inline void must(int ok, const char *what)
{
    if (!ok) {
        perror(what);
        exit(1);
    }
}

static inline tiny_folder tiny_new(void)
{
    tiny_folder f;

    temporary_folder(f.path, "ted4-test");
    return f;
}

static inline void tiny_remove_path(const char *path)
{
    DIR *d = opendir(path);

    for (struct dirent *e = d == NULL ? NULL : readdir(d); e != NULL; e = readdir(d)) {
        struct stat s;
        if (strcmp(e->d_name, ".") == 0 || strcmp(e->d_name, "..") == 0)
            continue;
        char *child = ted4_path_join(path, e->d_name);
        must(child != NULL, path);
        if (lstat(child, &s) == 0 && S_ISDIR(s.st_mode))
            tiny_remove_path(child);
        else
            remove(child);
        free(child);
    }
    if (d != NULL)
        closedir(d);
    rmdir(path);
}

static inline void tiny_free(tiny_folder *f)
{
    tiny_remove_path(f->path);
}

/* Full path of name; makes the folders on the way. The text stays valid for the next seven
 * calls. */
static inline const char *tiny_path(const tiny_folder *f, const char *name)
{
    static char text[8][1024];
    static int turn;
    char *p = text[turn++ % 8];

    snprintf(p, sizeof text[0], "%s/%s", f->path, name);
    for (char *s = p + strlen(f->path) + 1; (s = strchr(s, '/')) != NULL; *s++ = '/') {
        *s = 0;
        mkdir(p, 0777);
    }
    return p;
}

static inline void tiny_bytes(const tiny_folder *f, const char *name, const void *bytes, size_t n)
{
    FILE *o = fopen(tiny_path(f, name), "wb");

    must(o != NULL && fwrite(bytes, 1, n, o) == n && fclose(o) == 0, name);
}

static inline void tiny_text(const tiny_folder *f, const char *name, const char *text)
{
    tiny_bytes(f, name, text, strlen(text));
}

static inline size_t tiny_size(const tiny_folder *f, const char *name)
{
    struct stat s;

    must(stat(tiny_path(f, name), &s) == 0, name);
    return (size_t)s.st_size;
}

static inline void tiny_png(const tiny_folder *f, const char *name, int w, int h, uint32_t format,
                            const uint8_t *px)
{
    png_image p;

    memset(&p, 0, sizeof p);
    p.version = PNG_IMAGE_VERSION;
    p.width = (png_uint_32)w;
    p.height = (png_uint_32)h;
    p.format = format;
    must(png_image_write_to_file(&p, tiny_path(f, name), 0, px, 0, NULL), name);
}

/* An RGB picture whose pixels encode column, row and k. */
static inline void tiny_picture(const tiny_folder *f, const char *name, int w, int h, int k)
{
    uint8_t *px = malloc((size_t)w * (size_t)h * 3);

    must(px != NULL, name);
    for (int i = 0; i < w * h; i++) {
        px[3 * i] = (uint8_t)(i % w * 255 / w);
        px[3 * i + 1] = (uint8_t)(i / w * 255 / h);
        px[3 * i + 2] = (uint8_t)k;
    }
    tiny_png(f, name, w, h, PNG_FORMAT_RGB, px);
    free(px);
}

/* A growing text. */
typedef struct {
    char text[32768];
    size_t n;
} tiny_string;

static inline void tiny_add(tiny_string *s, const char *format, ...)
{
    va_list a;

    va_start(a, format);
    s->n += (size_t)vsnprintf(s->text + s->n, sizeof s->text - s->n, format, a);
    va_end(a);
    must(s->n < sizeof s->text, "tiny_add");
}

/* Adds a frame to the list of a transforms_*.json: a picture without its extension, from a camera
 * at (x, 0, z) that looks along -z. */
static inline void tiny_frame(tiny_string *s, int is_first, const char *picture, double time, int x,
                              int z)
{
    tiny_add(s,
             "%s{\"file_path\": \"./%s\", \"time\": %.9f, \"transform_matrix\": "
             "[[1,0,0,%d],[0,1,0,0],[0,0,1,%d],[0,0,0,1]]}",
             is_first ? "" : ", ", picture, time, x, z);
}

/* A growing little-endian record. */
typedef struct {
    uint8_t bytes[16384];
    size_t n;
} tiny_record;

static inline void tiny_put(tiny_record *r, uint64_t v, size_t size)
{
    for (size_t i = 0; i < size; i++)
        r->bytes[r->n++] = (uint8_t)(v >> (8 * i));
}

static inline void tiny_put_real(tiny_record *r, double v)
{
    uint64_t bits;

    memcpy(&bits, &v, sizeof bits);
    tiny_put(r, bits, 8);
}

#define TINY_POSE "[[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]"

static const ted4_dataset_options tiny_options = {
    .downscale = 1, .white = 1, .seed = 7, .cache_bytes = 1 << 20
};

/* Loads a dataset. Returns the message of a failure, or "". */
static inline const char *tiny_load(ted4_dataset *d, const tiny_folder *f,
                                    const ted4_dataset_options *o)
{
    static ted4_message m;

    return ted4_dataset_load(d, f->path, o, &m) == 0 ? "" : m.text;
}

#endif
