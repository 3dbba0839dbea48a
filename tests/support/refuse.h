/* refuse.h - checks that a scene fails to load, or loads with a warning. Depends on tiny_scene.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_REFUSE_H
#define TED4_REFUSE_H

#include <string.h>
#include "test.h"
#include "tiny_scene.h"

/* Asserts that loading fails with a one-line message that contains both texts, and leaves nothing
 * behind. */
static inline void refuse(const tiny_folder *f, const char *where, const char *what)
{
    ted4_dataset d, zero;
    const char *text = tiny_load(&d, f, &tiny_options);

    memset(&zero, 0, sizeof zero);
    if (*text == 0 || strstr(text, where) == NULL || strstr(text, what) == NULL ||
        strchr(text, '\n') != NULL)
        fail_msg("got \"%s\", expected \"%s\" and \"%s\"", text, where, what);
    assert_memory_equal(&d, &zero, sizeof d);
}

/* Asserts that loading succeeds with one warning, a line that contains both texts. Returns the
 * number of pictures. */
static inline size_t warned(const tiny_folder *f, const char *where, const char *what)
{
    ted4_dataset d;
    const char *text = tiny_load(&d, f, &tiny_options);
    const size_t n = d.n_pictures;

    if (*text != 0 || d.n_warnings != 1 || strstr(d.warnings[0], where) == NULL ||
        strstr(d.warnings[0], what) == NULL || strchr(d.warnings[0], '\n') != NULL)
        fail_msg("got \"%s\", %zu warnings \"%s\", expected \"%s\" and \"%s\"", text, d.n_warnings,
                 d.n_warnings > 0 ? d.warnings[0] : "", where, what);
    ted4_dataset_free(&d);
    return n;
}

#endif
