/* test_conformance.c - the suite: its recipes give the published bytes and leave nothing out, our
 * decoder passes all of them, and the runner detects decoders that do not conform
 * (conformance/tests/bad_decoder.sh). Programs are run as a user would run them.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>

#include "test.h"
#include "base/level.h"
#include "temporary.h"
#include "ted4.h"

#ifdef __SANITIZE_ADDRESS__
#define MEMORY " --memory 0" /* the sanitizer's shadow memory takes terabytes of addresses */
#else
#define MEMORY ""
#endif

static const char *build(void)
{
    const char *b = getenv("TED4_BUILD");

    return b != NULL ? b : "build";
}

/* The beginning of what ted4conf printed last. */
static char said[4096];

/* Returns the exit code of ted4conf with those arguments, and its last line in last. */
static int conf(char *last, size_t size, const char *format, ...)
{
    char arguments[1024], command[2048], line[1024];
    va_list a;
    FILE *f;
    int status;

    va_start(a, format);
    vsnprintf(arguments, sizeof arguments, format, a);
    va_end(a);
    snprintf(command, sizeof command, "TED4DEC=%s/ted4dec MOOD=%s/mood %s/ted4conf %s 2>&1",
             build(), build(), build(), arguments);
    f = popen(command, "r");
    assert_non_null(f);
    last[0] = said[0] = '\0';
    while (fgets(line, sizeof line, f) != NULL) {
        snprintf(last, size, "%s", line);
        strncat(said, line, sizeof said - 1 - strlen(said));
    }
    status = pclose(f);
    assert_true(WIFEXITED(status));
    return WEXITSTATUS(status);
}

static void recipes_give_the_published_bytes(void **state)
{
    char last[1024];

    (void)state;
    if (conf(last, sizeof last, "gen --verify") != 0)
        fail_msg("%s", last);
    assert_int_equal(conf(last, sizeof last, "gen --verify --only WRK-smalest"), 3);
    assert_string_equal(last, "ted4conf: --only WRK-smalest: no vector's id begins so\n");
}

/* There is no rule without a vector and no vector without a rule, and every value, pair, table
 * entry and extreme occurs. */
static void nothing_is_left_out(void **state)
{
    char last[1024];

    (void)state;
    if (conf(last, sizeof last, "cover") != 0)
        fail_msg("ted4conf cover: %s", last);
}

/* Files truncated at every byte: con.truncated at the end, or the error that pass 1 finds before
 * it. */
static void truncation_at_every_byte(void **state)
{
    static const char *const file[] = { "worked/WRK-smallest", "worked/WRK-masks",
                                        "worked/WRK-dynamic" };
    uint8_t data[4096];

    (void)state;
    for (size_t i = 0; i < sizeof file / sizeof *file; i++) {
        char path[256];
        FILE *f;
        size_t size;
        ted4_scene *s;
        ted4_error e;

        snprintf(path, sizeof path, "conformance/vectors/%s.ted4", file[i]);
        f = fopen(path, "rb");
        assert_non_null(f);
        size = fread(data, 1, sizeof data, f);
        fclose(f);
        assert_true(size > 200);
        assert_true(size < sizeof data);
        for (size_t n = 0; n < size; n++) {
            assert_int_equal(ted4_decode(data, n, NULL, &s, &e), TED4_E_CON_TRUNCATED);
            assert_int_equal(e.offset, n);
        }
    }
}

/* The second run of each vector uses the plain kernels: both runs must give the same hashes. */
static void our_decoder_conforms(void **state)
{
    char last[1024];

    (void)state;
    if (conf(last, sizeof last, "run -j 2 -t 300 -d %s/ted4dec --second TED4_KERNEL=plain%s",
             build(), MEMORY) != 0)
        fail_msg("%s%s", said, last);
    assert_null(strstr(last, " 0 passed"));
    assert_non_null(strstr(last, " 0 failed, 0 without answer, 0 missing, 0 declined"));
}

