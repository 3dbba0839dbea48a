/* test_export.c - the files that ted4dec writes, read back field by field. The programs' helpers
 * are in no library, so their sources are included here.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <dirent.h>
#include <jansson.h>
#include <math.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "test.h"
#include "base/bytes.h"
#include "random_source.h"
#include "temporary.h"
#include "tool/export.h"
#include "tool/leftovers.h"
#include "tool/output.h"
#include "tool/sh.h"

enum { N = 37 };

static char folder[TEMPORARY_SIZE];
static random_source source = { 3 };

static double uniform(double low, double high)
{
    return low + (high - low) * random_unit(&source);
}

/* Random Gaussians with unit rotations. */
typedef struct {
    float column[14][N], sh[N * 3 * TED4_SH_MAX_COEFS];
    ted4_frame frame;
} set;

static void make(set *s, size_t n, int degree)
{
    *s = (set) { .frame = { .n = n, .opacity = s->column[10], .sh_degree = degree, .sh = s->sh } };
    s->frame.comment = "one line\nanother: %d\n";
    for (size_t i = 0; i < n; i++) {
        double length = 0.0;

        for (int k = 0; k < 14; k++)
            s->column[k][i] = (float)(k < 3    ? uniform(-9.0, 9.0)
                                      : k < 6  ? exp(uniform(-6.0, 0.0))
                                      : k < 10 ? uniform(-1.0, 1.0)
                                               : uniform(0.0, 1.0));
        for (int k = 6; k < 10; k++)
            length += pow((double)s->column[k][i], 2.0);
        for (int k = 6; k < 10; k++)
            s->column[k][i] = (float)((double)s->column[k][i] / sqrt(length));
        for (int k = 0; k < 3 * ted4_sh_count(degree); k++)
            s->sh[i * 3 * (size_t)ted4_sh_count(degree) + (size_t)k] = (float)uniform(-0.6, 0.6);
    }
    for (int k = 0; k < 4; k++)
        s->frame.rot[k] = s->column[6 + k];
    for (int k = 0; k < 3; k++) {
        s->frame.mean[k] = s->column[k];
        s->frame.scale[k] = s->column[3 + k];
        s->frame.colour[k] = s->column[11 + k];
    }
}

/* Writes the format of the file name's suffix, and reads the bytes back. */
static uint8_t *written(const ted4_frame *x, const char *name, size_t *size)
{
    char path[256];
    uint8_t *data;
    FILE *f;

    snprintf(path, sizeof path, "%s/%s", folder, name);
    assert_int_equal(ted4_export(ted4_format_find(path), x, path), 0);
    f = fopen(path, "rb");
    assert_non_null(f);
    data = malloc(1 << 20);
    assert_non_null(data);
    *size = fread(data, 1, 1 << 20, f);
    fclose(f);
    remove(path);
    return data;
}

static float float_at(const uint8_t *p)
{
    return ted4_bits_float(ted4_load32(p));
}

/* ---- PLY ---- */

static void expect_line(const uint8_t **p, const char *line)
{
    const size_t n = strlen(line);

    assert_memory_equal(*p, line, n);
    assert_int_equal((*p)[n], '\n');
    *p += n + 1;
}

static const uint8_t *expect_ply_header(const uint8_t *p, size_t n, int n_rest)
{
    static const char *const before[] = { "x",  "y",      "z",      "nx",    "ny",
                                          "nz", "f_dc_0", "f_dc_1", "f_dc_2" };
    static const char *const after[] = { "opacity", "scale_0", "scale_1", "scale_2",
                                         "rot_0",   "rot_1",   "rot_2",   "rot_3" };
    char line[64];

    expect_line(&p, "ply");
    expect_line(&p, "format binary_little_endian 1.0");
    snprintf(line, sizeof line, "element vertex %zu", n);
    expect_line(&p, line);
    for (size_t i = 0; i < 9; i++) {
        snprintf(line, sizeof line, "property float %s", before[i]);
        expect_line(&p, line);
    }
    for (int i = 0; i < n_rest; i++) {
        snprintf(line, sizeof line, "property float f_rest_%d", i);
        expect_line(&p, line);
    }
    for (size_t i = 0; i < 8; i++) {
        snprintf(line, sizeof line, "property float %s", after[i]);
        expect_line(&p, line);
    }
    expect_line(&p, "comment one line");
    expect_line(&p, "comment another: %d");
    expect_line(&p, "end_header");
    return p;
}

