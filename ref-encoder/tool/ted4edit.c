/* ted4edit.c - sets and strips what a .ted4 file says about its scene: title, author, licence,
 * cameras, up direction, thumbnail (spec 5.2, 16.4). The scene stays the same.
 * SPDX-License-Identifier: BSD-2-Clause */
#include <errno.h>
#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "describe.h"
#include "edit.h"
#include "file_out.h"
#include "ted4.h"
#include "tool/arguments.h"
#include "tool/cli.h"
#include "tool/leftovers.h"
#include "tool/output.h"
#include "tool/turn.h"

enum {
    OPT_OUTPUT,
    OPT_TITLE,
    OPT_AUTHOR,
    OPT_LICENCE,
    OPT_CREATED,
    OPT_LINE,
    OPT_CAMERAS,
    OPT_PATH,
    OPT_UP,
    OPT_THUMBNAIL,
    OPT_STRIP,
    OPT_FORCE,
    OPT_QUIET,
    OPT_HELP,
    OPT_VERSION,
    N_OPTIONS
};

enum { MAX_LINES = 32, MAX_STRIPS = 8, LINE_SIZE = 1024 };

static const ted4_argument OPTIONS[N_OPTIONS] = {
    [OPT_OUTPUT] = { 'o', "output", "FILE", "the file to write; with -f it may be the input" },
    [OPT_TITLE] = { 0, "title", "TEXT", "title of the scene; an empty text removes it" },
    [OPT_AUTHOR] = { 0, "author", "TEXT", "who made it" },
    [OPT_LICENCE] = { 0, "licence", "TEXT", "an SPDX expression, such as CC-BY-4.0, or a text" },
    [OPT_CREATED] = { 0, "created", "DATE", "as in 2026-11-24 or 2026-11-24T12:00:00Z" },
    [OPT_LINE] = { 0, "set", "KEY=VALUE", "any line of META; an empty value removes it" },
    [OPT_CAMERAS] = { 0, "cameras", "FILE.json",
                      "cameras that took the pictures, as for ted4dec --camera" },
    [OPT_PATH] = { 0, "path", "FILE.json", "path of a player's camera, in the same form" },
    [OPT_UP] = { 0, "up", "X,Y,Z",
                 "the direction that is up in the scene, as in 0,0,1, or an axis, as for ted4dec "
                 "--up" },
    [OPT_THUMBNAIL] = { 0, "thumbnail", "FILE.png", "a picture of at most 1024 x 1024 pixels" },
    [OPT_STRIP] = { 0, "strip", "TYPE",
                    "first remove chunks META, CAMS, THMB, another ancillary type, or all" },
    [OPT_FORCE] = { 'f', "force", NULL, "overwrite" },
    [OPT_QUIET] = { 'q', "quiet", NULL, "errors only" },
    [OPT_HELP] = TED4_ARGUMENT_HELP,
    [OPT_VERSION] = TED4_ARGUMENT_VERSION,
};

static const ted4_command COMMAND = {
    "ted4edit",
    "FILE.ted4 -o FILE.ted4 [options]",
    "Sets and strips what a TED4 file says about its scene. The scene itself stays the same, "
    "which\n"
    "the program checks by its hash. ted4info shows the result.",
    OPTIONS,
    N_OPTIONS,
    "Exit codes: 0 fine, 1 file refused, 3 usage, input, output or resources.\n\n"
    "Examples:\n"
    "  ted4edit a.ted4 -o b.ted4 --title \"A walk\" --licence CC-BY-4.0\n"
    "  ted4edit a.ted4 -o a.ted4 -f --strip all\n",
    NULL,
};

typedef struct {
    const char *input, *output, *cameras, *path, *thumbnail; /* NULL: not given */
    const char *strip[MAX_STRIPS];
    char text[MAX_LINES][LINE_SIZE];
    const char *line[MAX_LINES]; /* text[i] */
    size_t n_lines, n_strips;
    float up[3];
    int has_up, force, quiet;
} settings;

static int failed(const char *what, const char *why)
{
    fprintf(stderr, "ted4edit: %s: %s\n", what, why);
    return TED4_EXIT_TOOL;
}