/* Uses the kernels of each level that this machine has. */
static void levels_conform(void **state)
{
    char last[1024];

    (void)state;
    for (int level = TED4_LEVEL_PLAIN; level <= (int)ted4_level_of_machine(); level++) {
        setenv("TED4_KERNEL", ted4_level_name((ted4_level)level), 1);
        if (conf(last, sizeof last, "replay") != 0)
            fail_msg("%s: %s", ted4_level_name((ted4_level)level), said);
    }
    unsetenv("TED4_KERNEL");
}

/* Decodes with a caller's threads, with a trace, without options, and to a scene as encoders make
 * it. */
static void ways_agree(void **state)
{
    char last[1024];

    (void)state;
    if (conf(last, sizeof last, "replay --ways") != 0)
        fail_msg("%s", said);
}

/* Decodes and asks on four threads at once, lent to the library or each a caller of its own; make
 * conformance-threads has the thread sanitizer watch. */
static void threads_agree(void **state)
{
    char last[1024];

    (void)state;
    if (conf(last, sizeof last, "replay --threads 4") != 0)
        fail_msg("%s", said);
}

/* Runs a bad decoder over a list of vectors; the last line must contain what. */
static void expect_of(const char *list, const char *way, int code, const char *what)
{
    char last[1024];

    assert_int_equal(conf(last, sizeof last,
                          "run -j %d -t %d --memory 0 -q -l conformance/%s "
                          "-d 'sh conformance/tests/bad_decoder.sh %s'",
                          strcmp(way, "moody") == 0 ? 1 : 4, strncmp(way, "hang", 4) == 0 ? 1 : 60,
                          list, way),
                     code);
    if (strstr(last, what) == NULL)
        fail_msg("%s: \"%s\" lacks \"%s\"", way, last, what);
}

static void expect(const char *way, int code, const char *what)
{
    expect_of("lists/few.txt", way, code, what);
}

/* few.txt: 4 valid vectors, 3 invalid ones, 1 limit. */
static void no_answers(void **state)
{
    static const char *const way[] = { "crash",          "silent",      "exit-code", "chatter",
                                       "chatter-behind", "two-answers", "no-json",   "no-utf8",
                                       "flood",          "hang" };

    (void)state;
    for (size_t i = 0; i < sizeof way / sizeof *way; i++)
        expect(way[i], 1, " 0 passed, 0 failed, 8 without answer, 0 missing");
    expect("no-capabilities", 1, "nothing on stdout");
    expect("old-protocol", 1, "protocol is not 1");
}

/* A decoder says all of the handshake, or has no verdict. */
static void capabilities(void **state)
{
    static const struct {
        const char *way, *member;
    } wrong[] = { { "class-unknown", "class" },      { "profile-unknown", "profiles" },
                  { "tier-unknown", "tiers" },       { "knob-number", "knobs" },
                  { "declines-number", "declines" }, { "lenient-text", "lenient" },
                  { "level-0", "max_level" },        { "level-5", "max_level" },
                  { "level-32", "max_level" } };
    static const char *const member[] = { "name",  "version", "spec",   "profiles", "max_level",
                                          "tiers", "class",   "strict", "declines", "knobs" };

    (void)state;
    for (size_t i = 0; i < sizeof member / sizeof *member; i++) {
        char way[40], text[80];

        snprintf(way, sizeof way, "without-%s", member[i]);
        snprintf(text, sizeof text, "capabilities: %s is missing", member[i]);
        expect(way, 1, text);
    }
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        char text[80];

        snprintf(text, sizeof text, "capabilities: %s is missing, or not what", wrong[i].member);
        expect(wrong[i].way, 1, text);
    }
    expect("compact-alone", 1, "capabilities: profiles lacks Main");
}

