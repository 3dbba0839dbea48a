/* bench_render.c - measures how many frames per second the decoder renders of a scene with 100,000
 * Gaussians in view, at 960x536. Each frame has another time and another camera, so that all
 * deformations and heads are evaluated again. The scene is made here, with the sizes of two
 * presets; all anchors move. Usage: bench_render.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>

#include "measure.h"
#include "math/compare.h"
#include "norm/half.h"
#include "norm/scene.h"
#include "raster_scene.h"
#include "render/view.h"
#include "tool/threads.h"

enum { WIDTH = 960, HEIGHT = 536, N_GAUSSIANS = 101000, FRAMES = 300, ROUNDS = 60 };

/* The camera is at this distance before the origin and looks along +z: depths from 2 to 4. */
#define DISTANCE 3.0f
#define FOCAL    (0.9f * WIDTH)

/* spec 10.1: the index of the step size Q0. */
enum { STEP_ONE = 128 };

typedef struct {
    const char *preset;
    int offsets, feature, head_width, bank_dim, deform_width, deform_layers;
} model;

typedef struct {
    double query, draw, both; /* ms */
} times;

typedef struct {
    ted4_scene *scene;
    ted4_recon *recon;
    ted4_viewer *viewer;
    ted4_info info;
    uint8_t *rgb;
} bench;

static ted4_header make_header(const model *m)
{
    ted4_header h = {
        .n_anchors = (uint32_t)((N_GAUSSIANS + m->offsets - 1) / m->offsets),
        .tile_size = 4096,
        .n_offsets = (uint8_t)m->offsets,
        .feature_dim = (uint8_t)m->feature,
        .motion = TED4_MOTION_BANK,
        .phi_dim = 8,
        .bank_rows = FRAMES / 2,
        .bank_dim = (uint16_t)m->bank_dim,
        .deform_layers = (uint8_t)m->deform_layers,
        .deform_width = (uint16_t)m->deform_width,
        .temporal_mask = 1,
        .offset_mask = 1,
        .activation = 1,
        .view = TED4_VIEW_COLOUR,
        .head_layers = 1,
        .head_width = (uint16_t)m->head_width,
        .scale_domain = TED4_SCALE_LOG2,
        .prior = TED4_PRIOR_INR,
        .pe_octaves = 10,
        .hyper_layers = 1,
        .hyper_width = 16,
        .n_slices = 1,
        .slice = { (uint8_t)m->feature },
        .ar_width = 16,
        .step = { 1.0f, 0.02f, 0.1f, 0.1f, 0.01f },
        .frames = FRAMES,
        .rate_num = 30,
        .rate_den = 1,
    };

    return h;
}

/* Draws weights that keep values near 1 at any width. In the last layer they are multiplied by
 * last, and the biases are bias. */
static void fill_network(ted4_scene *s, int net, double last, float bias, uint64_t *seed)
{
    const ted4_net_shape *n = &s->shape.netr[net];
    float *w = s->netr.values + n->first;

    for (int l = 0; l < n->n_layers; l++) {
        const int is_last = l + 1 == n->n_layers;
        const double size = 1.7 / sqrt(n->dim[l]) * (is_last ? last : 1.0);

        for (size_t k = 0; k < (size_t)n->dim[l] * n->dim[l + 1]; k++)
            *w++ = (float)scene_range(seed, -size, size);
        for (size_t k = 0; k < n->dim[l + 1]; k++)
            *w++ = is_last ? bias : 0.0f;
    }
}

/* Draws values of a type, in units of its Q0. */
static void fill_symbols(ted4_scene *s, ted4_type t, double middle, double spread, uint64_t *seed)
{
    const size_t n = s->head.n_anchors;

    memset(s->step_index[t], STEP_ONE, n);
    for (size_t i = 0; i < n * s->shape.dim[t]; i++)
        s->symbol[t][i] =
            (int16_t)lrint((middle + spread * scene_normal(seed)) / (double)s->head.step[t]);
}

