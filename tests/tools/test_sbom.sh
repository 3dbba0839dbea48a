#!/bin/sh
# test_sbom.sh - the bill of materials is well-formed SPDX 2.3, names every file of the source tree
# with its hash, and is the same when it is made again. Prints lines as a cmocka program does; run
# by `make test` from the project's root.
# SPDX-License-Identifier: BSD-2-Clause
set -u
. tests/support/speak.sh
need sbom python3
why=$(git ls-files --error-unmatch Makefile 2>&1 >/dev/null) ||
    { skip sbom "git lists no files here: $(echo "$why" | head -n 1)"; exit 0; }

make() { python3 tools/sbom.py "$@"; }
if make "$out/a.json" 2>"$out/err" && make "$out/b.json" && cmp -s "$out/a.json" "$out/b.json"
then ok deterministic; else fail deterministic "$(cat "$out/err")"; fi
if SOURCE_DATE_EPOCH=0 make "$out/c.json" && grep -q '"created": "1970-01-01T00:00:00Z"' \
    "$out/c.json"; then ok date; else fail date "not that of SOURCE_DATE_EPOCH"; fi
expect usage 3 "usage: sbom.py FILE" python3 tools/sbom.py
expect no_folder 3 "No such file" python3 tools/sbom.py "$out/nowhere/a.json"

cat >"$out/judge.py" <<'PYTHON'
import hashlib
import json
import os
import re
import subprocess
import sys

with open(sys.argv[1], encoding="utf-8") as f:
    d = json.load(f)
assert d["spdxVersion"] == "SPDX-2.3" and d["dataLicense"] == "CC0-1.0"
assert re.fullmatch(r"https://spdx\.org/spdxdocs/ted4-\S+-[0-9a-f-]{36}", d["documentNamespace"])
assert re.fullmatch(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\dZ", d["creationInfo"]["created"])
assert all(re.match("(Tool|Organization|Person): ", c) for c in d["creationInfo"]["creators"])
elements = [d["SPDXID"]] + [e["SPDXID"] for e in d["packages"] + d["files"]]
assert len(set(elements)) == len(elements), "an identifier twice"
assert all(re.fullmatch(r"SPDXRef-[A-Za-z0-9.-]+", e) for e in elements)
for p in d["packages"]:
    for key in ("name", "downloadLocation", "licenseConcluded", "licenseDeclared"):
        assert p[key], (p["name"], key)
related = {r["relatedSpdxElement"] for r in d["relationships"]} | {
    r["spdxElementId"] for r in d["relationships"]}
assert related == set(elements), related ^ set(elements)
listed = subprocess.run(["git", "ls-files", "-z"], capture_output=True, check=True).stdout
names = [f["fileName"] for f in d["files"]]
assert sorted(names) == sorted(
    "./" + p for p in listed.decode().split("\0") if os.path.isfile(p))
sums = []
for f in d["files"]:
    found = {c["algorithm"]: c["checksumValue"] for c in f["checksums"]}
    with open(f["fileName"], "rb") as data:
        assert found["SHA256"] == hashlib.sha256(data.read()).hexdigest(), f["fileName"]
    sums.append(found["SHA1"])
code = hashlib.sha1("".join(sorted(sums)).encode()).hexdigest()
assert d["packages"][0]["packageVerificationCode"]["packageVerificationCodeValue"] == code
licence = {f["fileName"]: f["licenseConcluded"] for f in d["files"]}
assert licence["./ref-decoder/ted4.h"] == "BSD-2-Clause"
assert licence["./spec/01-scope.md"] == "CC-BY-4.0"
assert licence["./conformance/SUITE.json"] == "CC0-1.0"
PYTHON
if python3 "$out/judge.py" "$out/a.json" 2>"$out/err"; then ok well_formed
else fail well_formed "$(cat "$out/err")"; fi
exit $bad