static void lies(void **state)
{
    (void)state;
    expect("good", 0,
           " 8 passed, 0 failed, 0 without answer, 0 missing, 0 declined, 0 not run: conforms");
    expect("says-valid", 1, " 0 passed, 8 failed");
    expect("says-invalid", 1, " 1 passed, 7 failed"); /* one of them really is invalid */
    expect("says-limit", 1, " 1 passed, 7 failed");
    expect("wrong-hash", 1, " 4 passed, 4 failed");
    expect("half-wrong", 1, " 4 passed, 4 failed");
    expect("no-hashes", 1, " 4 passed, 4 failed");
    expect("no-tier", 1, " 4 passed, 4 failed");
    expect("wrong-records", 1, " 4 passed, 4 failed");
    expect("no-records", 1, " 4 passed, 4 failed");
    expect("records-and-error", 1, " 4 passed, 4 failed");
    expect("wrong-bytes", 1, " 4 passed, 4 failed");
    expect("text-bytes", 1, " 4 passed, 4 failed");
    expect("no-result", 1, " 0 passed, 8 failed");
    expect("wrong-offset", 1, " 5 passed, 3 failed");
    expect("no-offset", 1, " 5 passed, 3 failed");
    expect("tiers-of-invalid", 1, " 5 passed, 3 failed");
    expect("salvages-strictly", 1, " 5 passed, 3 failed");
    expect("wrong-error", 1, " 4 passed, 4 failed");
    expect("moody", 1, " 0 passed, 8 failed");
    expect("spoils-input", 1, "does not conform");
}

/* What is wrong with an answer, in words. */
static void reasons(void **state)
{
    static const char *const said_of[][2] = {
        { "no-result", "fail: CON-least: the result is missing, or no text\n" },
        { "no-offset", "fail: NEG-magic-0: con.magic: the offset is missing, or no integer\n" },
        { "says-invalid", "fail: CON-least: should be valid, is invalid con.magic\n" },
        { "says-valid", "fail: NEG-magic-0: should be invalid con.magic, is valid\n" },
    };
    char last[1024];

    (void)state;
    for (size_t i = 0; i < sizeof said_of / sizeof *said_of; i++) {
        conf(last, sizeof last,
             "run -t 60 --memory 0 -l conformance/lists/few.txt "
             "-d 'sh conformance/tests/bad_decoder.sh %s'",
             said_of[i][0]);
        if (strstr(said, said_of[i][1]) == NULL)
            fail_msg("%s: %s", said_of[i][0], said);
    }
}

static void declining(void **state)
{
    (void)state;
    expect("no-knobs", 0, " 7 passed, 0 failed, 0 without answer, 0 missing, 1 declined");
    expect("declines-moving", 0, " 5 passed, 0 failed, 0 without answer, 0 missing, 3 declined");
    expect("declines-all", 1, "no valid stream decoded");
    expect("fewer-tiers", 1,
           " 8 passed, 0 failed, 0 without answer, 0 missing, 0 declined, 0 not run: does not "
           "conform: T1 is not claimed");
    expect("class-alone", 1, "a class is claimed, but not T5");
}

/* claims.txt: a valid vector of profile Main; a valid and an invalid one of profile Compact; an
 * invalid one for which the specification allows a limit, too; an invalid one with a knob. */
static void claims(void **state)
{
    static const char list[] = "tests/claims.txt";

    (void)state;
    expect_of(list, "good", 0, " 5 passed, 0 failed, 0 without answer, 0 missing, 0 declined");
    expect_of(list, "compact-refused", 0,
              " 3 passed, 0 failed, 0 without answer, 0 missing, 2 declined");
    expect_of(list, "compact-unclaimed", 1, " 3 passed, 2 failed");
    expect_of(list, "knobs-refused", 0, " 5 passed, 0 failed, 0 without answer");
    expect_of(list, "says-no-limit", 1, " 0 passed, 5 failed");
    expect_of("tests/above.txt", "says-no-limit", 1, " 0 passed, 4 failed");
}

/* Processes that a decoder leaves running end when its time is over, and do not make the runner
 * wait. */
static void left_behind(void **state)
{
    (void)state;
    expect("hang-behind", 1, " 8 without answer");
}

