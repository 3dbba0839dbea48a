/* judge.c - see judge.h.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "judge.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

const char *const conf_outcome_name[CONF_OUTCOMES] = { "pass",     "fail",    "no answer",
                                                       "declined", "missing", "not run" };

static void say(conf_verdict *v, conf_outcome outcome, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
static void say(conf_verdict *v, conf_outcome outcome, const char *format, ...)
{
    va_list a;

    v->outcome = outcome;
    va_start(a, format);
    (void)vsnprintf(v->reason, sizeof v->reason, format, a);
    va_end(a);
}

json_t *conf_judge_document(const conf_process *p, conf_verdict *v)
{
    json_error_t why;
    json_t *o;

    switch (p->end) {
    case CONF_CRASHED:
        say(v, CONF_NO_ANSWER, "ended by signal %d; stderr: %s", p->code,
            (const char *)p->complaint.data);
        return NULL;
    case CONF_HUNG:
        say(v, CONF_NO_ANSWER, "no answer within %.1f s", p->options->timeout);
        return NULL;
    case CONF_TOO_LONG:
        say(v, CONF_NO_ANSWER, "more than %d bytes of output", CONF_MAX_OUTPUT);
        return NULL;
    default: break;
    }
    if (p->code != 0) {
        say(v, CONF_NO_ANSWER, "exit code %d, where a verdict is exit code 0; stderr: %s", p->code,
            (const char *)p->complaint.data);
        return NULL;
    }
    if (p->answer.size == 0) {
        say(v, CONF_NO_ANSWER, "nothing on stdout");
        return NULL;
    }
    o = json_loadb((const char *)p->answer.data, p->answer.size, JSON_REJECT_DUPLICATES, &why);
    if (!json_is_object(o)) {
        say(v, CONF_NO_ANSWER, "stdout is not one JSON object and nothing else: %s: %.60s",
            o == NULL ? why.text : "not an object", (const char *)p->answer.data);
        json_decref(o);
        return NULL;
    }
    return o;
}

static int holds(const json_t *array, const char *text)
{
    for (size_t i = 0; i < json_array_size(array); i++) {
        const char *const s = json_string_value(json_array_get(array, i));

        if (s != NULL && strcmp(s, text) == 0)
            return 1;
    }
    return 0;
}

static const char *text_of(const json_t *o, const char *key)
{
    const char *const s = json_string_value(json_object_get(o, key));

    return s != NULL ? s : "";
}

static int is_one_of(const char *text, const char *const *known, size_t n)
{
    for (size_t i = 0; i < n; i++)
        if (strcmp(text, known[i]) == 0)
            return 1;
    return 0;
}

/* Returns 1 if o is an array of texts, all of which are known; n = 0: any texts. */
static int is_list_of(const json_t *o, const char *const *known, size_t n)
{
    for (size_t i = 0; i < json_array_size(o); i++) {
        const char *const s = json_string_value(json_array_get(o, i));

        if (s == NULL || (n > 0 && !is_one_of(s, known, n)))
            return 0;
    }
    return json_is_array(o);
}

/* Levels that can be claimed: 1 to 4, and 31 (R-DEC-007). */
static int is_level(const json_t *o)
{
    const json_int_t level = json_integer_value(o); /* 0 if it is no integer */

    return (level >= 1 && level <= 4) || level == 31;
}

/* Returns the first member that schema/capabilities.schema.json requires and c lacks, or that is
 * not what the schema says; NULL if there is none. */
