/* cover_goals.c - see cover.h: goals in groups, and which vectors reach them.
 * SPDX-License-Identifier: BSD-2-Clause */
#include "cover.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

enum { NAME = 160 };

static json_t *group_of(conf_cover *c, const char *group)
{
    json_t *g = json_object_get(c->groups, group);

    if (g == NULL) {
        g = json_object();
        json_object_set_new(c->groups, group, g);
    }
    return g;
}

void conf_goal(conf_cover *c, const char *group, const char *format, ...)
{
    char name[NAME];
    va_list a;

    va_start(a, format);
    (void)vsnprintf(name, sizeof name, format, a);
    va_end(a);
    if (json_object_get(group_of(c, group), name) == NULL)
        json_object_set_new(group_of(c, group), name, json_pack("[s,i]", "", 0));
}

void conf_reach(conf_cover *c, const char *group, const char *vector, const char *format, ...)
{
    char name[NAME];
    va_list a;
    json_t *goal;

    va_start(a, format);
    (void)vsnprintf(name, sizeof name, format, a);
    va_end(a);
    goal = json_object_get(group_of(c, group), name);
    if (goal == NULL)
        return;
    if (json_integer_value(json_array_get(goal, 1)) == 0)
        json_array_set_new(goal, 0, json_string(vector));
    json_integer_set(json_array_get(goal, 1), json_integer_value(json_array_get(goal, 1)) + 1);
}
