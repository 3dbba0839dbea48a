/* mutant_build.c - see mutant_build.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "mutant_build.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

/* Runs a shell command. Returns 1 on success. */
static int shell(const char *command)
{
    const int status = system(command);

    return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

void conf_mutant_folder(char *folder)
{
    const char *tmp = getenv("TMPDIR");

    conf_path(folder, "%s/ted4mutant-XXXXXX", tmp != NULL ? tmp : "/tmp");
    if (mkdtemp(folder) == NULL)
        conf_die("%s: cannot be made", folder);
}

void conf_mutant_folder_remove(const char *folder)
{
    char command[CONF_PATH + 16];

    snprintf(command, sizeof command, "rm -rf '%s'", folder);
    (void)shell(command);
}

void conf_mutant_put(const char *folder, const char *file, const conf_bytes *b)
{
    char path[CONF_PATH];

    conf_path(path, "%s/%s", folder, file);
    conf_write(path, b->data, b->size);
}

void conf_mutant_show_log(const char *folder)
{
    char path[CONF_PATH];
    conf_bytes log;

    conf_path(path, "%s/log", folder);
    if (conf_read(path, &log))
        fputs((const char *)log.data, stderr);
    conf_free(&log);
}

/* Adds, as words for a shell, the sources that have to be compiled after a change to that file.
 * Plain kernels leave the code of kernel/ alone. */
static void add_sources(const conf_mutant_options *o, const conf_place *place, const char *file,
                        conf_bytes *b)
{
    const int plain = strcmp(conf_place_named("")->variable, place->variable) == 0;

    if (strcmp(file, CONF_ANNEX_L) == 0)
        conf_print(b, "echo " CONF_PRINTED_INFLATE "; ");
    else if (strcmp(file + strlen(file) - 2, ".h") == 0)
        conf_print(b,
                   "(cd %s && grep -l '%s' ref-decoder/norm/*.d ref-decoder/read/*.d "
                   "ref-decoder/recon/*.d %s | sed 's/\\.d$/.c/'); ",
                   o->build, file, plain ? "" : "ref-decoder/kernel/*.d");
    else
        conf_print(b, "echo %s; ", file);
}

/* Adds the beginning of a shell's case statement that sets f to the flags of source s. */
static void add_flags(const conf_mutant_options *o, conf_bytes *b)
{
    conf_print(b, "f=; case $s in ");
    for (int i = 0; i < CONF_MUTANT_FLAGS && o->flags[i] != NULL; i++) {
        const char *const flags = strchr(o->flags[i], '=');

        if (flags == NULL)
            conf_die("%s: not SUFFIX=FLAGS", o->flags[i]);
        conf_print(b, "*%.*s) f='%s';; ", (int)(flags - o->flags[i]), o->flags[i], flags + 1);
    }
    conf_print(b, "esac; ");
}

int conf_mutant_build(const conf_mutant_options *o, const conf_place *place, const conf_mutant *m,
                      size_t n, const char *folder)
{
    const char *const b = o->build;
    conf_bytes command = { NULL, 0, 0 };
    int good;

    conf_print(&command, "d='%s'; ", folder);
    if (place->printed)
        conf_print(&command,
                   "mkdir -p \"$d/inc/spec\" && awk -f tests/spec/code.awk \"$d/" CONF_ANNEX_L
                   "\" >\"$d/inc/spec/inflate.h\" || exit 1; ");
    conf_print(&command, "for s in $({ ");
    for (size_t i = 0; i < n; i++)
        if (m[i].place == place &&
            (i == 0 || m[i - 1].place != place || strcmp(m[i].file, m[i - 1].file) != 0))
            add_sources(o, place, m[i].file, &command);
    conf_print(&command, "} | sort -u); do from=$s; [ -f \"$d/$s\" ] && from=$d/$s; ");
    add_flags(o, &command);
    conf_print(&command,
               "%s $f -I\"$d/inc\" -I\"$d/ref-decoder\" -Iref-decoder -Iref-encoder -w -c $from "
               "-o \"$d/$(echo $s | tr / _).o\" 2>>\"$d/log\" || exit 1; done; ",
               o->compile);
    /* What of the tools was compiled anew is left out of the old ones; read/inflate.c is in a
     * library, and one function of it is still needed beside the printed decoder. */
    conf_print(&command,
               "for t in $(ls %s/ref-decoder/tool/*.o | grep -v /ted4); do "
               "[ -f \"$d/ref-decoder_tool_$(basename $t .o).c.o\" ] || tools=\"$tools $t\"; done; "
               "cc -fopenmp %s \"$d\"/*.o %s/conformance/tool/*.o "
               "%s/conformance/tolerance/class_t.o %s/tests/spec/eval_*.o $tools %s/libted4enc.a "
               "%s/libted4render.a %s/libted4dec.a -o \"$d/ted4conf\" %s 2>>\"$d/log\"",
               b, place->printed ? "-Wl,-z,muldefs" : "", b, b, b, b, b, b, o->libraries);
    good = shell((const char *)command.data);
    conf_free(&command);
    return good;
}

void conf_mutant_replay(const conf_mutant_options *o, const conf_place *place, const char *folder,
                        conf_process *p)
{
    const conf_process_options how = { "exec", place->variable, o->timeout, (uint64_t)4 << 30 };
    char program[CONF_PATH], threads[16];
    const char *argv[] = { program,   "replay",  "--stop",
                           "--names", "--ways",  "--threads",
                           threads,   "--suite", o->vectors != NULL ? o->vectors : o->suite,
                           NULL };
    conf_process *one[1] = { p };

    conf_path(program, "%s/ted4conf", folder);
    snprintf(threads, sizeof threads, "%d", place->threads);
    conf_process_start(p, &how, argv);
    while (conf_process_wait(one, 1, 100) < 0)
        ;
}
