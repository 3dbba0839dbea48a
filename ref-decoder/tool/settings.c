/* settings.c - see settings.h. An option that has no effect is refused: whoever wrote it expects
 * something of it.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "settings.h"

#include <stddef.h>
#include <stdio.h>

#include "cli.h"
#include "output.h"
#include "turn.h"

static int refuse(const char *options, const char *why)
{
    fprintf(stderr, "ted4dec: %s: %s (see --help)\n", options, why);
    return TED4_EXIT_TOOL;
}

static int refuse_degree(const ted4_settings *s)
{
    fprintf(stderr, "ted4dec: --sh-degree: %d is more than %s can hold (see --help)\n",
            s->sh_degree, s->format->suffix);
    return TED4_EXIT_TOOL;
}

/* Options that say how to do what another option asks for. */
static int check_needs(const ted4_settings *s)
{
    const int exports = s->output != NULL, queries = exports || s->hash;
    const int n_cameras = (s->cameras != NULL) + (s->path != NULL) + (s->orbit > 0);
    const int turns = s->auto_up || ted4_has_direction(s->up);

    if (s->render != NULL && n_cameras != 1)
        return refuse("--render", "goes with one of --camera, --orbit and --path");
    if (s->render == NULL && n_cameras > 0)
        return refuse("--camera, --orbit and --path", "only with --render");
    if (s->views > 0 && s->path == NULL)
        return refuse("--views", "only with --path");
    if (s->has_range && !queries)
        return refuse("--frames", "only with -o or --hash; cameras say their own times");
    if (s->has_time && !queries && s->render == NULL)
        return refuse("--time", "only with -o, --hash or --render");
    if (s->has_centre && !queries)
        return refuse("--camera-centre", "only with -o or --hash");
    if (s->hash && !exports && s->has_centre && !s->has_range && !s->has_time)
        return refuse("--camera-centre", "--hash needs --frames or --time as well");
    if (s->sh_degree >= 0 && !exports)
        return refuse("--sh-degree", "only with -o");
    if (turns && !exports && s->orbit == 0)
        return refuse("--up", "only with -o or --orbit");
    if (turns && exports && s->format == &ted4_format_raw)
        return refuse("--up", ".raw holds the records as they were decoded");
    if (s->widen && !exports)
        return refuse("--widen", "only with -o");
    if (s->widen && s->format == &ted4_format_raw)
        return refuse("--widen", ".raw holds the records as they were decoded");
    if (s->keep_all && !exports)
        return refuse("--keep-all", "only with -o");
    if (s->drop_faint && !exports)
        return refuse("--drop-faint", "only with -o");
    return 0;
}

/* Options that contradict each other. */
static int check_conflicts(const ted4_settings *s)
{
    if (s->has_range && s->has_time)
        return refuse("--frames and --time", "only one of them");
    if (s->test && (s->output != NULL || s->render != NULL))
        return refuse("--test", "writes no file");
    if (s->keep_all && s->drop_faint)
        return refuse("--keep-all and --drop-faint", "only one of them");
    if (s->trace && s->json)
        return refuse("--trace and --json", "only one of them");
    if (s->quiet && s->verbose)
        return refuse("-q and -v", "only one of them");
    return 0;
}

int ted4_settings_only_check(const ted4_settings *s)
{
    return s->test || (s->output == NULL && s->render == NULL && !s->hash && !s->trace);
}

/* Standard output holds one thing. */
static int check_stdout(const ted4_settings *s)
{
    const int uses = s->output != NULL && ted4_output_is_stdout(s->output);

    if (s->stdout_format != NULL && !uses)
        return refuse("--format", "only with -o -; a name says its format");
    if (uses && (s->json || s->hash || s->trace))
        return refuse("-o -", "goes without --json, --hash and --trace, which print as well");
    return 0;
}

int ted4_settings_check(ted4_settings *s)
{
    int code = check_stdout(s);

    if (code == 0 && s->stdout_format != NULL)
        s->format = s->stdout_format;
    if (code == 0)
        code = check_needs(s);
    if (code != 0)
        return code;
    if (s->output != NULL && s->sh_degree >= 0 && s->format->max_sh_degree < s->sh_degree)
        return refuse_degree(s);
    return check_conflicts(s);
}
