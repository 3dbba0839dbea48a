/* test_edit.c - tool/edit.c, cams.c, chunks.c: what a file says about its scene is set, replaced
 * and stripped, and nothing else in the file changes.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <math.h>

#include "test.h"
#include "norm/limits.h"
#include "ted4.h"
#include "tool/cams.h"
#include "tool/edit.h"
#include "validate_case.h"

enum { MINOR_AT = 9, LEVEL_AT = 11 };

/* A file without ancillary chunks. */
static uint8_t *plain_file_of(uint8_t profile, size_t *size)
{
    ted4_header h = random_small_header(200);
    ted4_scene *s = useful(7, &h);
    uint8_t *file;

    s->profile = profile;
    file = encoded(s, 0, size);
    ted4_scene_free(s);
    return file;
}

static uint8_t *plain_file(size_t *size)
{
    return plain_file_of(TED4_PROFILE_MAIN, size);
}

static uint8_t *copied(const void *data, size_t size)
{
    uint8_t *copy = malloc(size);

    memcpy(copy, data, size);
    return copy;
}

/* Writes the edit. */
static uint8_t *written(ted4_edit *e, size_t *size)
{
    const char *why = NULL;
    uint8_t *out = NULL;

    if (ted4_edit_write(e, &out, size, &why) != 0)
        fail_msg("%s", why);
    ted4_edit_finish(e);
    return out;
}

/* The text of the only chunk META; "" if there is none. */
static const char *meta_of(const uint8_t *file, size_t size)
{
    static char text[1000];
    ted4_chunk_view c;
    int n = 0;

    text[0] = '\0';
    for (size_t at = TED4_FILE_HEADER; ted4_chunks_next(file, size, &at, &c);) {
        if (strcmp(c.type, "META") != 0)
            continue;
        assert_int_equal(c.flags, TED4_CHUNK_IS_SAFE);
        memcpy(text, c.payload, c.size);
        text[c.size] = '\0';
        n++;
    }
    assert_in_range(n, 0, 1);
    return text;
}

static uint8_t *with_lines(const uint8_t *file, size_t *size, const char *const *line, size_t n)
{
    ted4_edit e;

    assert_int_equal(ted4_edit_begin(&e, file, *size), 0);
    assert_int_equal(ted4_edit_lines(&e, line, n), 0);
    return written(&e, size);
}

static void lines_are_set_replaced_and_removed(void **state)
{
    static const char *const first[] = { "title=One", "author=A", "a=b=c" };
    static const char *const second[] = { "title=E=", "author=", "titles==" };
    static const char *const last[] = { "title=", "a=", "titles=", "none=" };
    size_t size, plain_size;
    uint8_t *plain = plain_file(&plain_size), *one, *two, *none;

    (void)state;
    size = plain_size;
    one = with_lines(plain, &size, first, 3);
    assert_string_equal(meta_of(one, size), "title=One\nauthor=A\na=b=c\n");
    assert_int_equal(one[MINOR_AT], 0);
    two = with_lines(one, &size, second, 3);
    assert_string_equal(meta_of(two, size), "a=b=c\ntitle=E=\ntitles==\n");
    none = with_lines(two, &size, last, 4);
    assert_int_equal(size, plain_size);
    assert_memory_equal(none, plain, size);
    free(plain);
    free(one);
    free(two);
    free(none);
}

static ted4_cams_camera some_camera(void)
{
    const ted4_cams_camera c = { .view = { .width = 640,
                                           .height = 480,
                                           .fx = 500.5f,
                                           .fy = 501,
                                           .cx = 320,
                                           .cy = 240,
                                           .R = { 0, 1, 0, 0, 0, 1, 1, 0, 0 },
                                           .t = { 1, -2, 3 } },
                                 .time = { 3, 7 } };

    return c;
}

