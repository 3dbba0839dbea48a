/* fz_checkpoint.c - a trainer's checkpoint: u8 which (bit 0: of stage 1 or of the integer stage;
 * bit 1: its hash is left wrong), then changes of a valid one: u24 offset, u8 number of bytes,
 * those bytes; the number 255 truncates the file at the offset. Claims: a valid file is accepted,
 * and one with a wrong hash is refused. Any other file is refused with a message, or gives a
 * trainer whose header is one that the format allows, whose anchors lie in the cube, whose pictures
 * exist, and which makes a step or returns a message. The capacity for anchors is in proportion to
 * the file's size.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>
#include <string.h>
#include <xxhash.h>
#include "harness.h"
#include "scene_folder.h"
#include "train/monitor/checkpoint.h"
#include "train/step/trainer_init.h"
#include "train/train.h"
#include "write/coder_count.h"

enum { BASES = 2, CUT = 255, STEPS_1 = 2, STEPS_2 = 4 };

static struct {
    ted4_dataset data;
    ted4_train_options o;
    ted4_snapshot base[BASES];
} lab;

static void set(const char *text)
{
    char why[256];

    fuzz_require(ted4_options_set(&lab.o, text, why, sizeof why) == 0, text);
}

static void load_scene(void)
{
    static const ted4_dataset_options wanted = { .downscale = 1,
                                                 .seed = 3,
                                                 .cache_bytes = 1 << 20 };
    static const char scene[] = "{\"fl_x\":3,\"w\":2,\"h\":2,\"fps\":5,\"frames\":["
                                "{\"file_path\":\"a.png\",\"time\":0,\"transform_matrix\":[[1,0,0,"
                                "0],[0,1,0,0],[0,0,1,4],[0,0,0,1]]},"
                                "{\"file_path\":\"b.png\",\"time\":1,\"transform_matrix\":[[1,0,0,"
                                "0.3],[0,1,0,0],[0,0,1,4],[0,0,0,1]]}]}";
    static const char points[] = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float "
                                 "x\nproperty float y\nproperty float z\n"
                                 "end_header\n0 0 0\n0.2 0.1 0\n-0.1 0.3 0.2\n";
    ted4_message m;

    const char *folder = fuzz_scene("checkpoint");

    (void)fuzz_picture("a.png");
    (void)fuzz_picture("b.png");
    (void)fuzz_text("transforms.json", scene);
    (void)fuzz_text("points3d.ply", points);
    fuzz_require(ted4_dataset_load(&lab.data, folder, &wanted, &m) == 0, "a scene");
}

/* A checkpoint in a file equals the one in memory. */
static void check_file(ted4_trainer *t)
{
    char path[600];

    (void)snprintf(path, sizeof path, "%s", fuzz_text("checkpoint.bin", ""));
    fuzz_require(ted4_checkpoint_save(t, path) == 0, t->message.text);
    fuzz_require(ted4_checkpoint_load(t, path) == 0, t->message.text);
    fuzz_no_file("checkpoint.bin");
    fuzz_require(ted4_checkpoint_load(t, path) != 0, "no file, no checkpoint");
    fuzz_check_message(&t->message);
}

/* Trains a few steps, and keeps a state of each of the two stages. */
static void prepare(void)
{
    static const char *const small[] = { "stage1=2",        "stage2=3",       "offsets=1",
                                         "feature=4",       "phi=1",          "bank_dim=1",
                                         "deform_layers=1", "deform_width=1", "head_width=1",
                                         "hyper_layers=1",  "hyper_width=1",  "ar_width=1",
                                         "slices=2",        "octaves=0",      "probe=0",
                                         "sprouts=0" };
    ted4_trainer t;

    load_scene();
    fuzz_require(ted4_options_preset(&lab.o, "draft") == 0, "a preset");
    for (size_t i = 0; i < sizeof small / sizeof *small; i++)
        set(small[i]);
    fuzz_require(ted4_trainer_init(&t, &lab.o, &lab.data, NULL) == 0, "a trainer");
    for (int i = 0; i < STEPS_2; i++) {
        if (i + 1 == STEPS_1)
            fuzz_require(ted4_snapshot_take(&t, &lab.base[0]) == 0, "a checkpoint of stage 1");
        fuzz_require(ted4_trainer_step(&t) == 0, t.message.text);
    }
    fuzz_require(ted4_snapshot_take(&t, &lab.base[1]) == 0, "a checkpoint of stage 2");
    check_file(&t);
    ted4_trainer_finish(&t);
}