static int is_line(const char *text)
{
    const char *equals = strchr(text, '=');

    return equals != NULL && equals != text && ted4_edit_is_text(text);
}

/* Is the value of the line, KEY=VALUE, one that its key may have? Only created asks for a form;
 * with an empty value the line is removed. */
static int has_date(const char *line)
{
    static const char key[] = "created=";
    const char *const value = line + sizeof key - 1;

    return strncmp(line, key, sizeof key - 1) != 0 || *value == '\0' || ted4_edit_is_date(value);
}

/* key NULL: value is the whole line. */
static int add_line(settings *s, const char *option, const char *key, const char *value)
{
    if (s->n_lines == MAX_LINES)
        return failed(option, "too many lines");

    char *to = s->text[s->n_lines];
    const int n = key != NULL ? snprintf(to, LINE_SIZE, "%s=%s", key, value)
                              : snprintf(to, LINE_SIZE, "%s", value);

    if (n < 0 || n >= LINE_SIZE)
        return failed(option, "too long");
    if (!is_line(to))
        return failed(option, key != NULL ? "expected a text of one line, in UTF-8"
                                          : "expected KEY=VALUE, one line in UTF-8");
    if (!has_date(to))
        return failed(option, "expected a date, as 2026-11-24 or 2026-11-24T12:00:00Z");
    for (size_t i = 0; i < s->n_lines; i++)
        if (strncmp(to, s->line[i], (size_t)(strchr(to, '=') - to) + 1) == 0)
            return failed(option, "the key was set before");
    s->line[s->n_lines++] = to;
    return TED4_EXIT_FINE;
}

/* Scales the vector to length 1. Returns 0, or -1 if it has no direction. */
static int normalise(float v[3])
{
    const double x = (double)v[0], y = (double)v[1], z = (double)v[2];
    const double square = x * x + y * y + z * z;

    if (!(square > 0.0))
        return -1;
    v[0] = (float)(x / __builtin_sqrt(square));
    v[1] = (float)(y / __builtin_sqrt(square));
    v[2] = (float)(z / __builtin_sqrt(square));
    return 0;
}

/* A type of chunk is four letters or digits (spec 5.2). */
static int is_type(const char *text)
{
    static const char of[] = "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz";

    return strlen(text) == 4 && strspn(text, of) == 4;
}

static int take(settings *s, int option, const char *value)
{
    switch (option) {
    case OPT_OUTPUT: s->output = value; break;
    case OPT_TITLE: return add_line(s, "--title", "title", value);
    case OPT_AUTHOR: return add_line(s, "--author", "author", value);
    case OPT_LICENCE: return add_line(s, "--licence", "licence", value);
    case OPT_CREATED: return add_line(s, "--created", "created", value);
    case OPT_LINE: return add_line(s, "--set", NULL, value);
    case OPT_CAMERAS: s->cameras = value; break;
    case OPT_PATH: s->path = value; break;
    case OPT_UP:
        if (ted4_axis_parse(value, s->up) != 0 &&
            (ted4_arguments_floats(value, 3, s->up) != 0 || normalise(s->up) != 0))
            return failed("--up", "expected an axis, as z, or a direction X,Y,Z");
        s->has_up = 1;
        break;
    case OPT_THUMBNAIL: s->thumbnail = value; break;
    case OPT_STRIP:
        if (strcmp(value, "all") != 0 && !is_type(value))
            return failed("--strip", "expected META, CAMS, THMB, another type, or all");
        if (s->n_strips == MAX_STRIPS)
            return failed("--strip", "too many");
        s->strip[s->n_strips++] = value;
        break;
    case OPT_FORCE: s->force = 1; break;
    case OPT_QUIET: s->quiet = 1; break;
    }
    return TED4_EXIT_FINE;
}

/* Returns -1 if the program should go on, or else its exit code. */
static int parse(settings *s, int argc, char **argv)
{
    const char *value;

    memset(s, 0, sizeof *s);
    for (int i; (i = ted4_arguments_next(&COMMAND, argc, argv, &value)) != TED4_ARGUMENTS_END;) {
        if (i == TED4_ARGUMENTS_BAD)
            return TED4_EXIT_TOOL;
        if (i == TED4_ARGUMENTS_DONE)
            return TED4_EXIT_FINE;
        const int code = take(s, i, value);

        if (code != TED4_EXIT_FINE)
            return code;
    }
    if (optind + 1 != argc || s->output == NULL)
        return failed("arguments", "expected FILE.ted4 -o FILE.ted4 (see --help)");
    if (!ted4_has_suffix(s->output, ".ted4"))
        return failed(s->output, "expected a file name that ends in .ted4");
    s->input = argv[optind];
    return -1;
}

