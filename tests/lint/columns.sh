#!/bin/sh
# columns.sh [FILE...] - lines have at most 100 columns: C and the prose of Markdown everywhere, and
# shell, awk, Python, JavaScript and build rules in the folders named below. Left aside in Markdown:
# rows of tables, code blocks, pictures, and lines that are little else than one link or address;
# in shell: here-documents, and a quoted text of more than 70 columns, which a program is given
# or has to say. Tables of the decoder that a program prints (norm/tables.c) stay as they are
# printed, and so does text between clang-format off and on.
export LC_ALL=C
scripts='tests tools bench player python ref-decoder ref-encoder'
[ $# -gt 0 ] || set -- $({
    find . \( -name .git -o -name 'build*' -o -name corpus -o -name out \
        -o -path ./conformance/vectors -o -path ./conformance/generated \) -prune \
        -o -type f \( -name '*.[ch]' -o -name '*.md' \) ! -path ./ref-decoder/norm/tables.c -print
    find $scripts -type f \( -name '*.sh' -o -name '*.awk' -o -name '*.py' -o -name '*.mk' \
        -o -name '*.js' -o -name '*.mjs' \)
} | sed 's|^\./||' | sort)
awk '
    FNR == 1 { block = aside = 0; prose = FILENAME ~ /\.md$/; shell = FILENAME ~ /\.sh$/; document = "" }
    {
        line = $0
        gsub(/[\200-\277]/, "", line)
        while ((at = index(line, "\t")) > 0)
            line = substr(line, 1, at - 1) substr("        ", (at - 1) % 8 + 1) \
                substr(line, at + 1)
    }
    /clang-format off/ { aside = 1 }
    /clang-format on/ { aside = 0 }
    aside { next }
    document != "" { if ($1 == document) document = ""; next }
    shell && match(line, /<<-?'"'"'?[A-Z]+/) {
        document = substr(line, RSTART, RLENGTH)
        gsub(/[^A-Z]/, "", document)
    }
    prose && /^ *```/ { block = !block }
    length(line) <= 100 { next }
    prose && (block || /^    / || /^ *\|/ || /^!\[/) { next }
    shell && match(line, /'"'"'[^'"'"']*'"'"'|"([^"\\]|\\.)*"/) && RLENGTH > 70 { next }
    # What stays of the line without its longest word, an address or a link, says nothing.
    prose && /:\/\/|\]\(/ {
        longest = 0
        n = split(line, word, / +/)
        for (i = 1; i <= n; i++)
            if (length(word[i]) > longest)
                longest = length(word[i])
        if (longest > 60)
            next
    }
    { print FILENAME ":" FNR ": " length(line) " columns"; bad = 1 }
    END { exit bad }' "$@"
