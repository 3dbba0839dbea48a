#!/bin/sh
# The table of all training options in doc/switches.md agrees with options.def, entry for entry. `sh
# tests/lint/switches.sh print` prints the table, for pasting.
export LC_ALL=C
table() {
    awk '
    /^TED4_OPTION\(/ { entry = "" }
    { entry = entry $0 }
    entry ~ /^TED4_OPTION\(.*"\)$/ {
        help = entry; gsub(/" *"/, "", help); sub(/^[^"]*"/, "", help); sub(/"\)$/, "", help)
        values = entry; sub(/^TED4_OPTION\(/, "", values); sub(/, *".*$/, "", values)
        if (split(values, v, /, */) != 10) { print FILENAME ": " entry; exit 1 }
        row = "| `" v[3] "` | " v[4] " to " v[5]
        for (i = 6; i <= 10; i++) row = row " | " v[i]
        print row " | " help " |"
    }' ref-encoder/train/model/options.def
}
if [ "$1" = print ]; then table; exit 0; fi
there=$(sed -n '/^<!-- options -->$/,/^<!-- end of options -->$/p' doc/switches.md | grep '^| `')
[ "$there" = "$(table)" ] ||
    { echo "doc/switches.md is not what options.def says: sh tests/lint/switches.sh print";
        exit 1; }
