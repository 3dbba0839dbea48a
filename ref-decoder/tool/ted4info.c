/* ted4info.c - prints the contents of a .ted4 file, and how many bytes each syntax element takes.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <getopt.h>
#include <inttypes.h>
#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "arguments.h"
#include "base/bytes.h"
#include "budget.h"
#include "cams.h"
#include "chunks.h"
#include "cli.h"
#include "file_cameras.h"
#include "findings.h"
#include "graver.h"
#include "json_string.h"
#include "plural.h"
#include "ted4.h"
#include "threads.h"
#include "turn.h"
#include "meta_lines.h"

enum {
    OPT_BUDGET,
    OPT_WHY,
    OPT_CAMERAS,
    OPT_PATH,
    OPT_VALIDATE,
    OPT_MEMORY,
    OPT_WORK,
    OPT_THREADS,
    OPT_JSON,
    OPT_QUIET,
    OPT_VERBOSE,
    OPT_HELP,
    OPT_VERSION,
    N_OPTIONS
};

static const ted4_argument OPTIONS[N_OPTIONS] = {
    [OPT_BUDGET] = { 0, "budget", NULL, "attribute every byte of the file to a syntax element" },
    [OPT_WHY] = { 0, "why", NULL,
                  "what the encoder says of its decisions, if it was asked to (ted4enc --why)" },
    [OPT_CAMERAS] = { 0, "cameras", NULL, "the cameras of the file, as JSON for ted4dec --camera" },
    [OPT_PATH] = { 0, "path", NULL, "the path of the file, as JSON for ted4dec --path" },
    [OPT_VALIDATE] = { 0, "validate", NULL,
                       "for authors of encoders: every error, and what is legal but doubtful, with "
                       "byte offset and rule" },
    [OPT_MEMORY] = { 0, "max-memory", "BYTES", "refuse a file that takes more. Default 4 GiB" },
    [OPT_WORK] = { 0, "max-work", "STEPS",
                   "refuse a file that asks for more steps (specification 13.4). Default: any "
                   "number" },
    [OPT_THREADS] = { 'j', "threads", "N",
                      "accepted; elements are listed in order, by one thread" },
    [OPT_JSON] = { 0, "json", NULL, "everything as one JSON object for each file" },
    [OPT_QUIET] = { 'q', "quiet", NULL, "errors only: is the file valid?" },
    [OPT_VERBOSE] = { 'v', "verbose", NULL, "also every element of the header" },
    [OPT_HELP] = TED4_ARGUMENT_HELP,
    [OPT_VERSION] = TED4_ARGUMENT_VERSION,
};

static const ted4_command COMMAND = {
    "ted4info",
    "FILE.ted4... [options]     (- reads standard input)",
    "Says what a TED4 file holds.",
    OPTIONS,
    N_OPTIONS,
    "Exit codes: 0 fine, 1 file refused, 2 fine with warnings (--validate), 3 usage,\n"
    "input, output or resources.\n\n"
    "Examples:\n"
    "  ted4info a.ted4 --budget\n"
    "  ted4info a.ted4 --cameras >cameras.json\n",
    NULL,
};

typedef struct {
    const char *input;
    int on[N_OPTIONS];            /* 1: option i was given */
    int64_t max_memory, max_work; /* 0: not given */
} settings;

static int usage_error(const char *text)
{
    fprintf(stderr, "ted4info: %s (see --help)\n", text);
    return TED4_EXIT_TOOL;
}

static int bad_number(const char *name, const char *value, int64_t low, int64_t high)
{
    return ted4_arguments_bad_number("ted4info", name, value, low, high);
}

