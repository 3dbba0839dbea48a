# SPDX-License-Identifier: BSD-2-Clause
"""JSON schemas as far as conformance/schema uses them."""

import json
import os
import re

SCHEMAS = os.path.join("conformance", "schema")
TYPES = {
    "object": lambda v: isinstance(v, dict), "array": lambda v: isinstance(v, list),
    "string": lambda v: isinstance(v, str),
    "integer": lambda v: isinstance(v, int) and not isinstance(v, bool),
    "boolean": lambda v: isinstance(v, bool), "null": lambda v: v is None,
    "number": lambda v: isinstance(v, (int, float)) and not isinstance(v, bool),
}


def load(path):
    with open(path, encoding="utf-8") as file:
        return json.load(file)


class Schema:
    """The keywords of JSON Schema draft 7 that the files of conformance/schema use; any other is an
    error."""

    def __init__(self, name):
        self.name, self.root = name, load(os.path.join(SCHEMAS, name))

    def check(self, value):
        """Where and why the value violates the schema; [] if it does not."""
        return list(self.errors(value, self.root, "$"))

    def errors(self, value, schema, at):
        for keyword, operand in schema.items():
            if keyword in ("$schema", "title", "description", "definitions"):
                continue
            yield from getattr(self, "on_" + keyword.replace("$", ""))(value, operand, at, schema)

    def on_ref(self, value, operand, at, _):
        name, _, path = operand.partition("#")
        target = Schema(name) if name else self
        found = target.root
        for part in path.strip("/").split("/") if path else []:
            found = found[part]
        yield from target.errors(value, found, at)

    def on_type(self, value, operand, at, _):
        if not any(TYPES[name](value)
                   for name in (operand if isinstance(operand, list) else [operand])):
            yield "%s: not %s" % (at, operand)

    def on_enum(self, value, operand, at, _):
        if value not in operand:
            yield "%s: %r is none of %r" % (at, value, operand)

    def on_const(self, value, operand, at, _):
        if value != operand or isinstance(value, bool) != isinstance(operand, bool):
            yield "%s: %r is not %r" % (at, value, operand)

    def on_required(self, value, operand, at, _):
        if isinstance(value, dict):
            yield from ("%s: no %s" % (at, name) for name in operand if name not in value)

    def on_properties(self, value, operand, at, _):
        for name, schema in operand.items() if isinstance(value, dict) else ():
            if name in value:
                yield from self.errors(value[name], schema, "%s.%s" % (at, name))

    def on_additionalProperties(self, value, operand, at, schema):
        for name in value if isinstance(value, dict) else ():
            if name in schema.get("properties", {}):
                continue
            if operand is False:
                yield "%s: %s is not known" % (at, name)
            elif isinstance(operand, dict):
                yield from self.errors(value[name], operand, "%s.%s" % (at, name))

    def on_items(self, value, operand, at, _):
        for i, item in enumerate(value if isinstance(value, list) else ()):
            yield from self.errors(item, operand, "%s[%d]" % (at, i))

    def on_contains(self, value, operand, at, _):
        if isinstance(value, list) and all(list(self.errors(v, operand, at)) for v in value):
            yield "%s: lacks what it must contain" % at

    def on_anyOf(self, value, operand, at, _):
        if all(list(self.errors(value, schema, at)) for schema in operand):
            yield "%s: is none of what it may be" % at

    def on_minItems(self, value, operand, at, _):
        if isinstance(value, list) and len(value) < operand:
            yield "%s: too few" % at

    def on_maxItems(self, value, operand, at, _):
        if isinstance(value, list) and len(value) > operand:
            yield "%s: too many" % at

    def on_minLength(self, value, operand, at, _):
        if isinstance(value, str) and len(value) < operand:
            yield "%s: too short" % at

    def on_minimum(self, value, operand, at, _):
        if TYPES["number"](value) and value < operand:
            yield "%s: below %s" % (at, operand)

    def on_maximum(self, value, operand, at, _):
        if TYPES["number"](value) and value > operand:
            yield "%s: above %s" % (at, operand)

    def on_pattern(self, value, operand, at, _):
        if isinstance(value, str) and not re.search(operand, value):
            yield "%s: %r does not fit %s" % (at, value, operand)
