/* file_cameras.h - what a file says of cameras and of the up direction (spec 16.4).
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_FILE_CAMERAS_H
#define TED4_FILE_CAMERAS_H

#include <stddef.h>
#include <stdint.h>

#include "camera_list.h"
#include "cams.h"

/* Sets up to the up direction that a file's chunks CAMS name last, in scene coordinates; all 0 if
 * none does. file: [size], accepted by a decoder, or recovered in part: of damaged chunks, nothing
 * is taken. */
void ted4_file_up(const uint8_t *file, size_t size, float up[3]);

/* Reads the cameras of a kind into *l, from the last chunk that has them. Those of a path get the
 * width of their pixels (annex I.4) if the file has the cameras that took its pictures. Returns 0,
 * or -1 if out of memory; l->n is 0 if the file has none of the kind. l needs
 * ted4_camera_list_free() in either case. */
int ted4_file_cameras(const uint8_t *file, size_t size, ted4_cams_kind kind, ted4_camera_list *l);

#endif
