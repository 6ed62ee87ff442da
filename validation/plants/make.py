r"""Make concealed plants: recordings in one folder, sealed truths in another, the seals' sha256 published first.

python -m validation.plants.make --seed 1 --count 20 --out out/plants \
    [--effects-per-plant 1] [--kinds a,b] [--robots ur5]
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path

import numpy as np

from validation.plants.draw import FIRST_SET, ROBOTS, draw_plant
from validation.plants.simulate import simulate_plant
from validation.plants.spec import PlantSpec


def seal(specs: Sequence[PlantSpec], out: Path) -> None:
    """Publish the sha256 of every truth before anything is simulated."""
    out.mkdir(parents=True, exist_ok=True)
    (out / "seals.sha256").write_text("".join(f"{spec.fingerprint()}  {spec.name}.json\n" for spec in specs))


def open_envelopes(specs: Sequence[PlantSpec], vault: Path) -> None:
    """Lay the truths down."""
    vault.mkdir(parents=True, exist_ok=True)
    for spec in specs:
        (vault / f"{spec.name}.json").write_bytes(spec.sealed())


def make_plant(spec: PlantSpec, out: Path) -> tuple[str, np.ndarray]:
    """Simulate one plant into `out`; its name, and what its held-out torque has beyond the nominal bodies."""
    folder = out / spec.name
    beyond = simulate_plant(spec, folder / "recordings")
    (folder / "nominal.txt").write_text(spec.robot + "\n")
    return spec.name, beyond


def make(specs: Sequence[PlantSpec], out: Path, processes: int = 1) -> dict[str, np.ndarray]:
    """Simulate plants; what the held-out torque of each has beyond the nominal bodies, by name."""
    beyond: dict[str, np.ndarray] = {}
    with ProcessPoolExecutor(processes, mp_context=get_context("spawn")) as pool:
        for name, extra in pool.map(make_plant, specs, [out] * len(specs)):
            beyond[name] = extra
            print(name, flush=True)
    return beyond


def main() -> None:
    """Parse and make."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--count", type=int, default=10)
    parser.add_argument("--first", type=int, default=0, help="number of the first plant")
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--effects-per-plant", type=int, default=1)
    parser.add_argument("--kinds", default=",".join(FIRST_SET))
    parser.add_argument("--robots", default=",".join(ROBOTS))
    parser.add_argument("--noise", type=float, default=0.01, help="of each joint's torque rms")
    parser.add_argument("--processes", type=int, default=1)
    given = parser.parse_args()
    kinds, robots = given.kinds.split(","), given.robots.split(",")
    unknown = (set(kinds) - set(FIRST_SET)) | (set(robots) - set(ROBOTS))
    if unknown:
        parser.error(f"unknown {sorted(unknown)}; kinds: {', '.join(FIRST_SET)}; robots: {', '.join(ROBOTS)}")
    numbers = range(given.first, given.first + given.count)
    specs = [draw_plant(given.seed, n, kinds, given.effects_per_plant, robots, given.noise) for n in numbers]
    seal(specs, given.out)
    vault = given.out.with_name(given.out.name + "_truth")
    open_envelopes(specs, vault)
    for name, beyond in make(specs, given.out, given.processes).items():
        np.save(vault / f"{name}_holdout.npy", beyond)


if __name__ == "__main__":
    main()
