/* build_dataset.c - turns the shots of any layout into a dataset: reconciles the sizes of lenses
 * and files, numbers frames and physical cameras, puts training pictures before test pictures, and
 * takes or draws the initial points. See raw_scene.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "data/raw_scene.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "data/data_util.h"
#include "data/source.h"

/* Is width x height equal to the lens's size divided by an integer *n, rounded up or down? */
static int is_fraction(const ted4_lens *l, int width, int height, int *n)
{
    *n = (l->width + width / 2) / width;
    return *n >= 1 && fabs((double)l->width / *n - width) < 1 &&
           fabs((double)l->height / *n - height) < 1;
}

/* Scales the lens to the file's size. A file may be smaller than stated by an integer factor (the
 * images_2 folders of static sets); both are taken to cover the same field of view. */
static int fit_lens(ted4_shot *s, ted4_message *m)
{
    ted4_lens *l = &s->lens;
    int n;
    const double ax = (double)s->width / l->width, ay = (double)s->height / l->height;

    if (!(isfinite(l->fx) && isfinite(l->fy) && l->fx > 0 && l->fy > 0))
        return ted4_say(m, "%s: focal lengths %g, %g, expected positive numbers", s->path, l->fx,
                        l->fy);
    if (!(isfinite(l->cx) && isfinite(l->cy)))
        return ted4_say(m, "%s: principal point %g, %g is not finite", s->path, l->cx, l->cy);
    if (!(isfinite(l->k1) && isfinite(l->k2) && isfinite(l->p1) && isfinite(l->p2) &&
          isfinite(l->k3) && isfinite(l->skew)))
        return ted4_say(m, "%s: a distortion coefficient is not finite", s->path);
    if (!is_fraction(l, s->width, s->height, &n))
        return ted4_say(m,
                        "%s: the file is %dx%d%s, its camera says %dx%d, expected the same or an "
                        "integer fraction of it",
                        s->path, s->width, s->height,
                        s->orientation >= 5 && is_fraction(l, s->height, s->width, &n)
                            ? " (EXIF turns it by a quarter when shown; turn the pixels themselves)"
                            : "",
                        l->width, l->height);
    l->fx *= ax;
    l->cx *= ax;
    l->skew *= ax;
    l->fy *= ay;
    l->cy *= ay;
    l->width = s->width;
    l->height = s->height;
    return 0;
}

/* Camera distances beyond this could make values that are derived from the pose infinite. */
static const double FARTHEST = 1e15;

static int check_pose(const ted4_shot *s, ted4_message *m)
{
    for (int i = 0; i < 9; i++)
        if (!isfinite(s->R[i]))
            return ted4_say(m, "%s: its camera's rotation holds a value that is not finite",
                            s->path);
    for (int i = 0; i < 3; i++)
        if (!(fabs(s->t[i]) <= FARTHEST))
            return ted4_say(m, "%s: its camera is %g units away, expected at most %g", s->path,
                            fabs(s->t[i]), FARTHEST);
    return 0;
}

/* Divides the wanted reduction by that of the files. Files that are reduced by more than is wanted
 * are used as they are. */
static int left_to_reduce(const ted4_raw_scene *s, int downscale, int *n, ted4_message *m)
{
    const int done = s->reduced > 1 ? s->reduced : 1;

    *n = done > 1 && downscale < done ? 1 : downscale / done;
    if (downscale > done && downscale % done != 0)
        return ted4_say(
            m,
            "%s: the finest pictures are reduced by %d, a reduction by %d cannot be made of them",
            s->shots[0].path, done, downscale);
    return 0;
}

static int make_picture(ted4_picture *p, ted4_source *source, ted4_shot *s, int n,
                        const ted4_dataset_options *o, ted4_message *m)
{
    ted4_camera *c = &p->camera;

    if (fit_lens(s, m) != 0 || check_pose(s, m) != 0)
        return -1;
    if (n < 1 || s->width / n < 1 || s->height / n < 1)
        return ted4_say(m, "%s: a picture of %dx%d cannot be reduced by %d", s->path, s->width,
                        s->height, n);
    c->width = s->width / n;
    c->height = s->height / n;
    c->fx = s->lens.fx / n;
    c->fy = s->lens.fy / n;
    c->cx = s->lens.cx / n;
    c->cy = s->lens.cy / n;
    memcpy(c->R, s->R, sizeof c->R);
    memcpy(c->t, s->t, sizeof c->t);
    p->is_test = s->is_test != 0;
    p->path = s->path;
    s->path = NULL;
    source->path = p->path;
    source->lens = s->lens;
    source->downscale = n;
    source->background = o->white ? 255 : 0;
    source->premultiplied = o->premultiplied && s->has_alpha;
    return 0;
}

