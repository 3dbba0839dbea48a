#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-2-Clause
"""Checks against conformance/schema: the manifest, every descriptor, capabilities and answers of
our decoders, and the results of `ted4conf run`, as JSON, JUnit and HTML, for a decoder that
conforms and one that does not; also the total size of all files. Prints lines as a cmocka program
does; run in the project's root, by tests/tools/test_suite_schema.sh. TED4_BUILD: the build folder.
"""

import csv
import hashlib
import html.parser
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import xml.etree.ElementTree

from json_schema import Schema, load

SUITE = "conformance"
BUILD = os.environ.get("TED4_BUILD", "build")
SPEC = "1.0 and draft 1.1"                      # of decoders that have both profiles
MOST_BYTES = 10000000                           # of all files of the folder
MADE = r"/(generated|__pycache__)\b"             # folders that programs make in it


def require(condition, why):
    if not condition:
        raise AssertionError(why)


def holds(schema, value, what):
    wrong = schema.check(value)
    require(not wrong, "%s: %s" % (what, "; ".join(wrong[:3])))


def descriptors():
    for folder, _, names in sorted(os.walk(os.path.join(SUITE, "vectors"))):
        for name in sorted(names):
            if name.endswith(".json"):
                yield os.path.join(folder, name)


def manifest():
    suite, schema = load(os.path.join(SUITE, "SUITE.json")), Schema("manifest.schema.json")
    holds(schema, suite, "SUITE.json")
    require(suite["vectors"] == len(suite["vector"]) == len({v["id"] for v in suite["vector"]}),
            "SUITE.json: number of vectors")
    results = [load(path)["expect"]["result"] for path in descriptors()]
    for kind, values in (("result", results), ("folder", [v["folder"] for v in suite["vector"]])):
        require({v: values.count(v) for v in values} == suite["counts"][kind],
                "SUITE.json: counts by %s" % kind)
    require(schema.check(dict(suite, schema=2)), "a manifest of another schema passes")


def size():
    files = [os.path.join(folder, name) for folder, _, names in os.walk(SUITE) for name in names
             if not re.search(MADE, folder)]
    total = sum(os.path.getsize(path) for path in files)
    require(total <= MOST_BYTES,
            "the files of %s add up to %d bytes, more than %d" % (SUITE, total, MOST_BYTES))


def every_descriptor():
    schema = Schema("descriptor.schema.json")
    listed = {v["id"]: v for v in load(os.path.join(SUITE, "SUITE.json"))["vector"]}
    one = None
    for path in descriptors():
        one = load(path)
        name = os.path.basename(path)[:-len(".json")]
        holds(schema, one, path)
        require(one["id"] == name and one["file"] == name + ".ted4" and name in listed,
                "%s: names" % path)
        require(one["category"] == listed[name]["folder"]
                == os.path.relpath(os.path.dirname(path), os.path.join(SUITE, "vectors")),
                "%s: category" % path)
        require(one["bytes"] == listed[name]["bytes"] and one["sha256"] == listed[name]["sha256"],
                "%s: file" % path)
        with open(path, "rb") as file:
            require(hashlib.sha256(file.read()).hexdigest()[:16] == listed[name]["json"],
                    "%s: another one than in SUITE.json" % path)
        require(("tiers" in one) == (one["expect"]["result"] == "valid"), "%s: tiers" % path)
        require(one["expect"]["result"] != "invalid" or one["expect"]["offset"] <= one["bytes"],
                "%s: offset" % path)
        del listed[name]
    require(not listed, "no descriptor of %s" % list(listed)[:3])
    for change in ({"more": 1}, {"rules": []}, {"sha256": "x"}, {"level": -1},
                   {"expect": {"result": "maybe"}}, {"tiers": {"T9": {}}}):
        require(schema.check(dict(one, **change)), "a descriptor with %r passes" % change)


def ask(command, *arguments):
    run = subprocess.run(command + list(arguments), capture_output=True, timeout=120, check=False)
    require(run.returncode == 0, "%s: exit status %d" % (command, run.returncode))
    return json.loads(run.stdout)


