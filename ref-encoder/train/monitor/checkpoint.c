/* checkpoint.c - writes and reads the state of a trainer (checkpoint.h). Numbers are stored in
 * native byte order, because a checkpoint stays on the machine that made it.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "checkpoint.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "monitor.h"
#include "state_stream.h"
#include "train/math/voxel_set.h"
#include "train/model/header_from_options.h"

#define MAGIC 0x34444554u /* "TED4" */
enum { FORMAT = 17 };

typedef ted4_state_stream stream;

static void put(stream *s, void *p, size_t size)
{
    ted4_state_put(s, p, size);
}

static void expect(stream *s, uint64_t value)
{
    ted4_state_expect(s, value);
}

/* Does the same as expect(), and fills t->message with why if the numbers differ. */
static void expect_or(stream *s, ted4_trainer *t, uint64_t value, const char *why)
{
    const int before = s->failed;

    expect(s, value);
    if (s->failed && !before)
        ted4_trainer_fail(t, "%s", why);
}

/* Does the same as expect(), and fills t->message with both numbers if they differ. */
static void expect_number(stream *s, ted4_trainer *t, uint64_t value, const char *what)
{
    uint64_t x = value;

    put(s, &x, sizeof x);
    if (!s->failed && x != value)
        s->failed = ted4_trainer_fail(t, "it is of %llu %s, and there are %llu",
                                      (unsigned long long)x, what, (unsigned long long)value) != 0;
}

/* Writes or compares the seed and the values of all options; t->message names one that differs.
 * Before stage 2, the options that affect only stage 2 may differ. */
static void walk_options(stream *s, ted4_trainer *t)
{
    double value[1 + TED4_OPTIONS], mine[1 + TED4_OPTIONS];

    mine[0] = t->opt.seed;
    for (int i = 0; i < TED4_OPTIONS; i++)
        mine[1 + i] = ted4_options_value(&t->opt, i);
    memcpy(value, mine, sizeof value);
    put(s, value, sizeof value);
    for (int i = 0; !s->failed && i <= TED4_OPTIONS; i++)
        if (value[i] != mine[i] &&
            (i == 0 || ted4_options_stage(i - 1) <= (t->phase.stage2 ? 2 : 1)))
            s->failed = ted4_trainer_fail(t, "its %s is %g, and %g is asked for",
                                          i == 0 ? "seed" : ted4_options_name(i - 1), value[i],
                                          mine[i]) != 0;
}

/* Returns whether all anchors lie in the cube. Training never moves them out of it (init.c,
 * densify.c, plane_sweep.c), and the fixed-point inputs of networks are computed without another
 * check. */
static int inside_cube(const ted4_anchors *a)
{
    const float *p = a->data[TED4_ROW_POSITION];
    int inside = 1;

    for (size_t i = 0; i < a->n_blocks * 3 * TED4_LANES; i++)
        inside &= p[i] >= -1.0f && p[i] <= 1.0f;
    return inside;
}

/* Makes room for n anchors if the file is long enough to hold them. Returns 0 or -1. */
static int resize_anchors(const stream *s, ted4_anchors *a, uint64_t n)
{
    uint64_t values = 0;

    for (int k = 0; k < TED4_ROWS; k++)
        values += (uint64_t)a->rows[k];
    return n > s->left / (values * sizeof(float)) ? -1 : ted4_anchors_resize(a, (size_t)n);
}

static void walk_anchors(stream *s, ted4_trainer *t)
{
    uint64_t n = t->anchors.n;

    put(s, &n, sizeof n);
    if (s->failed)
        return;
    if (!s->writing && resize_anchors(s, &t->anchors, n) != 0) {
        s->failed = 1;
        return;
    }
    for (int k = 0; k < TED4_ROWS; k++)
        put(s, t->anchors.data[k],
            t->anchors.n_blocks * (size_t)t->anchors.rows[k] * TED4_LANES * sizeof(float));
    s->failed |= !s->writing && !s->failed && !inside_cube(&t->anchors);
}

/* Copies to want what the model search may have made smaller in h (model_search.h). A trial only
 * makes things smaller, and its header is valid. */
