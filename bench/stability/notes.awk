# notes.awk - causes and mends, written by hand: bench/stability-notes.md. A heading "## SCENE VARIANT" (VARIANT *: all variants) begins the note of these
# runs; what stands before the first heading is for its readers alone. Takes -v notes: that file.
# SPDX-License-Identifier: BSD-2-Clause

function read_notes(    line, word, key) {
    while ((getline line <notes) > 0) {
        if (line ~ /^## /) {
            split(line, word, " ")
            key = word[2] " " word[3]
            unread[key] = 1
        } else if (key != "" && line != "") {
            gsub(/\|/, "\\|", line)
            note[key] = join(note[key], " ", line)
        }
    }
    close(notes)
}

# "" when there is none.
function note_of(s, v,    key) {
    key = (s " " v) in note ? s " " v : s " *"
    delete unread[key]
    return key in note ? note[key] : ""
}