/* Returns -1 if the program should continue, else its exit code. */
static int parse(settings *s, int argc, char **argv)
{
    const char *value;
    int64_t threads;

    memset(s, 0, sizeof *s);
    for (int i; (i = ted4_arguments_next(&COMMAND, argc, argv, &value)) != TED4_ARGUMENTS_END;) {
        if (i == TED4_ARGUMENTS_BAD)
            return TED4_EXIT_TOOL;
        if (i == TED4_ARGUMENTS_DONE)
            return TED4_EXIT_FINE;
        if (i == OPT_THREADS && ted4_arguments_number(value, 0, TED4_MAX_THREADS, &threads) != 0)
            return bad_number("threads", value, 0, TED4_MAX_THREADS);
        if (i == OPT_MEMORY && ted4_arguments_number(value, 1, INT64_MAX, &s->max_memory) != 0)
            return bad_number("max-memory", value, 1, INT64_MAX);
        if (i == OPT_WORK && ted4_arguments_number(value, 1, INT64_MAX, &s->max_work) != 0)
            return bad_number("max-work", value, 1, INT64_MAX);
        s->on[i] = 1;
    }
    if (optind == argc)
        return usage_error("expected a file");
    if (optind + 1 < argc && s->on[OPT_CAMERAS] + s->on[OPT_PATH] > 0)
        return usage_error("--cameras and --path are of one file");
    if (s->on[OPT_VALIDATE] && (s->on[OPT_BUDGET] || s->on[OPT_WHY] || s->on[OPT_VERBOSE]))
        return usage_error("--validate goes without --budget, --why and --verbose");
    if (s->on[OPT_CAMERAS] + s->on[OPT_PATH] > 0 &&
        s->on[OPT_CAMERAS] + s->on[OPT_PATH] + s->on[OPT_VALIDATE] + s->on[OPT_BUDGET] +
                s->on[OPT_WHY] + s->on[OPT_VERBOSE] + s->on[OPT_JSON] + s->on[OPT_QUIET] >
            1)
        return usage_error("--cameras and --path print nothing else");
    if (s->on[OPT_QUIET] && !s->on[OPT_JSON] &&
        (s->on[OPT_BUDGET] || s->on[OPT_WHY] || s->on[OPT_VERBOSE]))
        return usage_error("--quiet goes without --budget, --why and --verbose");
    return -1;
}

static int is_float(const char *element)
{
    return strcmp(element, "step") == 0 || strcmp(element, "origin") == 0;
}

static int64_t integer_value(const ted4_header_value *v)
{
    return strcmp(v->name, "exponent") == 0 ? (int8_t)v->value : v->value;
}

/* The time of the last frame. */
static double last_second(const ted4_info *info)
{
    return (double)(info->frames - 1) * info->rate_den / info->rate_num;
}

/* A single frame has no rate. Rates in thousandths are printed as decimal numbers, such as 6 or
 * 23.976 instead of 6000/1000. */
static void print_frames(const ted4_info *info)
{
    enum { THOUSAND = 1000 };

    printf("frames      %" PRIu32, info->frames);
    if (info->frames > 1 && THOUSAND % info->rate_den == 0)
        printf(" at %.10g per second", (double)info->rate_num / info->rate_den);
    else if (info->frames > 1)
        printf(" at %" PRIu32 "/%" PRIu32 " per second", info->rate_num, info->rate_den);
    putchar('\n');
    if (info->frames > 1)
        printf("seconds     0 to %.7g\n", last_second(info));
}

/* Offset in the file (spec 5.1). */
enum { PROFILE_AT = 10 };

