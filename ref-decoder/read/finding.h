/* finding.h - the file under validation, and how the parts of the validator report what they find.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_FINDING_H
#define TED4_FINDING_H

#include <stddef.h>
#include "base/status.h"
#include "ted4.h"

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
    ted4_error verdict; /* the strict decoder's; it has been reported already */
    int found;          /* 1: collect.c has found the error of the verdict itself */
    size_t chunk;       /* offset of the chunk in which the last error was found; 0: none yet */
    int starved;        /* 1: memory has run out during the search for more findings */
} ted4_findings;

/* Reports an error. */
void ted4_give_error(ted4_findings *f, ted4_error e);
/* Reports an error unless it is the verdict, which is only noted as found, or says that memory has
 * run out. */
void ted4_find_error(ted4_findings *f, ted4_error e);
/* Reports something doubtful, with the first n_values (0 to 2) of a and b. where is as in
 * ted4_finding. */
void ted4_find_advice(ted4_findings *f, ted4_advice what, const char *where, size_t offset,
                      unsigned n_values, int64_t a, int64_t b);

#endif
