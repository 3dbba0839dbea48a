/* edit.c - see edit.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "edit.h"

#include <stdlib.h>
#include <string.h>
#include <xxhash.h>

#include "base/bytes.h"
#include "norm/syntax.h"
#include "ted4.h"
#include "tool/json_string.h"
#include "write/buffer.h"

enum { MINOR_AT = 9, PROFILE_AT = 10, LEVEL_AT = 11, COMPACT_MINOR = 2 };
enum { META_FLAGS = TED4_CHUNK_IS_SAFE };

int ted4_edit_begin(ted4_edit *e, const uint8_t *file, size_t size)
{
    ted4_chunk_view c;

    memset(e, 0, sizeof *e);
    e->file = file;
    e->size = size;
    for (size_t at = TED4_FILE_HEADER; ted4_chunks_next(file, size, &at, &c);)
        e->n++;
    e->chunk = calloc(e->n > 0 ? e->n : 1, sizeof *e->chunk);
    if (e->chunk == NULL)
        return -1;
    for (size_t i = 0, at = TED4_FILE_HEADER; i < e->n; i++)
        (void)ted4_chunks_next(file, size, &at, &e->chunk[i].view);
    return 0;
}

void ted4_edit_finish(ted4_edit *e)
{
    for (size_t i = 0; i < e->n_added; i++)
        free(e->added[i].payload);
    free(e->added);
    free(e->chunk);
    memset(e, 0, sizeof *e);
}

size_t ted4_edit_drop(ted4_edit *e, const char *type)
{
    size_t n = 0;

    for (size_t i = 0; i < e->n; i++) {
        ted4_edit_chunk *c = &e->chunk[i];

        if (c->dropped || (c->view.flags & TED4_CHUNK_IS_CRITICAL) != 0 ||
            (type != NULL && strcmp(c->view.type, type) != 0))
            continue;
        c->dropped = 1;
        n++;
    }
    return n;
}

int ted4_edit_is_critical(const ted4_edit *e, const char *type)
{
    static const char *const known[] = { "HEAD", "NETE", "NETR", "BANK", "POSN", "TILE", "ENDS" };
    int is = 0;

    for (size_t i = 0; i < sizeof known / sizeof known[0]; i++)
        is |= strcmp(known[i], type) == 0;
    for (size_t i = 0; i < e->n; i++)
        is |= (e->chunk[i].view.flags & TED4_CHUNK_IS_CRITICAL) != 0 &&
              strcmp(e->chunk[i].view.type, type) == 0;
    return is;
}

static int make_room(ted4_edit *e)
{
    const size_t room = 2 * e->room + 8;
    ted4_edit_addition *added;

    if (e->n_added < e->room)
        return 0;
    added = realloc(e->added, room * sizeof *added);
    if (added == NULL)
        return -1;
    e->added = added;
    e->room = room;
    return 0;
}

int ted4_edit_add(ted4_edit *e, const char *type, uint32_t flags, uint8_t *payload, size_t size)
{
    if (size > UINT32_MAX || make_room(e) != 0) {
        free(payload);
        return -1;
    }
    ted4_edit_addition *a = &e->added[e->n_added++];

    memset(a->type, 0, sizeof a->type);
    memcpy(a->type, type, 4);
    a->flags = flags;
    a->payload = payload;
    a->size = size;
    return 0;
}

/* ---- META ---- */

int ted4_edit_is_text(const char *text)
{
    for (const char *c = text; *c != '\0'; c++)
        if ((unsigned char)*c < ' ' || *c == 0x7f)
            return 0;
    return ted4_is_utf8(text);
}

/* Reads n digits, and moves *text behind them. Returns whether they are a number of low to high. */
static int is_number(const char **text, int n, int low, int high)
{
    int value = 0;

    for (int i = 0; i < n; i++, ++*text) {
        if (**text < '0' || **text > '9')
            return 0;
        value = 10 * value + (**text - '0');
    }
    return value >= low && value <= high;
}

