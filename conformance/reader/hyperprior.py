# SPDX-License-Identifier: BSD-2-Clause
"""Inputs and outputs of the hyperprior (10.1: R-ATT-002, R-ATT-003)."""

from collections import namedtuple

from integers import clamp, round_shift
from tables import SIN

# For one type, with one entry per anchor: step indices; mu[c] and s[c], the lists of component c.
Prior = namedtuple("Prior", "step mu s")


def sine(u):
    """Sine of the phase u, 2^32 a turn, in Q12."""
    i, b = u >> 22, u >> 10 & 4095
    return SIN[i] + round_shift((SIN[i + 1] - SIN[i]) * b, 12)


def encode(coordinates, octaves):
    """Q12 inputs: the coordinates, then octave by octave sine and cosine of each."""
    inputs = [x >> 12 for x in coordinates]
    for octave in range(octaves):
        for x in coordinates:
            u = (x << 7 + octave) & 0xFFFFFFFF
            inputs.append(sine(u))
            inputs.append(sine(u + (1 << 30) & 0xFFFFFFFF))
    return inputs


def evaluate_prior(network, h, fixed):
    """The Prior of each present type for anchors whose X, Y, Z are in `fixed`, three per anchor."""
    if h.prior:
        rows = [network([])] * (len(fixed) // 3)
    else:
        rows = [network(encode(fixed[i:i + 3], h.pe_octaves)) for i in range(0, len(fixed), 3)]
    columns = list(zip(*rows))
    priors, at = {}, 0
    steps = columns[len(columns) - len(h.types):]
    for (name, dim), v in zip(h.types, steps):
        step = [clamp(128 + round_shift(x, 3), 0, 255) for x in v]
        priors[name] = Prior(step, columns[at:at + dim], columns[at + dim:at + 2 * dim])
        at += 2 * dim
    return priors


def sigma_index(s):
    return clamp(64 + round_shift(s, 4), 0, 239)
