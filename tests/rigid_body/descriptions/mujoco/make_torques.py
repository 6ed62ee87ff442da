"""Makes torques.json: inverse dynamics of arm.xml by MuJoCo itself (pip install mujoco), without damping and limits."""

import json
from pathlib import Path

import mujoco
import numpy as np

HERE = Path(__file__).parent
TURNS = [
    'euler="40 -50 60"',
    'axisangle="1 2 3 50"',
    'xyaxes="1 1 0 -1 1 1"',
    'zaxis="1 2 -3"',
    'quat=".1 .2 .3 .4"',
    "",
]
SEQUENCES = ["xyz", "ZYX", "zxz"]


def torques(text: str, motion: np.ndarray) -> list[list[float]]:
    """Torque of each sample of motion (3, n, dof)."""
    model = mujoco.MjModel.from_xml_string(text)
    model.dof_damping[:] = 0
    model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_CONSTRAINT
    data, rows = mujoco.MjData(model), []
    for q, v, a in zip(*motion, strict=True):
        data.qpos[:], data.qvel[:], data.qacc[:] = q, v, a
        mujoco.mj_inverse(model, data)
        rows.append(data.qfrc_inverse.tolist())
    return rows


def main() -> None:
    """Writes the file beside this one."""
    motion, text = np.random.default_rng(0).normal(size=(3, 4, 3)), (HERE / "arm.xml").read_text()
    cases = [
        {"turn": turn, "sequence": sequence, "tau": torques(text.format(turn=turn, sequence=sequence), motion)}
        for turn in TURNS
        for sequence in SEQUENCES
    ]
    q, v, a = motion.tolist()
    content = {"mujoco": mujoco.__version__, "q": q, "v": v, "a": a, "cases": cases}
    (HERE / "torques.json").write_text(json.dumps(content, indent=1) + "\n")


if __name__ == "__main__":
    main()
