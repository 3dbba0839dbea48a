/* validate.c - spec 3.6: ted4_validate() gives the strict decoder's verdict, then what collect.c
 * finds in an invalid file or advise.c in a valid one.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <string.h>
#include "read/advise.h"
#include "read/collect.h"

ted4_status ted4_validate(const void *data, size_t size, const ted4_options *o,
                          ted4_finding_sink *sink, void *user)
{
    ted4_findings f;
    ted4_options quiet;
    ted4_scene *s;
    ted4_status verdict;

    memset(&quiet, 0, sizeof quiet);
    if (o != NULL)
        quiet = *o;
    quiet.trace = NULL;
    memset(&f, 0, sizeof f);
    f.data = data;
    f.size = size;
    f.sink = sink;
    f.user = user;
    verdict = ted4_decode(data, size, &quiet, &s, &f.verdict);
    if (verdict == TED4_OK)
        ted4_advise(&f, s, &quiet);
    else
        ted4_give_error(&f, f.verdict);
    if (ted4_status_verdict(verdict) == TED4_INVALID && ted4_collect(&f, &quiet) != TED4_OK)
        f.starved = 1;
    if (f.starved)
        ted4_find_advice(&f, TED4_ADV_MEMORY, NULL, 0, 0, 0, 0);
    ted4_scene_free(s);
    return verdict;
}
