/* describe.c - see describe.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "describe.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <png.h>

#include "camera_view.h"
#include "data/data_util.h"
#include "render/png_file.h"
#include "render/view.h"
#include "ted4.h"
#include "tool/cli.h"

/* Cosine of 30 degrees. Cameras that look down at a scene all have an up direction that leans away
 * from it; scenes are hardly ever stored at such an angle. */
#define NEAR_AXIS 0.866

/* Mean up directions that are shorter than this come from cameras that disagree. */
#define AGREED 0.5

static uint8_t *no_memory(char *why, size_t why_size)
{
    snprintf(why, why_size, "out of memory");
    return NULL;
}

void ted4_describe_up(const ted4_dataset *d, float up[3])
{
    double sum[3] = { 0 }, length = 0;
    size_t n = 0, largest = 0;

    for (size_t i = 0; i < d->n_pictures; i++) {
        const ted4_picture *p = &d->pictures[i];

        for (size_t a = 0; a < 3 && !p->is_test; a++)
            sum[a] -= p->camera.R[3 + a]; /* the second camera axis points down */
        n += !p->is_test;
    }
    for (size_t a = 0; a < 3; a++) {
        length += sum[a] * sum[a];
        largest = fabs(sum[a]) > fabs(sum[largest]) ? a : largest;
    }
    length = sqrt(length);
    for (size_t a = 0; a < 3; a++)
        up[a] = n > 0 && length >= AGREED * (double)n ? (float)(sum[a] / length) : 0.0f;
    if (fabs((double)up[largest]) >= NEAR_AXIS)
        for (size_t a = 0; a < 3; a++)
            up[a] = a == largest ? copysignf(1.0f, up[a]) : 0.0f;
}

/* The training pictures of a camera. */
typedef struct {
    size_t n, first;
    int moves; /* 1: they were taken from several places */
} taken;

/* all: one per camera, zeros. */
static void find_taken(const ted4_dataset *d, taken *all)
{
    for (size_t i = 0; i < d->n_pictures; i++) {
        const ted4_picture *p = &d->pictures[i];
        taken *const t = &all[p->camera_id];

        if (p->is_test)
            continue;
        if (t->n++ == 0)
            t->first = i;
        else if (!ted4_camera_same(&d->pictures[t->first].camera, &p->camera))
            t->moves = 1;
    }
}

/* Whether the pictures of a camera are listed with their times: those of a moving one; and a single
 * one, for in many layouts a moving camera is another one at each place. */
static int has_times(const ted4_dataset *d, const taken *t)
{
    return t->moves || (t->n == 1 && d->n_frames > 1);
}

/* Writes the cameras behind the head of a payload; NULL: only counts them. */
static size_t put_taken(const ted4_dataset *d, const taken *all, uint8_t *payload)
{
    size_t n = 0;

    for (size_t i = 0; i < d->n_pictures; i++) {
        const ted4_picture *p = &d->pictures[i];
        const taken *const t = &all[p->camera_id];

        if (p->is_test || (!t->moves && t->first != i))
            continue;
        if (payload != NULL) {
            ted4_cams_camera c = { .view = ted4_view_of_camera(&p->camera) };

            if (has_times(d, t))
                c.time = ted4_time_of_frame(p->frame, d->n_frames);
            ted4_cams_put(payload + TED4_CAMS_HEAD + n * TED4_CAMS_CAMERA, &c);
        }
        n++;
    }
    return n;
}

uint8_t *ted4_describe_taken(const ted4_dataset *d, size_t *size, char *why, size_t why_size)
{
    taken *const all = calloc((size_t)d->n_cameras + 1, sizeof *all);
    uint8_t *payload = NULL;
    float up[3];

    ted4_describe_up(d, up);
    if (all != NULL) {
        find_taken(d, all);

        const size_t n = put_taken(d, all, NULL);

        *size = TED4_CAMS_HEAD + n * TED4_CAMS_CAMERA;
        if (n > TED4_CAMS_MOST)
            snprintf(why, why_size, "%zu cameras, more than the %d of a chunk", n, TED4_CAMS_MOST);
        else if ((payload = malloc(*size)) == NULL)
            no_memory(why, why_size);
        if (payload != NULL) {
            ted4_cams_put_head(payload, up, TED4_CAMS_TAKEN, n);
            put_taken(d, all, payload);
        }
    } else {
        no_memory(why, why_size);
    }
    free(all);
    return payload;
}

uint8_t *ted4_describe_listed(const ted4_camera_list *l, uint32_t n_frames, ted4_cams_kind kind,
                              const float up[3], size_t *size, char *why, size_t why_size)
{
    uint8_t *payload;

    *size = TED4_CAMS_HEAD + l->n * TED4_CAMS_CAMERA;
    if (l->n > TED4_CAMS_MOST) {
        snprintf(why, why_size, "%zu cameras, more than the %d of a chunk", l->n, TED4_CAMS_MOST);
        return NULL;
    }
    for (size_t i = 0; i < l->n; i++) {
        if (l->camera[i].has_frame && l->camera[i].frame >= n_frames) {
            snprintf(why, why_size, "camera %zu: frame %u, but the scene has %u", i,
                     l->camera[i].frame, n_frames);
            return NULL;
        }
    }
    payload = malloc(*size);
    if (payload == NULL)
        return no_memory(why, why_size);
    ted4_cams_put_head(payload, up, kind, l->n);
    for (size_t i = 0; i < l->n; i++) {
        const ted4_listed_camera *from = &l->camera[i];
        const ted4_cams_camera c = { from->view, from->has_frame
                                                     ? ted4_time_of_frame(from->frame, n_frames)
                                                     : from->time };

        ted4_cams_put(payload + TED4_CAMS_HEAD + i * TED4_CAMS_CAMERA, &c);
    }
    return payload;
}