/* Returns the changed file; s->bytes is owned by the caller. */
static ted4_snapshot change(fuzz_source *in, int which)
{
    const ted4_snapshot *base = &lab.base[which & 1];
    ted4_snapshot s = { malloc(base->size + 8), base->size };
    uint64_t hash;

    fuzz_require(s.bytes != NULL, "memory");
    memcpy(s.bytes, base->bytes, base->size);
    while (in->at < in->end) {
        const size_t at = (size_t)fuzz_take(in, 3);
        const int n = fuzz_u8(in);

        if (n == CUT && at >= 8 && at < s.size)
            s.size = at;
        for (int i = 0; n != CUT && i < n && at + (size_t)i < s.size; i++)
            s.bytes[at + (size_t)i] = (char)fuzz_u8(in);
    }
    hash = XXH3_64bits(s.bytes, s.size - 8) ^ (which >> 1 & 1);
    memcpy(s.bytes + s.size - 8, &hash, sizeof hash);
    return s;
}

/* Checks the header with the walk that a writer of the file would begin with. */
static void check_header(const ted4_trainer *t)
{
    ted4_header h = t->layout.head;
    ted4_shape shape;
    ted4_counter c;

    h.n_anchors = 1; /* a trainer does not keep it in the header */
    ted4_counter_init(&c);
    ted4_walk_header(&c.base, &h, &shape, 31, UINT64_MAX);
    fuzz_require(c.base.error.code == TED4_OK, "a header of the format");
    for (uint32_t i = 0; i < t->order.n; i++)
        fuzz_require(t->order.item[i] < t->data->n_pictures, "pictures that exist");
    fuzz_require(t->order.next <= t->order.n, "a place in their order");
}

static void check_positions(const ted4_trainer *t)
{
    for (size_t i = 0; i < t->anchors.n; i++)
        for (int j = 0; j < 3; j++)
            fuzz_require(fabsf(*ted4_anchor_value(&t->anchors, TED4_ROW_POSITION, i, j)) <= 1,
                         "anchors in the cube");
}

/* A position takes 12 of an anchor's bytes in the file. Capacities grow by half, and by a few
 * blocks. */
static void check_capacity(const ted4_trainer *t, size_t size)
{
    fuzz_require(t->anchors.capacity * TED4_LANES * 12 <= 2 * size + 16 * TED4_LANES * 12,
                 "no more room than the file fills");
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_source in = { data, data + size };
    ted4_trainer t;

    if (lab.base[1].bytes == NULL)
        prepare();

    const int which = fuzz_u8(&in), good = size == 1 && which < BASES;
    ted4_snapshot s = change(&in, which);

    fuzz_require(ted4_trainer_init(&t, &lab.o, &lab.data, NULL) == 0, "a trainer");
    if (ted4_snapshot_restore(&t, &s) == 0) {
        fuzz_require(!(which >> 1 & 1), "a wrong hash is refused");
        check_header(&t);
        check_positions(&t);
        if (ted4_trainer_check(&t, 1) == 0 && ted4_trainer_step(&t) != 0)
            fuzz_check_message(&t.message);
    } else {
        fuzz_require(!good, "a good one is accepted");
        fuzz_check_message(&t.message);
        check_capacity(&t, s.size);
    }
    ted4_trainer_finish(&t);
    ted4_snapshot_free(&s);
    return 0;
}
