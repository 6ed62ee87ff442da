"""Both formulations of a step as training takes it: in a compiled loop, each batch spread over the cores."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Callable
from typing import Any

STEPS = 20  # in one compiled loop
RATE = 1e-9  # so that weights hardly move


def measured(kind: str, repeats: int) -> dict[str, Any]:
    """Seconds of a step by both formulations and their ratio, in a process that sees each core as a device."""
    kept = {k: v for k, v in os.environ.items() if k not in ("JAX_NUM_CPU_DEVICES", "XLA_FLAGS")}
    command = [sys.executable, "-m", "validation.throughput.in_training", kind, str(repeats)]
    done = subprocess.run(command, env=kept, capture_output=True, text=True, check=True)
    return json.loads(done.stdout)


def main() -> None:
    """Print the seconds of a step and the median ratio of pairs as JSON."""
    from lagnet.training.cores import let_jax_see_cores, parts_of

    let_jax_see_cores()
    from validation.throughput.study import BATCH, paired_times

    found = paired_times(*loops(sys.argv[1]), int(sys.argv[2]))
    seconds = {name: found[name] / STEPS for name in ("ours", "hessian")}
    print(json.dumps(found | seconds | {"devices": parts_of(BATCH)}))


def loops(kind: str) -> tuple[Callable[[], Any], Callable[[], Any]]:
    """STEPS steps of plain descent on one batch, by ours and by the usual formulation."""
    import equinox as eqx
    import jax
    import jax.numpy as jnp

    from lagnet.training.cores import everywhere, mesh_for, spread
    from validation.throughput.study import BATCH, both_forms, one_batch, torque_error

    arm, rest, torques = both_forms(kind)
    mesh = mesh_for(BATCH)
    data, rows = everywhere(one_batch(), mesh), jnp.arange(BATCH)

    def loop(torque: Callable[..., Any]) -> Callable[[], Any]:
        def loss(arm: Any, data: Any, rows: Any, _: Any) -> jax.Array:
            return torque_error(eqx.combine(arm, rest), torque, tuple(x[rows] for x in data))

        gradient = spread(jax.value_and_grad(loss), mesh)

        def step(arm: Any, _: None) -> tuple[Any, None]:
            return jax.tree.map(lambda p, d: p - RATE * d, arm, gradient(arm, data, rows, jnp.zeros(()))[1]), None

        compiled = jax.jit(lambda arm: jax.lax.scan(step, arm, None, length=STEPS)[0])
        return lambda: compiled(arm)

    return loop(torques[0]), loop(torques[1])


if __name__ == "__main__":
    main()
