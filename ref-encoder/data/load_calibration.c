/* load_calibration.c - loads the layout "calibration": cams.json describes fixed cameras by
 * OpenCV's model, with one clip each (clip.h). A camera has name, video (a file or a folder of
 * pictures; clip.h says where it is looked for without this field), w, h, K (3x3), dist (k1 k2 p1
 * p2 and optionally k3), w2c (world to camera, 4x4; right, down, forward), and start (seconds) or
 * frame, which say when its clip begins. At the top are frames (the number of frames that are read,
 * and that each clip must have at least) and fps. Cameras without a clip are left out.
 * TED4_HOLD_OUT_* selects the times that are held out, for all cameras.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "data/raw_scene.h"

#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "data/clip.h"
#include "data/data_util.h"
#include "data/json_field.h"

/* OpenCV puts the centre of the first pixel at 0, this program at 0.5. */
static const double CENTRE_SHIFT = 0.5;

/* Starts are rounded to frames. There is no warning if this moves them by at most BETWEEN
 * frames. */
static const double BETWEEN = 0.1, MOST_OFFSET = 1e6;

typedef struct {
    ted4_raw_scene *scene;
    const char *folder;
    char *path;   /* path of cams.json; owned */
    json_t *root; /* owned */
    ted4_clips clips;
    size_t stated;    /* frames of each clip; 0 if not stated */
    int started;      /* does any camera state when its clip begins? */
    size_t n_between; /* cameras whose clips start between two frames */
    double farthest;  /* largest such offset from a frame, in frames */
    ted4_message *m;
} calibration;

int ted4_is_calibration(const char *folder)
{
    char *path = ted4_path_join(folder, "cams.json");
    const int found = path != NULL && ted4_is_file(path);

    free(path);
    return found;
}

static int missing(const calibration *c, const char *where, const char *what, int found)
{
    return found < 0 ? -1 : ted4_say(c->m, "%s: no %s", where, what);
}

static int read_lens(const calibration *c, const json_t *o, const char *where, ted4_lens *l)
{
    double w = 0, h = 0, K[9], dist[5] = { 0, 0, 0, 0, 0 };
    int found = ted4_json_number(o, where, "w", &w, c->m);

    if (found > 0)
        found = ted4_json_number(o, where, "h", &h, c->m);
    if (found <= 0)
        return missing(c, where, "w, h", found);
    if (!(w >= 1 && h >= 1 && w <= 1e6 && h <= 1e6) || w != floor(w) || h != floor(h))
        return ted4_say(c->m, "%s: w, h are %g, %g, expected whole numbers of pixels", where, w, h);
    found = ted4_json_numbers(o, where, "K", K, 9, 9, c->m);
    if (found <= 0)
        return missing(c, where, "K", found);
    if (K[3] != 0 || K[6] != 0 || K[7] != 0 || K[8] != 1)
        return ted4_say(c->m, "%s.K: expected fx s cx, 0 fy cy, 0 0 1", where);
    if (ted4_json_numbers(o, where, "dist", dist, 4, 5, c->m) < 0)
        return -1;
    *l = (ted4_lens) { .width = (int)w,
                       .height = (int)h,
                       .fx = K[0],
                       .fy = K[4],
                       .skew = K[1],
                       .cx = K[2] + CENTRE_SHIFT,
                       .cy = K[5] + CENTRE_SHIFT,
                       .k1 = dist[0],
                       .k2 = dist[1],
                       .p1 = dist[2],
                       .p2 = dist[3],
                       .k3 = dist[4] };
    return 0;
}

static int read_pose(const calibration *c, const json_t *o, const char *where, ted4_shot *shot)
{
    double M[12];
    const int found = ted4_json_affine(o, where, "w2c", M, c->m);

    if (found <= 0)
        return missing(c, where, "w2c", found);
    for (int i = 0; i < 3; i++) {
        memcpy(shot->R + 3 * i, M + 4 * i, 3 * sizeof *M);
        shot->t[i] = M[4 * i + 3];
    }
    const char *wrong = ted4_rotation_clean(shot->R);
    return wrong == NULL ? 0 : ted4_say(c->m, "%s.w2c: its 3x3 part %s", where, wrong);
}

