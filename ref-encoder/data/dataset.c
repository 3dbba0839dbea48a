/* dataset.c - public interface of the loaders: recognises the layout, provides pixels, and prints a
 * summary. See dataset.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "data/dataset.h"

#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <xxhash.h>
#include "data/data_util.h"
#include "data/image_cache.h"
#include "data/raw_scene.h"
#include "data/source.h"

/* The first layout whose probe succeeds loads the scene. */
static const struct {
    int (*probe)(const char *folder);
    ted4_loader *load;
} layouts[] = {
    { ted4_is_transforms, ted4_load_transforms },
    { ted4_is_hypernerf, ted4_load_hypernerf },
    { ted4_is_calibration, ted4_load_calibration },
    { ted4_is_neu3d, ted4_load_neu3d },
    { ted4_is_llff, ted4_load_llff },
    { ted4_is_colmap, ted4_load_colmap },
};

#define LAYOUTS                                                                              \
    "transforms_train.json, transforms.json (D-NeRF, nerfstudio), dataset.json and camera/ " \
    "(HyperNeRF), cams.json, poses_bounds.npy (Neu3D, LLFF) or sparse/ (COLMAP)"

static int load_raw(ted4_raw_scene *s, const char *folder, ted4_message *m)
{
    if (!ted4_is_folder(folder))
        return ted4_may_read(folder, m) != 0
                   ? -1
                   : ted4_say(m, "%s: no such folder, expected a scene", folder);
    for (size_t i = 0; i < sizeof layouts / sizeof layouts[0]; i++)
        if (layouts[i].probe(folder))
            return layouts[i].load(s, folder, m);
    return ted4_may_read(folder, m) != 0
               ? -1
               : ted4_say(m, "%s: no scene recognised, expected " LAYOUTS, folder);
}

int ted4_dataset_load(ted4_dataset *d, const char *folder, const ted4_dataset_options *o,
                      ted4_message *m)
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
    for (size_t i = 0; i < d->n_warnings; i++)
        free(d->warnings[i]);
    free(d->warnings);
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

void ted4_dataset_ahead(ted4_dataset *d, size_t i)
{
    ted4_image_cache_ahead(d->cache, i, d->ahead);
}

typedef struct {
    ted4_dataset *d;
    pthread_mutex_t lock;
    size_t bad;      /* first picture known to be bad; n_pictures if none */
    ted4_message *m; /* error message of that picture */
} verification;

static double mean_level(const uint8_t *pixels, const ted4_camera *c)
{
    const size_t n = 3 * (size_t)c->width * (size_t)c->height;
    uint64_t sum = 0;

    for (size_t i = 0; i < n; i++)
        sum += pixels[i];
    return (double)sum / (double)n;
}

/* Skips pictures after a known bad one. Those before it are still checked, so that the picture that
 * is named does not depend on the number of threads. */
static void verify_picture(void *arg, size_t i)
{
    verification *v = arg;
    ted4_message m;

    pthread_mutex_lock(&v->lock);
    const int needed = i < v->bad;
    pthread_mutex_unlock(&v->lock);
    if (!needed)
        return;

    const uint8_t *pixels = ted4_dataset_pixels(v->d, i, &m);

    if (pixels != NULL) {
        v->d->sources[i].level = mean_level(pixels, &v->d->pictures[i].camera);
        ted4_dataset_release(v->d, i);
        return;
    }
    pthread_mutex_lock(&v->lock);
    if (i < v->bad) {
        v->bad = i;
        *v->m = m;
    }
    pthread_mutex_unlock(&v->lock);
}

/* With fewer partly transparent pixels than ENOUGH_PARTIAL, it cannot be told whether their colours
 * are premultiplied. Colours count as not premultiplied if more than 1 / FEW of these pixels exceed
 * alpha. */
enum { ENOUGH_PARTIAL = 1000, FEW = 100 };

/* Warns if the pixels contradict the option premultiplied. Returns 0, or -1 if memory runs out. */
static int check_alpha(ted4_dataset *d)
{
    size_t partial = 0, above = 0;
    int premultiplied = 0;

    for (size_t i = 0; i < d->n_pictures; i++) {
        partial += d->sources[i].n_partial;
        above += d->sources[i].n_above;
        premultiplied |= d->sources[i].premultiplied;
    }
    if (partial < ENOUGH_PARTIAL)
        return 0;
    if (!premultiplied && above == 0)
        return ted4_text_add(&d->warnings, &d->n_warnings,
                             "no colour of a pixel that is transparent in part exceeds its alpha: "
                             "colours seem to be premultiplied (--alpha premultiplied)");
    if (premultiplied && above > partial / FEW)
        return ted4_text_add(&d->warnings, &d->n_warnings,
                             "colours of %zu of %zu pixels that are transparent in part exceed "
                             "their alpha: they seem not to be premultiplied (--alpha straight)",
                             above, partial);
    return 0;
}

