# SPDX-License-Identifier: BSD-2-Clause
"""Random valid streams for tests: makes the bytes of a file from a seed.

Tiles are made by decoding random slots, which draws symbols from the model of the stream itself.
The symbols are recorded and coded backwards, so the decoder reads what was drawn. All that this
writer needs besides the decoder is therefore chunks, a header, networks, positions and one page of
rANS.
"""

import random
import struct
from types import SimpleNamespace

from container import CRITICAL, MAGIC
from elements import Payload
from header import ELEMENTS, read_header
from integer_networks import HIDDEN_BITS, plan, read_networks, PHASE_BITS
from positions import Positions, morton
from rans import TOTAL, lane_count
from sample_compact import code_slots, coded_nete, netr_groups, random_blob, random_places
from shapes import hyperprior_shape, slice_shapes, tier_r_shapes, values_of
from tile import Tile
from verdict import Refusal
from xxh3 import xxh3_128, xxh3_64
from decode import Model


def chunk(kind, payload, flags=CRITICAL):
    body = kind + struct.pack("<II", flags, len(payload)) + payload
    return body + struct.pack("<Q", xxh3_64(body))


def random_header(rng, anchors):
    """Elements by name; small sizes, every switch."""
    motion, view, prior = rng.randrange(4), rng.randrange(3), rng.randrange(2)
    slices = rng.choice((1, 1, 2, 3))
    banked = motion in (1, 2)
    hidden, heads = 0 if prior else rng.randrange(3), rng.randrange(3)
    parts = [rng.randint(1, 4) for _ in range(slices)]
    return {
        "n_anchors": anchors, "tile_size": rng.choice((64, 65, 4096)),
        "n_offsets": rng.choice((1, 2, 5, 16)), "feature_dim": sum(parts),
        "motion": motion, "phi_dim": rng.randint(1, 4) if banked else 0,
        "bank_rows": rng.randint(1, 4) if banked else 0,
        "bank_dim": rng.randint(1, 5) if banked else 0,
        "deform_layers": rng.randint(1, 3) if motion else 0,
        "deform_width": rng.randint(1, 5) if motion else 0,
        "temporal_mask": rng.randrange(2) if motion else 0, "offset_mask": rng.randrange(2),
        "activation": rng.randrange(2), "view": view,
        "head_layers": heads, "head_width": rng.randint(1, 6) if heads else 0,
        "scale_domain": rng.randrange(2), "prior": prior,
        "pe_octaves": 0 if prior else rng.choice((0, 1, 10, 16)), "hyper_layers": hidden,
        "hyper_width": rng.randint(1, 9) if hidden else 0, "n_slices": slices,
        "slice": parts, "ar_width": rng.randint(1, 9) if slices > 1 else 0,
        "context_bits": rng.randint(0, 12),
        "step": [f32(rng.choice((1.0, 0.05, 2.0 ** -20)) * rng.uniform(1, 2)) for _ in range(5)],
        "frames": rng.randint(1, 600), "rate_num": 30, "rate_den": 1,
        "origin": [f32(rng.uniform(-9, 9)) for _ in range(3)],
        "exponent": rng.randint(-3, 3) & 255, "background": [0, 128, 255], "reserved": 0}


def f32(value):
    return struct.unpack("<I", struct.pack("<f", value))[0]


def head_payload(elements):
    out = b""
    for name, width, _, _, _ in ELEMENTS:
        entries = elements[name] if isinstance(elements[name], list) else [elements[name]]
        out += b"".join(e.to_bytes(width, "little") for e in entries)
    return out