/* A payload of n equal cameras. */
static uint8_t *payload_of(size_t n, ted4_cams_kind kind, const float up[3], size_t *size)
{
    const ted4_cams_camera c = some_camera();
    uint8_t *payload;

    *size = TED4_CAMS_HEAD + n * TED4_CAMS_CAMERA;
    payload = malloc(*size);
    ted4_cams_put_head(payload, up, kind, n);
    for (size_t i = 0; i < n; i++)
        ted4_cams_put(payload + TED4_CAMS_HEAD + i * TED4_CAMS_CAMERA, &c);
    return payload;
}

/* spec 16.4: a file with CAMS has minor 1, the same scene, and its bytes back when stripped. */
static void cameras_are_added_and_stripped(void **state)
{
    static const float up[3] = { 0, 0.6f, 0.8f };
    const ted4_cams_camera want = some_camera();
    size_t size, payload_size;
    uint8_t *plain = plain_file(&size), *with, *without, *payload;
    const size_t plain_size = size;
    ted4_chunk_view c;
    ted4_edit e;
    ted4_cams cams;
    int found = 0;

    (void)state;
    assert_int_equal(ted4_edit_begin(&e, plain, size), 0);
    payload = payload_of(2, TED4_CAMS_PATH, up, &payload_size);
    assert_int_equal(ted4_edit_add(&e, "CAMS", 0, payload, payload_size), 0);
    with = written(&e, &size);
    assert_int_equal(with[MINOR_AT], 1);
    for (size_t at = TED4_FILE_HEADER; ted4_chunks_next(with, size, &at, &c);) {
        if (strcmp(c.type, "CAMS") != 0)
            continue;
        found++;
        assert_int_equal(c.flags, 0);
        assert_int_equal(ted4_cams_read(c.payload, c.size, &cams), 0);
        assert_int_equal(cams.n, 2);
        assert_int_equal(cams.kind, TED4_CAMS_PATH);
        assert_memory_equal(cams.up, up, sizeof up);

        const ted4_cams_camera got = ted4_cams_get(&cams, 1);

        assert_memory_equal(&got.view, &want.view, sizeof want.view);
        assert_int_equal(got.time.num, 3);
        assert_int_equal(got.time.den, 7);
    }
    assert_int_equal(found, 1);
    assert_int_equal(ted4_edit_begin(&e, with, size), 0);
    assert_int_equal(ted4_edit_drop(&e, "THMB"), 0);
    assert_int_equal(ted4_edit_drop(&e, NULL), 1);
    without = written(&e, &size);
    assert_int_equal(size, plain_size);
    assert_memory_equal(without, plain, size);
    free(plain);
    free(with);
    free(without);
}

/* R-EXT-004: unknown chunks stay as they are, critical ones cannot be dropped, and a minor version
 * above 2 is kept. */
static void unknown_chunks_and_versions_stay(void **state)
{
    static const char text[] = "anything";
    size_t size, before;
    uint8_t *plain = plain_file(&size), *with, *again;
    ted4_edit e;

    (void)state;
    assert_int_equal(ted4_edit_begin(&e, plain, size), 0);
    assert_int_equal(ted4_edit_drop(&e, "POSN"), 0);
    assert_int_equal(ted4_edit_add(&e, "xyzw", 2, copied(text, sizeof text), sizeof text), 0);
    with = written(&e, &size);
    assert_int_equal(with[MINOR_AT], 0);
    with[MINOR_AT] = 9;
    before = size;
    again = with_lines(with, &size, (const char *const[]) { "title=" }, 1);
    assert_int_equal(size, before);
    assert_memory_equal(again, with, size);
    free(plain);
    free(with);
    free(again);
}

/* R-CON-007: an editor of this version knows 2; when it changes chunks, it keeps it for profile
 * Compact only. R-BIT-002: when it changes nothing, the bytes stay. */
