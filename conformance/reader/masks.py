# SPDX-License-Identifier: BSD-2-Clause
"""The mask substream (9.3: R-ENT-013, R-ENT-014)."""


def default_masks(h, n):
    """Dynamic bits and offset bits where nothing is coded."""
    return [int(h.moves)] * n, [(1 << h.n_offsets) - 1] * n


def mask_symbols(h, n):
    """Number of bits in a tile of n anchors; 0 if there is no such substream."""
    return n * (h.temporal_mask + h.n_offsets * h.offset_mask)


def decode_masks(substream, h, n, dynamic_prob, offset_prob):
    """Per anchor its dynamic bit and its offset bits as one number (bit k: offset k is kept); then
    all bits in coded order."""
    dynamic, kept = default_masks(h, n)
    coded = []
    for a in range(n):
        if h.temporal_mask:
            dynamic[a] = substream.bit(len(coded), dynamic_prob)
            coded.append(dynamic[a])
        if h.offset_mask:
            bits = offset_bits(substream, len(coded), h.n_offsets,
                               offset_prob[3 * dynamic[a]:3 * dynamic[a] + 3])
            kept[a] = sum(bit << k for k, bit in enumerate(bits))
            coded.extend(bits)
    substream.finish()
    return dynamic, kept, coded


def offset_bits(substream, first, count, prob):
    """The context: 1 while all bits so far are 1 (or there are none), 0 while all are 0, else
    2."""
    bits = []
    for k in range(count):
        ones = sum(bits)
        context = 1 if ones == k else 0 if ones == 0 else 2
        bits.append(substream.bit(first + k, prob[context]))
    return bits
