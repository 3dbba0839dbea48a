/* test_spec_pass2.c - the printed code as a decoder of byte strings (decode_file of annex M)
 * against the reference decoder: the same verdict, identifier and offset of the published vectors
 * and of damaged streams; and the tables of annex M, 6.1 and 13.1 against that code.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "spec_head.h" /* first: its fail() is a function, that of cmocka a macro */
#include <stdio.h>
#include <xxhash.h>

#include "test.h"
#include "random_scene.h"
#include "vector_files.h"

enum { N_DAMAGED = 20, N_DAMAGES = 200, N_EDGES = 10, MAX_CHUNKS = 32 };

static uint8_t *encoded(const ted4_scene *s, size_t *size)
{
    uint8_t *data = NULL;

    assert_int_equal(ted4_encode(s, 0, NULL, &data, size, NULL), TED4_OK);
    return data;
}

/* Offsets of the chunks of a valid file, and its end. Returns how many chunks. */
static size_t chunks_of(const uint8_t *data, size_t size, size_t at[MAX_CHUNKS + 1])
{
    size_t n = 0;

    at[0] = 12;
    while (at[n] < size && n < MAX_CHUNKS) {
        at[n + 1] = at[n] + 20 + ted4_load32(data + at[n] + 8);
        n++;
    }
    return n;
}

static void fix_hash(uint8_t *chunk)
{
    const size_t n = 12 + (size_t)ted4_load32(chunk + 8);
    const uint64_t h = XXH3_64bits(chunk, n);

    ted4_store32(chunk + n, (uint32_t)h);
    ted4_store32(chunk + n + 4, (uint32_t)(h >> 32));
}

/* A byte becomes something near, a bit turns, or it becomes a value that matters. */
static void change_byte(random_source *r, uint8_t *p)
{
    static const uint8_t special[] = { 0, 1, 2, 31, 63, 127, 128, 255 };

    switch (random_in(r, 0, 3)) {
    case 0: *p ^= (uint8_t)(1u << random_in(r, 0, 7)); break;
    case 1: *p = (uint8_t)(*p + 1); break;
    case 2: *p = (uint8_t)(*p - 1); break;
    default: *p = special[random_in(r, 0, 7)]; break;
    }
}

/* One damage in room for 2 size + 64 bytes. Returns the new size. */
static size_t damage(random_source *r, uint8_t *data, size_t size)
{
    size_t at[MAX_CHUNKS + 1];
    const size_t n = chunks_of(data, size, at), c = random_in(r, 0, (uint32_t)n - 1),
                 length = at[c + 1] - at[c];

    switch (random_in(r, 0, 14)) {
    case 0: /* any byte, hash or not */
        change_byte(r, data + random_in(r, 0, (uint32_t)size - 1));
        return size;
    case 1: /* cut */ return random_in(r, 0, (uint32_t)size - 1);
    case 2: /* a chunk twice */
        memmove(data + at[c + 1] + length, data + at[c + 1], size - at[c + 1]);
        memcpy(data + at[c + 1], data + at[c], length);
        return size + length;
    case 3: /* a chunk less */
        memmove(data + at[c], data + at[c + 1], size - at[c + 1]);
        return size - length;
    case 4: /* type, flags, hash fixed */
        change_byte(r, data + at[c] + random_in(r, 0, 7));
        fix_hash(data + at[c]);
        return size;
    case 5: /* a byte more at the end of a payload */
        memmove(data + at[c + 1] + 1, data + at[c + 1], size - at[c + 1]);
        data[at[c + 1]] = 0;
        ted4_store32(data + at[c] + 8, (uint32_t)length - 20 + 1);
        fix_hash(data + at[c]);
        return size + 1;
    case 6: /* a byte less */
        if (length == 20)
            return size;
        memmove(data + at[c + 1] - 1, data + at[c + 1], size - at[c + 1]);
        ted4_store32(data + at[c] + 8, (uint32_t)length - 20 - 1);
        fix_hash(data + at[c]);
        return size - 1;
    case 7: /* the file header */ change_byte(r, data + random_in(r, 0, 11)); return size;
    case 8: /* HEAD */
        change_byte(r, data + at[0] + 12 + random_in(r, 0, (uint32_t)(at[1] - at[0]) - 21));
        fix_hash(data + at[0]);
        return size;
    case 9: /* the first bytes of a payload */
        if (length > 20)
            change_byte(r, data + at[c] + 12 +
                               random_in(r, 0, (uint32_t)(length < 60 ? length : 60) - 21));
        fix_hash(data + at[c]);
        return size;
    default: /* some bytes of a payload, hash fixed */
        for (uint32_t i = random_in(r, 1, 3); i > 0 && length > 20; i--)
            change_byte(r, data + at[c] + 12 + random_in(r, 0, (uint32_t)length - 21));
        fix_hash(data + at[c]);
        return size;
    }
}

