/* finding.h - how the parts of the validator say what they find.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_FINDING_H
#define TED4_FINDING_H

#include "base/arena.h"
#include "norm/syntax.h"
#include "read/container.h"

typedef enum {
#define TED4_FINDING_ERROR(status, ...)
#define TED4_FINDING_ADVICE(name, id, severity, rule, text) TED4_ADV_##name,
#include "read/findings.def"
#undef TED4_FINDING_ERROR
#undef TED4_FINDING_ADVICE
    TED4_N_ADVICE
} ted4_advice;

/* A file, and where its findings go. */
typedef struct {
    const uint8_t *data; /* borrowed */
    size_t size;
    ted4_finding_sink *sink;
    void *user;
    ted4_error verdict; /* of the strict decoder: given already */
    int found;          /* collect.c has met the verdict itself */
    size_t chunk;       /* offset of the chunk that an error was last found in; 0: none yet */
    int starved;        /* memory has run out where more was looked for */
} ted4_findings;

/* Gives an error to the sink, with its rule and its chunk. */
void ted4_give_error(ted4_findings *f, ted4_error e);
/* The same, unless it is the verdict, which is noted, or says that memory has run out. */
void ted4_find_error(ted4_findings *f, ted4_error e);
/* n_values of a, b count. where: as in ted4_finding. */
void ted4_find_advice(ted4_findings *f, ted4_advice what, const char *where, size_t offset,
                      unsigned n_values, int64_t a, int64_t b);

/* collect.c: the errors of a file that the strict decoder has found invalid. TED4_OK or
 * TED4_E_LIMIT_MEMORY. */
ted4_status ted4_collect(ted4_findings *f, const ted4_options *o);

/* advise.c: what is doubtful in a valid file, of which s is the scene, as far as there is memory to
 * look. */
void ted4_advise(ted4_findings *f, const ted4_scene *s, const ted4_options *o);
/* Its parts: advise_meta.c, an ancillary chunk; advise_symbols.c, what is coded in tiles. */
void ted4_advise_ancillary(ted4_findings *f, const ted4_chunk_place *p, ted4_arena *a);
void ted4_advise_symbols(ted4_findings *f, const ted4_scene *s, const ted4_options *o);

#endif
