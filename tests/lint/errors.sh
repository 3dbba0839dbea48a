#!/bin/sh
# The table of identifiers in chapter 14 agrees with status.def, entry for entry. `sh
# tests/lint/errors.sh print` prints the table, for pasting.
export LC_ALL=C
table() {
    sed -n '/^TED4_STATUS(E_/{
        N
        s/^[^"]*"\([^"]*\)", *"\([^"]*\)",\n *"\([^"]*\)")$/| `\1` | \2 | \3 |/p
    }' ref-decoder/base/status.def
}
if [ "$1" = print ]; then table; exit 0; fi
for t in "$(table)"; do
    echo "$t" | while IFS= read -r line; do
        grep -qF "$line" spec/14-errors.md || { echo "spec/14-errors.md lacks: $line"; exit 1; }
    done || exit 1
done
[ "$(grep -c '^| `[a-z]*\.[a-z-]*` | [0-9]' spec/14-errors.md)" = "$(table | wc -l)" ] ||
    { echo "spec/14-errors.md lists other identifiers than status.def"; exit 1; }
