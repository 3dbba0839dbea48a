# SPDX-License-Identifier: BSD-2-Clause
"""HEAD (6.1: R-HDR-001 to 003) and what follows from it (6.2)."""

from types import SimpleNamespace

from floats import f32_sound, f32_values
from levels import LEVELS, check_totals
from shapes import blob_values, products_of_tier_e
from verdict import require

NONE, BANK, CONCAT, INR = range(4)              # motion
U32 = (1 << 32) - 1

# name, bytes, entries (None: n_slices), lowest and highest value (R-HDR-001), 0 included where a
# row has a condition; of f32, the values.
ELEMENTS = (
    ("n_anchors", 4, 1, 1, U32), ("tile_size", 4, 1, 64, 65536), ("n_offsets", 1, 1, 1, 16),
    ("feature_dim", 1, 1, 1, 128), ("motion", 1, 1, 0, 3),
    ("phi_dim", 1, 1, 0, 32), ("bank_rows", 4, 1, 0, U32), ("bank_dim", 2, 1, 0, 512),
    ("deform_layers", 1, 1, 0, 8), ("deform_width", 2, 1, 0, 512),
    ("temporal_mask", 1, 1, 0, 1), ("offset_mask", 1, 1, 0, 1), ("activation", 1, 1, 0, 1),
    ("view", 1, 1, 0, 2), ("head_layers", 1, 1, 0, 4),
    ("head_width", 2, 1, 0, 512), ("scale_domain", 1, 1, 0, 1), ("prior", 1, 1, 0, 1),
    ("pe_octaves", 1, 1, 0, 16), ("hyper_layers", 1, 1, 0, 4),
    ("hyper_width", 2, 1, 0, 512), ("n_slices", 1, 1, 1, 16), ("slice", 1, None, 1, 128),
    ("ar_width", 2, 1, 0, 512), ("context_bits", 1, 1, 0, 12),
    ("step", 4, 5, 2.0 ** -20, 2.0 ** 10), ("frames", 4, 1, 1, U32),
    ("rate_num", 4, 1, 1, (1 << 24) - 1), ("rate_den", 4, 1, 1, (1 << 24) - 1),
    ("origin", 4, 3, -float("inf"), float("inf")), ("exponent", 1, 1, -30, 30),
    ("background", 1, 3, 0, 255), ("reserved", 1, 1, 0, 0))
ARRAYS = ("slice", "step", "origin", "background")
FLOATS = ("step", "origin")

# R-HDR-002: does the element contradict earlier ones? "0 when ..., else 1 .." is a comparison of
# two truths.
CONTRADICTS = {
    "phi_dim": lambda h: (h.phi_dim > 0) != (h.motion in (BANK, CONCAT)),
    "bank_rows": lambda h: (h.bank_rows > 0) != (h.motion in (BANK, CONCAT)),
    "bank_dim": lambda h: (h.bank_dim > 0) != (h.motion in (BANK, CONCAT)),
    "deform_layers": lambda h: (h.deform_layers > 0) != (h.motion != NONE),
    "deform_width": lambda h: (h.deform_width > 0) != (h.motion != NONE),
    "temporal_mask": lambda h: h.temporal_mask and h.motion == NONE,
    "head_width": lambda h: (h.head_width > 0) != (h.head_layers > 0),
    "pe_octaves": lambda h: h.prior and h.pe_octaves,
    "hyper_layers": lambda h: h.prior and h.hyper_layers,
    "hyper_width": lambda h: (h.hyper_width > 0) != (h.hyper_layers > 0),
    "slice": lambda h: sum(h.slice) != h.feature_dim,
    "ar_width": lambda h: (h.ar_width > 0) != (h.n_slices > 1)}

# R-HDR-003: elements that a level bounds, and the column of 13.1.
LEVELLED = {"n_anchors": "anchors", "n_offsets": "offsets", "bank_rows": "frames",
            "frames": "frames"}


def read_header(payload, level, file_bytes):
    """The elements as attributes of one object, judged in order of offsets; within an element in
    the order range, combination, level (R-ERR-004)."""
    h = SimpleNamespace(level=level)
    for name, width, count, low, high in ELEMENTS:
        values = []
        for last, entry in payload.entries(name, width, h.n_slices if count is None else count):
            values.append(judge_range(name, entry, low, high, last))
        setattr(h, name, values if name in ARRAYS else values[0])
        require(not CONTRADICTS.get(name, lambda _: False)(h), "hdr.combination", last)
        if name in LEVELLED:
            require(values[0] <= getattr(LEVELS[level], LEVELLED[name]), "lvl.exceeded", last)
    derive(h)
    symbols = h.n_anchors * sum(dim for _, dim in h.types)
    check_totals(level, blob_values(h), products_of_tier_e(h), symbols, file_bytes, last)
    return h


def judge_range(name, entry, low, high, offset):
    """The value of an entry that is in range."""
    value = entry
    if name == "exponent":
        value = entry - 256 if entry > 127 else entry
    if name in FLOATS:
        require(f32_sound(entry), "hdr.range", offset)
        value = f32_values([entry])[0]
    require(low <= value <= high, "hdr.range", offset)
    return value


def derive(h):
    """6.2: the present types in order, each with its dimension; tiles."""
    dims = (("feature", h.feature_dim), ("scaling", 6), ("offset", 3 * h.n_offsets),
            ("phi", h.phi_dim), ("tau", 4 if h.activation else 0))
    h.types = [(name, dim) for name, dim in dims if dim > 0]
    h.dim = dict(dims)
    h.moves = h.motion != NONE
    h.n_tiles = -(-h.n_anchors // h.tile_size)
