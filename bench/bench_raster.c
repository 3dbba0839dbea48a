/* bench_raster.c - measures the forward and backward passes of the rasteriser on random scenes at
 * 480x270 with about 33 blended Gaussians per pixel. All levels of the machine are timed in turn.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "measure.h"
#include "raster_scene.h"
#include "tool/threads.h"
#include "train/raster/raster_bwd.h"

enum { WIDTH = 480, HEIGHT = 270, N_PIXELS = WIDTH * HEIGHT, ROUNDS = 40 };

/* Standard deviation in pixels for about 33 blended Gaussians per pixel. The low-pass filter
 * enlarges small Gaussians, so that the exponent is not exactly that of the area. */
#define SIGMA(n) (0.465 * pow(1e5 / (double)(n), 0.56))

typedef struct {
    double forward, backward; /* ms */
} times;

typedef struct {
    scene s;
    ted4_splats g;
    ted4_view v;
    ted4_raster *r;
    ted4_adjoint *adjoint;
    ted4_splat_grads grads;
    scene d;
    float *image, *d_image;
} bench;

static void bench_init(bench *b, size_t n)
{
    uint64_t seed = 1;

    b->v = scene_view(WIDTH, HEIGHT);
    b->s = scene_random(n, &b->v, SIGMA(n), 1);
    must(b->s.value);
    for (size_t i = 0; i < n; i++)
        scene_place(&b->s, &b->v, i, scene_range(&seed, 0, WIDTH), scene_range(&seed, 0, HEIGHT),
                    scene_range(&seed, 1, 8));
    b->g = scene_splats(&b->s);
    b->d = (scene) { n, must(malloc(n * SCENE_PARAMS * sizeof(float))) };

    b->grads = (ted4_splat_grads) { .opacity = scene_param(&b->d, SCENE_OPACITY, 0),
                                    .mean2d = must(malloc(n * sizeof(float))),
                                    .visible = must(malloc(n)) };
    for (int k = 0; k < 3; k++) {
        b->grads.mean[k] = scene_param(&b->d, SCENE_MEAN + k, 0);
        b->grads.scale[k] = scene_param(&b->d, SCENE_SCALE + k, 0);
        b->grads.colour[k] = scene_param(&b->d, SCENE_COLOUR + k, 0);
    }
    for (int k = 0; k < 4; k++)
        b->grads.rot[k] = scene_param(&b->d, SCENE_ROT + k, 0);
    b->r = must(ted4_raster_new());
    b->adjoint = must(ted4_adjoint_new());
    b->image = must(malloc(3 * N_PIXELS * sizeof(float)));
    b->d_image = must(malloc(3 * N_PIXELS * sizeof(float)));
    for (size_t i = 0; i < 3 * N_PIXELS; i++)
        b->d_image[i] = (float)scene_range(&seed, -1, 1);
}

static void bench_free(bench *b)
{
    ted4_adjoint_free(b->adjoint);
    ted4_raster_free(b->r);
    scene_free(&b->s);
    scene_free(&b->d);
    free(b->grads.mean2d);
    free(b->grads.visible);
    free(b->image);
    free(b->d_image);
}

static times once(bench *b, const ted4_parallel *p)
{
    const double t0 = now_ms();
    int bad = ted4_raster_forward(b->r, &b->g, &b->v, p, 1, b->image);
    const double t1 = now_ms();

    bad |= ted4_raster_backward(b->adjoint, b->r, &b->g, &b->v, p, b->d_image, &b->grads);
    if (bad)
        must(NULL);
    return (times) { t1 - t0, now_ms() - t1 };
}

/* Returns the shortest time of each pass, as other work on the machine can only add time. */
static times best(const times *t, size_t n)
{
    times b = t[0];

    for (size_t i = 1; i < n; i++) {
        b.forward = fmin(b.forward, t[i].forward);
        b.backward = fmin(b.backward, t[i].backward);
    }
    return b;
}

static void print_times(const char *what, times t, size_t pairs)
{
    printf("  %-22s forward %7.2f ms (%5.2f ns a pair)  backward %7.2f ms (%5.2f)  both %7.2f ms\n",
           what, t.forward, t.forward * 1e6 / (double)pairs, t.backward,
           t.backward * 1e6 / (double)pairs, t.forward + t.backward);
}

/* Measures the second of two rounds with the same number of threads, as in training: by then, each
 * core has its data in its own cache, not in that of another core. */
static times settled(bench *b, const ted4_parallel *p)
{
    once(b, p);
    return once(b, p);
}

static void print_level(ted4_level level, const times *t, const times *top, size_t pairs)
{
    char what[64];

    snprintf(what, sizeof what, "%s, 1 thread", ted4_level_name(level));
    print_times(what, *t, pairs);
    if (t != top)
        printf("  %-22s forward %7.2f                      backward %7.2f           both %7.2f\n",
               "  ratio", t->forward / top->forward, t->backward / top->backward,
               (t->forward + t->backward) / (top->forward + top->backward));
}

static void report(size_t n)
{
    const ted4_level most = ted4_level_of_machine();
    ted4_parallel two;
    times one_t[TED4_LEVELS][ROUNDS], two_t[ROUNDS], t1[TED4_LEVELS];
    bench b;

    ted4_threads_init(&two, 2);
    bench_init(&b, n);
    once(&b, NULL);
    const pair_count count = count_pairs(b.r, &b.v);
    const size_t pairs = count.blended;
    printf("%zu Gaussians, %dx%d: %.1f blended a pixel, %zu visible, %zu instances, %.0f %% of "
           "lanes blended\n",
           n, WIDTH, HEIGHT, (double)pairs / N_PIXELS, b.r->n_visible, b.r->n_instances,
           100.0 * (double)pairs / (double)count.computed);
    for (int i = 0; i < ROUNDS; i++) {
        for (ted4_level level = TED4_LEVEL_BASE; level <= most; level++) {
            ted4_level_use(level);
            one_t[level][i] = settled(&b, NULL);
        }
        two_t[i] = settled(&b, &two);
    }
    for (ted4_level level = TED4_LEVEL_BASE; level <= most; level++)
        t1[level] = best(one_t[level], ROUNDS);
    for (ted4_level level = most; level >= TED4_LEVEL_BASE; level--)
        print_level(level, &t1[level], &t1[most], pairs);

    const times t2 = best(two_t, ROUNDS);

    print_times("the first, 2 threads", t2, pairs);
    printf("  speed-up by 2 threads  %.2f\n",
           (t1[most].forward + t1[most].backward) / (t2.forward + t2.backward));
    bench_free(&b);
    ted4_threads_finish(&two);
}

int main(void)
{
    report(10000);
    report(100000);
    return 0;
}
