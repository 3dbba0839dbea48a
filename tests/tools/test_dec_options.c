/* test_dec_options.c - the command line of ted4dec: verdicts and exit codes, what is refused and
 * how, defaults.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <jansson.h>
#include <math.h>

#include "norm/limits.h"
#include "tool_files.h"

static void test_verdicts(void **state)
{
    size_t size;

    (void)state;
    need_programs();
    for (int view = 0; view < 3; view++)
        assert_int_equal(run("ted4dec --test v%d.ted4", view), 0);
    assert_string_equal(out, "");
    assert_int_equal(run("ted4dec --test --json -q v1.ted4"), 0);
    json_t *const cost = json_loads(out, 0, NULL);
    assert_true(json_real_value(json_object_get(cost, "decode_ms")) > 0);
    assert_true(json_real_value(json_object_get(cost, "peak_mib")) > 1);
    json_decref(cost);
    uint8_t *const data = contents("v1.ted4", &size);

    data[size / 2] ^= 16;
    write_contents("bad.ted4", data, size);
    free(data);
    assert_int_equal(run("ted4dec --test --json bad.ted4"), 1);
    json_t *const report = json_loads(out, 0, NULL);
    assert_non_null(report);
    assert_string_equal(json_string_value(json_object_get(report, "verdict")), "invalid");
    assert_string_equal(json_string_value(json_object_get(report, "error")), "con.chunk-hash");
    assert_true(json_integer_value(json_object_get(report, "offset")) > 0);
    json_decref(report);
    assert_int_equal(run("ted4dec bad.ted4 -o x.ply --time 0"), 1);
    assert_false(exists("x.ply"));
    assert_int_equal(run("ted4dec missing.ted4"), 3);
    assert_string_equal(out, "");
    for (int i = 0; i < 3; i++) {
        static const char *const reader[] = { "ted4dec", "ted4info", "ted4eval missing.ted4" };

        assert_int_equal(run("%s missing.ted4 --json", reader[i]), 3);
        json_t *const said = json_loads(out, 0, NULL);

        assert_string_equal(json_string_value(json_object_get(said, "verdict")), "io");
        assert_string_equal(json_string_value(json_object_get(said, "error")), "io.read");
        assert_string_equal(json_string_value(json_object_get(said, "text")),
                            "No such file or directory");
        json_decref(said);
    }
    assert_int_equal(run("ted4dec --ted4-run missing.ted4 --tiers T0"), 0);
    assert_non_null(strstr(out, "\"io.read\""));
    assert_int_equal(run("cat v1.ted4 | ted4dec - --hash"), 0);
    assert_int_equal(run("ted4dec -h"), 0);
    assert_non_null(strstr(out, "--sh-degree N"));
}

/* What is no TED4 file is refused by its beginning: a film of gigabytes, or a device without end,
 * would fill the memory. */
static void test_no_such_format(void **state)
{
    static const char *const reader[] = { "ted4dec -", "ted4info -", "ted4eval - .",
                                          "ted4edit - -o new.ted4 --title x",
                                          "ted4enc --transcode - -o new.ted4" };
    size_t size;

    (void)state;
    need_programs();
    for (size_t i = 0; i < sizeof reader / sizeof *reader; i++) {
        assert_int_equal(run("{ head -c 100000000 /dev/zero && : >all; } | %s", reader[i]), 1);
        assert_false(exists("all"));
        char *const err = (char *)contents("err", &size);

        err[size] = '\0';
        assert_non_null(strstr(err, "byte 0: not a TED4 file [con.magic]"));
        free(err);
    }
    assert_int_equal(run("head -c 1000000 /dev/zero | ted4info - --validate --json"), 1);
    assert_non_null(strstr(out, "\"bytes\":1000000"));
}

/* Pipes a file and so many zeros into ted4dec. Returns 1 if it was refused with that error and no
 * other, else 0. */
static int refused_longer(const char *name, unsigned long long zeros, const char *error)
{
    size_t size;

    if (run("{ cat %s; head -c %llu /dev/zero && : >all; } | ted4dec -", name, zeros) != 1)
        return 0;
    char *const err = (char *)contents("err", &size);

    err[size] = '\0';
    const int found = strstr(err, error) != NULL && strchr(err, '\n') == err + size - 1;

    free(err);
    return found;
}

