/* ted4.h - the public interface of libted4dec, which decodes a TED4 file and reconstructs its
 * Gaussians at any time. "spec" is the TED4 Bitstream Specification. The library prints nothing,
 * starts no thread and keeps no global state. It reads the environment variable TED4_KERNEL; no
 * thread may change the environment during a call. This header depends on base/parallel.h and
 * base/status.h only.
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
/* The versions of the specification that are followed: 1.0 has profile Main, 1.1 Compact, too. */
#define TED4_SPEC_VERSION "1.0 and draft 1.1"

/* The source of all memory; if alloc is NULL, malloc and free are used. alloc(user, size) returns
 * size bytes aligned for any type, or NULL if memory ran out. free(user, block) releases such a
 * block. A scene or ted4_recon keeps a copy and uses it until it is freed, so user must live as
 * long. Both functions are called by the thread that calls the library. */
typedef struct {
    void *(*alloc)(void *user, size_t size);
    void (*free)(void *user, void *block);
    void *user;
} ted4_allocator;

/* Settings of a call. A structure of zeros holds the defaults. */
typedef struct {
    ted4_allocator allocator;
    /* The caller's threads, borrowed for the duration of the call. NULL: the calling thread does
     * all the work. Each needs up to 256 KiB of stack. */
    const ted4_parallel *parallel;
    /* The largest amount of memory, in bytes, that the scene or the ted4_recon may occupy,
     * including what is needed to make it. 0: 4 GiB. Beyond it, the verdict is limit.memory. */
    uint64_t max_bytes;
    /* The largest number of steps (spec 13.4) that decoding a file, or each query, may take. 0: no
     * limit. Beyond it, the verdict is limit.work. */
    uint64_t max_work;
    /* Called for every syntax element, in file order and on the calling thread, with the element's
     * byte offset in the file, its name, its index if it is part of an array (otherwise 0), and its
     * value. The symbols of a substream all have its offset, and so has the substream itself, whose
     * value is their number. A zlib stream is one element, whose index is -1 and whose value is its
     * number of bytes. NULL: no trace. */
    void (*trace)(void *user, size_t offset, const char *element, int64_t index, int64_t value);
    void *trace_user; /* the first argument of trace */
} ted4_options;

/* The decoded integers of a file (Tier E, spec 5 to 10). */
typedef struct ted4_scene ted4_scene;

/* Decodes a whole file of size bytes strictly (spec 3, 5 to 10, 14). Returns TED4_OK with *scene
 * set; the caller owns it and frees it with ted4_scene_free. On any other verdict, *scene is NULL,
 * and *e holds the error and its byte offset. The library keeps no reference to data, which may be
 * NULL if size is 0. o and e may be NULL. */
ted4_status ted4_decode(const void *data, size_t size, const ted4_options *o, ted4_scene **scene,
                        ted4_error *e);
/* Frees a scene. s may be NULL. */
void ted4_scene_free(ted4_scene *s);

/* The result of lenient decoding. */
typedef struct {
    ted4_error verdict; /* the verdict of the strict decoder */
    /* Why decoding stopped: the first error in file order, or the limit that was exceeded. */
    ted4_error stop;
    uint32_t n_tiles; /* number of decoded tiles: the first ones of the file, each complete */
    /* The numbers that HEAD declares; 0 if HEAD is not valid. */
    uint32_t tiles_declared, anchors_declared;
} ted4_salvage;

/* Decodes leniently (spec 3.3). Returns the verdict of ted4_decode.
 * If the verdict is TED4_OK, *scene is the scene of ted4_decode, and what->stop.code is TED4_OK.
 * If the file is invalid, *scene holds the anchors of the first what->n_tiles tiles and a hash of
 * just these, or is NULL if no tile could be decoded.
 * Otherwise, *scene is NULL. The caller owns *scene and frees it with ted4_scene_free. The trace of
 * o reports the elements that the strict decoder reads. data and o are those of ted4_decode. */
ted4_status ted4_decode_lenient(const void *data, size_t size, const ted4_options *o,
                                ted4_scene **scene, ted4_salvage *what);

/* A finding of the validator (spec 3.6, read/findings.def). Its strings are constants that the
 * library owns. */
typedef enum { TED4_ERROR, TED4_WARNING, TED4_HINT } ted4_severity;
typedef struct {
    ted4_severity severity;
    /* id: for example "con.magic" (base/status.def) or "adv.level"; rule: for example "R-CON-001";
     * text: a sentence for people. */
    const char *id, *rule, *text;
    const char *where; /* the kind of chunk or symbol, for example "TILE" or "phi"; NULL: none */
    size_t offset;     /* in bytes from the start of the file */
    unsigned n_values; /* number of values that text refers to: 0, 1 or 2 */
    int64_t value[2];
} ted4_finding;
typedef void ted4_finding_sink(void *user, const ted4_finding *f);

/* Validates a file, for authors of encoders. Returns the verdict of ted4_decode and calls
 * sink(user, finding) for every finding. If the file is valid, the findings are warnings and hints.
 * Otherwise, the first one is the error of the strict decoder; if the verdict class is
 * TED4_INVALID, all further errors that parsing can reach follow. A TED4_ERROR is reported if and
 * only if the verdict is not TED4_OK. If memory runs out after the verdict is known, the verdict
 * stays, and the hint adv.memory is reported. o may be NULL; its trace is not called. */
ted4_status ted4_validate(const void *data, size_t size, const ted4_options *o,
                          ted4_finding_sink *sink, void *user);

