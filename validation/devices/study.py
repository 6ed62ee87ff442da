"""Training and batched parts on every device that JAX sees, each platform in a process of its own. See README.md.

python -m validation.devices.study [--quick] [--out FOLDER]
A platform whose figures stand in the folder is not measured again.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

import numpy as np

from validation.devices.motion import MOTION, write_motion

HERE = Path(__file__).resolve().parent
PLATFORMS = ("cpu", "cuda")
ASK = "import jax; print(jax.devices()[0].device_kind)"
ABSENT = "JAX sees no device of this platform here: not measured"
DOUBLE, SINGLE, TRAINING, BATCHED = 1e-9, 1e-4, 3.0, 10.0


def is_there(platform: str) -> bool:
    """Whether JAX sees a device of a platform, asked of another process."""
    asked = subprocess.run([sys.executable, "-c", ASK], env=_environment(platform), capture_output=True, check=False)
    return asked.returncode == 0


def measure(platform: str, folder: Path, quick: bool) -> dict[str, Any]:
    """The figures of a platform, kept in the folder.

    Raises:
        subprocess.CalledProcessError: something does not run there.
    """
    kept = folder / f"{platform}.json"
    if not kept.exists():
        words = [sys.executable, "-m", "validation.devices.measured", str(folder), *(["--quick"] if quick else [])]
        done = subprocess.run(words, env=_environment(platform), stdout=subprocess.PIPE, text=True, check=True)
        kept.write_text(done.stdout.splitlines()[-1], encoding="utf-8")
    return json.loads(kept.read_text(encoding="utf-8").splitlines()[-1])


def _environment(platform: str) -> dict[str, str]:
    return os.environ | {"JAX_PLATFORMS": platform}


def judged(found: dict[str, dict[str, Any]]) -> list[dict[str, Any]]:
    """Pass lines; those of CUDA are not measured where there is none."""
    lines = [("every model trains and every part runs on every device that is there", sorted(found), True)]
    claims = (
        (f"CUDA: torque of the same weights in double precision within {DOUBLE:g}", DOUBLE, "double"),
        (f"CUDA: torque of the same weights in single precision within {SINGLE:g}", SINGLE, "single"),
        (f"CUDA: training in batches of 4096 ≥ {TRAINING:g} ×, least of the models", TRAINING, "training"),
        (f"CUDA: batched inverse dynamics in single precision ≥ {BATCHED:g} ×", BATCHED, "batched"),
    )
    for claim, limit, what in claims:
        if "cuda" not in found:
            lines.append((claim, None, None))
            continue
        value = compared(found, what)
        lines.append((claim, value, value <= limit if what in ("double", "single") else value >= limit))
    return [{"claim": c, "found": f, "passed": p} for c, f, p in lines]


def compared(found: dict[str, dict[str, Any]], what: str) -> float:
    """CUDA against the processor: a difference of torques over their size, or a ratio of samples a second."""
    cpu, cuda = found["cpu"], found["cuda"]
    if what in ("double", "single"):
        one, other = (np.array(f["torques"][what]) for f in (cpu, cuda))
        return float(np.max(np.abs(one - other)) / np.max(np.abs(one)))
    if what == "batched":
        return _rate(cuda) / _rate(cpu)
    batch = max(cpu["training"]["delan"], key=int)
    pairs = [(f["training"][kind][batch]["samples_per_second"]) for kind in cpu["training"] for f in (cuda, cpu)]
    return float(min(np.array(pairs[::2]) / np.array(pairs[1::2])))


def _rate(found: dict[str, Any]) -> float:
    return found["batched"]["single"]["inverse_dynamics"]["per_second"]


def main() -> int:
    """Measure, judge and, but with --quick, write result.json; 1 where a line that was measured is missed."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true", help="small sizes; nothing is written")
    parser.add_argument("--out", type=Path, default=None, help="folder of figures; one that is forgotten, if not given")
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as forgotten:
        folder = given.out or Path(forgotten)
        if not (folder / MOTION).exists():
            write_motion(folder / MOTION)
        there = [p for p in PLATFORMS if (folder / f"{p}.json").exists() or is_there(p)]
        found = {p: measure(p, folder, given.quick) for p in there}
    lines = judged(found)
    devices = {p: {k: v for k, v in found[p].items() if k != "torques"} if p in found else ABSENT for p in PLATFORMS}
    result = {"study": "devices", "cores": found["cpu"]["cores"], "cuda_measured": "cuda" in found, "devices": devices}
    text = json.dumps({**result, "lines": lines}, indent=1, ensure_ascii=False) + "\n"
    print(text)
    if not given.quick:
        (HERE / "result.json").write_text(text, encoding="utf-8")
    return int(any(line["passed"] is False for line in lines))


if __name__ == "__main__":
    raise SystemExit(main())
