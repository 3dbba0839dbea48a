/* cli.c - see cli.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "cli.h"

#include <errno.h>
#include <fcntl.h>
#include <jansson.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/level.h"
#include "json_string.h"

/* A standard stream that the caller has closed would lend its number to the next file, which would
 * then get what is meant for the stream. Reading from it, or writing to it, still fails: each is
 * opened for the other. A new file gets the lowest number that is free. */
static void occupy_streams(void)
{
    int file = open("/dev/null", O_WRONLY);

    if (file > STDIN_FILENO)
        close(file);
    do
        file = open("/dev/null", O_RDONLY);
    while (file >= 0 && file <= STDERR_FILENO);
    if (file >= 0)
        close(file);
}

void ted4_cli_begin(void)
{
    occupy_streams();
#ifdef SIGXFSZ /* Windows has no limit of file sizes. */
    signal(SIGXFSZ, SIG_IGN);
#endif
}

/* Why standard output took no more; 0: not known. */
static int reason;

void ted4_cli_lost(int why)
{
    reason = why;
}

int ted4_cli_kernels(const char *program)
{
    const char *name = getenv("TED4_KERNEL");
    const ted4_level most = ted4_level_of_machine();

    if (name == NULL || ted4_level_named(name) <= most)
        return 0;
    fprintf(stderr, "%s: TED4_KERNEL=%s: this machine has", program, name);
    for (ted4_level level = TED4_LEVEL_PLAIN; level <= most; level++)
        fprintf(stderr, " %s", ted4_level_name(level));
    fputc('\n', stderr);
    return -1;
}

int ted4_cli_end(const char *program, int code)
{
    errno = 0;
    if (fflush(stdout) == 0 && !ferror(stdout))
        return code;
    if (reason == 0)
        reason = errno != 0 ? errno : EIO;
    fprintf(stderr, "%s: standard output: %s\n", program, strerror(reason));
    return TED4_EXIT_TOOL;
}

/* Returns 1 for what is wrong with a query and not with the file (R-ERR-008). */
static int is_of_query(ted4_status code)
{
    return code == TED4_E_REC_NONFINITE || code == TED4_E_QUERY;
}

static void print_json(const char *path, const ted4_error *e, const char *text)
{
    const ted4_verdict verdict = is_of_query(e->code) ? TED4_VALID : ted4_status_verdict(e->code);
    json_t *const o = json_pack("{s:o, s:s, s:s}", "file", ted4_json_string(path), "verdict",
                                ted4_verdict_name(verdict), "error", ted4_status_id(e->code));

    if (!is_of_query(e->code))
        json_object_set_new(o, "offset", json_integer((json_int_t)e->offset));
    json_object_set_new(o, "text", ted4_json_string(text));
    json_dumpf(o, stdout, JSON_COMPACT);
    putchar('\n');
    json_decref(o);
}

int ted4_report_unread(const char *program, const char *path, int json)
{
    const char *const why = strerror(errno);

    if (json)
        print_json(path, &(ted4_error) { TED4_E_IO, 0 }, why);
    fprintf(stderr, "%s: %s: %s\n", program, path, why);
    return TED4_EXIT_TOOL;
}

int ted4_report(const char *program, const char *path, const ted4_error *e, int json)
{
    const ted4_verdict verdict = ted4_status_verdict(e->code);
    const int of_query = is_of_query(e->code);
    const char *const text = of_query ? "this time and camera have no result"
                                      : ted4_status_text(e->code);

    if (json)
        print_json(path, e, text);
    fprintf(stderr, "%s: %s: ", program, path);
    if (!of_query)
        fprintf(stderr, "byte %zu: ", e->offset);
    fprintf(stderr, "%s [%s] (specification %s)\n", text, ted4_status_id(e->code),
            ted4_status_section(e->code));
    return !of_query && (verdict == TED4_INVALID || verdict == TED4_UNSUPPORTED) ? TED4_EXIT_REFUSED
                                                                                 : TED4_EXIT_TOOL;
}
