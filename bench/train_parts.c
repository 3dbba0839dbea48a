/* train_parts.c - see train_parts.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "train_parts.h"

#include "measure.h"
#include "train/densify/densify.h"
#include "train/raster/adjoint.h"
#include "train/state/visible_blocks.h"
#include "train/step/apply_gradients.h"
#include "train/step/events.h"
#include "train/step/loss_terms.h"
#include "train/train.h"

#define AS_TEXT(name, text) text,
const char *const part_name[N_PARTS] = { PARTS(AS_TEXT) };
const char *const stage_name[STAGES] = { "stage 1", "stage 2", "stage 2, integer" };
parts_clock parts;

static train_part enter(train_part p)
{
    const train_part before = parts.current;
    const double now = now_ms();

    parts.ms[before] += now - parts.since;
    if (parts.leave != NULL)
        parts.leave(before);
    parts.since = now_ms();
    parts.current = p;
    return before;
}

/* The wrapper functions. A call of name in the trainer calls __wrap_name; __real_name is the
 * function itself. The linker does not compare types; the declaration with __typeof__ does. */
#define BETWEEN(part, type, name, parameters, arguments) \
    extern __typeof__(name) __wrap_##name;               \
    type __real_##name parameters;                       \
    type __wrap_##name parameters                        \
    {                                                    \
        const train_part before = enter(PART_##part);    \
        const type result = __real_##name arguments;     \
        enter(before);                                   \
        return result;                                   \
    }
#define BETWEEN_VOID(part, name, parameters, arguments) \
    extern __typeof__(name) __wrap_##name;              \
    void __real_##name parameters;                      \
    void __wrap_##name parameters                       \
    {                                                   \
        const train_part before = enter(PART_##part);   \
        __real_##name arguments;                        \
        enter(before);                                  \
    }
/* A leveled function (render/leveled.h) may be called by its plain name within the same file, where
 * the linker cannot insert a wrapper. The plain function calls the copies for the levels, which are
 * in other files, so the copies are wrapped instead. */
#if defined(__x86_64__)
#define OF_LEVELS(kind, part, name, parameters, arguments)                                      \
    kind(part, name##_base, parameters, arguments) kind(part, name##_v3, parameters, arguments) \
        kind(part, name##_v4, parameters, arguments)
#else
#define OF_LEVELS(kind, part, name, parameters, arguments) \
    kind(part, name##_base, parameters, arguments)
#endif
#define BETWEEN_INT(part, name, parameters, arguments) \
    BETWEEN(part, int, name, parameters, arguments)
typedef const uint8_t *pixels;

BETWEEN(PICTURE, pixels, ted4_dataset_pixels, (ted4_dataset * d, size_t i, ted4_message *m),
        (d, i, m))
BETWEEN(SCHEDULE, int, ted4_trainer_check, (ted4_trainer * t, int anchors), (t, anchors))
BETWEEN(SCHEDULE, int, ted4_schedule_event, (ted4_trainer * t), (t))
BETWEEN(VISIBLE, int, ted4_visible_blocks_of, (ted4_trainer * t, const ted4_view *v, size_t n),
        (t, v, n))
BETWEEN_VOID(VISIBLE, ted4_visible_blocks_wake, (ted4_trainer * t, const ted4_generate_input *in),
             (t, in))
BETWEEN_VOID(GENERATE, ted4_generator_pack, (ted4_generator * g, const float *net), (g, net))
BETWEEN(GENERATE, int, ted4_generate,
        (ted4_generator * g, const ted4_generate_input *in, const ted4_parallel *p,
         ted4_splats *out),
        (g, in, p, out))
OF_LEVELS(BETWEEN_INT, PROJECT, ted4_raster_project,
          (ted4_raster * r, const ted4_splats *s, const ted4_view *v, const ted4_parallel *p),
          (r, s, v, p))
BETWEEN(BIN, int, ted4_raster_bin, (ted4_raster * r, const ted4_splats *s, const ted4_parallel *p),
        (r, s, p))
OF_LEVELS(BETWEEN_INT, BLEND, ted4_raster_blend,
          (ted4_raster * r, const ted4_view *v, const ted4_parallel *p, int keep, float *image),
          (r, v, p, keep, image))
BETWEEN(LOSS, double, ted4_loss,
        (ted4_loss_workspace * w, const float *image, const uint8_t *truth, int width, int height,
         float weight, const ted4_parallel *p, float *d_image, double *l1, double *ssim),
        (w, image, truth, width, height, weight, p, d_image, l1, ssim))
OF_LEVELS(BETWEEN_INT, BLEND_BWD, ted4_raster_blend_bwd,
          (ted4_adjoint * a, const ted4_raster *r, const ted4_view *v, const ted4_parallel *p,
           const float *d_image),
          (a, r, v, p, d_image))
OF_LEVELS(BETWEEN_VOID, PROJECT_BWD, ted4_raster_project_bwd,
          (const ted4_adjoint *a, const ted4_raster *r, const ted4_splats *s, const ted4_view *v,
           const ted4_parallel *p, const ted4_splat_grads *g),
          (a, r, s, v, p, g))
BETWEEN(GENERATE_BWD, int, ted4_generate_backward,
        (ted4_generator * g, const ted4_generate_input *in, const ted4_splat_grads *gr,
         const ted4_parallel *p, float *const *d_attr, float *d_net),
        (g, in, gr, p, d_attr, d_net))
BETWEEN(REGULARISE, size_t, ted4_update_volume, (ted4_trainer * t, const ted4_splats *s), (t, s))
BETWEEN_VOID(REGULARISE, ted4_update_bank, (ted4_trainer * t), (t))
BETWEEN_VOID(REGULARISE, ted4_densify_gather,
             (ted4_trainer * t, const ted4_generate_input *in, const ted4_splats *s), (t, in, s))
BETWEEN(RATE, int, ted4_update_rate, (ted4_trainer * t, uint64_t key), (t, key))
BETWEEN_VOID(ADAM, ted4_update_parameters, (ted4_trainer * t, size_t n_views), (t, n_views))

void parts_begin(void)
{
    memset(parts.ms, 0, sizeof parts.ms);
    parts.current = PART_REST;
    parts.since = now_ms();
}

void parts_end(void)
{
    enter(PART_REST);
}

void parts_fail(const ted4_message *m)
{
    fprintf(stderr, "benchmark: %s\n", m->text);
    exit(3);
}

double parts_step(ted4_trainer *t)
{
    const double begin = now_ms();

    parts_begin();
    if (ted4_trainer_step(t) != 0)
        parts_fail(&t->message);
    parts_end();
    return now_ms() - begin;
}

int parts_stage(const ted4_trainer *t)
{
    return t->phase.integer ? STAGE_INTEGER : t->phase.stage2 ? STAGE_2 : STAGE_1;
}

void parts_options(ted4_train_options *o, int steps)
{
    char why[256], text[8][64];

    snprintf(text[0], sizeof text[0], "stage1=%d", steps);
    snprintf(text[1], sizeof text[1], "stage2=%d", 2 * steps);
    snprintf(text[2], sizeof text[2], "integer_share=0.5");
    snprintf(text[3], sizeof text[3], "init_anchors=16000");
    snprintf(text[4], sizeof text[4], "activation_start=0");
    snprintf(text[5], sizeof text[5], "probe=0");
    snprintf(text[6], sizeof text[6], "capacity=0");
    /* Multi-view seeding takes a minute at full size, but is not part of a step. */
    snprintf(text[7], sizeof text[7], "sprouts=0");
    must(ted4_options_preset(o, "fast") == 0 ? o : NULL);
    for (int i = 0; i < 8; i++)
        if (ted4_options_set(o, text[i], why, sizeof why) != 0) {
            fprintf(stderr, "benchmark: %s\n", why);
            exit(3);
        }
}

double parts_load(ted4_dataset *d, int argc, char *const *argv)
{
    ted4_dataset_options o = { .white = 1, .cache_bytes = (size_t)1 << 30 };
    ted4_message m;
    double begin = 0;

    if (argc != 3) {
        fprintf(stderr, "usage: %s SCENE DOWNSCALE\n", argv[0]);
        exit(3);
    }
    o.downscale = atoi(argv[2]);
    if (ted4_dataset_load(d, argv[1], &o, &m) != 0)
        parts_fail(&m);
    begin = now_ms();
    if (ted4_dataset_verify(d, NULL, &m) != 0)
        parts_fail(&m);
    return (now_ms() - begin) / (double)d->n_pictures;
}
