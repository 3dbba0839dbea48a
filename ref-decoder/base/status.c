/* status.c - spec 14: the table of verdicts, and the functions of status.h that read it.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "base/status.h"

#include <string.h>

static const struct {
    const char *id, *section, *text;
} table[TED4_N_STATUS] = {
    { "ok", "14", "valid" },
#define TED4_STATUS(name, id, section, text) { id, section, text },
#include "status.def"
#undef TED4_STATUS
};

void ted4_fail(ted4_error *e, ted4_status code, size_t offset)
{
    if (e->code == TED4_OK) {
        e->code = code;
        e->offset = offset;
    }
}

const char *ted4_status_id(ted4_status s)
{
    return table[s].id;
}

const char *ted4_status_section(ted4_status s)
{
    return table[s].section;
}

const char *ted4_status_text(ted4_status s)
{
    return table[s].text;
}

ted4_verdict ted4_status_verdict(ted4_status s)
{
    const char *id = table[s].id;

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

    return name[v];
}