/* Spreads the anchors over the picture, at any depth. */
static void place_anchors(ted4_scene *s, uint64_t *seed)
{
    for (size_t i = 0; i < s->head.n_anchors; i++) {
        const double z = scene_range(seed, -1, 1), slope = (z + (double)DISTANCE) / (double)FOCAL;

        s->position[3 * i] =
            ted4_float_to_half((float)(scene_range(seed, -0.47, 0.47) * WIDTH * slope));
        s->position[3 * i + 1] =
            ted4_float_to_half((float)(scene_range(seed, -0.47, 0.47) * HEIGHT * slope));
        s->position[3 * i + 2] = ted4_float_to_half((float)z);
        s->dynamic[i] = 1;
        s->offset_bits[i] = (uint16_t)((1u << s->head.n_offsets) - 1);
    }
}

static ted4_scene *make_scene(const model *m)
{
    const ted4_header h = make_header(m);
    ted4_scene *s = must(ted4_scene_new(&h, NULL));
    const size_t n = h.n_anchors;
    uint64_t seed = 1;

    place_anchors(s, &seed);
    fill_network(s, TED4_NET_PROJECT, 1.0, 0.0f, &seed);
    fill_network(s, TED4_NET_DEFORM, 0.01, 0.0f, &seed);
    fill_network(s, TED4_NET_OPACITY, 0.3, 0.6f, &seed);
    fill_network(s, TED4_NET_COVARIANCE, 1.0, 0.0f, &seed);
    fill_network(s, TED4_NET_COLOUR, 1.0, 0.0f, &seed);
    for (size_t i = 0; i < s->bank.n; i++)
        s->bank.values[i] = (float)scene_normal(&seed);
    fill_symbols(s, TED4_FEATURE, 0, 1, &seed);
    fill_symbols(s, TED4_SCALING, -6.4, 0.8, &seed); /* log2 of a scale: about one pixel */
    fill_symbols(s, TED4_OFFSET, 0, 1.5, &seed);
    fill_symbols(s, TED4_PHI, 0, 1, &seed);
    fill_symbols(s, TED4_TAU, 0, 0, &seed); /* span from 0 to 1: active at all times */
    for (size_t i = 0; i < n; i++)
        s->symbol[TED4_TAU][2 * n + i] = (int16_t)lrint(1.0 / (double)h.step[TED4_TAU]);
    return s;
}

/* The camera of frame i, which sways by a few pixels. */
static ted4_view camera_of(int i)
{
    return (ted4_view) { .width = WIDTH,
                         .height = HEIGHT,
                         .fx = FOCAL,
                         .fy = FOCAL,
                         .cx = 0.5f * WIDTH,
                         .cy = 0.5f * HEIGHT,
                         .R = { 1, 0, 0, 0, 1, 0, 0, 0, 1 },
                         .t = { 0.01f * sinf(0.2f * (float)i), 0.01f * cosf(0.3f * (float)i),
                                DISTANCE } };
}

static void check(ted4_status status)
{
    if (status != TED4_OK) {
        fprintf(stderr, "bench_render: %s\n", ted4_status_id(status));
        exit(1);
    }
}

static times once(bench *b, const ted4_parallel *p, int i)
{
    const ted4_view camera = camera_of(i);
    ted4_gaussians g;
    const double t0 = now_ms();

    check(ted4_query_for_view(b->recon, (uint32_t)(i % FRAMES), FRAMES - 1, &camera, p, &g));
    const double t1 = now_ms();
    check(ted4_render_gaussians(b->viewer, &g, &b->info, &camera, p, b->rgb));
    const double t2 = now_ms();

    return (times) { t1 - t0, t2 - t1, t2 - t0 };
}

/* Returns the shortest times, and sets *median to the median of the sum. */
static times best(const times *t, double *median)
{
    times b = t[0];
    double both[ROUNDS];

    for (int i = 0; i < ROUNDS; i++) {
        b.query = fmin(b.query, t[i].query);
        b.draw = fmin(b.draw, t[i].draw);
        b.both = fmin(b.both, t[i].both);
        both[i] = t[i].both;
    }
    qsort(both, ROUNDS, sizeof *both, ted4_compare_doubles);
    *median = both[ROUNDS / 2];
    return b;
}

