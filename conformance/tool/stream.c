/* stream.c - see stream.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "stream.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <xxhash.h>
#include "base/bytes.h"
#include "norm/coder.h"

static int is_symbol(const char *name)
{
    static const char *const symbol[] = { "dynamic", "offset_bit", "feature", "scaling",
                                          "offset",  "phi",        "tau" };

    for (size_t i = 0; i < sizeof symbol / sizeof *symbol; i++)
        if (strcmp(symbol[i], name) == 0)
            return 1;
    return 0;
}

static int chunk_at(const conf_stream *s, size_t offset, size_t *at)
{
    size_t place = TED4_FILE_HEADER_SIZE;

    for (int i = 0; i < s->n; i++) {
        const size_t begin = place + TED4_FRAME_HEAD_SIZE, end = begin + s->chunk[i].payload.size;

        if (offset >= begin && offset < end + TED4_FRAME_HASH_SIZE) {
            *at = offset - begin;
            return i;
        }
        place = end + TED4_FRAME_HASH_SIZE;
    }
    return -1;
}

static void note(void *user, size_t offset, const char *name, int64_t index, int64_t value)
{
    conf_stream *s = user;
    conf_element *e;
    size_t at = offset;
    const int chunk = chunk_at(s, offset, &at);

    (void)value;
    if (is_symbol(name) || strncmp(name, "chunk_", 6) == 0)
        return;
    if (s->n_elements % 1024 == 0) {
        s->element = realloc(s->element, (s->n_elements + 1024) * sizeof *s->element);
        if (s->element == NULL)
            conf_die("no memory");
    }
    e = &s->element[s->n_elements++];
    snprintf(e->name, sizeof e->name, "%s", name);
    e->index = index;
    e->chunk = chunk;
    e->at = at;
}

void conf_stream_open(conf_stream *s, const conf_bytes *file, const conf_build *b)
{
    const ted4_options o = { .trace = note, .trace_user = s };
    ted4_scene *scene;
    ted4_error e;

    memset(s, 0, sizeof *s);
    s->build = b;
    s->cut = -1;
    memcpy(s->header, file->data, sizeof s->header);
    for (size_t at = sizeof s->header; at < file->size; s->n++) {
        conf_chunk *c = &s->chunk[s->n];

        if (s->n == CONF_CHUNKS)
            conf_die("more than %d chunks", CONF_CHUNKS);
        memcpy(c->type, file->data + at, 4);
        c->flags = ted4_load32(file->data + at + 4);
        c->size = -1;
        conf_add(&c->payload, file->data + at + 12, ted4_load32(file->data + at + 8));
        s->moved[s->n] = s->n;
        at += c->payload.size + TED4_FRAME_HEAD_SIZE + TED4_FRAME_HASH_SIZE;
    }
    if (ted4_decode(file->data, file->size, &o, &scene, &e) != TED4_OK)
        conf_die("the file to be broken is broken: %s at %zu", ted4_status_id(e.code), e.offset);
    ted4_scene_free(scene);
}

void conf_stream_close(conf_stream *s)
{
    for (int i = 0; i < s->n; i++)
        conf_free(&s->chunk[i].payload);
    conf_free(&s->tail);
    free(s->element);
}

void conf_stream_join(const conf_stream *s, conf_bytes *file)
{
    memset(file, 0, sizeof *file);
    conf_add(file, s->header, sizeof s->header);
    for (int i = 0; i < s->n; i++) {
        const conf_chunk *c = &s->chunk[i];
        const size_t at = file->size;
        uint8_t frame[8];

        conf_add(file, c->type, 4);
        ted4_store32(frame, c->flags);
        ted4_store32(frame + 4, c->size < 0 ? (uint32_t)c->payload.size : (uint32_t)c->size);
        conf_add(file, frame, 8);
        conf_add(file, c->payload.data, c->payload.size);
        ted4_store64(frame, XXH3_64bits(file->data + at, file->size - at) ^
                                (c->bad_hash ? (uint64_t)1 << 37 : 0));
        conf_add(file, frame, 8);
    }
    conf_add(file, s->tail.data, s->tail.size);
    if (s->cut >= 0 && (size_t)s->cut < file->size)
        conf_remove(file, (size_t)s->cut, file->size - (size_t)s->cut);
}

int conf_stream_chunk(const conf_stream *s, const conf_line *l, const char *ref)
{
    int left = strlen(ref) > 4 ? atoi(ref + 4) : 0;

    for (int i = 0; i < s->n; i++)
        if (memcmp(s->chunk[i].type, ref, strlen(ref) < 4 ? strlen(ref) : 4) == 0 && left-- == 0)
            return i;
    conf_line_bad(l, "no such chunk");
}

const conf_element *conf_stream_element(const conf_stream *s, const conf_line *l, const char *ref)
{
    const char *const dot = strchr(ref, '.'), *const name = dot != NULL ? dot + 1 : ref,
                      *const bracket = strchr(name, '[');
    const size_t length = bracket != NULL ? (size_t)(bracket - name) : strlen(name);
    const int64_t index = bracket != NULL ? strtoll(bracket + 1, NULL, 10) : 0;
    char chunk[16];
    int want = -2;

    if (dot != NULL) {
        snprintf(chunk, sizeof chunk, "%.*s", (int)(dot - ref), ref);
        want = conf_stream_chunk(s, l, chunk);
    }
    for (size_t i = 0; i < s->n_elements; i++) {
        const conf_element *e = &s->element[i];

        if (strlen(e->name) == length && memcmp(e->name, name, length) == 0 &&
            (e->index == index || e->index == -1) && (want == -2 || e->chunk == want))
            return e;
    }
    fprintf(stderr, "ted4conf: \"%s\"\n", ref);
    conf_line_bad(l, "no such element in the file");
}

size_t conf_stream_place(const conf_stream *s, int i)
{
    size_t at = TED4_FILE_HEADER_SIZE;

    for (int j = 0; j < i; j++)
        at += s->chunk[j].payload.size + TED4_FRAME_HEAD_SIZE + TED4_FRAME_HASH_SIZE;
    return at;
}

size_t conf_stream_substream(const conf_stream *s, int chunk, unsigned sub, size_t *size,
                             size_t *size_at)
{
    const conf_bytes *p = &s->chunk[chunk].payload;
    int original = 0;
    size_t first = 0, at, n = 0;

    while (original < CONF_CHUNKS && s->moved[original] != chunk)
        original++;
    for (size_t i = 0; i < s->n_elements; i++)
        if (s->element[i].chunk == original && strcmp(s->element[i].name, "size") == 0) {
            first = n == 0 ? s->element[i].at : first;
            n++;
        }
    if (sub >= n)
        conf_die("substream %u of %zu", sub, n);
    at = first + 4 * n;
    for (unsigned i = 0; i < sub; i++)
        at += ted4_load32(p->data + first + 4 * i);
    *size_at = first + 4 * sub;
    *size = ted4_load32(p->data + *size_at);
    return at;
}
