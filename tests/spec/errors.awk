# errors.awk - spec/errors.json: the identifiers of status.def, with what each means for the verdict
# (14.1) and the rules of annex G that name it. Reads spec/annex-g-rules.md, then
# ref-decoder/base/status.def. -v spec=: the versions of the specification.
# SPDX-License-Identifier: BSD-2-Clause
BEGIN { print "{\"spec\":\"" spec "\",\"license\":\"CC-BY-4.0\",\"errors\":[" }

/^\| R-/ {
    split($0, column, / *\| */)
    n = split(column[6], name, " ")
    for (i = 1; i <= n; i++)
        if (name[i] ~ /^`/) {
            id = substr(name[i], 2, length(name[i]) - 2)
            rules[id] = rules[id] (rules[id] == "" ? "" : ",") "\"" column[2] "\""
        }
}

function result(id) {
    if (id ~ /^(limit|unsupported|io)\./)
        return substr(id, 1, index(id, ".") - 1)
    return id == "rec.non-finite" || id == "query.range" ? "query" : "invalid"
}

# An entry: its text is on a line of its own.
/^TED4_STATUS\(/ { entry = "" }
{ entry = entry $0 }
entry ~ /^TED4_STATUS\(.*"\)$/ {
    split(entry, part, "\"")
    printf "%s{\"id\":\"%s\",\"result\":\"%s\",\"section\":\"%s\",\"text\":\"%s\",", next_line, \
        part[2], result(part[2]), part[4], part[6]
    printf "\"rules\":[%s]}", rules[part[2]]
    next_line = ",\n"
}

END { print "\n]}" }
