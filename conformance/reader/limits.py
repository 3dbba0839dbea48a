# SPDX-License-Identifier: BSD-2-Clause
"""Limits that a caller can set (R-LVL-007): memory, computed from HEAD before anything of pass 2 is
allocated (R-ERR-005), and work (R-LVL-008)."""

from shapes import blob_values, hyperprior_shape, products_of_tier_e
from verdict import require

DEFAULT = 1 << 32
PER_VALUE, PER_SYMBOL, PER_BYTE = 100, 200, 20          # bytes of Python objects, on the safe side


def memory_of_tier_e(h, file_bytes):
    """M_E of 13.3 in bytes, with one tile at a time."""
    components = sum(dim for _, dim in h.types)
    padded = -(-min(h.tile_size, h.n_anchors) // 64) * 64
    per_anchor = 4 * hyperprior_shape(h)[-1] + 2 * h.feature_dim + 11
    return ((1 << 20) + file_bytes + 16 * blob_values(h) + h.n_anchors * (2 * components + 16)
            + padded * per_anchor + (1 << 17))


def check_memory(h, file_bytes, bound):
    """limit.memory if M_E is above `bound`, or, without one, if decoding in Python may need more
    than DEFAULT bytes. Claims beyond what the bytes of the file could hold are not counted then: a
    deflated value takes at least 1/258 byte (RFC 1951: 258 bytes in two bits, four bytes per
    value), an anchor 1/8 byte of POSN."""
    if bound is not None:
        require(memory_of_tier_e(h, file_bytes) <= bound, "limit.memory", None)
        return
    values = min(blob_values(h), 258 * file_bytes)
    anchors = min(h.n_anchors, 8 * file_bytes)
    symbols = anchors * sum(dim for _, dim in h.types)
    need = PER_VALUE * values + PER_SYMBOL * symbols + PER_BYTE * file_bytes
    require(need <= DEFAULT, "limit.memory", None)


def check_work(h, file_bytes, bound):
    """R-LVL-008: limit.work if W_E of 13.4 is above `bound`; None: no bound."""
    symbols = h.n_anchors * (sum(dim for _, dim in h.types) + h.n_offsets + 1)
    steps = file_bytes + 4 * blob_values(h) + h.n_anchors * (
        products_of_tier_e(h) + hyperprior_shape(h)[-1]) + symbols
    require(bound is None or steps <= bound, "limit.work", None)
