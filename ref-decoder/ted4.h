/* ted4.h - the public interface of libted4dec: from the bytes of a TED4 file to Gaussians at any
 * time. "spec" is the TED4 Bitstream Specification. The library prints nothing, starts no thread
 * and keeps no global state. It depends on base/parallel.h and base/status.h only.
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

/* Where memory comes from. NULL members stand for malloc and free. alloc(user, size) returns size
 * bytes that are aligned for any type, or NULL if there is no memory; free(user, block) takes them
 * back. */
typedef struct {
    void *(*alloc)(void *user, size_t size);
    void (*free)(void *user, void *block);
    void *user;
} ted4_allocator;

/* Settings of a call. All members zero is a good default. */
typedef struct {
    ted4_allocator allocator;
    /* Threads of the caller, borrowed during the call. NULL: the calling thread does everything. */
    const ted4_parallel *parallel;
    /* Largest amount of memory, in bytes, that the scene may take. 0: 4 GiB. Beyond it the verdict
     * is limit.memory. */
    uint64_t max_bytes;
    /* Largest number of steps (spec 13.4) that a file, or a query, may ask for. 0: any number.
     * Beyond it the verdict is limit.work. */
    uint64_t max_work;
    /* Called for every syntax element, in the order of the file and on the calling thread, with the
     * element's byte offset, its name, its index in an array (otherwise 0) and its value.
     * NULL: off. */
    void (*trace)(void *user, size_t offset, const char *element, int64_t index, int64_t value);
    void *trace_user; /* the first argument of trace */
} ted4_options;

/* The decoded integers of a file (Tier E, spec 5 to 10). */
typedef struct ted4_scene ted4_scene;

/* Decodes the size bytes of a whole file strictly (spec 3, 5 to 10, 14). Returns TED4_OK and sets
 * *scene, which the caller owns and frees with ted4_scene_free. Otherwise *scene is NULL, and *e
 * holds the error and its byte offset. data is not kept and may be NULL if size is 0; o may be
 * NULL. */
ted4_status ted4_decode(const void *data, size_t size, const ted4_options *o, ted4_scene **scene,
                        ted4_error *e);
/* Frees a scene; s may be NULL. */
void ted4_scene_free(ted4_scene *s);

/* What a lenient decoder has saved from a file. */
typedef struct {
    ted4_error verdict; /* that of the strict decoder */
    /* The first error in the order of the file, at which decoding ended, or the limit that was
     * met. */
    ted4_error stop;
    uint32_t n_tiles; /* number of tiles in the scene: the first ones, all of them whole */
    /* Numbers that HEAD declares; 0 if HEAD is not valid. */
    uint32_t tiles_declared, anchors_declared;
} ted4_salvage;

/* Decodes leniently (spec 3.3). Returns the verdict of ted4_decode.
 * If that is TED4_OK, *scene is the scene of ted4_decode, and what->stop is TED4_OK.
 * If the file is invalid, *scene holds the anchors of its first what->n_tiles tiles, with a hash of
 * its own, or is NULL if there is no such tile.
 * Otherwise *scene is NULL. The caller owns *scene. The trace of o sees what the strict decoder
 * reads. */
ted4_status ted4_decode_lenient(const void *data, size_t size, const ted4_options *o,
                                ted4_scene **scene, ted4_salvage *what);

/* A finding of the validator (spec 3.6, read/findings.def). Its strings are constants of the
 * library. */
typedef enum { TED4_ERROR, TED4_WARNING, TED4_HINT } ted4_severity;
typedef struct {
    ted4_severity severity;
    /* id: "con.magic" of status.def, or for example "adv.level"; rule: "R-CON-001". */
    const char *id, *rule, *text;
    const char *where; /* the kind of chunk or symbol: "TILE", "phi"; NULL if there is none */
    size_t offset;     /* in bytes, in the file */
    unsigned n_values; /* how many numbers text names: 0, 1 or 2 */
    int64_t value[2];
} ted4_finding;
typedef void ted4_finding_sink(void *user, const ted4_finding *f);

/* Validates a file, for authors of encoders. Returns the verdict of ted4_decode and calls
 * sink(user, finding) for every finding. If the file is not valid, these are the error of the
 * strict decoder and then all others as far as parsing can go on; if it is valid, they are advice.
 * There is an error among them exactly when the verdict is not TED4_OK. If there is too little
 * memory to look further, the verdict stays as it is, and there is a hint adv.memory. o may be
 * NULL; its trace is not called. */
ted4_status ted4_validate(const void *data, size_t size, const ted4_options *o,
                          ted4_finding_sink *sink, void *user);

