/* open_decoded.c - see open_decoded.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "open_decoded.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "tool/cli.h"

int open_decoded(const char *program, const char *path, decoded *d)
{
    ted4_error e = { TED4_OK, 0 };
    uint8_t *const bytes = ted4_read_file(path, &d->bytes);

    if (bytes == NULL) {
        fprintf(stderr, "%s: %s: %s\n", program, path, strerror(errno));
        return TED4_EXIT_TOOL;
    }
    if (ted4_decode(bytes, d->bytes, NULL, &d->scene, &e) == TED4_OK)
        e.code = ted4_recon_new(&d->recon, d->scene, NULL);
    free(bytes);
    if (e.code != TED4_OK)
        return ted4_report(program, path, &e, 0);
    ted4_scene_info(d->scene, &d->info);
    return TED4_EXIT_FINE;
}