static void print_summary(const settings *s, const ted4_info *info, const uint8_t *data,
                          size_t size)
{
    static const char *const motion[] = { [TED4_MOTION_NONE] = "none",
                                          [TED4_MOTION_BANK] = "bank",
                                          [TED4_MOTION_CONCAT] = "concat",
                                          [TED4_MOTION_INR] = "inr" };
    static const char *const view[] = {
        [TED4_VIEW_NONE] = "none", [TED4_VIEW_COLOUR] = "colour", [TED4_VIEW_FULL] = "full"
    };
    char hash[33];

    ted4_hex(hash, info->hash, sizeof info->hash);
    printf("%s: TED4, %s profile, level %d, %zu bytes\n", s->input,
           data[PROFILE_AT] == 0 ? "Main" : "Compact", info->level, size);
    printf("anchors     %" PRIu32 ", moving %" PRIu32 "\n", info->n_anchors, info->n_dynamic);
    printf("Gaussians   %zu, at most %" PRIu32 " per anchor\n", info->n_gaussians, info->n_offsets);
    print_frames(info);
    printf("motion      %s; activation %s; view %s\n", motion[info->motion],
           info->activation ? "yes" : "no", view[info->view]);
    printf("space       origin %.9g %.9g %.9g, unit 2^%d\n", (double)info->origin[0],
           (double)info->origin[1], (double)info->origin[2], info->exponent);
    printf("background  #%02x%02x%02x\n", info->background[0], info->background[1],
           info->background[2]);
    printf("hash        %s\n", hash);
}

static void print_header(const ted4_budget *b)
{
    const char *before = "";

    for (int i = 0; i < b->n_header; i++) {
        const ted4_header_value *const v = &b->header[i];

        if (strcmp(v->name, before) != 0)
            printf("%s  %-16s", i > 0 ? "\n" : "header\n", v->name);
        before = v->name;
        if (is_float(v->name))
            printf(" %.9g", (double)ted4_bits_float((uint32_t)v->value));
        else
            printf(" %" PRId64, integer_value(v));
    }
    printf("\n");
}

static void print_budget(const ted4_budget *b, size_t size)
{
    printf("%-6s %-20s %12s %8s %12s %12s\n", "chunk", "element", "bytes", "%", "symbols",
           "bits/symbol");
    for (int i = 0; i < b->n_rows; i++) {
        const ted4_budget_row *const r = &b->row[i];

        printf("%-6s %-20s %12" PRIu64 " %8.3f", r->chunk, r->element, r->bytes,
               100.0 * (double)r->bytes / (double)size);
        if (r->symbols > 0)
            printf(" %12" PRIu64 " %12.4f", r->symbols,
                   8.0 * (double)r->bytes / (double)r->symbols);
        printf("\n");
    }
    printf("%-6s %-20s %12zu\n", "all", "", size);
}

static json_t *header_json(const ted4_budget *b)
{
    json_t *const o = json_object();

    for (int i = 0; i < b->n_header; i++) {
        const ted4_header_value *const v = &b->header[i];
        json_t *const value = is_float(v->name)
                                  ? json_real((double)ted4_bits_float((uint32_t)v->value))
                                  : json_integer(integer_value(v));
        json_t *list = json_object_get(o, v->name);
        const int is_list = is_float(v->name) || strcmp(v->name, "slice") == 0 ||
                            strcmp(v->name, "background") == 0;

        if (list == NULL && is_list) {
            list = json_array();
            json_object_set_new(o, v->name, list);
        }
        if (is_list)
            json_array_append_new(list, value);
        else
            json_object_set_new(o, v->name, value);
    }
    return o;
}

static json_t *budget_json(const ted4_budget *b)
{
    json_t *const list = json_array();

    for (int i = 0; i < b->n_rows; i++) {
        const ted4_budget_row *const r = &b->row[i];
        json_t *const o = json_pack("{s:s, s:s, s:I}", "chunk", r->chunk, "element", r->element,
                                    "bytes", (json_int_t)r->bytes);

        if (r->symbols > 0)
            json_object_set_new(o, "symbols", json_integer((json_int_t)r->symbols));
        json_array_append_new(list, o);
    }
    return list;
}

/* Keys of META that describe the scene to people (spec 16.4). */
static const char *const DESCRIBING[] = { "title", "author", "licence", "created" };
enum { N_DESCRIBING = sizeof DESCRIBING / sizeof DESCRIBING[0] };

