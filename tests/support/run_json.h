/* run_json.h - runs a program of this project on bytes, as a user would, and reads the JSON that it
 * prints: for test_lenient.c and test_validate.c.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_RUN_JSON_H
#define TED4_RUN_JSON_H

#include <jansson.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>
#include "temporary.h"
#include "test.h"

/* program: a program in the folder $TED4_BUILD, with options; the file's path is appended. Returns
 * the exit code. *printed: the JSON on stdout, owned by the caller. */
static inline int run_json(const char *program, const uint8_t *data, size_t size, json_t **printed)
{
    char path[TEMPORARY_SIZE], command[512];
    const int fd = temporary_file(path, "ted4-run");
    FILE *pipe;
    int status;

    assert_int_equal(write(fd, data, size), (ssize_t)size);
    close(fd);
    snprintf(command, sizeof command, "'%s'/%s '%s' 2>/dev/null", getenv("TED4_BUILD"), program,
             path);
    pipe = popen(command, "r");
    assert_non_null(pipe);
    *printed = json_loadf(pipe, 0, NULL);
    status = pclose(pipe);
    remove(path);
    assert_non_null(*printed);
    assert_true(WIFEXITED(status));
    return WEXITSTATUS(status);
}

#endif