/* Moves *text behind a character, which is one of these. Returns whether it was there. */
static int is_one(const char **text, const char *of)
{
    const int is = **text != '\0' && strchr(of, **text) != NULL;

    *text += is;
    return is;
}

static int is_day(const char **text)
{
    static const int days[] = { 31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31 };
    const char *const begin = *text;

    if (!is_number(text, 4, 0, 9999) || !is_one(text, "-") || !is_number(text, 2, 1, 12) ||
        !is_one(text, "-"))
        return 0;

    const int year = atoi(begin), month = atoi(begin + 5);
    const int leaps = year % 4 == 0 && (year % 100 != 0 || year % 400 == 0);

    return is_number(text, 2, 1, days[month - 1] + (month == 2 && leaps));
}

/* A second may be the 60th, a leap second. */
static int is_time(const char **text)
{
    if (!is_number(text, 2, 0, 23) || !is_one(text, ":") || !is_number(text, 2, 0, 59) ||
        !is_one(text, ":") || !is_number(text, 2, 0, 60))
        return 0;
    if (is_one(text, ".")) {
        if (!is_number(text, 1, 0, 9))
            return 0;
        *text += strspn(*text, "0123456789");
    }
    return is_one(text, "Zz") || (is_one(text, "+-") && is_number(text, 2, 0, 23) &&
                                  is_one(text, ":") && is_number(text, 2, 0, 59));
}

int ted4_edit_is_date(const char *text)
{
    return is_day(&text) && (!is_one(&text, "Tt") || is_time(&text)) && *text == '\0';
}

static size_t key_length(const char *line, size_t n)
{
    const char *equals = memchr(line, '=', n);

    return equals != NULL ? (size_t)(equals - line) : n;
}

/* Has the line no value, be it for lack of an equals sign? */
static int is_empty(const char *line)
{
    const char *equals = strchr(line, '=');

    return equals == NULL || equals[1] == '\0';
}

static int has_key(const char *const *line, size_t n, const char *key, size_t length)
{
    for (size_t i = 0; i < n; i++)
        if (key_length(line[i], strlen(line[i])) == length && memcmp(line[i], key, length) == 0)
            return 1;
    return 0;
}

static void add_line(ted4_buffer *b, const char *line, size_t n)
{
    uint8_t *to = ted4_buffer_add(b, n + 1);

    if (to != NULL) {
        memcpy(to, line, n);
        to[n] = '\n';
    }
}

/* Copies the lines of a chunk META whose keys are not among the new ones. */
static void copy_lines(ted4_buffer *b, const ted4_chunk_view *c, const char *const *line, size_t n)
{
    const char *at = (const char *)c->payload, *const end = at + c->size;

    while (at < end) {
        const char *lf = memchr(at, '\n', (size_t)(end - at));
        const size_t length = (size_t)((lf != NULL ? lf : end) - at);

        if (!has_key(line, n, at, key_length(at, length)))
            add_line(b, at, length);
        at += length + 1;
    }
}

int ted4_edit_lines(ted4_edit *e, const char *const *line, size_t n)
{
    ted4_buffer b = { 0 };

    for (size_t i = 0; i < e->n; i++)
        if (!e->chunk[i].dropped && strcmp(e->chunk[i].view.type, "META") == 0)
            copy_lines(&b, &e->chunk[i].view, line, n);
    for (size_t i = 0; i < n; i++)
        if (!is_empty(line[i]))
            add_line(&b, line[i], strlen(line[i]));
    if (b.failed) {
        ted4_buffer_free(&b);
        return -1;
    }
    ted4_edit_drop(e, "META");
    if (b.size == 0) {
        ted4_buffer_free(&b);
        return 0;
    }
    return ted4_edit_add(e, "META", META_FLAGS, b.data, b.size);
}

/* ---- writing ---- */