/* CAMS as text: "12 cameras, up 0 0 1". */
static void cams_text(const ted4_chunk_view *chunk, char *text, size_t size)
{
    ted4_cams c;

    if (ted4_cams_read(chunk->payload, chunk->size, &c) != 0) {
        snprintf(text, size, "not as specified");
        return;
    }
    const int n = snprintf(text, size, "%zu camera%s%s, up ", c.n, ted4_s(c.n),
                           c.kind == TED4_CAMS_PATH ? " of a path" : "");

    if (ted4_has_direction(c.up))
        snprintf(text + n, size - (size_t)n, "%.4g %.4g %.4g", (double)c.up[0], (double)c.up[1],
                 (double)c.up[2]);
    else
        snprintf(text + n, size - (size_t)n, "unknown");
}

/* Ancillary chunks: what people say about the scene, and one line per chunk. */
static void print_ancillary(const uint8_t *data, size_t size)
{
    ted4_chunk_view c;
    char text[100];

    for (int i = 0; i < N_DESCRIBING; i++)
        (void)ted4_meta_lines_print(data, size, DESCRIBING[i]);
    for (size_t at = TED4_FILE_HEADER; ted4_chunks_next(data, size, &at, &c);) {
        if ((c.flags & TED4_CHUNK_IS_CRITICAL) != 0)
            continue;
        text[0] = '\0';
        if (strcmp(c.type, "CAMS") == 0)
            cams_text(&c, text, sizeof text);
        printf("chunk       %s, %zu bytes%s%s\n", c.type, c.size, text[0] != '\0' ? ": " : "",
               text);
    }
}

static json_t *ancillary_json(const uint8_t *data, size_t size)
{
    json_t *const list = json_array();
    ted4_chunk_view c;
    char text[100];

    for (size_t at = TED4_FILE_HEADER; ted4_chunks_next(data, size, &at, &c);) {
        if ((c.flags & TED4_CHUNK_IS_CRITICAL) != 0)
            continue;
        json_t *const o = json_pack("{s:s, s:I}", "type", c.type, "bytes", (json_int_t)c.size);

        if (strcmp(c.type, "CAMS") == 0) {
            cams_text(&c, text, sizeof text);
            json_object_set_new(o, "text", json_string(text));
        }
        json_array_append_new(list, o);
    }
    return list;
}

static json_t *describing_json(const uint8_t *data, size_t size)
{
    json_t *const all = json_array();

    for (int i = 0; i < N_DESCRIBING; i++) {
        json_t *const lines = ted4_meta_lines_json(data, size, DESCRIBING[i]);

        json_array_extend(all, lines);
        json_decref(lines);
    }
    return all;
}

static void print_json(const settings *s, const ted4_info *info, const ted4_budget *b,
                       const uint8_t *data, size_t size)
{
    char hash[33];
    json_t *o;

    ted4_hex(hash, info->hash, sizeof info->hash);
    o = json_pack("{s:o, s:s, s:I, s:s, s:i, s:s, s:I, s:I, s:I, s:o}", "file",
                  ted4_json_string(s->input), "verdict", "valid", "bytes", (json_int_t)size,
                  "profile", data[PROFILE_AT] == 0 ? "main" : "compact", "level", info->level,
                  "hash", hash, "anchors", (json_int_t)info->n_anchors, "moving",
                  (json_int_t)info->n_dynamic, "gaussians", (json_int_t)info->n_gaussians, "header",
                  header_json(b));
    json_object_set_new(o, "seconds",
                        info->frames > 1 ? json_real(last_second(info)) : json_integer(0));
    if (s->on[OPT_BUDGET])
        json_object_set_new(o, "budget", budget_json(b));
    if (s->on[OPT_WHY])
        json_object_set_new(o, "why", ted4_meta_lines_json(data, size, "capacity"));
    json_object_set_new(o, "ancillary", ancillary_json(data, size));
    json_object_set_new(o, "description", describing_json(data, size));
    json_dumpf(o, stdout, JSON_COMPACT | JSON_REAL_PRECISION(9));
    putchar('\n');
    json_decref(o);
}

