r"""Make concealed plants: recordings in one folder, sealed truths in another, the seals' sha256 published first.

python -m validation.plants.make --seed 1 --count 20 --out out/plants \
    [--effects-per-plant 1] [--kinds a,b] [--robots ur5]
"""

from __future__ import annotations

import argparse
from pathlib import Path

from validation.plants.draw import FIRST_SET, ROBOTS, draw_plant
from validation.plants.simulate import simulate_plant
from validation.plants.spec import PlantSpec


def seal(specs: list[PlantSpec], out: Path) -> Path:
    """Write every truth beside `out`, and the list of their sha256 inside it, before anything is simulated."""
    vault = out.with_name(out.name + "_truth")
    for folder in (out, vault):
        folder.mkdir(parents=True, exist_ok=True)
    for spec in specs:
        (vault / f"{spec.name}.json").write_bytes(spec.sealed())
    (out / "seals.sha256").write_text("".join(f"{spec.fingerprint()}  {spec.name}.json\n" for spec in specs))
    return vault


def make(specs: list[PlantSpec], out: Path) -> None:
    """Seal, then simulate."""
    seal(specs, out)
    for spec in specs:
        folder = out / spec.name
        simulate_plant(spec, folder / "recordings")
        (folder / "nominal.txt").write_text(spec.robot + "\n")
        print(spec.name, flush=True)


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
    given = parser.parse_args()
    kinds, robots = given.kinds.split(","), given.robots.split(",")
    unknown = (set(kinds) - set(FIRST_SET)) | (set(robots) - set(ROBOTS))
    if unknown:
        parser.error(f"unknown {sorted(unknown)}; kinds: {', '.join(FIRST_SET)}; robots: {', '.join(ROBOTS)}")
    numbers = range(given.first, given.first + given.count)
    make([draw_plant(given.seed, n, kinds, given.effects_per_plant, robots, given.noise) for n in numbers], given.out)


if __name__ == "__main__":
    main()