/* Warns if no training picture shows anything. Returns 0, or -1 if memory runs out. */
static int check_shown(ted4_dataset *d)
{
    size_t n = 0, black = 0, white = 0;

    for (size_t i = 0; i < d->n_pictures; i++) {
        if (d->pictures[i].is_test)
            continue;
        n++;
        black += d->sources[i].level == 0;
        white += d->sources[i].level == 255;
    }
    if (n == 0 || (black < n && white < n))
        return 0;
    return ted4_text_add(&d->warnings, &d->n_warnings,
                         "all training pictures are %s: there is nothing to learn from them",
                         black == n ? "black" : "white");
}

int ted4_dataset_verify(ted4_dataset *d, const ted4_parallel *p, ted4_message *m)
{
    verification v = { .d = d, .bad = d->n_pictures, .m = m };

    pthread_mutex_init(&v.lock, NULL);
    ted4_parallel_for(p, d->n_pictures, verify_picture, &v);
    pthread_mutex_destroy(&v.lock);
    if (v.bad < d->n_pictures)
        return -1;
    d->content = 0;
    for (size_t i = 0; i < d->n_pictures; i++)
        d->content =
            XXH3_64bits_withSeed(&d->sources[i].digest, sizeof d->sources[i].digest, d->content);
    return check_alpha(d) == 0 && check_shown(d) == 0 ? 0 : ted4_say_no_memory(m);
}

static uint64_t add(uint64_t digest, const void *p, size_t size)
{
    return size > 0 ? XXH3_64bits_withSeed(p, size, digest) : digest;
}

/* A pinhole adds nothing: all there is of it is in the camera. */
static uint64_t add_lens(uint64_t digest, const ted4_lens *l)
{
    const double bends[6] = { l->k1, l->k2, l->k3, l->p1, l->p2, l->skew };

    return ted4_lens_is_pinhole(l) ? digest : add(digest, bends, sizeof bends);
}

uint64_t ted4_dataset_digest(const ted4_dataset *d)
{
    uint64_t x = d->content;

    for (size_t i = 0; i < d->n_pictures; i++) {
        const ted4_picture *p = &d->pictures[i];
        const ted4_camera *c = &p->camera;
        const uint32_t whole[5] = { (uint32_t)c->width, (uint32_t)c->height, p->frame, p->camera_id,
                                    p->is_test };
        const double lens[4] = { c->fx, c->fy, c->cx, c->cy };
        x = add(x, whole, sizeof whole);
        x = add(x, lens, sizeof lens);
        x = add(x, c->R, sizeof c->R);
        x = add(x, c->t, sizeof c->t);
        x = add_lens(x, &d->sources[i].lens);
        if (d->sources[i].premultiplied)
            x = add(x, &d->sources[i].premultiplied, sizeof d->sources[i].premultiplied);
    }
    x = add(x, d->points, 3 * d->n_points * sizeof *d->points);
    x = add(x, d->point_rgb, 3 * d->n_points);
    return add(x, d->background, sizeof d->background);
}

typedef struct {
    double low, high;
} range;

static const range nothing = { INFINITY, -INFINITY };

static void widen(range *r, double v)
{
    v = v == 0 ? 0 : v; /* it would be printed as -0 */
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
    range width = nothing, height = nothing, fx = nothing, fy = nothing,
          box[3] = { nothing, nothing, nothing };

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
    fprintf(out, "points      %zu%s\nbounds      ", d->n_points,
            d->random_points ? " (random)" : "");
    if (d->n_points > 0)
        print_box(out, box);
    else
        fputs("none\n", out);
    fprintf(out, "background  %d %d %d\n", d->background[0], d->background[1], d->background[2]);
    if (d->n_frames == 1)
        return;
    if (d->rate > 0)
        fprintf(out, "rate        %.6g frames/s\n", d->rate);
    else
        fputs("rate        unknown\n", out);
}
