# SPDX-License-Identifier: BSD-2-Clause
"""Whole streams: random ones are valid with consistent tiers; broken ones are refused where the
text says."""

import json
import math
import os
import random
import struct
import subprocess
import sys
import tempfile
import unittest

import reader
from decode import Model
from dumps import TIERS
from elements import IDENTIFIER
from reconstruct import Anchors, Query, records
from sample import chunk, random_stream
from verdict import Refusal


def verdict(data):
    try:
        Model(data)
    except Refusal as refusal:
        return refusal.error, refusal.offset
    return "valid"


def chunks_of(data):
    """(type, flags, payload) of each chunk."""
    found, at = [], 12
    while at < len(data):
        flags, size = struct.unpack_from("<II", data, at + 4)
        found.append((data[at:at + 4], flags, data[at + 12:at + 12 + size]))
        at += 20 + size
    return found


def rebuilt(data, chunks):
    return data[:12] + b"".join(chunk(kind, payload, flags) for kind, flags, payload in chunks)


def offsets(chunks):
    """Offset of each chunk's type."""
    at, found = 12, []
    for _, _, payload in chunks:
        found.append(at)
        at += 20 + len(payload)
    return found


BASE = dict(motion=1, phi_dim=2, bank_rows=2, bank_dim=2, deform_layers=1, deform_width=2,
            temporal_mask=1, offset_mask=1, activation=1, tile_size=64)


class Drawn(unittest.TestCase):
    def test_tiers(self):
        """Sizes that follow from annex J, for every combination that the seeds give."""
        for seed in range(20):
            data = random_stream(seed, compact=seed % 2 == 1)
            model = Model(data)
            h = model.header
            strings = {name: tier(model) for name, tier in TIERS.items()}
            coded = sum(len(component.k) for tile in model.tiles
                        for components in tile.coded.values() for component in components)
            self.assertEqual(15 * h.n_anchors, len(strings["T1"]))
            self.assertEqual(5 * coded + len(h.types) * h.n_anchors, len(strings["T2"]))
            self.assertEqual(6 * coded, len(strings["T4"]))
            self.assertEqual(data, bytes_of_elements(strings["T0"]))

    def test_records(self):
        model = Model(random_stream("records", 70, BASE))
        kept = sum(bin(bits).count("1") for tile in model.tiles for bits in tile.kept)
        anchors = Anchors(model)
        string = records(anchors, Query(1, 3, [0.0, 0.0, 0.0]))
        self.assertEqual(56 * kept, len(string))
        self.assertTrue(all(map(math.isfinite, struct.unpack("<%df" % (14 * kept), string))))
        for num, den in ((1, 0), (4, 3), (0, 1 << 24)):
            with self.assertRaises(Refusal) as caught:
                records(anchors, Query(num, den, [0.0, 0.0, 0.0]))
            self.assertEqual("query.range", caught.exception.error)


def bytes_of_elements(string):
    """The file, put together from the records of T0 alone: every byte belongs to one element."""
    widths = dict.fromkeys(range(256), 1)
    two = "bank_dim deform_width head_width hyper_width ar_width position dynamic_prob offset_prob"
    four = ("chunk_type chunk_flags chunk_size n_anchors tile_size bank_rows step frames rate_num "
            "rate_den origin nete netr bank tile_index size")
    widths.update(dict.fromkeys((IDENTIFIER[n] for n in two.split()), 2))
    widths.update(dict.fromkeys((IDENTIFIER[n] for n in four.split()), 4))
    as_bytes = {IDENTIFIER[n] for n in IDENTIFIER if n in ("magic", "ancillary")
                or n.endswith(("_hash", "_deflated", "_substream"))}
    out, at = b"", 0
    while at < len(string):
        identifier, value = struct.unpack_from("<HI", string, at)
        at += 6
        if identifier in as_bytes:
            out += string[at:at + value]
            at += value
        else:
            out += value.to_bytes(widths[identifier], "little")
    return out


