/* bench_train.c - what a training step costs, and which part of it how much: stage 1, stage 2 and its integer part, on one thread and on two.
 * Parts: train_parts.h. What runs on all threads is known by the regions that the trainer hands to its threads.
 * Parts are those of the machine's highest level (base/level.h); of lower ones the step is timed, in turn with it.
 * Usage: bench_train SCENE DOWNSCALE
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>

#include "measure.h"
#include "tool/threads.h"
#include "train_parts.h"

enum { STEPS = 150, WARM_UP = 15, ROUNDS = 2 };

/* One step: ms of each part, of the step, and of it outside all parallel regions. */
typedef struct {
    double part[N_PARTS], whole, alone;
} sample;

/* Of the step that goes on: ms in regions. */
static double in_regions;

typedef struct {
    sample step[STAGES][STEPS];
    size_t n[STAGES];
    size_t anchors[STAGES];
    double splats[STAGES];
} recording;

/* A team that takes note of the time for which it works. */
static void run_region(void *user, size_t n, void (*body)(void *arg, size_t i), void *arg)
{
    const ted4_parallel *team = user;
    const double         begin = now_ms();

    ted4_parallel_for(team, n, body, arg);
    in_regions += now_ms() - begin;
}

static sample one_step(ted4_trainer *t)
{
    const double begin = now_ms();
    sample       s;

    in_regions = 0;
    parts_begin();
    if (ted4_trainer_step(t) != 0) {
        fprintf(stderr, "bench_train: %s\n", t->message.text);
        exit(3);
    }
    parts_end();
    memcpy(s.part, parts.ms, sizeof s.part);
    s.whole = now_ms() - begin;
    s.alone = s.whole - in_regions;
    return s;
}

static void record(recording *r, ted4_dataset *d, const ted4_parallel *team, int steps)
{
    const ted4_parallel noted = { run_region, (void *)(uintptr_t)team };
    ted4_train_options  o;
    ted4_trainer        t;

    memset(r, 0, sizeof *r);
    parts_options(&o, steps);
    if (ted4_trainer_init(&t, &o, d, &noted) != 0) {
        fprintf(stderr, "bench_train: %s\n", t.message.text);
        exit(3);
    }
    while (t.iteration < ted4_trainer_total(&t)) {
        const sample s = one_step(&t);
        const int    stage = parts_stage(&t);

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

static void print_parts(const sample *one, const sample *two)
{
    printf("  %-28s %9s %6s %10s %9s\n", "", "1 thread", "share", "2 threads", "speed-up");
    for (int i = 0; i < N_PARTS; i++)
        if (one->part[i] >= 0.005)
            printf("  %-28s %6.2f ms %4.0f %% %7.2f ms %9.2f\n", part_name[i], one->part[i], 100 * one->part[i] / one->whole, two->part[i],
                   one->part[i] / two->part[i]);
    printf("  %-28s %6.2f ms        %7.2f ms %9.2f\n", "a step", one->whole, two->whole, one->whole / two->whole);
    printf("  %-28s %6.2f ms        %7.2f ms\n", "of it outside parallel work", one->alone, two->alone);
}

/* m: by level, number of threads less 1, and stage. */
static void print_stage(const recording *r, int stage, sample m[TED4_LEVELS][2][STAGES])
{
    const ted4_level most = ted4_level_of_machine();
    const double     one = m[most][0][stage].whole, two = m[most][1][stage].whole;

    printf("%s: %zu anchors, %.0f Gaussians on screen\n", stage_name[stage], r->anchors[stage], r->splats[stage]);
    print_parts(&m[most][0][stage], &m[most][1][stage]);
    for (ted4_level level = most; level >= TED4_LEVEL_BASE; level--) {
        const double a = m[level][0][stage].whole, b = m[level][1][stage].whole;

        printf("  a step, %-20s %6.2f ms        %7.2f ms", ted4_level_name(level), a, b);
        printf(level < most ? "   ratio %.2f, %.2f\n" : "\n", a / one, b / two);
    }
}

/* As the programs do: the decoder's kernels by the environment. */
static void use(ted4_level level)
{
    setenv("TED4_KERNEL", ted4_level_name(level), 1);
    ted4_level_use(level);
}

static void report(ted4_dataset *d)
{
    ted4_parallel team[2];
    sample        m[TED4_LEVELS][2][STAGES];
    recording    *r = must(malloc(sizeof *r));

    ted4_threads_init(&team[0], 1);
    ted4_threads_init(&team[1], 2);
    for (int round = 0; round < ROUNDS; round++)
        for (ted4_level level = TED4_LEVEL_BASE; level <= ted4_level_of_machine(); level++)
            for (int k = 0; k < 2; k++) {
                use(level);
                record(r, d, &team[k], STEPS);
                for (int stage = 0; stage < STAGES; stage++) {
                    const sample s = medians(r, stage);

                    m[level][k][stage] = round == 0 ? s : lesser(&m[level][k][stage], &s);
                }
            }
    for (int stage = 0; stage < STAGES; stage++)
        print_stage(r, stage, m);
    free(r);
    ted4_threads_finish(&team[1]);
    ted4_threads_finish(&team[0]);
}

int main(int argc, char **argv)
{
    ted4_dataset d;

    if (argc != 3) {
        fputs("usage: bench_train SCENE DOWNSCALE\n", stderr);
        return 3;
    }
    parts_load(&d, argv[1], argv[2]);
    printf("%s, 1/%s size: %dx%d, %zu pictures; preset fast, full number of anchors from the first step; medians of %d steps, lesser of %d rounds\n",
           strrchr(argv[1], '/') != NULL ? strrchr(argv[1], '/') + 1 : argv[1], argv[2], d.pictures[0].camera.width, d.pictures[0].camera.height,
           d.n_pictures, STEPS - WARM_UP, ROUNDS);
    report(&d);
    ted4_dataset_free(&d);
    return 0;
}
