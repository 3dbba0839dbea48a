/* bench_generate.c - speed of ted4_generate and ted4_generate_backward for 200 blocks of 32
 * anchors. Build (from the project root, after make):
 *     gcc -std=c11 -O3 -march=native -fopenmp -Iref-decoder -Iref-encoder bench/bench_generate.c \
 *         build/libted4enc.a build/libted4dec.a -o /tmp/bench_generate -lm
 * Use: bench_generate [THREADS [SLOTS]]. One line per model: the best and median of 20 runs in
 * milliseconds, GFLOP/s of the best. Counted are the dense layers as the specification has them, a
 * multiply-add as 2: the generator does less for the first layers of motion, so its figure there
 * can pass the machine's peak.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "train/model.h"

enum { RUNS = 20 };

typedef struct {
    const char *name;
    int motion, feature, width, head_layers, bank_dim, deform_width, deform_layers;
} model;

static void run(void *user, size_t n, void (*body)(void *arg, size_t i), void *arg)
{
    (void)user;
#pragma omp parallel for schedule(dynamic)
    for (size_t i = 0; i < n; i++)
        body(arg, i);
}

static double now(void)
{
    struct timespec t;

    timespec_get(&t, TIME_UTC);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static float *fill(size_t n)
{
    static uint32_t seed = 1;
    float *v = aligned_alloc(64, (n + 15) / 16 * 64);

    if (v == NULL)
        exit(1);
    for (size_t i = 0; i < n; i++) {
        seed = seed * 1664525u + 1013904223u;
        v[i] = 0.3f * (float)((int32_t)seed >> 8) * 0x1p-23f;
    }
    return v;
}

static ted4_header header(const model *m)
{
    ted4_header h;

    memset(&h, 0, sizeof h);
    h.tile_size = 4096;
    h.n_offsets = 10;
    h.feature_dim = (uint8_t)m->feature;
    h.n_slices = 1;
    h.motion = (uint8_t)m->motion;
    if (m->motion != TED4_MOTION_NONE) {
        h.deform_layers = (uint8_t)m->deform_layers;
        h.deform_width = (uint16_t)m->deform_width;
        h.temporal_mask = 1;
    }
    if (m->bank_dim > 0) {
        h.phi_dim = 8;
        h.bank_rows = 150;
        h.bank_dim = (uint16_t)m->bank_dim;
    }
    h.offset_mask = 1;
    h.activation = 1;
    h.view = TED4_VIEW_COLOUR;
    h.head_layers = (uint8_t)m->head_layers;
    h.head_width = (uint16_t)m->width;
    return h;
}

/* Multiply-adds of one anchor. */
static double work(const ted4_shape *s)
{
    double n = 0.0;

    for (int k = 0; k < TED4_NETS_R; k++)
        for (int i = 0; i < s->netr[k].n_layers; i++)
            n += (double)s->netr[k].dim[i] * s->netr[k].dim[i + 1];
    return n;
}

static int by_value(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;

    return (x > y) - (x < y);
}

static void bench(const model *m, const ted4_parallel *p, size_t n)
{
    const ted4_header h = header(m);
    ted4_layout l;
    ted4_generator *g;
    ted4_splats s;
    double forward[RUNS], backward[RUNS], flop;

    ted4_layout_make(&l, &h);
    const size_t block = (size_t)l.n_channels * TED4_LANES;
    float *attr = fill(n * block), *d_attr = fill(n * block), *position = fill(n * 3 * TED4_LANES);
    float *net = fill(l.n_net), *d_net = fill(l.n_net), *gradient = fill(n * 10 * TED4_LANES);
    const float **attrs = malloc(n * sizeof *attrs), **positions = malloc(n * sizeof *positions);
    float **d_attrs = malloc(n * sizeof *d_attrs);
    uint32_t *lanes = malloc(n * sizeof *lanes);
    ted4_splat_grads gr = { { gradient, gradient, gradient }, { gradient, gradient, gradient },
        { gradient, gradient, gradient, gradient }, gradient,
        { gradient, gradient, gradient }, NULL, NULL };

    for (size_t i = 0; i < n; i++) {
        attrs[i] = attr + i * block;
        d_attrs[i] = d_attr + i * block;
        positions[i] = position + i * 3 * TED4_LANES;
        lanes[i] = 0xffffffffu;
    }
    const ted4_generate_input in = { &l, net, n, attrs, positions, lanes, 37, 299, { 1, 2, 3 }, 1 };

    g = ted4_generator_new(&l);
    for (int i = 0; i < RUNS; i++) {
        const double start = now();

        ted4_generator_pack(g, net);
        if (ted4_generate(g, &in, p, &s) != 0)
            exit(1);
        const double middle = now();

        ted4_generate_backward(g, &in, &gr, p, d_attrs, d_net);
        forward[i] = middle - start;
        backward[i] = now() - middle;
    }
    qsort(forward, RUNS, sizeof *forward, by_value);
    qsort(backward, RUNS, sizeof *backward, by_value);
    flop = 2e-9 * work(&l.shape) * TED4_LANES * (double)n;
    printf("%-24s forward %6.2f (%6.2f) ms %5.0f GFLOP/s   "
           "backward %6.2f (%6.2f) ms %5.0f GFLOP/s\n", m->name,
           1e3 * forward[0], 1e3 * forward[RUNS / 2], flop / forward[0],
           1e3 * backward[0], 1e3 * backward[RUNS / 2], 2.0 * flop / backward[0]);
    ted4_generator_free(g);
    free(attr), free(d_attr), free(position), free(net), free(d_net), free(gradient);
    free(attrs), free(positions), free(d_attrs), free(lanes);
}

int main(int argc, char **argv)
{
    static const model models[] = {
        { "static, F 32, width 32", TED4_MOTION_NONE, 32, 32, 1, 0, 0, 0 },
        { "static, F 50, width 50", TED4_MOTION_NONE, 50, 50, 1, 0, 0, 0 },
        { "bank 64, F 32, width 32", TED4_MOTION_BANK, 32, 32, 1, 64, 64, 1 },
        { "bank 128, F 50, width 50", TED4_MOTION_BANK, 50, 50, 1, 128, 128, 2 },
        { "concat, F 50, width 50", TED4_MOTION_CONCAT, 50, 50, 1, 128, 128, 2 },
        { "inr 256 x 8, F 50", TED4_MOTION_INR, 50, 50, 1, 0, 256, 8 },
    };
    const ted4_parallel p = { run, NULL };
    const size_t n = argc > 2 ? strtoul(argv[2], NULL, 10) : 200;

    omp_set_num_threads(argc > 1 ? atoi(argv[1]) : 1);
    for (size_t i = 0; i < sizeof models / sizeof models[0]; i++)
        bench(&models[i], &p, n);
    return 0;
}
