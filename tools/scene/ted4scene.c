/* ted4scene.c - the command line of the scene maker: makes one of the project's own scenes (see
 * ray_scene.c) as a folder of pictures with poses.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <dirent.h>
#include <getopt.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "ray_rig.h"
#include "scene_ways.h"
#include "tool/arguments.h"
#include "tool/leftovers.h"

enum { EXIT_FINE = 0, EXIT_TROUBLE = 3 };
enum { LEAST_SIDE = 8 };

enum {
    OPT_OUTPUT,
    OPT_SIZE,
    OPT_CAMERAS,
    OPT_TEST_CAMERAS,
    OPT_FRAMES,
    OPT_HOLD,
    OPT_POSE_ERROR,
    OPT_TINT,
    OPT_DRIFT,
    OPT_LAYOUT,
    OPT_VIDEO,
    OPT_SEED,
    OPT_THREADS,
    OPT_FORCE,
    OPT_HELP,
    OPT_VERSION,
    OPT_WAYS /* the options of scene_ways.h begin here */
};

enum { N_OPTIONS = OPT_WAYS + TED4_SCENE_N_WAYS };

/* parse fills in those of scene_ways.h. */
static ted4_argument options[N_OPTIONS] = {
    [OPT_OUTPUT] = { 'o', "output", "FOLDER",
                     "where to; made if missing, must be empty without -f" },
    [OPT_SIZE] = { 0, "size", "WxH", "picture size, 8 to 4096" },
    [OPT_CAMERAS] = { 0, "cameras", "N", "training cameras, 1 to 1000" },
    [OPT_TEST_CAMERAS] = { 0, "test-cameras", "N", "test cameras, 0 to 1000" },
    [OPT_FRAMES] = { 0, "frames", "N", "times, 1 to 1000" },
    [OPT_HOLD] = { 0, "hold", "N",
                   "training cameras lack time N/2 of every N, test cameras have it; 2 to 1000, "
                   "0: none" },
    [OPT_POSE_ERROR] = { 0, "pose-error", "D",
                         "training cameras are stated turned by D degrees, and moved as far; 0 to "
                         "10" },
    [OPT_TINT] = { 0, "tint", "S", "training cameras disagree in colour and exposure; 0 to 2" },
    [OPT_DRIFT] = { 0, "drift", "S",
                    "exposures of training cameras go up or down by S stops over time; 0 to 2" },
    [OPT_LAYOUT] = { 0, "layout", "L",
                     "blender (default), nerfstudio, colmap, colmap-text, hypernerf, neu3d, "
                     "calibration or llff, of which the last has stills of one time" },
    [OPT_VIDEO] = { 0, "video", NULL,
                    "neu3d and calibration: lossless videos by ffmpeg, not frames" },
    [OPT_SEED] = { 0, "seed", "S", "of textures, points, errors and tints, 32 bits. Default 1" },
    [OPT_THREADS] = { 'j', "threads", "N", "threads, 1 to 1024. Default: all cores" },
    [OPT_FORCE] = { 'f', "force", NULL,
                    "write into a folder that is not empty; its other files stay" },
    [OPT_HELP] = TED4_ARGUMENT_HELP,
    [OPT_VERSION] = TED4_ARGUMENT_VERSION,
};

static void print_names(FILE *f)
{
    for (int s = 0; s < RAY_SCENES; s++) {
        const ted4_ray_plan *const p = ted4_ray_plan_of((ted4_ray_scene)s);

        fprintf(f, "  %-8s  %s\n            (%dx%d, %d + %d, %d, %d)\n", p->name, p->shows,
                p->width, p->height, p->n_train, p->n_test, p->n_frames, p->hold);
    }
}

static const ted4_command COMMAND = {
    "ted4scene",
    "NAME -o FOLDER [options]",
    "Makes a small synthetic dynamic scene. What is not given, and has no default\n"
    "here, is that of the NAME in the list below. If anything is held out or\n"
    "disturbed, the file truth.json in the folder says what.",
    options,
    N_OPTIONS,
    "--hold, --pose-error, --tint and --drift go with the layouts blender, nerfstudio\n"
    "and hypernerf, which list what is held out; in others a NAME's hold is left out.\n"
    "The options from --background on make files as other writers do; most of these\n"
    "go together, and the content stays the same.\n\n"
    "Exit codes: 0 fine, 3 usage, input, output or resources.\n\n"
    "NAMEs, with picture size, training + test cameras, times, hold:\n",
    print_names,
};

/* Options that were not given are -1. */
typedef struct {
    ted4_ray_options set;
    const char *folder;
    int threads, force;
} command;

static void run_openmp(void *user, size_t n, void (*body)(void *arg, size_t i), void *arg)
{
    const int threads = *(const int *)user;

#pragma omp parallel for schedule(dynamic) num_threads(threads)
    for (size_t i = 0; i < n; i++)
        body(arg, i);
}

static int complain(const char *what, const char *why)
{
    fprintf(stderr, "ted4scene: %s: %s\n", what, why);
    return EXIT_TROUBLE;
}