static void same_verdict(const uint8_t *data, size_t size, unsigned *seen)
{
    spec_model m = { .n_blocks = 0 };
    ted4_error e = { TED4_OK, 0 };
    ted4_scene *s;
    const ted4_status status = ted4_decode(data, size, NULL, &s, &e);
    const char *id;

    spec_model_decode(&m, data, size);
    id = m.p.v.id == NULL ? "ok" : m.p.v.id;
    if (strcmp(id, ted4_status_id(status)) != 0 ||
        (status != TED4_OK && e.offset != m.p.v.offset)) {
        printf("text: %s at %llu; decoder: %s at %zu\n", id, (unsigned long long)m.p.v.offset,
               ted4_status_id(status), e.offset);
        fail();
    }
    seen[status]++;
    spec_model_free(&m);
    ted4_scene_free(s);
}

static void damaged_streams(void **state)
{
    unsigned seen[TED4_N_STATUS] = { 0 };
    int n_kinds = 0;

    (void)state;
    for (uint64_t seed = 0; seed < N_DAMAGED; seed++) {
        random_source r = random_seed(1000 + seed);
        ted4_scene *s = random_scene(seed);
        size_t size;
        uint8_t *data, *copy;

        s->profile = seed % 2 ? TED4_PROFILE_COMPACT : TED4_PROFILE_MAIN;
        data = encoded(s, &size);
        copy = malloc(2 * size + 64);

        for (int i = 0; i < N_DAMAGES; i++) {
            memcpy(copy, data, size);
            same_verdict(copy, damage(&r, copy, size), seen);
        }
        ted4_scene_free(s);
        free(copy);
        free(data);
    }
    for (int i = TED4_OK + 1; i < TED4_N_STATUS; i++)
        n_kinds += seen[i] > 0;
    assert_true(n_kinds >= 24);
}

static unsigned published[TED4_N_STATUS];

static void visit_vector(const uint8_t *data, size_t size, const char *path)
{
    (void)path;
    same_verdict(data, size, published);
}

/* The suite, but what asks for much, and what is large: the printed code is slow. */
static void vectors(void **state)
{
    (void)state;
    assert_true(each_vector("-size -60k ! -path '*/limit/*'", visit_vector) > 1000);
    assert_true(published[TED4_OK] > 300);
}

/* An entry of HEAD: its place in the payload, and values at and beyond the ends of its range and of
 * the level's bounds. */
typedef struct {
    size_t at, width;
    int64_t value[8];
} head_entry;

enum { MAX_ENTRIES = 96 };

