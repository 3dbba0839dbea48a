/* test_bad_scenes.c - ted4enc as a program, given unusable input: it prints one line on stderr that
 * begins with its name, exits with status 3, and leaves nothing in the folder of the output. A
 * valid scene of a few pixels shows that the others fail for their own reasons. The program is
 * taken from $TED4_BUILD (set by tests/run.sh); the test is skipped if that is not set.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <sys/wait.h>

#include "test.h"
#include "tiny_scene.h"

#define OUT    " -o out/x.ted4"
#define QUICK  " --preset draft --iterations 3,3 -j 1 -q"
#define POSE   "\"transform_matrix\": [[1,0,0,0],[0,1,0,0],[0,0,1,%d],[0,0,0,1]]"
#define FRAME  "{\"file_path\": \"%d.png\", \"time\": %d, \"fl_x\": 12, " POSE "}"
#define SECOND "{\"file_path\": \"1.png\", \"time\": 1, \"fl_x\": 12, "

enum { N_PICTURES = 3 };

static const char *build;
static tiny_folder folder;
static char err[4096]; /* stderr of the last run */

/* Runs ted4enc with these arguments, in the folder, without its progress messages. Returns its exit
 * status. */
static int run(const char *arguments)
{
    char command[2048];
    FILE *f;
    int status;

    snprintf(command, sizeof command, "cd '%s' && '%s'/ted4enc -q %s >out.txt 2>err.txt",
             folder.path, build, arguments);
    status = system(command);
    f = fopen(tiny_path(&folder, "err.txt"), "rb");
    assert_non_null(f);
    err[fread(err, 1, sizeof err - 1, f)] = 0;
    fclose(f);
    assert_true(WIFEXITED(status));
    return WEXITSTATUS(status);
}

static int files_in(const char *name)
{
    DIR *d = opendir(tiny_path(&folder, name));
    int n = -2; /* . and .. do not count */

    assert_non_null(d);
    while (readdir(d) != NULL)
        n++;
    closedir(d);
    return n;
}

/* what: part of the message. */
static void refuse(const char *arguments, const char *what)
{
    const int before = files_in("out");
    const int status = run(arguments);
    const char *end = strchr(err, '\n');

    if (status != 3 || strncmp(err, "ted4enc: ", 9) != 0 || end == NULL || end[1] != 0 ||
        strstr(err, what) == NULL)
        fail_msg("ted4enc %s: exit %d, stderr \"%s\", expected 3 and \"%s\"", arguments, status,
                 err, what);
    if (files_in("out") != before)
        fail_msg("ted4enc %s: left a file behind", arguments);
}

/* Writes a nerfstudio scene of three pictures with the given top object and second frame. */
static void scene(const char *name, const char *top, const char *second)
{
    tiny_string s = { "", 0 };
    char path[256];

    tiny_add(&s, "{%s\"frames\": [", top);
    for (int i = 0; i < N_PICTURES; i++) {
        if (i > 0)
            tiny_add(&s, ", ");
        if (i == 1 && second != NULL)
            tiny_add(&s, "%s", second);
        else
            tiny_add(&s, FRAME, i, i, i + 2);
        snprintf(path, sizeof path, "%s/%d.png", name, i);
        tiny_picture(&folder, path, TINY_W, TINY_H, 60 * i);
    }
    tiny_add(&s, "]}");
    snprintf(path, sizeof path, "%s/transforms.json", name);
    tiny_text(&folder, path, s.text);
}

/* The same as COLMAP text. */
static void colmap(const char *name, const char *camera, const char *image)
{
    char path[256];

    snprintf(path, sizeof path, "%s/sparse/0/cameras.txt", name);
    tiny_text(&folder, path, camera);
    snprintf(path, sizeof path, "%s/sparse/0/images.txt", name);
    tiny_text(&folder, path, image);
    snprintf(path, sizeof path, "%s/sparse/0/points3D.txt", name);
    tiny_text(&folder, path, "1 0 0 3 9 9 9 0.1 1 0\n2 0.5 0 3 9 9 9 0.1 1 0\n");
    snprintf(path, sizeof path, "%s/images/0.png", name);
    tiny_picture(&folder, path, TINY_W, TINY_H, 0);
}