static int show_cameras(const settings *s, const uint8_t *data, size_t size)
{
    const ted4_cams_kind kind = s->on[OPT_PATH] ? TED4_CAMS_PATH : TED4_CAMS_TAKEN;
    ted4_camera_list cameras;
    const int bad = ted4_file_cameras(data, size, kind, &cameras) != 0;

    if (bad || cameras.n == 0)
        fprintf(stderr, "ted4info: %s: %s\n", s->input,
                bad                      ? "out of memory"
                : kind == TED4_CAMS_PATH ? "the file has no path of cameras"
                                         : "the file has no cameras");
    else
        ted4_camera_list_print(&cameras, stdout);
    const int code = bad || cameras.n == 0 ? TED4_EXIT_TOOL : TED4_EXIT_FINE;

    ted4_camera_list_free(&cameras);
    return code;
}

static int show(const settings *s, const ted4_info *info, const ted4_budget *b, const uint8_t *data,
                size_t size)
{
    if (s->on[OPT_CAMERAS] || s->on[OPT_PATH])
        return show_cameras(s, data, size);
    if (s->on[OPT_JSON]) {
        print_json(s, info, b, data, size);
    } else if (!s->on[OPT_QUIET]) {
        print_summary(s, info, data, size);
        print_ancillary(data, size);
        if (s->on[OPT_VERBOSE])
            print_header(b);
        if (s->on[OPT_BUDGET])
            print_budget(b, size);
        if (s->on[OPT_WHY] && ted4_meta_lines_print(data, size, "capacity") == 0)
            fprintf(stderr, "ted4info: note: %s: the file does not say why; ted4enc --why does\n",
                    s->input);
    }
    return TED4_EXIT_FINE;
}

/* Does for one file what the settings say. Returns the exit code. */
static int run(const settings *s)
{
    static ted4_budget counts;
    ted4_budget *const budget = memset(&counts, 0, sizeof counts);

    const ted4_options options = { .max_bytes = (uint64_t)s->max_memory,
                                   .max_work = (uint64_t)s->max_work,
                                   .trace = ted4_budget_trace,
                                   .trace_user = budget };
    ted4_error e = { TED4_OK, 0 };
    ted4_scene *scene = NULL;
    ted4_info info;
    size_t size;
    uint8_t *const data = s->on[OPT_VALIDATE] ? ted4_read_file(s->input, &size)
                                              : ted4_read_ted4(s->input, &size);
    int code;

    if (data == NULL)
        return ted4_report_unread("ted4info", s->input, s->on[OPT_JSON]);
    if (s->on[OPT_VALIDATE]) {
        code =
            ted4_findings_print(s->input, data, size, &options, s->on[OPT_JSON], s->on[OPT_QUIET]);
    } else if (ted4_decode(data, size, &options, &scene, &e) != TED4_OK) {
        code = ted4_report("ted4info", s->input, &e, s->on[OPT_JSON]);
    } else if (!ted4_budget_finish(budget, size)) {
        fprintf(stderr, "ted4info: %s: bytes without an owner: this is a bug\n", s->input);
        code = TED4_EXIT_TOOL;
    } else {
        ted4_scene_info(scene, &info);
        code = show(s, &info, budget, data, size);
    }
    ted4_scene_free(scene);
    free(data);
    return code;
}

int main(int argc, char **argv)
{
    settings s;
    const int parsed = parse(&s, argc, argv);
    int worst = TED4_EXIT_FINE;

    if (parsed >= 0)
        return parsed;
    for (int i = optind; i < argc; i++) {
        s.input = argv[i];
        if (i > optind && !s.on[OPT_JSON] && !s.on[OPT_QUIET])
            putchar('\n');
        worst = ted4_graver(worst, run(&s));
    }
    return ted4_cli_end("ted4info", worst);
}
