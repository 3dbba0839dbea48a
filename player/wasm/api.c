/* api.c - what the WebAssembly module exports: one file per instance, and the functions of ted4.h
 * over it. Numbers of 64 bits come and go as binary64, which JavaScript has. Results lie in static
 * records, whose layout src/decoder.js knows.
 * SPDX-License-Identifier: BSD-2-Clause */
#define XXH_STATIC_LINKING_ONLY /* the state lies in static memory */
#include <stdlib.h>
#include <string.h>
#include <xxhash.h>
#include "ted4.h"
#include "tool/budget.h"
#include "tool/record.h"

#define EXPORT(name) __attribute__((export_name(#name), used)) name

static ted4_scene *scene;
static ted4_recon *recon;
static ted4_gaussians gaussians;
static ted4_budget budget;
static struct {
    uint32_t code, offset;
} refused;
/* Of lenient decoding: tiles, declared tiles, declared anchors, code and offset of the stop. */
static uint32_t salvage[5];
static struct {
    double bytes;
    uint8_t xxh3[16];
} tier;
static XXH3_state_t state;

static ted4_options options(double max_bytes, double max_work)
{
    ted4_options o;

    memset(&o, 0, sizeof o);
    o.max_bytes = (uint64_t)max_bytes;
    o.max_work = (uint64_t)max_work;
    return o;
}

static uint32_t keep_error(ted4_error e)
{
    refused.code = e.code;
    refused.offset = (uint32_t)e.offset;
    return e.code;
}

void EXPORT(ted4_wasm_close)(void)
{
    ted4_recon_free(recon);
    ted4_scene_free(scene);
    recon = NULL;
    scene = NULL;
    memset(&gaussians, 0, sizeof gaussians);
}

/* Strict decoding; the status. with_budget: the bytes are attributed to elements, too. */
uint32_t EXPORT(ted4_wasm_open)(const void *data, size_t size, double max_bytes, double max_work,
                                int with_budget)
{
    ted4_options o = options(max_bytes, max_work);
    ted4_error e = { TED4_OK, 0 };

    ted4_wasm_close();
    memset(&budget, 0, sizeof budget);
    o.trace = with_budget ? ted4_budget_trace : NULL;
    o.trace_user = &budget;
    (void)ted4_decode(data, size, &o, &scene, &e);
    if (with_budget && scene != NULL)
        (void)ted4_budget_finish(&budget, size);
    return keep_error(e);
}

/* Lenient decoding (spec 3.3); the strict verdict. A scene may be there in spite of it. */
uint32_t EXPORT(ted4_wasm_open_lenient)(const void *data, size_t size, double max_bytes,
                                        double max_work)
{
    const ted4_options o = options(max_bytes, max_work);
    ted4_salvage what;

    ted4_wasm_close();
    memset(&what, 0, sizeof what);
    (void)ted4_decode_lenient(data, size, &o, &scene, &what);
    salvage[0] = what.n_tiles;
    salvage[1] = what.tiles_declared;
    salvage[2] = what.anchors_declared;
    salvage[3] = what.stop.code;
    salvage[4] = (uint32_t)what.stop.offset;
    return keep_error(what.verdict);
}

const void *EXPORT(ted4_wasm_error)(void)
{
    return &refused;
}

const void *EXPORT(ted4_wasm_salvage)(void)
{
    return salvage;
}

/* NULL: no scene is open. */
const ted4_info *EXPORT(ted4_wasm_info)(void)
{
    static ted4_info info;

    if (scene == NULL)
        return NULL;
    ted4_scene_info(scene, &info);
    return &info;
}

/* The first query lays the networks out, if no query takes more than max_work steps; the status. */
uint32_t EXPORT(ted4_wasm_query)(uint32_t num, uint32_t den, float x, float y, float z,
                                 double max_bytes, double max_work)
{
    const ted4_options o = options(max_bytes, max_work);
    const ted4_query q = { num, den, { x, y, z } };

    if (recon == NULL) {
        const ted4_status bad = ted4_recon_new(&recon, scene, &o);

        if (bad != TED4_OK)
            return bad;
    }
    return ted4_recon_query(recon, &q, NULL, &gaussians);
}

/* Count and addresses of the arrays, as ted4_gaussians has them. */
const ted4_gaussians *EXPORT(ted4_wasm_gaussians)(void)
{
    return &gaussians;
}

int EXPORT(ted4_wasm_class_x)(void)
{
    return ted4_recon_class_x();
}

static void add(void *user, const void *bytes, size_t size)
{
    (void)user;
    (void)XXH3_128bits_update(&state, bytes, size);
    tier.bytes += (double)size;
}

static void begin_tier(void)
{
    tier.bytes = 0;
    (void)XXH3_128bits_reset(&state);
}

static const void *end_tier(void)
{
    XXH128_canonical_t canonical;

    XXH128_canonicalFromHash(&canonical, XXH3_128bits_digest(&state));
    memcpy(tier.xxh3, canonical.digest, sizeof tier.xxh3);
    return &tier;
}

/* Size and hash of a tier of annex J, T0 to T4, of the file last opened, whose bytes are needed
 * for T0 only. NULL: no memory. */
const void *EXPORT(ted4_wasm_tier)(int number, const void *data, size_t size, double max_bytes)
{
    const ted4_options o = options(max_bytes, 0);
    ted4_error e = { TED4_OK, 0 };
    ted4_status bad;

    begin_tier();
    bad = number == 0 ? ted4_dump_syntax(data, size, &o, add, NULL, &e)
                      : ted4_dump_tier(scene, number, &o, add, NULL);
    return bad == TED4_OK ? end_tier() : NULL;
}

/* The same of T5, the records of the last query. */
const void *EXPORT(ted4_wasm_records)(void)
{
    const ted4_gaussians *g = &gaussians;
    const float *const column[TED4_RECORD_FLOATS] = TED4_RECORD_COLUMNS(g);

    begin_tier();
    for (size_t i = 0; i < g->n; i++) {
        uint8_t record[4 * TED4_RECORD_FLOATS];

        ted4_record_store(record, column, i);
        add(NULL, record, sizeof record);
    }
    return end_tier();
}

/* Row i of the bytes by element, or NULL behind the last. */
const ted4_budget_row *EXPORT(ted4_wasm_budget)(int i)
{
    return i < budget.n_rows ? &budget.row[i] : NULL;
}

/* Texts of a status, as C strings: identifier, section of the specification, sentence, verdict. */
const char *EXPORT(ted4_wasm_status)(uint32_t status, int what)
{
    const ted4_status s = (ted4_status)status;

    switch (what) {
    case 0: return ted4_status_id(s);
    case 1: return ted4_status_section(s);
    case 2: return ted4_status_text(s);
    default: return ted4_verdict_name(ted4_status_verdict(s));
    }
}

/* Storage for a file's bytes; NULL: no memory. The caller gives it back with free. */
void *EXPORT(ted4_wasm_alloc)(size_t size)
{
    return malloc(size);
}

void EXPORT(ted4_wasm_free)(void *block)
{
    free(block);
}
