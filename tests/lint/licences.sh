#!/bin/sh
# The licence of a source is a tag that programs search for: whole on its line, followed by nothing
# but the end of the comment. Every C source has one, on a line of its own, since clang-format may
# join it to the text before it, and then break it. Sources of fuzz/ and ref-decoder/{kernel,norm},
# which do not change during a fuzzing campaign, may have it after other text, and fuzz/parse.c in
# two pieces.
export LC_ALL=C
folders="ref-decoder ref-encoder conformance tests fuzz bench tools player spec doc python .ci"
find $folders -type d \( -name __pycache__ -o -name node_modules \) -prune -o -type f \
    ! -name licences.sh \( -name '*.[ch]' -o -name '*.def' -o -name '*.sh' -o -name '*.awk' \
    -o -name '*.py' -o -name '*.js' -o -name '*.mjs' -o -name '*.ts' -o -name '*.mk' \
    -o -name '*.css' \) -print | sort | xargs awk '
    function bad(what) { print FILENAME ": " what; wrong = 1 }
    function ended() { if (name ~ /\.[ch]$/ && !tagged) { print name ": no licence"; wrong = 1 } }
    FNR == 1 { ended(); name = FILENAME; tagged = 0 }
    !/SPDX-License-Identifier:/ || /^ *"/ { next }                  # also where a program prints it
    { tagged = 1 }
    !/SPDX-License-Identifier: (BSD-2-Clause|CC0-1.0|CC-BY-4.0)[ *\/">-]*$/ {
        if (FILENAME != "fuzz/parse.c")
            bad("a licence in pieces")
        next
    }
    name ~ /\.[ch]$/ && name !~ /^(fuzz|ref-decoder\/(kernel|norm))\// &&
        !/^( \*|\/\*)? *SPDX-License-Identifier:/ { bad("a licence behind other text") }
    END { ended(); exit wrong }'