static void check_ply_record(const float *v, const set *s, size_t i, int n_rest)
{
    const int n_coefs = 1 + n_rest / 3;
    const float *const sh = s->sh + i * 3 * (size_t)n_coefs, *const tail = v + 9 + n_rest;

    for (int c = 0; c < 3; c++) {
        assert_true(v[c] == s->column[c][i]);
        assert_true(v[3 + c] == 0.0f);
        assert_true(v[6 + c] == sh[c * n_coefs]);
        assert_true(fabsf(expf(tail[1 + c]) / s->column[3 + c][i] - 1.0f) < 1e-5f);
        for (int k = 1; k < n_coefs; k++) /* all of red, then green, then blue */
            assert_true(v[9 + c * (n_coefs - 1) + k - 1] == sh[c * n_coefs + k]);
    }
    assert_true(fabs(1.0 / (1.0 + exp(-(double)tail[0])) - (double)s->column[10][i]) < 2e-6);
    for (int c = 0; c < 4; c++)
        assert_true(tail[4 + c] == s->column[6 + c][i]);
}

static void test_ply(void **state)
{
    (void)state;
    for (int degree = 0; degree <= 3; degree++) {
        const int n_rest = 3 * ((degree + 1) * (degree + 1) - 1);
        const size_t n_floats = 17 + (size_t)n_rest;
        size_t size;
        set s;

        make(&s, N, degree);
        s.column[10][0] = 0.0f;
        s.column[10][1] = 1.0f;
        uint8_t *const data = written(&s.frame, "a.ply", &size);
        const uint8_t *p = expect_ply_header(data, N, n_rest);

        assert_int_equal(data + size - p, N * 4 * n_floats);
        for (size_t i = 0; i < N; i++) {
            float v[62];

            for (size_t k = 0; k < n_floats; k++, p += 4)
                assert_true(isfinite(v[k] = float_at(p)));
            check_ply_record(v, &s, i, n_rest);
        }
        free(data);
    }
}

/* ---- raw, splat ---- */

static void test_raw(void **state)
{
    size_t size;
    set s;

    (void)state;
    make(&s, N, 0);
    uint8_t *const data = written(&s.frame, "a.raw", &size);

    assert_int_equal(size, N * 56);
    for (size_t i = 0; i < N; i++)
        for (size_t k = 0; k < 14; k++)
            assert_true(float_at(data + i * 56 + k * 4) == s.column[k][i]);
    free(data);
}

static int near_byte(uint8_t got, double want)
{
    return fabs(got - fmin(fmax(want, 0.0), 255.0)) <= 0.5 + 1e-3;
}

static void test_splat(void **state)
{
    double last = INFINITY;
    int seen[N] = { 0 };
    size_t size;
    set s;

    (void)state;
    make(&s, N, 1);
    uint8_t *const data = written(&s.frame, "a.splat", &size);

    assert_int_equal(size, N * 32);
    for (const uint8_t *p = data; p < data + size; p += 32) {
        size_t i = 0;

        while (i < N && float_at(p) != s.column[0][i])
            i++;
        assert_true(i < N);
        assert_int_equal(seen[i]++, 0);
        const double weight = (double)s.column[3][i] * (double)s.column[4][i] *
                              (double)s.column[5][i] * (double)s.column[10][i];

        assert_true(weight <= last);
        last = weight;
        for (size_t c = 0; c < 3; c++) {
            assert_true(float_at(p + 4 * c) == s.column[c][i]);
            assert_true(float_at(p + 12 + 4 * c) == s.column[3 + c][i]);
            assert_true(near_byte(
                p[24 + c], 255.0 * (0.5 + 0.28209479177387814 * (double)s.sh[(i * 3 + c) * 4])));
        }
        assert_true(near_byte(p[27], 255.0 * (double)s.column[10][i]));
        for (size_t c = 0; c < 4; c++)
            assert_true(near_byte(p[28 + c], 128.0 + 128.0 * (double)s.column[6 + c][i]));
    }
    free(data);
}

/* Gaussians that weigh the same stay in the order of the scene; here each one of five weights, the
 * heaviest of which are the last of every five. */
