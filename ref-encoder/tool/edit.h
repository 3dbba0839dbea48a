/* edit.h - changes the ancillary chunks of a finished file (spec 3.5, 5.2, 16.4), and never the
 * scene: critical chunks are copied byte for byte, and unknown chunks stay.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_EDIT_H
#define TED4_EDIT_H

#include <stddef.h>
#include <stdint.h>

#include "base/status.h"
#include "tool/chunks.h"

typedef struct {
    ted4_chunk_view view;
    int dropped; /* 1: not in the new file */
} ted4_edit_chunk;

typedef struct {
    char type[5];
    uint32_t flags;
    uint8_t *payload; /* owned */
    size_t size;
} ted4_edit_addition;

typedef struct {
    const uint8_t *file; /* borrowed */
    size_t size;
    ted4_edit_chunk *chunk; /* owned: [n], all chunks of the file */
    size_t n;
    ted4_edit_addition *added; /* owned: [n_added], room for `room` */
    size_t n_added, room;
} ted4_edit;

/* Begins to edit a file that a decoder accepted. Returns 0, or -1 if out of memory. */
int ted4_edit_begin(ted4_edit *e, const uint8_t *file, size_t size);
void ted4_edit_finish(ted4_edit *e);

/* Drops ancillary chunks of a type; NULL: all of them. Returns how many. */
size_t ted4_edit_drop(ted4_edit *e, const char *type);
/* Is the type that of a critical chunk: of this specification, or of one in the file? */
int ted4_edit_is_critical(const ted4_edit *e, const char *type);
/* Adds an ancillary chunk before ENDS. payload is malloced, and owned by e from now on, also on
 * failure. Returns 0, or -1 if out of memory, or if size does not fit a chunk (5.2). */
int ted4_edit_add(ted4_edit *e, const char *type, uint32_t flags, uint8_t *payload, size_t size);

/* Is text what a line of META may hold (spec 5.2): UTF-8 without control characters? */
int ted4_edit_is_text(const char *text);
/* Is text a date or a time of RFC 3339, as in 2026-11-24 or 2026-11-24T12:00:00Z (R-EXT-007)? */
int ted4_edit_is_date(const char *text);

/* Sets lines of META: line[n] are "key=value" without a line feed. A line of the file with the same
 * key goes, and with an empty value the new line is not written either. All lines end up in one
 * chunk. Returns 0, or -1 if out of memory. */
int ted4_edit_lines(ted4_edit *e, const char *const *line, size_t n);

/* Writes the edited file into *out (free() it), and decodes both files to see that the scene is the
 * same. If the new file is too large for its level, the level is raised. Returns 0, or -1 with *why
 * saying what failed. */
int ted4_edit_write(const ted4_edit *e, uint8_t **out, size_t *size, const char **why);

#endif
