#!/bin/sh
# test_rate_check.sh - bench/rate_check on small trained files: three evaluations of the same
# entropy model agree, the coder takes little more than the model says, the symbols are those of the
# file, and a file of profile Compact costs what the file of profile Main does that it was made of.
# Prints lines as a cmocka program does; run by `make test` from the project's root.
# SPDX-License-Identifier: BSD-2-Clause
set -u
. tests/support/speak.sh
need rate_check bench/rate_check ted4enc ted4info python3
vectors=conformance/vectors/content

cat >"$out/judge.py" <<'EOF'
import json
import sys

NAMES = ("feature", "scaling", "offset", "phi", "tau", "total")


def near(name, what, value, limit):
    if not abs(value) <= limit:
        sys.exit(f"{name}: {what} differs by {value:.5f} %, more than {limit}")


def judge(rate, info):
    symbols = {}
    for row in info["budget"]:
        kind, found, _ = row["element"].partition("_substream")
        if found:
            symbols[kind] = symbols.get(kind, 0) + row["symbols"]
    for name in NAMES:
        cost = rate.get(name)
        if cost is None:
            continue
        floored = cost["float64_floored_bits"]
        # Rounding shows as hundredths of a percent, a wrong sum as whole percents.
        near(name, "integer", 100 * (cost["integer_bits"] / floored - 1), 0.1)
        near(name, "float32", 100 * (cost["float32_floored_bits"] / floored - 1), 0.01)
        near(name, "rANS", 100 * (cost["coded_bits"] / cost["integer_bits"] - 1), 1)
        if cost["coded_bits"] < cost["integer_bits"]:
            sys.exit(f"{name}: the coder takes less than the model says")
        if name != "total" and cost["symbols"] != symbols[name]:
            sys.exit(f"{name}: {cost['symbols']} symbols, the file has {symbols[name]}")
    if rate["total"]["symbols"] < 10000:
        sys.exit("too few symbols to tell")


judge(*(json.load(open(path)) for path in sys.argv[1:]))
EOF

costs() { sed 's/.*"feature"/"feature"/' "$1"; }

for name in CNT-turn-0.002 CNT-still-0.008 CNT-occluder-0.0005; do
    f=$vectors/$name.ted4
    "$TED4_BUILD/bench/rate_check" "$f" >"$out/main.json" 2>"$out/said" &&
        "$TED4_BUILD/ted4info" "$f" --budget --json >"$out/info.json" &&
        python3 "$out/judge.py" "$out/main.json" "$out/info.json" 2>"$out/said" &&
        ok "agree_$name" || fail "agree_$name" "$(cat "$out/said")"
    "$TED4_BUILD/ted4enc" --transcode "$f" --profile compact -q -f -o "$out/c.ted4" &&
        "$TED4_BUILD/bench/rate_check" "$out/c.ted4" >"$out/compact.json" &&
        [ "$(costs "$out/main.json")" = "$(costs "$out/compact.json")" ] &&
        ok "compact_$name" || fail "compact_$name" "$(costs "$out/compact.json")"
done
head -c 30000 "$f" >"$out/cut.ted4"
expect cut 1 'byte ' "$TED4_BUILD/bench/rate_check" "$out/cut.ted4"
expect usage 3 usage "$TED4_BUILD/bench/rate_check"
exit $bad