/* No more is read of a stream than a file of its level may have, and a bit: it is refused then,
 * whatever follows. Up to that the verdict is that of a file. */
static void test_endless(void **state)
{
    enum { LEVEL_AT = 11 };
    char trailing[100];
    size_t size;

    (void)state;
    need_programs();
    uint8_t *const data = contents("v1.ted4", &size);

    snprintf(trailing, sizeof trailing, "byte %zu: bytes after the last chunk [con.trailing]",
             size);
    for (unsigned level = 1; level <= 3; level++) {
        const unsigned long long most = ted4_limits_of(level)->file_bytes;

        data[LEVEL_AT] = (uint8_t)level;
        write_contents("level.ted4", data, size);
        assert_int_equal(run("ted4dec level.ted4"), 0);
        assert_true(refused_longer("level.ted4", 1, trailing));
        assert_true(refused_longer("level.ted4", most - size, trailing));
        assert_true(refused_longer("level.ted4", most - size + 1, "byte 11: "));
        assert_int_equal(run("rm all"), 0);
        assert_true(refused_longer("level.ted4", 3 * most, "[lvl.exceeded]"));
        assert_false(exists("all"));
    }
    /* Level 31 has no bound, and a level that does not exist is an error of its own. */
    data[LEVEL_AT] = TED4_LEVEL_UNBOUNDED;
    write_contents("level.ted4", data, size);
    assert_true(refused_longer("level.ted4", 20000000, trailing));
    data[LEVEL_AT] = 7;
    write_contents("level.ted4", data, size);
    assert_int_equal(run("rm all"), 0);
    assert_true(refused_longer("level.ted4", 1000000, "byte 11: "));
    assert_false(exists("all"));
    free(data);
}

/* Runs ted4dec, which must end with status 3 and one line on stderr that holds the text. */
static void expect_refusal(const char *arguments, const char *text)
{
    const int status = run("ted4dec %s", arguments);
    size_t size;
    char *const err = (char *)contents("err", &size);

    err[size] = '\0';
    if (status != 3 || strstr(err, text) == NULL || strchr(err, '\n') != err + size - 1)
        fail_msg("%s: status %d: %s", arguments, status, err);
    free(err);
}

