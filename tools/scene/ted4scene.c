/* ted4scene.c - the command line of the scene maker: makes one of the project's own scenes (see
 * ray_scene.c) as a folder of pictures with poses.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <dirent.h>
#include <errno.h>
#include <getopt.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "ray_rig.h"
#include "scene_ways.h"
#include "ted4.h"

enum { EXIT_FINE = 0, EXIT_TROUBLE = 3 };

static const char usage[] =
    "usage: ted4scene NAME -o FOLDER [options]\n"
    "Makes a small synthetic dynamic scene. What is not given, and has no default here, is that of "
    "the\n"
    "NAME in the list below.\n"
    "  -o FOLDER           where to; made if missing, must be empty without -f\n"
    "  --size WxH          picture size, 8 to 4096\n"
    "  --cameras N         training cameras, 1 to 1000\n"
    "  --test-cameras N    test cameras, 0 to 1000\n"
    "  --frames N          times, 1 to 1000\n"
    "  --hold N            training cameras lack time N/2 of every N, test cameras have it; 2 to\n"
    "                      1000, 0: none\n"
    "  --pose-error D      training cameras are stated turned by D degrees, and moved as far; 0 to "
    "10\n"
    "  --tint S            training cameras disagree in colour and exposure; 0 to 2\n"
    "                      These three go with the layouts blender, nerfstudio and hypernerf, "
    "which\n"
    "                      list what is held out; in others a NAME's hold is left out\n"
    "  --layout L          blender, nerfstudio, colmap, colmap-text, hypernerf, neu3d, calibration "
    "or\n"
    "                      llff, of which the last has stills of one time (blender)\n"
    "  --video             neu3d and calibration: lossless videos by ffmpeg, not frames\n"
    "  --seed S            of textures, points, errors and tints, 32 bits (1)\n"
    "  -j N                threads (all)\n"
    "  -f                  write into a folder that is not empty\n"
    "  -h, -V              this help, the version\n"
    "truth.json in the folder says what is held out or disturbed.\n";

static const char names[] = "NAMEs, with picture size, training + test cameras, times, hold:\n";

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

/* Parses a decimal integer in [low, high]. */
static int number(const char *text, long long low, long long high, long long *value)
{
    char *end;

    errno = 0;
    *value = strtoll(text, &end, 10);
    if (end == text || *end != '\0' || errno != 0 || *value < low || *value > high)
        return complain(text, "not a number in the range of its option (see -h)");
    return EXIT_FINE;
}

static int integer(const char *text, int low, int high, int *value)
{
    long long v;
    const int status = number(text, low, high, &v);

    if (status == EXIT_FINE)
        *value = (int)v;
    return status;
}

/* Parses a size such as "160x120". */
static int size_of(const char *text, ted4_ray_options *o)
{
    char width[16];
    const char *const x = strchr(text, 'x');
    const size_t n = x == NULL ? 0 : (size_t)(x - text);

    if (n == 0 || n >= sizeof width)
        return complain(text, "a size looks like 160x120");
    memcpy(width, text, n);
    width[n] = '\0';
    if (integer(width, 8, TED4_RAY_MAX_SIDE, &o->width) != EXIT_FINE)
        return EXIT_TROUBLE;
    return integer(x + 1, 8, TED4_RAY_MAX_SIDE, &o->height);
}

/* Parses a number in [0, high]. */
static int real(const char *text, double high, double *value)
{
    char *end;

    *value = strtod(text, &end);
    if (end == text || *end != '\0' || !(*value >= 0 && *value <= high))
        return complain(text, "not a number in the range of its option (see -h)");
    return EXIT_FINE;
}

/* Parses "0", or "2" to "1000". */
static int hold_of(const char *text, int *hold)
{
    const int status = integer(text, 0, TED4_RAY_MAX_COUNT, hold);

    if (status == EXIT_FINE && *hold == 1)
        return complain(text, "would hold out every time");
    return status;
}

static void help(void)
{
    fputs(usage, stdout);
    fputs(ted4_scene_ways_help, stdout);
    fputs(names, stdout);
    for (int s = 0; s < RAY_SCENES; s++) {
        const ted4_ray_plan *const p = ted4_ray_plan_of((ted4_ray_scene)s);

        printf("  %-8s  %s (%dx%d, %d + %d, %d, %d)\n", p->name, p->shows, p->width, p->height,
               p->n_train, p->n_test, p->n_frames, p->hold);
    }
}

