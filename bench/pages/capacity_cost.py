"""What a run costs, and what of its file is there for time's sake.
SPDX-License-Identifier: BSD-2-Clause"""
import math


def values_of(run):
    """Values of the anchors of a run: what lambda's bits are divided by, the same for all runs of a
    scene: those of its whole model."""
    return run.count("anchors") * (run.count("feature_dim") + 6 + 3 * run.count("n_offsets")
                                   + run.count("phi_dim") + 4 * run.count("activation"))


def distortion(run):
    """Of held-out pictures, as training weighs it."""
    return 0.8 * run.count("l1") + 0.2 * (1 - run.count("ssim"))


def chain(inputs, hidden, width, outputs):
    """Weights of a chain of layers, hidden ones of a width."""
    if hidden > 0:
        return ((inputs + 1) * width + (hidden - 1) * (width + 1) * width
                + (width + 1) * outputs)
    return (inputs + 1) * outputs


def motion_weights(run):
    """Weights of those networks of reconstruction that move things."""
    motion, bank, phi = (run.count(name) for name in ("motion", "bank_dim", "phi_dim"))
    layers, width = run.count("deform_layers"), run.count("deform_width")
    outputs = 3 + run.count("feature_dim")
    if motion == 0:
        return 0
    if motion == 1:
        return chain(phi, 0, 0, bank) + chain(bank, layers, width, outputs)
    return chain(phi + bank if motion == 2 else 84, layers, width, outputs)


def head_weights(run):
    feature, offsets, layers, width, view = (run.count(name) for name in (
        "feature_dim", "n_offsets", "head_layers", "head_width", "view"))
    geometry = feature + 3 * (view == 2)
    return (chain(geometry, layers, width, offsets) + chain(geometry, layers, width, 7 * offsets)
            + chain(feature + 3 * (view > 0), layers, width, 3 * offsets))


def weight_bits(run):
    """Bits of the file for a weight of the networks of reconstruction or a value of the bank; None
    without a row."""
    weights = (motion_weights(run) + head_weights(run)
               + run.count("bank_rows") * run.count("bank_dim"))
    return 8 * (run.count("b_netr") + run.count("b_bank")) / weights if run.has() else None


def temporal(run):
    """Bytes that a file has because things move, come or go: bank, temporal features, activations,
    and the networks' share."""
    motion = motion_weights(run)
    return (run.count("b_bank") + run.count("b_phi") + run.count("b_tau")
            + run.count("b_netr") * motion / (motion + head_weights(run)))


class Costs:
    def __init__(self, runs):
        self.runs = runs

    def of(self, run):
        """None where it is not known."""
        whole = self.runs.first(run.scene, "whole")
        values = values_of(whole) if whole.has() else 0
        if not run.has() or values <= 0:
            return None
        return distortion(run) + 8 * run.count("lambda") * run.count("bytes") / values

    def fixed(self, scene):
        """The first run of each fixed setting that a scene is to be trained with."""
        return [self.runs.first(scene, variant) for variant in self.runs.variants
                if variant != "auto" and self.runs.of(scene, variant)]

    def best_fixed(self, scene):
        """The one that costs least; None without any."""
        known = [run for run in self.fixed(scene) if self.of(run) is not None]
        return min(known, key=self.of, default=None)

    def spread(self, scene):
        """Standard deviation of auto's cost over seeds; None with fewer than two."""
        costs = [self.of(run) for run in self.runs.of(scene, "auto")]
        costs = [cost for cost in costs if cost is not None]
        n, total, square = len(costs), sum(costs), sum(cost * cost for cost in costs)
        if n < 2 or square / n <= total * total / n / n:
            return None
        return math.sqrt((square - total * total / n) / (n - 1))

    def mean(self, scene, variant, value):
        """Of a column or a function of runs, over the seeds of a scene's variant; None as long as
        one is missing."""
        runs = self.runs.of(scene, variant)
        if not runs or not all(run.has() for run in runs):
            return None
        return sum(run.count(value) if isinstance(value, str) else value(run)
                   for run in runs) / len(runs)
