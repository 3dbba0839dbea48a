/* ted4scene.c - command line: makes one of the project's own scenes (see ray_world.h) as a folder
 * of pictures with poses.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <dirent.h>
#include <errno.h>
#include <getopt.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "ray_set.h"
#include "ted4.h"

enum { EXIT_FINE = 0, EXIT_TROUBLE = 3 };

static const char usage[] =
    "usage: ted4scene NAME -o FOLDER [options]\n"
    "Makes a small synthetic dynamic scene.\n"
    "NAME: still, turn, occluder, pop, bend or fair\n"
    "  -o FOLDER           where to; made if missing, must be empty without -f\n"
    "  --size WxH          picture size, 8 to 4096 (160x120)\n"
    "  --cameras N         training cameras, 1 to 1000 (12)\n"
    "  --test-cameras N    test cameras, 0 to 1000 (2)\n"
    "  --frames N          times, 1 to 1000 (16)\n"
    "  --layout L          blender, nerfstudio, colmap, colmap-text, hypernerf, neu3d or\n"
    "                      calibration (blender)\n"
    "  --video             neu3d and calibration: lossless videos by ffmpeg, not frames\n"
    "  --seed S            of textures and points, 32 bits (1)\n"
    "  -j N                threads (all)\n"
    "  -f                  write into a folder that is not empty\n"
    "  -h, -V              this help, the version\n";

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

/* A whole decimal number in [low, high]. */
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

/* "160x120" */
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

static int scene_of(const char *name, ted4_ray_options *o)
{
    for (int s = 0; s < RAY_SCENES; s++) {
        if (strcmp(name, ted4_ray_scene_name((ted4_ray_scene)s)) == 0) {
            o->scene = (ted4_ray_scene)s;
            return EXIT_FINE;
        }
    }
    return complain(name, "not one of still, turn, occluder, pop, bend, fair");
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

static int option(command *c, int letter, const char *text)
{
    long long seed = 0;
    int status = EXIT_FINE;

    switch (letter) {
    case 'o':
        c->folder = text;
        break;
    case 'f':
        c->force = 1;
        break;
    case 'j':
        status = integer(text, 1, 1024, &c->threads);
        break;
    case 's':
        status = size_of(text, &c->set);
        break;
    case 'c':
        status = integer(text, 1, TED4_RAY_MAX_COUNT, &c->set.n_train);
        break;
    case 't':
        status = integer(text, 0, TED4_RAY_MAX_COUNT, &c->set.n_test);
        break;
    case 'n':
        status = integer(text, 1, TED4_RAY_MAX_COUNT, &c->set.n_frames);
        break;
    case 'l':
        status = layout_of(text, &c->set);
        break;
    case 'v':
        c->set.video = 1;
        break;
    case 'r':
        status = number(text, 0, UINT32_MAX, &seed);
        c->set.seed = (uint32_t)seed;
        break;
    default:
        fputs("ted4scene: see ted4scene -h\n", stderr);
        status = EXIT_TROUBLE;
    }
    return status;
}

/* EXIT_FINE, EXIT_TROUBLE, or -1 when -h or -V has done the work. */
static int parse(int argc, char **argv, command *c)
{
    static const struct option longs[] = { { "size", required_argument, NULL, 's' },
                                           { "cameras", required_argument, NULL, 'c' },
                                           { "test-cameras", required_argument, NULL, 't' },
                                           { "frames", required_argument, NULL, 'n' },
                                           { "layout", required_argument, NULL, 'l' },
                                           { "video", no_argument, NULL, 'v' },
                                           { "seed", required_argument, NULL, 'r' },
                                           { "help", no_argument, NULL, 'h' },
                                           { "version", no_argument, NULL, 'V' },
                                           { NULL, 0, NULL, 0 } };
    int letter;

    while ((letter = getopt_long(argc, argv, "o:j:fhV", longs, NULL)) != -1) {
        if (letter == 'h' || letter == 'V') {
            fputs(letter == 'h' ? usage : "ted4scene " TED4_VERSION "\n", stdout);
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
    return scene_of(argv[optind], &c->set);
}

/* Whether there is anything in folder; a folder that does not exist is empty. */
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
    command c = { .set = { .width = 160,
                           .height = 120,
                           .n_train = 12,
                           .n_test = 2,
                           .n_frames = 16,
                           .seed = 1 },
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
