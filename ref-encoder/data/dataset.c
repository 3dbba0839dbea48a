/* dataset.c - the public face of the loaders: recognises the layout, hands out pixels, prints
 * what was found. See dataset.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "data/dataset.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "data/data_util.h"
#include "data/image_cache.h"
#include "data/raw_scene.h"
#include "data/source.h"

/* The first whose probe says yes loads. */
static const struct {
    int         (*probe)(const char *folder);
    ted4_loader *load;
} layouts[] = {
    { ted4_is_transforms, ted4_load_transforms },
    { ted4_is_hypernerf, ted4_load_hypernerf },
    { ted4_is_calibration, ted4_load_calibration },
    { ted4_is_neu3d, ted4_load_neu3d },
    { ted4_is_colmap, ted4_load_colmap },
};

#define LAYOUTS "transforms_train.json, transforms.json (D-NeRF, nerfstudio), dataset.json and camera/ " \
                "(HyperNeRF), cams.json, poses_bounds.npy (Neu3D) or sparse/ (COLMAP)"

static int load_raw(ted4_raw_scene *s, const char *folder, ted4_message *m)
{
    if (!ted4_is_folder(folder))
        return ted4_say(m, "%s: no such folder, expected a scene", folder);
    for (size_t i = 0; i < sizeof layouts / sizeof layouts[0]; i++)
        if (layouts[i].probe(folder))
            return layouts[i].load(s, folder, m);
    return ted4_say(m, "%s: no scene recognised, expected " LAYOUTS, folder);
}

int ted4_dataset_load(ted4_dataset *d, const char *folder, const ted4_dataset_options *o, ted4_message *m)
{
    ted4_raw_scene raw;

    memset(d, 0, sizeof *d);
    memset(&raw, 0, sizeof raw);
    raw.wanted = o;
    m->text[0] = 0;
    int result = load_raw(&raw, folder, m);
    if (result == 0)
        result = ted4_build_dataset(d, &raw, o, m);
    ted4_raw_scene_free(&raw);
    if (result != 0)
        ted4_dataset_free(d);
    return result;
}

void ted4_dataset_free(ted4_dataset *d)
{
    ted4_image_cache_free(d->cache);
    for (size_t i = 0; i < d->n_pictures; i++)
        free(d->pictures[i].path);
    free(d->pictures);
    free(d->sources);
    free(d->points);
    free(d->point_rgb);
    free(d->layout);
    memset(d, 0, sizeof *d);
}

const uint8_t *ted4_dataset_pixels(ted4_dataset *d, size_t i, ted4_message *m)
{
    return ted4_image_cache_pin(d->cache, i, m);
}

void ted4_dataset_release(ted4_dataset *d, size_t i)
{
    ted4_image_cache_unpin(d->cache, i);
}

int ted4_dataset_verify(ted4_dataset *d, ted4_message *m)
{
    for (size_t i = 0; i < d->n_pictures; i++) {
        if (ted4_dataset_pixels(d, i, m) == NULL)
            return -1;
        ted4_dataset_release(d, i);
    }
    return 0;
}

typedef struct { double low, high; } range;

static const range nothing = { INFINITY, -INFINITY };

static void widen(range *r, double v)
{
    r->low = fmin(r->low, v);
    r->high = fmax(r->high, v);
}

static void print_range(FILE *out, range r)
{
    if (r.low == r.high)
        fprintf(out, "%.6g", r.low);
    else
        fprintf(out, "%.6g..%.6g", r.low, r.high);
}

static void print_box(FILE *out, const range r[3])
{
    for (int k = 0; k < 3; k++)
        fprintf(out, "%s[%.4g, %.4g]", k > 0 ? " x " : "", r[k].low, r[k].high);
    fputc('\n', out);
}

static void print_cameras(const ted4_dataset *d, FILE *out)
{
    range width = nothing, height = nothing, fx = nothing, fy = nothing, box[3] = { nothing, nothing, nothing };

    for (size_t i = 0; i < d->n_pictures; i++) {
        const ted4_camera *c = &d->pictures[i].camera;
        double centre[3];
        widen(&width, c->width);
        widen(&height, c->height);
        widen(&fx, c->fx);
        widen(&fy, c->fy);
        ted4_pose_centre(c->R, c->t, centre);
        for (int k = 0; k < 3; k++)
            widen(&box[k], centre[k]);
    }
    fputs("size        ", out);
    print_range(out, width);
    fputs(" x ", out);
    print_range(out, height);
    fputs(" pixels\nfocal       ", out);
    print_range(out, fx);
    fputs(" x ", out);
    print_range(out, fy);
    fputs(" pixels\ncentres     ", out);
    print_box(out, box);
}

void ted4_dataset_print(const ted4_dataset *d, FILE *out)
{
    range box[3] = { nothing, nothing, nothing };
    size_t n_test = 0;

    for (size_t i = 0; i < d->n_pictures; i++)
        n_test += d->pictures[i].is_test;
    fprintf(out, "layout      %s\n", d->layout);
    fprintf(out, "pictures    %zu train, %zu test\n", d->n_pictures - n_test, n_test);
    fprintf(out, "cameras     %u\n", (unsigned)d->n_cameras);
    fprintf(out, "frames      %u\n", (unsigned)d->n_frames);
    print_cameras(d, out);
    for (size_t i = 0; i < 3 * d->n_points; i++)
        widen(&box[i % 3], d->points[i]);
    fprintf(out, "points      %zu%s\nbounds      ", d->n_points, d->random_points ? " (random)" : "");
    print_box(out, box);
    fprintf(out, "background  %d %d %d\n", d->background[0], d->background[1], d->background[2]);
    if (d->rate > 0)
        fprintf(out, "rate        %.6g frames/s\n", d->rate);
    else
        fputs("rate        unknown\n", out);
}
