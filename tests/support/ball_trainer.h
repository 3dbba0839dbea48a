/* ball_trainer.h - small trainings on the scene of balls, from pictures to bytes.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_BALL_TRAINER_H
#define TED4_BALL_TRAINER_H

#include <string.h>

#include "ball_scene.h"
#include "test.h"
#include "train/step/export_scene.h"
#include "train/model/normalise.h"
#include "train/state/trainer.h"
#include "train/state/visible_blocks.h"
#include "train/step/trainer_init.h"
#include "train/train.h"
#include "write/encode.h"

typedef struct {
    uint8_t *bytes;
    size_t size;
} ball_file;

static inline void ball_load(tiny_folder *f, ted4_dataset *d, int frames, int moving)
{
    const ted4_dataset_options o = { .downscale = 1, .seed = 3, .cache_bytes = 1 << 20 };
    ted4_message m;

    *f = tiny_new();
    ball_scene(f, frames, moving);
    if (ted4_dataset_load(d, f->path, &o, &m) != 0)
        fail_msg("%s", m.text);
}

static inline void ball_set(ted4_train_options *o, const char *text)
{
    char why[256];

    if (ted4_options_set(o, text, why, sizeof why) != 0)
        fail_msg("%s", why);
}

static inline ted4_train_options ball_options(void)
{
    static const char *const small[] = {
        "stage1=400",       "stage2=250",      "offsets=4",
        "feature=8",        "phi=4",           "bank_dim=8",
        "deform_width=8",   "head_width=12",   "hyper_width=8",
        "ar_width=8",       "slices=2",        "octaves=4",
        "init_anchors=150", "max_anchors=260", "grow_every=20",
        "lr_feature=0.03",  "lr_heads=0.02",   "lr_scaling=0.03",
        "lr_offset=0.03",   "lr_motion=0.005", "lr_phi=0.02",
        "lr_mask=0.05",     "capacity=0",      "motion_worth=0",
    };
    ted4_train_options o;

    assert_int_equal(ted4_options_preset(&o, "draft"), 0);
    for (size_t i = 0; i < sizeof small / sizeof small[0]; i++)
        ball_set(&o, small[i]);
    return o;
}

static inline void ball_begin(ted4_trainer *t, const ted4_train_options *o, ted4_dataset *d,
                              const ted4_parallel *p)
{
    if (ted4_trainer_init(t, o, d, p) != 0)
        fail_msg("%s", t->message.text);
}

static inline void ball_train(ted4_trainer *t, uint64_t iteration)
{
    while (t->iteration < iteration)
        if (ted4_trainer_step(t) != 0)
            fail_msg("%s", t->message.text);
}

/* Returns the number, in t->net, of the value behind the last of a network of NETR. */
static inline size_t ball_net_end(const ted4_trainer *t, int net)
{
    const ted4_net_shape *s = &t->layout.shape.netr[net];
    size_t end = t->layout.netr + s->first;

    for (int i = 0; i < s->n_layers; i++)
        end += ((size_t)s->dim[i] + 1) * s->dim[i + 1];
    return end;
}

/* Sets the last n biases of the last layer of a network of NETR. */
static inline void ball_set_biases(ted4_trainer *t, int net, size_t n, float value)
{
    const size_t end = ball_net_end(t, net);

    for (size_t i = 1; i <= n; i++)
        t->net.value[end - i] = value;
}

/* Sets the last layer of F_deform to zero, so that all anchors stand still where they are. */
static inline void ball_stop_motion(ted4_trainer *t)
{
    const ted4_net_shape *s = &t->layout.shape.netr[TED4_NET_DEFORM];
    const int last = s->n_layers - 1;
    const size_t n = ((size_t)s->dim[last] + 1) * s->dim[last + 1];

    memset(t->net.value + ball_net_end(t, TED4_NET_DEFORM) - n, 0, n * sizeof *t->net.value);
}

/* Generates the Gaussians of all anchors at a frame, as the camera of the first picture sees them.
 */
static inline void ball_generate(ted4_trainer *t, uint32_t frame, ted4_splats *s)
{
    const ted4_layout *l = &t->layout;
    ted4_view v;
    ted4_generate_input in = { .layout = l,
                               .net = t->net.value,
                               .num = frame,
                               .den = t->data->n_frames - 1,
                               .activation = l->head.activation };

    assert_int_equal(ted4_visible_blocks_fill(t, NULL), 0);
    ted4_normalise_view(&l->head, &t->data->pictures[0].camera, &v, in.camera);
    in.n_visible = t->visible_blocks.n;
    in.attr = t->visible_blocks.raw;
    in.position = t->visible_blocks.position;
    in.lanes = t->visible_blocks.lanes;
    ted4_generator_pack(t->work.generator, t->net.value);
    assert_int_equal(ted4_generate(t->work.generator, &in, NULL, s), 0);
}

/* Ends the training and writes the file. */
static inline ball_file ball_finish(ted4_trainer *t)
{
    ted4_scene *s;
    ted4_error e = { TED4_OK, 0 };
    ball_file f;

    ball_train(t, ted4_trainer_total(t));
    if (ted4_export_scene(t, &s) != 0)
        fail_msg("%s", t->message.text);
    if (ted4_encode(s, 0, NULL, &f.bytes, &f.size, &e) != TED4_OK)
        fail_msg("%s", ted4_status_id(e.code));
    ted4_scene_free(s);
    return f;
}

static inline void ball_check_same(const ball_file *a, const ball_file *b)
{
    assert_int_equal(a->size, b->size);
    assert_memory_equal(a->bytes, b->bytes, a->size);
}

#endif
