/* camera_transforms.c - see camera_transforms.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "camera_transforms.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "camera_lens.h"
#include "cams.h"
#include "output.h"
#include "rotation.h"

typedef struct {
    const json_t *file;
    const char *path;
    double applied[12], applied_square; /* similarity that the writer applied to the world */
} transforms;

/* Finds a number of the frame, or else of the whole file. Returns 1 if it is there. */
static int find_number(const transforms *t, const json_t *frame, const char *key, double *out)
{
    const json_t *v = json_object_get(frame, key);

    if (v == NULL)
        v = json_object_get(t->file, key);
    *out = json_number_value(v);
    return json_is_number(v) && isfinite(*out);
}

/* Reads the upper three rows of a 4x4 (or 3x4) matrix. Returns 1 if it is one. */
static int get_rows(const json_t *rows, double out[12])
{
    for (size_t r = 0; r < 3; r++) {
        const json_t *const row = json_array_get(rows, r);

        if (json_array_size(row) != 4)
            return 0;
        for (size_t c = 0; c < 4; c++) {
            const json_t *const v = json_array_get(row, c);

            out[4 * r + c] = json_number_value(v);
            if (!json_is_number(v) || !isfinite(out[4 * r + c]))
                return 0;
        }
    }
    return 1;
}

/* Reads width and height of a PNG file, big-endian numbers at fixed places. Returns 1 if it is
 * one. */
static int png_size(const char *path, double *w, double *h)
{
    uint8_t head[24];
    struct stat s;
    FILE *const f = stat(path, &s) == 0 && S_ISREG(s.st_mode) ? fopen(path, "rb") : NULL;
    const int found = f != NULL && fread(head, sizeof head, 1, f) == 1 &&
                      memcmp(head, "\x89PNG\r\n\x1a\n", 8) == 0;

    if (f != NULL)
        fclose(f);
    if (!found)
        return 0;
    *w = head[16] * 16777216.0 + head[17] * 65536.0 + head[18] * 256.0 + head[19];
    *h = head[20] * 16777216.0 + head[21] * 65536.0 + head[22] * 256.0 + head[23];
    return 1;
}

/* The size that the file says, or that of the frame's picture. */
static int find_size(const transforms *t, const json_t *frame, double *w, double *h)
{
    const char *const name = json_string_value(json_object_get(frame, "file_path"));
    const char *const slash = strrchr(t->path, '/');
    const int folder = slash != NULL ? (int)(slash + 1 - t->path) : 0;
    char path[TED4_PATH_SIZE];

    if (find_number(t, frame, "w", w) && find_number(t, frame, "h", h))
        return 1;
    for (int i = 0; i < 2 && name != NULL; i++) {
        const int n =
            snprintf(path, sizeof path, "%.*s%s%s", folder, t->path, name, i == 0 ? "" : ".png");

        if (n > 0 && n < TED4_PATH_SIZE && png_size(path, w, h))
            return 1;
    }
    return 0;
}

static int is_side(double v)
{
    return v >= 1.0 && v <= TED4_CAMS_SIDE && v == floor(v);
}

static const char *get_lens(const transforms *t, const json_t *frame, ted4_view *v, int *distorted)
{
    double w, h;

    if (!find_size(t, frame, &w, &h) || !is_side(w) || !is_side(h))
        return "needs w and h, whole numbers from 1 to 16384, or its picture as PNG";
    *v = (ted4_view) { .width = (int)w, .height = (int)h };
    return ted4_camera_lens(t->file, frame, v, distorted);
}

/* Undoes the similarity of the writer: x = A^T (y - a) / s^2, for a point, or (without a) a
 * direction. */
static void undo(const transforms *t, double y[3], int is_point)
{
    const double *const A = t->applied;
    double d[3];

    for (int r = 0; r < 3; r++)
        d[r] = y[r] - (is_point ? A[4 * r + 3] : 0.0);
    for (int c = 0; c < 3; c++)
        y[c] = (A[c] * d[0] + A[4 + c] * d[1] + A[8 + c] * d[2]) / t->applied_square;
}

/* transform_matrix goes from camera to world: its columns are right, up, backward and the centre.
 * The rows of R are right, down and forward, and t = -R centre. */
static const char *get_pose(const transforms *t, const json_t *frame, ted4_view *v)
{
    static const double sign[3] = { 1, -1, -1 };
    double m[12], centre[3];

    if (!get_rows(json_object_get(frame, "transform_matrix"), m))
        return "needs transform_matrix, 4 rows of 4 numbers";
    for (int r = 0; r < 3; r++)
        centre[r] = m[4 * r + 3];
    undo(t, centre, 1);
    for (int k = 0; k < 3; k++) {
        double axis[3] = { m[k], m[4 + k], m[8 + k] }, length, along = 0.0;

        undo(t, axis, 0);
        length = sqrt(axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]);
        for (int c = 0; c < 3; c++) {
            const double a = sign[k] * axis[c] / length;

            v->R[3 * k + c] = (float)a;
            along += a * centre[c];
        }
        v->t[k] = (float)-along;
    }
    for (int i = 0; i < 3; i++)
        if (!isfinite(v->t[i]))
            return "is too far away";
    if (!ted4_is_orthogonal(v->R))
        return "has a transform_matrix that is no rotation";
    return ted4_is_rotation(v->R) ? NULL : "has a transform_matrix that is a mirror image";
}

static const char *get_time(const json_t *frame, ted4_listed_camera *c)
{
    const json_t *const time = json_object_get(frame, "time");
    const double t = json_number_value(time);

    c->time = (ted4_time) { 0, 0 };
    if (time == NULL)
        return NULL;
    if (!json_is_number(time) || !(t >= 0.0 && t <= 1.0))
        return "has a time that is not from 0 to 1";
    c->time = ted4_time_of_part(t);
    return NULL;
}

static const char *get_applied(transforms *t)
{
    static const double identity[12] = { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0 };
    const json_t *const rows = json_object_get(t->file, "applied_transform");
    double square = 0.0;

    memcpy(t->applied, identity, sizeof identity);
    if (rows != NULL && !get_rows(rows, t->applied))
        return "applied_transform is not 3 rows of 4 numbers";
    for (int r = 0; r < 3; r++)
        square += t->applied[4 * r] * t->applied[4 * r];
    t->applied_square = square;
    return square > 0.0 && isfinite(square) ? NULL : "applied_transform has no scale";
}

int ted4_transforms_read(const json_t *file, const char *path, ted4_camera_list *l, char *why,
                         size_t why_size)
{
    const json_t *const frames = json_object_get(file, "frames");
    transforms t = { .file = file, .path = path };
    const char *wrong = get_applied(&t);

    l->camera = calloc(json_array_size(frames) + 1, sizeof *l->camera);
    if (wrong == NULL && l->camera == NULL)
        wrong = "out of memory";
    if (wrong == NULL && json_array_size(frames) == 0)
        wrong = "the list of frames is empty";
    if (wrong != NULL)
        snprintf(why, why_size, "%s", wrong);
    for (; wrong == NULL && l->n < json_array_size(frames); l->n++) {
        const json_t *const frame = json_array_get(frames, l->n);
        ted4_listed_camera *const c = &l->camera[l->n];

        wrong = get_lens(&t, frame, &c->view, &l->distorted);
        if (wrong == NULL)
            wrong = get_pose(&t, frame, &c->view);
        if (wrong == NULL)
            wrong = get_time(frame, c);
        if (wrong != NULL)
            snprintf(why, why_size, "frame %zu %s", l->n, wrong);
    }
    return wrong == NULL ? 0 : -1;
}
