/* encoder.c - see encoder.h. The encoder is run once, in a process group of its own. Its output is
 * judged by the validator and the strict decoder.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "encoder.h"

#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include "judge.h"
#include "scratch.h"
#include "ted4.h"

static void wrong(int *n, const char *what, const char *why)
{
    fprintf(stderr, "%s%s%s\n", what, why[0] != '\0' ? ": " : "", why);
    ++*n;
}

/* Hints are ignored, as they may be intended. A warning breaks a rule that binds encoders, or
 * points out wasted bits (3.6). */
static void finding(void *user, const ted4_finding *f)
{
    char text[400];

    if (f->severity == TED4_HINT)
        return;
    snprintf(text, sizeof text, "byte %zu: %s [%s] (%s)", f->offset, f->text, f->id, f->rule);
    wrong(user, f->severity == TED4_ERROR ? "not valid" : "a warning of the validator", text);
}

/* Checks that the hash which the encoder reports for its integers (15.2) is that of the decoded
 * ones. */
static void judge_hash(const json_t *answer, const ted4_info *info, int *n)
{
    const char *const said = json_string_value(json_object_get(answer, "hash"));
    char hex[2 * sizeof info->hash + 1];

    conf_hex(hex, info->hash, sizeof info->hash);
    if (said == NULL || strcmp(said, hex) != 0)
        wrong(n, "the decoded integers have another hash than the answer says", hex);
}

/* Sets *level if the file is valid. */
static void judge_file(const json_t *answer, const char *path, int *n, size_t *size, int *level)
{
    conf_bytes file = { NULL, 0, 0 };
    struct stat made;
    ted4_scene *s;
    ted4_info info;

    if (lstat(path, &made) != 0 || !S_ISREG(made.st_mode) || !conf_read(path, &file)) {
        wrong(n, "there is no file", "");
        return;
    }
    *size = file.size;
    (void)ted4_validate(file.data, file.size, NULL, finding, n);
    if (ted4_decode(file.data, file.size, NULL, &s, NULL) == TED4_OK) {
        ted4_scene_info(s, &info);
        *level = info.level;
        judge_hash(answer, &info, n);
    }
    ted4_scene_free(s);
    conf_free(&file);
}

/* Returns the encoder's answer as a new reference, or NULL with a message if there is none. */
static json_t *ask(const conf_encode_options *o, const char *path, int *n)
{
    const conf_process_options how = { o->encoder, NULL, o->timeout, 0 };
    const char *argv[] = {
        "--ted4-encode", o->scene, "-o", path, o->preset != NULL ? "--preset" : NULL,
        o->preset,       NULL
    };
    conf_process p, *list[1] = { &p };
    conf_verdict v;
    json_t *answer;

    conf_process_start(&p, &how, argv);
    while (conf_process_wait(list, 1, 100) < 0)
        ;
    answer = conf_judge_document(&p, &v);
    if (answer == NULL)
        wrong(n, "no answer", v.reason);
    conf_process_free(&p);
    return answer;
}

int conf_encode(const conf_encode_options *o)
{
    char folder[CONF_PATH], path[CONF_PATH];
    size_t size = 0;
    json_t *answer;
    int n = 0, level = 0;

    conf_scratch_make(folder);
    conf_path(path, "%s/out.ted4", folder);
    answer = ask(o, path, &n);
    if (answer != NULL)
        judge_file(answer, path, &n, &size, &level);
    conf_scratch_remove();
    json_decref(answer);
    printf("%s: %zu bytes, level %d: %s\n", o->scene, size, level,
           n == 0 ? "conforms" : "does not conform");
    return n > 0;
}
