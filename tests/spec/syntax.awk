# syntax.awk - do the syntax tables of spec 5.1, 5.2 and 9.1 say what a decoder traces? Reads those
# two chapters, then a trace of ted4dec (offset, element[index] = value); -v bytes: size of the file
# that was traced. Says what differs and ends with status 1.
# SPDX-License-Identifier: BSD-2-Clause
function bad(what) { print FILENAME ": " what; failed = 1; exit 1 }

# Rows of the table of a section: element, type, and what the last column says.
FILENAME ~ /\.md$/ && /^## / { section = $2 }
FILENAME ~ /\.md$/ && /^\| [a-z]/ && section ~ /^(5\.1|5\.2|9\.1)$/ && !/^\| element / {
    split($0, cell, / *\| */)
    k = ++rows[section]
    element[section, k] = cell[2]; type[section, k] = cell[3]; says[section, k] = cell[4]
}
FILENAME ~ /\.md$/ { next }
{
    n++
    at[n] = $1; value[n] = $4
    name[n] = $2; sub(/\[.*/, "", name[n])
    item[n] = $2; gsub(/.*\[|\]/, "", item[n])
    if (!($2 in first)) first[$2] = $4
}

function head(what) { return first[what "[0]"] }
function width(of) { return substr(of, 2) / 8 }

# One number of so many bytes here: its value.
function number(what, index_, bytes_) {
    if (name[i] != what || item[i] != index_ || at[i] != place)
        bad("at " place " " what "[" index_ "] is expected, the trace has " \
            name[i] "[" item[i] "] at " at[i])
    place += bytes_
    return value[i++]
}

function in_list(x, list,   part, m, k) {
    gsub(/ or /, ", ", list)
    m = split(list, part, ", ")
    for (k = 1; k <= m; k++)
        if (part[k] + 0 == x)
            return 1
    return 0
}

# 5.1, whose last column gives values.
function file_header(   k, j, byte, v, list) {
    for (k = 1; k <= rows["5.1"]; k++)
        if (type["5.1", k] == "u8[8]") {
            split(substr(says["5.1", k], 2), byte, " ")
            for (j = 0; j < 8; j++) {
                v = number(element["5.1", k], j, 1)
                if (sprintf("%02X", v) != substr(byte[j + 1], 1, 2))
                    bad("byte " j " of the magic is " v)
            }
        } else {
            v = number(element["5.1", k], 0, width(type["5.1", k]))
            list = says["5.1", k]
            sub(/ *[(=].*/, "", list)
            if (!in_list(v, list))
                bad(element["5.1", k] " is " v ", not " list)
        }
}

# R-ENT-008.
function substreams() {
    return (head("temporal_mask") || head("offset_mask")) + head("n_slices") + 2 + \
        (head("phi_dim") > 0) + (head("activation") > 0)
}

function present(when) {
    if (when == "always" || when == "S of them")
        return 1
    split(when, word, " ")
    if (!((word[1] "[0]") in first) || word[2] != "=")
        bad("a condition that is not understood: " when)
    return head(word[1]) == word[3]
}

function tile(end,   k, j, what, count, size) {
    for (k = 1; k <= rows["9.1"]; k++) {
        what = element["9.1", k]
        if (!present(says["9.1", k]))
            continue
        if (what ~ /^substream/) {
            for (j = 0; j < substreams(); j++) {
                while (i <= n && name[i] !~ /_substream$/)
                    i++
                if (at[i] != place)
                    bad("substream " j " is expected at " place ", the trace has one at " at[i])
                i++
                place += size[j]
            }
            continue
        }
        count = what ~ /\[S\]/ ? substreams() : \
            what ~ /\[/ ? substr(what, index(what, "[") + 1) + 0 : 1
        sub(/\[.*/, "", what)
        for (j = 0; j < count; j++)
            size[j] = number(what, j, width(type["9.1", k]))
    }
    if (place != end)
        bad("a tile ends at " place ", not at " end)
}

function chunk(   k, what, kind, size, end) {
    for (k = 1; k <= rows["5.2"]; k++) {
        what = "chunk_" element["5.2", k]
        if (element["5.2", k] == "payload") {
            end = place + size
            if (kind == 1162627412)             # "TILE" as u32
                tile(end)
            while (i <= n && at[i] < end)
                i++
            place = end
        } else if (element["5.2", k] == "size")
            size = number(what, 0, width(type["5.2", k]))
        else if (element["5.2", k] == "type")
            kind = number(what, 0, 4)
        else
            number(what, 0, width(type["5.2", k]))
    }
}

END {
    if (failed)
        exit 1
    if (rows["5.1"] == 0 || rows["5.2"] == 0 || rows["9.1"] == 0)
        bad("a table was not found")
    i = 1
    place = 0
    file_header()
    while (!failed && i <= n)
        chunk()
    if (place != bytes)
        bad("the trace ends at " place " of " bytes " bytes")
}
