/* corpus_units.c - see corpus.h. Most of these harnesses accept any numbers. Only the values that
 * an input needs to get past the first checks are set to valid ones.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <stdio.h>
#include <zlib.h>
#include "corpus.h"
#include "norm/coded_weights.h"
#include "norm/octree.h"
#include "random_scene.h"
#include "tool/cams.h"
#include "write/coder_write.h"

enum { MOST = 1 << 12 };

/* Writes n given bytes, followed by random ones. */
static void any(const char *group, const char *name, size_t size, const char *first, size_t n)
{
    random_source r = random_seed(size + (unsigned char)group[0]);
    uint8_t data[MOST];

    for (size_t i = 0; i < size; i++)
        data[i] = (uint8_t)random_u32(&r);
    memcpy(data, first, n);
    corpus_write(group, name, data, size);
}

/* Seeds that consist of such bytes. */
static const struct {
    const char *group, *name;
    size_t size;
    const char *first;
    size_t n;
} anything[] = {
#define SEED(group, name, size, first)             \
    {                                              \
        group, name, size, first, sizeof first - 1 \
    }
    SEED("encode", "plain", 60, "\2"),
    SEED("encode", "escapes", 61, "\1"),
    SEED("encode", "level2", 62, "\2aaaaaa\17"),
    SEED("encode", "level4", 63, "\4aaaaaa\37"),
    SEED("rans", "symbols", 300, "\2"),
    SEED("rans", "bits", 301, "\2\xff\xf0\xff"),
    SEED("rans", "any", 200, "\1"),
    SEED("cdf", "narrow", 60, "\5"),
    SEED("cdf", "wide", 61, "\xe0"),
    SEED("net_int", "small", 200, "\3\4"),
    SEED("net_int", "wide", 1200, "\x41\x07"),
    SEED("net_int", "odd", 400, "\5\11"),
    SEED("integerise", "nets0", 500, ""),
    SEED("integerise", "nets1", 501, ""),
    SEED("integerise", "nets2", 502, ""),
    SEED("integerise", "nets3", 503, ""),
    SEED("integerise", "nets4", 504, ""),
    SEED("integerise", "nets5", 505, ""),
    SEED("integerise", "nets6", 506, ""),
    SEED("integerise", "nets7", 507, ""),
    SEED("positions", "any", 60, ""),
    SEED("masks", "both", 300, "\4\0\1\1"),
    SEED("masks", "offsets", 301, "\4\0\2\1"),
    SEED("masks", "none", 302, "\4\0\2\2"),
    SEED("masks", "dynamic", 303, "\4\0\1\2"),
    SEED("masks", "contradicting", 304, "\4\0\1\1\40\0\3\0"),
    SEED("masks", "beyond", 305, "\4\0\0\1\40\0\3\0"),
    SEED("masks", "compact", 306, "\4\0\1\1\40\0\0\3"),
    SEED("encode", "compact", 64, "\2\1"),
    SEED("encode", "compact_escapes", 65, "\3\7"),
    SEED("coded", "tree", 200, "\0\0\40\0"),
    SEED("coded", "fine_tree", 201, "\0\7\40\0"),
    SEED("coded", "integers", 202, "\2\40"),
    SEED("coded", "weights", 203, "\4\40\360\0"),
    SEED("inflate", "values", 300, "\1"),
#undef SEED
};

static void positions(void)
{
    random_source r = random_seed(3);
    ted4_header h = random_header(&r);
    ted4_scene *s;
    uint8_t data[6 * 40];

    h.n_anchors = 40;
    s = random_scene_of(&r, &h, 0);
    for (size_t i = 0; s != NULL && i < 120; i++)
        ted4_store16(data + 2 * i, s->position[i]);
    ted4_scene_free(s);
    corpus_write("positions", "sorted", data, sizeof data);
    memmove(data + 66, data + 60, 6);
    corpus_write("positions", "doubled", data, sizeof data);
    ted4_store16(data + 60, 0x8000);
    corpus_write("positions", "negative_zero", data, sizeof data);
    ted4_store16(data + 60, 0x3c01);
    corpus_write("positions", "above_one", data, sizeof data);
}

/* Kind 1 of fz_rans.c: models, then the substream that the writer produces for a few symbols. sigma
 * index 64, mu 64 / 256. */
static void substream(void)
{
    static const int16_t k[6] = { 0, 1, -2, 40, -300, 3 };
    static const int32_t mu[6] = { 0 };
    uint8_t sigma[6], data[MOST] = { 1, 5 };
    size_t n = 2;
    uint32_t size;
    ted4_writer w;

    memset(sigma, 64, sizeof sigma);
    for (int i = 0; i < 6; i++) { /* prob - 1 = 65535 mod 65535 = 0, so mu is 1 << 6 */
        data[n++] = 64;
        data[n++] = 255;
        data[n++] = 255;
        data[n++] = (uint8_t)k[i];
        data[n++] = (uint8_t)(k[i] >> 8);
    }
    ted4_writer_init(&w);
    w.base.ops->sizes(&w.base, &size, 1);
    w.base.ops->open(&w.base, 6);
    for (int i = 0; i < 6; i++) {
        const int32_t here = mu[i] + 64;
        int16_t symbol = k[i];

        w.base.ops->gauss(&w.base, 1, &here, &sigma[i], &symbol);
    }
    w.base.ops->close(&w.base);
    memcpy(data + n, w.out.data + 4, w.out.size - 4);
    corpus_write("rans", "substream", data, n + w.out.size - 4);
    ted4_writer_finish(&w);
}

