/* actions.h - what ted4dec does with a decoded scene: it prints hashes, writes Gaussians to files
 * and renders views.
 * Depends on ted4.h, render/view.h, sample.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_ACTIONS_H
#define TED4_ACTIONS_H

#include <jansson.h>

#include "camera_list.h"
#include "settings.h"
#include "ted4.h"

/* One run of the program. The functions below return an exit code (cli.h) and print their own error
 * messages. */
typedef struct {
    const ted4_settings *set;
    ted4_parallel parallel;
    ted4_info info;
    ted4_recon *recon;        /* owned */
    ted4_camera_list cameras; /* owned */
    float up[3];              /* as the file says; all 0: unknown */
    json_t *report;           /* owned: what --json prints */
    int warned;
} ted4_session;

/* open_scene.c: decodes the input and fills info and recon. With --lenient, a damaged input is
 * decoded as far as possible. */
int ted4_action_open(ted4_session *s);

/* Checks that the requested frames are in the file, and that no output file exists unless -f is
 * given. Must be called before anything is written. */
int ted4_action_check(const ted4_session *s);

int ted4_action_hash(ted4_session *s);
int ted4_action_export(ted4_session *s);
int ted4_action_render(ted4_session *s);

#endif
