# words.awk - the page as it grows: lines, table cells, verdicts. Used by bench/report.sh.
# SPDX-License-Identifier: BSD-2-Clause

function say(line) { body[++n_body] = line }
function fixed(x, digits) { return x == "" ? "-" : sprintf("%." digits "f", x) }
function signed(x, digits, unit) { return x == "" ? "-" : sprintf("%+." digits "f", x) unit }
function size_of(x) { return x < 0 ? -x : x }
function join(list, separator, item) { return list == "" ? item : list separator item }

# A tag as tables show it: marked when other sources made its row.
function name_of(t) { return is_old(t) ? t "†" : t }
# The mark alone, for numbers that come from several rows: as many tags as wanted, divided by spaces.
function mark_of(tags,    i, n, t) {
    n = split(tags, t, " ")
    for (i = 1; i <= n; i++)
        if (is_old(t[i]))
            return "†"
    return ""
}

# Columns of a run's row as cells, divided by "|". names: divided by spaces, with ":DIGITS" where a number is rounded; team: jobs and threads.
function values(t, names,    n, i, part, half, text) {
    n = split(names, part, " ")
    for (i = 1; i <= n; i++) {
        text = text (i > 1 ? "|" : "")
        if (part[i] == "team")
            text = text get(t, "jobs") " x " get(t, "threads")
        else if (split(part[i], half, ":") > 1)
            text = text fixed(get(t, half[1]), half[2])
        else
            text = text get(t, part[i])
    }
    return text
}

# Begins a table of columns divided by commas.
function table(titles,    n, i, c, head, rule) {
    n = split(titles, c, ",")
    for (i = 1; i <= n; i++) {
        head = head "| " c[i] " "
        rule = rule "|---"
    }
    table_columns = n
    say("")
    say(head "|")
    say(rule "|")
}

# A row whose first cells are given, divided by "|", and whose others are empty; or one that says that its run is missing.
function row(cells,    n, unused) {
    n = split(cells, unused, "|")
    gsub(/\|/, " | ", cells)
    gsub(/  +/, " ", cells)
    for (; n < table_columns; n++)
        cells = cells " |"
    say("| " cells " |")
}
function row_missing(cells) { row(cells "|not run yet") }

# One line of the summary. number: of the bar. ok: 1 met, 0 missed, "" not run yet, "?" measured but says neither.
function bar(number, what, limit, measured, ok, how) {
    verdict = ok == "" ? "not run yet" : ok == "?" ? "cannot be said" : ok ? "met" : "**missed**"
    n_verdicts[verdict]++
    bars[++n_bars] = "| " number " | " what " | " limit " | " (measured == "" ? "-" : measured) " | " verdict " | " how " |"
}

# How the rows that match shell patterns are made.
function sweep(patterns) { return "`bench/sweep.sh" (patterns == "" ? "" : " " patterns) "`" }

# The picture of a chart that was drawn, or what is said in its place.
function show_chart(name, text) {
    say("")
    say(name in drawn ? "![" text "](charts/" name ".svg)" : "*" text "*: not run yet.")
}