static const char *capability_wrong(const json_t *c)
{
    static const char *const text[] = { "name", "version", "spec" };
    static const char *const profile[] = { "Main", "Compact" };
    static const char *const tier[] = { "T0", "T1", "T2", "T3", "T4", "T5" };
    static const char *const class[] = { "X", "T" };
    const json_t *const lenient = json_object_get(c, "lenient");

    for (size_t i = 0; i < sizeof text / sizeof *text; i++)
        if (!json_is_string(json_object_get(c, text[i])))
            return text[i];
    if (!is_list_of(json_object_get(c, "profiles"), profile, sizeof profile / sizeof *profile))
        return "profiles";
    if (!is_level(json_object_get(c, "max_level")))
        return "max_level";
    if (!is_list_of(json_object_get(c, "tiers"), tier, sizeof tier / sizeof *tier))
        return "tiers";
    if (!json_is_null(json_object_get(c, "class")) &&
        !is_one_of(text_of(c, "class"), class, sizeof class / sizeof *class))
        return "class";
    if (!json_is_boolean(json_object_get(c, "strict")))
        return "strict";
    if (lenient != NULL && !json_is_boolean(lenient))
        return "lenient";
    if (!is_list_of(json_object_get(c, "declines"), NULL, 0))
        return "declines";
    return is_list_of(json_object_get(c, "knobs"), NULL, 0) ? NULL : "knobs";
}

int conf_judge_capabilities(const json_t *c, conf_verdict *v)
{
    const char *const wrong = capability_wrong(c);

    if (json_integer_value(json_object_get(c, "protocol")) != 1)
        say(v, CONF_NO_ANSWER, "capabilities: protocol is not 1");
    else if (wrong != NULL)
        say(v, CONF_NO_ANSWER, "capabilities: %s is missing, or not what it has to be", wrong);
    else if (text_of(c, "name")[0] == '\0')
        say(v, CONF_NO_ANSWER, "capabilities: the name is empty");
    else if (!holds(json_object_get(c, "profiles"), "Main"))
        say(v, CONF_NO_ANSWER, "capabilities: profiles lacks Main, which every decoder has (3)");
    else if (json_array_size(json_object_get(c, "tiers")) == 0)
        say(v, CONF_NO_ANSWER, "capabilities: no tiers");
    else if (json_is_string(json_object_get(c, "class")) &&
             !holds(json_object_get(c, "tiers"), "T5"))
        say(v, CONF_NO_ANSWER, "capabilities: a class is claimed, but not T5, which shows it");
    else
        return 1;
    return 0;
}

const char *conf_judge_lacks(const json_t *c)
{
    static const char *const tier[] = { "T0", "T1", "T2", "T3", "T4" };

    for (size_t i = 0; i < sizeof tier / sizeof *tier; i++)
        if (!holds(json_object_get(c, "tiers"), tier[i]))
            return tier[i];
    return NULL;
}

int conf_has_knob(const json_t *capabilities, const char *name)
{
    return holds(json_object_get(capabilities, "knobs"), name);
}

/* Every decoder has to refuse invalid files. */
int conf_judge_declines(const json_t *capabilities, const json_t *d)
{
    const json_t *const features = json_object_get(d, "features"), *const knobs =
                                                                       json_object_get(d, "knobs");
    const char *const result = text_of(json_object_get(d, "expect"), "result");
    const char *knob;
    json_t *value;

    if (strcmp(result, "invalid") == 0 || strcmp(result, "unsupported") == 0)
        return 0;
    for (size_t i = 0; i < json_array_size(features); i++)
        if (holds(json_object_get(capabilities, "declines"),
                  json_string_value(json_array_get(features, i))))
            return 1;
    json_object_foreach((json_t *)(uintptr_t)knobs, knob,
                        value) if (!conf_has_knob(capabilities, knob)) return 1;
    return 0;
}

int conf_expects(const json_t *d, const char *result)
{
    return strcmp(text_of(json_object_get(d, "expect"), "result"), result) == 0;
}

int conf_judge_lenient(const json_t *capabilities)
{
    return json_is_true(json_object_get(capabilities, "lenient"));
}

int conf_same_hash(const json_t *want, const json_t *got)
{
    static const char *const name[] = { "xxh3", "sha256" };
    const json_t *const bytes = json_object_get(got, "bytes");
    int n = 0;

    if (bytes != NULL && !json_equal(json_object_get(want, "bytes"), bytes))
        return 0;
    for (size_t i = 0; i < 2; i++)
        if (json_object_get(got, name[i]) != NULL) {
            if (!json_equal(json_object_get(want, name[i]), json_object_get(got, name[i])))
                return 0;
            n++;
        }
    return n > 0;
}