/* Arguments, and a part of the one line that refuses them. */
static const char *const wrong[][2] = {
    { "", "expected one file, found 0" },
    { "v1.ted4 v0.ted4 --hash", "expected one file, found 2" },
    { "v1.ted4 out.ply", "expected one file; -o out.ply writes Gaussians" },
    { "v1.ted4 -o a.doc", "bad value a.doc; expected a name that ends in .ply, .splat, .glb or" },
    { "v1.ted4 -o a%s.ply", "a%s.ply; expected at most one %d" },
    { "v1.ted4 -o a.ply", "several frames need a %d in the name" },
    { "v1.ted4 -o -", "-o -: standard output takes one frame; --time or --frames says which" },
    { "v1.ted4 -o missing/a%d.ply", "missing/a0.ply: No such file" },
    { "v1.ted4 --hash --frames 0:999", "--frames" },
    { "v1.ted4 --hash --frames 1 --time 0", "only one of them" },
    { "v1.ted4 --time 1.5", "--time: bad value 1.5; expected seconds, as 1.5s, or 0 to 1" },
    { "v1.ted4 --render a.png", "--render: goes with one of --camera, --orbit and --path" },
    { "v1.ted4 --render a.png --orbit 3 --path a.json", "goes with one of" },
    { "v1.ted4 --orbit 3", "only with --render" },
    { "v1.ted4 --render a.png --orbit 0", "--orbit: bad value 0; expected a whole number from 1" },
    { "v1.ted4 --render a.png --orbit 1 --views 3", "--views: only with --path" },
    { "v1.ted4 --render a.png --orbit 2", "several cameras need a %d in the name" },
    { "v1.ted4 --sh-degree 4", "--sh-degree: bad value 4; expected a whole number from 0 to 3" },
    { "v1.ted4 -j x", "--threads: bad value x; expected a whole number from 0 to 256" },
    { "v1.ted4 -j 257", "--threads" },
    { "v1.ted4 --frames 2-4", "--frames: bad value 2-4; expected one frame, or A:B:STEP" },
    { "v1.ted4 --max-memory 1G", "--max-memory: bad value 1G; expected a whole number from 1" },
    { "v1.ted4 --test --trace --json", "only one of them" },
    { "v1.ted4 --test -o a.ply --time 0", "--test" },
    { "v1.ted4 --camera-centre 1,2", "--camera-centre: bad value 1,2; expected three" },
    { "v1.ted4 -o missing/a.ply --time 0", "missing/a.ply" },
    { "v1.ted4 --render a.png --camera v1.ted4", "v1.ted4: line 1: " },
    { "v1.ted4 --render a.png --camera nope.json", "nope.json: No such file or directory" },
    /* What would have no effect. */
    { "v1.ted4 --render a.png --camera x.json --frames 0", "--frames: only with -o or --hash" },
    { "v1.ted4 --render a.jpg --camera x.json",
      "--render: bad value a.jpg; expected a name that ends in .png or .mp4" },
    { "v1.ted4 --time 0", "--time: only with -o, --hash or --render" },
    { "v1.ted4 --test --frames 0", "--frames: only with -o or --hash" },
    { "v1.ted4 --keep-all", "--keep-all: only with -o" },
    { "v1.ted4 --up z", "--up: only with -o" },
    { "v1.ted4 --up z --time 0 -o a.raw", ".raw holds the records as they were decoded" },
    { "v1.ted4 --up z --time 0 -o - --format raw", ".raw holds the records as they were" },
    { "v1.ted4 --widen", "--widen: only with -o" },
    { "v1.ted4 --widen --time 0 -o a.raw", ".raw holds the records as they were decoded" },
    { "v1.ted4 --widen --time 0 -o a.ply", "the file has none (ted4enc --cameras)" },
    { "v1.ted4 --up up --time 0 -o a.ply", "--up: bad value up; expected x, y, z, -x, -y" },
    { "v1.ted4 --up auto --time 0 -o a.ply", "does not say which way is up" },
    { "v1.ted4 --drop-faint", "--drop-faint: only with -o" },
    { "v1.ted4 -o a.ply --time 0 --keep-all --drop-faint", "only one of them" },
    { "v1.ted4 --hash --sh-degree 1", "--sh-degree: only with -o" },
    { "v1.ted4 --hash --camera-centre 1,2,3", "--hash needs --frames or --time" },
    { "v1.ted4 --time 0 -o a.raw --sh-degree 0", "more than .raw can hold" },
    { "v1.ted4 --time 0 -o a.splat --sh-degree 1", "more than .splat can hold" },
    { "v1.ted4 --time 0 -o a.ply --camera-centre 1,2,3", "--camera-centre: has no effect: sph" },
    { "v0.ted4 --time 0 -o a.ply --camera-centre 1,2,3", "--camera-centre: has no effect: noth" },
    { "v0.ted4 --time 0 -o a.raw --camera-centre 1,2,3", "--camera-centre: has no effect: noth" },
    { "v1.ted4 --time 0 -o a.ply -o a.splat", "ted4dec: -o: only once" },
    { "v1.ted4 --render a.png --render b.png --orbit 1", "ted4dec: --render: only once" },
    { "v1.ted4 --render a.png --camera x.json --camera y.json", "ted4dec: --camera: only once" },
    { "v1.ted4 --render a.png --path x.json --path x.json", "ted4dec: --path: only once" },
    { "v1.ted4 -q -v", "-q and -v" },
};

static void test_usage(void **state)
{
    (void)state;
    need_programs();
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        expect_refusal(wrong[i][0], wrong[i][1]);
    assert_int_equal(run("ted4dec v1.ted4 --nothing"), 3);
    assert_int_equal(run("ted4dec v1.ted4 -o"), 3);
}

