/* colmap_txt.c - reads COLMAP's text model files. See colmap_file.h. Lines that begin with # are
 * comments, and values are separated by spaces:
 *   camera   id model width height parameters
 *   image    id qw qx qy qz tx ty tz camera name, then one line, maybe empty, of observations
 *   point    id x y z r g b error track
 * SPDX-License-Identifier: BSD-2-Clause */
#include "data/colmap_file.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "data/data_util.h"

typedef struct {
    const char *path;
    char *text; /* owned; divided into lines as it is read */
    char *next; /* NULL at the end */
    size_t line;
    char where[600]; /* "path:line" of the line read last */
} text_reader;

static int start(text_reader *r, const char *path, ted4_message *m)
{
    uint8_t *bytes;
    size_t size;

    memset(r, 0, sizeof *r);
    if (ted4_read_whole(path, &bytes, &size, m) != 0)
        return -1;
    r->path = path;
    r->text = (char *)bytes; /* ends in a zero byte */
    r->next = r->text + ted4_mark_size(bytes, size);
    return 0;
}

/* Returns the next line without its line end, or NULL at the end of the file. */
static char *any_line(text_reader *r)
{
    char *line = r->next;

    if (line == NULL || *line == 0)
        return NULL;
    char *end = strchr(line, '\n');
    r->next = end == NULL ? NULL : end + 1;
    if (end != NULL)
        *end = 0;
    line[strcspn(line, "\r")] = 0;
    r->line++;
    snprintf(r->where, sizeof r->where, "%s:%zu", r->path, r->line);
    return line;
}

/* Returns the next line that is neither empty nor a comment, or NULL at the end of the file. */
static char *record_line(text_reader *r)
{
    char *line;

    while ((line = any_line(r)) != NULL) {
        line += strspn(line, " \t");
        if (*line != 0 && *line != '#')
            break;
    }
    return line;
}

/* Reads n numbers and moves *at past them. Returns -1 if there are fewer. */
static int numbers(char **at, double *v, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        char *end;
        v[i] = strtod(*at, &end);
        if (end == *at)
            return -1;
        *at = end;
    }
    return 0;
}

/* Returns the rest of the line without spaces at its ends. */
static char *rest(char *at)
{
    at += strspn(at, " \t");
    size_t n = strlen(at);
    while (n > 0 && (at[n - 1] == ' ' || at[n - 1] == '\t'))
        at[--n] = 0;
    return at;
}

static uint64_t whole(double v)
{
    return v >= 0 && v < 0x1p53 ? (uint64_t)v : 0;
}

static int read_camera(text_reader *r, char *line, ted4_colmap_camera *c, ted4_message *m)
{
    char name[64], *at = line;
    double id, size[2], p[TED4_COLMAP_MAX_PARAMETERS];
    size_t n;
    int used = 0;

    if (numbers(&at, &id, 1) != 0 || sscanf(at, "%63s%n", name, &used) != 1)
        return ted4_say(m, "%s: expected CAMERA_ID MODEL WIDTH HEIGHT PARAMETERS", r->where);
    at += used;
    c->id = (uint32_t)whole(id);
    char where[640];
    snprintf(where, sizeof where, "%s: camera %u", r->where, (unsigned)c->id);
    const int model = ted4_colmap_model_by_name(name, where, &n, m);
    if (model < 0)
        return -1;
    if (numbers(&at, size, 2) != 0 || numbers(&at, p, n) != 0 || *rest(at) != 0)
        return ted4_say(m, "%s: expected WIDTH HEIGHT and %zu parameters of %s", where, n, name);
    return ted4_colmap_set_camera(c, model, whole(size[0]), whole(size[1]), p, where, m);
}

int ted4_colmap_txt_cameras(ted4_colmap *c, const char *path, ted4_message *m)
{
    text_reader r;
    char *line;
    int result = 0;

    if (start(&r, path, m) != 0)
        return -1;
    while (result == 0 && (line = record_line(&r)) != NULL) {
        void *array = c->cameras;
        if (ted4_colmap_reserve(&array, c->n_cameras, sizeof *c->cameras) != 0) {
            result = ted4_say_no_memory(m);
            break;
        }
        c->cameras = array;
        result = read_camera(&r, line, &c->cameras[c->n_cameras++], m);
    }
    free(r.text);
    return result;
}