/* ---- thumbnails ---- */

/* Is it a PNG of at most TED4_THUMBNAIL_LARGEST pixels in width and height? Both are big-endian
 * numbers at fixed places of the first chunk, IHDR. */
static int is_thumbnail(const uint8_t *png, size_t size)
{
    static const uint8_t magic[8] = { 0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n' };
    uint32_t side[2];

    if (size < 24 || memcmp(png, magic, sizeof magic) != 0)
        return 0;
    for (int i = 0; i < 2; i++) {
        const uint8_t *p = png + 16 + 4 * i;

        side[i] = (uint32_t)p[0] << 24 | (uint32_t)p[1] << 16 | (uint32_t)p[2] << 8 | p[3];
    }
    return side[0] >= 1 && side[0] <= TED4_THUMBNAIL_LARGEST && side[1] >= 1 &&
           side[1] <= TED4_THUMBNAIL_LARGEST;
}

/* Can all of a thumbnail be decoded? */
static int is_whole(const uint8_t *png, size_t size)
{
    png_image image = { .version = PNG_IMAGE_VERSION };
    uint8_t *pixels;
    int whole;

    if (!png_image_begin_read_from_memory(&image, png, size))
        return 0;
    image.format = PNG_FORMAT_RGBA;
    pixels = malloc(PNG_IMAGE_SIZE(image));
    whole = pixels != NULL && png_image_finish_read(&image, NULL, pixels, 0, NULL) != 0;
    png_image_free(&image);
    free(pixels);
    return whole;
}

uint8_t *ted4_describe_png(const char *path, size_t *size, char *why, size_t why_size)
{
    uint8_t *png = ted4_read_file(path, size);

    if (png == NULL) {
        snprintf(why, why_size, "%s", strerror(errno));
        return NULL;
    }
    if (!is_thumbnail(png, *size))
        snprintf(why, why_size, "expected a PNG file of at most %d x %d pixels",
                 TED4_THUMBNAIL_LARGEST, TED4_THUMBNAIL_LARGEST);
    else if (!is_whole(png, *size))
        snprintf(why, why_size, "a PNG file that is cut short or damaged");
    else
        return png;
    free(png);
    return NULL;
}

/* The view of the first training picture, scaled to at most TED4_THUMBNAIL_MADE pixels, which are
 * wider than those of training (annex I.4). */
static ted4_view small_view(const ted4_dataset *d)
{
    size_t i = 0;

    while (i + 1 < d->n_pictures && d->pictures[i].is_test)
        i++;

    ted4_view v = ted4_view_of_camera(&d->pictures[i].camera);
    const int longer = v.width > v.height ? v.width : v.height;
    const float s = longer > TED4_THUMBNAIL_MADE ? (float)TED4_THUMBNAIL_MADE / (float)longer
                                                 : 1.0f;

    v.width = (int)fmaxf(1.0f, rintf((float)v.width * s));
    v.height = (int)fmaxf(1.0f, rintf((float)v.height * s));
    v.fx *= s;
    v.fy *= s;
    v.cx *= s;
    v.cy *= s;
    v.pixel = 1.0f / s;
    return v;
}

static ted4_status draw(const uint8_t *file, size_t size, const ted4_view *v,
                        const ted4_parallel *p, uint8_t *rgb)
{
    const ted4_options options = { .parallel = p };
    ted4_error e = { TED4_OK, 0 };
    ted4_viewer *viewer = ted4_viewer_new();
    ted4_scene *scene = NULL;
    ted4_recon *recon = NULL;
    ted4_info info;

    if (viewer == NULL)
        e.code = TED4_E_LIMIT_MEMORY;
    else if (ted4_decode(file, size, &options, &scene, &e) == TED4_OK) {
        ted4_scene_info(scene, &info);
        e.code = ted4_recon_new(&recon, scene, &options);
    }
    if (e.code == TED4_OK) {
        const ted4_time t = ted4_time_of_frame(info.frames / 2, info.frames);

        e.code = ted4_render_query(viewer, recon, &info, t.num, t.den, v, p, rgb);
    }
    ted4_recon_free(recon);
    ted4_scene_free(scene);
    ted4_viewer_free(viewer);
    return e.code;
}

uint8_t *ted4_describe_thumbnail(const uint8_t *file, size_t file_size, const ted4_dataset *d,
                                 const ted4_parallel *p, size_t *size, char *why, size_t why_size)
{
    const ted4_view v = small_view(d);
    uint8_t *rgb = malloc(3 * (size_t)v.width * (size_t)v.height), *png = NULL;

    if (rgb == NULL)
        return no_memory(why, why_size);

    const ted4_status status = draw(file, file_size, &v, p, rgb);

    if (status != TED4_OK)
        snprintf(why, why_size, "the thumbnail cannot be rendered: %s", ted4_status_id(status));
    else
        png = ted4_png_encode(v.width, v.height, rgb, size, why, why_size);
    free(rgb);
    return png;
}