/* A query without a result says nothing against the file (R-ERR-008), and has no offset in it. */
static void test_no_result(void **state)
{
    char arguments[1300];

    (void)state;
    need_programs();
    snprintf(arguments, sizeof arguments,
             "'%s/conformance/vectors/valid/view/VIW-far-camera.ted4' --hash --time 0 --json",
             root());
    expect_refusal(arguments, "VIW-far-camera.ted4: this time and camera have no result "
                              "[rec.non-finite] (specification 12.2)");
    json_t *const report = json_loads(out, 0, NULL);

    assert_string_equal(json_string_value(json_object_get(report, "verdict")), "valid");
    assert_string_equal(json_string_value(json_object_get(report, "error")), "rec.non-finite");
    assert_string_equal(json_string_value(json_object_get(report, "text")),
                        "this time and camera have no result");
    assert_null(json_object_get(report, "offset"));
    json_decref(report);
}

/* A truncated file of which nothing is recovered because a limit is in the way is not refused for
 * being truncated: with more memory or work it would be recovered. Whether it is the file that
 * takes too much, or, without an offset in it, what is made of it for queries. */
static void test_lenient_limits(void **state)
{
    unsigned made = 0;
    size_t size;

    (void)state;
    need_programs();
    uint8_t *const data = contents("v1.ted4", &size);

    write_contents("cut.ted4", data, size - 1);
    free(data);
    expect_refusal("cut.ted4 --lenient --max-work 100", "[limit.work]");
    assert_int_equal(run("ted4dec cut.ted4 --max-memory 5000"), 1);
    for (unsigned bytes = 5000; run("ted4dec cut.ted4 --lenient --max-memory %u", bytes) != 2;
         bytes += bytes / 16) {
        char *const err = (char *)contents("err", &size);

        err[size] = '\0';
        const int is_made = strstr(err, ": incomplete: tiles 0 to ") != NULL;

        if (strstr(err, is_made ? ": byte 0: needs more memory than allowed or available [limit."
                                : "[limit.memory] (specification 13)\n") == NULL)
            fail_msg("%u bytes: %s", bytes, err);
        made += (unsigned)is_made;
        free(err);
        assert_int_equal(run("ted4dec cut.ted4 --lenient --max-memory %u", bytes), 3);
    }
    assert_true(made > 0);
}

/* Without --sh-degree: 1 where colours depend on the view, else 0. */
static void test_default_degree(void **state)
{
    static const char *const last[3] = { "f_dc_2\nproperty float opacity",
                                         "f_rest_8\nproperty float opacity",
                                         "f_rest_8\nproperty float opacity" };

    (void)state;
    need_programs();
    for (int view = 0; view < 3; view++) {
        char name[32];
        size_t size;

        assert_int_equal(run("ted4dec v%d.ted4 -o degree%d.ply --time 0", view, view),
                         view == 2 ? 2 : 0);
        snprintf(name, sizeof name, "degree%d.ply", view);
        uint8_t *const ply = contents(name, &size);

        assert_non_null(strstr((const char *)ply, last[view]));
        free(ply);
    }
}

/* Widened scales are those of the records and a pixel of the file's camera, here of width 1. */
static void test_widen(void **state)
{
    static const char camera[] = "[{\"width\": 2, \"height\": 2, \"fx\": 1, \"fy\": 1, \"cx\": 1, "
                                 "\"cy\": 1, \"R\": [1,0,0,0,1,0,0,0,1], \"t\": [0,0,0]}]";
    const double e = ldexp(1.0, file[1].info.exponent);
    size_t size;

    (void)state;
    need_programs();
    write_contents("wide.json", (const uint8_t *)camera, strlen(camera));
    assert_int_equal(run("ted4edit v1.ted4 -o wide.ted4 --cameras wide.json && "
                         "ted4dec wide.ted4 -o wide%%d.splat --time 0 --widen && "
                         "ted4dec wide.ted4 -o thin%%d.splat --time 0"),
                     0);
    uint8_t *const wide = contents("wide0.splat", &size), *const thin =
                                                              contents("thin0.splat", &size);

    for (size_t i = 0; i < file[1].info.n_gaussians; i++) {
        float mean[3], was[3], is[3];

        memcpy(mean, wide + i * 32, sizeof mean);
        memcpy(was, thin + i * 32 + 12, sizeof was);
        memcpy(is, wide + i * 32 + 12, sizeof is);
        const double x = (double)mean[0], y = (double)mean[1], z = (double)mean[2];
        const int is_seen = z > 0.02 * e && fabs(x) <= 1.3 * z && fabs(y) <= 1.3 * z;
        const double width = is_seen ? z : sqrt(x * x + y * y + z * z);

        for (int k = 0; k < 3; k++) {
            const double want = sqrt((double)was[k] * (double)was[k] + 0.3 * width * width);

            assert_true(fabs((double)is[k] - want) < 1e-5 * want);
        }
    }
    free(wide);
    free(thin);
}

