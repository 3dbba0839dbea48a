#!/bin/sh
# test_pages.sh - every page of bench/ that a program writes agrees with its rows: each page is made
# anew and compared with the stored one, and so are its charts. Every row says which sources made
# it. A page that differs was edited by hand, or its rows or the sources changed after it was made:
# `python3 -m bench.pages NAME` makes it. Prints lines as a cmocka program does; run by `make test`
# from the project's root.
# SPDX-License-Identifier: BSD-2-Clause
set -u
unset TED4_WORK TED4_TABLE TED4_PAGES TED4_NOTES TED4_RESULTS
. tests/support/speak.sh
command -v python3 >/dev/null || { skip pages 'there is no python3'; exit 0; }

mkdir "$out/bench"
cp -R bench/*.csv bench/*.md bench/*/ "$out/bench"
rm -rf "$out/bench/pages"
# page NAME FILE...: the page, and its files and folders of charts
page() {
    name=$1; shift
    TED4_RESULTS=$out/bench TED4_PAGES=$out/bench python3 -m bench.pages "$name" \
        >"$out/said" 2>&1 || { fail "$name" "$(cat "$out/said")"; return; }
    for f; do
        diff -r "bench/$f" "$out/bench/$f" >"$out/said" 2>&1 ||
            { fail "$name" "$f is not what its rows give: $(head -n 5 "$out/said")"; return; }
    done
    ok "$name"
}
page report report.md report-tables.md charts
page capacity capacity.md capacity
page stability stability.md lab
page zoo zoo.md
page bd_rate bd_rate.md

# A key is the hash of the options, a hyphen, and the hash of the sources, followed by that of the
# judging programs if these are others.
# Those of machines.csv have one hash of both.
for csv in sweep capacity stability zoo bd_rate held_out machines; do
    if [ $csv = machines ]; then key='[0-9a-f]+'; else key='[0-9a-f]+-[0-9a-f]+([.][0-9a-f]+)?'; fi
    bad_rows=$(awk -F, -v key="^$key\$" '
        NR == 1 { for (i = 1; i <= NF; i++) if ($i == "key") c = i; if (!c) print "no key"; next }
        $c !~ key { print $1 }
        END { if (NR < 2) print "no rows" }' "bench/$csv.csv")
    [ -z "$bad_rows" ] && ok "made_with_$csv" || fail "made_with_$csv" "$bad_rows"
done
# Equal bytes are claimed from one state of the sources to a later one, with the number of cases.
bad_rows=$(awk -F, 'NR > 1 && ($1 !~ /^[0-9a-f]+$/ || $2 !~ /^[0-9a-f]+$/ || $1 == $2 || $3 < 1 ||
    $5 == "" || NF != 5)' bench/equal.csv)
[ -z "$bad_rows" ] && ok equal || fail equal "$bad_rows"
exit $bad
