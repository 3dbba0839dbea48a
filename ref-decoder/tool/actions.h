/* actions.h - what ted4dec does with a decoded scene: it prints hashes, writes Gaussians to files
 * and renders views. The functions return an exit code (cli.h) and print their own error messages.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_ACTIONS_H
#define TED4_ACTIONS_H

#include "session.h"

/* open_scene.c: decodes the input and fills data, info and recon. With --lenient, a damaged input
 * is decoded as far as possible. */
int ted4_action_open(ted4_session *s);

/* Checks that the requested frames are in the file, and that no output file exists unless -f is
 * given. Must be called before anything is written. */
int ted4_action_check(const ted4_session *s);

int ted4_action_hash(ted4_session *s);
int ted4_action_export(ted4_session *s); /* export_times.c */
int ted4_action_render(ted4_session *s); /* render_views.c */

#endif