static void print_times(ted4_level level, int threads, const times *t)
{
    double median;
    const times b = best(t, &median);

    printf("  %-2s, %d thread%s  deformation, heads %6.2f ms  picture %6.2f ms  "
           "best %6.2f ms = %5.1f frames/s  median %6.2f ms = %5.1f frames/s\n",
           ted4_level_name(level), threads, threads == 1 ? " " : "s", b.query, b.draw, b.both,
           1e3 / b.both, median, 1e3 / median);
}

/* Prints the contents of one frame. */
static void print_load(const bench *b, const model *m)
{
    ted4_view camera = camera_of(0);
    ted4_raster *r = must(ted4_raster_new());
    float *image = must(malloc(3 * sizeof(float) * WIDTH * HEIGHT));
    ted4_gaussians g;

    camera.near_z = (float)TED4_VIEW_NEAR;
    check(ted4_query_for_view(b->recon, 0, FRAMES - 1, &camera, NULL, &g));
    const ted4_splats s = { g.n,
                            { g.mean[0], g.mean[1], g.mean[2] },
                            { g.scale[0], g.scale[1], g.scale[2] },
                            { g.rot[0], g.rot[1], g.rot[2], g.rot[3] },
                            g.opacity,
                            { g.colour[0], g.colour[1], g.colour[2] } };
    if (ted4_raster_forward(r, &s, &camera, NULL, 1, image) != 0)
        must(NULL);
    const pair_count count = count_pairs(r, &camera);

    printf("preset %s: %u moving anchors of %d Gaussians, F %d, heads %d wide, F_deform %d x %d, "
           "bank %d wide\n",
           m->preset, b->info.n_anchors, m->offsets, m->feature, m->head_width, m->deform_layers,
           m->deform_width, m->bank_dim);
    printf("  %dx%d: %zu of %zu Gaussians visible, %.1f blended a pixel\n", WIDTH, HEIGHT,
           r->n_visible, g.n, (double)count.blended / (WIDTH * HEIGHT));
    free(image);
    ted4_raster_free(r);
}

/* Selects the level as the programs do; the decoder's kernels follow the environment. */
static void use(ted4_level level)
{
    setenv("TED4_KERNEL", ted4_level_name(level), 1);
    ted4_level_use(level);
}

static void report(const model *m, ted4_level level, const ted4_parallel *two)
{
    times one_t[ROUNDS], two_t[ROUNDS];
    bench b = { .scene = make_scene(m),
                .viewer = must(ted4_viewer_new()),
                .rgb = must(malloc(3 * WIDTH * HEIGHT)) };

    use(level);
    ted4_scene_info(b.scene, &b.info);
    check(ted4_recon_new(&b.recon, b.scene, NULL));
    if (level == ted4_level_of_machine())
        print_load(&b, m);
    for (int i = 0; i < ROUNDS;
         i++) { /* each frame differs from the previous one, so that no result is reused */
        one_t[i] = once(&b, NULL, 2 * i + 1);
        two_t[i] = once(&b, two, 2 * i + 2);
    }
    print_times(level, 1, one_t);
    print_times(level, 2, two_t);
    ted4_recon_free(b.recon);
    ted4_viewer_free(b.viewer);
    ted4_scene_free(b.scene);
    free(b.rgb);
}

int main(void)
{
    static const model models[] = {
        { "fast", 8, 32, 32, 64, 64, 2 },
        { "paper", 10, 50, 50, 128, 128, 2 },
    };
    ted4_parallel two;

    ted4_threads_init(&two, 2);
    for (size_t i = 0; i < sizeof models / sizeof models[0]; i++)
        for (ted4_level level = ted4_level_of_machine(); level >= TED4_LEVEL_BASE; level--)
            report(&models[i], level, &two);
    ted4_threads_finish(&two);
    return 0;
}
