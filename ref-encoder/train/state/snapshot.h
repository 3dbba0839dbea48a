/* snapshot.h - the whole state of a trainer as bytes in memory. monitor/checkpoint.h takes and
 * restores snapshots.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_SNAPSHOT_H
#define TED4_SNAPSHOT_H

#include <stdlib.h>

typedef struct {
    char *bytes; /* owned; NULL: empty */
    size_t size;
} ted4_snapshot;

static inline void ted4_snapshot_free(ted4_snapshot *s)
{
    free(s->bytes);
    s->bytes = NULL;
    s->size = 0;
}

#endif