static void allow_smaller(ted4_header *want, const ted4_header *h)
{
    want->n_offsets = h->n_offsets < want->n_offsets ? h->n_offsets : want->n_offsets;
    want->bank_rows = h->bank_rows < want->bank_rows ? h->bank_rows : want->bank_rows;
    want->bank_dim = h->bank_dim < want->bank_dim ? h->bank_dim : want->bank_dim;
    want->phi_dim = h->phi_dim < want->phi_dim ? h->phi_dim : want->phi_dim;
    want->deform_width = h->deform_width < want->deform_width ? h->deform_width
                                                              : want->deform_width;
    want->view = h->view < want->view ? h->view : want->view;
    want->head_width = h->head_width < want->head_width ? h->head_width : want->head_width;
    want->pe_octaves = h->pe_octaves < want->pe_octaves ? h->pe_octaves : want->pe_octaves;
    want->hyper_width = h->hyper_width < want->hyper_width ? h->hyper_width : want->hyper_width;
    want->ar_width = h->ar_width < want->ar_width ? h->ar_width : want->ar_width;
    want->step[TED4_SCALING] = h->step[TED4_SCALING];
    if (h->feature_dim > want->feature_dim || h->n_slices > want->n_slices)
        return;
    want->feature_dim = h->feature_dim;
    want->n_slices = h->n_slices;
    memcpy(want->slice, h->slice, sizeof want->slice);
}

/* Returns whether h is the header with which this run began, except for what the stages change:
 * motion and activation may be removed, scalings may be linear, and the context bits are chosen.
 * The hash detects damage, but not a header of another run. */
static int header_belongs(const ted4_header *began, const ted4_header *h, int decided)
{
    ted4_header want = *began;

    if (h->motion == TED4_MOTION_NONE)
        ted4_header_without_motion(&want);
    if (h->activation == 0)
        want.activation = 0;
    want.scale_domain = h->scale_domain;
    want.context_bits = h->context_bits;
    if (decided)
        allow_smaller(&want, h);
    return ted4_header_same(&want, h);
}

/* Prepares an empty model with the layout of h. If this is the present layout of the trainer, as
 * it mostly is at the end of a trial, the memory is reused: new memory would have to be cleared,
 * too, page by page. Returns 0 or -1. */
static int begin_layout(ted4_trainer *t, const ted4_header *h)
{
    const size_t n = t->layout.n_net;

    if (ted4_header_same(&t->layout.head, h) && t->work.generator != NULL && t->work.rate != NULL) {
        memset(t->net.value, 0, n * sizeof *t->net.value);
        memset(t->net.m, 0, n * sizeof *t->net.m);
        memset(t->net.v, 0, n * sizeof *t->net.v);
        return 0;
    }
    ted4_layout_make(&t->layout, h);
    ted4_anchors_finish(&t->anchors);
    return ted4_anchors_init(&t->anchors, &t->layout) != 0 || ted4_trainer_rebuild(t) != 0 ? -1 : 0;
}

/* Writes or reads the header, which determines the layout; the layout may have lost parts since
 * the trainer was made. Within stage 1, fields that only stage 2 uses are not taken from the
 * file. */
static void walk_layout(stream *s, ted4_trainer *t)
{
    ted4_header h = t->layout.head, began;

    put(s, &h, sizeof h);
    if (s->writing || s->failed)
        return;
    if (!t->phase.stage2)
        ted4_header_stage2(&h, &t->opt);
    ted4_header_make(&began, &t->opt, t->data);
    s->failed = !header_belongs(&began, &h, t->phase.stage2 && t->opt.capacity) ||
                begin_layout(t, &h) != 0;
}

/* Prior networks are stored only from stage 2 on, because their sizes are options of stage 2. */
static void walk_networks(stream *s, ted4_trainer *t)
{
    const size_t n = t->phase.stage2 ? t->layout.n_net : t->layout.nete;
    uint8_t has_shift = t->net.shift != NULL;

    put(s, t->net.value, n * sizeof *t->net.value);
    put(s, t->net.m, n * sizeof *t->net.m);
    put(s, t->net.v, n * sizeof *t->net.v);
    put(s, &has_shift, 1);
    if (!s->writing) {
        free(t->net.shift);
        t->net.shift = has_shift && !s->failed ? malloc(t->layout.shape.n_units + 1) : NULL;
        s->failed |= has_shift && t->net.shift == NULL;
    }
    if (has_shift && !s->failed)
        put(s, t->net.shift, t->layout.shape.n_units);
    s->failed |= !s->writing && t->phase.integer && t->net.shift == NULL;
}