static size_t head_entries(const struct header *h, int level, head_entry *e)
{
    uint64_t bound[N_BOUNDS];
    size_t n = 0, at = 0;

    spec_bounds(level, bound);

#define ELEMENT(name, count, bytes, is_signed, low, high, conditional, condition, level_bound) \
    for (int64_t i = 0; i < (count); i++, at += bytes)                                         \
        e[n++] = (head_entry) { at,                                                            \
                                bytes,                                                         \
                                { 0, (low)-1, low, (low) + 1, high, (high) + 1,                \
                                  (int64_t)bound[BOUND_##level_bound],                         \
                                  (int64_t)bound[BOUND_##level_bound] + 1 } };
#define REAL(name, count, bounded)                                                               \
    for (int64_t i = 0; i < (count); i++, at += 4)                                               \
        e[n++] = (head_entry) { at,                                                              \
                                4,                                                               \
                                { 0, 0x80000000, 0x357fffff, 0x35800000, 0x44800000, 0x44800001, \
                                  0x7f800000, 1 } };
#include "spec/head.inc"
#undef ELEMENT
#undef REAL
    return n;
}

/* What the table of 6.1 says of the elements of HEAD is what the printed code says. */
static void as_tabled(const uint8_t *data, size_t size)
{
    spec_head head = { .payload = data + 24, .size = ted4_load32(data + 20) };
    spec_model m = { .n_blocks = 0 };

    spec_model_decode(&m, data, size);
    spec_head_judge(&head, data[11]);
    if (head.v.id != NULL) {
        assert_string_equal(m.p.v.id, head.v.id);
        assert_int_equal(m.p.v.offset, 24 + head.v.offset);
    } else
        assert_true(m.p.v.id == NULL || strncmp(m.p.v.id, "hdr.", 4) != 0);
    spec_model_free(&m);
}

/* Every element of HEAD at both ends of what it may be, under every level. */
static void edges_of_head(void **state)
{
    static const uint8_t level[] = { 1, 2, 3, 4, 31 };
    unsigned seen[TED4_N_STATUS] = { 0 };

    (void)state;
    for (uint64_t seed = 0; seed < N_EDGES; seed++) {
        ted4_scene *s = random_scene(2 * seed);
        head_entry e[MAX_ENTRIES];
        spec_model m = { .n_blocks = 0 };
        size_t size, n;
        uint8_t *data = encoded(s, &size), *copy = malloc(size);

        data[11] = level[seed % sizeof level];
        spec_model_decode(&m, data, size);
        n = head_entries(&m.p.s.h, data[11], e);
        for (size_t i = 0; i < n; i++)
            for (int k = 0; k < 8; k++) {
                memcpy(copy, data, size);
                for (size_t b = 0; b < e[i].width; b++)
                    copy[24 + e[i].at + b] = (uint8_t)(e[i].value[k] >> 8 * b);
                fix_hash(copy + 12);
                same_verdict(copy, size, seen);
                as_tabled(copy, size);
            }
        spec_model_free(&m);
        ted4_scene_free(s);
        free(copy);
        free(data);
    }
    assert_true(seen[TED4_E_HDR_RANGE] > 100);
    assert_true(seen[TED4_E_HDR_COMBINATION] > 50);
    assert_true(seen[TED4_E_LVL_EXCEEDED] > 5);
}

/* The table of 13.1 is that of the printed code. */
static void bounds(void **state)
{
    static const int column[6] = { BOUND_n_anchors, BOUND_n_offsets, BOUND_frames,
                                   BOUND_values,    BOUND_products,  BOUND_symbols };

    (void)state;
    for (int level = 0; level < 5; level++) {
        uint64_t bound[N_BOUNDS];

        spec_bounds(level == 0 ? 31 : level, bound);
        for (int i = 0; i < 6; i++)
            assert_int_equal(level_bounds[level][i], bound[column[i]]);
    }
}

/* Identifiers of the tables of annex M: listed[kind] holds those of the chunks of that kind (5.3),
 * each between spaces; found[kind] those that a vector has shown. */
static char listed[7][1024], found[7][1024];

static void add_word(char *list, const char *word)
{
    char spaced[64];

    snprintf(spaced, sizeof spaced, " %s ", word);
    if (strstr(list, spaced) == NULL)
        strncat(list, spaced, 1023 - strlen(list));
}

/* A row of a table of annex M: its identifier, in column 3, of all chunks that the heading names.
 */
static void take_row(const char *heading, char *row)
{
    char *id = row;

    for (int i = 0; i < 3 && id != NULL; i++)
        id = strchr(id + (i > 0), '|');
    if (id == NULL || id[2] != '`')
        return;
    id[3 + strcspn(id + 3, "`")] = '\0';
    for (int kind = 0; kind < 7; kind++)
        if (strstr(heading, known_type[kind]) != NULL)
            add_word(listed[kind], id + 3);
}

static void visit_error(const uint8_t *data, size_t size, const char *path)
{
    spec_model m = { .n_blocks = 0 };
    uint64_t at = 12, next = 12;

    (void)path;
    if (pass_1(data, size).id != NULL)
        return;
    spec_model_decode(&m, data, size);
    while (m.p.v.id != NULL && next <= m.p.v.offset) {
        at = next;
        next += 20 + (uint64_t)ted4_load32(data + at + 8);
    }
    if (m.p.v.id != NULL)
        add_word(found[kind_of(data + at)], m.p.v.id);
    spec_model_free(&m);
}

static void read_annex(void)
{
    char line[1024], heading[1024] = "";
    FILE *const f = fopen("spec/annex-m-pass2.md", "r");

    assert_non_null(f);
    while (fgets(line, sizeof line, f) != NULL) {
        if (strncmp(line, "## ", 3) == 0)
            memcpy(heading, line, sizeof heading);
        else if (strncmp(line, "| ", 2) == 0)
            take_row(heading, line);
    }
    fclose(f);
}

/* Every word of one list is in the other, but for limits, which are a caller's. */
static void all_in(const char *these, const char *those, const char *type)
{
    char words[1024], spaced[64];

    memcpy(words, these, sizeof words);
    for (char *word = strtok(words, " "); word != NULL; word = strtok(NULL, " ")) {
        snprintf(spaced, sizeof spaced, " %s ", word);
        if (strncmp(word, "limit.", 6) != 0 && strstr(those, spaced) == NULL)
            fail_msg("%s, annex M and vectors: only one has %s", type, word);
    }
}

/* The identifiers that vectors show in a chunk are those that annex M lists for it. */
static void rows(void **state)
{
    (void)state;
    read_annex();
    assert_true(each_vector("-size -60k -path '*/invalid/*'", visit_error) > 500);
    for (int kind = 0; kind < 7; kind++) {
        assert_true(listed[kind][0] != '\0');
        all_in(found[kind], listed[kind], known_type[kind]);
        all_in(listed[kind], found[kind], known_type[kind]);
    }
}

/* Blocks that the printed code may still have. */
typedef struct {
    spec_model *m;
    int left;
} few_blocks;

static void *few(void *user, uint64_t n, size_t size)
{
    few_blocks *f = user;

    return f->left-- > 0 ? spec_room(f->m, n, size) : NULL;
}

/* Without memory the verdict is limit.memory, wherever memory ends. */
static void little_memory(void **state)
{
    ted4_scene *s = random_scene(3);
    size_t size;
    uint8_t *data = encoded(s, &size);
    int n = 0, valid = 0;

    (void)state;
    for (; !valid; n++) {
        spec_model m = { .n_blocks = 0 };
        few_blocks f = { &m, n };

        m.p = (struct pass_2) { .file = data, .size = size, .room = few, .user = &f };
        decode_file(&m.p);
        valid = m.p.v.id == NULL;
        if (!valid)
            assert_string_equal(m.p.v.id, "limit.memory");
        spec_model_free(&m);
    }
    assert_true(n > 10);
    ted4_scene_free(s);
    free(data);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bounds),
        cmocka_unit_test(edges_of_head),
        cmocka_unit_test(damaged_streams),
        cmocka_unit_test(vectors),
        cmocka_unit_test(rows),
        cmocka_unit_test(little_memory),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