/* Odd kinds of fz_coded.c: substreams of a tree of two leaves, 6 bits deep, of integers and of
 * weights of exponent -8. */
static void adaptive(int kind)
{
    uint16_t p[6] = { 0, 0, 0, 0x3400, 0x3800, 0xb800 };
    float x[20];
    uint8_t data[MOST] = { (uint8_t)kind, kind == 1 ? 0 : 19, kind == 1 ? 1 : 248 };
    uint32_t size;
    ted4_integer_model m;
    ted4_writer w;

    ted4_integer_model_init(&m);
    ted4_writer_init(&w);
    w.base.ops->sizes(&w.base, &size, 1);
    w.base.ops->open(&w.base, 1);
    for (int i = 0; i < 20; i++)
        x[i] = (float)(i * i * i % 100 - 40) / 256;
    if (kind == 1)
        (void)ted4_octree_walk(&w.base, 6, 2, p);
    else if (kind == 5)
        ted4_code_weights(&w.base, &m, -8, x, 20);
    for (unsigned i = 0; kind == 3 && i < 20; i++)
        (void)ted4_code_integer(&w.base, &m, (248 + i) % TED4_INTEGER_LENGTHS, (int32_t)(i << i));
    w.base.ops->close(&w.base);
    memcpy(data + 4, w.out.data + 4, w.out.size - 4);
    corpus_write("coded",
                 kind == 1   ? "tree_substream"
                 : kind == 3 ? "integers_substream"
                             : "weights_substream",
                 data, w.out.size);
    ted4_writer_finish(&w);
}

static void deflated(void)
{
    uint8_t values[400] = { 0 }, data[MOST] = { 0, 100, 0, 0, 0 };
    uLongf n = sizeof data - 5;

    for (size_t i = 0; i < sizeof values; i++)
        values[i] = (uint8_t)(i / 60);
    if (compress2(data + 5, &n, values, sizeof values, 9) != Z_OK)
        return;
    corpus_write("inflate", "stream", data, 5 + n);
    data[5 + n] = 0;
    corpus_write("inflate", "trailing", data, 6 + n);
    data[3] = 8; /* a tight memory limit */
    corpus_write("inflate", "tight", data, 5 + n);
    data[3] = 0;
    data[5 + n / 2] ^= 1;
    corpus_write("inflate", "damaged", data, 5 + n);
}

/* Two cameras, at all times and at one, and variants of their payload that are refused. */
static void cameras(void)
{
    static const float up[3] = { 0, 0, 1 };
    const ted4_cams_camera camera = { .view = { .width = 64,
                                                .height = 48,
                                                .fx = 60,
                                                .fy = 61,
                                                .cx = 32,
                                                .cy = 24,
                                                .R = { 0, 1, 0, 0, 0, 1, 1, 0, 0 },
                                                .t = { 1, 2, 3 } },
                                      .time = { 1, 4 } };
    ted4_cams_camera always = camera;
    uint8_t data[TED4_CAMS_HEAD + 2 * TED4_CAMS_CAMERA];

    always.time = (ted4_time) { 0, 0 };
    ted4_cams_put_head(data, up, TED4_CAMS_PATH, 2);
    ted4_cams_put(data + TED4_CAMS_HEAD, &camera);
    ted4_cams_put(data + TED4_CAMS_HEAD + TED4_CAMS_CAMERA, &always);
    corpus_write("cams", "two", data, sizeof data);
    corpus_write("cams", "short", data, sizeof data - 1);
    data[3] = 0x7f; /* up x: no longer of length 1 */
    corpus_write("cams", "up", data, sizeof data);
    ted4_cams_put_head(data, up, TED4_CAMS_TAKEN, 0);
    corpus_write("cams", "none", data, TED4_CAMS_HEAD);
}

void corpus_units(void)
{
    static const uint8_t times[][22] = { { 1, 1, 0, 0, 0, 3, 0, 0, 0, 4 },
                                         { 2, 0, 0, 0, 0, 9, 0, 0, 0, 1 },
                                         { 3, 7, 0, 0, 0, 7, 0, 0, 0, 2 },
                                         { 0, 5, 0, 0, 0, 0, 0, 0, 0 },
                                         { 4, 1, 0, 0, 0, 2, 0, 0, 0, 0, 0, 0, 192, 127 },
                                         { 5, 0xff, 0xff, 0xff, 0, 0xff, 0xff, 0xff, 0, 0 } };
    char name[32];

    for (size_t i = 0; i < sizeof anything / sizeof *anything; i++)
        any(anything[i].group, anything[i].name, anything[i].size, anything[i].first,
            anything[i].n);
    substream();
    adaptive(1);
    adaptive(3);
    adaptive(5);
    cameras();
    positions();
    deflated();
    for (size_t i = 0; i < sizeof times / sizeof *times; i++) {
        (void)snprintf(name, sizeof name, "time%zu", i);
        corpus_write("query_time", name, times[i], sizeof times[i]);
    }
}
