# SPDX-License-Identifier: BSD-2-Clause
"""NETE: the networks of Tier E, integerised, judged and evaluated (7.3, R-NET-011)."""

import struct

from blob import Blob
from floats import f32_sound, f32_values
from integers import clamp
from shapes import hyperprior_shape, layers, slice_shapes
from verdict import require

# fraction bits of the hyperprior's inputs, hidden values, outputs
PHASE_BITS, HIDDEN_BITS, OUTPUT_BITS = 12, 10, 8
LIMIT = (1 << 26) - 1


class Layer:
    """One dense layer, all its units in one Python integer.

    Unit o lives in bits 32 o to 32 o + 31. Column i of W is the integer sum of W[o][i] 2^(32 o), so
    x_i times it is all products with x_i at once, and acc = B + sum W x of all units is n_in
    multiplications of a long integer with a short one, which is many times faster than a loop over
    the units. R-NET-006 makes it right: |acc| + 2^(r-1) < 2^31, so with 2^31 + 2^(r-1) added to
    each B every field ends in (0, 2^32) and borrows nothing from its neighbour. The 2^(r-1) is the
    one of round_shift.
    """

    def __init__(self, weights, biases, shifts, hidden):
        n = len(biases)
        self.columns = [pack(column) for column in zip(*weights)]
        self.bias = pack([b + (1 << r >> 1) + (1 << 31) for b, r in zip(biases, shifts)])
        self.shifts = [(r, 1 << 31 - r) for r in shifts]
        self.hidden = hidden
        self.size = 4 * n
        self.fields = struct.Struct("<%dI" % n)

    def __call__(self, x):
        """Outputs of all units for the inputs x, integers."""
        acc = self.bias
        for column, value in zip(self.columns, x):
            if value:
                acc += column * value
        y = [(field >> r) - offset for field, (r, offset) in zip(
            self.fields.unpack(acc.to_bytes(self.size, "little")), self.shifts)]
        if self.hidden:
            return [0 if v < 0 else 32767 if v > 32767 else v for v in y]
        return [clamp(v, -LIMIT, LIMIT) for v in y]


def pack(fields):
    """The sum of fields[o] 2^(32 o), fields of either sign."""
    total = 0
    for field in reversed(fields):
        total = (total << 32) + field
    return total


class Network:
    def __init__(self, layer_list):
        self.layers = layer_list

    def __call__(self, x):
        for layer in self.layers:
            x = layer(x)
        return x


def read_networks(payload, h):
    """The hyperprior and the list of slice networks 1 .. n_slices - 1 of the NETE chunk."""
    plans = [plan(hyperprior_shape(h), PHASE_BITS, 4096)] + [
        plan(shape, h.context_bits, 32767) for shape in slice_shapes(h)]
    units = [unit for network in plans for layer in network for unit in [layer] * layer["outputs"]]
    shifts = []
    for (offset, s), unit in zip(payload.entries("shift", 1, len(units)), units):
        require(s <= 20, "net.shift", offset)                                           # R-NET-003
        require(s + unit["f"] - unit["g"] >= 0, "net.shift", offset)                    # R-NET-005
        shifts.append(s)
    count = sum((p["inputs"] + 1) * p["outputs"] for network in plans for p in network)
    reader = LayerReader(shifts, Blob(payload, "nete", count, list(coded_units(plans, shifts))))
    networks = [Network([reader.layer(p) for p in network]) for network in plans]
    return networks[0], networks[1:]


def coded_units(plans, shifts):
    """7.6: the units of mode 2: for each layer those of its weights, then those of its biases, with
    contexts of their own."""
    unit = 0
    for p in (p for network in plans for p in network):
        mine = shifts[unit:unit + p["outputs"]]
        unit += p["outputs"]
        yield [(p["inputs"], -s) for s in mine]
        yield [(1, -(s + p["f"])) for s in mine]


def plan(shape, bits, amplitude):
    """Per layer: sizes, fraction bits f of its inputs and g of its outputs, A, and whether it is
    hidden."""
    count = len(shape) - 1
    return [{"inputs": inputs, "outputs": outputs, "f": HIDDEN_BITS if i else bits,
             "g": OUTPUT_BITS if i == count - 1 else HIDDEN_BITS,
             "A": 32767 if i else amplitude, "hidden": i < count - 1}
            for i, (inputs, outputs) in enumerate(layers(shape))]


class LayerReader:
    """Takes layer after layer off shifts and blob, judging each value by R-NET-002 and R-NET-004
    (weights) or R-NET-006 (biases)."""

    def __init__(self, shifts, blob):
        self.shifts, self.blob = shifts, blob
        self.unit = self.value = 0

    def layer(self, p):
        shifts = self.shifts[self.unit:self.unit + p["outputs"]]
        weights = [[self.weight(s) for _ in range(p["inputs"])] for s in shifts]
        r = [s + p["f"] - p["g"] for s in shifts]
        biases = [self.bias(s + p["f"], sum(map(abs, row)) * p["A"], half) for s, row, half in
                  zip(shifts, weights, [1 << k >> 1 for k in r])]
        self.unit += p["outputs"]
        return Layer(weights, biases, r, p["hidden"])

    def next_scaled(self, bits):
        """rne(v 2^bits). A binary64 holds the product exactly, and Python's round takes ties to
        even."""
        i = self.value
        self.value += 1
        pattern, offset = self.blob.patterns[i], self.blob.offset(i)
        require(f32_sound(pattern), "net.value", offset)
        return round(f32_values([pattern])[0] * (1 << bits)), offset

    def weight(self, s):
        w, offset = self.next_scaled(s)
        require(abs(w) <= 32767, "net.weight-range", offset)
        return w

    def bias(self, bits, reach, half):
        b, offset = self.next_scaled(bits)
        require(reach + abs(b) + half <= 0x7FFFFFFF, "net.accumulator", offset)
        return b