/* Pictures with equal labels come from the same camera. */
typedef struct {
    const char *label;
    uint32_t picture;
} labelled;

static int by_label(const void *a, const void *b)
{
    const labelled *x = a, *y = b;
    const int order = strcmp(x->label, y->label);

    return order != 0 ? order : (x->picture > y->picture) - (x->picture < y->picture);
}

/* Numbers the cameras in the order of their first pictures. shots[i] belongs to d->pictures[i]. */
static int number_cameras(ted4_dataset *d, const ted4_shot *shots, ted4_message *m)
{
    const size_t n = d->n_pictures;
    labelled *list = malloc(n * sizeof *list);
    int result = list == NULL ? -1 : 0;

    for (size_t i = 0; i < n && result == 0; i++) {
        list[i].label = shots[i].camera;
        list[i].picture = (uint32_t)i;
    }
    if (result == 0) {
        qsort(list, n, sizeof *list, by_label);
        /* camera_id is first the index of the camera's first picture, then the camera's number. */
        for (size_t i = 0; i < n; i++) {
            const int same = i > 0 && strcmp(list[i].label, list[i - 1].label) == 0;
            d->pictures[list[i].picture].camera_id =
                same ? d->pictures[list[i - 1].picture].camera_id : list[i].picture;
        }
        for (size_t i = 0; i < n; i++) {
            const uint32_t first = d->pictures[i].camera_id;
            d->pictures[i].camera_id = first == i ? d->n_cameras++ : d->pictures[first].camera_id;
        }
    }
    free(list);
    return result != 0 ? ted4_say_no_memory(m) : 0;
}

/* A picture whose time is farther from its frame than this, in frame intervals, counts as moved. */
static const double MOVED = 0.1;

/* Warns if pictures had to move to the nearest frame. Returns 0, or -1 if memory runs out. */
static int say_moved(ted4_raw_scene *s, const ted4_dataset *d)
{
    const double steps = (double)d->n_frames - 1;
    double first = s->shots[0].time, last = first, worst = 0;
    size_t n = 0;

    for (size_t i = 0; i < s->n_shots; i++) {
        first = fmin(first, s->shots[i].time);
        last = fmax(last, s->shots[i].time);
    }
    for (size_t i = 0; i < s->n_shots && last > first; i++) {
        const double off =
            fabs((s->shots[i].time - first) / (last - first) * steps - d->pictures[i].frame);

        if (off > MOVED)
            n++;
        if (off > worst)
            worst = off;
    }
    return n == 0 ? 0
                  : ted4_raw_scene_warn(s,
                                        "times have no common step: of %zu pictures, %zu move to "
                                        "the nearest of %u frames, by up to %.2g "
                                        "of the whole time",
                                        s->n_shots, n, (unsigned)d->n_frames, worst / steps);
}

static int number_frames(ted4_dataset *d, ted4_raw_scene *s, ted4_message *m)
{
    const ted4_shot *shots = s->shots;
    const size_t n = d->n_pictures;
    double *time = malloc(n * sizeof *time);
    uint32_t *frame = malloc(n * sizeof *frame);
    int result = -1;

    if (time == NULL || frame == NULL) {
        ted4_say_no_memory(m);
    } else {
        for (size_t i = 0; i < n; i++)
            time[i] = shots[i].time;
        result = ted4_frame_times(time, n, frame, &d->n_frames, m);
        for (size_t i = 0; i < n && result == 0; i++)
            d->pictures[i].frame = frame[i];
        if (result == 0 && say_moved(s, d) != 0)
            result = ted4_say_no_memory(m);
    }
    free(time);
    free(frame);
    return result;
}

typedef struct {
    const char *name; /* not terminated */
    size_t length;
    double time;
} named;

static int compare_names(const named *x, const named *y)
{
    const size_t shorter = x->length < y->length ? x->length : y->length;
    const int order = memcmp(x->name, y->name, shorter);

    return order != 0 ? order : (x->length > y->length) - (x->length < y->length);
}

static int by_name(const void *a, const void *b)
{
    const named *x = a, *y = b;
    const int order = compare_names(x, y);

    return order != 0 ? order : (x->time > y->time) - (x->time < y->time);
}

/* Warns of cameras that have a name but no picture up to the time last. Where the layout gives no
 * times, a camera of a single picture is one that COLMAP made for it. Returns 0, or -1 if memory
 * runs out. */
