"""The order of the study: publish the seals, simulate, diagnose blindly, publish the verdict's hash, open, score.

A plant's envelope and witness are held in memory until its verdict is hashed. A folder that was left half done goes on
where it stopped: plants whose envelope is open are finished.
"""

from __future__ import annotations

import hashlib
import json
import tempfile
import threading
from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from multiprocessing import get_context
from pathlib import Path

from validation.concealed.blind import diagnose_blind
from validation.concealed.code import fingerprint
from validation.concealed.gain import gain_shares
from validation.plants.catalogue.draw_plan import draw_plan
from validation.plants.catalogue.plan import Plan
from validation.plants.catalogue.simulate import simulate
from validation.plants.catalogue.witness import Witness

Disturbance = Callable[[Plan, Path, Witness], Witness]


class OtherPlants(ValueError):
    """The folder holds a run of other plants."""


def draw(seed: int, numbers: Sequence[int], processes: int) -> list[Plan]:
    """Plans of a seed."""
    with ProcessPoolExecutor(processes, mp_context=get_context("spawn")) as pool:
        return list(pool.map(draw_plan, [seed] * len(numbers), numbers, chunksize=8))


def publish_seals(plans: Sequence[Plan], out: Path) -> None:
    """Write the sha256 of every truth, before anything is simulated.

    Raises:
        OtherPlants: an earlier run in the folder sealed other truths under the same names.
    """
    out.mkdir(parents=True, exist_ok=True)
    listing = out / "seals.sha256"
    earlier = dict(line.split("  ")[::-1] for line in listing.read_text().splitlines()) if listing.exists() else {}
    fresh = {f"{plan.name}.json": plan.fingerprint() for plan in plans}
    if any(earlier.get(name, seal) != seal for name, seal in fresh.items()):
        raise OtherPlants(f"{out} holds a run of other plants: remove it, or give another --out")
    listing.write_text("".join(f"{seal}  {name}\n" for name, seal in sorted((earlier | fresh).items())))


class Run:
    """One run of the protocol in a folder.

    Args:
        out: the folder.
        processes: plants at a time.
        disturbed: changes the recordings in a folder before they are diagnosed, and what they then show.
    """

    def __init__(self, out: Path, processes: int, disturbed: Disturbance | None = None) -> None:
        self.out, self.processes, self._lock = out, processes, threading.Lock()
        self._disturbed = disturbed

    def conduct(self, plans: Sequence[Plan]) -> None:
        """Bring every plant that is not finished to its end."""
        (self.out / "envelopes").mkdir(parents=True, exist_ok=True)
        waiting = [plan for plan in plans if not (self.out / "envelopes" / f"{plan.name}.json").exists()]
        context = get_context("spawn")
        with (
            ProcessPoolExecutor(self.processes, mp_context=context) as simulators,
            ThreadPoolExecutor(self.processes) as threads,
        ):
            for name, words in threads.map(lambda plan: self._conduct_one(plan, simulators), waiting):
                print(name, words, flush=True)

    def _conduct_one(self, plan: Plan, simulators: ProcessPoolExecutor) -> tuple[str, str]:
        with tempfile.TemporaryDirectory() as folder:
            try:
                witness, truth = simulators.submit(simulate, plan, Path(folder)).result()
            except Exception as error:
                self._put(plan, "failures", f"not simulated: {error}".encode(), ".txt")
                return plan.name, f"was not simulated: {error}"
            if self._disturbed is not None:
                witness = self._disturbed(plan, Path(folder), witness)
            self._publish("witnesses.sha256", witness.to_json(), f"{plan.name}.json")
            code = fingerprint()
            blind = diagnose_blind(Path(folder), plan.recordings, plan.robot)
        self._publish("verdicts.sha256", blind.verdict, f"verdicts/{plan.name}.json")
        if blind.verdict:
            self._put(plan, "verdicts", blind.verdict)
        judged = blind.verdict and plan.hidden
        shares = gain_shares(plan, blind.torques, truth) if judged else (None, None)
        self._open(
            plan,
            witness,
            {
                "seconds": blind.seconds,
                "processor_seconds": blind.processor_seconds,
                "message": blind.message,
                "code": code,
                "gain_share": shares[0],
                "gain_share_with_rest": shares[1],
            },
        )
        return plan.name, f"{blind.processor_seconds:.1f} s {blind.message}"

    def _open(self, plan: Plan, witness: Witness, outcome: dict) -> None:
        self._put(plan, "witnesses", witness.to_json())
        self._put(plan, "outcomes", json.dumps(outcome).encode())
        self._put(plan, "envelopes", plan.sealed())  # last: it marks the plant as finished

    def _put(self, plan: Plan, kind: str, content: bytes, suffix: str = ".json") -> None:
        folder = self.out / kind
        folder.mkdir(parents=True, exist_ok=True)
        (folder / f"{plan.name}{suffix}").write_bytes(content)

    def _publish(self, listing: str, content: bytes, name: str) -> None:
        """One line, once for each name: a plant that was stopped between its hash and its end is done anew."""
        line = f"{hashlib.sha256(content).hexdigest() if content else 'failed'}  {name}\n"
        with self._lock:
            file = self.out / listing
            kept = file.read_text().splitlines(keepends=True) if file.exists() else []
            file.write_text("".join([*(k for k in kept if not k.endswith(f"  {name}\n")), line]))
