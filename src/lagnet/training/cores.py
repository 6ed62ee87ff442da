"""A batch spread over the devices that JAX has: each takes an equal part of its rows, and the gradients are averaged.

One device is the rule. `let_jax_see_cores` makes the cores of a processor so many devices; a step's small operations
gain nothing from a second thread, but a second core that works on the other half of the batch does.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from contextlib import suppress
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jax.flatten_util import ravel_pytree
from jax.sharding import Mesh, NamedSharding
from jax.sharding import PartitionSpec as Spec
from jaxtyping import Array

from lagnet.models.devices import chosen_devices
from lagnet.side_by_side import usable_cores

ROWS = "rows"
FLAG = "xla_force_host_platform_device_count"
LEAST = 128  # rows of a batch that are worth a device of their own
MOST = 8  # cores that are taken without being asked for: usual batches have no more such parts

Gradient = Callable[[Any, tuple[Array, ...], Array, Array], tuple[Array, Any]]
"""(params, data, rows, λ) → loss and gradient over these rows of the data."""


def let_jax_see_cores(cores: int | None = None) -> int:
    """Makes cores of the processor into devices of JAX; to be called before JAX computes anything.

    Args:
        cores: how many; None for those that this process may use, MOST at most, unless the environment says
            (JAX_NUM_CPU_DEVICES).

    Returns:
        The number of devices that there are now: what it was where JAX is in use already.
    """
    said = "JAX_NUM_CPU_DEVICES" in os.environ or FLAG in os.environ.get("XLA_FLAGS", "")
    if cores is not None or not said:
        with suppress(RuntimeError):  # JAX is in use: what it has stays
            jax.config.update("jax_num_cpu_devices", cores or min(usable_cores(), MOST))
    return len(jax.local_devices())


def parts_of(batch: int) -> int:
    """Devices that a batch is spread over: as many as divide it into equal parts that are worth it."""
    many = range(2, len(chosen_devices()) + 1)
    return max((n for n in many if batch % n == 0 and batch >= n * LEAST), default=1)


def mesh_for(batch: int) -> Mesh | None:
    """The devices that a batch is spread over, None for one."""
    parts = parts_of(batch)
    return Mesh(np.array(chosen_devices()[:parts]), (ROWS,)) if parts > 1 else None


def spread(gradient: Gradient, mesh: Mesh | None) -> Gradient:
    """The same gradient, each device taking its part of the rows; exact for losses that are means over rows."""
    if mesh is None:
        return gradient

    def part(params: Any, data: tuple[Array, ...], rows: Array, penalty: Array) -> tuple[Array, Any]:
        value, grads = gradient(params, data, rows, penalty)
        flat, restore = ravel_pytree(grads)  # one message for all weights: messages cost more than their length
        mean = jax.lax.pmean(jnp.append(flat, value), ROWS)
        return mean[-1], restore(mean[:-1])

    inputs = (Spec(), Spec(), Spec(ROWS), Spec())
    return jax.shard_map(part, mesh=mesh, in_specs=inputs, out_specs=Spec(), check_vma=False)


def everywhere(arrays: Any, mesh: Mesh | None) -> Any:
    """Arrays put on every device of the mesh."""
    return arrays if mesh is None else jax.device_put(arrays, NamedSharding(mesh, Spec()))


def on_one_device(arrays: Any) -> Any:
    """Arrays from the first device alone, as if there were no other."""
    first = chosen_devices()[0]
    return jax.tree.map(lambda x: jax.device_put(x, first) if isinstance(x, jax.Array) else x, arrays)