static void cut(const char *name, size_t size)
{
    must(truncate(tiny_path(&folder, name), (off_t)size) == 0, name);
}

static int setup(void **state)
{
    (void)state;
    build = getenv("TED4_BUILD");
    if (build == NULL)
        return 0;
    folder = tiny_new();
    (void)tiny_path(&folder, "out/x.ted4");
    scene("good", "", NULL);
    return 0;
}

static int teardown(void **state)
{
    (void)state;
    if (build != NULL)
        tiny_free(&folder);
    return 0;
}

static void need_program(void)
{
    if (build == NULL) {
        print_message("skipped: TED4_BUILD is not set\n");
        skip();
    }
}

static void test_good(void **state)
{
    (void)state;
    need_program();
    assert_int_equal(run("good" OUT QUICK), 0);
    assert_string_equal(err, "");
    assert_int_equal(files_in("out"), 1);
    refuse("good" OUT QUICK, "out/x.ted4: exists; -f overwrites");
    assert_int_equal(run("good -f" OUT QUICK), 0);
    must(remove(tiny_path(&folder, "out/x.ted4")) == 0, "x.ted4");
}

static void test_pictures(void **state)
{
    (void)state;
    need_program();
    scene("missing", "", NULL);
    must(remove(tiny_path(&folder, "missing/1.png")) == 0, "1.png");
    assert_int_equal(run("missing" OUT QUICK), 0);
    must(remove(tiny_path(&folder, "out/x.ted4")) == 0, "x.ted4");
    assert_int_equal(run("missing --check -q"), 0);
    if (strncmp(err, "ted4enc: warning: 1 of 3 entries has no picture: ", 49) != 0 ||
        strstr(err, "frames[1]: 1.png\n") == NULL)
        fail_msg("stderr \"%s\"", err);
    must(remove(tiny_path(&folder, "missing/0.png")) == 0 &&
             remove(tiny_path(&folder, "missing/2.png")) == 0,
         "pictures");
    refuse("missing" OUT QUICK, "none of 3 entries has a picture; the first: "
                                "missing/transforms.json: frames[0]: 0.png");
    scene("cut", "", NULL);
    cut("cut/2.png", tiny_size(&folder, "cut/2.png") - 40);
    refuse("cut" OUT QUICK, "2.png: PNG");
    refuse("cut --check", "2.png: PNG");
    cut("cut/2.png", 20);
    refuse("cut" OUT QUICK, "2.png");
    cut("cut/2.png", 0);
    refuse("cut" OUT QUICK, "2.png");
    scene("large", "", NULL);
    refuse("large --downscale 13" OUT QUICK, "cannot be reduced by 13");
}

/* Both programs accept the same options about the scene. */
static void test_hold_out(void **state)
{
    char command[1024];

    (void)state;
    need_program();
    assert_int_equal(run("good --check --hold-out 2.png --alpha premultiplied"), 0);
    must(system(NULL) != 0, "a shell");
    snprintf(command, sizeof command, "grep -q '^pictures    2 train, 1 test$' '%s'",
             tiny_path(&folder, "out.txt"));
    assert_int_equal(system(command), 0);
    refuse("good --check --hold-out 9", "--hold-out 9: no camera or picture of this name, expected "
                                        "one of: 0.png, 1.png, 2.png");
    refuse("good --alpha wet" OUT, "--alpha: bad value wet");
    assert_int_equal(run("good --hold-out 2.png" OUT QUICK), 0);
    snprintf(
        command, sizeof command,
        "cd '%s' && '%s'/ted4eval out/x.ted4 good --hold-out 0 --hold-out 1.png --alpha straight "
        "--anyway --json -j 1 >out.txt 2>err.txt"
        " && grep -q '\"views\":2' out.txt",
        folder.path, build);
    assert_int_equal(system(command), 0);
    must(remove(tiny_path(&folder, "out/x.ted4")) == 0, "x.ted4");
}

