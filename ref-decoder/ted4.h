/* ted4.h - the public interface of libted4dec: TED4 bytes in, Gaussians of any time out.
 * Depends on base/parallel.h and base/status.h only. The library prints nothing, starts no thread, keeps no global state.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_H
#define TED4_H

#include <stddef.h>
#include <stdint.h>
#include "base/parallel.h"
#include "base/status.h"

#define TED4_VERSION      "0.1.0"
#define TED4_SPEC_VERSION "1.0"

/* NULL members: malloc and free. alloc(user, size) returns NULL or storage aligned for any type. */
typedef struct {
    void *(*alloc)(void *user, size_t size);
    void  (*free)(void *user, void *block);
    void  *user;
} ted4_allocator;

/* All zero is a good default. */
typedef struct {
    ted4_allocator       allocator;
    const ted4_parallel *parallel;      /* borrowed during the call; NULL: one thread */
    uint64_t             max_bytes;     /* of memory the scene may take; 0: 4 GiB. Above: limit.memory */
    void (*trace)(void *user, size_t offset, const char *element, int64_t index, int64_t value);
    void  *trace_user;                  /* trace: called for every syntax element, in order, on one thread; NULL: off */
} ted4_options;

typedef struct ted4_scene ted4_scene;   /* Tier E of a file, decoded */

/* Decodes a whole file, strictly (spec 3, 5 to 10, 14). TED4_OK: *scene is set. Otherwise *scene is NULL and *e says why and where.
 * o may be NULL. data is not kept. */
ted4_status ted4_decode(const void *data, size_t size, const ted4_options *o,
                        ted4_scene **scene, ted4_error *e);
void ted4_scene_free(ted4_scene *s);    /* NULL is fine */

typedef struct {
    uint32_t n_anchors, n_offsets, frames, rate_num, rate_den;
    size_t   n_gaussians;               /* kept offsets: records of a query */
    uint32_t n_dynamic;
    int      level, view, motion, activation;
    float    origin[3];
    int      exponent;
    uint8_t  background[3];
    uint8_t  hash[16];                  /* of the decoded integers, spec 15.2 */
} ted4_info;

void ted4_scene_info(const ted4_scene *s, ted4_info *info);

/* spec 11: time num / den in [0, 1], camera centre in world coordinates. */
typedef struct {
    uint32_t num, den;
    float    camera[3];
} ted4_query;

/* Records of a query as structure of arrays; id = anchor * K + offset is stable over time. Owned by the ted4_recon, and to be read only:
 * the next query computes again only what has changed. */
typedef struct {
    size_t    n;
    float    *mean[3], *scale[3], *rot[4], *opacity, *colour[3];
    uint32_t *id;
} ted4_gaussians;

typedef struct ted4_recon ted4_recon;   /* attributes dequantised and networks laid out for queries */

/* Keeps no reference to s. TED4_OK or TED4_E_LIMIT_MEMORY. allocator and max_bytes of o count; o may be NULL. */
ted4_status ted4_recon_new(ted4_recon **r, const ted4_scene *s,
                           const ted4_options *o);
void        ted4_recon_free(ted4_recon *r);

/* Class X reconstruction (spec 11, 12.2). *g stays valid until the next query or free. TED4_OK, TED4_E_QUERY (num > den or den out of range)
 * or TED4_E_REC_NONFINITE. */
ted4_status ted4_recon_query(ted4_recon *r, const ted4_query *q,
                             const ted4_parallel *p, ted4_gaussians *g);

/* 1: this build, on this machine and in its floating-point state of now, can claim class X. 0: queries still work, but their last
 * bits may differ (-ffast-math, x87, flush to zero, another rounding mode). */
int ted4_recon_class_x(void);

/* spec 15.3. hash: in canonical form. */
void ted4_gaussians_hash(const ted4_gaussians *g, uint8_t hash[16]);

#endif