/* Values of ted4_info.motion: how anchors move (spec 6.1, 11.3); and of ted4_info.view: which heads
 * receive the viewing direction (spec 6.1). */
enum { TED4_MOTION_NONE, TED4_MOTION_BANK, TED4_MOTION_CONCAT, TED4_MOTION_INR };
enum { TED4_VIEW_NONE, TED4_VIEW_COLOUR, TED4_VIEW_FULL };

/* A summary of a scene. Members named like a syntax element have its meaning (spec 6.1). */
typedef struct {
    /* The number of anchors, and the largest number of Gaussians per anchor. */
    uint32_t n_anchors, n_offsets;
    /* The number of frames, of which frame j is at time j / (frames - 1), or at 0 if there is only
     * one; R-HDR-005 says how to query the times of more than 2^24 frames. The frame rate is
     * rate_num / rate_den frames per second. */
    uint32_t frames, rate_num, rate_den;
    size_t n_gaussians;    /* number of kept offsets, which is the number of records per query */
    uint32_t n_dynamic;    /* number of anchors that move */
    int level;             /* spec 13.1: 1 to 4, or 31, which bounds nothing; 0: not from a file */
    int view, motion;      /* TED4_VIEW_..., TED4_MOTION_... */
    int activation;        /* 1: anchors appear and disappear (spec 11.4); 0: they always exist */
    float origin[3];       /* origin of normalised space, in world units */
    int exponent;          /* 1 in normalised space, where anchors are in [-1, 1], is 2^exponent
                            * world units */
    uint8_t background[3]; /* display-referred sRGB: red, green, blue */
    uint8_t hash[16];      /* hash of the decoded integers (spec 15.2) */
} ted4_info;

/* Fills *info. This never fails. */
void ted4_scene_info(const ted4_scene *s, ted4_info *info);

/* Receives the byte string of a tier (annex J) piece by piece, in order; a piece has size bytes. */
typedef void ted4_sink(void *user, const void *bytes, size_t size);

/* Decodes a file and writes its tier T0 to the sink. Returns the verdict of ted4_decode. If that is
 * not TED4_OK, *e holds the error, and the bytes written so far are to be discarded. o and e may be
 * NULL; the trace of o is not called. */
ted4_status ted4_dump_syntax(const void *data, size_t size, const ted4_options *o, ted4_sink *sink,
                             void *user, ted4_error *e);
/* Writes one of the tiers T1 to T4 (tier = 1 .. 4; nothing for other numbers) of a decoded scene to
 * the sink. Returns TED4_OK or TED4_E_LIMIT_MEMORY. o may be NULL; its max_work is not used. */
ted4_status ted4_dump_tier(const ted4_scene *s, int tier, const ted4_options *o, ted4_sink *sink,
                           void *user);

/* A query (spec 11): the time num / den in [0, 1], with den in [1, 2^24), where 0 is the first
 * frame and 1 the last; and the camera centre in world coordinates. */
typedef struct {
    uint32_t num, den;
    float camera[3];
} ted4_query;

/* The records of a query (spec 11.6) as a structure of arrays [n]: mean and scale (standard
 * deviations along the axes) in world units; rot, a unit quaternion w, x, y, z; opacity in [0, 1];
 * colour in display-referred sRGB in [0, 1], red, green, blue. id = anchor * n_offsets + offset is
 * the same at all times. The arrays belong to the ted4_recon and must not be modified, because the
 * next query recomputes only what has changed. */
typedef struct {
    size_t n;
    float *mean[3], *scale[3], *rot[4], *opacity, *colour[3];
    uint32_t *id;
} ted4_gaussians;

/* A scene prepared for queries: attributes are dequantised, and networks are laid out for
 * evaluation. Only one thread may use it at a time. */
typedef struct ted4_recon ted4_recon;

/* Prepares *r from s. The caller owns *r and frees it with ted4_recon_free; *r keeps no reference
 * to s. Returns TED4_OK, TED4_E_LIMIT_MEMORY, or TED4_E_LIMIT_WORK if each query would take more
 * than max_work steps; on failure, *r is NULL. o may be NULL; its trace is not called. */
ted4_status ted4_recon_new(ted4_recon **r, const ted4_scene *s, const ted4_options *o);
/* Frees a ted4_recon and the arrays of its queries. r may be NULL. */
void ted4_recon_free(ted4_recon *r);

/* Reconstructs the Gaussians of a query in class X (spec 11, 12.2). Returns TED4_OK with *g filled,
 * TED4_E_QUERY (num > den, or den is out of range), or TED4_E_REC_NONFINITE (a number of a record
 * is infinite or NaN). *g stays valid until the next query or ted4_recon_free. p: the caller's
 * threads, or NULL for the calling thread alone. */
ted4_status ted4_recon_query(ted4_recon *r, const ted4_query *q, const ted4_parallel *p,
                             ted4_gaussians *g);

/* Returns 1 if this build, on this machine and with the current floating-point settings of the
 * calling thread, computes as class X demands (spec 12.2); otherwise 0 (because of -ffast-math, x87
 * arithmetic, flush to zero or another rounding mode). Queries still work then, but the last bits
 * of their records may differ. Records are of class X if it returns 1 in every thread that takes
 * part, while the ted4_recon is made and in all of its queries, as it keeps what it has computed:
 * threads of p often have other settings than the calling one. */
int ted4_recon_class_x(void);

/* Computes the hash of the records of a query (spec 15.3), in canonical form. */
void ted4_gaussians_hash(const ted4_gaussians *g, uint8_t hash[16]);

#ifdef __cplusplus
}
#endif

#endif