/* The frame rate that a scene file states is found unchanged in the output. */
static void test_rate(void **state)
{
    static const char *const rates[][2] = { { "6", "3 at 6 per second" },
                                            { "23.976", "3 at 23.976 per second" },
                                            { "0.333", "3 at 0.333 per second" },
                                            { "29.97002997002997", "3 at 30000/1001 per second" } };
    char text[1024];

    (void)state;
    need_program();
    for (size_t i = 0; i < sizeof rates / sizeof *rates; i++) {
        snprintf(text, sizeof text, "\"fps\": %s, ", rates[i][0]);
        scene("rate", text, NULL);
        assert_int_equal(run("rate -f" OUT QUICK), 0);
        snprintf(text, sizeof text,
                 "cd '%s' && '%s'/ted4info out/x.ted4 | grep -qx 'frames      %s'", folder.path,
                 build, rates[i][1]);
        if (system(text) != 0)
            fail_msg("%s", rates[i][0]);
    }
    must(remove(tiny_path(&folder, "out/x.ted4")) == 0, "x.ted4");
}

static void test_cameras(void **state)
{
    (void)state;
    need_program();
    scene("fisheye", "\"camera_model\": \"OPENCV_FISHEYE\", ", NULL);
    refuse("fisheye" OUT QUICK, "OPENCV_FISHEYE");
    colmap("unknown", "1 WIDE 16 12 9 8 6\n", "1 1 0 0 0 0 0 0 1 0.png\n\n");
    refuse("unknown" OUT QUICK, "WIDE");
    colmap("nan", "1 SIMPLE_PINHOLE 16 12 9 8 6\n", "1 nan 0 0 0 0 0 0 1 0.png\n\n");
    refuse("nan" OUT QUICK, "images.txt:1");
    colmap("nan", "1 SIMPLE_PINHOLE 16 12 nan 8 6\n", "1 1 0 0 0 0 0 0 1 0.png\n\n");
    refuse("nan" OUT QUICK, "images/0.png: focal lengths nan");
    scene("null", "", SECOND "\"transform_matrix\": [[1,0,0,NaN],[0,1,0,0],[0,0,1,0],[0,0,0,1]]}");
    refuse("null" OUT QUICK, "transforms.json:1");
    scene("null", "", SECOND "\"transform_matrix\": [[1,0,0,null],[0,1,0,0],[0,0,1,0],[0,0,0,1]]}");
    refuse("null" OUT QUICK, "frames[1].transform_matrix");
    scene("null", "",
          SECOND "\"transform_matrix\": [[1,0,0,1e999],[0,1,0,0],[0,0,1,0],[0,0,0,1]]}");
    refuse("null" OUT QUICK, "transforms.json:1");
    scene("null", "", SECOND "\"transform_matrix\": [[0,0,0,0],[0,0,0,0],[0,0,0,0],[0,0,0,1]]}");
    refuse("null" OUT QUICK, "frames[1].transform_matrix");
}

static void test_empty(void **state)
{
    (void)state;
    need_program();
    tiny_text(&folder, "none/transforms.json", "{\"fl_x\": 12, \"frames\": []}");
    refuse("none" OUT QUICK, "frames");
    refuse("none --check", "frames");
    tiny_text(&folder, "none/transforms.json", "{}");
    refuse("none" OUT QUICK, "frames");
    tiny_text(&folder, "none/transforms.json", "");
    refuse("none" OUT QUICK, "transforms.json");
    colmap("still", "1 SIMPLE_PINHOLE 16 12 9 8 6\n", "# nothing\n");
    refuse("still" OUT QUICK, "has no pictures");
    (void)tiny_path(&folder, "bare/x");
    refuse("bare" OUT QUICK, "no scene recognised");
    refuse("nowhere" OUT QUICK, "no such folder");
    refuse("good/0.png" OUT QUICK, "no such folder");
}

