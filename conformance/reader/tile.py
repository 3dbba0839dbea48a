# SPDX-License-Identifier: BSD-2-Clause
"""TILE: one tile of anchors, from bytes to symbols (9.1, 10.2, 10.3)."""

from collections import namedtuple

from gaussian import decode_symbols
from hyperprior import evaluate_prior, sigma_index
from integers import round_shift, sat16
from masks import decode_masks, default_masks, mask_symbols
from rans import Substream
from tables import STEPI
from verdict import require

# One component of a type: the anchors of the tile that have it, and for each of them sigma index,
# mu (Q8) and symbol.
Component = namedtuple("Component", "anchors sigma mu k")


class Tile:
    """first, n: its anchors. dynamic, kept: per anchor, its dynamic bit and the bits of its
    offsets. step[type]: step indices. coded[type]: its Components. streams: (substream, symbols) in
    order of 9.1, for T3 and 15.2."""

    def __init__(self, payload, model, number):
        h = self.header = model.header
        self.first = number * h.tile_size
        self.n = min(h.n_anchors - self.first, h.tile_size)
        self.model, self.payload = model, payload
        self.streams, self.coded = [], {}
        self.read_elements(number)
        self.decode_masks()
        fixed = model.positions.fixed[3 * self.first:3 * (self.first + self.n)]
        self.priors = evaluate_prior(model.hyperprior, h, fixed)
        self.step = {name: prior.step for name, prior in self.priors.items()}
        self.decode_feature()
        for name, _ in h.types[1:]:
            self.coded[name] = self.decode_components(name, self.priors[name].mu,
                                                      self.priors[name].s)
        if h.activation:
            self.check_order()
        del self.model, self.payload, self.priors

    def read_elements(self, number):
        """All but the substreams: R-ENT-001, R-ENT-002, R-ENT-008, R-ENT-003."""
        h, payload = self.header, self.payload
        start = payload.at
        require(payload.number("tile_index", 4) == number, "ent.tile-index", start)
        self.dynamic_prob = self.probabilities("dynamic_prob", 1)[0] if h.temporal_mask else None
        self.offset_prob = self.probabilities("offset_prob", 6) if h.offset_mask else None
        names = ["mask"] if h.temporal_mask or h.offset_mask else []
        names += ["feature"] * h.n_slices + [name for name, _ in h.types[1:]]
        start = payload.at
        sizes = payload.numbers("size", 4, len(names))
        require(sum(sizes) == payload.end - payload.at, "con.payload-size", start)
        self.waiting = list(zip(names, sizes))

    def probabilities(self, name, count):
        entries = []
        for offset, p in self.payload.entries(name, 2, count):
            require(p > 0, "ent.prob", offset)
            entries.append(p)
        return entries

    def open_substream(self, n):
        """The next substream, of n symbols."""
        name, size = self.waiting.pop(0)
        start = self.payload.at
        self.payload.bytes(name + "_substream", size)
        return Substream(self.payload.data, start, size, n)

    def decode_masks(self):
        h = self.header
        self.dynamic, self.kept = default_masks(h, self.n)
        if h.temporal_mask or h.offset_mask:
            substream = self.open_substream(mask_symbols(h, self.n))
            self.dynamic, self.kept, bits = decode_masks(substream, h, self.n, self.dynamic_prob,
                                                         self.offset_prob)
            self.streams.append((substream, bits))

    def decode_feature(self):
        """10.3, R-ATT-005: slice after slice, each with the contexts of those before it."""
        h = self.header
        prior = self.priors["feature"]
        components, contexts, at = [], [], 0
        for m, size in enumerate(h.slice):
            mu, s = prior.mu[at:at + size], prior.s[at:at + size]
            if m > 0:
                network = self.model.slice_networks[m - 1]
                added = list(zip(*[network(row) for row in zip(*contexts)]))
                mu = [list(map(int.__add__, a, b)) for a, b in zip(mu, added[:size])]
                s = [list(map(int.__add__, a, b)) for a, b in zip(s, added[size:])]
            new = self.decode_components("feature", mu, s)
            components += new
            contexts += [self.context(component.k, prior.step) for component in new]
            at += size
        self.coded["feature"] = components

    def context(self, symbols, steps):
        shift = 12 - self.header.context_bits
        return [sat16(round_shift(k * STEPI[q], shift)) for k, q in zip(symbols, steps)]

    def decode_components(self, name, mu, s):
        """One substream with the components whose model is mu[c], s[c]."""
        present = [self.anchors_with(name, c) for c in range(len(mu))]
        mu = [[row[a] for a in anchors] for row, anchors in zip(mu, present)]
        sigma = [[sigma_index(row[a]) for a in anchors] for row, anchors in zip(s, present)]
        substream = self.open_substream(sum(map(len, present)))
        symbols = decode_symbols(substream, sum(sigma, []), sum(mu, []))
        self.streams.append((substream, symbols))
        components, at = [], 0
        for anchors, g, m in zip(present, sigma, mu):
            components.append(Component(anchors, g, m, symbols[at:at + len(anchors)]))
            at += len(anchors)
        return components

    def anchors_with(self, name, c):
        """10.2, R-ATT-004: which anchors have component c of a type."""
        if name == "offset":
            return [a for a, bits in enumerate(self.kept) if bits >> c // 3 & 1]
        if name == "phi":
            return [a for a, moves in enumerate(self.dynamic) if moves]
        return range(self.n)

    def check_order(self):
        """R-ATT-001, at the substream of tau, which is the last and has been decoded to its end
        (R-ENT-012)."""
        begins, _, ends, _ = (component.k for component in self.coded["tau"])
        require(all(map(int.__le__, begins, ends)), "att.tau-order", self.streams[-1][0].start)
