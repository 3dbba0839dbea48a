# SPDX-License-Identifier: BSD-2-Clause
"""Reconstruction (chapter 11): the records of a query, T5. Every quantity is a list of vectors over
anchors, one per component."""

from array import array
from collections import namedtuple
from itertools import repeat
import sys

import strict as s
from hyperprior import encode
from values import component_values, quantiser_steps
from verdict import Refusal, require

Query = namedtuple("Query", "num den camera")
FIELDS = 14                                         # binary32 values of a record (11.6)


class Anchors:
    """All anchors of a model with their decoded values: value[type][c] is a vector over anchors, 0
    where the component is absent. Built once for all queries."""

    def __init__(self, model):
        h = self.header = model.header
        self.model = model
        self.count = h.n_anchors
        self.p = [list(model.positions.values[j::3]) for j in range(3)]
        self.fixed = model.positions.fixed
        self.kept = [bits for tile in model.tiles for bits in tile.kept]
        self.dynamic = [a for tile in model.tiles
                        for a, moves in enumerate(tile.dynamic, tile.first) if moves]
        self.value = {name: [[0.0] * self.count for _ in range(dim)] for name, dim in h.types}
        for tile in model.tiles:
            for name, _ in h.types:
                q = quantiser_steps(h, name, tile.step[name])
                for vector, component in zip(self.value[name], tile.coded[name]):
                    for a, v in zip(component.anchors, component_values(component, q)):
                        vector[tile.first + a] = v
        # S of 11.1
        self.size = [s.pow2(v) if h.scale_domain == 0 else s.at_least(2.0 ** -20, v)
                     for v in self.value["scaling"]]


def records(anchors, query):
    """The T5 string of a query (J.7), or a Refusal."""
    h, feature = anchors.header, anchors.value["feature"]
    num, den = query.num, query.den
    require(1 <= den < 1 << 24 and 0 <= num <= den, "query.range", None)            # R-REC-002
    moved_p, moved_f = move(anchors, num, den)
    strength = activation(anchors, num, den)
    direction = view_direction(anchors, query.camera) if h.view else []
    sees = {"opacity": h.view == 2, "covariance": h.view == 2, "colour": h.view > 0}
    head = {name: s.dense(anchors.model.networks[name],
                          (moved_f if name == "covariance" else feature) +
                          (direction if sees[name] else []))
            for name in sees}
    out = array("f", bytes(4 * FIELDS * sum(bin(bits).count("1") for bits in anchors.kept)))
    place = places(anchors.kept)
    for k in range(h.n_offsets):
        chosen = [a for a, bits in enumerate(anchors.kept) if bits >> k & 1]
        fields = position(anchors, moved_p, k, chosen)
        fields = fields + covariance(anchors, head["covariance"], k, chosen)
        fields += opacity(head["opacity"][k], strength, chosen)
        fields += [s.sigmoid(pick(y, chosen)) for y in head["colour"][3 * k:3 * k + 3]]
        for field, vector in enumerate(fields):
            for a, v in zip(chosen, vector):
                out[FIELDS * (place[a] + bin(anchors.kept[a] & (1 << k) - 1).count("1")) +
                    field] = v
    if any(v - v != 0 for v in out):                # not 0 for infinities and NaN
        raise Refusal("rec.non-finite")             # R-REC-001
    if sys.byteorder == "big":
        out.byteswap()
    return out.tobytes()


def pick(vector, chosen):
    return [vector[a] for a in chosen]


def places(kept):
    """The number of each anchor's first record."""
    place, total = [], 0
    for bits in kept:
        place.append(total)
        total += bin(bits).count("1")
    return place


def bank_at(bank, num, den):
    """z of 11.2, one number per column."""
    g = num * (len(bank) - 1)
    i = g // den
    if i >= len(bank) - 1:
        return bank[-1]
    w = s.div([float(g % den)], [float(den)])[0]
    return s.add(bank[i], s.scaled(s.sub(bank[i + 1], bank[i]), w))


