/* export.c - see export.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "export.h"

#include "output.h"

const ted4_format *const ted4_formats[] = { &ted4_format_ply, &ted4_format_splat, &ted4_format_glb,
                                            &ted4_format_raw, NULL };

const ted4_format *ted4_format_find(const char *path)
{
    for (size_t i = 0; ted4_formats[i] != NULL; i++)
        if (ted4_has_suffix(path, ted4_formats[i]->suffix))
            return ted4_formats[i];
    return NULL;
}

int ted4_export(const ted4_format *w, const ted4_frame *x, const char *path)
{
    ted4_output o;

    if (ted4_output_is_stdout(path))
        return w->write(stdout, x) == 0 && fflush(stdout) == 0 && !ferror(stdout) ? 0 : -1;
    if (ted4_output_open(&o, path) != 0)
        return -1;
    if (w->write(o.file, x) != 0) {
        ted4_output_cancel(&o);
        return -1;
    }
    return ted4_output_close(&o);
}
