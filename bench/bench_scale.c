/* bench_scale.c - predicts how far a training step can use many cores: the share of it outside
 * parallel work, and the speed that this share and the sizes of the jobs allow on 8, 16 and 32
 * cores. On one thread, each index of each parallel region is timed. There are two bounds. Amdahl's
 * law: a region takes its work divided by the number of cores. Real jobs: the jobs of the same
 * steps, handed out in order to the first free core, plus the cost of opening and closing a region
 * (recorder.h). Usage: bench_scale SCENE DOWNSCALE
 * SPDX-License-Identifier: BSD-2-Clause */
#include "measure.h"
#include "recorder.h"
#include "train/raster/adjoint.h"
#include "train_record.h"

enum { STEPS = 120 }; /* per stage */

/* A part of one step, or all of it: ms on one thread, ms in regions, ms in regions on
 * recorder_cores, and the number of regions. */
typedef struct {
    double whole, work, on[RECORDER_CORES], regions;
} portion;
enum { MEMBERS = sizeof(portion) / sizeof(double) };

/* The parts, followed by the whole step. */
typedef struct {
    portion of[N_PARTS + 1];
} sample;

static recorder recorded;
static sample here;

/* The tiles of the adjoint are processed by TED4_BWD_JOBS jobs, each of which takes one tile after
 * another. The durations of the tiles are assumed proportional to those of the forward pass. */
static int kind_of_region(size_t n)
{
    return parts.current == PART_BLEND                             ? 1
           : parts.current == PART_BLEND_BWD && n == TED4_BWD_JOBS ? 2
                                                                   : 0;
}

/* Adds the regions since the last change of parts to p. */
static void leave(train_part p)
{
    recorder_regions *r = &recorded.regions;
    portion *to = &here.of[p];

    to->work += r->work;
    to->whole -= r->own;
    to->regions += (double)r->n;
    for (int k = 0; k < RECORDER_CORES; k++)
        to->on[k] += r->on[k];
    memset(r, 0, sizeof *r);
}

/* The whole step is the sum of its parts. */
static void add_parts(sample *s)
{
    double *all = (double *)&s->of[N_PARTS];

    memset(all, 0, sizeof s->of[N_PARTS]);
    for (int p = 0; p < N_PARTS; p++)
        for (int i = 0; i < MEMBERS; i++)
            all[i] += ((const double *)&s->of[p])[i];
}

static void one_step(ted4_trainer *t, void *measured)
{
    memset(&here, 0, sizeof here);
    memset(&recorded.regions, 0, sizeof recorded.regions);
    parts_step(t);
    for (int p = 0; p < N_PARTS; p++)
        here.of[p].whole += parts.ms[p];
    memcpy(measured, &here, sizeof here);
}

static void print_portion(const char *name, const portion *p, double step)
{
    const double serial = p->whole - p->work;

    printf("  %-28s %7.3f %8.3f %7.2f %% %5.0f", name, p->whole, serial, 100 * serial / step,
           p->regions);
    for (int k = 0; k < RECORDER_CORES; k++)
        printf(" %8.3f", serial + p->on[k]);
    putchar('\n');
}

static void print_stage(const train_record *r, int stage)
{
    sample m;
    const portion *all = &m.of[N_PARTS];
    double serial = 0;

    record_medians(r, stage, (double *)&m);
    add_parts(&m);
    serial = all->whole - all->work;
    record_print_stage(r, stage);
    printf("  %-28s %7s %8s %9s %5s %8s %8s %8s\n", "ms", "1 core", "serial", "of step", "reg.",
           "8 cores", "16", "32");
    for (int i = 0; i < N_PARTS; i++)
        if (m.of[i].whole >= 0.005)
            print_portion(part_name[i], &m.of[i], all->whole);
    print_portion("a step", all, all->whole);
    printf("  %-28s %33s", "bound by Amdahl's law", "");
    for (int k = 0; k < RECORDER_CORES; k++)
        printf(" %7.1fx", all->whole / (serial + all->work / recorder_cores[k]));
    printf("\n  %-28s %33s", "bound with the real jobs", "");
    for (int k = 0; k < RECORDER_CORES; k++)
        printf(" %7.1fx", all->whole / (serial + all->on[k]));
    putchar('\n');
}

int main(int argc, char **argv)
{
    ted4_dataset d;
    train_record r;
    const double picture = parts_load(&d, argc, argv);
    const ted4_parallel team = recorder_team(&recorded);

    recorder_init(&recorded);
    recorded.kind = kind_of_region;
    parts.leave = leave;
    record_init(&r, STEPS, sizeof(sample) / sizeof(double));
    record_training(&r, &d, &team, one_step);
    record_print_title(&r, &d, argv);
    printf("\na picture's file to pixels: %.2f ms; the %d threads that decode ahead, where not all "
           "pictures stay in memory, have one every %.2f ms\n",
           picture, TED4_DATASET_AHEAD, picture / TED4_DATASET_AHEAD);
    for (int stage = 0; stage < STAGES; stage++)
        print_stage(&r, stage);
    record_free(&r);
    recorder_finish(&recorded);
    ted4_dataset_free(&d);
    return 0;
}
