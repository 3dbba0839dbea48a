# SPDX-License-Identifier: BSD-2-Clause
"""A part of the conformance suite, in this process: files that this decoder has not made, with the
answers of other decoders."""

import json
import pathlib
import unittest
import zlib

from decode import Model
from dumps import TIERS
from floats import f32_round
from reader import describe, refusal_answer
from reconstruct import Anchors, Query, records
from verdict import Refusal

VECTORS = pathlib.Path(__file__).resolve().parents[1] / "vectors"
SHARE = 12                          # one vector in so many, and all that are worked examples
LARGEST = 8000                      # bytes


def chosen():
    """Descriptors, selected by a checksum of their names, so that new vectors do not change which
    of the old ones are taken."""
    for path in sorted(VECTORS.rglob("*.json")):
        if path.with_suffix(".ted4").exists() and (zlib.crc32(path.stem.encode()) % SHARE == 0
                                                   or path.parent.name == "worked"):
            yield path


def answer(vector, data):
    """As reader.run gives it."""
    try:
        knobs = vector.get("knobs", {})
        model = Model(data, knobs.get("max_alloc_total"), knobs.get("max_work"))
    except Refusal as refusal:
        return refusal_answer(refusal), {}
    tiers = {name: describe(string(model), name, None) for name, string in TIERS.items()}
    anchors, tiers["T5"] = Anchors(model), []
    for query in vector["queries"]:
        try:
            asked = Query(*query["t"], [f32_round(c) for c in query["cam"]])
            tiers["T5"].append(describe(records(anchors, asked), "T5", None))
        except Refusal as refusal:
            tiers["T5"].append({"error": refusal.error})
    return {"result": "valid"}, tiers


@unittest.skipUnless(VECTORS.is_dir(), "the suite is not there")
class Suite(unittest.TestCase):
    def test_share(self):
        asked = 0
        for path in chosen():
            vector = json.loads(path.read_text(encoding="utf-8"))
            data = path.with_suffix(".ted4").read_bytes()
            if len(data) > LARGEST:
                continue
            expected = {key: value for key, value in vector["expect"].items() if key != "also_ok"}
            verdict, tiers = answer(vector, data)
            with self.subTest(vector["id"]):
                asked += 1
                if verdict["result"] not in vector["expect"].get("also_ok", ()):
                    self.assertEqual(expected, verdict)
                    for name, known in vector.get("tiers", {}).items():
                        self.assertEqual(known, tiers[name], name)
        self.assertGreater(asked, 80)


if __name__ == "__main__":
    unittest.main()