/* Is this a line of observations, X Y POINT3D_ID each? Most numbers are told by their letters, as
 * such lines make up most of a large file. */
static int is_observations(const char *at)
{
    size_t n = 0;

    for (at += strspn(at, " \t"); *at != 0; at += strspn(at, " \t")) {
        const char *end = at;
        char *parsed;
        while ((*end >= '0' && *end <= '9') || *end == '.')
            end++;
        if (end == at || (*end != 0 && *end != ' ' && *end != '\t')) {
            strtod(at, &parsed);
            end = parsed;
            if (end == at || (*end != 0 && *end != ' ' && *end != '\t'))
                return 0;
        }
        at = end;
        n++;
    }
    return n % 3 == 0;
}

/* Reads the line after that of an image, which may be missing at the end of the file. */
static int read_observations(text_reader *r, ted4_message *m)
{
    const char *line = any_line(r);

    if (line == NULL || is_observations(line))
        return 0;
    return ted4_say(m,
                    "%s: expected the observations of the image on the line before: X Y POINT3D_ID "
                    "for each, or an empty line",
                    r->where);
}

static int read_image(text_reader *r, char *line, ted4_colmap_image *image, ted4_message *m)
{
    char *at = line;
    double id, qt[7], camera;

    memset(image, 0, sizeof *image);
    if (numbers(&at, &id, 1) != 0 || numbers(&at, qt, 7) != 0 || numbers(&at, &camera, 1) != 0 ||
        *rest(at) == 0)
        return ted4_say(m, "%s: expected IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME", r->where);
    image->camera = (uint32_t)whole(camera);
    image->name = ted4_text_copy(rest(at));
    if (image->name == NULL)
        return ted4_say_no_memory(m);
    if (ted4_colmap_set_pose(image, qt, r->where, m) != 0)
        return -1;
    return read_observations(r, m);
}

int ted4_colmap_txt_images(ted4_colmap *c, const char *path, ted4_message *m)
{
    text_reader r;
    char *line;
    int result = 0;

    if (start(&r, path, m) != 0)
        return -1;
    while (result == 0 && (line = record_line(&r)) != NULL) {
        void *array = c->images;
        if (ted4_colmap_reserve(&array, c->n_images, sizeof *c->images) != 0) {
            result = ted4_say_no_memory(m);
            break;
        }
        c->images = array;
        result = read_image(&r, line, &c->images[c->n_images++], m);
    }
    free(r.text);
    return result;
}

static int read_point(text_reader *r, char *line, float *xyz, uint8_t *rgb, ted4_message *m)
{
    char *at = line;
    double v[7];

    if (numbers(&at, v, 7) != 0)
        return ted4_say(m, "%s: expected POINT_ID X Y Z R G B", r->where);
    for (int k = 0; k < 3; k++) {
        xyz[k] = (float)v[1 + k];
        rgb[k] = (uint8_t)(v[4 + k] > 0 ? fmin(v[4 + k], 255) : 0);
        if (!isfinite(xyz[k]))
            return ted4_say(m, "%s: a coordinate is not finite", r->where);
    }
    return 0;
}

/* Returns the number of lines, comments included, which is enough capacity for the points. */
static size_t count_lines(const char *text)
{
    size_t n = 1;

    for (const char *p = text; (p = strchr(p, '\n')) != NULL; p++)
        n++;
    return n;
}

int ted4_colmap_txt_points(ted4_colmap *c, const char *path, ted4_message *m)
{
    text_reader r;
    char *line;
    size_t n = 0;
    int result = 0;

    if (start(&r, path, m) != 0)
        return -1;
    if (ted4_point_cloud_alloc(&c->cloud, count_lines(r.text)) != 0)
        result = ted4_say_no_memory(m);
    while (result == 0 && (line = record_line(&r)) != NULL) {
        result = read_point(&r, line, c->cloud.xyz + 3 * n, c->cloud.rgb + 3 * n, m);
        n++;
    }
    c->cloud.n = n;
    free(r.text);
    return result;
}
