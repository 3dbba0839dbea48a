# curves.awk - how far one rate-distortion curve lies from another. A curve is n points (x[i], y[i]), i from 1; for a rate at equal quality x is the PSNR
# and y the logarithm of the bytes, for a quality at equal rate the other way round. Functions only; used by bench/report.sh and tests/tools/test_report.sh.
# Sources: G. Bjontegaard, VCEG-M33, 2001 (the mean); F. N. Fritsch and J. Butland, SIAM J. Sci. Stat. Comput. 5 (1984), the cubics, as JCT-VC uses them.
# SPDX-License-Identifier: BSD-2-Clause

# Points in order of x.
function curve_sort(x, y, n,    i, j, a, b) {
    for (i = 2; i <= n; i++) {
        a = x[i]; b = y[i]
        for (j = i - 1; j >= 1 && x[j] > a; j--) {
            x[j + 1] = x[j]; y[j + 1] = y[j]
        }
        x[j + 1] = a; y[j + 1] = b
    }
}

# y at that x on the straight lines between sorted points; "" outside of them.
function curve_at(x, y, n, at,    i) {
    if (n < 1 || at < x[1] || at > x[n])
        return ""
    for (i = 1; i < n && at > x[i + 1]; i++)
        ;
    if (i == n || x[i + 1] == x[i])
        return y[i]
    return y[i] + (y[i + 1] - y[i]) * (at - x[i]) / (x[i + 1] - x[i])
}

# Mean of curve b less curve a over the x that both have, on straight lines; "" when they share none. Exact: corners of both are its steps.
function curve_gap(xa, ya, na, xb, yb, nb,    low, high, n, i, at, gap, before, cut, unused, sum) {
    if (na < 2 || nb < 2)
        return ""
    low = xa[1] > xb[1] ? xa[1] : xb[1]
    high = xa[na] < xb[nb] ? xa[na] : xb[nb]
    if (!(low < high))
        return ""
    for (i = 1; i <= na; i++)
        if (xa[i] > low && xa[i] < high)
            cut[++n] = xa[i]
    for (i = 1; i <= nb; i++)
        if (xb[i] > low && xb[i] < high)
            cut[++n] = xb[i]
    cut[++n] = high
    for (i = 1; i <= n; i++)
        unused[i] = 0
    curve_sort(cut, unused, n)
    at = low
    before = curve_at(xb, yb, nb, at) - curve_at(xa, ya, na, at)
    for (i = 1; i <= n; i++) {
        gap = curve_at(xb, yb, nb, cut[i]) - curve_at(xa, ya, na, cut[i])
        sum += (cut[i] - at) * (gap + before) / 2
        at = cut[i]
        before = gap
    }
    return sum / (high - low)
}

# Slopes d[i] of the monotone piecewise cubic through sorted points of different x: harmonic means inside, where the lines on both sides rise or both fall, else 0; from
# three points at the ends. So the curve leaves the range of its neighbouring points nowhere, which one cubic through all points may do by far.
function slopes(x, y, n, d,    i, h, m, v, w) {
    for (i = 1; i < n; i++) {
        h[i] = x[i + 1] - x[i]
        m[i] = (y[i + 1] - y[i]) / h[i]
    }
    for (i = 2; i < n; i++) {
        v = 2 * h[i] + h[i - 1]
        w = h[i] + 2 * h[i - 1]
        d[i] = m[i - 1] * m[i] <= 0 ? 0 : (v + w) / (v / m[i - 1] + w / m[i])
    }
    d[1] = end_slope(h[1], h[2], m[1], m[2])
    d[n] = end_slope(h[n - 1], h[n - 2], m[n - 1], m[n - 2])
}

# At an end: next to it a piece of width h and slope m, then one of width h2 and slope m2.
function end_slope(h, h2, m, m2,    d) {
    d = ((2 * h + h2) * m - h * m2) / (h + h2)
    if (d * m <= 0)
        return 0
    return m * m2 < 0 && size_of(d) > 3 * size_of(m) ? 3 * m : d
}

# The integral from x[1] to at.
function cubic_integral(x, y, n, d, at,    i, h, s, s3, s4, sum) {
    for (i = 1; i < n && at > x[i]; i++) {
        h = x[i + 1] - x[i]
        s = at < x[i + 1] ? (at - x[i]) / h : 1
        s3 = s * s * s
        s4 = s3 * s
        sum += h * (y[i] * (s - s3 + s4 / 2) + y[i + 1] * (s3 - s4 / 2) + h * d[i] * (s * s / 2 - 2 * s3 / 3 + s4 / 4) + h * d[i + 1] * (s4 / 4 - s3 / 3))
    }
    return sum + 0
}

# Whether n sorted points are four or more, all of different x.
function cubic_exists(x, n,    i) {
    for (i = 2; i <= n; i++)
        if (x[i] <= x[i - 1])
            return 0
    return n >= 4
}

# Bjontegaard's mean of curve b less curve a, each a monotone piecewise cubic, over the x that both have. "" with fewer than four points, or nothing shared.
function bjontegaard(xa, ya, na, xb, yb, nb,    low, high, da, db) {
    if (!cubic_exists(xa, na) || !cubic_exists(xb, nb))
        return ""
    low = xa[1] > xb[1] ? xa[1] : xb[1]
    high = xa[na] < xb[nb] ? xa[na] : xb[nb]
    if (!(low < high))
        return ""
    slopes(xa, ya, na, da)
    slopes(xb, yb, nb, db)
    return (cubic_integral(xb, yb, nb, db, high) - cubic_integral(xb, yb, nb, db, low) - \
            cubic_integral(xa, ya, na, da, high) + cubic_integral(xa, ya, na, da, low)) / (high - low)
}

# A gap between logarithms of bytes as percent.
function percent_of(gap) {
    return gap == "" ? "" : 100 * (exp(gap) - 1)
}
