/* pages.c - takes the place of the parser of command lines in a program that is linked with it. The
 * program then writes a page about itself and ends:
 *     PROGRAM [SUBCOMMAND] man DATE | bash | zsh | fish
 * SPDX-License-Identifier: BSD-2-Clause */
#include "pages.h"

#include <stdlib.h>
#include <string.h>

/* The linker directs calls of ted4_arguments_next here (--wrap). */
int __wrap_ted4_arguments_next(const ted4_command *c, int argc, char **argv, const char **value);

int __wrap_ted4_arguments_next(const ted4_command *c, int argc, char **argv, const char **value)
{
    const char *const kind = argc > 1 ? argv[1] : "";

    *value = NULL;
    if (strcmp(kind, "man") == 0 && argc > 2) {
        ted4_pages_man(c, argv[2], stdout);
    } else if (strcmp(kind, "bash") == 0) {
        ted4_pages_bash(c, stdout);
    } else if (strcmp(kind, "zsh") == 0) {
        ted4_pages_zsh(c, stdout);
    } else if (strcmp(kind, "fish") == 0) {
        ted4_pages_fish(c, stdout);
    } else {
        fputs("pages: man DATE, bash, zsh or fish\n", stderr);
        exit(EXIT_FAILURE);
    }
    exit(fflush(stdout) == 0 ? EXIT_SUCCESS : EXIT_FAILURE);
}