def move(anchors, num, den):
    """11.3, R-REC-006: p' and f'."""
    h, chosen = anchors.header, anchors.dynamic
    p, f = anchors.p, anchors.value["feature"]
    if not chosen:
        return p, f
    networks = anchors.model.networks
    if h.motion == 3:
        own = [[x / 4096.0 for x in encode(anchors.fixed[3 * a:3 * a + 3], 10)] for a in chosen]
        time = [x / 4096.0 for x in encode([(num << 24) // den], 10)]
        inputs = [list(column) for column in zip(*own)] + [[t] * len(chosen) for t in time]
    else:
        z = bank_at(anchors.model.bank, num, den)
        phi = [pick(v, chosen) for v in anchors.value["phi"]]
        if h.motion == 1:
            inputs = [s.scaled(w, z_j) for w, z_j in zip(s.dense(networks["project"], phi), z)]
        else:
            inputs = phi + [[z_j] * len(chosen) for z_j in z]
    y = s.dense(networks["deform"], inputs)
    moved = []
    for vector, delta in zip(p + f, y):
        vector = list(vector)
        for a, v in zip(chosen, s.add(pick(vector, chosen), delta)):
            vector[a] = v
        moved.append(vector)
    return moved[:3], moved[3:]


def activation(anchors, num, den):
    """11.4, R-REC-007: A."""
    if not anchors.header.activation:
        return [1.0] * anchors.count
    t = s.div([float(num)], [float(den)])[0]
    begins, log_start, ends, log_end = anchors.value["tau"]
    b_s, b_f = (s.at_least(2.0 ** -12, s.pow2(v)) for v in (log_start, log_end))
    edge, width = [], []
    for a in range(anchors.count):
        before = t < begins[a]
        edge.append(begins[a] if before else ends[a])
        width.append(b_s[a] if before else b_f[a])
    u = s.div(s.sub(repeat(t, anchors.count), edge), width)
    fade = s.pow2(s.scaled(s.negated(s.mul(u, u)), s.LOG2E))
    return [v if t < begin or t > end else 1.0 for v, begin, end in zip(fade, begins, ends)]


def length(vectors):
    """The square root of the sum of squares, in order."""
    total = s.mul(vectors[0], vectors[0])
    for v in vectors[1:]:
        total = s.add(total, s.mul(v, v))
    return s.sqrt(total)


def normalised(vectors, instead):
    """Each vector divided by its length n, or `instead` if n < 2^-20."""
    n = length(vectors)
    short = [v < 2.0 ** -20 for v in n]
    n = [1.0 if is_short else v for is_short, v in zip(short, n)]
    return [[c if is_short else q for is_short, q in zip(short, s.div(v, n))]
            for v, c in zip(vectors, instead)]


def view_direction(anchors, camera):
    """11.5, R-REC-008."""
    h = anchors.header
    v = []
    for j in range(3):
        c = s.scaled(s.sub([camera[j]], [h.origin[j]]), 2.0 ** -h.exponent)[0]
        v.append(s.shifted(anchors.p[j], -c))
    return normalised(v, (0.0, 0.0, 1.0))


def position(anchors, moved_p, k, chosen):
    """11.6, R-REC-010."""
    h, fields = anchors.header, []
    for j in range(3):
        offset = s.mul(pick(anchors.value["offset"][3 * k + j], chosen),
                       pick(anchors.size[j], chosen))
        local = s.add(pick(moved_p[j], chosen), offset)
        fields.append(s.shifted(s.scaled(local, 2.0 ** h.exponent), h.origin[j]))
    return fields


def covariance(anchors, head, k, chosen):
    """R-REC-009: scale (in the world) and rotation."""
    y = [pick(v, chosen) for v in head[7 * k:7 * k + 7]]
    scale = [s.mul(pick(anchors.size[3 + j], chosen), s.sigmoid(y[j])) for j in range(3)]
    scale = [s.scaled(v, 2.0 ** anchors.header.exponent) for v in scale]
    return scale + normalised(y[3:], (1.0, 0.0, 0.0, 0.0))


def opacity(y, strength, chosen):
    """R-REC-009."""
    o = s.shifted(s.scaled(s.sigmoid(s.scaled(pick(y, chosen), 2.0)), 2.0), -1.0)
    return [s.mul([0.0 if 0.0 > v else v for v in o], pick(strength, chosen))]
