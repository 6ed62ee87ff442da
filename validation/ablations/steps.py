"""What does each step of search and estimation buy? Fresh plants, with one step taken out at a time; no rule, no limit.

python -m validation.ablations.steps [--quick] [--plants 12 6] [--report] [--data DIR] [--out out/ablations_steps]
A run that is stopped goes on with the same command; --report writes the result of what is finished.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path

from validation.ablations.plan import OF_STEPS, SIMULATED, TEXTURED, Source, Stage
from validation.ablations.report import CODE, Finished, rows_of
from validation.ablations.study import conduct, folder_of
from validation.real_arms.options import parser_of

HERE = Path(__file__).resolve().parent
SEEDS = {SIMULATED: 61, TEXTURED: 62}
STEPS = (Stage(OF_STEPS, lambda s: range(s.all)),)


def told(sources: tuple[Source, ...], out: Path) -> dict:
    """What each step buys on the plants that are finished."""
    finished = {
        s.kind: Finished({n: folder_of(out, s, n) for n in range(s.all)}, out / "plants" / s.kind / f"seed_{s.seed}")
        for s in sources
    }
    rows = rows_of(finished, OF_STEPS)
    for row in rows:
        for kind, gain in row.kinds.items():
            print(f"{row.name[:60]:60s} {kind:9s} {gain.line()}")
    return {
        "code": CODE,
        "seeds": SEEDS,
        "plants": {kind: len(one.whole) for kind, one in finished.items()},
        "steps": {row.name.replace(" ", "_"): row.told() for row in rows},
        "steps_that_buy_nothing": [row.name for row in rows if not row.earns],
    }


def main() -> int:
    """Run the study and write its result."""
    parser = parser_of(__doc__, "one plant")
    parser.add_argument("--plants", default=(12, 6), type=int, nargs=2, help="of the simulated and the textured kind")
    parser.add_argument("--report", action="store_true", help="run nothing, write the result of what is finished")
    parser.add_argument("--out", type=Path, default=Path("out") / "ablations_steps")
    given = parser.parse_args()
    counts = (1, 0) if given.quick else given.plants
    sources = tuple(Source(k, SEEDS[k], n, n) for k, n in zip(SEEDS, counts, strict=True) if n)
    given.out.mkdir(parents=True, exist_ok=True)
    if not given.report:
        conduct(sources, STEPS, given.out, given.data)
    result = told(sources, given.out)
    if not given.quick:
        (HERE / "steps.json").write_text(json.dumps(result, indent=1) + "\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
