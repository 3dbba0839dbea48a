/* bench_scale.c - how far a training step can use many cores: the share of it outside parallel
 * work, and what that and the sizes of its jobs let 8, 16 and 32 cores reach. On one thread each
 * index of each parallel region is timed. Two bounds: Amdahl's law, for which regions take no
 * time on many cores but their work over the cores; and the same steps with their real jobs,
 * handed out in order to whichever core is free, and what opening and closing a region costs
 * (recorder.h).
 * Usage: bench_scale SCENE DOWNSCALE
 * SPDX-License-Identifier: BSD-2-Clause */
#include "measure.h"
#include "recorder.h"
#include "train/raster_adjoint.h"
#include "train_parts.h"

enum { STEPS = 120, WARM_UP = 15, FEWEST = 12 };

/* A part of one step, or all of it: ms on one thread, in regions alone, and in regions on
 * recorder_cores; regions. */
typedef struct {
    double whole, work, on[RECORDER_CORES], regions;
} portion;
enum { MEMBERS = sizeof(portion) / sizeof(double) };

/* Parts, then the whole step. */
typedef struct {
    portion of[N_PARTS + 1];
} sample;

typedef struct {
    sample step[STAGES][STEPS];
    size_t n[STAGES], anchors[STAGES];
    double splats[STAGES];
} recording;

static recorder recorded;
static sample   here;

/* The tiles of the adjoint are taken by TED4_BWD_JOBS jobs, one by one; each lasts about as
 * long, against the others, as forward. */
static int kind_of_region(size_t n)
{
    return parts.current == PART_BLEND ? 1
           : parts.current == PART_BLEND_BWD && n == TED4_BWD_JOBS ? 2 : 0;
}

/* What was in regions since the last change of parts belongs to p. */
static void leave(train_part p)
{
    recorder_regions *r = &recorded.regions;
    portion          *to = &here.of[p];

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

static sample one_step(ted4_trainer *t)
{
    memset(&here, 0, sizeof here);
    memset(&recorded.regions, 0, sizeof recorded.regions);
    parts_begin();
    if (ted4_trainer_step(t) != 0) {
        fprintf(stderr, "bench_scale: %s\n", t->message.text);
        exit(3);
    }
    parts_end();
    for (int p = 0; p < N_PARTS; p++)
        here.of[p].whole += parts.ms[p];
    return here;
}

static void record(recording *r, ted4_dataset *d)
{
    const ted4_parallel team = recorder_team(&recorded);
    ted4_train_options  o;
    ted4_trainer        t;

    parts_options(&o, STEPS);
    if (ted4_trainer_init(&t, &o, d, &team) != 0) {
        fprintf(stderr, "bench_scale: %s\n", t.message.text);
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

/* Of each part medians over the steps of a stage, the first ones aside. */
static sample medians(const recording *r, int stage)
{
    const size_t first = r->n[stage] > WARM_UP + FEWEST ? WARM_UP : 0, n = r->n[stage] - first;
    sample       m;

    for (size_t i = 0; i < N_PARTS * (size_t)MEMBERS; i++) {
        double value[STEPS];

        for (size_t k = 0; k < n; k++)
            value[k] = ((const double *)r->step[stage][first + k].of)[i];
        qsort(value, n, sizeof *value, by_value);
        ((double *)m.of)[i] = value[n / 2];
    }
    add_parts(&m);
    return m;
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

static void print_stage(const recording *r, int stage)
{
    const sample   m = medians(r, stage);
    const portion *all = &m.of[N_PARTS];
    const double   serial = all->whole - all->work;

    printf("%s: %zu anchors, %.0f Gaussians on screen\n", stage_name[stage], r->anchors[stage],
           r->splats[stage]);
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
    recording   *r = must(calloc(1, sizeof *r));
    ted4_dataset d;

    if (argc != 3) {
        fputs("usage: bench_scale SCENE DOWNSCALE\n", stderr);
        return 3;
    }

    const double picture = parts_load(&d, argv[1], argv[2]);

    recorder_init(&recorded);
    recorded.kind = kind_of_region;
    parts.leave = leave;
    record(r, &d);
    const char *const name = strrchr(argv[1], '/') != NULL ? strrchr(argv[1], '/') + 1 : argv[1];

    printf("%s, 1/%s size: %dx%d, %zu pictures; preset fast, full number of anchors from the first "
           "step; medians of %d steps\n", name, argv[2], d.pictures[0].camera.width,
           d.pictures[0].camera.height, d.n_pictures, STEPS - WARM_UP);
    printf("a picture's file to pixels: %.2f ms; the %d threads that decode ahead, where not all "
           "pictures stay in memory, have one every %.2f ms\n", picture, TED4_DATASET_AHEAD,
           picture / TED4_DATASET_AHEAD);
    for (int stage = 0; stage < STAGES; stage++)
        print_stage(r, stage);
    free(r);
    recorder_finish(&recorded);
    ted4_dataset_free(&d);
    return 0;
}
