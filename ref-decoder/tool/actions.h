/* actions.h - what ted4dec does with a decoded scene: hashes, files of Gaussians, pictures.
 * Depends on ted4.h, render/view.h, sample.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_ACTIONS_H
#define TED4_ACTIONS_H

#include <jansson.h>

#include "camera_list.h"
#include "export.h"
#include "ted4.h"
#include "times.h"

typedef struct {
    const char *input;
    const char *output, *render, *cameras; /* patterns and file name; NULL: not asked for */
    const ted4_format *format;             /* of output */
    ted4_range range;
    ted4_time time;
    int has_range, has_time;
    float centre[3];
    int sh_degree, threads;
    int64_t max_memory, max_work; /* of decoding and of a query; 0: not given */
    int keep_all, hash, test, lenient, trace, force, json, quiet, verbose;
} ted4_settings;

/* One run. Functions below return an exit code (cli.h) and have said what went wrong. */
typedef struct {
    const ted4_settings *set;
    ted4_parallel parallel;
    ted4_info info;
    ted4_recon *recon;        /* owned */
    ted4_camera_list cameras; /* owned */
    json_t *report;           /* owned: what --json prints */
    int warned;
} ted4_session;

/* open_scene.c: decodes the input, as far as it can be when it is damaged and --lenient is given:
 * info, recon. */
int ted4_action_open(ted4_session *s);

/* Are the frames asked for in the file, and is every output free? To be called before anything is
 * written. */
int ted4_action_check(const ted4_session *s);

int ted4_action_hash(ted4_session *s);
int ted4_action_export(ted4_session *s);
int ted4_action_render(ted4_session *s);

#endif