static void test_output(void **state)
{
    char name[400], text[512];

    (void)state;
    need_program();
    memset(name, 'n', sizeof name - 1);
    name[sizeof name - 1] = 0;
    snprintf(text, sizeof text, "good -o out/%s.ted4" QUICK, name);
    refuse(text, "cannot be written");
    refuse("good -o good/0.png/x.ted4" QUICK, "cannot be written");
    refuse("good -o nowhere/x.ted4" QUICK, "cannot be written");
    refuse("good -o /proc/x.ted4" QUICK, "cannot be written");
    refuse("good -f -o /proc/version" QUICK, "-o /proc/version: expected a file name that ends in");
    refuse("good -o -" QUICK, "-o -: expected a file name that ends in .ted4");
    refuse("good -o out/x.mp4" QUICK, "-o out/x.mp4: expected a file name that ends in .ted4");
    refuse("good -o ''" QUICK, "expected a file name that ends in .ted4");
    (void)tiny_path(&folder, "folder.ted4/x");
    refuse("good -f -o folder.ted4" QUICK, "is a folder");
    refuse("good --checkpoint ''" OUT QUICK, "name is empty");
    refuse("good --checkpoint nowhere/c" OUT QUICK, "nowhere/c: cannot be written");
    refuse("good --log nowhere/l" OUT QUICK, "nowhere/l");
    tiny_text(&folder, "damaged", "not a checkpoint");
    refuse("good --checkpoint damaged --resume" OUT QUICK, "it is cut short or damaged");
    tiny_text(&folder, "out/there.ted4", "mine");
    refuse("good -o out/there.ted4" QUICK, "exists");
    assert_int_equal(tiny_size(&folder, "out/there.ted4"), 4);
}

static void test_options(void **state)
{
    static const char *const wrong[][2] = {
        { "-j x", "--threads: bad value x" },
        { "-j -1", "--threads: bad value -1" },
        { "--downscale 0", "--downscale" },
        { "--downscale 65", "--downscale: bad value 65" },
        { "--downscale 1.5", "--downscale" },
        { "--downscale ''", "--downscale" },
        { "--seed -1", "--seed" },
        { "--seed 99999999999999999999", "--seed" },
        { "--preset best", "--preset best" },
        { "--iterations 5", "--iterations" },
        { "--iterations 0,5", "stage1=0" },
        { "--iterations 5,-1", "stage2=-1" },
        { "--iterations a,b", "stage1=a" },
        { "--iterations 5,5,5", "stage2=5,5" },
        { "--iterations 10000001,5", "stage1=10000001: expected" },
        { "--iterations 5,10000001", "stage2=10000001: expected" },
        { "--lambda x", "lambda=x" },
        { "--lambda nan", "lambda=nan" },
        { "--lambda -1", "lambda=-1" },
        { "--lambda ''", "lambda=" },
        { "--set nothing=1", "nothing=1" },
        { "--set lambda", "lambda" },
        { "--set lambda=1e999", "lambda" },
        { "--resume", "--checkpoint" },
        { "--nothing", "nothing" },
        { "--preset", "preset" },
        { "good", "one scene folder" },
    };
    char text[256];

    (void)state;
    need_program();
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        snprintf(text, sizeof text, "good" OUT " %s", wrong[i][0]);
        refuse(text, wrong[i][1]);
    }
    refuse("", "one scene folder");
    refuse("good", "-o FILE.ted4 expected");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_good),     cmocka_unit_test(test_pictures),
        cmocka_unit_test(test_hold_out), cmocka_unit_test(test_rate),
        cmocka_unit_test(test_cameras),  cmocka_unit_test(test_empty),
        cmocka_unit_test(test_output),   cmocka_unit_test(test_options),
    };

    return cmocka_run_group_tests_name("bad scenes", tests, setup, teardown);
}