/* Reads the time of the clip's first picture in frames, on the common clock of all cameras: "start"
 * in seconds, or "frame". */
static int read_start(calibration *c, const json_t *o, const char *where, double *time)
{
    double start = 0, frame = 0;
    const int seconds = ted4_json_number(o, where, "start", &start, c->m);
    const int frames = seconds < 0 ? -1 : ted4_json_number(o, where, "frame", &frame, c->m);

    if (seconds < 0 || frames < 0)
        return -1;
    if (seconds > 0 && frames > 0)
        return ted4_say(c->m, "%s: both start and frame are given, expected one", where);
    if (seconds > 0 && c->scene->rate <= 0)
        return ted4_say(c->m,
                        "%s.start: %g seconds, but the file has no fps at its top (frame counts "
                        "frames)",
                        where, start);
    if (frames > 0 && frame != floor(frame))
        return ted4_say(c->m, "%s.frame: %g, expected a whole number", where, frame);
    const double at = seconds > 0 ? start * c->scene->rate : frame;
    *time = floor(at + 0.5);
    if (!(fabs(at) <= MOST_OFFSET))
        return ted4_say(c->m, "%s: its clip begins %g frames from the others, expected at most %g",
                        where, at, MOST_OFFSET);
    c->n_between += fabs(at - *time) > BETWEEN;
    c->farthest = fmax(c->farthest, fabs(at - *time));
    c->started |= seconds > 0 || frames > 0;
    return 0;
}

enum { WHERE = 700 };

static void name_camera(const calibration *c, size_t i, char where[WHERE])
{
    snprintf(where, WHERE, "%.600s: cameras[%zu]", c->path, i);
}

/* Refuses clips that end before the stated frames, as they may have been truncated, and those that
 * have none of them. */
static int check_counts(const calibration *c)
{
    char where[WHERE];

    for (const ted4_clip *clip = c->clips.list; clip < c->clips.list + c->clips.n; clip++) {
        const size_t frames = clip->pictures.n > 0 ? clip->frames : 0;
        name_camera(c, clip->entry, where);
        if (frames < c->stated)
            return ted4_say(c->m,
                            "%s: %zu frames, expected %zu by the file's frames "
                            "(--max-frames reads the first ones)",
                            where, frames, c->stated);
    }
    return 0;
}

static int find_clip(calibration *c, const char *where, const ted4_clip *clip, const char *video)
{
    char text[400];

    c->scene->n_entries++;
    const int found = ted4_clips_find(&c->clips, clip, video, c->scene->wanted, c->m);
    if (found == 0 && video != NULL)
        return ted4_say(c->m, "%s.video: %.150s: no such video or folder of pictures", where,
                        video);
    if (found == 0) {
        snprintf(text, sizeof text,
                 "%.150s: no such video, nor a folder images/%.60s or %.60s/images of its pictures",
                 clip->name, clip->name, clip->name);
        ted4_raw_scene_missing(c->scene, where, text);
    }
    return found < 0 ? -1 : 0;
}

/* Refuses the name of an earlier camera, whose pictures would count as this one's. */
static int check_name(const calibration *c, const char *where, const char *name, size_t i)
{
    const json_t *cameras = json_object_get(c->root, "cameras");

    for (size_t k = 0; k < i; k++)
        if (strcmp(json_string_value(json_object_get(json_array_get(cameras, k), "name")), name) ==
            0)
            return ted4_say(c->m, "%s.name: %s, as cameras[%zu]", where, name, k);
    return 0;
}

