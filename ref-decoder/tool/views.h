/* views.h - the cameras that ted4dec --render draws.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_VIEWS_H
#define TED4_VIEWS_H

#include "session.h"

/* Fills s->cameras as --camera, --orbit or --path asks, after the file was decoded; all cameras
 * have a frame or a time of the scene afterwards. Returns an exit code (cli.h), after a message. */
int ted4_views_make(ted4_session *s);

#endif
