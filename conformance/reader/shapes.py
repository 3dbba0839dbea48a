# SPDX-License-Identifier: BSD-2-Clause
"""Shapes of all networks, from HEAD (chapter 7). A shape is the list of widths, from the inputs to
the outputs."""


def hyperprior_shape(h):
    """7.3. Without hidden layers it is one layer; a factorised prior has no inputs, only biases."""
    inputs = 0 if h.prior else 3 + 6 * h.pe_octaves
    outputs = 2 * sum(dim for _, dim in h.types) + len(h.types)
    return [inputs] + [h.hyper_width] * h.hyper_layers + [outputs]


def slice_shapes(h):
    """7.3: the networks of slices 1 .. n_slices - 1."""
    return [[sum(h.slice[:m]), h.ar_width, 2 * h.slice[m]] for m in range(1, h.n_slices)]


def tier_r_shapes(h):
    """7.4: (name, shape) of those that exist, in order of the file."""
    shapes = []
    if h.motion == 1:
        shapes.append(("project", [h.phi_dim, h.bank_dim]))
    if h.motion > 0:
        inputs = {1: h.bank_dim, 2: h.phi_dim + h.bank_dim, 3: 84}[h.motion]
        shapes.append(
            ("deform", [inputs] + [h.deform_width] * h.deform_layers + [3 + h.feature_dim]))
    for name, sees, outputs in (("opacity", h.view == 2, 1), ("covariance", h.view == 2, 7),
                                ("colour", h.view > 0, 3)):
        inputs = h.feature_dim + (3 if sees else 0)
        shapes.append((name, [inputs] + [h.head_width] * h.head_layers + [outputs * h.n_offsets]))
    return shapes


def layers(shape):
    """The dense layers of a network as (inputs, outputs)."""
    return list(zip(shape, shape[1:]))


def values_of(shapes):
    """How many f32 values the networks have: weights and biases."""
    return sum((inputs + 1) * outputs for shape in shapes for inputs, outputs in layers(shape))


def tier_e_shapes(h):
    return [hyperprior_shape(h)] + slice_shapes(h)


def products_of_tier_e(h):
    """Chapter 13: products per anchor."""
    return sum(inputs * outputs for shape in tier_e_shapes(h) for inputs, outputs in layers(shape))


def blob_values(h):
    """Chapter 13: f32 values of all blobs: NETE, NETR and BANK."""
    tier_r = values_of(shape for _, shape in tier_r_shapes(h))
    return values_of(tier_e_shapes(h)) + tier_r + h.bank_rows * h.bank_dim
