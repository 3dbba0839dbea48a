/* describe.h - payloads of the chunks that describe a scene to players (spec 16.4): cameras, the up
 * direction and a thumbnail, from a dataset, from a list of cameras, or from a PNG file.
 * All functions that return a payload return memory from malloc, which the caller frees, or NULL
 * with why filled.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_DESCRIBE_H
#define TED4_DESCRIBE_H

#include <stddef.h>
#include <stdint.h>

#include "base/parallel.h"
#include "data/dataset.h"
#include "tool/camera_list.h"
#include "tool/cams.h"

/* Longest side of a thumbnail, in pixels: what spec 16.4 permits, and what ted4enc makes. */
enum { TED4_THUMBNAIL_LARGEST = 1024, TED4_THUMBNAIL_MADE = 256 };

/* Finds the direction that is up in training pictures: the mean of the cameras' up directions, or
 * the axis of the scene next to it if the angle is at most 30 degrees. All 0 if cameras disagree.
 */
void ted4_describe_up(const ted4_dataset *d, float up[3]);

/* CAMS with the cameras of all training pictures. A camera that does not move appears once, and
 * belongs to all times if it has taken more than one picture. */
uint8_t *ted4_describe_taken(const ted4_dataset *d, size_t *size, char *why, size_t why_size);
/* CAMS with the cameras of a list. n_frames: of the scene, for cameras that name a frame. */
uint8_t *ted4_describe_listed(const ted4_camera_list *l, uint32_t n_frames, ted4_cams_kind kind,
                              const float up[3], size_t *size, char *why, size_t why_size);

/* THMB from a PNG file, which must be whole and small enough. */
uint8_t *ted4_describe_png(const char *path, size_t *size, char *why, size_t why_size);
/* THMB: the decoded file as the first training camera sees it, in the middle of the scene's time.
 */
uint8_t *ted4_describe_thumbnail(const uint8_t *file, size_t file_size, const ted4_dataset *d,
                                 const ted4_parallel *p, size_t *size, char *why, size_t why_size);

#endif