/* ---- chunks ---- */

/* Drops the cameras of a kind, and chunks CAMS that cannot be read. The last up direction found is
 * kept in up. */
static void drop_cameras(ted4_edit *e, ted4_cams_kind kind, float up[3])
{
    ted4_cams c;

    for (size_t i = 0; i < e->n; i++) {
        ted4_edit_chunk *chunk = &e->chunk[i];

        if (chunk->dropped || strcmp(chunk->view.type, "CAMS") != 0)
            continue;

        const int readable = ted4_cams_read(chunk->view.payload, chunk->view.size, &c) == 0;

        chunk->dropped = !readable || c.kind == kind;
        if (readable && ted4_has_direction(c.up))
            memcpy(up, c.up, sizeof c.up);
    }
}

/* Says what of a list the chunk does not hold. */
static void warn_of_list(const ted4_camera_list *l, const char *file)
{
    int pixel = 0;

    for (size_t i = 0; i < l->n; i++)
        pixel |= l->camera[i].view.pixel != 0.0f;
    if (pixel)
        fprintf(stderr, "ted4edit: warning: %s: the member pixel is left out\n", file);
    if (l->distorted)
        fprintf(stderr, "ted4edit: warning: %s: %s\n", file, TED4_CAMERA_LIST_DISTORTED);
}

static int add_cameras(ted4_edit *e, const settings *s, const ted4_info *info, const char *file,
                       ted4_cams_kind kind)
{
    float up[3] = { 0, 0, 0 };
    ted4_camera_list list;
    char why[256];
    size_t size;

    if (ted4_camera_list_load(&list, file, why, sizeof why) != 0)
        return failed(file, why);
    if (!s->quiet)
        warn_of_list(&list, file);
    drop_cameras(e, kind, up);

    uint8_t *payload = ted4_describe_listed(&list, info->frames, kind, s->has_up ? s->up : up,
                                            &size, why, sizeof why);

    ted4_camera_list_free(&list);
    if (payload == NULL)
        return failed(file, why);
    return ted4_edit_add(e, "CAMS", 0, payload, size) == 0 ? TED4_EXIT_FINE
                                                           : failed(file, "too many chunks");
}

/* Finds the cameras of the file that count: the last ones that took pictures (16.4). Returns their
 * chunk with *c filled; one without cameras if there is no other; or NULL, and c->n is 0. */
static ted4_edit_chunk *find_taken(ted4_edit *e, ted4_cams *c)
{
    ted4_edit_chunk *found = NULL;
    ted4_cams one;

    c->n = 0;
    for (size_t i = 0; i < e->n; i++) {
        ted4_edit_chunk *chunk = &e->chunk[i];

        if (chunk->dropped || strcmp(chunk->view.type, "CAMS") != 0 ||
            ted4_cams_read(chunk->view.payload, chunk->view.size, &one) != 0 ||
            one.kind != TED4_CAMS_TAKEN || (one.n == 0 && c->n > 0))
            continue;
        found = chunk;
        *c = one;
    }
    return found;
}

/* --up without --cameras: the cameras of the file get another up direction; if it has none, a chunk
 * without cameras says it. */
static int set_up(ted4_edit *e, const settings *s)
{
    ted4_cams c;
    ted4_edit_chunk *const old = find_taken(e, &c);
    const size_t size = old != NULL ? old->view.size : TED4_CAMS_HEAD;
    uint8_t *const payload = malloc(size);

    if (payload == NULL)
        return failed("--up", "out of memory");
    if (old != NULL) {
        memcpy(payload, old->view.payload, size);
        old->dropped = 1;
    }
    ted4_cams_put_head(payload, s->up, TED4_CAMS_TAKEN, c.n);
    return ted4_edit_add(e, "CAMS", 0, payload, size) == 0 ? TED4_EXIT_FINE
                                                           : failed("--up", "too many chunks");
}