static void test_splat_ties(void **state)
{
    size_t size;
    set s;

    (void)state;
    make(&s, N, 0);
    for (size_t i = 0; i < N; i++) {
        s.column[3][i] = s.column[4][i] = s.column[5][i] = 0.5f;
        s.column[10][i] = 0.125f * (float)(i % 5 + 1);
    }
    uint8_t *const data = written(&s.frame, "a.splat", &size);
    const uint8_t *p = data;

    assert_int_equal(size, N * 32);
    for (size_t rest = 5; rest-- > 0;)
        for (size_t i = rest; i < N; i += 5, p += 32)
            assert_true(float_at(p) == s.column[0][i]);
    free(data);
}

/* ---- glTF ---- */

/* q: w x y z. */
static void rotate(const double q[4], const double v[3], double out[3])
{
    const double w = q[0], x = q[1], y = q[2], z = q[3];

    out[0] = (1 - 2 * (y * y + z * z)) * v[0] + 2 * (x * y - w * z) * v[1] +
             2 * (x * z + w * y) * v[2];
    out[1] = 2 * (x * y + w * z) * v[0] + (1 - 2 * (x * x + z * z)) * v[1] +
             2 * (y * z - w * x) * v[2];
    out[2] = 2 * (x * z - w * y) * v[0] + 2 * (y * z + w * x) * v[1] +
             (1 - 2 * (x * x + y * y)) * v[2];
}

typedef struct {
    json_t *json;
    const uint8_t *data;
} glb;

static glb open_glb(const uint8_t *data, size_t size)
{
    const uint32_t length = ted4_load32(data + 12);
    glb g;

    assert_memory_equal(data, "glTF\2\0\0\0", 8);
    assert_int_equal(ted4_load32(data + 8), size);
    assert_memory_equal(data + 16, "JSON", 4);
    assert_int_equal(length % 4, 0);
    g.json = json_loadb((const char *)data + 20, length, JSON_REJECT_DUPLICATES, NULL);
    assert_non_null(g.json);
    g.data = data + 20 + length;
    if (g.data == data + size)
        return g;
    assert_memory_equal(g.data + 4, "BIN\0", 4);
    assert_int_equal(ted4_load32(g.data), (size_t)(data + size - g.data) - 8);
    g.data += 8;
    return g;
}

/* Returns the accessor of an attribute, with its bytes. */
static const uint8_t *attribute(const glb *g, const char *name, const char *type, int component,
                                const json_t **accessor)
{
    const json_t *const primitive = json_array_get(
        json_object_get(json_array_get(json_object_get(g->json, "meshes"), 0), "primitives"), 0);
    const json_t *const place = json_object_get(json_object_get(primitive, "attributes"), name);

    assert_true(json_is_integer(place));
    *accessor =
        json_array_get(json_object_get(g->json, "accessors"), (size_t)json_integer_value(place));
    assert_string_equal(json_string_value(json_object_get(*accessor, "type")), type);
    assert_int_equal(json_integer_value(json_object_get(*accessor, "componentType")), component);
    assert_int_equal(json_integer_value(json_object_get(*accessor, "count")), N);
    const json_t *const view =
        json_array_get(json_object_get(g->json, "bufferViews"),
                       (size_t)json_integer_value(json_object_get(*accessor, "bufferView")));

    return g->data + json_integer_value(json_object_get(view, "byteOffset"));
}

/* Converts v to glTF's axes: y up, z backwards. */
static void turned(const double v[3], double out[3])
{
    out[0] = v[0];
    out[1] = -v[1];
    out[2] = -v[2];
}

/* The colour of degree 0 as a linear intensity, found by bisection of the other direction. */
static double base_colour(const set *s, size_t i, size_t c)
{
    const size_t n_coefs = (size_t)ted4_sh_count(s->frame.sh_degree);
    const double encoded = 0.5 + TED4_SH_C0 * (double)s->sh[(i * 3 + c) * n_coefs];
    double low = 0.0, high = 1.0;

    for (int k = 0; k < 40; k++) {
        const double v = (low + high) / 2;

        if ((v <= 0.0031308 ? 12.92 * v : 1.055 * pow(v, 1 / 2.4) - 0.055) < encoded)
            low = v;
        else
            high = v;
    }
    return low;
}

