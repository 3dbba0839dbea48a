# rules.awk - annex G: every rule of the chapters and annexes named, in order of appearance. A rule
# begins a paragraph with its identifier in bold and ends with it. With -v json=1 spec/rules.json:
# the same, with file and text of each; -v spec=, the versions of the specification.
# SPDX-License-Identifier: BSD-2-Clause
BEGIN {
    split("BIT bitstream DEC decoder LEN lenient-decoder ENC encoder EDT editor VAL validator " \
          "EXT author DMP test TOL decoder SEC decoder MED player INT decoder ERR decoder " \
          "ARI decoder REC decoder XXH decoder DEF stream", pair, " ")
    for (i = 1; i in pair; i += 2)
        whom[pair[i]] = pair[i + 1]
    if (json)
        print "{\"spec\":\"" spec "\",\"license\":\"CC-BY-4.0\",\"rules\":["
    else
        heading()
}

function heading() {
    print "# Annex G (informative): index of rules"
    print ""
    print "`make spec-annexes` generates this annex from the text. Rules that bind \"stream\" " \
        "are those that a"
    print "byte string can break; the other rules bind the party that the column names. The word " \
        "is the"
    print "strongest of BCP 14 in the rule."
    print ""
    print "| rule | section | binds | word | errors |"
    print "|---|---|---|---|---|"
}

# A text between quotes. Backslashes and quotes are all that needs care: there are no control
# characters in the chapters.
function quoted(text) {
    gsub(/\\/, "&&", text)
    gsub(/"/, "\\\"", text)
    return "\"" text "\""
}

function print_json(kind, word, errors) {
    sub(/^\*\*R-[A-Z]*-[0-9]*\*\* */, "", text)
    gsub(/`/, "\"", errors)
    gsub(/ /, ",", errors)
    printf "%s{\"id\":\"%s\",\"file\":\"%s\",\"section\":\"%s\",\"binds\":\"%s\",", next_line, \
        rule, file, section, kind
    printf "\"word\":\"%s\",\"errors\":[%s],\"text\":%s}", word, errors, quoted(text)
    next_line = ",\n"
}

function flush_rule(   word, errors, rest, id, kind) {
    if (rule == "")
        return
    word = text ~ /MUST/ ? "MUST" : text ~ /SHOULD/ ? "SHOULD" : text ~ /MAY/ ? "MAY" : "none"
    rest = text
    while (match(rest, /`[a-z]+\.[a-z]+(-[a-z]+)*`/)) {
        id = substr(rest, RSTART + 1, RLENGTH - 2)
        if (id ~ /^(con|hdr|net|pos|ent|att|rec|syn|lvl|limit|unsupported|query|io)\./ &&
            index(errors, "`" id "`") == 0)
            errors = errors (errors == "" ? "" : " ") "`" id "`"
        rest = substr(rest, RSTART + RLENGTH)
    }
    kind = substr(rule, 3, 3)
    if (text ~ /\*\* An encoder/)
        kind = "encoder"
    else if (kind in whom)
        kind = whom[kind]
    else
        kind = errors ~ /`(con|hdr|net|pos|ent|att|syn|lvl|unsupported)\./ ? "stream" : "decoder"
    if (json)
        print_json(kind, word, errors)
    else
        printf "| %s | %s | %s | %s | %s |\n", rule, section, kind, word, errors
    rule = ""
}

FNR == 1 { flush_rule(); code = 0; file = FILENAME; sub(/.*\//, "", file) }
/^```/ { code = !code }
code { next }
/^#+ / {
    flush_rule()
    section = $2
    if (section == "Annex")
        section = $3
}
/^\*\*R-[A-Z][A-Z][A-Z]-[0-9][0-9][0-9]\*\*/ {
    flush_rule()
    rule = substr($1, 3, 9)
    text = $0
    next
}
/^$/ { flush_rule() }
rule != "" { text = text " " $0 }
END { flush_rule(); if (json) print "\n]}" }
