# SPDX-License-Identifier: BSD-2-Clause
"""The decision procedure: a byte string to a Model, or a Refusal (R-DEC-001, R-ERR-001 to 004).

Everything is judged in order of passes, then of offsets; a violation that is reported at an earlier
byte than where it is detected is judged before anything between the two. So the first Refusal
raised is the one to report.
"""

import struct

from blob import Blob
from container import walk_chunks, pass_one
from elements import Payload
from floats import f32_values
from header import read_header
from integer_networks import read_networks
from limits import check_memory, check_work
from positions import Positions
from shapes import layers, tier_r_shapes, values_of
from tile import Tile
from verdict import require
from xxh3 import xxh3_128


class Model:
    """A valid file, decoded.

    header; positions; hyperprior and slice_networks (Tier E); networks (Tier R): name to list of
    layers (W by rows, b); bank: rows; tiles; spans: per chunk, what Payload kept for T0.
    """

    def __init__(self, data, max_memory=None, max_work=None):
        self.data = data
        self.tiles, self.spans, self.bank = [], [], []
        level, self.chunks = pass_one(data)
        self.compact = data[10] == 1
        head = Payload(data, self.chunks[0].begin, self.chunks[0].end)
        self.header = h = read_header(head, level, len(data))
        check_work(h, len(data), max_work)
        head.finish()
        self.spans.append(head.spans)
        check_memory(h, len(data), max_memory)
        read = {"NETE": self.read_nete, "NETR": self.read_netr, "BANK": self.read_bank,
                "POSN": self.read_posn, "TILE": self.read_tile,
                "ENDS": self.read_ends}
        for chunk in walk_chunks(self.chunks[1:], h.phi_dim > 0, h.n_tiles):
            payload = Payload(data, chunk.begin, chunk.end, self.compact)
            read.get(chunk.type, skip)(payload)
            payload.finish()
            self.spans.append(payload.spans)

    def read_nete(self, payload):
        self.hyperprior, self.slice_networks = read_networks(payload, self.header)

    def read_netr(self, payload):
        """7.4."""
        shapes = tier_r_shapes(self.header)
        groups = [[(inputs, None)] * outputs + [(outputs, None)]
                  for _, shape in shapes for inputs, outputs in layers(shape)]
        values = iter(read_values(payload, "netr", values_of(shape for _, shape in shapes),
                                  groups))
        self.networks = {}
        for name, shape in shapes:
            self.networks[name] = [([take(values, inputs) for _ in range(outputs)],
                                    take(values, outputs)) for inputs, outputs in layers(shape)]

    def read_bank(self, payload):
        """7.5."""
        h = self.header
        n = h.bank_rows * h.bank_dim
        values = iter(read_values(payload, "bank", n, [[(n, None)]]))
        self.bank = [take(values, h.bank_dim) for _ in range(h.bank_rows)]

    def read_posn(self, payload):
        self.positions = Positions(payload, self.header.n_anchors)

    def read_tile(self, payload):
        self.tiles.append(Tile(payload, self, len(self.tiles)))

    def read_ends(self, payload):
        """5.4, R-CON-006."""
        start = payload.at
        claimed = payload.bytes("ends_hash", 16)
        require(claimed == xxh3_128(self.decoded_integers()), "syn.hash", start)

    def decoded_integers(self):
        """The byte string of 15.2, R-INT-002."""
        parts = [struct.pack("<%dH" % len(self.positions.patterns), *self.positions.patterns)]
        for tile in self.tiles:
            parts += [struct.pack("<BH", dynamic, kept)
                      for dynamic, kept in zip(tile.dynamic, tile.kept)]
            parts += [bytes(tile.step[name]) for name, _ in self.header.types]
            masks = self.header.temporal_mask or self.header.offset_mask
            parts += [struct.pack("<%dh" % len(symbols), *symbols)
                      for _, symbols in tile.streams[1 if masks else 0:]]
        return b"".join(parts)


def skip(payload):
    """An ancillary chunk: its payload is one element."""
    payload.bytes("ancillary", payload.end - payload.at)


def take(values, n):
    return [next(values) for _ in range(n)]


def read_values(payload, name, count, groups):
    blob = Blob(payload, name, count, groups)
    blob.check_values()
    return f32_values(blob.patterns)
