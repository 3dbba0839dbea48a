/* state_stream.h - the bytes of a checkpoint or a snapshot, with their hash at the end. One walk
 * (checkpoint.c) serves both directions. Snapshots are often taken and restored, by one thread,
 * while all others wait; therefore they are copied to and from memory directly, without a FILE.
 * Depends on state/snapshot.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_STATE_STREAM_H
#define TED4_STATE_STREAM_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <xxhash.h>

#include "train/state/snapshot.h"

/* whole: includes the monitor's last good state. left: when reading, the bytes that have not been
 * read yet; anchors get memory only if these bytes can fill it. */
typedef struct {
    FILE *file;            /* borrowed; NULL if the stream is in memory */
    ted4_snapshot *memory; /* borrowed */
    size_t at, capacity;   /* in memory: the reading position; the allocated bytes when writing */
    int writing, whole, failed;
    XXH3_state_t *hash;
    uint64_t left;
} ted4_state_stream;

/* Writes or reads size bytes at p, unless the stream has failed. */
void ted4_state_put(ted4_state_stream *s, void *p, size_t size);
/* Writes value, or reads a number, which must then be equal to value. */
void ted4_state_expect(ted4_state_stream *s, uint64_t value);
/* Writes the hash of everything so far, or reads it and compares. */
void ted4_state_hash(ted4_state_stream *s);
/* Returns whether the last eight bytes are the hash of all others. Call before anything that is
 * read is trusted. On success a file is at its start again. Leaves s->hash in use. */
int ted4_state_intact(ted4_state_stream *s);

#endif