def answers():
    ours = [os.path.join(BUILD, "ted4dec")]
    capabilities, answer = Schema("capabilities.schema.json"), Schema("answer.schema.json")
    for command in (ours, ["python3", os.path.join(SUITE, "reader", "reader.py")]):
        said = ask(command, "--ted4-capabilities")
        holds(capabilities, said, "capabilities of %s" % command[-1])
        require(capabilities.check(dict(said, protocol=0))
                and capabilities.check(dict(said, max_level=5))
                and capabilities.check(dict(said, profiles=["Compact"])),
                "other capabilities pass")
        require(said["profiles"] == ["Main", "Compact"] and said["spec"] == SPEC,
                "%s: profiles or specification" % command[-1])
    wanted = {"worked/WRK-dynamic": "valid", "invalid/container/NEG-magic-0": "invalid",
              "tolerant/TOL-three-1": "invalid",
              "limit/LIM-bank-60000": "limit", "invalid/container/NEG-profile-2": "unsupported"}
    for vector, result in wanted.items():
        path = os.path.join(SUITE, "vectors", vector)
        if not os.path.exists(path + ".json"):
            path = next(p[:-len(".json")] for p in descriptors()
                        if load(p)["expect"]["result"] == result)
        with tempfile.NamedTemporaryFile("w", suffix=".json", encoding="ascii") as queries:
            one = load(path + ".json")
            json.dump(one["queries"], queries)
            queries.flush()
            knobs = [x for k, v in one.get("knobs", {}).items()
                     for x in ("--knob", "%s=%d" % (k, v))]
            said = ask(ours, "--ted4-run", path + ".ted4", "--tiers", "T0,T1,T2,T3,T4,T5", "--mode",
                       "lenient", "--queries", queries.name, *knobs)
        holds(answer, said, vector)
        require(said["result"] == result, "%s: %s" % (vector, said["result"]))
        require(("salvage" in said) == (vector == "tolerant/TOL-three-1"), "%s: salvage" % vector)
        require(answer.check(dict(said, result="perhaps")) and answer.check(dict(said, offset=-1)),
                "other answers pass")


class Page(html.parser.HTMLParser):
    """Cells and paragraphs of a page whose elements are closed in order."""

    def __init__(self, text):
        super().__init__()
        self.open, self.text = [], []
        self.feed(text)
        self.close()
        require(not self.open, "HTML: %s is not closed" % self.open)

    def handle_starttag(self, tag, attrs):
        if tag != "meta":
            self.open.append(tag)

    def handle_endtag(self, tag):
        require(self.open and self.open.pop() == tag, "HTML: </%s> closes nothing" % tag)

    def handle_data(self, data):
        if data.strip():
            self.text.append(data.strip())


def one_report(folder, command, outcomes, reason=""):
    conforms = "fail" not in outcomes and not reason
    out = {kind: os.path.join(folder, "results." + kind) for kind in ("json", "xml", "html")}
    ids = open(os.path.join(SUITE, "lists", "few.txt"), encoding="ascii").read().split()
    run = subprocess.run([os.path.join(BUILD, "ted4conf"), "run", "-q", "--memory", "0", "-l",
                          os.path.join(SUITE, "lists", "few.txt"), "-d", command,
                          "--json", out["json"], "--junit", out["xml"], "--html", out["html"]],
                         env=dict(os.environ, TED4DEC=os.path.join(BUILD, "ted4dec")),
                         capture_output=True, timeout=300, check=False)
    require(run.returncode == (0 if conforms else 1),
            "exit status %d: %s" % (run.returncode, run.stdout))
    results, schema = load(out["json"]), Schema("results.schema.json")
    holds(schema, results, "results")
    require(results["conforms"] is conforms and results["reason"] == reason and results["counts"]
            == dict({n: 0 for n in results["counts"]}, **outcomes), "results: counts")
    require(sorted(v["id"] for v in results["vectors"]) == sorted(ids), "results: vectors")
    require(schema.check(dict(results, conforms="yes")), "other results pass")
    junit = xml.etree.ElementTree.parse(out["xml"]).getroot()
    cases = ids + (["verdict"] if reason else [])
    failed = [failure.get("message") for failure in junit.findall("testcase/failure")]
    require(junit.tag == "testsuite" and sorted(c.get("name") for c in junit) == sorted(cases),
            "JUnit: cases")
    require(int(junit.get("tests")) == len(cases) and int(junit.get("failures")) == len(failed),
            "JUnit: counts")
    require(len(failed) == outcomes.get("fail", 0) + bool(reason)
            and (not reason or reason in failed)
            and int(junit.get("errors")) == outcomes.get("no answer", 0), "JUnit: failures")
    page = Page(open(out["html"], encoding="utf-8").read())
    require(("conforms" in page.text) is conforms
            and ("does not conform" in page.text) is not conforms
            and (not reason or reason in page.text), "HTML: verdict")
    require(all(i in page.text for i in ids) and command in page.text, "HTML: vectors")


def reports():
    bad = "sh conformance/tests/bad_decoder.sh "
    with tempfile.TemporaryDirectory() as folder:
        one_report(folder, bad + "good", {"pass": 8})
        one_report(folder, "NAME='<a href=\"x\">&' " + bad + "wrong-hash",
                   {"pass": 4, "fail": 4}, "no valid stream decoded")
        one_report(folder, bad + "wrong-offset", {"pass": 5, "fail": 3})
        one_report(folder, bad + "fewer-tiers", {"pass": 8}, "T1 is not claimed (R-DMP-070)")
        one_report(folder, bad + "level-5", {"no answer": 8},
                   "capabilities: max_level is missing, or not what it has to be")


