/* bench_train.c - what a training step costs, and which part of it how much: stage 1, stage 2 and its integer part, on one thread and on two.
 * The parts are known by the functions that do them: the linker puts those of this file in between (-Wl,--wrap, bench.mk), so the trainer itself is not touched
 * and a part that another calls is counted once, for the inner one. What runs on all threads is known by the regions that the trainer hands to its threads.
 * Usage: bench_train SCENE DOWNSCALE [OTHER]. OTHER: the same program from a plain scalar build; it is asked for its times on one thread.
 *        bench_train -t SCENE DOWNSCALE: one line "stage1_ms stage2_ms integer_ms" for that purpose.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>

#include "measure.h"
#include "tool/threads.h"
#include "train/raster_adjoint.h"
#include "train/trainer.h"

enum { STEPS = 150, WARM_UP = 15, PLAIN_STEPS = 60, ROUNDS = 2 };
enum { STAGE_1, STAGE_2, STAGE_INTEGER, STAGES };

/* Parts of a step, in about the order in which it does them. */
#define PARTS(P) \
    P(PICTURE,      "picture file to pixels") \
    P(SCHEDULE,     "checks, schedule") \
    P(VISIBLE,      "visible anchors") \
    P(GENERATE,     "heads, deformation") \
    P(PROJECT,      "projection") \
    P(BIN,          "sorting, tile lists") \
    P(BLEND,        "blending") \
    P(LOSS,         "L1, SSIM, gradient") \
    P(BLEND_BWD,    "blending, back") \
    P(PROJECT_BWD,  "projection, back") \
    P(GENERATE_BWD, "heads, deformation, back") \
    P(REGULARISE,   "volume, bank, statistics") \
    P(RATE,         "rate, forward and back") \
    P(ADAM,         "masks, Adam") \
    P(REST,         "the rest, quantisation too")

#define AS_ENUM(name, text) PART_##name,
#define AS_TEXT(name, text) text,
typedef enum { PARTS(AS_ENUM) N_PARTS } part;
static const char *const part_name[N_PARTS] = { PARTS(AS_TEXT) };
static const char *const stage_name[STAGES] = { "stage 1", "stage 2", "stage 2, integer" };

/* One step: ms of each part, of the step, and of it outside all parallel regions. */
typedef struct {
    double part[N_PARTS], whole, alone;
} sample;

/* What goes on now; the trainer's own thread alone looks at it. */
static struct {
    sample here;
    part   current;
    double since;               /* when current began or went on */
} clock_state;

typedef struct {
    sample step[STAGES][STEPS];
    size_t n[STAGES];
    size_t anchors[STAGES];
    double splats[STAGES];
} recording;

static part enter(part p)
{
    const part   before = clock_state.current;
    const double now = now_ms();

    clock_state.here.part[before] += now - clock_state.since;
    clock_state.since = now;
    clock_state.current = p;
    return before;
}

/* The functions in between. type __wrap_name is called where the trainer names name; __real_name is what it then gets. The linker compares no types: the
 * declaration by __typeof__ does. */