static void minor_of_the_profile(void **state)
{
    static const struct {
        uint8_t profile, before, after;
    } of[] = { { TED4_PROFILE_MAIN, 2, 0 },
               { TED4_PROFILE_COMPACT, 2, 2 },
               { TED4_PROFILE_COMPACT, 0, 2 } };

    (void)state;
    for (size_t i = 0; i < sizeof of / sizeof *of; i++) {
        size_t size;
        uint8_t *file = plain_file_of(of[i].profile, &size), *again;

        file[MINOR_AT] = of[i].before;
        const size_t before = size;

        again = with_lines(file, &size, (const char *const[]) { "title=" }, 1);
        assert_int_equal(size, before);
        assert_memory_equal(again, file, size);
        free(again);
        again = with_lines(file, &size, (const char *const[]) { "title=x" }, 1);
        assert_int_equal(again[MINOR_AT], of[i].after);
        free(again);
        free(file);
    }
}

/* spec 13.1: a file that grows beyond its level gets the next one that takes it. */
static void level_is_raised_where_needed(void **state)
{
    size_t size;
    uint8_t *plain = plain_file(&size), *with;
    const size_t much = (size_t)ted4_limits_of(plain[LEVEL_AT])->file_bytes;
    ted4_edit e;

    (void)state;
    assert_int_equal(plain[LEVEL_AT], 1);
    assert_int_equal(ted4_edit_begin(&e, plain, size), 0);
    assert_int_equal(ted4_edit_add(&e, "xyzw", 0, calloc(much, 1), much), 0);
    with = written(&e, &size);
    assert_int_equal(with[LEVEL_AT], 2);
    free(plain);
    free(with);
}

static void expect_refused(size_t at, uint32_t value)
{
    static const float up[3] = { 0, 1, 0 };
    size_t size;
    uint8_t *payload = payload_of(2, TED4_CAMS_TAKEN, up, &size);
    ted4_cams c;

    assert_int_equal(ted4_cams_read(payload, size, &c), 0);
    ted4_store32(payload + at, value);
    if (ted4_cams_read(payload, size, &c) == 0)
        fail_msg("value %08x at %zu is accepted", value, at);
    free(payload);
}

/* More chunks than any program adds by itself: transcoding adds all those of a file. */
static void many_chunks_are_added_in_order(void **state)
{
    enum { MANY = 100 };
    ted4_edit e;
    ted4_chunk_view c;
    size_t size, n = 0;
    uint8_t *file = plain_file(&size), *out;

    assert_int_equal(ted4_edit_begin(&e, file, size), 0);
    for (uint8_t i = 0; i < MANY; i++)
        assert_int_equal(ted4_edit_add(&e, "many", TED4_CHUNK_IS_SAFE, copied(&i, 1), 1), 0);
    out = written(&e, &size);
    for (size_t at = TED4_FILE_HEADER; ted4_chunks_next(out, size, &at, &c);)
        if (strcmp(c.type, "many") == 0) {
            assert_int_equal(c.size, 1);
            assert_int_equal(c.payload[0], n++);
        }
    assert_int_equal(n, MANY);
    free(out);
    free(file);
    (void)state;
}

