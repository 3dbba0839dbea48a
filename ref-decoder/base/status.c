/* status.c - spec 14: the table of verdicts, and the functions of status.h that read it.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "base/status.h"

#include <string.h>

static const struct {
    const char *id, *section, *text;
} table[TED4_N_STATUS + 1] = {
    { "ok", "14", "valid" },
#define TED4_STATUS(name, id, section, text) { id, section, text },
#include "status.def"
#undef TED4_STATUS
    { "unknown", "14", "not a status of this version" },
};

void ted4_fail(ted4_error *e, ted4_status code, size_t offset)
{
    if (e->code == TED4_OK) {
        e->code = code;
        e->offset = offset;
    }
}

/* Numbers of later versions, or of no status, are described as such. */
static unsigned known(ted4_status s)
{
    return (unsigned)s < TED4_N_STATUS ? (unsigned)s : TED4_N_STATUS;
}

const char *ted4_status_id(ted4_status s)
{
    return table[known(s)].id;
}

const char *ted4_status_section(ted4_status s)
{
    return table[known(s)].section;
}

const char *ted4_status_text(ted4_status s)
{
    return table[known(s)].text;
}

ted4_verdict ted4_status_verdict(ted4_status s)
{
    const char *id = table[known(s)].id;

    if (s == TED4_OK)
        return TED4_VALID;
    if (strncmp(id, "limit.", 6) == 0)
        return TED4_LIMIT;
    if (strncmp(id, "unsupported.", 12) == 0)
        return TED4_UNSUPPORTED;
    if (strncmp(id, "io.", 3) == 0)
        return TED4_IO;
    return TED4_INVALID;
}

const char *ted4_verdict_name(ted4_verdict v)
{
    static const char *const name[] = { "valid", "invalid", "limit", "unsupported", "io" };

    return (unsigned)v < sizeof name / sizeof *name ? name[v] : "unknown";
}
