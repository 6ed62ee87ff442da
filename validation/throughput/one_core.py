"""Both formulations of a step on one core, in processor time: what else the machine does then hardly counts."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import time
from collections.abc import Callable
from typing import Any

ROUNDS, CALLS = 40, 5  # the least of so many means over so many calls


def measured(kind: str) -> dict[str, float]:
    """Processor seconds of a step by both formulations, in a process of its own that may use one core alone."""
    alone = {**os.environ, "XLA_FLAGS": "--xla_cpu_multi_thread_eigen=false"}
    command = [sys.executable, "-m", "validation.throughput.one_core", kind]
    done = subprocess.run(command, env=alone, capture_output=True, text=True, check=True)
    return json.loads(done.stdout)


def main() -> None:
    """Print the seconds and their ratio as JSON."""
    os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})
    from validation.throughput.study import step_calls

    seconds = [least(call) for call in step_calls(sys.argv[1])]
    print(json.dumps({"ours": seconds[0], "hessian": seconds[1], "ratio": seconds[1] / seconds[0]}))


def least(call: Callable[[], Any]) -> float:
    """Least processor time of a call [s]."""
    import jax

    def once() -> float:
        began = time.process_time()
        for _ in range(CALLS):
            jax.block_until_ready(call())
        return (time.process_time() - began) / CALLS

    jax.block_until_ready(call())
    return min(once() for _ in range(ROUNDS))


if __name__ == "__main__":
    main()