/* R-EXT-008, one violation at a time, in the second camera. */
static void broken_cameras_are_refused(void **state)
{
    enum { CAMERA = TED4_CAMS_HEAD + TED4_CAMS_CAMERA };
    static const float up[3] = { 0, 0, 0 };
    const uint32_t infinite = 0x7f800000, minus_one = 0xbf800000, nan = 0x7fc00000;
    size_t size;
    uint8_t *payload = payload_of(1, TED4_CAMS_TAKEN, up, &size);
    ted4_cams c;

    (void)state;
    expect_refused(0, 0x3f800000); /* up of length sqrt(2) */
    expect_refused(0, nan);
    expect_refused(4, 0x3f804189); /* 1.002 */
    expect_refused(12, TED4_CAMS_KINDS);
    expect_refused(16, 1);
    expect_refused(16, 3);
    expect_refused(16, UINT32_MAX);
    expect_refused(CAMERA, 0);
    expect_refused(CAMERA, TED4_CAMS_SIDE + 1);
    expect_refused(CAMERA + 4, UINT32_MAX);
    expect_refused(CAMERA + 8, 0);
    expect_refused(CAMERA + 12, minus_one);
    expect_refused(CAMERA + 16, infinite);
    expect_refused(CAMERA + 20, nan);
    expect_refused(CAMERA + 24, 0x3f800000);
    expect_refused(CAMERA + 48, minus_one); /* R a mirror image */
    expect_refused(CAMERA + 56, nan);
    expect_refused(CAMERA + 68, infinite);
    expect_refused(CAMERA + 72, 8);        /* num above den */
    expect_refused(CAMERA + 76, 0);        /* ..., and den 0 */
    expect_refused(CAMERA + 76, 1 << 24);  /* no query */
    ted4_store32(payload + 4, 0x3f801d7e); /* 1.0009 */
    assert_int_equal(ted4_cams_read(payload, size, &c), 0);
    assert_int_equal(ted4_cams_read(payload, size - 1, &c), -1);
    assert_int_equal(ted4_cams_read(payload, TED4_CAMS_HEAD - 1, &c), -1);
    assert_int_equal(ted4_cams_read(payload, 0, &c), -1);
    free(payload);
}

/* Sizes that lie about the file end the walk, and nothing outside is read. */
static void chunks_end_with_the_file(void **state)
{
    size_t size, at = TED4_FILE_HEADER, n = 0;
    uint8_t *file = plain_file(&size);
    ted4_chunk_view c;

    (void)state;
    while (ted4_chunks_next(file, size, &at, &c))
        n++;
    assert_int_equal(at, size);
    assert_true(n >= 6);
    for (size_t cut = 0; cut < size; cut += 1 + cut / 8) {
        uint8_t *part = copied(file, cut > 0 ? cut : 1);

        for (at = TED4_FILE_HEADER; ted4_chunks_next(part, cut, &at, &c);)
            assert_true(c.end <= cut);
        free(part);
    }
    free(file);
}

static void dates_are_of_rfc_3339(void **state)
{
    static const char *const good[] = { "2026-11-24",
                                        "2024-02-29",
                                        "2000-02-29",
                                        "2026-11-24T12:00:00Z",
                                        "2026-11-24t23:59:60z",
                                        "2026-11-24T12:00:00.125+01:00",
                                        "2026-11-24T12:00:00-00:00" };
    static const char *const none[] = { "",
                                        "yesterday",
                                        "2026",
                                        "2026-11",
                                        "2026-13-01",
                                        "2026-00-01",
                                        "2026-11-31",
                                        "2026-11-00",
                                        "1900-02-29",
                                        "2026-02-29",
                                        "2026-11-24T",
                                        "2026-11-24T12:00Z",
                                        "2026-11-24T24:00:00Z",
                                        "2026-11-24T12:00:00",
                                        "2026-11-24T12:00:00.Z",
                                        "2026-11-24T12:00:00+0100",
                                        "2026-11-24T12:00:00Z ",
                                        "2026-1-24",
                                        "24.11.2026" };

    (void)state;
    for (size_t i = 0; i < sizeof good / sizeof good[0]; i++)
        if (!ted4_edit_is_date(good[i]))
            fail_msg("%s", good[i]);
    for (size_t i = 0; i < sizeof none / sizeof none[0]; i++)
        if (ted4_edit_is_date(none[i]))
            fail_msg("%s", none[i]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lines_are_set_replaced_and_removed),
        cmocka_unit_test(cameras_are_added_and_stripped),
        cmocka_unit_test(unknown_chunks_and_versions_stay),
        cmocka_unit_test(minor_of_the_profile),
        cmocka_unit_test(level_is_raised_where_needed),
        cmocka_unit_test(many_chunks_are_added_in_order),
        cmocka_unit_test(broken_cameras_are_refused),
        cmocka_unit_test(chunks_end_with_the_file),
        cmocka_unit_test(dates_are_of_rfc_3339),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