class Broken(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.data = random_stream("broken", 70, BASE)
        cls.chunks = chunks_of(cls.data)
        # of TILE: the second
        cls.at = dict(zip((kind for kind, _, _ in cls.chunks), offsets(cls.chunks)))

    def changed(self, chunks):
        return verdict(rebuilt(self.data, chunks))

    def test_file_header(self):
        for i, error in ((0, "con.magic"), (8, "con.version"), (10, "unsupported.profile"),
                         (11, "con.level")):
            broken = bytearray(self.data)
            broken[i] ^= 0x40
            self.assertEqual((error, i), verdict(bytes(broken)))
        self.assertEqual("valid", verdict(self.data[:9] + b"\7" + self.data[10:]))        # minor

    def test_truncation(self):
        for n in list(range(30)) + list(range(30, len(self.data), 97)):
            self.assertEqual(("con.truncated", n), verdict(self.data[:n]))
        self.assertEqual(("con.trailing", len(self.data)), verdict(self.data + b"\0"))

    def test_hash_of_each_chunk(self):
        for at in offsets(self.chunks):
            broken = bytearray(self.data)
            broken[at] ^= 0x20
            self.assertEqual(("con.chunk-hash", at), verdict(bytes(broken)))

    def test_order(self):
        c = self.chunks
        # NETE missing: NETR in its place
        self.assertEqual(("con.chunk-order", self.at[b"NETE"]), self.changed([c[0]] + c[2:]))
        # HEAD doubled
        self.assertEqual(("con.chunk-order", self.at[b"NETE"]), self.changed(c[:1] + c))
        self.assertEqual(("con.chunk-order", 12), self.changed(c[1:]))
        self.assertEqual(("con.chunk-order", self.at[b"BANK"]),
                         self.changed([k for k in c if k[0] != b"BANK"]))
        # one TILE for two: ENDS in its place
        self.assertEqual(("con.chunk-order", self.at[b"TILE"]), self.changed(c[:6] + c[7:]))
        # three
        self.assertEqual(("con.chunk-order", self.at[b"ENDS"]), self.changed(c[:7] + c[6:]))

    def test_ancillary(self):
        c = self.chunks
        for flags, expected in ((0, "valid"), (2, "valid"),
                                (1, ("con.unknown-critical", self.at[b"NETE"])),
                                (4, ("con.reserved", self.at[b"NETE"] + 4)),
                                (5, ("con.reserved", self.at[b"NETE"] + 4))):
            self.assertEqual(expected,
                             self.changed(c[:1] + [(b"META", flags, b"a=b")] + c[1:]), flags)
        self.assertEqual(("con.chunk-order", 12), self.changed([(b"META", 2, b"")] + c))
        self.assertEqual(("con.reserved", self.at[b"NETE"]),
                         self.changed(c[:1] + [(b"ME A", 2, b"")] + c[1:]))
        self.assertEqual(("con.reserved", 16), self.changed([(b"HEAD", 3, c[0][2])] + c[1:]))

    def test_header(self):
        for position, value, error in ((4, 63, "hdr.range"), (8, 0, "hdr.range"),
                                       (8, 17, "hdr.range"), (10, 0, "hdr.combination"),
                                       (10, 4, "hdr.range"),
                                       (89, 1, "hdr.range")):
            head = bytearray(self.chunks[0][2])
            position = len(head) - 1 if position == 89 else position
            head[position:position + 1] = [value]
            # motion none: phi_dim contradicts it
            at = 24 + (11 if error == "hdr.combination" else position)
            self.assertEqual((error, at),
                             self.changed([(b"HEAD", 1, bytes(head))] + self.chunks[1:]), position)

    def test_level(self):
        for level, expected in ((1, ("lvl.exceeded", 32)), (3, "valid")):
            data = random_stream("level", 4, {"n_offsets": 16})
            self.assertEqual(expected, verdict(data[:11] + bytes([level]) + data[12:]))

    def test_hash_of_integers(self):
        last = self.chunks[-1][2]
        self.assertEqual(("syn.hash", self.at[b"ENDS"] + 12),
                         self.changed(self.chunks[:-1] +
                                      [(b"ENDS", 1, bytes([last[0] ^ 1]) + last[1:])]))
        self.assertEqual(("con.payload-size", self.at[b"ENDS"] + 12),
                         self.changed(self.chunks[:-1] + [(b"ENDS", 1, last[1:])]))
        self.assertEqual(("con.payload-size", self.at[b"ENDS"] + 28),
                         self.changed(self.chunks[:-1] + [(b"ENDS", 1, last + b"\0")]))

    def test_lowest_offset_wins(self):
        """A payload that is too long is detected at its end, after errors inside it."""
        kind, flags, posn = self.chunks[4]
        self.assertEqual(b"POSN", kind)
        wrong = posn[:6] + b"\0\x80" + posn[8:] + b"\0"
        self.assertEqual(("pos.value", self.at[b"POSN"] + 18),
                         self.changed(self.chunks[:4] + [(kind, flags, wrong)] + self.chunks[5:]))

    def test_any_change_has_a_verdict(self):
        """Random changes with repaired hashes: each gives a verdict, never another exception."""
        rng = random.Random(6)
        for _ in range(60):
            chunks = list(self.chunks)
            i = rng.randrange(len(chunks))
            payload = bytearray(chunks[i][2])
            payload[rng.randrange(len(payload))] = rng.randrange(256)
            chunks[i] = (chunks[i][0], 1, bytes(payload))
            self.changed(chunks)


class CommandLine(unittest.TestCase):
    """The driver contract, in a process of its own."""

    def run_reader(self, *arguments):
        command = [sys.executable, reader.__file__, *arguments]
        return json.loads(subprocess.run(command, stdout=subprocess.PIPE, check=True).stdout)

    def test_capabilities(self):
        self.assertEqual("X", self.run_reader("--ted4-capabilities")["class"])

    def test_run(self):
        with tempfile.TemporaryDirectory() as folder:
            path, queries = os.path.join(folder, "s.ted4"), os.path.join(folder, "q.json")
            data = random_stream("run", 3, BASE)
            with open(path, "wb") as file:
                file.write(data)
            with open(queries, "w", encoding="utf-8") as file:
                file.write('[{"t": [0, 1], "cam": [0, 0.5, -1e3]},'
                           ' {"t": [2, 1], "cam": [0, 0, 0]}]')
            answer = self.run_reader("--ted4-run", path, "--tiers", "T5,T1", "--queries", queries,
                                     "--dump", folder)
            self.assertEqual("valid", answer["result"])
            self.assertEqual(["T1", "T5"], sorted(answer["tiers"]))
            self.assertEqual({"error": "query.range"}, answer["tiers"]["T5"][1])
            self.assertEqual(45, answer["tiers"]["T1"]["bytes"])
            self.assertEqual(45, os.path.getsize(os.path.join(folder, "T1.bin")))
            self.assertEqual({"result": "limit", "error": "limit.memory"},
                             self.run_reader("--ted4-run", path, "--knob", "max_alloc_total=1000"))
            self.assertEqual({"result": "limit", "error": "limit.work"},
                             self.run_reader("--ted4-run", path, "--knob",
                                             "max_work=%d" % len(data)))
            with open(path, "wb") as file:
                file.write(data[:100])
            self.assertEqual({"result": "invalid", "error": "con.truncated", "offset": 100},
                             self.run_reader("--ted4-run", path))
            self.assertEqual({"result": "io", "error": "io.read"},
                             self.run_reader("--ted4-run", os.path.join(folder, "none")))


if __name__ == "__main__":
    unittest.main()
