"""Ten thousand broken inputs: files of every kind, mutated by a seed.

python -m validation.fuzz.study            # writes result.json
python -m validation.fuzz.study --quick    # 500 inputs, writes nothing
"""

from __future__ import annotations

import argparse
import resource
from dataclasses import asdict
from pathlib import Path

from lagnet.files import finite_json, write_whole
from validation.fuzz.run import Tally, fuzz

INPUTS, QUICK, SEED = 10_000, 500, 4


def main() -> None:
    """Runs the study."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true")
    quick = parser.parse_args().quick
    found: Tally = fuzz(QUICK if quick else INPUTS, SEED)
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024**2
    print(f"{found.inputs} inputs, {found.accepted} accepted, {found.refused} refused, {len(found.faults)} faults")
    for fault in found.faults:
        print(fault)
    if not quick:
        result = {"figures": asdict(found) | {"seed": SEED, "largest_memory_gib": memory}}
        write_whole(Path(__file__).with_name("result.json"), finite_json(result))


if __name__ == "__main__":
    main()