/* Returns whether the order contains only training pictures, and each at most once. */
static int order_is_whole(const ted4_trainer *t)
{
    const ted4_order *o = &t->order;
    uint8_t *seen = calloc(t->data->n_pictures + 1, 1);
    int whole = seen != NULL && o->next <= o->n;

    for (uint32_t i = 0; whole && i < o->n; i++) {
        const uint32_t p = o->item[i];

        whole = p < t->data->n_pictures && !t->data->pictures[p].is_test && !seen[p];
        if (whole)
            seen[p] = 1;
    }
    free(seen);
    return whole;
}

/* Checks the numbers that control how training continues. */
static int numbers_are_possible(const ted4_trainer *t)
{
    return (t->phase.stage2 == 0 || t->phase.stage2 == 1) &&
           (t->phase.integer == 0 || t->phase.integer == 1) &&
           t->phase.integer <= t->phase.stage2 && t->iteration <= ted4_trainer_total(t) &&
           t->phase.stage2_start <= t->iteration && t->phase.grid >= 0 && t->phase.grid <= 12 &&
           t->voxel >= TED4_FINEST_VOXEL && t->voxel <= 1e30 &&
           t->search.decided >= TED4_DECIDED_NOTHING && t->search.decided <= TED4_DECIDED_ALL &&
           t->monitor.state.factor > 0 && t->monitor.state.factor <= 1 &&
           t->monitor.state.rollbacks <= TED4_ROLLBACKS;
}

/* Writes or reads the last good state. It is a state of this format, and is checked when it is
 * needed. It is not written if there is none or if the next step replaces it. Memory grows with
 * the bytes that are read, because the stored size is not trusted. */
static void walk_good(stream *s, ted4_trainer *t)
{
    enum { PIECE = 1 << 20 };
    ted4_monitor *w = &t->monitor;
    const int none = w->good.bytes == NULL || ted4_monitor_due(t);
    uint64_t size = s->writing && !none ? w->good.size : 0;

    put(s, &size, sizeof size);
    put(s, &w->good_at, sizeof w->good_at);
    if (s->writing) {
        put(s, w->good.bytes, (size_t)size);
        return;
    }
    ted4_monitor_forget(t);
    while (!s->failed && w->good.size < size) {
        const size_t n = size - w->good.size < PIECE ? (size_t)(size - w->good.size) : PIECE;
        char *bytes = realloc(w->good.bytes, w->good.size + n);

        s->failed = bytes == NULL;
        if (s->failed)
            break;
        w->good.bytes = bytes;
        put(s, bytes + w->good.size, n);
        w->good.size += n;
    }
    if (s->failed)
        ted4_monitor_forget(t);
}

/* Whether trials may have decided something: the model search, or how coarse the weights of profile
 * Compact are. */
static int may_have_trials(const ted4_trainer *t)
{
    return t->phase.stage2 && (t->opt.capacity || t->opt.profile == TED4_PROFILE_COMPACT);
}

/* Writes or reads the results of trials. There are none before stage 2; without trials the model
 * is the one with which stage 2 began. */
