#!/bin/sh
# columns.sh [FILE...] - lines have at most 100 columns, in everything that is written by hand: C,
# tables of macros, shell, awk, Python, JavaScript, build rules, and the prose of Markdown. Exempt
# in Markdown are rows of tables, code blocks, pictures, and lines that consist of little more than
# a link or address; in shell, here-documents and lines with a quoted text of more than 70 columns,
# which a program is given or has to print. Also exempt are tables of the decoder that a program
# prints (norm/tables.c), and text between clang-format off and on.
export LC_ALL=C
# Files that are not committed yet belong to the project; other things in a checkout (.venv,
# node_modules) do not.
files() {
    if [ "$(git rev-parse --show-prefix 2>/dev/null)" = '' ] &&
        git ls-files --cached --others --exclude-standard 2>/dev/null | grep -qx Makefile; then
        git -c core.quotePath=off ls-files --cached --others --exclude-standard
    else
        find . -type d \( -name '.?*' ! -path ./.ci -o -name node_modules -o -name 'build*' \
            -o -name out -o -name __pycache__ \) -prune -o -type f -print | sed 's|^\./||'
    fi | grep -E '\.([ch]|def|sh|awk|py|js|mjs|mk|md)$|(^|/)Makefile$' |
        grep -vE '(^|/)corpus/|^shared/|^conformance/(vectors|generated)/' |
        grep -vx ref-decoder/norm/tables.c | sort -u |
        while IFS= read -r f; do [ ! -f "$f" ] || printf '%s\n' "$f"; done
}
if [ $# -eq 0 ]; then
    IFS='
'
    set -f
    # shellcheck disable=SC2046 # a line each
    set -- $(files)
fi
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
    # Without its longest word, an address or a link, little is left of the line.
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
