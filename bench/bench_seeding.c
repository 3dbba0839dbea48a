/* bench_seeding.c - measures the search of multi-view seeding (train/densify/sweep_depths.h) on
 * random pictures of cameras in a ring, every pixel of which misses something. All levels of the
 * machine are timed in turn, on one thread.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "measure.h"
#include "random_source.h"
#include "train/densify/error_view.h"
#include "train/densify/sweep_depths.h"
#include "train/densify/view_geometry.h"

enum { ROUNDS = 5, RAYS = 2000 };

/* One frame. */
typedef struct {
    ted4_sweep_view *views; /* [n] */
    size_t n;
} frame;

/* Camera i of n, on an arc of a quarter around the scene's cube, 2.5 units from its centre. */
static ted4_view camera(size_t i, size_t n, int width, int height)
{
    const double a = 1.5708 * ((double)i / (double)(n - 1) - 0.5);
    const float c = (float)cos(a), s = (float)sin(a), f = (float)width;

    return (ted4_view) { .width = width,
                         .height = height,
                         .fx = f,
                         .fy = f,
                         .cx = f / 2,
                         .cy = (float)height / 2,
                         .R = { c, 0, s, 0, 1, 0, -s, 0, c },
                         .t = { 0, 0, 2.5f },
                         .near_z = 0.01f };
}

static frame frame_of(size_t n, int width, int height, int depths)
{
    const size_t pixels = (size_t)width * (size_t)height;
    frame f = { must(calloc(n, sizeof *f.views)), n };
    random_source r = random_seed(1);

    for (size_t i = 0; i < n; i++) {
        f.views[i] = (ted4_sweep_view) { .view = camera(i, n, width, height),
                                         .nearest = 1.5f,
                                         .farthest = 3.5f,
                                         .depths = depths,
                                         .pixel = must(malloc(pixels * sizeof(uint32_t))) };
        for (size_t k = 0; k < pixels; k++)
            f.views[i].pixel[k] = random_u32(&r) | (uint32_t)TED4_MISSING << 24;
    }
    return f;
}

/* Judges all depths on rays through a grid of pixels. Returns nanoseconds per depth and picture. */
static double once(const frame *f)
{
    const ted4_view *v = &f->views[0].view;
    const int step = (int)sqrt((double)v->width * v->height / RAYS), depths = f->views[0].depths;
    const double start = now_ms();
    size_t asked = 0;

    for (int row = step / 2; row < v->height; row += step)
        for (int column = step / 2; column < v->width; column += step) {
            ted4_sweep_ray ray = { .views = f->views, .n = f->n, .self = asked % f->n };
            ted4_swept_depths d;

            ray.pixel = f->views[ray.self].pixel[row * v->width + column];
            ted4_view_ray(&f->views[ray.self].view, column, row, ray.ray);
            for (int k = 0; k < depths; k += TED4_DEPTHS)
                ted4_sweep_depths(&ray, k, &d);
            asked++;
        }
    return 1e6 * (now_ms() - start) / ((double)asked * depths * (double)(f->n - 1));
}

static void report(size_t n, int width, int height, int depths)
{
    const ted4_level most = ted4_level_of_machine();
    const frame f = frame_of(n, width, height, depths);
    double best[TED4_LEVELS];

    for (int i = 0; i < ROUNDS; i++)
        for (ted4_level level = TED4_LEVEL_BASE; level <= most; level++) {
            ted4_level_use(level);
            const double ns = once(&f);
            best[level] = i == 0 ? ns : fmin(best[level], ns);
        }
    printf("%zu pictures of %dx%d, %d depths\n", n, width, height, depths);
    for (ted4_level level = most; level >= TED4_LEVEL_BASE; level--)
        printf("  %-4s %6.2f ns per depth and picture   ratio %.2f\n", ted4_level_name(level),
               best[level], best[level] / best[most]);
    for (size_t i = 0; i < n; i++)
        free(f.views[i].pixel);
    free(f.views);
}

int main(void)
{
    report(13, 240, 135, 96);
    report(20, 1352, 1014, 512);
    return 0;
}