static int judge_queries(const json_t *want, const json_t *got, conf_verdict *v)
{
    if (!json_is_array(got) || json_array_size(got) != json_array_size(want)) {
        say(v, CONF_FAIL, "T5: %zu results for %zu queries", json_array_size(got),
            json_array_size(want));
        return 0;
    }
    for (size_t i = 0; i < json_array_size(want); i++) {
        const json_t *const w = json_array_get(want, i), *const g = json_array_get(got, i);
        const json_t *const error = json_object_get(w, "error"), *const found =
                                                                     json_object_get(g, "error");
        const char *const why = error != NULL && !json_equal(error, found) ? "should have no result"
                                : error == NULL && found != NULL           ? "should have a result"
                                : error == NULL && !conf_same_hash(w, g)   ? "other records"
                                                                           : NULL;

        if (why != NULL) {
            say(v, CONF_FAIL, "T5: query %zu: %s", i, why);
            return 0;
        }
    }
    return 1;
}

/* Reports the first tier that differs, where the search should begin. A salvaged scene has no T0.
 */
static void judge_tiers(const json_t *capabilities, const json_t *want, const json_t *got,
                        conf_verdict *v)
{
    const char *const class = text_of(capabilities, "class");

    for (int t = 0; t < 6; t++) {
        const char name[3] = { 'T', (char)('0' + t), '\0' };
        const json_t *const w = json_object_get(want, name), *const g = json_object_get(got, name);

        if (w == NULL || !holds(json_object_get(capabilities, "tiers"), name) ||
            (t == 5 && strcmp(class, "X") != 0))
            continue;
        if (t == 5) {
            if (!judge_queries(w, g, v))
                return;
        } else if (!conf_same_hash(w, g)) {
            say(v, CONF_FAIL, "%s: %s", name,
                g == NULL ? "missing" : "another hash or size, or no hash");
            return;
        }
    }
    say(v, CONF_PASS, "%s", "");
}

/* Returns 1 if pass 1 finds the expected error. A limit may precede only errors of pass 2
 * (R-ERR-005). Either pass may find con.chunk-order (5.3), so it is not listed. */
static int is_of_pass_1(const json_t *expect)
{
    static const char *const id[] = { "con.truncated",        "con.magic",
                                      "con.version",          "con.level",
                                      "con.reserved",         "con.chunk-hash",
                                      "con.unknown-critical", "con.trailing",
                                      "unsupported.profile" };
    enum {
        LEVEL_AT = 11
    }; /* the offset at which the bound on the file's size is judged (R-LVL-003) */
    const char *const error = text_of(expect, "error");

    for (size_t i = 0; i < sizeof id / sizeof *id; i++)
        if (strcmp(error, id[i]) == 0)
            return 1;
    return strcmp(error, "lvl.exceeded") == 0 &&
           json_integer_value(json_object_get(expect, "offset")) == LEVEL_AT;
}

enum { PROFILE_AT = 10 };

/* Returns whether a decoder has the profile; one that does not say has all. */
static int has_profile(const json_t *capabilities, const char *profile)
{
    const json_t *const profiles = json_object_get(capabilities, "profiles");

    return profiles == NULL || holds(profiles, profile);
}

static int is_limit(const json_t *answer)
{
    return strcmp(text_of(answer, "result"), "limit") == 0 &&
           strncmp(text_of(answer, "error"), "limit.", 6) == 0;
}

/* Judges an answer that should refuse the file of a profile that the decoder does not have. */
static void judge_other_profile(const json_t *answer, conf_verdict *v)
{
    if (strcmp(text_of(answer, "result"), "unsupported") == 0 &&
        strcmp(text_of(answer, "error"), "unsupported.profile") == 0 &&
        json_integer_value(json_object_get(answer, "offset")) == PROFILE_AT)
        say(v, CONF_DECLINED, "of a profile that the decoder does not have");
    else
        say(v, CONF_FAIL, "should be unsupported.profile at %d, as the decoder claims no such one",
            PROFILE_AT);
}

static void say_other(conf_verdict *v, const json_t *expect, const json_t *answer)
{
    const char *const want = text_of(expect, "error"), *const got = text_of(answer, "error");

    say(v, CONF_FAIL, "should be %s%s%s, is %s%s%s", text_of(expect, "result"),
        want[0] != '\0' ? " " : "", want, text_of(answer, "result"), got[0] != '\0' ? " " : "",
        got);
}