static void walk_capacity(stream *s, ted4_trainer *t)
{
    enum { MOST = 4096 };
    uint64_t n = t->search.n_trials;
    ted4_header began;

    if (!s->writing) {
        t->phase.grid = 0;
        t->search.decided = 0;
        ted4_weight_grid_full(t->net.bits);
    }
    if (may_have_trials(t)) {
        put(s, &t->phase.rate_norm_header, sizeof t->phase.rate_norm_header);
        put(s, &t->search.decided, sizeof t->search.decided);
        put(s, t->net.bits, sizeof t->net.bits);
        put(s, &n, sizeof n);
    } else {
        t->phase.rate_norm_header = t->layout.head;
        n = 0;
    }
    if (may_have_trials(t))
        put(s, &t->phase.grid, sizeof t->phase.grid);
    if (!s->writing && !s->failed) {
        ted4_header_make(&began, &t->opt, t->data);
        free(t->search.trial);
        t->search.trial = n <= MOST ? malloc((size_t)(n + 1) * sizeof *t->search.trial) : NULL;
        t->search.n_trials = t->search.trial != NULL ? (size_t)n : 0;
        s->failed = t->search.trial == NULL ||
                    !header_belongs(&began, &t->phase.rate_norm_header, 0);
    }
    if (!s->failed)
        put(s, t->search.trial, (size_t)n * sizeof *t->search.trial);
    for (int i = 0; !s->failed && i < TED4_WEIGHT_GRIDS; i++)
        s->failed = t->net.bits[i] < 1 || t->net.bits[i] > TED4_WEIGHT_GRID_FULL(i);
    for (size_t i = 0; !s->failed && i < n; i++)
        s->failed = t->search.trial[i].candidate < 0 ||
                    t->search.trial[i].candidate >= TED4_CANDIDATES;
}

static void walk_exposure(stream *s, ted4_exposure *e)
{
    expect(s, e->n_knots);
    put(s, e->steps, e->n_cameras * sizeof *e->steps);
    put(s, e->value, 9 * e->n_cameras * e->n_knots * sizeof *e->value);
}

static void walk_colour(stream *s, ted4_trainer *t)
{
    ted4_colour *c = &t->colour;

    expect(s, c->n_cameras);
    put(s, c->steps, c->n_cameras * sizeof *c->steps);
    put(s, c->value, c->n_cameras * sizeof *c->value);
    put(s, c->m, c->n_cameras * sizeof *c->m);
    put(s, c->v, c->n_cameras * sizeof *c->v);
    walk_exposure(s, &c->exposure);
}

static void walk_poses(stream *s, ted4_trainer *t)
{
    ted4_poses *p = &t->poses;

    expect(s, p->n);
    put(s, &p->decision, sizeof p->decision);
    put(s, &p->moved, sizeof p->moved);
    put(s, p->steps, p->n * sizeof *p->steps);
    put(s, p->value, p->n * sizeof *p->value);
    put(s, p->m, p->n * sizeof *p->m);
    put(s, p->v, p->n * sizeof *p->v);
    s->failed |= !s->writing && !s->failed &&
                 !(p->decision >= TED4_POSES_ON_TRIAL && p->decision <= TED4_POSES_GIVEN);
}

static void walk(stream *s, ted4_trainer *t)
{
    expect(s, MAGIC);
    expect_or(s, t, FORMAT, "it is of another version of ted4enc");
    expect_number(s, t, t->data->n_pictures, "pictures");
    expect_number(s, t, t->data->n_frames, "times");
    expect_or(s, t, ted4_dataset_digest(t->data),
              "it is of other pictures, cameras, points or background (another scene, --downscale, "
              "--black)");
    put(s, &t->phase.stage2, sizeof t->phase.stage2);
    walk_options(s, t);
    expect(s, ted4_options_hash(&t->opt, t->phase.stage2 ? 2 : 1));
    walk_layout(s, t);
    if (!s->failed)
        walk_capacity(s, t);
    put(s, &t->voxel, sizeof t->voxel);
    put(s, &t->iteration, sizeof t->iteration);
    put(s, &t->seconds, sizeof t->seconds);
    put(s, &t->phase.integer, sizeof t->phase.integer);
    put(s, &t->phase.stage2_start, sizeof t->phase.stage2_start);
    put(s, &t->search.probed, sizeof t->search.probed);
    put(s, t->search.probe_loss, sizeof t->search.probe_loss);
    put(s, &t->closing, sizeof t->closing);
    put(s, &t->progress, sizeof t->progress);
    put(s, &t->monitor.state, sizeof t->monitor.state);
    expect(s, t->order.n);
    put(s, t->order.item, t->order.n * sizeof *t->order.item);
    put(s, &t->order.next, sizeof t->order.next);
    put(s, &t->order.round, sizeof t->order.round);
    s->failed |= !s->writing && !s->failed && !(order_is_whole(t) && numbers_are_possible(t));
    walk_colour(s, t);
    walk_poses(s, t);
    walk_anchors(s, t);
    if (!s->failed)
        walk_networks(s, t);
    if (s->whole)
        walk_good(s, t);
}

