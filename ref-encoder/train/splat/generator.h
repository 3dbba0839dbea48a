/* generator.h - the generator: turns anchors into Gaussians, and backpropagates the gradients (spec
 * 11).
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_GENERATOR_H
#define TED4_GENERATOR_H

#include "base/parallel.h"
#include "train/model/model.h"
#include "train/model/splat_grads.h"

/* Work is split into this many chunks of visible blocks for any number of threads and of processes,
 * so that sums over visible blocks have a fixed order. */
enum { TED4_GEN_CHUNKS = 32 };

/* One query over chosen blocks, usually the visible ones. Lane j of offset k of visible block i is
 * splat (i K + k) 32 + j. */
typedef struct {
    const ted4_layout *layout;
    const float *net; /* [n_net] */
    size_t n_visible;
    const float *const
        *attr; /* [n_visible] blocks; values in the form to be used (quantised, noisy or plain) */
    const float *const *position; /* [n_visible] [3][32] */
    const uint32_t *lanes; /* [n_visible] bit j: lane j holds an anchor to be used; the other lanes
                              give opacity 0 and gradient 0 */
    uint32_t num, den;     /* time, spec 11 */
    float camera[3];       /* normalised space: (c - origin) 2^-e */
    int activation;        /* 0: activation is taken as 1 (static phase), even if tau is present */
    /* 1: several views of this time follow (ted4_generate_view), which share everything but
     * colours. Only if the heads of opacity and covariance do not depend on the view. */
    int by_view;
    /* With by_view, for ted4_generate_backward: the mean over the views of what
     * ted4_generate_view_backward returns, as gr is their mean. */
    const float *view_sum;
} ted4_generate_input;

typedef struct ted4_generator ted4_generator; /* saved activations, packed weights */

ted4_generator *ted4_generator_new(const ted4_layout *l);
void ted4_generator_free(ted4_generator *g);

/* Copies network weights into kernel order. Call after they change and before ted4_generate. */
void ted4_generator_pack(ted4_generator *g, const float *net);
/* Computes the Gaussians in normalised space, valid until the next call. Opacity is 0 for unused
 * lanes, for masked offsets, and if the head's output is <= 0. Also keeps what
 * ted4_generate_backward needs. Returns 0, or -1 if memory ran out. */
int ted4_generate(ted4_generator *g, const ted4_generate_input *in, const ted4_parallel *p,
                  ted4_splats *out);
/* Call after ted4_generate with the same input. gr: gradients of the splats; of
 * the colours only without by_view. d_attr: [n_visible] blocks, overwritten. d_net: gradients of
 * the NETR and BANK parts are added to it. Sums have a fixed order. Returns 0. */
int ted4_generate_backward(ted4_generator *g, const ted4_generate_input *in,
                           const ted4_splat_grads *gr, const ted4_parallel *p, float *const *d_attr,
                           float *d_net);
/* The same in parts, for processes of which each has some chunks. Blocks of chunk c: from
 * ted4_generate_first(n_visible, c) to that of c + 1. */
size_t ted4_generate_first(size_t n_visible, size_t chunk);
/* Fills d_attr of the blocks of chunks from to to - 1; of gr it reads these blocks alone. */
void ted4_generate_backward_chunks(ted4_generator *g, const ted4_generate_input *in,
                                   const ted4_splat_grads *gr, const ted4_parallel *p,
                                   float *const *d_attr, size_t from, size_t to);
/* Returns the gradients of networks by chunk, [TED4_GEN_CHUNKS][*size], borrowed. */
float *ted4_generate_chunk_gradients(ted4_generator *g, size_t *size);
/* Adds to d_net, once the array of chunk 0 has the sum over all chunks, in their order. */
void ted4_generate_backward_end(ted4_generator *g, const ted4_generate_input *in, float *d_net);
/* Returns the gradient [3] of in->camera from the last ted4_generate_backward, or with by_view from
 * the last ted4_generate_view_backward: zero if nothing depends on the viewing direction. */
const float *ted4_generate_camera_gradient(const ted4_generator *g);

/* After ted4_generate with by_view: computes colours for in->camera, and the opacities of in->lanes
 * alone, which are some of the lanes of ted4_generate; all else in *in is as in that call. *out
 * receives both, valid until the next call. */
void ted4_generate_view(ted4_generator *g, const ted4_generate_input *in, const ted4_parallel *p,
                        ted4_splats *out);
/* Returns the floats of the gradients behind colours, for n visible blocks: first those of the
 * features of each block, then those of the colour head. */
size_t ted4_generate_view_size(const ted4_generator *g, size_t n_visible);
/* Returns how many of them belong to one block. */
size_t ted4_generate_view_row(const ted4_generator *g);
/* After ted4_generate_view with the same input: from the gradients of colours to those of features
 * and of the colour head, sum[ted4_generate_view_size], overwritten. */
void ted4_generate_view_backward(ted4_generator *g, const ted4_generate_input *in,
                                 const ted4_splat_grads *gr, const ted4_parallel *p, float *sum);

#endif