/* Z up in the scene: exports have -Y up, with the same records; glTF has +Y up. */
static void test_up(void **state)
{
    size_t size, raw_size;

    (void)state;
    need_programs();
    assert_int_equal(run("ted4dec v1.ted4 -o z.splat --time 0 --up z --sh-degree 0"), 0);
    assert_int_equal(run("ted4dec v1.ted4 -o z%%d.splat --time 0 --up z --sh-degree 0"), 0);
    assert_int_equal(run("ted4dec v1.ted4 -o z.raw --time 0 --keep-all"), 0);
    uint8_t *const splat = contents("z0.splat", &size), *const raw = contents("z.raw", &raw_size);

    for (size_t i = 0; i < file[1].info.n_gaussians; i++) {
        float from[3], to[3];

        memcpy(from, raw + i * 56, sizeof from);
        memcpy(to, splat + i * 32, sizeof to);
        assert_true(to[0] == from[0]);
        assert_true(to[1] == -from[2]);
        assert_true(to[2] == from[1]);
    }
    free(splat);
    free(raw);
    /* What the file says is what the option says; without it, a note tells. */
    assert_int_equal(run("ted4edit v1.ted4 -o up.ted4 --up 0,0,1"), 0);
    assert_int_equal(run("ted4dec up.ted4 -o auto.ply --time 0 --up auto && "
                         "ted4dec v1.ted4 -o z.ply --time 0 --up z && cmp auto.ply z.ply && "
                         "grep -qa 'comment world axes: .*turned so that 0 0 1 of the' z.ply && "
                         "ted4dec v1.ted4 -o g.glb --time 0 --up z && "
                         "ted4dec up.ted4 -o note.ply --time 0 2>note && "
                         "grep -q 'note: up is 0 0 1 in this scene.*--up auto' note && "
                         "grep -qa 'comment world axes: .*of the scene: up is 0 0 1' note.ply"),
                     0);
    /* glTF: position (x, y, z) of a scene with Z up becomes (x, z, -y), and scales follow. */
    uint8_t *const glb = contents("g.glb", &size);
    char *const low = strstr((char *)glb + 20, "\"min\":[");
    double box[3];

    assert_non_null(low);
    assert_int_equal(sscanf(low + 7, "%lf,%lf,%lf", &box[0], &box[1], &box[2]), 3);
    uint8_t *const kept = contents("z.ply", &size);
    const uint8_t *const values = (uint8_t *)strstr((char *)kept, "end_header\n") + 11;
    const size_t record = 4 * (17 + 9);
    double least = 1e30;

    for (const uint8_t *p = values; p < kept + size; p += record) {
        float y;

        memcpy(&y, p + 4, sizeof y);
        least = -(double)y < least ? -(double)y : least; /* in PLY, -y is up */
    }
    assert_true(least == box[1] || (float)least == (float)box[1]);
    free(glb);
    free(kept);
}

static size_t count(const char *text, char c)
{
    size_t n = 0;

    for (; *text != '\0'; text++)
        n += *text == c;
    return n;
}

/* Several files: each is checked, and the worst exit code stays. */
static void test_several(void **state)
{
    (void)state;
    need_programs();
    write_contents("bad.ted4", "no", 2);
    assert_int_equal(run("ted4dec v0.ted4 v1.ted4 v2.ted4 --test"), 0);
    assert_int_equal(run("ted4dec v0.ted4 bad.ted4 v1.ted4 --json 2>/dev/null"), 1);
    assert_int_equal(count(out, '\n'), 3);
    assert_int_equal(run("ted4dec v0.ted4 v1.ted4 2>&1 | grep -c 'peak memory so far '"), 0);
    assert_string_equal(out, "2\n");
    assert_int_equal(run("ted4dec v0.ted4 missing.ted4 bad.ted4 v1.ted4"), 3);
    assert_int_equal(run("ted4info v0.ted4 bad.ted4 v1.ted4"), 1);
    assert_non_null(strstr(out, "v0.ted4: TED4"));
    assert_non_null(strstr(out, "\nv1.ted4: TED4"));
    assert_int_equal(run("ted4info v0.ted4 v1.ted4 --budget --json"), 0);
    assert_int_equal(count(out, '\n'), 2);
    assert_int_equal(run("ted4info v0.ted4 v1.ted4 --cameras"), 3);
    assert_int_equal(run("ted4info"), 3);
}