/* How anchors move (spec 6.1, 11.3), and which heads see the view direction (spec 6.1). */
enum { TED4_MOTION_NONE, TED4_MOTION_BANK, TED4_MOTION_CONCAT, TED4_MOTION_INR };
enum { TED4_VIEW_NONE, TED4_VIEW_COLOUR, TED4_VIEW_FULL };

/* What the header of a scene says. A member that bears the name of a syntax element has its meaning
 * (spec 6.1). */
typedef struct {
    /* Number of anchors, and the largest number of Gaussians per anchor. */
    uint32_t n_anchors, n_offsets;
    /* Frame j has time j / (frames - 1), or 0 if there is one frame; there are
     * rate_num / rate_den frames per second. */
    uint32_t frames, rate_num, rate_den;
    size_t n_gaussians;    /* number of kept offsets, and of the records of a query */
    uint32_t n_dynamic;    /* number of anchors that move */
    int level;             /* spec 13.1: 1 to 4, or 31, which has no bounds */
    int view, motion;      /* TED4_VIEW_..., TED4_MOTION_... */
    int activation;        /* 1: anchors appear and disappear (spec 11.4); 0: they always exist */
    float origin[3];       /* in world units: where the normalised position is 0 */
    int exponent;          /* 2^exponent world units are 1 in normalised space; anchors: [-1, 1] */
    uint8_t background[3]; /* display-referred sRGB: red, green, blue */
    uint8_t hash[16];      /* of the decoded integers (spec 15.2) */
} ted4_info;

/* Fills *info. It never fails. */
void ted4_scene_info(const ted4_scene *s, ted4_info *info);

/* Receives the byte string of a tier (annex J) in order, in many small pieces of size bytes. */
typedef void ted4_sink(void *user, const void *bytes, size_t size);

/* Gives tier T0 of a file to the sink, and decodes the file for this. Returns the verdict of
 * ted4_decode; unless it is TED4_OK, *e holds the error, and what the sink was given is void. o may
 * be NULL; its trace is not called. */
ted4_status ted4_dump_syntax(const void *data, size_t size, const ted4_options *o, ted4_sink *sink,
                             void *user, ted4_error *e);
/* Gives tier T1 to T4 (tier = 1 .. 4) of a decoded scene to the sink. Returns TED4_OK or
 * TED4_E_LIMIT_MEMORY. max_work of o is not used; o may be NULL. */
ted4_status ted4_dump_tier(const ted4_scene *s, int tier, const ted4_options *o, ted4_sink *sink,
                           void *user);

/* A query (spec 11): the time num / den in [0, 1], and the camera centre in world coordinates. */
typedef struct {
    uint32_t num, den;
    float camera[3];
} ted4_query;

/* The records of a query as a structure of arrays, each [n]. id = anchor * n_offsets + offset is
 * the same at all times. The arrays belong to the ted4_recon and must not be written to, because
 * the next query computes again only what has changed. */
typedef struct {
    size_t n;
    float *mean[3], *scale[3], *rot[4], *opacity, *colour[3];
    uint32_t *id;
} ted4_gaussians;

/* A scene prepared for queries: its attributes are dequantised, its networks laid out. */
typedef struct ted4_recon ted4_recon;

/* Prepares *r, which the caller owns, from s, to which it keeps no reference. Returns TED4_OK,
 * TED4_E_LIMIT_MEMORY, or TED4_E_LIMIT_WORK if each query would take more than max_work steps. Of o
 * it uses allocator, parallel, max_bytes and max_work; o may be NULL. */
ted4_status ted4_recon_new(ted4_recon **r, const ted4_scene *s, const ted4_options *o);
void ted4_recon_free(ted4_recon *r);

/* Reconstructs the Gaussians of a query in class X (spec 11, 12.2). *g stays valid until the next
 * query or ted4_recon_free. p may be NULL. Returns TED4_OK, TED4_E_QUERY (num > den, or den is out
 * of range) or TED4_E_REC_NONFINITE. */
ted4_status ted4_recon_query(ted4_recon *r, const ted4_query *q, const ted4_parallel *p,
                             ted4_gaussians *g);

/* Returns 1 if this build, on this machine and in its present floating-point state, can claim class
 * X (spec 12.2). Returns 0 if it cannot (-ffast-math, x87, flush to zero, another rounding mode):
 * queries still work then, but their last bits may differ. */
int ted4_recon_class_x(void);

/* Computes the hash of the records of a query (spec 15.3), in canonical form. */
void ted4_gaussians_hash(const ted4_gaussians *g, uint8_t hash[16]);

#ifdef __cplusplus
}
#endif

#endif
