/* checkpoint.c - see checkpoint.h. Native byte order: a checkpoint stays on the machine that made it.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "checkpoint.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <xxhash.h>

#define MAGIC 0x34444554u       /* "TED4" */
enum { FORMAT = 1 };

/* One walk for both directions: put() writes or reads the bytes at p. */
typedef struct {
    FILE         *file;
    int           writing, failed;
    XXH3_state_t *hash;
} stream;

static void put(stream *s, void *p, size_t size)
{
    if (s->failed || size == 0)
        return;
    const size_t done = s->writing ? fwrite(p, 1, size, s->file) : fread(p, 1, size, s->file);

    if (done != size) {
        s->failed = 1;
        return;
    }
    XXH3_64bits_update(s->hash, p, size);
}

/* Reading: the file must hold this very value. */
static void expect(stream *s, uint64_t value)
{
    uint64_t x = value;

    put(s, &x, sizeof x);
    s->failed |= x != value;
}

static void walk_anchors(stream *s, ted4_trainer *t)
{
    uint64_t n = t->anchors.n;

    put(s, &n, sizeof n);
    if (s->failed)
        return;
    if (!s->writing && (n > (1u << 24) || ted4_anchors_resize(&t->anchors, (size_t)n) != 0)) {
        s->failed = 1;
        return;
    }
    for (int k = 0; k < TED4_ROWS; k++)
        put(s, t->anchors.data[k], t->anchors.n_blocks * (size_t)t->anchors.rows[k] *
                                       TED4_LANES * sizeof(float));
}

/* The header tells the layout, which may have lost parts at the start of stage 2. */
static void walk_layout(stream *s, ted4_trainer *t)
{
    ted4_header h = t->layout.head;

    put(s, &h, sizeof h);
    if (s->writing || s->failed)
        return;
    ted4_layout_make(&t->layout, &h);
    ted4_anchors_finish(&t->anchors);
    if (ted4_anchors_init(&t->anchors, &t->layout) != 0 || ted4_trainer_rebuild(t) != 0)
        s->failed = 1;
}

static void walk(stream *s, ted4_trainer *t)
{
    uint8_t has_shift = t->shift != NULL;

    expect(s, MAGIC);
    expect(s, FORMAT);
    expect(s, ted4_options_hash(&t->opt));
    expect(s, t->data->n_pictures);
    expect(s, t->data->n_frames);
    walk_layout(s, t);
    put(s, &t->cell, sizeof t->cell);
    put(s, &t->iteration, sizeof t->iteration);
    put(s, &t->stage2, sizeof t->stage2);
    put(s, &t->integer, sizeof t->integer);
    put(s, &t->stage2_start, sizeof t->stage2_start);
    put(s, &t->progress, sizeof t->progress);
    expect(s, t->order.n);
    put(s, t->order.item, t->order.n * sizeof *t->order.item);
    put(s, &t->order.next, sizeof t->order.next);
    put(s, &t->order.round, sizeof t->order.round);
    walk_anchors(s, t);
    if (s->failed)
        return;
    put(s, t->net, t->layout.n_net * sizeof *t->net);
    put(s, t->net_m, t->layout.n_net * sizeof *t->net_m);
    put(s, t->net_v, t->layout.n_net * sizeof *t->net_v);
    put(s, &has_shift, 1);
    if (has_shift && t->shift == NULL && (t->shift = malloc(t->layout.shape.n_units + 1)) == NULL) {
        s->failed = 1;
        return;
    }
    if (has_shift)
        put(s, t->shift, t->layout.shape.n_units);
}

/* The last eight bytes are the hash of all others. Looked at before anything in the file is
 * believed, for sizes in it decide about memory. The file is at its start again afterwards. */
static int intact(FILE *file, XXH3_state_t *hash)
{
    uint8_t  bytes[1 << 14];
    uint64_t want;
    long     left = fseek(file, 0, SEEK_END) == 0 ? ftell(file) - (long)sizeof want : -1;

    if (left < 0 || fseek(file, 0, SEEK_SET) != 0)
        return 0;
    while (left > 0) {
        const size_t n = left < (long)sizeof bytes ? (size_t)left : sizeof bytes;

        if (fread(bytes, 1, n, file) != n)
            return 0;
        XXH3_64bits_update(hash, bytes, n);
        left -= (long)n;
    }
    return fread(&want, 1, sizeof want, file) == sizeof want &&
           XXH3_64bits_digest(hash) == want && fseek(file, 0, SEEK_SET) == 0;
}

static void walk_hash(stream *s)
{
    const uint64_t hash = XXH3_64bits_digest(s->hash);

    expect(s, hash);
}

static int run(ted4_trainer *t, FILE *file, int writing)
{
    stream s = { file, writing, 0, XXH3_createState() };

    if (s.hash == NULL)
        return -1;
    XXH3_64bits_reset(s.hash);
    s.failed = !writing && !intact(file, s.hash);
    XXH3_64bits_reset(s.hash);
    walk(&s, t);
    walk_hash(&s);
    XXH3_freeState(s.hash);
    return s.failed ? -1 : 0;
}

int ted4_checkpoint_save(ted4_trainer *t, const char *path)
{
    char  name[4096];
    FILE *f;

    if (snprintf(name, sizeof name, "%s.part", path) >= (int)sizeof name)
        return ted4_trainer_fail(t, "%s: name too long", path);
    f = fopen(name, "wb");
    if (f == NULL)
        return ted4_trainer_fail(t, "%s: %s", name, strerror(errno));

    int bad = run(t, f, 1);

    bad |= fflush(f) != 0 || fsync(fileno(f)) != 0;
    bad |= fclose(f) != 0;
    if (bad || rename(name, path) != 0) {
        ted4_trainer_fail(t, "%s: %s", path, strerror(errno));
        remove(name);
        return -1;
    }
    return 0;
}

int ted4_checkpoint_load(ted4_trainer *t, const char *path)
{
    FILE *f = fopen(path, "rb");

    if (f == NULL)
        return ted4_trainer_fail(t, "%s: %s", path, strerror(errno));

    const int bad = run(t, f, 0);

    fclose(f);
    if (bad)
        return ted4_trainer_fail(t, "%s: not a checkpoint of this scene with these options", path);
    if (t->integer) {
        ted4_rate_pack(t->rate, t->net);
    }
    return 0;
}
