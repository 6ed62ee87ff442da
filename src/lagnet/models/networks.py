"""Multilayer perceptrons whose units may see only some of the inputs, decided by an order on units."""

from __future__ import annotations

from collections.abc import Callable

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array

from lagnet.errors import ModelError

ACTIVATIONS: dict[str, Callable] = {"silu": jax.nn.silu, "tanh": jnp.tanh, "softplus": jax.nn.softplus}
SLOPES: dict[str, Callable] = {  # derivative from argument and value, so that nothing is computed twice
    "silu": lambda x, y: (s := jax.nn.sigmoid(x)) + y * (1.0 - s),
    "tanh": lambda x, y: 1.0 - y**2,
    "softplus": lambda x, y: jax.nn.sigmoid(x),
}
LARGEST_WIDTH = 2048
SMALL_START = 0.01  # power of the outputs at first: torque follows by derivatives of energies, which are much larger


def check_widths(hidden: tuple[int, ...]) -> None:
    """Refuse layers that are empty or too wide to be meant.

    Raises:
        ModelError: a width outside 1 … LARGEST_WIDTH, or no hidden layer.
    """
    if not hidden or not all(1 <= width <= LARGEST_WIDTH for width in hidden):
        raise ModelError(f"hidden layers {list(hidden)} are not usable", next_step=f"give widths 1 … {LARGEST_WIDTH}")


Pass = Callable[[Array], Array]


class OrderedNetwork(eqx.Module):
    """A multilayer perceptron in which a unit of degree d sees only units of degree d or more below it.

    With all degrees equal it is the ordinary dense network. With the joint index as degree, an output can be made a
    function of the joints from some index on, whatever the weights are.

    Args:
        weights: one (n_out, n_in) matrix a layer.
        biases: one (n_out,) vector a layer.
        degrees: for the input and each layer, the degree of each unit.
        activation: name of the nonlinearity between layers.
    """

    weights: tuple[Array, ...]
    biases: tuple[Array, ...]
    degrees: tuple[tuple[int, ...], ...] = eqx.field(static=True)
    activation: str = eqx.field(static=True)

    def __call__(self, x: Array) -> Array:
        """Outputs (n_out,) for inputs (n_in,)."""
        act = ACTIVATIONS[self.activation]
        last = len(self.weights) - 1
        for layer, (weight, bias) in enumerate(zip(self.weights, self.biases, strict=True)):
            x = x @ self._masked(weight, layer).T + bias  # this way round, samples of a batch stay rows
            x = x if layer == last else act(x)
        return x

    def linearised(self, x: Array) -> tuple[Array, Pass, Pass]:
        """Outputs (n_out,), and the Jacobian there: along a direction of inputs, and back from weights of outputs.

        The same as `jax.jvp` and `jax.vjp`, with the slopes of the units shared by all three.
        """
        act, slope, slopes = ACTIVATIONS[self.activation], SLOPES[self.activation], []
        weights = [self._masked(weight, layer) for layer, weight in enumerate(self.weights)]
        for weight, bias in zip(weights[:-1], self.biases[:-1], strict=True):
            before = x @ weight.T + bias
            x = act(before)
            slopes.append(slope(before, x))

        def along(direction: Array) -> Array:
            for weight, slope in zip(weights[:-1], slopes, strict=True):
                direction = slope * (direction @ weight.T)
            return direction @ weights[-1].T

        def back(wanted: Array) -> Array:
            wanted = wanted @ weights[-1]
            for weight, slope in zip(weights[-2::-1], slopes[::-1], strict=True):
                wanted = (slope * wanted) @ weight
            return wanted

        return x @ weights[-1].T + self.biases[-1], along, back

    def settled(self) -> OrderedNetwork:
        """The same function for use, not for training: unseen weights are zero once and for all, not masked anew."""
        weights = tuple(self._masked(weight, layer) for layer, weight in enumerate(self.weights))
        return OrderedNetwork(weights, self.biases, tuple((0,) * len(units) for units in self.degrees), self.activation)

    def _masked(self, weight: Array, layer: int) -> Array:
        mask = visible(self.degrees[layer + 1], self.degrees[layer])
        return weight if mask.all() else weight * mask.astype(weight.dtype)


def visible(above: tuple[int, ...], below: tuple[int, ...]) -> np.ndarray:
    """Which unit below each unit above may see, shape (n_above, n_below), bool."""
    return np.asarray(below)[None, :] >= np.asarray(above)[:, None]


def make_network(
    key: Array,
    degrees_in: tuple[int, ...],
    degrees_out: tuple[int, ...],
    hidden: tuple[int, ...],
    activation: str,
    hidden_degrees: tuple[int, ...] = (0,),
) -> OrderedNetwork:
    """Draw a network; `hidden_degrees` are spread over each hidden layer in equal shares by repetition.

    Raises:
        ModelError: the activation is unknown.
    """
    if activation not in ACTIVATIONS:
        raise ModelError(f"activation {activation!r} is unknown", choices=ACTIVATIONS)
    layers = tuple(tuple(_spread(hidden_degrees, width)) for width in hidden)
    degrees = (degrees_in, *layers, degrees_out)
    keys = jax.random.split(key, len(degrees) - 1)
    weights = []
    for layer, subkey in enumerate(keys):
        mask = visible(degrees[layer + 1], degrees[layer])
        inputs = np.maximum(mask.sum(axis=1, keepdims=True), 1)
        gain = SMALL_START if layer == len(keys) - 1 else 2.0
        draw = jax.random.normal(subkey, mask.shape) * np.sqrt(gain / inputs) * mask
        weights.append(draw)
    biases = tuple(jnp.zeros(len(units)) for units in degrees[1:])
    return OrderedNetwork(tuple(weights), biases, degrees, activation)


def _spread(values: tuple[int, ...], width: int) -> list[int]:
    """The values in order, each repeated for its share of the width."""
    return [values[(unit * len(values)) // width] for unit in range(width)]
