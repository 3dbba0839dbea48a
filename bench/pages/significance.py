"""Whether means over seeds differ from zero, judged together: Student's t and Holm's correction.
SPDX-License-Identifier: BSD-2-Clause"""
import math

LEVEL = 0.05    # chance of one wrong verdict or more, among all that are judged together


def student_tail(t, freedom):
    """The probability that Student's t with a whole number of degrees of freedom, at least 1, lies
    above t: the finite series in the angle whose tangent is t / sqrt(freedom)."""
    angle = math.atan(t / math.sqrt(freedom))
    sine, square = math.sin(angle), math.cos(angle) ** 2
    odd = freedom % 2
    term, total = (math.cos(angle) if odd else 1.0), 0.0
    for k in range(freedom // 2):
        total += term
        term *= square * (2 * k + 2) / (2 * k + 3) if odd else square * (2 * k + 1) / (2 * k + 2)
    inside = 2 / math.pi * (angle + sine * total) if odd else sine * total
    return (1 - inside) / 2


def holm(chances):
    """{name: probability} to the set of names that hold at LEVEL for all of them together: the
    smallest probability against LEVEL / n, the next against LEVEL / (n - 1), until one fails."""
    holding = set()
    for k, name in enumerate(sorted(chances, key=chances.get)):
        if chances[name] > LEVEL / (len(chances) - k):
            break
        holding.add(name)
    return holding