/* Judges the error of an answer with the right result, which is not valid. */
static void judge_error(const json_t *d, const json_t *answer, conf_verdict *v)
{
    const json_t *const expect = json_object_get(d, "expect"), *const offset = json_object_get(
                                                                   expect, "offset");
    const json_t *const at = json_object_get(answer, "offset");
    const char *const error = text_of(expect, "error");
    /* R-LVL-008 prescribes which limit is met under max_work. */
    const int any = conf_expects(d, "limit") &&
                    json_object_get(json_object_get(d, "knobs"), "max_work") == NULL;

    if (any ? !is_limit(answer) : strcmp(error, text_of(answer, "error")) != 0)
        say(v, CONF_FAIL, "should be %s, is %s", error, text_of(answer, "error"));
    else if (offset != NULL && !json_is_integer(at))
        say(v, CONF_FAIL, "%s: the offset is missing, or no integer", error);
    else if (offset != NULL && !json_equal(offset, at))
        say(v, CONF_FAIL, "%s at %lld, should be at %lld", error, (long long)json_integer_value(at),
            (long long)json_integer_value(offset));
    else if (json_object_get(answer, "tiers") != NULL)
        say(v, CONF_FAIL, "delivers tiers of a file that is not valid (R-DEC-003)");
    else
        say(v, CONF_PASS, "%s", "");
}

void conf_judge(const json_t *capabilities, const json_t *d, const json_t *answer, conf_verdict *v)
{
    const json_t *const expect = json_object_get(d, "expect");
    const char *const want = text_of(expect, "result"), *const got = text_of(answer, "result");

    if (!has_profile(capabilities, text_of(d, "profile"))) {
        judge_other_profile(answer, v);
    } else if (strcmp(got, "limit") == 0 && !is_limit(answer)) {
        say(v, CONF_FAIL, "limit, but the error \"%.40s\" is no limit", text_of(answer, "error"));
    } else if (holds(json_object_get(expect, "also_ok"), got)) {
        say(v, CONF_PASS, "%s, which the specification allows too", got);
    } else if (strcmp(want, "limit") != 0 && is_limit(answer) && !is_of_pass_1(expect) &&
               json_integer_value(json_object_get(d, "level")) >
                   json_integer_value(json_object_get(capabilities, "max_level"))) {
        say(v, CONF_DECLINED, "above the decoder's greatest level");
    } else if (got[0] == '\0') {
        say(v, CONF_FAIL, "the result is missing, or no text");
    } else if (strcmp(want, got) != 0) {
        say_other(v, expect, answer);
    } else if (strcmp(want, "valid") == 0) {
        judge_tiers(capabilities, json_object_get(d, "tiers"), json_object_get(answer, "tiers"), v);
    } else {
        judge_error(d, answer, v);
    }
}

void conf_judge_salvage(const json_t *capabilities, const json_t *d, const json_t *answer,
                        conf_verdict *v)
{
    static const char *const name[] = { "tiles", "tiles_declared", "anchors", "anchors_declared",
                                        "error", "offset",         "hash" };
    const json_t *const want = json_object_get(d, "salvage"), *const got = json_object_get(
                                                                  answer, "salvage");

    if (!json_is_object(want)) {
        if (got != NULL && !json_is_null(got))
            say(v, CONF_FAIL, "lenient mode: nothing can be salvaged, but something is");
        return;
    }
    for (size_t i = 0; i < sizeof name / sizeof *name; i++)
        if (!json_equal(json_object_get(want, name[i]), json_object_get(got, name[i]))) {
            say(v, CONF_FAIL, "lenient mode: %s",
                json_is_object(got) ? name[i] : "nothing is salvaged");
            return;
        }
    judge_tiers(capabilities, json_object_get(want, "tiers"), json_object_get(got, "tiers"), v);
    if (v->outcome == CONF_FAIL) {
        const conf_verdict tier = *v;

        say(v, CONF_FAIL, "lenient mode: %.300s", tier.reason);
    }
}