def one_suite(folder, changed, outcome):
    """Runs our decoder over a suite of two vectors, of which the second has been changed."""
    published = {v["id"]: v for v in load(os.path.join(SUITE, "SUITE.json"))["vector"]}
    place = os.path.join(folder, "vectors", "worked")
    os.makedirs(place)
    for name in ("WRK-annex-b1", "WRK-masks"):
        for suffix in (".json", ".ted4"):
            shutil.copy(os.path.join(SUITE, "vectors", "worked", name + suffix), place)
    with open(os.path.join(folder, "SUITE.json"), "w", encoding="ascii") as file:
        json.dump({"vector": [published["WRK-annex-b1"], published["WRK-masks"]]}, file)
    changed(place)
    run = subprocess.run([os.path.join(BUILD, "ted4conf"), "run", "-q", "--memory", "0", "-s",
                          folder, "-d", os.path.join(BUILD, "ted4dec")],
                         stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=120,
                         check=False)
    require(outcome in run.stdout.decode(), "%s: %s" % (changed.__name__, run.stdout))


def changed_suites():
    """A vector that is gone, or is not the one in the manifest, counts as missing, whatever its
    descriptor says."""
    second = "WRK-masks"

    def as_it_is(_):
        pass

    def no_file(place):
        os.remove(os.path.join(place, second + ".ted4"))

    def no_descriptor(place):
        os.remove(os.path.join(place, second + ".json"))

    def other_file(place):
        shutil.copy(os.path.join(place, "WRK-annex-b1.ted4"), os.path.join(place, second + ".ted4"))

    def other_vector(place):
        other_file(place)
        one = load(os.path.join(place, "WRK-annex-b1.json"))
        with open(os.path.join(place, second + ".json"), "w", encoding="ascii") as file:
            json.dump(dict(one, id=second, file=second + ".ted4"), file)

    def other_descriptor(place):
        one = load(os.path.join(place, second + ".json"))
        del one["tiers"]["T3"]
        with open(os.path.join(place, second + ".json"), "w", encoding="ascii") as file:
            json.dump(one, file)

    def one_more(place):
        for suffix in (".json", ".ted4"):
            shutil.copy(os.path.join(place, second + suffix),
                        os.path.join(place, "WRK-more" + suffix))

    def listed(place, text):
        with open(os.path.join(place, "..", "..", "SUITE.json"), "w", encoding="ascii") as file:
            file.write(text)

    def no_id(place):
        listed(place, '{"vector":[{}]}')

    def broken_manifest(place):
        listed(place, '{"vector":[')

    for changed, outcome in ((as_it_is, " 2 passed, 0 failed, 0 without answer, 0 missing"),
                             (no_file, " 1 passed, 0 failed, 0 without answer, 1 missing"),
                             (no_descriptor, " 1 passed, 0 failed, 0 without answer, 1 missing"),
                             (other_file, " 1 missing"),
                             (other_vector, " 1 passed, 0 failed, 0 without answer, 1 missing"),
                             (other_descriptor, " 1 passed, 0 failed, 0 without answer, 1 missing"),
                             (no_id, "/SUITE.json: vector 0 has no id"),
                             (broken_manifest, "/SUITE.json: line 1: "),
                             (one_more, " 2 passed, 0 failed, 0 without answer, 1 missing")):
        with tempfile.TemporaryDirectory() as folder:
            one_suite(folder, changed, outcome)


def thresholds():
    """Thresholds are exponents of powers of two; that of the root mean square never exceeds that of
    the largest deviation (R-TOL-003)."""
    rows = list(csv.DictReader(
        open(os.path.join(SUITE, "tolerance", "thresholds.csv"), encoding="ascii")))
    require(len(rows) > 20, "thresholds.csv: too few rows")
    for row in rows:
        for group in ("position", "scale", "rotation", "opacity", "colour"):
            peak, rms = row[group + "_peak"], row[group + "_rms"]
            require((peak == "-") == (rms == "-") and (peak == "-" or int(rms) <= int(peak)),
                    "thresholds.csv: %s %s" % (row["vector"], group))


def main():
    bad = 0
    for test in (manifest, size, every_descriptor, answers, reports, changed_suites, thresholds):
        try:
            test()
            print("[       OK ] %s" % test.__name__)
        except (AssertionError, AttributeError, KeyError, ValueError, OSError,
                subprocess.SubprocessError, StopIteration) as error:
            print("[  FAILED  ] %s: %s: %s" % (test.__name__, type(error).__name__, error))
            bad = 1
    return bad


if __name__ == "__main__":
    sys.exit(main())
