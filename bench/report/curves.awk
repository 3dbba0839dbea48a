# curves.awk - how far one rate-distortion curve lies from another. A curve is n points (x[i], y[i]), i from 1; for a rate at equal quality x is the PSNR
# and y the logarithm of the bytes, for a quality at equal rate the other way round. Functions only; used by bench/report.sh and tests/test_report.sh.
# Source of the cubic one: G. Bjontegaard, VCEG-M33, 2001.
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

# Coefficients c[0..3] of the cubic in u = (x - middle) / half that fits the points best: normal equations, Gaussian elimination with pivots.
function cubic_fit(x, y, n, middle, half, c,    i, j, k, u, p, m, best, t) {
    for (i = 0; i < 4; i++)
        for (j = 0; j <= 4; j++)
            m[i, j] = 0
    for (k = 1; k <= n; k++) {
        u = (x[k] - middle) / half
        for (i = 0; i < 7; i++)
            p[i] = i > 0 ? p[i - 1] * u : 1
        for (i = 0; i < 4; i++) {
            for (j = 0; j < 4; j++)
                m[i, j] += p[i + j]
            m[i, 4] += p[i] * y[k]
        }
    }
    for (i = 0; i < 4; i++) {
        best = i
        for (k = i + 1; k < 4; k++)
            if (m[k, i] * m[k, i] > m[best, i] * m[best, i])
                best = k
        for (j = 0; j <= 4; j++) {
            t = m[i, j]; m[i, j] = m[best, j]; m[best, j] = t
        }
        for (k = i + 1; k < 4; k++)
            for (j = 4; j >= i; j--)
                m[k, j] -= m[i, j] * m[k, i] / m[i, i]
    }
    for (i = 3; i >= 0; i--) {
        c[i] = m[i, 4]
        for (j = i + 1; j < 4; j++)
            c[i] -= m[i, j] * c[j]
        c[i] /= m[i, i]
    }
}

function cubic_mean(c, low, high) {
    return (cubic_integral(c, high) - cubic_integral(c, low)) / (high - low)
}

function cubic_integral(c, u) {
    return u * (c[0] + u * (c[1] / 2 + u * (c[2] / 3 + u * c[3] / 4)))
}

# Whether n sorted points have four or more different x, which a cubic needs.
function cubic_exists(x, n,    i, different) {
    for (i = 1; i <= n; i++)
        different += i == 1 || x[i] > x[i - 1]
    return different >= 4
}

# Bjontegaard: mean of curve b less curve a, each a cubic through its points, over the x that both have. "" with fewer than four points, or nothing shared.
function bjontegaard(xa, ya, na, xb, yb, nb,    low, high, middle, half, ca, cb) {
    if (!cubic_exists(xa, na) || !cubic_exists(xb, nb))
        return ""
    low = xa[1] > xb[1] ? xa[1] : xb[1]
    high = xa[na] < xb[nb] ? xa[na] : xb[nb]
    if (!(low < high))
        return ""
    middle = (low + high) / 2
    half = (high - low) / 2
    cubic_fit(xa, ya, na, middle, half, ca)
    cubic_fit(xb, yb, nb, middle, half, cb)
    return cubic_mean(cb, -1, 1) - cubic_mean(ca, -1, 1)
}

# A gap between logarithms of bytes as percent.
function percent_of(gap) {
    return gap == "" ? "" : 100 * (exp(gap) - 1)
}
