/* request.h - what a command line of ted4enc asks for.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_REQUEST_H
#define TED4_REQUEST_H

#include <stddef.h>

#include "data/scatter.h"
#include "train/model/options.h"

enum { TED4_REQUEST_HOLD_OUT = 256 };

typedef struct {
    const char *scene, *out, *checkpoint, *stage1,
        *log; /* borrowed from argv; NULL: not asked for */
    int downscale, max_frames, cache_mib, checkpoint_every, threads, resume, check, json, force,
        quiet, verbose, black, search_report;
    int premultiplied;
    const char *hold_out[TED4_REQUEST_HOLD_OUT]; /* borrowed from argv */
    size_t n_hold_out;
    size_t target_size;          /* bytes; 0: not asked for */
    ted4_scatter_options bounds; /* its seed is set later */
    ted4_train_options options;
} ted4_request;

enum { TED4_REQUEST_GO, TED4_REQUEST_DONE, TED4_REQUEST_BAD };

/* GO: *r says what to do. DONE: help or version was printed. BAD: one line on stderr said why. */
int ted4_request_parse(ted4_request *r, int argc, char **argv);

#endif
