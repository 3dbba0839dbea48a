/* schema_check.h - checks whether a JSON value conforms to a schema of conformance/schema. Supports
 * those keywords of JSON Schema draft 7 that these files use for the output of programs: type,
 * enum, required, properties, additionalProperties (false), items, minimum, minItems, maxItems,
 * pattern. Header only.
 * SPDX-License-Identifier: BSD-2-Clause */
#ifndef TED4_SCHEMA_CHECK_H
#define TED4_SCHEMA_CHECK_H

#include <jansson.h>
#include <regex.h>
#include <stdio.h>
#include <string.h>

static inline int schema_type_is(json_t *v, const char *name)
{
    return (strcmp(name, "object") == 0 && json_is_object(v)) ||
           (strcmp(name, "array") == 0 && json_is_array(v)) ||
           (strcmp(name, "string") == 0 && json_is_string(v)) ||
           (strcmp(name, "integer") == 0 && json_is_integer(v)) ||
           (strcmp(name, "null") == 0 && json_is_null(v)) ||
           (strcmp(name, "boolean") == 0 && json_is_boolean(v));
}

/* Whether v is the wanted text, or one of a list of texts. */
static inline int schema_one_of(json_t *v, json_t *wanted, int (*is)(json_t *, json_t *))
{
    size_t i;
    json_t *w;

    if (!json_is_array(wanted))
        return is(v, wanted);
    json_array_foreach(wanted, i, w) if (is(v, w)) return 1;
    return 0;
}

static inline int schema_typed(json_t *v, json_t *name)
{
    return schema_type_is(v, json_string_value(name));
}

static inline int schema_equal(json_t *v, json_t *w)
{
    return json_equal(v, w);
}

static inline int schema_matches(const char *text, const char *pattern)
{
    regex_t r;
    int good;

    if (regcomp(&r, pattern, REG_EXTENDED | REG_NOSUB) != 0)
        return 0;
    good = regexec(&r, text, 0, NULL, 0) == 0;
    regfree(&r);
    return good;
}

static inline int schema_holds(json_t *schema, json_t *v);

static inline int schema_object_holds(json_t *schema, json_t *v)
{
    json_t *const properties = json_object_get(schema, "properties");
    const char *key;
    json_t *member, *name;
    size_t i;

    json_array_foreach(json_object_get(schema, "required"), i,
                       name) if (json_object_get(v, json_string_value(name)) == NULL) return 0;
    json_object_foreach(v, key, member)
    {
        json_t *const of = json_object_get(properties, key);

        if (of == NULL ? json_is_false(json_object_get(schema, "additionalProperties"))
                       : !schema_holds(of, member))
            return 0;
    }
    return 1;
}

static inline int schema_array_holds(json_t *schema, json_t *v)
{
    json_t *const least = json_object_get(schema, "minItems"), *const most = json_object_get(
                                                                   schema, "maxItems");
    json_t *const items = json_object_get(schema, "items");
    json_t *member;
    size_t i;

    if ((least != NULL && (json_int_t)json_array_size(v) < json_integer_value(least)) ||
        (most != NULL && (json_int_t)json_array_size(v) > json_integer_value(most)))
        return 0;
    json_array_foreach(v, i, member) if (items != NULL && !schema_holds(items, member)) return 0;
    return 1;
}

/* Returns 1 if v conforms to the schema, else 0. */
static inline int schema_holds(json_t *schema, json_t *v)
{
    json_t *const type = json_object_get(schema, "type"), *const list =
                                                              json_object_get(schema, "enum");
    json_t *const least = json_object_get(schema, "minimum"), *const pattern = json_object_get(
                                                                  schema, "pattern");

    if ((type != NULL && !schema_one_of(v, type, schema_typed)) ||
        (list != NULL && !schema_one_of(v, list, schema_equal)))
        return 0;
    if (least != NULL && json_is_integer(v) && json_integer_value(v) < json_integer_value(least))
        return 0;
    if (pattern != NULL && json_is_string(v) &&
        !schema_matches(json_string_value(v), json_string_value(pattern)))
        return 0;
    if (json_is_object(v))
        return schema_object_holds(schema, v);
    return !json_is_array(v) || schema_array_holds(schema, v);
}

#endif