/* class-t.txt: a valid vector; one with four queries, three of which are out of range; one with
 * queries that have no result in class X; an invalid one. */
static void class_t(void **state)
{
    static const char *const kept[] = { "exact", "inside", "more" };
    static const char *const broken[] = {
        "beyond-scale", "beyond-rotation", "beyond-opacity", "beyond-colour", "nan", "short"
    };
    static const char list[] = "tests/class-t.txt";
    char way[40];

    (void)state;
    for (size_t i = 0; i < sizeof kept / sizeof *kept; i++) {
        snprintf(way, sizeof way, "class-t-%s", kept[i]);
        expect_of(
            list, way, 0,
            " 4 passed, 0 failed, 0 without answer, 0 missing, 0 declined, 0 not run: conforms");
    }
    for (size_t i = 0; i < sizeof broken / sizeof *broken; i++) {
        snprintf(way, sizeof way, "class-t-%s", broken[i]);
        expect_of(list, way, 1, " 2 passed, 2 failed, 0 without answer");
    }
    expect_of(list, "class-t-rms-opacity", 1, " 3 passed, 1 failed, 0 without answer");
    expect_of(list, "class-t-less", 1, " 1 passed, 3 failed, 0 without answer");
    expect_of(list, "class-t-no-dump", 1, " 1 passed, 3 failed, 0 without answer");
    expect_of(list, "class-t-other-dump", 1, " 1 passed, 3 failed, 0 without answer");
}

/* lenient.txt: six vectors. From two nothing can be salvaged, from three something, and one is
 * valid. */
static void lenient_mode(void **state)
{
    static const char list[] = "tests/lenient.txt";

    (void)state;
    expect_of(list, "good", 0, " 6 passed, 0 failed, 0 without answer");
    expect_of(list, "not-lenient", 0, " 6 passed, 0 failed, 0 without answer");
    expect_of(list, "salvages-nothing", 1, " 3 passed, 3 failed");
    expect_of(list, "salvages-less", 1, " 5 passed, 1 failed");
    expect_of(list, "salvages-wrongly", 1, " 3 passed, 3 failed");
    expect_of(list, "salvages-to-the-end", 1, " 3 passed, 3 failed");
    expect_of(list, "salvages-always", 1, " 3 passed, 3 failed");
    expect_of(list, "salvages-and-forgives", 1, " 0 passed, 6 failed");
}

static void missing_vectors(void **state)
{
    char last[1024];

    (void)state;
    assert_int_equal(conf(last, sizeof last,
                          "run -q" MEMORY " -l conformance/tests/absent.txt -d %s/ted4dec",
                          build()),
                     1);
    assert_non_null(strstr(last, " 1 passed, 0 failed, 0 without answer, 1 missing"));
}

/* Leaves in FOLDER/vectors one vector with its file, one that is made on demand, and one whose file
 * is gone. */
static void make_torn_suite(const char *folder)
{
    char command[1024];

    snprintf(command, sizeof command,
             "mkdir %s/vectors && cp conformance/vectors/worked/WRK-masks.* "
             "conformance/vectors/worked/WRK-escape.json "
             "conformance/vectors/stress/ENT-lanes-64-more.json %s/vectors",
             folder, folder);
    assert_int_equal(system(command), 0);
}

/* A vector whose file is gone fails, unless it is one that is made on demand; a suite without files
 * is an error. */