static void check_glb_shape(const glb *g, const set *s)
{
    const json_t *a;
    const uint8_t *const position = attribute(g, "POSITION", "VEC3", 5126, &a);
    const json_t *const low = json_object_get(a, "min"), *const high = json_object_get(a, "max");
    const uint8_t *const rotation =
        attribute(g, "KHR_gaussian_splatting:ROTATION", "VEC4", 5126, &a);
    const uint8_t *const scale = attribute(g, "KHR_gaussian_splatting:SCALE", "VEC3", 5126, &a);
    const uint8_t *const opacity =
        attribute(g, "KHR_gaussian_splatting:OPACITY", "SCALAR", 5126, &a);
    const uint8_t *const colour = attribute(g, "COLOR_0", "VEC4", 5123, &a);

    assert_true(json_is_true(json_object_get(a, "normalized")));
    for (size_t i = 0; i < N; i++) {
        const double v[3] = { 0.3, -0.7, 1.9 },
                     q[4] = { (double)s->column[6][i], (double)s->column[7][i],
                              (double)s->column[8][i], (double)s->column[9][i] };
        double r[4], want[3], world[3], got[3];

        for (size_t c = 0; c < 4; c++)
            r[(c + 1) % 4] = (double)float_at(rotation + i * 16 + c * 4);
        rotate(q, v, world);
        turned(world, want);
        rotate(r, v, got);
        for (size_t c = 0; c < 3; c++) {
            const float p = float_at(position + i * 12 + c * 4);

            assert_true(fabs(got[c] - want[c]) < 1e-5);
            assert_true(p == (c == 0 ? s->column[c][i] : -s->column[c][i]));
            assert_true(p >= (float)json_number_value(json_array_get(low, c)));
            assert_true(p <= (float)json_number_value(json_array_get(high, c)));
            assert_true(float_at(scale + i * 12 + c * 4) == s->column[3 + c][i]);
        }
        assert_true(float_at(opacity + i * 4) == s->column[10][i]);
        for (size_t c = 0; c < 4; c++) {
            const int n = colour[i * 8 + c * 2] | colour[i * 8 + c * 2 + 1] << 8;
            const double level = c == 3 ? (double)s->column[10][i] : base_colour(s, i, c);

            assert_true(fabs(n / 65535.0 - level) < 1.0 / 65535.0);
        }
    }
}

/* The colour in a direction is the same before and after rotating world and direction together. */
static void check_glb_colour(const glb *g, const set *s, int degree)
{
    const uint8_t *coef[TED4_SH_MAX_COEFS];
    const double d[3] = { 0.36, 0.48, -0.8 };
    double before[TED4_SH_MAX_COEFS], after[TED4_SH_MAX_COEFS], t[3];

    turned(d, t);
    ted4_sh_basis(d, degree, before);
    ted4_sh_basis(t, degree, after);
    for (int l = 0, n = 0; l <= degree; l++) {
        for (int m = 0; m <= 2 * l; m++, n++) {
            const json_t *a;
            char name[64];

            snprintf(name, sizeof name, "KHR_gaussian_splatting:SH_DEGREE_%d_COEF_%d", l, m);
            coef[n] = attribute(g, name, "VEC3", 5126, &a);
        }
    }
    for (size_t i = 0; i < N; i++) {
        for (size_t c = 0; c < 3; c++) {
            double want = 0.0, got = 0.0;

            for (int k = 0; k < ted4_sh_count(degree); k++) {
                want += before[k] *
                        (double)s->sh[(i * 3 + c) * (size_t)ted4_sh_count(degree) + (size_t)k];
                got += after[k] * (double)float_at(coef[k] + i * 12 + c * 4);
            }
            assert_true(fabs(got - want) < 1e-6);
        }
    }
}

static void test_glb(void **state)
{
    (void)state;
    for (int degree = 0; degree <= 3; degree++) {
        size_t size;
        set s;

        make(&s, N, degree);
        uint8_t *const data = written(&s.frame, "a.glb", &size);
        const glb g = open_glb(data, size);

        assert_string_equal(
            json_string_value(json_array_get(json_object_get(g.json, "extensionsUsed"), 0)),
            "KHR_gaussian_splatting");
        assert_int_equal(json_integer_value(json_object_get(
                             json_array_get(json_object_get(g.json, "buffers"), 0), "byteLength")),
                         data + size - g.data);
        check_glb_shape(&g, &s);
        check_glb_colour(&g, &s, degree);
        json_decref(g.json);
        free(data);
    }
}

