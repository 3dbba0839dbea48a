/* describe_trained.c - see describe_trained.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "describe_trained.h"

#include <stdio.h>
#include <stdlib.h>

#include "describe.h"
#include "edit.h"

enum { N_TEXTS = 3 };

typedef struct {
    const ted4_request *r;
    const ted4_dataset *d;
    const ted4_parallel *p;
    ted4_edit edit;
    char *why;
    size_t why_size;
} job;

static int failed(const job *j, const char *text)
{
    snprintf(j->why, j->why_size, "%s", text);
    return -1;
}

static int add_texts(job *j)
{
    static const char *const key[N_TEXTS] = { "title", "author", "licence" };
    const char *const value[N_TEXTS] = { j->r->title, j->r->author, j->r->licence };
    char text[N_TEXTS][TED4_REQUEST_TEXT + 16];
    const char *line[N_TEXTS];
    size_t n = 0;

    for (int i = 0; i < N_TEXTS; i++) {
        if (value[i] == NULL)
            continue;
        snprintf(text[n], sizeof text[n], "%s=%s", key[i], value[i]);
        line[n] = text[n];
        n++;
    }
    return n == 0 || ted4_edit_lines(&j->edit, line, n) == 0 ? 0 : failed(j, "out of memory");
}

static int add_chunk(job *j, const char *type, uint8_t *payload, size_t size)
{
    if (payload == NULL)
        return -1;
    return ted4_edit_add(&j->edit, type, 0, payload, size) == 0 ? 0 : failed(j, "too many chunks");
}

static int add_chunks(job *j)
{
    size_t size = 0;

    if (add_texts(j) != 0)
        return -1;
    if (j->r->cameras) {
        uint8_t *cams = ted4_describe_taken(j->d, &size, j->why, j->why_size);

        if (add_chunk(j, "CAMS", cams, size) != 0)
            return -1;
    }
    if (!j->r->thumbnail)
        return 0;

    uint8_t *png =
        ted4_describe_thumbnail(j->edit.file, j->edit.size, j->d, j->p, &size, j->why, j->why_size);

    return add_chunk(j, "THMB", png, size);
}

int ted4_describe_possible(const ted4_request *r, const ted4_dataset *d, char *why, size_t why_size)
{
    char text[200];
    size_t size;

    if (!r->cameras)
        return 0;

    uint8_t *cams = ted4_describe_taken(d, &size, text, sizeof text);

    if (cams == NULL)
        snprintf(why, why_size, "--cameras: %s", text);
    free(cams);
    return cams != NULL ? 0 : -1;
}

int ted4_describe_trained(const ted4_request *r, const ted4_dataset *d, const ted4_parallel *p,
                          uint8_t **bytes, size_t *size, char *why, size_t why_size)
{
    job j = { .r = r, .d = d, .p = p, .why = why, .why_size = why_size };
    const char *text;
    uint8_t *out;
    size_t n;
    int bad;

    if (r->title == NULL && r->author == NULL && r->licence == NULL && !r->cameras && !r->thumbnail)
        return 0;
    if (ted4_edit_begin(&j.edit, *bytes, *size) != 0)
        return failed(&j, "out of memory");
    bad = add_chunks(&j) != 0;
    if (!bad && (bad = ted4_edit_write(&j.edit, &out, &n, &text) != 0))
        failed(&j, text);
    ted4_edit_finish(&j.edit);
    if (bad)
        return -1;
    free(*bytes);
    *bytes = out;
    *size = n;
    return 0;
}
