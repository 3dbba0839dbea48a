/* phases.c - measures a whole run of ted4enc by phase: how long each phase takes on one thread, how
 * much of it is outside parallel work, and how long it would take on many cores. The functions are
 * linked in front of ted4enc's own (-Wl,--wrap, bench.mk). The team of ted4enc is the recorder's,
 * and the table is printed to standard output when the team is dismissed. If a phase calls another
 * one, the time counts for the inner one only. Steps of a probe or of a trial are counted
 * separately from training steps.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "measure.h"
#include "recorder.h"
#include "tool/file_out.h"
#include "tool/run_log.h"
#include "tool/threads.h"
#include "tool/verify.h"
#include "train/densify/densify.h"
#include "train/model/header_from_options.h"
#include "train/search/branch.h"
#include "train/search/model_search.h"
#include "train/search/prior_bits.h"
#include "train/search/rd_prune.h"
#include "train/state/picture.h"
#include "train/monitor/checkpoint.h"
#include "train/step/export_scene.h"
#include "train/raster/adjoint.h"
#include "train/densify/mv_seed.h"
#include "train/step/stages.h"
#include "train/step/trainer_init.h"
#include "train/step/step.h"
#include "write/encode.h"

/* Roughly in the order of a run. */
#define PHASES(P)                                 \
    P(LOAD, "reading the scene's files")          \
    P(CHECK, "decoding every picture once")       \
    P(SETTLE, "looking for flicker")              \
    P(INIT, "first anchors, colours, transients") \
    P(STEPS, "steps of the training")             \
    P(STATES, "states kept and restored")         \
    P(PROBE, "steps of probe and trials")         \
    P(ADJUST, "growing and pruning")              \
    P(MV_SEED, "sprouts")                         \
    P(STAGE, "changes of stage")                  \
    P(MODEL_SEARCH, "trials: moves")              \
    P(DRAW, "trials: pictures")                   \
    P(SCENE, "model to scene")                    \
    P(CODE, "coding")                             \
    P(PREVIEW, "preview")                         \
    P(LOG, "log")                                 \
    P(SAVE, "checkpoints")                        \
    P(VERIFY, "reading the file back")            \
    P(WRITE, "writing the file")                  \
    P(REST, "the rest")

#define AS_ENUM(name, text) PHASE_##name,
#define AS_TEXT(name, text) text,
typedef enum { PHASES(AS_ENUM) PHASES } phase;
static const char *const phase_name[PHASES] = { PHASES(AS_TEXT) };

typedef struct {
    double whole, work, on[RECORDER_CORES];
    size_t times;
} portion;

static recorder recorded;
static portion of[PHASES];
static phase current = PHASE_REST;
static double since;

/* The tiles of the adjoint are processed by TED4_BWD_JOBS jobs, each of which takes one tile after
 * another. The durations of the tiles are assumed proportional to those of blending. */
static int in_blend, in_blend_bwd;

static int kind_of_region(size_t n)
{
    return in_blend ? 1 : in_blend_bwd && n == TED4_BWD_JOBS ? 2 : 0;
}

static phase enter(phase p)
{
    const phase before = current;
    const double now = recorder_thread_ms();
    portion *to = &of[before];
    recorder_regions *r = &recorded.regions;

    to->whole += (since > 0 ? now - since : 0) - r->spent;
    to->work += r->work;
    for (int k = 0; k < RECORDER_CORES; k++)
        to->on[k] += r->on[k];
    memset(r, 0, sizeof *r);
    since = recorder_thread_ms();
    current = p;
    return before;
}

/* A call of name in the program calls __wrap_name; __real_name is the function itself. The linker
 * does not compare types; the declaration with __typeof__ does. */
#define BETWEEN(phase_of, type, name, parameters, arguments) \
    extern __typeof__(name) __wrap_##name;                   \
    type __real_##name parameters;                           \
    type __wrap_##name parameters                            \
    {                                                        \
        const phase before = enter(phase_of);                \
        of[current].times++;                                 \
        const type result = __real_##name arguments;         \
        enter(before);                                       \
        return result;                                       \
    }

