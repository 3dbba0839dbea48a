#!/bin/sh
# columns.sh [FILE...] - lines have at most 100 columns, in everything that is written by hand: C,
# tables of macros, shell, awk, Python, JavaScript, build rules, and the prose of Markdown. Left
# aside in Markdown: rows of tables, code blocks, pictures, and lines that are little else than one
# link or address; in shell: here-documents, and a quoted text of more than 70 columns, which a
# program is given or has to say. Tables of the decoder that a program prints (norm/tables.c) stay
# as they are printed, and so does text between clang-format off and on.
export LC_ALL=C
[ $# -gt 0 ] || set -- $(find . \
    -type d \( -name .git -o -name 'build*' -o -name corpus -o -name out -o -name __pycache__ \
        -o -path ./shared -o -path ./conformance/vectors -o -path ./conformance/generated \) \
    -prune \
    -o -type f \( -name '*.[ch]' -o -name '*.def' -o -name '*.sh' -o -name '*.awk' -o -name '*.py' \
        -o -name '*.js' -o -name '*.mjs' -o -name '*.mk' -o -name Makefile -o -name '*.md' \) \
    ! -path ./ref-decoder/norm/tables.c -print | sed 's|^\./||' | sort)
awk '
    FNR == 1 {
        block = aside = 0
        prose = FILENAME ~ /\.md$/
        shell = FILENAME ~ /\.sh$/
        document = ""
    }
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
