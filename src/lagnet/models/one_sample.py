"""Torque of perceptron DeLaN at one sample in plain NumPy, done before a compiled call would have handed over its work.

The sums are those of `PerceptronDelan.inverse_dynamics`. At this size an array operation costs a third of a
microsecond whatever it does, so there are few of them: values and their changes along v go through one product, both
networks through one nonlinearity.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.special import expit

from lagnet.models.dynamics import AbstractDynamics
from lagnet.models.features import JointFeatures
from lagnet.models.lagrangians.conservative import Conservative
from lagnet.models.lagrangians.perceptron_delan import PerceptronDelan
from lagnet.models.networks import OrderedNetwork

Array = np.ndarray
Bend = Callable[[Array], tuple[Array, Array]]


def torque_of_one(dynamics: AbstractDynamics, width: type) -> Callable[[Array, Array, Array], Array] | None:
    """Torque (1, dof) from q, v and a, each (1, dof); None for dynamics that are not perceptron DeLaN alone.

    Args:
        dynamics: the model, its networks settled.
        width: floating-point type of all that is given and computed.
    """
    if not isinstance(dynamics, Conservative) or not isinstance(dynamics.lagrangian, PerceptronDelan):
        return None
    return OneSample(dynamics.lagrangian, width)


def _silu(x: Array) -> tuple[Array, Array]:
    share = expit(x)
    value = x * share
    return value, share + value * (1.0 - share)


def _tanh(x: Array) -> tuple[Array, Array]:
    value = np.tanh(x)
    return value, 1.0 - value * value


def _softplus(x: Array) -> tuple[Array, Array]:
    return np.logaddexp(0.0, x), expit(x)


BENDS: dict[str, Bend] = {"silu": _silu, "tanh": _tanh, "softplus": _softplus}  # value and slope of each unit


class OneSample:
    """A model laid out for one sample at a time, and the torque it gives."""

    def __init__(self, arm: PerceptronDelan, width: type):
        n, root = len(arm.scales.inertia), np.sqrt(np.asarray(arm.scales.inertia))
        self.circle = Circle(arm.features, width)
        self.scale = (np.triu(np.ones((n, n))) * root[:, None]).astype(width).ravel()
        self.floor = width(arm.settings.floor)
        self.networks = TwoNetworks(
            _laid_out(arm.inertia, self.circle, width),
            _laid_out(arm.potential, self.circle, width),
            np.asarray(arm.scales.torque, width),
            BENDS[arm.inertia.activation],
        )

    def __call__(self, q: Array, v: Array, a: Array) -> Array:
        """Torque (1, dof) [N m] at one sample, each argument (1, dof)."""
        v, a = v[0], a[0]
        features, slopes = self.circle(q[0])
        raw, bends = self.networks.up(np.concatenate((features, slopes * v)).reshape(2, -1))
        factor, rate, bent = self._factor(raw)
        speed = v.dot(factor)
        change = v.dot(rate) + a.dot(factor)
        pull = self.networks.down(bent * (v[:, None] * speed).ravel(), bends).reshape(2, -1) * slopes
        return np.asarray(rate.dot(speed) + factor.dot(change) + pull[0] + pull[1], np.float64)[None]

    def _factor(self, raw: Array) -> tuple[Array, Array, Array]:
        """U, its rate, and the derivative of each entry by its output, from the outputs and their rates (2, dof²)."""
        n = self.circle.centre.size
        bent, own = self.scale.copy(), raw[0, :: n + 1]
        bent[:: n + 1] *= expit(own)
        factor = raw[0] * self.scale
        factor[:: n + 1] = (np.logaddexp(0.0, own) + self.floor) * self.scale[:: n + 1]
        return factor.reshape(n, n), (raw[1] * bent).reshape(n, n), bent


class Circle:
    """Features in another order, before division by their scale: sines, or where sliding joints are, then cosines."""

    def __init__(self, features: JointFeatures, width: type):
        n, owner = len(features.joint_types), np.asarray(features.owner)
        self.places = owner + n * (np.diff(owner, prepend=-1) == 0)  # where each of the model's features stands here
        offset = np.zeros(2 * n)
        offset[self.places] = features.offset
        self.offset, self.scale = offset.reshape(2, n).astype(width), np.asarray(features.scale, width)
        self.centre = np.asarray(features.centre, width)
        self.quarters = (0.5 * np.pi * np.arange(3)[:, None]).astype(width)
        self.slides = np.flatnonzero([kind == "prismatic" for kind in features.joint_types])

    def __call__(self, q: Array) -> tuple[Array, Array]:
        """Features at q (dof,) and their derivatives by their joints, each (2, dof)."""
        x = q - self.centre
        rows = np.sin(x + self.quarters)  # the derivative of each row is the next
        if self.slides.size:
            rows[:, self.slides] = np.stack((x, np.ones_like(x), np.zeros_like(x)))[:, self.slides]
        return rows[:2] - self.offset, rows[1:]


Layers = list[tuple[Array, Array]]


def _laid_out(network: OrderedNetwork, circle: Circle, width: type) -> Layers:
    """Weights (n_in, n_out) and biases of each layer, the first for features as `Circle` gives them."""
    layers = [
        (np.asarray(w, width).T.copy(), np.asarray(b, width))
        for w, b in zip(network.weights, network.biases, strict=True)
    ]
    first = np.zeros((circle.offset.size, len(layers[0][1])), width)
    first[circle.places] = layers[0][0] / circle.scale[:, None]
    return [(first, layers[0][1]), *layers[1:]]


class TwoNetworks:
    """The networks of inertia and potential, whose hidden layers have the same widths, side by side."""

    def __init__(self, inertia: Layers, potential: Layers, torque: Array, bend: Bend):
        pairs = list(zip(inertia, potential, strict=True))
        self.bend, self.last = bend, inertia[-1]
        self.hidden = [(w, p, np.concatenate((b, c))) for (w, b), (p, c) in pairs[:-1]]
        self.back = [(w.T.copy(), p.T.copy()) for (w, _), (p, _) in pairs[-2:0:-1]]
        self.ground = np.concatenate((inertia[0][0].T, potential[0][0].T))
        self.force = -inertia[-1][0].T
        self.pull = potential[-1][0].dot(torque)

    def up(self, x: Array) -> tuple[Array, list[Array]]:
        """Outputs of the inertia and their rates (2, dof²) from features and their rates; the slopes of all units."""
        below, bends = x[0], []
        for inertia, potential, bias in self.hidden:
            x, wide = x.dot(inertia), inertia.shape[1]
            value, bend = self.bend(np.concatenate((x[0], below.dot(potential))) + bias)
            x[0], below = value[:wide], value[wide:]
            x[1] *= bend[:wide]
            bends.append(bend)
        raw = x.dot(self.last[0])
        raw[0] += self.last[1]
        return raw, bends

    def down(self, wanted: Array, bends: list[Array]) -> Array:
        """Derivatives by features of the potential, less those of the inertia's outputs times `wanted` (dof²,)."""
        force, pull = wanted.dot(self.force), self.pull
        for (inertia, potential), bend in zip(self.back, bends[:0:-1], strict=True):
            both, wide = np.concatenate((force, pull)) * bend, force.size
            force, pull = both[:wide].dot(inertia), both[wide:].dot(potential)
        return (np.concatenate((force, pull)) * bends[0]).dot(self.ground)