/* Seconds are those of R-MED-001. */
static void test_seconds(void **state)
{
    const ted4_info *const info = &file[1].info;
    const double last = (double)(info->frames - 1) * info->rate_den / info->rate_num;
    char first[MAX_TEXT];

    (void)state;
    need_programs();
    assert_int_equal(run("ted4dec v1.ted4 --hash --frames %u", (unsigned)(info->frames - 1)), 0);
    strcpy(first, strstr(out, ",0 ") != NULL ? strrchr(out, ' ') : "");
    assert_int_equal(run("ted4dec v1.ted4 --hash --time %.7fs", fmin(last + 1.0, 999999.0)), 0);
    assert_string_equal(strrchr(out, ' '), first);
    assert_int_equal(run("ted4info v1.ted4 --json"), 0);
    json_t *const o = json_loads(out, 0, NULL);

    assert_true(fabs(json_number_value(json_object_get(o, "seconds")) - last) <= 1e-6 * last);
    assert_string_equal(json_string_value(json_object_get(o, "profile")), "main");
    json_decref(o);
}

/* Help fits a terminal, and has an example. */
static void test_help(void **state)
{
    static const char *const program[] = { "ted4dec", "ted4info", "ted4enc", "ted4eval",
                                           "ted4edit" };

    (void)state;
    need_programs();
    for (size_t i = 0; i < sizeof program / sizeof *program; i++) {
        assert_int_equal(run("%s --help", program[i]), 0);
        assert_non_null(strstr(out, "\nExamples:\n"));
        for (const char *line = out; *line != '\0';) {
            const size_t n = strcspn(line, "\n");

            if (n > 80)
                fail_msg("%s: %.*s", program[i], (int)n, line);
            line += n + (line[n] == '\n');
        }
    }
}

/* Of several files the gravest verdict counts, and a refusal is graver than a warning: whoever
 * accepts files with warnings must not accept one that is refused. */
static void test_gravest(void **state)
{
    char warned[1200];
    size_t size;

    (void)state;
    need_programs();
    snprintf(warned, sizeof warned, "'%s/conformance/vectors/content/CNT-pop-0.002.ted4'", root());
    uint8_t *const data = contents("v1.ted4", &size);

    write_contents("cut.ted4", data, size - 1);
    write_contents("short.ted4", data, 40);
    free(data);
    assert_int_equal(run("ted4dec --test --lenient cut.ted4"), 2);
    assert_int_equal(run("ted4dec --test --lenient short.ted4"), 1);
    assert_int_equal(run("ted4dec --test --lenient cut.ted4 short.ted4 v1.ted4"), 1);
    assert_int_equal(run("ted4dec --test --lenient short.ted4 cut.ted4"), 1);
    assert_int_equal(run("ted4dec --test --lenient v1.ted4 cut.ted4 v1.ted4"), 2);
    assert_int_equal(run("ted4dec --test --lenient short.ted4 missing.ted4 cut.ted4"), 3);
    assert_int_equal(run("ted4info --validate %s", warned), 2);
    assert_int_equal(run("ted4info --validate %s short.ted4", warned), 1);
    assert_int_equal(run("ted4info --validate short.ted4 %s", warned), 1);
    assert_int_equal(run("ted4info --validate short.ted4 %s missing.ted4", warned), 3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_verdicts),       cmocka_unit_test(test_usage),
        cmocka_unit_test(test_default_degree), cmocka_unit_test(test_up),
        cmocka_unit_test(test_widen),          cmocka_unit_test(test_several),
        cmocka_unit_test(test_seconds),        cmocka_unit_test(test_help),
        cmocka_unit_test(test_no_such_format), cmocka_unit_test(test_endless),
        cmocka_unit_test(test_gravest),        cmocka_unit_test(test_no_result),
        cmocka_unit_test(test_lenient_limits),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
