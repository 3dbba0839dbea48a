"""How far one rate-distortion curve lies from another.

A curve is a list of points (x, y) in order of x. For a rate at equal quality x is the PSNR and y
the logarithm of the bytes; for a quality at equal rate the other way round. Sources:
G. Bjontegaard, VCEG-M33, 2001 (the mean); F. N. Fritsch and J. Butland, SIAM J. Sci. Stat. Comput.
5 (1984), the cubics, as JCT-VC uses them.
SPDX-License-Identifier: BSD-2-Clause"""
import math


def swapped(curve):
    """x and y exchanged."""
    return sorted(((y, x) for x, y in curve), key=lambda point: point[0])


def value_at(curve, at):
    """y at that x on the straight lines between points; None outside of them."""
    if not curve or at < curve[0][0] or at > curve[-1][0]:
        return None
    i = 0
    while i < len(curve) - 1 and at > curve[i + 1][0]:
        i += 1
    x, y = curve[i]
    if i == len(curve) - 1 or curve[i + 1][0] == x:
        return y
    return y + (curve[i + 1][1] - y) * (at - x) / (curve[i + 1][0] - x)


def shared_range(a, b):
    """(low, high) of the x that both curves have, or None."""
    low, high = max(a[0][0], b[0][0]), min(a[-1][0], b[-1][0])
    return (low, high) if low < high else None


def mean_gap(a, b):
    """Mean of curve b less curve a over the x that both have, on straight lines; None when they
    share none. It is exact, for the corners of both are its steps."""
    if len(a) < 2 or len(b) < 2 or shared_range(a, b) is None:
        return None
    low, high = shared_range(a, b)
    cuts = sorted([x for x, _ in a + b if low < x < high] + [high])
    at, total = low, 0
    before = value_at(b, at) - value_at(a, at)
    for cut in cuts:
        gap = value_at(b, cut) - value_at(a, cut)
        total += (cut - at) * (gap + before) / 2
        at, before = cut, gap
    return total / (high - low)


def slopes(curve):
    """Slopes of the monotone piecewise cubic through points of different x.

    Inside: harmonic means where the lines on both sides rise or both fall, else 0; at the ends:
    from three points. So the curve leaves the range of its neighbouring points nowhere, which one
    cubic through all points may do by far."""
    h = [b[0] - a[0] for a, b in zip(curve, curve[1:])]
    m = [(b[1] - a[1]) / step for a, b, step in zip(curve, curve[1:], h)]
    inner = []
    for i in range(1, len(h)):
        v, w = 2 * h[i] + h[i - 1], h[i] + 2 * h[i - 1]
        inner.append(0 if m[i - 1] * m[i] <= 0 else (v + w) / (v / m[i - 1] + w / m[i]))
    return ([end_slope(h[0], h[1], m[0], m[1])] + inner
            + [end_slope(h[-1], h[-2], m[-1], m[-2])])


def end_slope(h, h2, m, m2):
    """At an end: next to it a piece of width h and slope m, then one of width h2 and slope m2."""
    d = ((2 * h + h2) * m - h * m2) / (h + h2)
    if d * m <= 0:
        return 0
    return 3 * m if m * m2 < 0 and abs(d) > 3 * abs(m) else d


def integral(curve, slope, at):
    """Of the piecewise cubic, from the first point to x = at."""
    total = 0
    for i in range(len(curve) - 1):
        (x, y), (x2, y2) = curve[i], curve[i + 1]
        if at <= x:
            break
        h = x2 - x
        s = (at - x) / h if at < x2 else 1
        s3, s4 = s ** 3, s ** 4
        total += h * (y * (s - s3 + s4 / 2) + y2 * (s3 - s4 / 2)
                      + h * slope[i] * (s * s / 2 - 2 * s3 / 3 + s4 / 4)
                      + h * slope[i + 1] * (s4 / 4 - s3 / 3))
    return total


def has_cubic(curve):
    """Four points or more, all of different x."""
    return len(curve) >= 4 and all(a[0] < b[0] for a, b in zip(curve, curve[1:]))


def bjontegaard(a, b):
    """Bjontegaard's mean of curve b less curve a, each a monotone piecewise cubic, over the x that
    both have. None with fewer than four points, or where nothing is shared."""
    if not has_cubic(a) or not has_cubic(b) or shared_range(a, b) is None:
        return None
    low, high = shared_range(a, b)
    of_a, of_b = slopes(a), slopes(b)
    return (integral(b, of_b, high) - integral(b, of_b, low)
            - integral(a, of_a, high) + integral(a, of_a, low)) / (high - low)


def as_percent(gap):
    """A gap between logarithms of bytes."""
    return None if gap is None else 100 * (math.exp(gap) - 1)
