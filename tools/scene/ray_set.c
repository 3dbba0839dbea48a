/* ray_set.c - writes the pictures of a scene, and the folder. ray_layout.c writes the other files
 * of a layout, and ray_points.c finds its points.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "ray_layout.h"
#include "ray_picture.h"
#include "ray_save.h"
#include "ray_shot.h"
#include "ray_truth.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tool/leftovers.h"
#include "tool/mp4_whole.h"

enum { MAX_PATH = 1024 };
static const char truth_name[] = "truth.json";

ted4_ray_options ted4_ray_defaults(ted4_ray_scene s)
{
    const ted4_ray_plan *const p = ted4_ray_plan_of(s);

    return (ted4_ray_options) { .scene = s,
                                .width = p->width,
                                .height = p->height,
                                .n_train = p->n_train,
                                .n_test = p->n_test,
                                .n_frames = p->n_frames,
                                .seed = 1,
                                .hold = p->hold,
                                .pose_error = p->pose_error,
                                .tint = p->tint,
                                .drift = p->drift };
}

const char *ted4_ray_fault(const ted4_ray_options *o)
{
    const ted4_ray_ways *const w = &o->ways;
    const int transforms = o->layout == RAY_BLENDER || o->layout == RAY_NERFSTUDIO,
              clear = ted4_ray_around(o) == RAY_CLEAR;

    if ((w->turns || w->split == RAY_OTHER_TIMES) && !ted4_ray_has_lists(o->layout))
        return "--turns and --split times go with the layouts blender, nerfstudio and hypernerf";
    if (w->turns && (o->hold > 0 || w->split == RAY_OTHER_TIMES))
        return "--turns holds out no times but those of its test cameras";
    if (w->split == RAY_OTHER_TIMES && o->hold == 0)
        return "--split times needs --hold";
    if ((w->paths != RAY_AS_USUAL || w->split == RAY_VAL_FILE || w->split == RAY_TRAIN_ONLY) &&
        !transforms)
        return "--paths, --split val and --split train-only go with the layouts blender and "
               "nerfstudio";
    if ((w->off[0] != 0 || w->off[1] != 0) && (o->layout == RAY_NEU3D || o->layout == RAY_LLFF))
        return "--centre: the layouts neu3d and llff cannot say it";
    if (w->starts && o->layout != RAY_CALIBRATION)
        return "--starts goes with the layout calibration";
    if (w->missing > 0 && o->video)
        return "--missing goes with pictures, not with videos";
    if (w->premultiplied && !clear)
        return "--alpha goes with a transparent background";
    if (w->file >= RAY_JPEG && (clear || o->video))
        return "--jpeg goes with opaque pictures, not with transparent ones and videos";
    if (o->layout == RAY_LLFF && o->n_frames != 1)
        return "the layout llff has one time: --frames 1";
    return NULL;
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

/* Makes the folder path and the folders above it. */
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