static void replay_without_files(void **state)
{
    char folder[TEMPORARY_SIZE], last[1024], line[512];

    (void)state;
    temporary_folder(folder, "ted4-test-replay");
    make_torn_suite(folder);
    assert_int_equal(conf(last, sizeof last, "replay --suite %s", folder), 1);
    assert_string_equal(last, "2 run, 1 failed\n");
    snprintf(line, sizeof line, "missing: WRK-escape: %s/vectors/WRK-escape.ted4 is not there\n",
             folder);
    assert_non_null(strstr(said, line));
    assert_int_equal(conf(last, sizeof last, "cover --suite %s", folder), 3);
    snprintf(line, sizeof line, "ted4conf: %s/vectors/WRK-escape.ted4: cannot be read\n", folder);
    assert_string_equal(last, line);
    snprintf(line, sizeof line, "rm %s/vectors/WRK-*", folder);
    assert_int_equal(system(line), 0);
    assert_int_equal(conf(last, sizeof last, "replay --suite %s", folder), 3);
    snprintf(line, sizeof line, "ted4conf: %s/vectors: no vector has a file\n", folder);
    assert_string_equal(said, line);
    assert_int_equal(conf(last, sizeof last, "replay --suite %s/absent", folder), 3);
    snprintf(line, sizeof line, "rm -r %s", folder);
    assert_int_equal(system(line), 0);
}

/* work.txt: the first vector may give any limit, the second only limit.work. */
static void limits(void **state)
{
    static const char list[] = "tests/work.txt";

    (void)state;
    expect_of(list, "says-limit", 1, " 1 passed, 1 failed");
}

/* above.txt: a valid vector of level 1; of higher levels a valid one, one with an error of pass 2,
 * and one with an error of pass 1, which no decoder may decline. */
static void levels_above(void **state)
{
    static const char list[] = "tests/above.txt";

    (void)state;
    expect_of(list, "good", 0, " 4 passed, 0 failed, 0 without answer, 0 missing, 0 declined");
    expect_of(list, "limit-above-1", 1,
              " 1 passed, 1 failed, 0 without answer, 0 missing, 2 declined");
}

static void version(void **state)
{
    char last[1024];

    (void)state;
    assert_int_equal(conf(last, sizeof last, "--version"), 0);
    assert_string_equal(last, "ted4conf " TED4_VERSION "\n");
}

/* Without a second run nothing is tested in its environment. */
static void options_in_vain(void **state)
{
    char last[1024];

    (void)state;
    assert_int_equal(conf(last, sizeof last, "run -d false --once --second TED4_KERNEL=plain"), 3);
    assert_non_null(strstr(said, "--second: goes without --once"));
    assert_int_equal(conf(last, sizeof last, "run -d false -t 0"), 3);
    assert_non_null(strstr(said, "--timeout: bad value 0; expected a whole number from 1"));
    assert_int_equal(
        conf(last, sizeof last, "run -d false -l conformance/lists/few.txt --html conformance"), 3);
    assert_string_equal(last, "ted4conf: conformance: Is a directory\n");
}

/* A list that includes another one, and lists that include each other. */
static void lists(void **state)
{
    static const char folder[] = "conformance/tests";
    char last[1024];

    (void)state;
    assert_int_equal(conf(last, sizeof last, "replay -l %s/nested.txt", folder), 0);
    assert_string_equal(last, "9 run, 0 failed\n");
    assert_int_equal(conf(last, sizeof last, "replay -l %s/circle.txt", folder), 3);
    assert_non_null(strstr(last, "circle.txt: cannot be read"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(recipes_give_the_published_bytes),
        cmocka_unit_test(nothing_is_left_out),
        cmocka_unit_test(truncation_at_every_byte),
        cmocka_unit_test(our_decoder_conforms),
        cmocka_unit_test(levels_conform),
        cmocka_unit_test(ways_agree),
        cmocka_unit_test(threads_agree),
        cmocka_unit_test(capabilities),
        cmocka_unit_test(lies),
        cmocka_unit_test(class_t),
        cmocka_unit_test(lenient_mode),
        cmocka_unit_test(no_answers),
        cmocka_unit_test(reasons),
        cmocka_unit_test(declining),
        cmocka_unit_test(claims),
        cmocka_unit_test(left_behind),
        cmocka_unit_test(missing_vectors),
        cmocka_unit_test(replay_without_files),
        cmocka_unit_test(limits),
        cmocka_unit_test(levels_above),
        cmocka_unit_test(version),
        cmocka_unit_test(options_in_vain),
        cmocka_unit_test(lists),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