static int say_lost(ted4_raw_scene *s, uint32_t most, double last)
{
    named *list = malloc(s->n_shots * sizeof *list);
    const named *first = NULL;
    size_t n = 0, lost = 0;

    if (list == NULL)
        return -1;
    for (size_t i = 0; i < s->n_shots; i++) {
        if (s->shots[i].camera == NULL)
            continue;
        list[n].name = ted4_camera_name(s->shots[i].camera, &list[n].length);
        list[n++].time = s->shots[i].time;
    }
    qsort(list, n, sizeof *list, by_name);
    for (size_t i = 0, end; i < n; i = end) {
        for (end = i + 1; end < n && compare_names(&list[i], &list[end]) == 0; end++)
            ;
        if (list[i].time > last && (s->timed || end > i + 1) && lost++ == 0)
            first = &list[i];
    }
    const int result =
        lost == 0   ? 0
        : lost == 1 ? ted4_raw_scene_warn(s,
                                          "--max-frames %u leaves out camera %.*s, which has no "
                                          "picture in the first times",
                                          (unsigned)most, (int)first->length, first->name)
                    : ted4_raw_scene_warn(s,
                                          "--max-frames %u leaves out %zu cameras, which have no "
                                          "picture in the first times; the first: %.*s",
                                          (unsigned)most, lost, (int)first->length, first->name);
    free(list);
    return result;
}

/* Keeps the shots of the first most distinct times, in their order. */
static int keep_first_times(ted4_raw_scene *s, uint32_t most, ted4_message *m)
{
    double *sorted = malloc(s->n_shots * sizeof *sorted);
    size_t n = 0, kept = 0;

    if (sorted == NULL)
        return ted4_say_no_memory(m);
    for (size_t i = 0; i < s->n_shots; i++)
        sorted[i] = s->shots[i].time;
    n = ted4_distinct_times(sorted, s->n_shots);
    const double last = n > most ? sorted[most - 1] : sorted[n - 1];
    free(sorted);
    if (say_lost(s, most, last) != 0)
        return ted4_say_no_memory(m);
    for (size_t i = 0; i < s->n_shots; i++) {
        if (s->shots[i].time > last) {
            free(s->shots[i].path);
            free(s->shots[i].camera);
        } else {
            s->shots[kept++] = s->shots[i];
        }
    }
    s->n_shots = kept;
    return 0;
}

/* Moves test shots behind the training shots; the order within each group is kept. */
static int split(ted4_raw_scene *s, ted4_message *m)
{
    ted4_shot *sorted = malloc(s->n_shots * sizeof *sorted);
    size_t k = 0;

    if (sorted == NULL)
        return ted4_say_no_memory(m);
    for (int test = 0; test < 2; test++)
        for (size_t i = 0; i < s->n_shots; i++)
            if ((s->shots[i].is_test != 0) == test)
                sorted[k++] = s->shots[i];
    free(s->shots);
    s->shots = sorted;
    s->capacity = s->n_shots;
    if (!sorted[0].is_test)
        return 0;
    return s->n_missing == 0
               ? ted4_say(m, "all %zu pictures are held out, none is left to train on", s->n_shots)
               : ted4_say(m,
                          "all %zu pictures that are there are held out, none is left to train on; "
                          "%zu of %zu entries have no picture, "
                          "the first: %s",
                          s->n_shots, s->n_missing, s->n_entries, s->first_missing);
}

/* Sorts equal paths in the order of the shots, which is that of the addresses. */
static int by_path(const void *a, const void *b)
{
    const ted4_shot *x = *(const ted4_shot *const *)a, *y = *(const ted4_shot *const *)b;
    const int order = strcmp(x->path, y->path);

    return order != 0 ? order : (x > y) - (x < y);
}

/* Shots of pictures that an earlier shot has too. */
typedef struct {
    size_t n;
    const char *first; /* by name */
} repeated;

static int say_repeated(ted4_raw_scene *s, const repeated *held_out, const repeated *other)
{
    int result = 0;

    if (held_out->n > 0)
        result = ted4_raw_scene_warn(
            s,
            held_out->n == 1 ? "%zu held-out picture is a training picture too: %s"
                             : "%zu held-out pictures are training pictures too; the first: %s",
            held_out->n, held_out->first);
    if (other->n > 0 && result == 0)
        result = ted4_raw_scene_warn(s,
                                     other->n == 1
                                         ? "%zu entry names a picture again: %s"
                                         : "%zu entries name a picture again; the first: %s",
                                     other->n, other->first);
    return result;
}

/* Warns of pictures that are listed more than once: what is held out should not have been trained
 * on. The training shots must come first. */
static int say_twice(ted4_raw_scene *s, ted4_message *m)
{
    const ted4_shot **sorted = malloc(s->n_shots * sizeof *sorted), *first = NULL;
    repeated held_out = { 0, NULL }, other = { 0, NULL };

    if (sorted == NULL)
        return ted4_say_no_memory(m);
    for (size_t i = 0; i < s->n_shots; i++)
        sorted[i] = &s->shots[i];
    qsort(sorted, s->n_shots, sizeof *sorted, by_path);
    for (size_t i = 0; i < s->n_shots; i++) {
        if (first == NULL || strcmp(first->path, sorted[i]->path) != 0) {
            first = sorted[i];
            continue;
        }
        repeated *r = sorted[i]->is_test && !first->is_test ? &held_out : &other;
        if (r->n++ == 0)
            r->first = first->path;
    }
    free(sorted);
    return say_repeated(s, &held_out, &other) == 0 ? 0 : ted4_say_no_memory(m);
}