BETWEEN(PHASE_LOAD, int, ted4_dataset_load,
        (ted4_dataset * d, const char *f, const ted4_dataset_options *o, ted4_message *m),
        (d, f, o, m))
BETWEEN(PHASE_CHECK, int, ted4_dataset_verify,
        (ted4_dataset * d, const ted4_parallel *p, ted4_message *m), (d, p, m))
BETWEEN(PHASE_SETTLE, int, ted4_header_settle, (ted4_train_options * o, const ted4_dataset *d),
        (o, d))
BETWEEN(PHASE_INIT, int, ted4_trainer_init,
        (ted4_trainer * t, const ted4_train_options *o, ted4_dataset *d, const ted4_parallel *p),
        (t, o, d, p))
BETWEEN(PHASE_INIT, int, ted4_trainer_restart, (ted4_trainer * t, const ted4_header *h), (t, h))
BETWEEN(current == PHASE_PROBE ? PHASE_PROBE : PHASE_STEPS, int, ted4_gradient_step,
        (ted4_trainer * t), (t))
BETWEEN(PHASE_PROBE, int, ted4_branch_run, (ted4_trainer * t, int n, double *loss), (t, n, loss))
BETWEEN(PHASE_STATES, int, ted4_snapshot_take, (ted4_trainer * t, ted4_snapshot *s), (t, s))
BETWEEN(PHASE_STATES, int, ted4_snapshot_restore, (ted4_trainer * t, const ted4_snapshot *s),
        (t, s))
BETWEEN(PHASE_STATES, int, ted4_state_take, (ted4_trainer * t, ted4_snapshot *s), (t, s))
BETWEEN(PHASE_STATES, int, ted4_state_restore, (ted4_trainer * t, const ted4_snapshot *s), (t, s))
BETWEEN(PHASE_ADJUST, int, ted4_densify_adjust, (ted4_trainer * t, size_t room), (t, room))
BETWEEN(PHASE_MV_SEED, int, ted4_mv_seed, (ted4_trainer * t), (t))
BETWEEN(PHASE_STAGE, int, ted4_activation_begin, (ted4_trainer * t), (t))
BETWEEN(PHASE_STAGE, int, ted4_stage2_begin, (ted4_trainer * t), (t))
BETWEEN(PHASE_STAGE, int, ted4_integer_begin, (ted4_trainer * t), (t))
BETWEEN(PHASE_MODEL_SEARCH, int, ted4_model_search, (ted4_trainer * t), (t))
BETWEEN(PHASE_MODEL_SEARCH, int, ted4_refine_prior_bits, (ted4_trainer * t), (t))
BETWEEN(PHASE_MODEL_SEARCH, int, ted4_rd_prune, (ted4_trainer * t), (t))
BETWEEN(PHASE_DRAW, double, ted4_trainer_distortion, (ted4_trainer * t, size_t item), (t, item))
BETWEEN(PHASE_DRAW, int, ted4_distortion_gradient, (ted4_trainer * t, size_t item, ted4_splats *s),
        (t, item, s))
BETWEEN(PHASE_SCENE, int, ted4_export_scene, (ted4_trainer * t, ted4_scene **s), (t, s))
BETWEEN(PHASE_CODE, ted4_status, ted4_encode,
        (const ted4_scene *s, int level, const ted4_parallel *p, uint8_t **out, size_t *size,
         ted4_error *e),
        (s, level, p, out, size, e))
BETWEEN(PHASE_CODE, ted4_status, ted4_encode_with_text,
        (const ted4_scene *s, int level, char *text, const ted4_parallel *p, uint8_t **out,
         size_t *size, ted4_error *e),
        (s, level, text, p, out, size, e))
BETWEEN(PHASE_PREVIEW, double, ted4_trainer_preview, (ted4_trainer * t, int n), (t, n))
BETWEEN(PHASE_LOG, int, ted4_run_log_step,
        (ted4_run_log * l, const ted4_trainer *t, char *why, size_t size), (l, t, why, size))