static void put_addition(ted4_buffer *b, const ted4_edit_addition *a)
{
    uint8_t *to = ted4_buffer_add(b, TED4_CHUNK_HEAD + a->size + TED4_CHUNK_HASH);

    if (to == NULL)
        return;
    memcpy(to, a->type, 4);
    ted4_store32(to + 4, a->flags);
    ted4_store32(to + 8, (uint32_t)a->size);
    if (a->size > 0)
        memcpy(to + TED4_CHUNK_HEAD, a->payload, a->size);

    const uint64_t hash = XXH3_64bits(to, TED4_CHUNK_HEAD + a->size);

    to += TED4_CHUNK_HEAD + a->size;
    ted4_store32(to, (uint32_t)hash);
    ted4_store32(to + 4, (uint32_t)(hash >> 32));
}

static void copy(ted4_buffer *b, const uint8_t *from, size_t n)
{
    uint8_t *to = ted4_buffer_add(b, n);

    if (to != NULL)
        memcpy(to, from, n);
}

/* The decoded scene's hash into hash, or the reason for having none. */
static ted4_status hash_of(const uint8_t *file, size_t size, uint8_t hash[16])
{
    const ted4_options options = { .max_bytes = UINT64_MAX };
    ted4_error e = { TED4_OK, 0 };
    ted4_scene *scene;
    ted4_info info;

    if (ted4_decode(file, size, &options, &scene, &e) == TED4_OK) {
        ted4_scene_info(scene, &info);
        memcpy(hash, info.hash, sizeof info.hash);
        ted4_scene_free(scene);
    }
    return e.code;
}

/* Raises the level until the file fits (spec 13.1). Returns the verdict. */
static ted4_status fit_level(uint8_t *file, size_t size, uint8_t hash[16])
{
    static const uint8_t level[] = { 1, 2, 3, 4, 31 };
    const uint8_t found = file[LEVEL_AT];
    ted4_status verdict = hash_of(file, size, hash);

    for (size_t i = 0; i < sizeof level && verdict == TED4_E_LVL_EXCEEDED; i++) {
        if (level[i] <= found)
            continue;
        file[LEVEL_AT] = level[i];
        verdict = hash_of(file, size, hash);
    }
    return verdict;
}

static int is_of_minor_1(const char *type)
{
    return strcmp(type, "CAMS") == 0 || strcmp(type, "THMB") == 0;
}

/* R-CON-007: the minor version of the new file. That of a later specification is kept, and so is
 * that of a file whose chunks stay as they are. */
static int minor_version(const ted4_edit *e)
{
    const int found = e->file[MINOR_AT];
    int described = 0, changes = e->n_added > 0;

    for (size_t i = 0; i < e->n; i++) {
        changes |= e->chunk[i].dropped;
        described |= !e->chunk[i].dropped && is_of_minor_1(e->chunk[i].view.type);
    }
    for (size_t i = 0; i < e->n_added; i++)
        described |= is_of_minor_1(e->added[i].type);
    if (found > COMPACT_MINOR || !changes)
        return found;
    return e->file[PROFILE_AT] == TED4_PROFILE_COMPACT ? COMPACT_MINOR : described;
}

int ted4_edit_write(const ted4_edit *e, uint8_t **out, size_t *size, const char **why)
{
    ted4_buffer b = { 0 };
    uint8_t before[16], after[16];

    copy(&b, e->file, TED4_FILE_HEADER);
    for (size_t i = 0; i < e->n; i++) {
        const ted4_chunk_view *c = &e->chunk[i].view;

        for (size_t k = 0; strcmp(c->type, "ENDS") == 0 && k < e->n_added; k++)
            put_addition(&b, &e->added[k]);
        if (!e->chunk[i].dropped)
            copy(&b, e->file + c->at, c->end - c->at);
    }
    *why = b.failed ? "out of memory" : NULL;
    if (*why == NULL) {
        b.data[MINOR_AT] = (uint8_t)minor_version(e);
        if (hash_of(e->file, e->size, before) != TED4_OK)
            *why = "the file is not one that a decoder accepts";
        else if (fit_level(b.data, b.size, after) != TED4_OK ||
                 memcmp(before, after, sizeof before) != 0)
            *why = "the edited file is not the same scene: this is a bug";
    }
    if (*why != NULL) {
        ted4_buffer_free(&b);
        return -1;
    }
    *out = b.data;
    *size = b.size;
    return 0;
}
