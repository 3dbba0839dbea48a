/* syntax.h - spec 6 to 10: the contents of a parsed file, with one member per syntax element.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_SYNTAX_H
#define TED4_SYNTAX_H

#include <stddef.h>
#include <stdint.h>
#include "ted4.h"
#include "base/arena.h"

enum {
    TED4_MAX_OFFSETS = 16,
    TED4_MAX_FEATURE = 128,
    TED4_MAX_SLICES = 16,
    TED4_MAX_PHI = 32,
    TED4_MAX_LAYERS = 10,
    TED4_MAX_WIDTH = 512,
    TED4_MAX_NETS = 24
};

/* spec 5.1: values of profile. */
enum { TED4_PROFILE_MAIN, TED4_PROFILE_COMPACT };

/* spec 6.2: the attribute types in stream order. */
typedef enum { TED4_FEATURE, TED4_SCALING, TED4_OFFSET, TED4_PHI, TED4_TAU, TED4_TYPES } ted4_type;

/* spec 6.1: values of scale_domain and prior. The values of motion and view are in ted4.h. */
enum { TED4_SCALE_LOG2, TED4_SCALE_LINEAR };
enum { TED4_PRIOR_INR, TED4_PRIOR_FACTORISED };

/* spec 6.1: the header, in file order and with the names of the specification. */
typedef struct {
    uint32_t n_anchors, tile_size;
    uint8_t n_offsets, feature_dim;
    uint8_t motion, phi_dim;
    uint32_t bank_rows;
    uint16_t bank_dim;
    uint8_t deform_layers;
    uint16_t deform_width;
    uint8_t temporal_mask, offset_mask, activation;
    uint8_t view, head_layers;
    uint16_t head_width;
    uint8_t scale_domain, prior, pe_octaves, hyper_layers;
    uint16_t hyper_width;
    uint8_t n_slices, slice[TED4_MAX_SLICES];
    uint16_t ar_width;
    uint8_t context_bits;
    float step[TED4_TYPES]; /* Q0 of each type */
    uint32_t frames, rate_num, rate_den;
    float origin[3];
    int8_t exponent;
    uint8_t background[3];
} ted4_header;

/* The shape of a network, derived from the header (spec 7). Layer i has dim[i] inputs and dim[i +
 * 1] outputs. */
typedef struct {
    uint8_t n_layers; /* 0: the network does not exist */
    uint16_t dim[TED4_MAX_LAYERS + 1];
    size_t first;      /* index of its first f32 in its blob */
    size_t first_unit; /* index of its first shift (NETE) */
} ted4_net_shape;

/* Returns the number of weights of a layer, which its biases follow in the blob (spec 7.1). */
static inline size_t ted4_layer_weights(const ted4_net_shape *n, unsigned layer)
{
    return (size_t)n->dim[layer] * n->dim[layer + 1];
}

/* Returns the number of weights and biases of a layer. */
static inline size_t ted4_layer_size(const ted4_net_shape *n, unsigned layer)
{
    return ted4_layer_weights(n, layer) + n->dim[layer + 1];
}

enum {
    TED4_NET_PROJECT,
    TED4_NET_DEFORM,
    TED4_NET_OPACITY,
    TED4_NET_COVARIANCE,
    TED4_NET_COLOUR,
    TED4_NETS_R
};

typedef struct {
    unsigned dim[TED4_TYPES];          /* components per anchor; 0: type absent */
    unsigned n_types;                  /* number of present types */
    unsigned n_outputs;                /* P of spec 7.3 */
    unsigned first_output[TED4_TYPES]; /* index of the first mu; the first s is at + dim */
    unsigned first_step_output;        /* index of v of the first present type */
    unsigned n_tiles, n_substreams;
    ted4_net_shape hyper, slice[TED4_MAX_SLICES]; /* slice[0] never exists */
    size_t n_nete, n_units;                       /* numbers of f32 values and of shifts in NETE */
    ted4_net_shape netr[TED4_NETS_R];
    size_t n_netr, n_units_r; /* numbers of f32 values and, in mode 2, of exponents in NETR */
    uint64_t n_bank;          /* number of values of BANK, up to 2^41 */
} ted4_shape;

/* shape.c: fills *s from a header whose values are in range. It never fails. */
void ted4_shape_make(ted4_shape *s, const ted4_header *h);

enum { TED4_BLOB_RAW, TED4_BLOB_DEFLATED, TED4_BLOB_CODED, TED4_BLOB_AUTO = 255 };

/* A blob (spec 7.2). values: n binary32 numbers, owned by the scene; NULL if not allocated, in
 * which case n is only the number that the header implies. deflated: the zlib bytes of mode
 * TED4_BLOB_DEFLATED. exponent: of mode TED4_BLOB_CODED in NETR and BANK, one per unit, each 128
 * more than the exponent of the power of two that the values of the unit are multiples of; owned as
 * values are. TED4_BLOB_AUTO: no mode is given, and the writer chooses the smallest form. */
typedef struct {
    float *values;
    uint64_t n;
    uint8_t mode;
    uint8_t *deflated;
    size_t deflated_size;
    uint8_t *exponent;
} ted4_blob;

enum { TED4_PROBS = 7 }; /* per tile: dynamic_prob, offset_prob[6] */

/* The decoded integers of a file (Tier E). The arena of the scene owns the arrays (scene.h). N is
 * the number of anchors. */
struct ted4_scene {
    ted4_arena arena;
    uint8_t level;   /* spec 13.1; 0: not from a file */
    uint8_t profile; /* spec 5.1; the writer's choice where the scene is not from a file */
    uint8_t grid;    /* spec 8.2, profile Compact; 0: the writer chooses it */
    ted4_header head;
    ted4_shape shape;
    uint8_t *shift; /* [n_units] spec 7.3 */
    ted4_blob nete, netr, bank;
    uint16_t *position;              /* [N][3] binary16 patterns */
    uint8_t *dynamic;                /* [N] 0 or 1 */
    uint16_t *offset_bits;           /* [N] bit k: offset k is kept */
    uint8_t *step_index[TED4_TYPES]; /* each [N]; NULL: type absent */
    int16_t *symbol[TED4_TYPES];     /* [dim][N]; 0 where not coded */
    uint16_t *prob;   /* [n_tiles][TED4_PROBS]; 0: not given, the writer counts symbols to set it */
    uint8_t hash[16]; /* ENDS, spec 15.2 */
};

#endif