static int read_camera(calibration *c, size_t i)
{
    const json_t *o = json_array_get(json_object_get(c->root, "cameras"), i);
    const char *video = NULL;
    char where[WHERE];
    ted4_clip clip;

    memset(&clip, 0, sizeof clip);
    clip.entry = i;
    name_camera(c, i, where);
    const int found = ted4_json_text(o, where, "name", &clip.name, c->m);
    if (found <= 0)
        return missing(c, where, "name", found);
    if (check_name(c, where, clip.name, i) != 0 ||
        ted4_json_text(o, where, "video", &video, c->m) < 0 ||
        read_lens(c, o, where, &clip.model.lens) != 0 || read_pose(c, o, where, &clip.model) != 0 ||
        read_start(c, o, where, &clip.model.time) != 0)
        return -1;
    return find_clip(c, where, &clip, video);
}

static int read_frames(calibration *c)
{
    const uint32_t most = c->scene->wanted->max_frames;
    double frames = 0;

    if (ted4_json_number(c->root, c->path, "frames", &frames, c->m) < 0 ||
        ted4_json_rate(c->root, c->path, &c->scene->rate, c->m) < 0)
        return -1;
    if (!(frames >= 0 && frames <= TED4_MAX_FRAMES) || frames != floor(frames))
        return ted4_say(c->m, "%s.frames: %g, expected a whole number up to %d", c->path, frames,
                        TED4_MAX_FRAMES);
    c->stated = (size_t)frames;
    if (most > 0 && c->stated > most)
        c->stated = most;
    c->clips.most = c->stated > 0 ? c->stated : most;
    return 0;
}

/* Holds out times of all cameras, counted from the earliest time of any camera. */
static void hold_out_times(ted4_raw_scene *s)
{
    double first = s->n_shots > 0 ? s->shots[0].time : 0;

    for (size_t i = 0; i < s->n_shots; i++)
        first = fmin(first, s->shots[i].time);
    for (size_t i = 0; i < s->n_shots; i++)
        s->shots[i].is_test = (size_t)(s->shots[i].time - first) % TED4_HOLD_OUT_EVERY ==
                              TED4_HOLD_OUT_PHASE;
}

static int say_times(calibration *c)
{
    if (c->n_between > 0 &&
        ted4_raw_scene_warn(c->scene,
                            "%zu of %zu cameras start between two frames, by up to %.2g of a "
                            "frame: each goes with the nearest "
                            "frame",
                            c->n_between, c->scene->n_entries, c->farthest) != 0)
        return ted4_say_no_memory(c->m);
    return ted4_clips_say(&c->clips, !c->started, c->scene, c->m);
}

static int read_all(calibration *c)
{
    ted4_raw_scene *s = c->scene;

    c->root = c->path == NULL ? NULL : ted4_json_read(c->path, c->m);
    if (c->root == NULL)
        return c->path == NULL ? ted4_say_no_memory(c->m) : -1;
    const size_t n = json_array_size(json_object_get(c->root, "cameras"));
    if (n == 0)
        return ted4_say(c->m, "%s: cameras: expected a list with at least one camera", c->path);
    if (read_frames(c) != 0)
        return -1;
    for (size_t i = 0; i < n; i++)
        if (read_camera(c, i) != 0)
            return -1;
    if (ted4_clips_number(&c->clips, c->m) != 0 || check_counts(c) != 0 ||
        ted4_clips_give(&c->clips, s, c->m) != 0)
        return -1;
    hold_out_times(s);
    if (say_times(c) != 0)
        return -1;
    return ted4_ply_find(&s->cloud, c->folder, c->m);
}

int ted4_load_calibration(ted4_raw_scene *s, const char *folder, ted4_message *m)
{
    calibration c;

    memset(&c, 0, sizeof c);
    s->layout = "calibration";
    s->timed = 1;
    c.scene = s;
    c.folder = folder;
    c.clips.folder = folder;
    c.m = m;
    c.path = ted4_path_join(folder, "cams.json");
    const int result = read_all(&c);
    ted4_clips_free(&c.clips);
    json_decref(c.root);
    free(c.path);
    return result;
}
