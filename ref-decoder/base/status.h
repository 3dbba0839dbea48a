/* status.h - spec 14: all verdicts that a decoder can give, generated from status.def.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_STATUS_H
#define TED4_STATUS_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum {
    TED4_OK,
#define TED4_STATUS(name, id, section, text) TED4_##name,
#include "status.def"
#undef TED4_STATUS
    TED4_N_STATUS
} ted4_status;

typedef enum { TED4_VALID, TED4_INVALID, TED4_LIMIT, TED4_UNSUPPORTED, TED4_IO } ted4_verdict;

/* The first error, which later ones do not replace: its code, and its byte offset in the file. */
typedef struct {
    ted4_status code;
    size_t offset;
} ted4_error;

/* Sets *e unless it already holds an error. A breakpoint here stops at the first invalid byte. */
void ted4_fail(ted4_error *e, ted4_status code, size_t offset);
const char *ted4_status_id(ted4_status s);      /* for example "con.chunk-hash"; "ok" for TED4_OK */
const char *ted4_status_section(ted4_status s); /* of the specification: "5.2" */
const char *ted4_status_text(ted4_status s);
ted4_verdict ted4_status_verdict(ted4_status s); /* from the id's first part */
const char *ted4_verdict_name(
    ted4_verdict v); /* "valid", "invalid", "limit", "unsupported", "io" */

#ifdef __cplusplus
}
#endif

#endif