BETWEEN(PHASE_SAVE, int, ted4_checkpoint_write, (ted4_trainer * t, FILE *f, const char *name),
        (t, f, name))
BETWEEN(PHASE_VERIFY, int, ted4_verify,
        (const ted4_scene *s, const uint8_t *bytes, size_t size, const ted4_parallel *p,
         ted4_verified *v, char *why, size_t why_size),
        (s, bytes, size, p, v, why, why_size))
BETWEEN(PHASE_WRITE, int, ted4_file_keep,
        (const char *path, int force, const void *data, size_t size, char *why, size_t why_size),
        (path, force, data, size, why, why_size))

#define MARKED(flag, name, parameters, arguments)   \
    extern __typeof__(name) __wrap_##name;          \
    int __real_##name parameters;                   \
    int __wrap_##name parameters                    \
    {                                               \
        flag = 1;                                   \
        const int result = __real_##name arguments; \
        flag = 0;                                   \
        return result;                              \
    }
#define BLENDING(level)                                                                           \
    MARKED(in_blend, ted4_raster_blend_##level,                                                   \
           (ted4_raster * r, const ted4_view *v, const ted4_parallel *p, int keep, float *image), \
           (r, v, p, keep, image))                                                                \
    MARKED(in_blend_bwd, ted4_raster_blend_bwd_##level,                                           \
           (ted4_adjoint * a, const ted4_raster *r, const ted4_view *v, const ted4_parallel *p,   \
            const float *d),                                                                      \
           (a, r, v, p, d))
BLENDING(base)
#if defined(__x86_64__)
BLENDING(v3)
BLENDING(v4)
#endif

extern __typeof__(ted4_threads_init) __wrap_ted4_threads_init;
void __wrap_ted4_threads_init(ted4_parallel *p, int n_threads)
{
    (void)n_threads;
    recorder_init(&recorded);
    recorded.kind = kind_of_region;
    *p = recorder_team(&recorded);
}

extern __typeof__(ted4_threads_count) __wrap_ted4_threads_count;
int __wrap_ted4_threads_count(const ted4_parallel *p)
{
    (void)p;
    return 1;
}

static void print_phase(const char *name, const portion *p, const portion *all)
{
    const double serial = p->whole - p->work;

    printf("  %-34s %6zu %9.2f %8.2f %7.2f %%", name, p->times, 1e-3 * p->whole, 1e-3 * serial,
           100 * serial / all->whole);
    for (int k = 0; k < RECORDER_CORES; k++)
        printf(" %8.2f", 1e-3 * (serial + p->on[k]));
    putchar('\n');
}

extern __typeof__(ted4_threads_finish) __wrap_ted4_threads_finish;
void __wrap_ted4_threads_finish(ted4_parallel *p)
{
    portion all = { .whole = 0 };

    enter(PHASE_REST);
    p->user = NULL;
    for (int i = 0; i < PHASES; i++) {
        all.whole += of[i].whole;
        all.work += of[i].work;
        for (int k = 0; k < RECORDER_CORES; k++)
            all.on[k] += of[i].on[k];
    }
    const double serial = all.whole - all.work;

    printf("  %-34s %6s %9s %8s %9s %8s %8s %8s\n", "seconds", "times", "1 core", "serial",
           "of run", "8 cores", "16", "32");
    for (int i = 0; i < PHASES; i++)
        if (of[i].whole >= 5)
            print_phase(phase_name[i], &of[i], &all);
    print_phase("the run", &all, &all);
    printf("  %-34s %35s", "bound by Amdahl's law", "");
    for (int k = 0; k < RECORDER_CORES; k++)
        printf(" %7.1fx", all.whole / (serial + all.work / recorder_cores[k]));
    printf("\n  %-34s %35s", "bound with the real jobs", "");
    for (int k = 0; k < RECORDER_CORES; k++)
        printf(" %7.1fx", all.whole / (serial + all.on[k]));
    putchar('\n');
    recorder_finish(&recorded);
}
