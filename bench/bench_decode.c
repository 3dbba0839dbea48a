/* bench_decode.c - measures how long files take to decode on one core, with the kernels of each
 * level of this machine and with none, in turn, and the share of the entropy stage: the work that
 * the library hands to the caller's threads tile by tile (prior, coder, symbols; spec 9, 10). All
 * levels must give the same scene. Usage: bench_decode FILE.ted4...
 * SPDX-License-Identifier: BSD-2-Clause */
#include <errno.h>
#include <math.h>

#include "base/bytes.h"
#include "base/level.h"
#include "measure.h"
#include "norm/scene.h"
#include "tool/cli.h"

enum { ROUNDS = 20 };

typedef struct {
    double whole, entropy; /* ms */
} times;

/* Runs the jobs one after another and adds up their time. */
static void run_timed(void *user, size_t n, void (*body)(void *arg, size_t i), void *arg)
{
    const double begin = now_ms();

    for (size_t i = 0; i < n; i++)
        body(arg, i);
    *(double *)user += now_ms() - begin;
}

/* Returns 0, or -1 after printing a line. Sets info to that of the scene, with its hash, and
 * *symbols to the number of its coded symbols without masks. */
static int once(const char *path, const uint8_t *bytes, size_t size, times *t, ted4_info *info,
                double *symbols)
{
    ted4_parallel timed = { run_timed, &t->entropy };
    ted4_options o = { .parallel = &timed };
    ted4_error e;
    ted4_scene *s;

    t->entropy = 0;
    const double begin = now_ms();
    const ted4_status status = ted4_decode(bytes, size, &o, &s, &e);

    t->whole = now_ms() - begin;
    if (status != TED4_OK) {
        fprintf(stderr, "bench_decode: %s: byte %zu: %s\n", path, e.offset, ted4_status_id(e.code));
        return -1;
    }
    ted4_scene_info(s, info);

    const ted4_shape *shape = &s->shape;

    *symbols = (double)info->n_anchors *
                   (shape->dim[TED4_FEATURE] + shape->dim[TED4_SCALING] + shape->dim[TED4_TAU]) +
               3.0 * (double)info->n_gaussians + (double)info->n_dynamic * shape->dim[TED4_PHI];
    ted4_scene_free(s);
    return 0;
}

static void keep_best(times *best, const times *t)
{
    best->whole = fmin(best->whole, t->whole);
    best->entropy = fmin(best->entropy, t->entropy);
}

/* Lists the levels with different decoders, the fastest first. Returns their number. */
static int levels_here(ted4_level *level)
{
    int n = 0;

    for (int l = ted4_level_of_machine(); l >= TED4_LEVEL_PLAIN; l--) {
#if !defined(__aarch64__)
        if (l == TED4_LEVEL_BASE) /* same decoder as PLAIN */
            continue;
#endif
        level[n++] = (ted4_level)l;
    }
    return n;
}

static void print_level(ted4_level level, const times *t, double symbols)
{
    printf("  %-6s  whole %7.1f ms  entropy stage %7.1f ms (%5.1f million symbols/s)\n",
           ted4_level_name(level), t->whole, t->entropy, symbols / t->entropy / 1e3);
}

static void print_ratio(const char *of, const char *to, const times *a, const times *b)
{
    printf("  ratio   whole %7.2f     entropy stage %7.2f     (%s to %s)\n", a->whole / b->whole,
           a->entropy / b->entropy, of, to);
}

static int measure(const char *path, const uint8_t *bytes, size_t size)
{
    ted4_level level[TED4_LEVELS];
    const int n = levels_here(level);
    times best[TED4_LEVELS], t;
    ted4_info info[TED4_LEVELS];
    double symbols = 0;
    int same = 1;

    for (int i = 0; i < n; i++)
        best[i] = (times) { INFINITY, INFINITY };
    for (int i = 0; i < n * ROUNDS; i++) {
        setenv("TED4_KERNEL", ted4_level_name(level[i % n]), 1);
        if (once(path, bytes, size, &t, &info[i % n], &symbols) != 0)
            return 1;
        keep_best(&best[i % n], &t);
        same &= memcmp(info[i % n].hash, info[0].hash, sizeof info[0].hash) == 0;
    }
    const char *const slash = strrchr(path, '/');

    printf("%s: %zu bytes, %u anchors, %.0f symbols; same scene: %s\n",
           slash != NULL ? slash + 1 : path, size, info[0].n_anchors, symbols, same ? "yes" : "NO");
    for (int i = 0; i < n; i++)
        print_level(level[i], &best[i], symbols);
    for (int i = 1; i < n; i++)
        print_ratio(ted4_level_name(level[i]), ted4_level_name(level[0]), &best[i], &best[0]);
    return !same;
}

int main(int argc, char **argv)
{
    int bad = argc < 2;

    if (bad)
        fputs("usage: bench_decode FILE.ted4...\n", stderr);
    for (int i = 1; i < argc; i++) {
        size_t size;
        uint8_t *const bytes = ted4_read_file(argv[i], &size);

        if (bytes == NULL) {
            fprintf(stderr, "bench_decode: %s: %s\n", argv[i], strerror(errno));
            return 3;
        }
        bad |= measure(argv[i], bytes, size);
        free(bytes);
    }
    return bad ? 3 : 0;
}