static int make_parent(const char *path, ted4_ray_message *m)
{
    char parent[MAX_PATH];

    snprintf(parent, sizeof parent, "%.*s", (int)(strrchr(path, '/') - path), path);
    return make_folders(parent, m);
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

/* ---- pictures: one job each, whose index alone determines its picture ---- */

typedef struct {
    const ted4_ray_options *o;
    const char *folder;
    ted4_ray_message *failure; /* [n_train + n_test][n_frames] one per job, empty on success */
} pictures;

/* Writes truth/masks/NAME.png. */
static void write_mask(const pictures *job, int number, int frame, const ted4_ray_camera *c,
                       uint8_t *mask, ted4_ray_message *m)
{
    char file[TED4_RAY_NAME], name[TED4_RAY_NAME + 24], path[MAX_PATH];

    ted4_ray_picture_name(job->o, number, frame, file);
    snprintf(name, sizeof name, "truth/masks/%.*s.png", (int)(strrchr(file, '.') - file), file);
    if (join(path, job->folder, name, m) != 0 || make_parent(path, m) != 0)
        return;
    if (ted4_ray_mask(job->o, number, frame, mask) != 0)
        complain(m, name, "out of memory");
    else
        ted4_ray_write_grey(path, c->width, c->height, mask, m);
}

static void picture_job(void *arg, size_t i)
{
    const pictures *const job = arg;
    const ted4_ray_options *const o = job->o;
    const int number = (int)(i / (size_t)o->n_frames), frame = (int)(i % (size_t)o->n_frames);
    ted4_ray_message *const m = &job->failure[i];
    ted4_ray_camera camera;
    char file[TED4_RAY_NAME], path[MAX_PATH];

    if (!ted4_ray_is_taken(o, number, frame))
        return;
    ted4_ray_picture_name(o, number, frame, file);
    if (ted4_ray_is_missing(o, number, frame)) {
        remove_file(job->folder, file, m);
        return;
    }
    ted4_ray_camera_of(o, number, &camera);
    uint8_t *const rgba = malloc((size_t)camera.width * (size_t)camera.height * 4);
    if (rgba == NULL) {
        complain(m, file, "out of memory");
    } else if (join(path, job->folder, file, m) == 0) {
        ted4_ray_shot(o, number, frame, rgba);
        if (ted4_ray_write_picture(o, path, camera.width, camera.height, rgba, m) == 0 &&
            o->ways.masks && number < o->n_train)
            write_mask(job, number, frame, &camera, rgba, m);
    }
    free(rgba);
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

/* ---- the folder ---- */

static int write_file(const ted4_ray_options *o, const char *folder, const ted4_ray_file *file,
                      ted4_ray_message *m)
{
    char path[MAX_PATH];
    ted4_ray_collected c;

    if (join(path, folder, file->name, m) != 0 || make_parent(path, m) != 0)
        return -1;
    ted4_ray_collect(&c);
    if (c.file != NULL)
        file->put(c.file, o, file->number, file->frame);
    return ted4_ray_collect_end(&c, 0, path, m);
}

/* Makes every folder for pictures; the D-NeRF layout has both folders even without test cameras. */
static int make_picture_folders(const ted4_ray_options *o, const char *folder, ted4_ray_message *m)
{
    char name[TED4_RAY_NAME], path[MAX_PATH];

    for (int number = 0; number < o->n_train + (o->n_test > 0 ? o->n_test : 1); number++) {
        ted4_ray_picture_name(o, number, ted4_ray_start(o, number), name);
        if (number >= o->n_train + o->n_test && o->layout != RAY_BLENDER)
            break;
        if (join(path, folder, name, m) != 0 || make_parent(path, m) != 0)
            return -1;
    }
    return 0;
}

/* ---- videos: lossless, instead of folders of frames ---- */

/* Makes the name by which ffmpeg finds the pictures of a camera. In the name of a folder, a % is
 * written twice, as it would begin a number; and no name is taken for a protocol. Returns 0, or -1
 * if it is too long. */
static int name_pictures(char name[MAX_PATH], const char *folder, const char *camera)
{
    char doubled[MAX_PATH];
    size_t n = 0;

    for (const char *c = folder; *c != '\0'; c++) {
        if (n + 2 >= sizeof doubled)
            return -1;
        doubled[n++] = *c;
        if (*c == '%')
            doubled[n++] = '%';
    }
    doubled[n] = '\0';
    n = (size_t)snprintf(name, MAX_PATH, "file:%s/%s/images/%%04d.png", doubled, camera);
    return n < MAX_PATH ? 0 : -1;
}

/* Runs ffmpeg, which makes the file to of the pictures input. Returns 0, or -1. */
static int run_ffmpeg(const char *input, const char *to)
{
    char output[MAX_PATH + 8];
    const pid_t child = fork();

    if (child == 0) {
        snprintf(output, sizeof output, "file:%s", to);
        execlp("ffmpeg", "ffmpeg", "-nostdin", "-v", "error", "-xerror", "-y", "-framerate", "30",
               "-i", input, "-c:v", "png", "-f", "mp4", output, (char *)NULL);
        _exit(127);
    }
    if (child < 0)
        return -1;
    ted4_leftovers_add(to, child);

    const int status = ted4_leftovers_wait(to, child);

    return WIFEXITED(status) && WEXITSTATUS(status) == 0 && ted4_mp4_is_whole(to) ? 0 : -1;
}

static int encode(const char *folder, const char *camera, ted4_ray_message *m)
{
    char input[MAX_PATH], output[MAX_PATH], temporary[MAX_PATH];

    if (name_pictures(input, folder, camera) != 0 ||
        snprintf(output, sizeof output, "%s/%s.mp4", folder, camera) >= MAX_PATH ||
        snprintf(temporary, sizeof temporary, "%s/%s.%ld.part", folder, camera, (long)getpid()) >=
            MAX_PATH)
        return complain(m, folder, "the path is too long");
    const int bad = run_ffmpeg(input, temporary) != 0;
    const int failed = bad || rename(temporary, output) != 0;
    const int why = errno;
    if (failed)
        unlink(temporary);
    ted4_leftovers_forget(temporary);
    if (bad)
        return complain(m, output, "the program ffmpeg cannot make it (is it installed?)");
    return failed ? complain(m, output, strerror(why)) : 0;
}

static int make_videos(const ted4_ray_options *o, const char *folder, ted4_ray_message *m)
{
    char name[TED4_RAY_NAME], path[MAX_PATH];

    for (int number = 0; number < o->n_train + o->n_test; number++) {
        ted4_ray_camera_name(o, number, name);
        if (encode(folder, name, m) != 0)
            return -1;
        for (int frame = ted4_ray_start(o, number); frame < o->n_frames; frame++) {
            ted4_ray_picture_name(o, number, frame, name);
            if (remove_file(folder, name, m) != 0 || join(path, folder, name, m) != 0)
                return -1;
        }
        for (int up = 0; up < 2; up++) {
            *strrchr(path, '/') = '\0';
            rmdir(path);
        }
    }
    return 0;
}

/* ---- the whole scene ---- */

static int write_cameras(const ted4_ray_options *o, const char *folder, ted4_ray_message *m)
{
    for (int number = 0; number < o->n_train + o->n_test; number++)
        for (int frame = 0; frame < o->n_frames; frame++) {
            char name[TED4_RAY_NAME];
            const ted4_ray_file file = { name, ted4_ray_put_hypernerf_camera, number, frame, NULL };

            if (!ted4_ray_is_taken(o, number, frame))
                continue;
            ted4_ray_hypernerf_camera_name(o, number, frame, name);
            if (write_file(o, folder, &file, m) != 0)
                return -1;
        }
    return 0;
}

int ted4_ray_write(const ted4_ray_options *o, const char *folder, const ted4_parallel *p,
                   ted4_ray_message *m)
{
    const ted4_ray_file *const files = ted4_ray_layout_files(o->layout);
    const ted4_ray_file truth = { truth_name, ted4_ray_put_truth, 0, 0, NULL };

    m->text[0] = '\0';
    if (make_folders(folder, m) != 0 || make_picture_folders(o, folder, m) != 0 ||
        remove_file(folder, truth_name, m) != 0)
        return -1;
    for (int i = 0; files[i].name != NULL; i++) {
        if (remove_file(folder, files[i].name, m) != 0)
            return -1;
    }
    if (write_pictures(o, folder, p, m) != 0)
        return -1;
    if (o->layout == RAY_HYPERNERF && write_cameras(o, folder, m) != 0)
        return -1;
    if (o->video && make_videos(o, folder, m) != 0)
        return -1;
    if (ted4_ray_has_truth(o) && write_file(o, folder, &truth, m) != 0)
        return -1;
    for (int i = 0; files[i].name != NULL; i++) {
        if ((files[i].wanted == NULL || files[i].wanted(o)) &&
            write_file(o, folder, &files[i], m) != 0)
            return -1;
    }
    return 0;
}
