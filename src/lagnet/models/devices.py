"""Where JAX computes: all devices of this process, or the one that was chosen."""

from __future__ import annotations

from typing import Any

import jax


def chosen_devices() -> list[Any]:
    """The device of `jax.default_device` alone where one is set, in this thread or for all, else all of this process.

    JAX itself takes a GPU where there is one and `JAX_PLATFORMS` does not say otherwise.
    """
    chosen: Any = jax.config.jax_default_device  # pyright: ignore[reportAttributeAccessIssue]
    if chosen is None:
        return jax.local_devices()
    return jax.local_devices(backend=chosen)[:1] if isinstance(chosen, str) else [chosen]