#define BETWEEN(part, type, name, parameters, arguments) \
    extern __typeof__(name) __wrap_##name; \
    type __real_##name parameters; \
    type __wrap_##name parameters \
    { \
        const enum_part before = enter(PART_##part); \
        const type      result = __real_##name arguments; \
        enter(before); \
        return result; \
    }
#define BETWEEN_VOID(part, name, parameters, arguments) \
    extern __typeof__(name) __wrap_##name; \
    void __real_##name parameters; \
    void __wrap_##name parameters \
    { \
        const enum_part before = enter(PART_##part); \
        __real_##name arguments; \
        enter(before); \
    }
typedef part enum_part;
typedef const uint8_t *pixels;

BETWEEN(PICTURE, pixels, ted4_dataset_pixels, (ted4_dataset *d, size_t i, ted4_message *m), (d, i, m))
BETWEEN(SCHEDULE, int, ted4_trainer_check, (ted4_trainer *t, int anchors), (t, anchors))
BETWEEN(SCHEDULE, int, ted4_schedule_event, (ted4_trainer *t), (t))
BETWEEN(VISIBLE, int, ted4_slots_fill, (ted4_trainer *t, const ted4_view *v), (t, v))
BETWEEN_VOID(GENERATE, ted4_generator_pack, (ted4_generator *g, const float *net), (g, net))
BETWEEN(GENERATE, int, ted4_generate,
        (ted4_generator *g, const ted4_generate_input *in, const ted4_parallel *p, ted4_splats *out), (g, in, p, out))
BETWEEN(PROJECT, int, ted4_raster_project, (ted4_raster *r, const ted4_splats *s, const ted4_view *v, const ted4_parallel *p), (r, s, v, p))
BETWEEN(BIN, int, ted4_raster_bin, (ted4_raster *r, const ted4_splats *s, const ted4_parallel *p), (r, s, p))
BETWEEN(BLEND, int, ted4_raster_blend, (ted4_raster *r, const ted4_view *v, const ted4_parallel *p, int keep, float *image), (r, v, p, keep, image))
BETWEEN(LOSS, double, ted4_loss,
        (ted4_loss_workspace *w, const float *image, const uint8_t *truth, int width, int height, float weight, const ted4_parallel *p, float *d_image,
         double *l1, double *ssim),
        (w, image, truth, width, height, weight, p, d_image, l1, ssim))
BETWEEN(BLEND_BWD, int, ted4_raster_blend_bwd, (ted4_raster *r, const ted4_view *v, const ted4_parallel *p, const float *d_image), (r, v, p, d_image))
BETWEEN_VOID(PROJECT_BWD, ted4_raster_project_bwd,
             (ted4_raster *r, const ted4_splats *s, const ted4_view *v, const ted4_parallel *p, const ted4_splat_grads *g), (r, s, v, p, g))
BETWEEN(GENERATE_BWD, int, ted4_generate_backward,
        (ted4_generator *g, const ted4_generate_input *in, const ted4_splat_grads *gr, const ted4_parallel *p, float *const *d_attr, float *d_net),
        (g, in, gr, p, d_attr, d_net))
BETWEEN(REGULARISE, size_t, ted4_update_volume, (ted4_trainer *t, const ted4_splats *s), (t, s))
BETWEEN_VOID(REGULARISE, ted4_update_bank, (ted4_trainer *t), (t))
BETWEEN_VOID(REGULARISE, ted4_densify_gather, (ted4_trainer *t, const ted4_generate_input *in, const ted4_splats *s), (t, in, s))
BETWEEN(RATE, int, ted4_update_rate, (ted4_trainer *t, uint64_t key), (t, key))
BETWEEN_VOID(ADAM, ted4_update_parameters, (ted4_trainer *t), (t))

/* A team that takes note of the time for which it works. */
static void run_region(void *user, size_t n, void (*body)(void *arg, size_t i), void *arg)
{
    const ted4_parallel *team = user;
    const double         begin = now_ms();

    ted4_parallel_for(team, n, body, arg);
    clock_state.here.alone -= now_ms() - begin;
}

static sample one_step(ted4_trainer *t)
{
    const double begin = now_ms();

    clock_state.here = (sample){ .whole = 0 };
    clock_state.current = PART_REST;
    clock_state.since = begin;
    if (ted4_trainer_step(t) != 0) {
        fprintf(stderr, "bench_train: %s\n", t->message.text);
        exit(3);
    }
    enter(PART_REST);
    clock_state.here.whole = now_ms() - begin;
    clock_state.here.alone += clock_state.here.whole;
    return clock_state.here;
}

/* The preset "fast" with as many anchors as it may have from the beginning, and short stages. */
static void choose_options(ted4_train_options *o, int steps)
{
    char why[256], text[7][64];

    snprintf(text[0], sizeof text[0], "stage1=%d", steps);
    snprintf(text[1], sizeof text[1], "stage2=%d", 2 * steps);
    snprintf(text[2], sizeof text[2], "integer_share=0.5");
    snprintf(text[3], sizeof text[3], "init_anchors=16000");
    snprintf(text[4], sizeof text[4], "activation_start=0");
    snprintf(text[5], sizeof text[5], "probe=0");
    snprintf(text[6], sizeof text[6], "capacity=0");
    must(ted4_options_preset(o, "fast") == 0 ? o : NULL);
    for (int i = 0; i < 7; i++)
        if (ted4_options_set(o, text[i], why, sizeof why) != 0) {
            fprintf(stderr, "bench_train: %s\n", why);
            exit(3);
        }
}

static void record(recording *r, ted4_dataset *d, const ted4_parallel *team, int steps)
{
    const ted4_parallel noted = { run_region, (void *)(uintptr_t)team };
    ted4_train_options  o;
    ted4_trainer        t;

    memset(r, 0, sizeof *r);
    choose_options(&o, steps);
    if (ted4_trainer_init(&t, &o, d, &noted) != 0) {
        fprintf(stderr, "bench_train: %s\n", t.message.text);
        exit(3);
    }
    while (t.iteration < ted4_trainer_total(&t)) {
        const sample s = one_step(&t);
        const int    stage = t.integer ? STAGE_INTEGER : t.stage2 ? STAGE_2 : STAGE_1;

        if (r->n[stage] < STEPS)
            r->step[stage][r->n[stage]++] = s;
        r->anchors[stage] = t.anchors.n;
        r->splats[stage] = t.progress.splats;
    }
    ted4_trainer_finish(&t);
}

static int by_value(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;

    return (x > y) - (x < y);
}

/* Member i of a sample: parts, whole, alone. */
static double member(const sample *s, int i)
{
    return i < N_PARTS ? s->part[i] : i == N_PARTS ? s->whole : s->alone;
}

/* Medians over the steps of a stage, the first ones aside. */
static sample medians(const recording *r, int stage)
{
    sample m = { .whole = 0 };

    for (int i = 0; i < N_PARTS + 2; i++) {
        double       value[STEPS];
        const size_t first = r->n[stage] > 2 * WARM_UP ? WARM_UP : 0, n = r->n[stage] - first;

        for (size_t k = 0; k < n; k++)
            value[k] = member(&r->step[stage][first + k], i);
        qsort(value, n, sizeof *value, by_value);
        *(i < N_PARTS ? &m.part[i] : i == N_PARTS ? &m.whole : &m.alone) = n > 0 ? value[n / 2] : 0;
    }
    return m;
}

/* The lesser of two, member by member. */
static sample lesser(const sample *a, const sample *b)
{
    sample s = { .whole = fmin(a->whole, b->whole), .alone = fmin(a->alone, b->alone) };

    for (int i = 0; i < N_PARTS; i++)
        s.part[i] = fmin(a->part[i], b->part[i]);
    return s;
}

static void print_stage(const recording *r, int stage, const sample *one, const sample *two, double plain)
{
    printf("%s: %zu anchors, %.0f Gaussians on screen\n", stage_name[stage], r->anchors[stage], r->splats[stage]);
    printf("  %-28s %9s %6s %10s %9s\n", "", "1 thread", "share", "2 threads", "speed-up");
    for (int i = 0; i < N_PARTS; i++)
        if (one->part[i] >= 0.005)
            printf("  %-28s %6.2f ms %4.0f %% %7.2f ms %9.2f\n", part_name[i], one->part[i], 100 * one->part[i] / one->whole, two->part[i],
                   one->part[i] / two->part[i]);
    printf("  %-28s %6.2f ms        %7.2f ms %9.2f\n", "a step", one->whole, two->whole, one->whole / two->whole);
    printf("  %-28s %6.2f ms        %7.2f ms\n", "of it outside parallel work", one->alone, two->alone);
    if (plain > 0)
        printf("  %-28s %6.2f ms, ratio %.1f\n", "plain build, 1 thread", plain, plain / one->whole);
}

static void ask_other(const char *program, const char *scene, const char *downscale, double plain[STAGES])
{
    char command[4096];

    snprintf(command, sizeof command, "TED4_KERNEL=plain '%s' -t '%s' '%s'", program, scene, downscale);
    FILE *f = must(popen(command, "r"));
    if (fscanf(f, "%lf %lf %lf", &plain[STAGE_1], &plain[STAGE_2], &plain[STAGE_INTEGER]) != STAGES) {
        fprintf(stderr, "bench_train: %s gave no times\n", program);
        exit(3);
    }
    pclose(f);
}

static void load(ted4_dataset *d, const char *scene, const char *downscale)
{
    const ted4_dataset_options o = { .downscale = atoi(downscale), .white = 1, .cache_bytes = (size_t)1 << 30 };
    ted4_message               m;

    if (ted4_dataset_load(d, scene, &o, &m) != 0 || ted4_dataset_verify(d, NULL, &m) != 0) {
        fprintf(stderr, "bench_train: %s\n", m.text);
        exit(3);
    }
}

static void report(ted4_dataset *d, const double plain[STAGES])
{
    ted4_parallel one, two;
    sample        m[2][STAGES];
    recording    *r = must(malloc(sizeof *r));

    ted4_threads_init(&one, 1);
    ted4_threads_init(&two, 2);
    for (int round = 0; round < ROUNDS; round++)
        for (int k = 0; k < 2; k++) {
            record(r, d, k == 0 ? &one : &two, STEPS);
            for (int stage = 0; stage < STAGES; stage++) {
                const sample s = medians(r, stage);

                m[k][stage] = round == 0 ? s : lesser(&m[k][stage], &s);
            }
        }
    for (int stage = 0; stage < STAGES; stage++)
        print_stage(r, stage, &m[0][stage], &m[1][stage], plain[stage]);
    free(r);
    ted4_threads_finish(&two);
    ted4_threads_finish(&one);
}

int main(int argc, char **argv)
{
    const int    quiet = argc == 4 && strcmp(argv[1], "-t") == 0;
    double       plain[STAGES] = {0};
    ted4_dataset d;

    if (argc < 3 || argc > 4) {
        fputs("usage: bench_train SCENE DOWNSCALE [OTHER]\n", stderr);
        return 3;
    }
    load(&d, argv[1 + quiet], argv[2 + quiet]);
    if (quiet) {
        recording *r = must(malloc(sizeof *r));

        record(r, &d, NULL, PLAIN_STEPS);
        printf("%.6f %.6f %.6f\n", medians(r, STAGE_1).whole, medians(r, STAGE_2).whole, medians(r, STAGE_INTEGER).whole);
        free(r);
    } else {
        if (argc == 4)
            ask_other(argv[3], argv[1], argv[2], plain);
        printf("%s, 1/%s size: %dx%d, %zu pictures; preset fast, full number of anchors from the first step; medians of %d steps, lesser of %d rounds\n",
               strrchr(argv[1], '/') != NULL ? strrchr(argv[1], '/') + 1 : argv[1], argv[2], d.pictures[0].camera.width, d.pictures[0].camera.height,
               d.n_pictures, STEPS - WARM_UP, ROUNDS);
        report(&d, plain);
    }
    ted4_dataset_free(&d);
    return 0;
}