static void test_empty(void **state)
{
    size_t size;
    set s;

    (void)state;
    make(&s, 0, 1);
    uint8_t *data = written(&s.frame, "a.ply", &size);
    assert_int_equal(expect_ply_header(data, 0, 9) - data, size);
    free(data);
    free(written(&s.frame, "a.splat", &size));
    assert_int_equal(size, 0);
    data = written(&s.frame, "a.glb", &size);
    const glb g = open_glb(data, size);
    assert_null(json_object_get(g.json, "accessors"));
    json_decref(g.json);
    free(data);
}

/* A folder that does not exist, and a writer that fails: no file is left behind. */
static int write_badly(FILE *f, const ted4_frame *x)
{
    (void)x;
    fputs("half", f);
    return -1;
}

static int count_files(void)
{
    DIR *const d = opendir(folder);
    int n = 0;

    assert_non_null(d);
    for (const struct dirent *e; (e = readdir(d)) != NULL;)
        n += e->d_name[0] != '.';
    closedir(d);
    return n;
}

static void test_no_debris(void **state)
{
    const ted4_format bad = { ".bad", "", 0, write_badly };
    char path[256];
    set s;

    (void)state;
    make(&s, N, 0);
    assert_int_equal(count_files(), 0);
    snprintf(path, sizeof path, "%s/x.bad", folder);
    assert_int_equal(ted4_export(&bad, &s.frame, path), -1);
    assert_int_equal(count_files(), 0);
    assert_ptr_equal(ted4_format_find("x.ply.glb"), &ted4_format_glb);
    assert_null(ted4_format_find("a.png"));
    assert_null(ted4_format_find(".ply"));
    snprintf(path, sizeof path, "%s/missing/x.ply", folder);
    assert_int_equal(ted4_export(&ted4_format_ply, &s.frame, path), -1);
}

/* A child begins a file, says so, and waits to be ended by the signal. */
static void end_while_writing(int signal, int is_ignored)
{
    ted4_output o;
    char path[256], said = 0;
    int ends[2], status;

    snprintf(path, sizeof path, "%s/x.ply", folder);
    assert_int_equal(socketpair(AF_UNIX, SOCK_STREAM, 0, ends), 0);

    const pid_t child = fork();

    assert_true(child >= 0);
    close(ends[child == 0 ? 0 : 1]);
    if (child == 0) {
        sigaction(signal, &(struct sigaction) { .sa_handler = is_ignored ? SIG_IGN : SIG_DFL },
                  NULL);
        ted4_leftovers_watch();
        said = ted4_output_open(&o, path) == 0 && fputs("half", o.file) > 0 && !fflush(o.file);
        if (write(ends[1], &said, 1) == 1 && is_ignored && read(ends[1], &said, 1) == 1)
            _exit(ted4_output_close(&o) == 0 ? 0 : 1);
        for (;;)
            pause();
    }
    assert_int_equal(read(ends[0], &said, 1), 1);
    assert_int_equal(said, 1);
    assert_int_equal(count_files(), 1);
    kill(child, signal);
    if (is_ignored)
        assert_int_equal(write(ends[0], &said, 1), 1);
    assert_int_equal(waitpid(child, &status, 0), child);
    if (is_ignored)
        assert_true(WIFEXITED(status) && WEXITSTATUS(status) == 0);
    else
        assert_true(WIFSIGNALED(status) && WTERMSIG(status) == signal);
    close(ends[0]);
}

static void test_signals(void **state)
{
    char path[256];

    (void)state;
    for (int i = 0; i < 4; i++) {
        end_while_writing((const int[]) { SIGINT, SIGTERM, SIGHUP, SIGPIPE }[i], 0);
        assert_int_equal(count_files(), 0);
    }
    end_while_writing(SIGHUP, 1);
    assert_int_equal(count_files(), 1);
    snprintf(path, sizeof path, "%s/x.ply", folder);
    assert_int_equal(remove(path), 0);
}

static int folder_make(void **state)
{
    (void)state;
    temporary_folder(folder, "ted4-export");
    return 0;
}

static int folder_remove(void **state)
{
    (void)state;
    return rmdir(folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_ply),       cmocka_unit_test(test_raw),
        cmocka_unit_test(test_splat),     cmocka_unit_test(test_splat_ties),
        cmocka_unit_test(test_glb),       cmocka_unit_test(test_empty),
        cmocka_unit_test(test_no_debris), cmocka_unit_test(test_signals),
    };
    return cmocka_run_group_tests(tests, folder_make, folder_remove);
}