static int set_thumbnail(ted4_edit *e, const char *path)
{
    char why[256];
    size_t size;
    uint8_t *png = ted4_describe_png(path, &size, why, sizeof why);

    if (png == NULL)
        return failed(path, why);
    ted4_edit_drop(e, "THMB");
    return ted4_edit_add(e, "THMB", 0, png, size) == 0 ? TED4_EXIT_FINE
                                                       : failed(path, "too many chunks");
}

/* Does what --strip says. A chunk that the scene is made of is an error; one that is not there is
 * not, as then it need not be stripped. */
static int strip(ted4_edit *e, const settings *s)
{
    for (size_t i = 0; i < s->n_strips; i++) {
        const char *const type = s->strip[i];
        const int all = strcmp(type, "all") == 0;

        if (!all && ted4_edit_is_critical(e, type)) {
            fprintf(stderr, "ted4edit: --strip: the scene is made of chunks %s\n", type);
            return TED4_EXIT_TOOL;
        }
        if (ted4_edit_drop(e, all ? NULL : type) == 0 && !s->quiet)
            fprintf(stderr, "ted4edit: note: %s: no chunk to strip%s%s\n", s->input,
                    all ? "" : ": ", all ? "" : type);
    }
    return TED4_EXIT_FINE;
}

static int change(ted4_edit *e, const settings *s, const ted4_info *info)
{
    int code = strip(e, s);

    if (code == TED4_EXIT_FINE && s->n_lines > 0 && ted4_edit_lines(e, s->line, s->n_lines) != 0)
        code = failed("--set", "out of memory");
    if (code == TED4_EXIT_FINE && s->cameras != NULL)
        code = add_cameras(e, s, info, s->cameras, TED4_CAMS_TAKEN);
    else if (code == TED4_EXIT_FINE && s->has_up)
        code = set_up(e, s);
    if (code == TED4_EXIT_FINE && s->path != NULL)
        code = add_cameras(e, s, info, s->path, TED4_CAMS_PATH);
    if (code == TED4_EXIT_FINE && s->thumbnail != NULL)
        code = set_thumbnail(e, s->thumbnail);
    return code;
}

/* ---- the program ---- */

static int write_out(const ted4_edit *e, const settings *s)
{
    char why[512];
    const char *text;
    uint8_t *out;
    size_t size;
    int code = TED4_EXIT_FINE;

    if (ted4_edit_write(e, &out, &size, &text) != 0)
        return failed(s->output, text);
    if (ted4_file_writable(s->output, s->force, "", why, sizeof why) != 0 ||
        ted4_file_write(s->output, s->force, out, size, why, sizeof why) != 0) {
        fprintf(stderr, "ted4edit: %s\n", why);
        code = TED4_EXIT_TOOL;
    } else if (!s->quiet) {
        fprintf(stderr, "ted4edit: %s: %zu bytes, was %zu; the scene is the same\n", s->output,
                size, e->size);
    }
    free(out);
    return code;
}

static int run(const settings *s)
{
    ted4_error error = { TED4_OK, 0 };
    ted4_scene *scene = NULL;
    ted4_info info;
    ted4_edit e;
    size_t size;
    uint8_t *const file = ted4_read_ted4(s->input, &size);
    int code;

    if (file == NULL)
        return failed(s->input, strerror(errno));
    if (ted4_decode(file, size, NULL, &scene, &error) != TED4_OK) {
        free(file);
        return ted4_report("ted4edit", s->input, &error, 0);
    }
    ted4_scene_info(scene, &info);
    ted4_scene_free(scene);
    if (ted4_edit_begin(&e, file, size) != 0) {
        code = failed(s->input, "out of memory");
    } else {
        code = change(&e, s, &info);
        if (code == TED4_EXIT_FINE)
            code = write_out(&e, s);
    }
    ted4_edit_finish(&e);
    free(file);
    return code;
}

int main(int argc, char **argv)
{
    static settings s;
    const int code = parse(&s, argc, argv);

    if (code >= 0)
        return code;
    ted4_leftovers_watch();
    return run(&s);
}
