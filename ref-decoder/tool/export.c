/* export.c - see export.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "export.h"

#include <string.h>

#include "output.h"

const ted4_writer *const ted4_writers[] = {
    &ted4_writer_ply, &ted4_writer_splat, &ted4_writer_glb, &ted4_writer_raw, NULL
};

const ted4_writer *ted4_writer_find(const char *path)
{
    const size_t n = strlen(path);

    for (size_t i = 0; ted4_writers[i] != NULL; i++) {
        const size_t m = strlen(ted4_writers[i]->suffix);

        if (n > m && strcmp(path + n - m, ted4_writers[i]->suffix) == 0)
            return ted4_writers[i];
    }
    return NULL;
}

int ted4_export(const ted4_writer *w, const ted4_frame *x, const char *path)
{
    ted4_output o;

    if (ted4_output_open(&o, path) != 0)
        return -1;
    if (w->write(o.file, x) != 0) {
        ted4_output_cancel(&o);
        return -1;
    }
    return ted4_output_close(&o);
}