static int bad_value(int option, const char *text, const char *expected)
{
    (void)ted4_arguments_bad(COMMAND.program, options[option].name, text, expected);
    return EXIT_TROUBLE;
}

static int integer(int option, const char *text, int low, int high, int *value)
{
    int64_t v;

    if (ted4_arguments_number(text, low, high, &v) != 0) {
        (void)ted4_arguments_bad_number(COMMAND.program, options[option].name, text, low, high);
        return EXIT_TROUBLE;
    }
    *value = (int)v;
    return EXIT_FINE;
}

/* Parses a size such as "160x120". */
static int size_of(const char *text, ted4_ray_options *o)
{
    char width[16] = "", expected[80];
    int64_t w, h;
    const char *const x = strchr(text, 'x');
    const size_t n = x == NULL ? 0 : (size_t)(x - text);

    if (n < sizeof width)
        memcpy(width, text, n);
    if (ted4_arguments_number(width, LEAST_SIDE, TED4_RAY_MAX_SIDE, &w) != 0 ||
        ted4_arguments_number(x + 1, LEAST_SIDE, TED4_RAY_MAX_SIDE, &h) != 0) {
        snprintf(expected, sizeof expected, "a size from %dx%d to %dx%d, such as 160x120",
                 LEAST_SIDE, LEAST_SIDE, TED4_RAY_MAX_SIDE, TED4_RAY_MAX_SIDE);
        return bad_value(OPT_SIZE, text, expected);
    }
    o->width = (int)w;
    o->height = (int)h;
    return EXIT_FINE;
}

/* Parses a number in [0, high]. */
static int real(int option, const char *text, double high, double *value)
{
    char *end, expected[80];

    *value = strtod(text, &end);
    if (end != text && *end == '\0' && *value >= 0 && *value <= high)
        return EXIT_FINE;
    snprintf(expected, sizeof expected, "a number from 0 to %g", high);
    return bad_value(option, text, expected);
}

/* Parses "0", or "2" to "1000". */
static int hold_of(const char *text, int *hold)
{
    char expected[80];
    int64_t v;

    if (ted4_arguments_number(text, 0, TED4_RAY_MAX_COUNT, &v) != 0 || v == 1) {
        snprintf(expected, sizeof expected, "0, or a whole number from 2 to %d",
                 TED4_RAY_MAX_COUNT);
        return bad_value(OPT_HOLD, text, expected);
    }
    *hold = (int)v;
    return EXIT_FINE;
}

/* Takes the options that were not given from the table. */
static int fill(ted4_ray_options *o)
{
    const ted4_ray_options d = ted4_ray_defaults(o->scene);

    const int lists = ted4_ray_has_lists(o->layout);

    if (o->hold > 0 && !lists)
        return complain("--hold", "goes with the layouts blender, nerfstudio and hypernerf");
    if (o->n_frames >= 0 && o->ways.turns)
        return complain("--frames", "not with --turns, where each camera has a time");
    if (o->width < 0) {
        o->width = d.width;
        o->height = d.height;
    }
    o->n_train = o->n_train < 0 ? d.n_train : o->n_train;
    o->n_test = o->n_test < 0 ? d.n_test : o->n_test;
    if (o->ways.turns)
        o->n_frames = o->n_train + o->n_test;
    if (o->n_frames < 0)
        o->n_frames = o->layout == RAY_LLFF ? 1 : d.n_frames;
    if (o->hold < 0)
        o->hold = o->ways.turns ? 0 : o->ways.split == RAY_OTHER_TIMES && d.hold == 0 ? 4 : d.hold;
    o->pose_error = o->pose_error < 0 ? d.pose_error : o->pose_error;
    o->tint = o->tint < 0 ? d.tint : o->tint;
    o->drift = o->drift < 0 ? d.drift : o->drift;
    if ((o->pose_error > 0 || o->tint > 0 || o->drift > 0) && !lists)
        return complain("--layout",
                        "scenes with pose errors, tints or drift go with blender, nerfstudio and "
                        "hypernerf only: others hold out pictures of disturbed cameras");
    return ted4_ray_fault(o) == NULL ? EXIT_FINE : complain("options", ted4_ray_fault(o));
}

static int scene_of(const char *name, ted4_ray_options *o)
{
    for (int s = 0; s < RAY_SCENES; s++) {
        if (strcmp(name, ted4_ray_scene_name((ted4_ray_scene)s)) == 0) {
            o->scene = (ted4_ray_scene)s;
            return EXIT_FINE;
        }
    }
    return complain(name, "not the name of a scene (see -h)");
}

static int layout_of(const char *name, ted4_ray_options *o)
{
    char expected[200];
    size_t n = 0;

    for (int l = 0; l < RAY_LAYOUTS; l++) {
        const char *const known = ted4_ray_layout_name((ted4_ray_layout)l);

        if (strcmp(name, known) == 0) {
            o->layout = (ted4_ray_layout)l;
            return EXIT_FINE;
        }
        n += (size_t)snprintf(expected + n, sizeof expected - n, "%s%s",
                              l == 0                 ? ""
                              : l == RAY_LAYOUTS - 1 ? " or "
                                                     : ", ",
                              known);
    }
    return bad_value(OPT_LAYOUT, name, expected);
}

