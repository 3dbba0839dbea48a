/* ted4.h - the public interface of libted4dec: TED4 bytes in, Gaussians of any time out.
 * Depends on base/parallel.h and base/status.h only. The library prints nothing, starts no thread,
 * keeps no global state.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_H
#define TED4_H

#include <stddef.h>
#include <stdint.h>
#include "base/parallel.h"
#include "base/status.h"

#ifdef __cplusplus
extern "C" {
#endif

#define TED4_VERSION      "0.2.0-dev"
#define TED4_SPEC_VERSION "1.0"

/* NULL members: malloc and free. alloc(user, size) returns NULL or storage aligned for any type. */
typedef struct {
    void *(*alloc)(void *user, size_t size);
    void (*free)(void *user, void *block);
    void *user;
} ted4_allocator;

/* All zero is a good default. */
typedef struct {
    ted4_allocator allocator;
    const ted4_parallel *parallel; /* borrowed during the call; NULL: one thread */
    uint64_t max_bytes;            /* of memory the scene may take; 0: 4 GiB. Above: limit.memory */
    uint64_t max_work; /* steps of spec 13.4 that a file, or a query, may ask for; 0: any. Above:
                          limit.work */
    void (*trace)(void *user, size_t offset, const char *element, int64_t index, int64_t value);
    void *
        trace_user; /* trace: called for every syntax element, in order, on one thread; NULL: off */
} ted4_options;

typedef struct ted4_scene ted4_scene; /* Tier E of a file, decoded */

/* Decodes a whole file, strictly (spec 3, 5 to 10, 14). TED4_OK: *scene is set. Otherwise *scene is
 * NULL and *e says why and where. o may be NULL. data is not kept. */
ted4_status ted4_decode(const void *data, size_t size, const ted4_options *o, ted4_scene **scene,
                        ted4_error *e);
void ted4_scene_free(ted4_scene *s); /* NULL is fine */

/* What a lenient decoder has got out of a file. */
typedef struct {
    ted4_error verdict; /* of the strict decoder */
    ted4_error stop; /* the first error in the order of the file, where decoding ended; or the limit
                        that was met */
    uint32_t n_tiles;                          /* that the scene holds: the first ones, whole */
    uint32_t tiles_declared, anchors_declared; /* by HEAD; 0 where that is not right */
} ted4_salvage;

/* Lenient decoding (spec 3.3). Gives the verdict of ted4_decode. TED4_OK: the same scene, and stop
 * is TED4_OK. Invalid: *scene holds the anchors of the first what->n_tiles tiles, with a hash of
 * its own, or is NULL when there is no such tile. Otherwise it is NULL. The trace of o sees what
 * the strict decoder reads. */
ted4_status ted4_decode_lenient(const void *data, size_t size, const ted4_options *o,
                                ted4_scene **scene, ted4_salvage *what);

/* A validator's finding (spec 3.6, read/findings.def). Strings are constants of the library. */
typedef enum { TED4_ERROR, TED4_WARNING, TED4_HINT } ted4_severity;
typedef struct {
    ted4_severity severity;
    const char *id, *rule, *text; /* "con.magic" of status.def, or "adv.level"; "R-CON-001" */
    const char *where; /* what kind of chunk or symbol: "TILE", "phi"; NULL: nothing more to say */
    size_t offset;
    unsigned n_values; /* of the numbers that text names: 0, 1, 2 */
    int64_t value[2];
} ted4_finding;
typedef void ted4_finding_sink(void *user, const ted4_finding *f);

/* For authors of encoders: gives the verdict of ted4_decode, and every finding to the sink: the
 * error of the strict decoder first, then the others as far as parsing can go on; of a valid file,
 * advice. There is an error among them exactly when the verdict is not TED4_OK. Too little memory
 * to look further changes no verdict: it is a hint, adv.memory. o may be NULL; its trace is not
 * called. */
ted4_status ted4_validate(const void *data, size_t size, const ted4_options *o,
                          ted4_finding_sink *sink, void *user);