def random_nete(rng, h):
    """Shifts and weights of many magnitudes, up to what R-NET-006 allows; half of the layers are
    not on the integer grid."""
    shifts, values = [], []
    slices = [(s, h.context_bits, 32767) for s in slice_shapes(h)]
    for shape, bits, amplitude in [(hyperprior_shape(h), PHASE_BITS, 4096)] + slices:
        for layer in plan(shape, bits, amplitude):
            s = [rng.randint(max(0, layer["g"] - layer["f"]), min(20, HIDDEN_BITS + 4))
                 for _ in range(layer["outputs"])]
            grid = rng.choice((0.0, 0.25))
            reach = [min(0x38000000, 1 << rng.randint(8, 18) + k + layer["f"] - layer["g"])
                     for k in s]
            for k, bound in zip(s, reach):
                most = min(32767, bound // (layer["A"] * max(1, layer["inputs"])))
                values += [(rng.randint(-most, most) + grid) / 2 ** k
                           for _ in range(layer["inputs"])]
            values += [rng.uniform(-1, 1) * bound / 2 ** (k + layer["f"])
                       for k, bound in zip(s, reach)]
            shifts += s
    return shifts, values


def pack_values(values):
    """Rounded to binary32; subnormal numbers and negative zero become 0."""
    return struct.pack("<%df" % len(values), *(v if abs(v) >= 2.0 ** -126 else 0.0 for v in values))


def random_positions(rng, n):
    anchors = {tuple(rng.choice((0, 0x8000)) | rng.randint(1, 0x3C00) for _ in range(3))
               for _ in range(n)}
    while len(anchors) < n:
        anchors.add(tuple(rng.randint(0, 0x3C00) for _ in range(3)))
    return struct.pack("<%dH" % (3 * n),
                       *(p for anchor in sorted(anchors, key=morton) for p in anchor))


class DrawnSubstream:
    """Replaces rans.Substream: every slot is random, and bytes() codes the symbols taken."""

    def __init__(self, rng, n):
        self.rng, self.start, self.n, self.lanes = rng, 0, n, lane_count(n)
        self.taken, self.pending = [], None

    def slot(self, i):
        if self.pending is None:
            self.pending = (self.rng.choice((0, 65535)) if self.rng.random() < 0.02
                            else self.rng.randrange(TOTAL))
        return self.pending

    def advance(self, i, first, freq):
        self.taken.append((i % self.lanes, first, freq))
        self.pending = None

    def bit(self, i, ones):
        one = self.slot(i) < ones
        self.advance(i, 0 if one else ones, ones if one else TOTAL - ones)
        return int(one)

    def finish(self):
        self.bytes = code_slots(self.taken, self.lanes)


class DrawnTile(Tile):
    """A Tile whose substreams are random; `payload_bytes` is its TILE payload."""

    def __init__(self, rng, model, number):
        self.rng = rng
        super().__init__(None, model, number)
        h, out = self.header, struct.pack("<I", number)
        if h.temporal_mask:
            out += struct.pack("<H", self.dynamic_prob)
        if h.offset_mask:
            out += struct.pack("<6H", *self.offset_prob)
        parts = [substream.bytes for substream, _ in self.streams]
        sizes = struct.pack("<%dI" % len(parts), *map(len, parts))
        self.payload_bytes = out + sizes + b"".join(parts)

    def read_elements(self, number):
        self.dynamic_prob, *self.offset_prob = [
            self.rng.choice((1, 65535, self.rng.randint(1, 65535))) for _ in range(7)]

    def open_substream(self, n):
        return DrawnSubstream(self.rng, n)


def random_stream(seed, anchors=None, changes=None, compact=False):
    """The bytes of a valid file; `changes` replace elements of the header; `compact`: of that
    profile. A draw that no symbols could make valid, or that has fewer bits than R-ENT-016
    requires, is repeated."""
    for attempt in range(1000):
        rng = random.Random("%s %d" % (seed, attempt))
        try:
            return draw_stream(rng, anchors or rng.choice((1, 2, 30, 70, 150)), changes or {},
                               compact)
        except Refusal as refusal:
            if refusal.error not in ("att.tau-order", "ent.symbol-range", "ent.escape",
                                     "ent.size"):
                raise
    raise ValueError("no stream for this seed")


def front_payloads(rng, h, compact):
    """NETE, NETR, BANK and POSN; in profile Compact each blob is raw or coded."""
    shifts, values = random_nete(rng, h)
    posn = random_places(rng, h.n_anchors) if compact else random_positions(rng, h.n_anchors)
    coded = [compact and rng.random() < 0.8 for _ in range(3)]
    n_netr, n_bank = values_of(s for _, s in tier_r_shapes(h)), h.bank_rows * h.bank_dim
    raw = [b"\0" + pack_values([rng.uniform(-1, 1) for _ in range(n)]) for n in (n_netr, n_bank)]
    return (coded_nete(h, shifts, values) if coded[0]
            else bytes(shifts) + b"\0" + pack_values(values),
            random_blob(rng, netr_groups(h)) if coded[1] else raw[0],
            random_blob(rng, [[(n_bank, None)]]) if coded[2] and n_bank else raw[1], posn)


def draw_stream(rng, anchors, changes, compact):
    elements = random_header(rng, anchors)
    elements.update(changes)
    head = head_payload(elements)
    h = read_header(Payload(head, 0, len(head)), 31, 1 << 30)
    model = SimpleNamespace(header=h, tiles=[])
    nete, netr, bank, posn = front_payloads(rng, h, compact)
    model.hyperprior, model.slice_networks = read_networks(Payload(nete, 0, len(nete), compact), h)
    model.positions = Positions(Payload(posn, 0, len(posn), compact), h.n_anchors)
    chunks = chunk(b"HEAD", head) + chunk(b"NETE", nete) + chunk(b"NETR", netr)
    chunks += (chunk(b"BANK", bank) if h.phi_dim else b"") + chunk(b"POSN", posn)
    for number in range(h.n_tiles):
        model.tiles.append(DrawnTile(rng, model, number))
        chunks += chunk(b"TILE", model.tiles[-1].payload_bytes)
    chunks += chunk(b"ENDS", xxh3_128(Model.decoded_integers(model)))
    return MAGIC + bytes((1, 2 if compact else 0, int(compact), 31)) + chunks