static int seed_of(const char *text, uint32_t *seed)
{
    int64_t v;

    if (ted4_arguments_number(text, 0, UINT32_MAX, &v) != 0) {
        (void)ted4_arguments_bad_number(COMMAND.program, options[OPT_SEED].name, text, 0,
                                        UINT32_MAX);
        return EXIT_TROUBLE;
    }
    *seed = (uint32_t)v;
    return EXIT_FINE;
}

static int way(command *c, int index, const char *text)
{
    const int file = c->set.ways.file;

    if (ted4_scene_way(index, text, &c->set.ways) != 0)
        return bad_value(OPT_WAYS + index, text, ted4_scene_way_expected(index));
    if (file != RAY_PNG && (file >= RAY_JPEG) != (c->set.ways.file >= RAY_JPEG))
        return complain("--jpeg", "not with --png: all pictures are of one kind");
    return EXIT_FINE;
}

static int set_option(command *c, int index, const char *text)
{
    ted4_ray_options *const o = &c->set;

    switch (index) {
    case OPT_OUTPUT: c->folder = text; return EXIT_FINE;
    case OPT_FORCE: c->force = 1; return EXIT_FINE;
    case OPT_VIDEO: o->video = 1; return EXIT_FINE;
    case OPT_THREADS: return integer(index, text, 1, 1024, &c->threads);
    case OPT_SIZE: return size_of(text, o);
    case OPT_CAMERAS: return integer(index, text, 1, TED4_RAY_MAX_COUNT, &o->n_train);
    case OPT_TEST_CAMERAS: return integer(index, text, 0, TED4_RAY_MAX_COUNT, &o->n_test);
    case OPT_FRAMES: return integer(index, text, 1, TED4_RAY_MAX_COUNT, &o->n_frames);
    case OPT_HOLD: return hold_of(text, &o->hold);
    case OPT_POSE_ERROR: return real(index, text, TED4_RAY_MOST_ERROR, &o->pose_error);
    case OPT_TINT: return real(index, text, TED4_RAY_MOST_TINT, &o->tint);
    case OPT_DRIFT: return real(index, text, TED4_RAY_MOST_DRIFT, &o->drift);
    case OPT_LAYOUT: return layout_of(text, o);
    case OPT_SEED: return seed_of(text, &o->seed);
    default: return way(c, index - OPT_WAYS, text);
    }
}

/* Returns EXIT_FINE, EXIT_TROUBLE, or -1 if -h or -V has already been handled. */
static int parse(int argc, char **argv, command *c)
{
    const char *value;

    memcpy(options + OPT_WAYS, ted4_scene_ways, sizeof ted4_scene_ways);
    for (int i; (i = ted4_arguments_next(&COMMAND, argc, argv, &value)) != TED4_ARGUMENTS_END;) {
        if (i == TED4_ARGUMENTS_DONE)
            return -1;
        if (i == TED4_ARGUMENTS_BAD || set_option(c, i, value) != EXIT_FINE)
            return EXIT_TROUBLE;
    }
    if (optind + 1 != argc)
        return complain(argc > optind ? argv[optind + 1] : "NAME", "give one scene name (see -h)");
    if (c->set.video && c->set.layout != RAY_NEU3D && c->set.layout != RAY_CALIBRATION)
        return complain("--video", "goes with the layouts neu3d and calibration");
    if (c->folder == NULL)
        return complain("-o", "give the folder to write (see -h)");
    if (scene_of(argv[optind], &c->set) != EXIT_FINE)
        return EXIT_TROUBLE;
    return fill(&c->set);
}

/* Returns 1 if the folder contains anything. A folder that does not exist is empty. */
static int is_occupied(const char *folder)
{
    DIR *const d = opendir(folder);
    int found = 0;

    if (d == NULL)
        return 0;
    for (const struct dirent *e = readdir(d); e != NULL && !found; e = readdir(d))
        found = strcmp(e->d_name, ".") != 0 && strcmp(e->d_name, "..") != 0;
    closedir(d);
    return found;
}

int main(int argc, char **argv)
{
    command c = { .set = { .width = -1,
                           .n_train = -1,
                           .n_test = -1,
                           .n_frames = -1,
                           .seed = 1,
                           .hold = -1,
                           .pose_error = -1,
                           .tint = -1,
                           .drift = -1 },
                  .threads = omp_get_max_threads() };
    const ted4_parallel threads = { run_openmp, &c.threads };
    ted4_ray_message m;
    const int status = parse(argc, argv, &c);

    if (status != EXIT_FINE)
        return status < 0 ? EXIT_FINE : EXIT_TROUBLE;
    if (!c.force && is_occupied(c.folder))
        return complain(c.folder, "is not empty; -f to write into it");
    ted4_leftovers_watch();
    if (ted4_ray_write(&c.set, c.folder, &threads, &m) != 0) {
        fprintf(stderr, "ted4scene: %s\n", m.text);
        return EXIT_TROUBLE;
    }
    return EXIT_FINE;
}
