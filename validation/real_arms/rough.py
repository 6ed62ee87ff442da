"""Real recordings against rough models: what is left where the links of the nominal model are far from the arm's.

python -m validation.real_arms.rough [--quick] [--data DIR]
"""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from validation.real_arms.layers import Case, cases
from validation.real_arms.options import parser_of
from validation.real_arms.splits import summary
from validation.real_arms.whole import whole

from lagnet.rigid_body.inertia import from_pseudo_inertia, pseudo_inertia
from lagnet.types import RobotModel

HERE = Path(__file__).resolve().parent
SETS = ("staubli_tx40", "ur10e", "panda", "ur10", "loaded_1")
SPREAD = 0.5  # standard deviation of the logarithm of each link's mass
MOVED = 0.03  # [m] standard deviation of each coordinate of each link's centre of mass
KILOGRAM, SMALL = 1.0, 1e-3  # [kg] and [kg m²] about each axis: what templates of robot files give every link
ABSENT = 0.01  # of its inertial parameters, what is left of a link that a model leaves out


def halved(robot: RobotModel, _: np.random.Generator) -> np.ndarray:
    """All links half as heavy."""
    return 0.5 * robot.inertial_parameters()


def scattered(robot: RobotModel, draw: np.random.Generator) -> np.ndarray:
    """Each link with another mass and another centre, as where bodies were guessed."""
    return np.stack([_moved(p, draw) for p in robot.inertial_parameters()])


def without_wrist(robot: RobotModel, _: np.random.Generator) -> np.ndarray:
    """The last two links all but left out."""
    parameters = robot.inertial_parameters().copy()
    parameters[-2:] *= ABSENT
    return parameters


def kilograms(robot: RobotModel, _: np.random.Generator) -> np.ndarray:
    """A kilogram at the origin of each joint."""
    return np.tile([KILOGRAM, 0, 0, 0, SMALL, 0, SMALL, 0, 0, SMALL], (robot.n_dof, 1))


def kinematics_alone(robot: RobotModel, _: np.random.Generator) -> np.ndarray:
    """No link has mass, as in files without inertials."""
    return np.zeros((robot.n_dof, 10))


KINDS = {
    "halved": halved,
    "scattered": scattered,
    "without wrist": without_wrist,
    "kilograms": kilograms,
    "kinematics alone": kinematics_alone,
}


def rough_cases(data: Path) -> dict[str, Callable[[], Case]]:
    """Each set with each kind of rough model; the recordings and their parts are those of the sets."""
    whole_sets = cases(data)

    def against(name: str, kind: str, seed: int) -> Case:
        robot, fit, held = whole_sets[name]()
        parameters = KINDS[kind](robot, np.random.default_rng(seed))
        return robot.with_inertial_parameters(parameters), fit, held

    return {
        f"{name}: {kind}": (lambda name=name, kind=kind, seed=seed: against(name, kind, seed))
        for seed, name in enumerate(SETS)
        for kind in KINDS
    }


def _moved(parameters: np.ndarray, draw: np.random.Generator) -> np.ndarray:
    """A body scaled and shifted, which stays one that matter can have."""
    scale, shift = np.exp(SPREAD * draw.standard_normal()), MOVED * draw.standard_normal(3)
    place = np.eye(4)
    place[:3, 3] = shift
    return scale * from_pseudo_inertia(place @ pseudo_inertia(parameters) @ place.T)


def main() -> int:
    """Run the study; 0 if no joint's identified layer is beyond 1.1 times least squares."""
    options = parser_of(__doc__, "one set and kind").parse_args()
    found: dict[str, Any] = {}
    for name, case in list(rough_cases(options.data).items())[: 1 if options.quick else None]:
        found[name] = whole(name.split(":")[0], case())
        print(name, json.dumps(found[name]), flush=True)
    told = summary(found)
    print(json.dumps(told, indent=1))
    if not options.quick:
        (HERE / "rough.json").write_text(json.dumps({"summary": told, "found": found}, indent=1) + "\n")
    return 1 if told["identified_beyond_1.1"] else 0


if __name__ == "__main__":
    raise SystemExit(main())