/* Takes the options that were not given from the table. */
static int fill(ted4_ray_options *o)
{
    const ted4_ray_options d = ted4_ray_defaults(o->scene);

    const int lists = ted4_ray_has_lists(o->layout);

    if (o->hold > 0 && !lists)
        return complain("--hold", "goes with the layouts blender, nerfstudio and hypernerf");
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
    if ((o->pose_error > 0 || o->tint > 0) && !lists)
        return complain("errors and tints",
                        "go with the layouts blender, nerfstudio and hypernerf: "
                        "others hold out pictures of disturbed cameras");
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
    for (int l = 0; l < RAY_LAYOUTS; l++) {
        if (strcmp(name, ted4_ray_layout_name((ted4_ray_layout)l)) == 0) {
            o->layout = (ted4_ray_layout)l;
            return EXIT_FINE;
        }
    }
    return complain(name, "not a layout (see -h)");
}

static int way(command *c, int number_of_option, const char *text)
{
    if (ted4_scene_way(number_of_option, text, &c->set.ways) == 0)
        return EXIT_FINE;
    return complain(text, "not what goes with its option (see -h)");
}

static int option(command *c, int letter, const char *text)
{
    long long seed = 0;
    int status = EXIT_FINE;

    switch (letter) {
    case 'o': c->folder = text; break;
    case 'f': c->force = 1; break;
    case 'j': status = integer(text, 1, 1024, &c->threads); break;
    case 's': status = size_of(text, &c->set); break;
    case 'c': status = integer(text, 1, TED4_RAY_MAX_COUNT, &c->set.n_train); break;
    case 't': status = integer(text, 0, TED4_RAY_MAX_COUNT, &c->set.n_test); break;
    case 'n': status = integer(text, 1, TED4_RAY_MAX_COUNT, &c->set.n_frames); break;
    case 'H': status = hold_of(text, &c->set.hold); break;
    case 'p': status = real(text, TED4_RAY_MOST_ERROR, &c->set.pose_error); break;
    case 'T': status = real(text, TED4_RAY_MOST_TINT, &c->set.tint); break;
    case 'l': status = layout_of(text, &c->set); break;
    case 'v': c->set.video = 1; break;
    case 'r':
        status = number(text, 0, UINT32_MAX, &seed);
        c->set.seed = (uint32_t)seed;
        break;
    default:
        if (letter >= TED4_SCENE_WAYS)
            return way(c, letter, text);
        fputs("ted4scene: see ted4scene -h\n", stderr);
        status = EXIT_TROUBLE;
    }
    return status;
}

/* Returns EXIT_FINE, EXIT_TROUBLE, or -1 if -h or -V has already been handled. */
static int parse(int argc, char **argv, command *c)
{
    static const struct option own[] = { { "size", required_argument, NULL, 's' },
                                         { "cameras", required_argument, NULL, 'c' },
                                         { "test-cameras", required_argument, NULL, 't' },
                                         { "frames", required_argument, NULL, 'n' },
                                         { "hold", required_argument, NULL, 'H' },
                                         { "pose-error", required_argument, NULL, 'p' },
                                         { "tint", required_argument, NULL, 'T' },
                                         { "layout", required_argument, NULL, 'l' },
                                         { "video", no_argument, NULL, 'v' },
                                         { "seed", required_argument, NULL, 'r' },
                                         { "help", no_argument, NULL, 'h' },
                                         { "version", no_argument, NULL, 'V' } };
    enum { OWN = sizeof own / sizeof own[0] };
    struct option longs[OWN + TED4_SCENE_N_WAYS + 1] = { { NULL, 0, NULL, 0 } };
    int letter;

    memcpy(longs, own, sizeof own);
    memcpy(longs + OWN, ted4_scene_ways, sizeof ted4_scene_ways);

    while ((letter = getopt_long(argc, argv, "o:j:fhV", longs, NULL)) != -1) {
        if (letter == 'h' || letter == 'V') {
            if (letter == 'h')
                help();
            else
                puts("ted4scene " TED4_VERSION);
            return -1;
        }
        if (option(c, letter, optarg) != EXIT_FINE)
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
                           .tint = -1 },
                  .threads = omp_get_max_threads() };
    const ted4_parallel threads = { run_openmp, &c.threads };
    ted4_ray_message m;
    const int status = parse(argc, argv, &c);

    if (status != EXIT_FINE)
        return status < 0 ? EXIT_FINE : EXIT_TROUBLE;
    if (!c.force && is_occupied(c.folder))
        return complain(c.folder, "is not empty; -f to write into it");
    if (ted4_ray_write(&c.set, c.folder, &threads, &m) != 0) {
        fprintf(stderr, "ted4scene: %s\n", m.text);
        return EXIT_TROUBLE;
    }
    return EXIT_FINE;
}
