# branches.awk - how much of norm/ and read/ the published vectors take.
#     awk -f branches.awk EXCLUDED SUITE TESTS
# EXCLUDED is branches-excluded.txt; SUITE and TESTS are tables of branches.sh, after the vectors
# and after the tests.
# Outcomes that only a failing allocation, a caller's mistake or a writer can take stand apart, and
# a test has to take them. Those that are listed for another reason count as not taken. Prints every
# outcome that is not taken, each mistake of the list, totals. Fails below 99 %, and when the list
# is wrong: a line that is not there or there twice, an outcome that the vectors take, one that
# stands apart and no test takes.
# SPDX-License-Identifier: BSD-2-Clause
BEGIN { FS = "\t" }
FNR == 1 { part++ }

# file: function: source line | reason outcome,outcome,... | why
part == 1 {
    if ($0 ~ /^#/ || $0 == "")
        next
    if (!match($0, / \| (allocation|caller|writer|machine|size|never) [0-9][0-9,]* \| /)) {
        complain("not in the form of an entry: " $0)
        next
    }
    place = substr($0, 1, RSTART - 1)
    split(substr($0, RSTART + 3, RLENGTH - 6), what, " ")
    n = split(what[2], outcome, ",")
    for (i = 1; i <= n; i++)
        reason[place, outcome[i]] = what[1]
    listed[place] = 1
    next
}

{ place = $1 ": " $2 ": " $6 }

part == 2 {
    if (place in listed) {
        if (place in line && line[place] != $3)
            complain("stands there twice: " place)
        line[place] = $3
    }
    taken[place, $4] = 0
    total++
    good += $5
    why = reason[place, $4]
    seen[place, $4] = 1
    if ($5 && why != "")
        complain("excluded, but the vectors take it: " place " | " $4)
    if ($5)
        next
    apart = why == "allocation" || why == "caller" || why == "writer"
    count[why]++
    if (apart)
        waiting[place, $4] = place " | " $4
    else
        print (why == "" ? "not taken: " : "not taken (" why "): ") \
            $1 ":" $3 ": " $2 ": " $6 " | " $4
    next
}

part == 3 && $5 { delete waiting[place, $4] }

function complain(text)
{
    print text
    wrong = 1
}

END {
    for (key in reason)
        if (!(key in seen)) {
            split(key, p, SUBSEP)
            complain("excluded, but not there: " p[1] " | " p[2])
        }
    for (key in waiting)
        complain("no test takes: " waiting[key])
    total -= count["allocation"] + count["caller"] + count["writer"]
    printf "%d of %d branch outcomes taken: %.2f %%; ", good, total, \
           100 * good / (total > 0 ? total : 1)
    printf "not taken: %d of other machines, %d of larger files, %d never, %d others; ", \
           count["machine"], count["size"], count["never"], count[""]
    printf "apart, for tests: %d of failing allocations, %d of mistakes of callers, ", \
           count["allocation"], count["caller"]
    printf "%d of writing\n", count["writer"]
    exit wrong || total == 0 || good < 0.99 * total
}