/* Warns of entries that were skipped because their picture is missing, as other programs skip them
 * too. It is an error if no entry has a picture. */
static int say_missing(ted4_raw_scene *s, ted4_message *m)
{
    if (s->n_missing == 0)
        return 0;
    if (s->n_shots == 0)
        return s->n_entries == 1
                   ? ted4_say(m, "the scene's only entry has no picture: %s", s->first_missing)
                   : ted4_say(m, "none of %zu entries has a picture; the first: %s", s->n_entries,
                              s->first_missing);
    const int result =
        s->n_missing == 1
            ? ted4_raw_scene_warn(s, "1 of %zu entries has no picture: %s", s->n_entries,
                                  s->first_missing)
            : ted4_raw_scene_warn(s, "%zu of %zu entries have no picture; the first: %s",
                                  s->n_missing, s->n_entries, s->first_missing);
    return result != 0 ? ted4_say_no_memory(m) : 0;
}

static int take_points(ted4_dataset *d, ted4_raw_scene *s, const ted4_dataset_options *o,
                       ted4_message *m)
{
    double centre[3] = { 0, 0, 0 }, half = TED4_BLENDER_HALF_CUBE;

    if (s->cloud.n == 0) {
        ted4_point_cloud_free(&s->cloud);
        if (!s->unit_cube && ted4_view_box(d, centre, &half) != 0)
            return ted4_say_no_memory(m);
        if (ted4_point_cloud_random(&s->cloud, centre, half, o->seed) != 0)
            return ted4_say_no_memory(m);
        d->random_points = 1;
    }
    for (size_t i = 0; i < 3 * s->cloud.n; i++)
        if (!isfinite(s->cloud.xyz[i]))
            return ted4_say(m, "point %zu of the scene has a coordinate that is not finite", i / 3);
    d->points = s->cloud.xyz;
    d->point_rgb = s->cloud.rgb;
    d->n_points = s->cloud.n;
    memset(&s->cloud, 0, sizeof s->cloud);
    return 0;
}

/* Transparent pictures are composited over the background that the caller chose. If no picture is
 * transparent, the background is black. */
static void choose_background(ted4_dataset *d, const ted4_raw_scene *s,
                              const ted4_dataset_options *o)
{
    for (size_t i = 0; i < s->n_shots && !d->has_alpha; i++)
        d->has_alpha = s->shots[i].has_alpha;
    memset(d->background, d->has_alpha && o->white ? 255 : 0, sizeof d->background);
}

int ted4_build_dataset(ted4_dataset *d, ted4_raw_scene *s, const ted4_dataset_options *o,
                       ted4_message *m)
{
    int reduction;

    if (say_missing(s, m) != 0)
        return -1;
    if (s->n_shots == 0)
        return ted4_say(m, "the scene (layout %s) has no pictures", s->layout);
    if ((o->max_frames > 0 && keep_first_times(s, o->max_frames, m) != 0) ||
        left_to_reduce(s, o->downscale, &reduction, m) != 0)
        return -1;
    if (ted4_raw_scene_label(s) != 0)
        return ted4_say_no_memory(m);
    if ((o->n_hold_out > 0 && ted4_raw_scene_hold_out_named(s, o, m) != 0) || split(s, m) != 0 ||
        say_twice(s, m) != 0)
        return -1;
    d->layout = ted4_text_copy(s->layout);
    d->pictures = calloc(s->n_shots, sizeof *d->pictures);
    d->sources = calloc(s->n_shots, sizeof *d->sources);
    if (d->layout == NULL || d->pictures == NULL || d->sources == NULL)
        return ted4_say_no_memory(m);
    for (; d->n_pictures < s->n_shots; d->n_pictures++)
        if (make_picture(&d->pictures[d->n_pictures], &d->sources[d->n_pictures],
                         &s->shots[d->n_pictures], reduction, o, m) != 0)
            return -1;
    d->rate = s->rate;
    choose_background(d, s, o);
    if (number_frames(d, s, m) != 0 || number_cameras(d, s->shots, m) != 0 ||
        take_points(d, s, o, m) != 0)
        return -1;
    d->warnings = s->warnings;
    d->n_warnings = s->n_warnings;
    s->warnings = NULL;
    s->n_warnings = 0;
    d->cache = ted4_image_cache_new(d->n_pictures, o->cache_bytes, ted4_source_decode, d->sources);
    return d->cache == NULL ? ted4_say_no_memory(m) : 0;
}
