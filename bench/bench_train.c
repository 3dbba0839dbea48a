/* bench_train.c - measures a training step and its parts (train_parts.h) in stage 1, in stage 2 and
 * in the integer part of stage 2, on one thread and on two. Work on all threads is recognised by
 * the regions that the trainer hands to its threads. The parts are measured for the machine's
 * highest level (base/level.h); for lower levels only the whole step is timed, in turn with it.
 * Usage: bench_train SCENE DOWNSCALE
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>

#include "measure.h"
#include "tool/threads.h"
#include "train_record.h"

/* Steps per stage; recordings for each level and each number of threads. */
enum { STEPS = 115, ROUNDS = 2 };

/* One step: ms of each part, of the whole step, and of the step outside all parallel regions. */
typedef struct {
    double part[N_PARTS], whole, alone;
} sample;

/* Time in regions during the current step, in ms. */
static double in_regions;

/* A team that measures the time for which it works. */
static void run_region(void *user, size_t n, void (*body)(void *arg, size_t i), void *arg)
{
    const ted4_parallel *team = user;
    const double begin = now_ms();

    ted4_parallel_for(team, n, body, arg);
    in_regions += now_ms() - begin;
}

static void one_step(ted4_trainer *t, void *measured)
{
    sample *s = measured;

    in_regions = 0;
    s->whole = parts_step(t);
    memcpy(s->part, parts.ms, sizeof s->part);
    s->alone = s->whole - in_regions;
}

/* Returns the smaller of two values for each member. */
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
            printf("  %-28s %6.2f ms %4.0f %% %7.2f ms %9.2f\n", part_name[i], one->part[i],
                   100 * one->part[i] / one->whole, two->part[i], one->part[i] / two->part[i]);
    printf("  %-28s %6.2f ms        %7.2f ms %9.2f\n", "a step", one->whole, two->whole,
           one->whole / two->whole);
    printf("  %-28s %6.2f ms        %7.2f ms\n", "of it outside parallel work", one->alone,
           two->alone);
}

/* m is indexed by level, number of threads less 1, and stage. */
static void print_stage(const train_record *r, int stage, sample m[TED4_LEVELS][2][STAGES])
{
    const ted4_level most = ted4_level_of_machine();
    const double one = m[most][0][stage].whole, two = m[most][1][stage].whole;

    record_print_stage(r, stage);
    print_parts(&m[most][0][stage], &m[most][1][stage]);
    for (ted4_level level = most; level >= TED4_LEVEL_BASE; level--) {
        const double a = m[level][0][stage].whole, b = m[level][1][stage].whole;

        printf("  a step, %-20s %6.2f ms        %7.2f ms", ted4_level_name(level), a, b);
        printf(level < most ? "   ratio %.2f, %.2f\n" : "\n", a / one, b / two);
    }
}

/* Selects the level as the programs do; the decoder's kernels follow the environment. */
static void use(ted4_level level)
{
    setenv("TED4_KERNEL", ted4_level_name(level), 1);
    ted4_level_use(level);
}

static void report(train_record *r, ted4_dataset *d)
{
    ted4_parallel team[2];
    sample m[TED4_LEVELS][2][STAGES];

    ted4_threads_init(&team[0], 1);
    ted4_threads_init(&team[1], 2);
    for (int round = 0; round < ROUNDS; round++)
        for (ted4_level level = TED4_LEVEL_BASE; level <= ted4_level_of_machine(); level++)
            for (int k = 0; k < 2; k++) {
                const ted4_parallel noted = { run_region, &team[k] };

                use(level);
                record_training(r, d, &noted, one_step);
                for (int stage = 0; stage < STAGES; stage++) {
                    sample s;

                    record_medians(r, stage, (double *)&s);
                    m[level][k][stage] = round == 0 ? s : lesser(&m[level][k][stage], &s);
                }
            }
    for (int stage = 0; stage < STAGES; stage++)
        print_stage(r, stage, m);
    ted4_threads_finish(&team[1]);
    ted4_threads_finish(&team[0]);
}

int main(int argc, char **argv)
{
    train_record r;
    ted4_dataset d;

    parts_load(&d, argc, argv);
    record_init(&r, STEPS, sizeof(sample) / sizeof(double));
    record_print_title(&r, &d, argv);
    printf(", lesser of %d rounds\n", ROUNDS);
    report(&r, &d);
    record_free(&r);
    ted4_dataset_free(&d);
    return 0;
}