/* Runs the walk on file or, if file is NULL, on memory. When writing, memory must be empty, but
 * may have capacity allocated bytes. Returns 0 or -1. */
static int run(ted4_trainer *t, FILE *file, ted4_snapshot *memory, size_t capacity, int writing,
               int whole)
{
    stream s = { .file = file,
                 .memory = memory,
                 .capacity = capacity,
                 .writing = writing,
                 .whole = whole,
                 .hash = XXH3_createState() };

    if (s.hash == NULL)
        return -1;
    XXH3_64bits_reset(s.hash);
    s.failed = !writing && !ted4_state_intact(&s);
    if (s.failed)
        ted4_trainer_fail(t, "it is cut short or damaged, or of another kind");
    XXH3_64bits_reset(s.hash);
    walk(&s, t);
    ted4_state_hash(&s);
    XXH3_freeState(s.hash);
    return s.failed ? -1 : 0;
}

/* Writes any state. The message needs the errno of the first failure; a state that a checkpoint may
 * not hold sets none. */
static int put_state(ted4_trainer *t, FILE *f, const char *name)
{
    errno = 0;
    if (run(t, f, NULL, 0, 1, 1) == 0 && fflush(f) == 0 && fsync(fileno(f)) == 0)
        return 0;
    return ted4_trainer_fail(t, "%s: %s", name, strerror(errno != 0 ? errno : EIO));
}

int ted4_checkpoint_write(ted4_trainer *t, FILE *f, const char *name)
{
    return ted4_trainer_check(t, 1) != 0 ? -1 : put_state(t, f, name);
}

int ted4_checkpoint_save(ted4_trainer *t, const char *path)
{
    FILE *f;

    if (ted4_trainer_check(t, 1) != 0)
        return -1;
    f = fopen(path, "wb");
    if (f == NULL)
        return ted4_trainer_fail(t, "%s: %s", path, strerror(errno));

    const int bad = put_state(t, f, path);

    if (fclose(f) != 0 && bad == 0)
        return ted4_trainer_fail(t, "%s: %s", path, strerror(errno));
    return bad;
}

static int load(ted4_trainer *t, FILE *f, ted4_snapshot *memory, const char *name, int whole)
{
    const ted4_message before = t->message;

    t->message.text[0] = 0;
    if (run(t, f, memory, 0, 0, whole) != 0) {
        const ted4_message m = t->message;

        return ted4_trainer_fail(t, "%s: not a checkpoint of this scene with these options%s%.500s",
                                 name, m.text[0] != 0 ? ": " : "", m.text);
    }
    t->message = before;
    if (t->phase.integer)
        ted4_rate_pack(t->work.rate, t->net.value);
    return 0;
}

int ted4_checkpoint_load(ted4_trainer *t, const char *path)
{
    FILE *f = fopen(path, "rb");

    if (f == NULL)
        return ted4_trainer_fail(t, "%s: %s", path, strerror(errno));

    const int bad = load(t, f, NULL, path, 1);

    fclose(f);
    return bad;
}

static int take(ted4_trainer *t, ted4_snapshot *s, int whole)
{
    const size_t capacity = s->bytes != NULL ? s->size : 0;

    s->size = 0;
    if (run(t, NULL, s, capacity, 1, whole) == 0)
        return 0;
    ted4_snapshot_free(s);
    return ted4_trainer_fail(t, "no memory for a snapshot");
}

static int restore(ted4_trainer *t, const ted4_snapshot *s, int whole)
{
    ted4_snapshot memory = *s;

    return load(t, NULL, &memory, "snapshot", whole);
}

int ted4_snapshot_take(ted4_trainer *t, ted4_snapshot *s)
{
    return take(t, s, 1);
}

int ted4_snapshot_restore(ted4_trainer *t, const ted4_snapshot *s)
{
    return restore(t, s, 1);
}

int ted4_state_take(ted4_trainer *t, ted4_snapshot *s)
{
    return take(t, s, 0);
}

int ted4_state_restore(ted4_trainer *t, const ted4_snapshot *s)
{
    return restore(t, s, 0);
}
