/* bench_decode.c - how long files take to decode on one core, with the decoder's kernels and with its plain ones, and how much of that is the entropy stage: what the
 * library hands to the caller's threads, a tile at a time (prior, coder, symbols; spec 9, 10). Both ways have to give the same scene.
 * Usage: bench_decode FILE.ted4...
 * SPDX-License-Identifier: BSD-2-Clause */
#include <errno.h>
#include <math.h>

#include "base/bytes.h"
#include "measure.h"
#include "norm/scene.h"
#include "tool/cli.h"

enum { ROUNDS = 20 };

typedef struct {
    double whole, entropy;      /* ms */
} times;

/* Runs jobs one after another and adds up how long they take. */
static void run_timed(void *user, size_t n, void (*body)(void *arg, size_t i), void *arg)
{
    const double begin = now_ms();

    for (size_t i = 0; i < n; i++)
        body(arg, i);
    *(double *)user += now_ms() - begin;
}

/* 0, or -1 with a line. The hash of the scene and its number of coded symbols without masks go to info and *symbols. */
static int once(const char *path, const uint8_t *bytes, size_t size, times *t, ted4_info *info, double *symbols)
{
    ted4_parallel timed = { run_timed, &t->entropy };
    ted4_options  o = { .parallel = &timed };
    ted4_error    e;
    ted4_scene   *s;

    t->entropy = 0;
    const double      begin = now_ms();
    const ted4_status status = ted4_decode(bytes, size, &o, &s, &e);

    t->whole = now_ms() - begin;
    if (status != TED4_OK) {
        fprintf(stderr, "bench_decode: %s: byte %zu: %s\n", path, e.offset, ted4_status_id(e.code));
        return -1;
    }
    ted4_scene_info(s, info);

    const ted4_shape *shape = &s->shape;

    *symbols = (double)info->n_anchors * (shape->dim[TED4_FEATURE] + shape->dim[TED4_SCALING] + shape->dim[TED4_TAU]) +
               3.0 * (double)info->n_gaussians + (double)info->n_dynamic * shape->dim[TED4_PHI];
    ted4_scene_free(s);
    return 0;
}

static void keep_best(times *best, const times *t)
{
    best->whole = fmin(best->whole, t->whole);
    best->entropy = fmin(best->entropy, t->entropy);
}

static int measure(const char *path, const uint8_t *bytes, size_t size)
{
    times     best[2] = { { INFINITY, INFINITY }, { INFINITY, INFINITY } }, t;
    ted4_info info[2];
    double    symbols;

    for (int i = 0; i < 2 * ROUNDS; i++) {
        const int plain = i % 2;

        if (plain)
            setenv("TED4_KERNEL", "plain", 1);
        else
            unsetenv("TED4_KERNEL");
        if (once(path, bytes, size, &t, &info[plain], &symbols) != 0)
            return 1;
        keep_best(&best[plain], &t);
    }
    const char *const slash = strrchr(path, '/');

    printf("%s: %zu bytes, %u anchors, %.0f symbols; same scene: %s\n", slash != NULL ? slash + 1 : path, size, info[0].n_anchors, symbols,
           memcmp(info[0].hash, info[1].hash, sizeof info[0].hash) == 0 ? "yes" : "NO");
    for (int plain = 0; plain < 2; plain++)
        printf("  %-8s whole %7.1f ms  entropy stage %7.1f ms (%5.1f million symbols/s)\n", plain ? "plain" : "kernels", best[plain].whole,
               best[plain].entropy, symbols / best[plain].entropy / 1e3);
    printf("  ratio    whole %7.2f     entropy stage %7.2f\n", best[1].whole / best[0].whole, best[1].entropy / best[0].entropy);
    return memcmp(info[0].hash, info[1].hash, sizeof info[0].hash) != 0;
}

int main(int argc, char **argv)
{
    int bad = argc < 2;

    if (bad)
        fputs("usage: bench_decode FILE.ted4...\n", stderr);
    for (int i = 1; i < argc; i++) {
        size_t         size;
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