/* spec 6.1: how anchors move (11.3), and which heads see the view direction. */
enum { TED4_MOTION_NONE, TED4_MOTION_BANK, TED4_MOTION_CONCAT, TED4_MOTION_INR };
enum { TED4_VIEW_NONE, TED4_VIEW_COLOUR, TED4_VIEW_FULL };

/* spec 6.1, where a member bears the name of an element. */
typedef struct {
    uint32_t n_anchors, n_offsets; /* anchors; Gaussians an anchor at most */
    uint32_t frames, rate_num,
        rate_den; /* frame j: time j / (frames - 1), or 0; rate_num / rate_den frames a second */
    size_t n_gaussians; /* kept offsets: records of a query */
    uint32_t n_dynamic; /* anchors that move */
    int level;          /* spec 13.1: 1 to 4, or 31: without bounds */
    int view, motion;   /* TED4_VIEW_..., TED4_MOTION_... */
    int activation;     /* 1: anchors come and go (11.4); 0: they are always there */
    float origin[3];    /* in world units: where the normalised position is 0 */
    int exponent; /* 2^exponent world units are 1 of normalised space, where anchors lie in [-1, 1]
                   */
    uint8_t background[3]; /* display-referred sRGB: red, green, blue */
    uint8_t hash[16];      /* of the decoded integers, spec 15.2 */
} ted4_info;

void ted4_scene_info(const ted4_scene *s, ted4_info *info);

/* annex J: pieces of a tier's byte string, in order, many small ones. */
typedef void ted4_sink(void *user, const void *bytes, size_t size);

/* T0 of a file; decodes it, and what was given is to be thrown away unless this is TED4_OK. o may
 * be NULL; its trace is not called. */
ted4_status ted4_dump_syntax(const void *data, size_t size, const ted4_options *o, ted4_sink *sink,
                             void *user, ted4_error *e);
/* T1 to T4 of a decoded scene, tier = 1 .. 4. TED4_OK or TED4_E_LIMIT_MEMORY. max_work of o does
 * not count; o may be NULL. */
ted4_status ted4_dump_tier(const ted4_scene *s, int tier, const ted4_options *o, ted4_sink *sink,
                           void *user);

/* spec 11: time num / den in [0, 1], camera centre in world coordinates. */
typedef struct {
    uint32_t num, den;
    float camera[3];
} ted4_query;

/* Records of a query as structure of arrays; id = anchor * K + offset is stable over time. Owned by
 * the ted4_recon, and to be read only: the next query computes again only what has changed. */
typedef struct {
    size_t n;
    float *mean[3], *scale[3], *rot[4], *opacity, *colour[3];
    uint32_t *id;
} ted4_gaussians;

typedef struct ted4_recon ted4_recon; /* attributes dequantised and networks laid out for queries */

/* Keeps no reference to s. TED4_OK, TED4_E_LIMIT_MEMORY, or TED4_E_LIMIT_WORK: each query would
 * take more than max_work. allocator, parallel, max_bytes and max_work of o count; o may be NULL.
 */
ted4_status ted4_recon_new(ted4_recon **r, const ted4_scene *s, const ted4_options *o);
void ted4_recon_free(ted4_recon *r);

/* Class X reconstruction (spec 11, 12.2). *g stays valid until the next query or free. TED4_OK,
 * TED4_E_QUERY (num > den or den out of range) or TED4_E_REC_NONFINITE. */
ted4_status ted4_recon_query(ted4_recon *r, const ted4_query *q, const ted4_parallel *p,
                             ted4_gaussians *g);

/* 1: this build, on this machine and in its floating-point state of now, can claim class X. 0:
 * queries still work, but their last bits may differ (-ffast-math, x87, flush to zero, another
 * rounding mode). */
int ted4_recon_class_x(void);

/* spec 15.3. hash: in canonical form. */
void ted4_gaussians_hash(const ted4_gaussians *g, uint8_t hash[16]);

#ifdef __cplusplus
}
#endif

#endif
