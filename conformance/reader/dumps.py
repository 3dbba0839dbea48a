# SPDX-License-Identifier: BSD-2-Clause
"""The byte strings of the tiers T0 to T4 (annex J)."""

import struct

from container import FILE_HEADER
from elements import IDENTIFIER
from floats import f32_patterns
from values import component_values, quantiser_steps


def tier_0(model):
    """J.2: a record for every element, from the first byte to the last."""
    spans = [("magic", 0, 8, 0), ("major", 1, 1, 8), ("minor", 1, 1, 9), ("profile", 1, 1, 10),
             ("level", 1, 1, FILE_HEADER - 1)]
    for chunk, inside in zip(model.chunks, model.spans):
        spans += [("chunk_type", 4, 1, chunk.start), ("chunk_flags", 4, 1, chunk.start + 4),
                  ("chunk_size", 4, 1, chunk.start + 8)]
        spans += inside
        spans.append(("chunk_hash", 0, 8, chunk.end))
    return b"".join(record for span in spans for record in records(model.data, *span))


def records(data, name, width, count, offset):
    """R-DMP-010, R-DMP-011: those of a span (elements.py)."""
    identifier = struct.pack("<H", IDENTIFIER[name])
    if width == 0:
        yield identifier + struct.pack("<I", count) + data[offset:offset + count]
    zeros = bytes(4 - width)
    for at in range(offset, offset + width * count, width or 1):
        yield identifier + data[at:at + width] + zeros


def tier_1(model):
    """J.3."""
    fixed = model.positions.fixed
    masks = [struct.pack("<BH", dynamic, kept) for tile in model.tiles
             for dynamic, kept in zip(tile.dynamic, tile.kept)]
    return struct.pack("<%di" % len(fixed), *fixed) + b"".join(masks)


def tier_2(model):
    """J.4."""
    parts = []
    for tile in model.tiles:
        parts += [bytes(tile.step[name]) for name, _ in model.header.types]
        for component in coded_components(model, tile):
            parts += map(struct.Struct("<Bi").pack, component.sigma, component.mu)
    return b"".join(parts)


def tier_3(model):
    """J.5."""
    parts = []
    for tile in model.tiles:
        masks = model.header.temporal_mask or model.header.offset_mask
        for number, (substream, symbols) in enumerate(tile.streams):
            code = "B" if masks and number == 0 else "h"
            parts.append(struct.pack("<I%d%s" % (len(symbols), code), len(symbols), *symbols))
            parts.append(struct.pack("<I%dI" % substream.lanes, substream.lanes, *substream.states))
    return b"".join(parts)


def tier_4(model):
    """J.6."""
    parts = []
    for tile in model.tiles:
        for name, _ in model.header.types:
            q = quantiser_steps(model.header, name, tile.step[name])
            for component in tile.coded[name]:
                parts += map(struct.Struct("<hI").pack, component.k,
                             f32_patterns(component_values(component, q)))
    return b"".join(parts)


def coded_components(model, tile):
    """R-DMP-003."""
    return [component for name, _ in model.header.types for component in tile.coded[name]]


TIERS = {"T0": tier_0, "T1": tier_1, "T2": tier_2, "T3": tier_3, "T4": tier_4}
