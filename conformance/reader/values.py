# SPDX-License-Identifier: BSD-2-Clause
"""Decoded values (10.4: R-ATT-006)."""

from floats import f32_round
from tables import STEP


def quantiser_steps(h, name, indices):
    """q of each anchor for a type: the binary32 product of Q0 and STEP. The binary64 product of two
    binary32 values is exact, so there is only one rounding."""
    q0 = h.step[("feature", "scaling", "offset", "phi", "tau").index(name)]
    table = {i: f32_round(q0 * STEP[i]) for i in set(indices)}
    return [table[i] for i in indices]


def component_values(component, q):
    """The binary32 product k q of each symbol of a component; q is that of all anchors of the
    tile."""
    return [f32_round(k * q[a]) for a, k in zip(component.anchors, component.k)]
