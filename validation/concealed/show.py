"""Make one plant again, diagnose it, and lay truth and verdict side by side.

python -m validation.concealed.show SEED NUMBER [--keep DIR]
"""

from __future__ import annotations

import argparse
import json
import tempfile
from pathlib import Path

from validation.concealed.blind import diagnose_blind
from validation.concealed.gain import gain_shares
from validation.concealed.scoring import score
from validation.plants.catalogue.draw_plan import draw_plan
from validation.plants.catalogue.simulate import simulate


def show(seed: int, number: int, folder: Path) -> None:
    """Print what is hidden, what the recordings can show of it, and what is claimed."""
    plan = draw_plan(seed, number)
    print(plan.name, plan.group, plan.robot, plan.controller, plan.engine, f"noise {plan.noise:.4f}", *plan.shapes)
    witness, truth = simulate(plan, folder)
    for hidden, sight in zip(plan.hidden, witness.sights, strict=True):
        print(f"hidden  {hidden.effect} @ {hidden.joint} {hidden.values}")
        print(
            f"        {sight.share:.3f} of the torque, {sight.over_noise:.1f} times the noise, same as {sight.same_as}"
        )
    blind = diagnose_blind(folder, plan.recordings, plan.robot)
    if not blind.verdict:
        print("no verdict:", blind.message)
        return
    verdict = json.loads(blind.verdict)
    shares = gain_shares(plan, blind.torques, truth) if plan.hidden else (None, None)
    outcome = {
        "seconds": blind.seconds,
        "processor_seconds": blind.processor_seconds,
        "message": "",
        "gain_share": shares[0],
        "gain_share_with_rest": shares[1],
    }
    found = score(plan, witness, verdict, outcome)
    for effect, (*_, judged) in zip(verdict["effects"], found.claims, strict=True):
        values = {p["name"]: float(f"{p['value']:.5g}") for p in effect["parameters"]}
        print(f"{judged:7} {effect['effect']} @ {effect['joint']} tied {effect['tied_with']} {values}")
    print(
        "errors", {k: round(e, 4) for k, e in found.errors.items()}, "gain", shares, f"{blind.processor_seconds:.1f} s"
    )


def main() -> None:
    """Parse and show."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("seed", type=int)
    parser.add_argument("number", type=int)
    parser.add_argument("--keep", type=Path, default=None, help="folder for the recordings")
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as empty:
        show(given.seed, given.number, given.keep or Path(empty))


if __name__ == "__main__":
    main()
