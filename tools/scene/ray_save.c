/* ray_save.c - see ray_save.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "ray_save.h"

#include <errno.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include "tool/output.h"

static pthread_mutex_t one_at_a_time = PTHREAD_MUTEX_INITIALIZER;

static int complain(ted4_ray_message *m, const char *path, const char *why)
{
    snprintf(m->text, sizeof m->text, "%s: %s", path, why);
    return -1;
}

static int save(const char *path, const void *bytes, size_t n, ted4_ray_message *m)
{
    ted4_output o;

    if (ted4_output_open(&o, path) != 0)
        return complain(m, path, strerror(errno));
    if (fwrite(bytes, 1, n, o.file) == n)
        return ted4_output_close(&o) == 0 ? 0 : complain(m, path, strerror(errno));
    ted4_output_cancel(&o);
    return complain(m, path, strerror(errno));
}

int ted4_ray_save(const char *path, const void *bytes, size_t n, ted4_ray_message *m)
{
    pthread_mutex_lock(&one_at_a_time);
    const int status = save(path, bytes, n, m);
    pthread_mutex_unlock(&one_at_a_time);
    return status;
}

void ted4_ray_collect(ted4_ray_collected *c)
{
    c->bytes = NULL;
    c->n = 0;
    c->file = open_memstream(&c->bytes, &c->n);
}

int ted4_ray_collect_end(ted4_ray_collected *c, int bad, const char *path, ted4_ray_message *m)
{
    bad |= c->file == NULL || ferror(c->file);
    bad |= c->file != NULL && fclose(c->file) != 0;
    const int status = bad ? complain(m, path, "cannot be made (out of memory?)")
                           : ted4_ray_save(path, c->bytes, c->n, m);
    free(c->bytes);
    return status;
}
