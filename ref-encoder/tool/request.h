/* request.h - the parsed command line of ted4enc.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_REQUEST_H
#define TED4_REQUEST_H

#include <stddef.h>

#include "data/scatter.h"
#include "train/model/options.h"

enum { TED4_REQUEST_HOLD_OUT = 256, TED4_REQUEST_TEXT = 1000 /* bytes */ };

typedef struct {
    /* File and folder names, borrowed from argv. NULL: not given. */
    const char *scene, *out, *checkpoint, *stage1, *log;
    int downscale, max_frames, cache_mib, checkpoint_every, threads, resume, check, json, force,
        quiet, verbose, black, search_report;
    int premultiplied;
    const char *hold_out[TED4_REQUEST_HOLD_OUT]; /* borrowed from argv */
    size_t n_hold_out;
    const char *title, *author, *licence; /* texts for META, borrowed from argv; NULL: none */
    int cameras, thumbnail;               /* 1: write the chunk CAMS or THMB */
    double rate;                          /* --fps; 0: not given */
    const char *transcode;                /* the file to write again, borrowed; NULL: train */
    size_t target_size;                   /* --target-size in bytes; 0: not given */
    ted4_scatter_options bounds;          /* --bounds; the caller sets the seed */
    ted4_train_options options;
} ted4_request;

/* Results of ted4_request_parse. */
enum {
    TED4_REQUEST_GO,   /* *r is filled, and the program should go on */
    TED4_REQUEST_DONE, /* the help or version text was printed, and nothing else is to be done */
    TED4_REQUEST_BAD   /* the command line is wrong, and one line on stderr says why */
};

/* Parses the command line into *r, and sets argv[0] to "ted4enc". Returns a TED4_REQUEST_ value. */
int ted4_request_parse(ted4_request *r, int argc, char **argv);

#endif
