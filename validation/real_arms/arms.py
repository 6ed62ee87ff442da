"""The three real arms: their files, and the lines that a diagnosis of them must pass."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

FRICTION = ("viscous_friction", "coulomb_friction", "asymmetric_friction", "stribeck_friction", "quadratic_drag")
DRY = (
    "coulomb_friction",
    "asymmetric_friction",
    "stribeck_friction",
    "load_dependent_friction",
    "presliding_hysteresis",
)
WRIST_NAMES = (*FRICTION, "rotor_inertia", "torque_offset", "coupled_transmission")  # what the wrist has
UR10E_BOUNDS = (0.010, 0.005, 0.003, 0.014, 0.05, 0.025)
TX40_MEAN = 0.035
EMPS_PRINTED = {
    ("viscous_friction", "Fv"): 203.5,
    ("coulomb_friction", "Fc"): 20.4,
    ("torque_offset", "b"): -3.16,
}
EMPS_MASS = 95.0  # [kg]


@dataclass(frozen=True)
class Line:
    """One pass line: what was asked, what was found, whether it holds."""

    claim: str
    found: Any
    passed: bool


@dataclass(frozen=True)
class Arm:
    """A real arm.

    Args:
        name: of the case.
        urdf: nominal model in it.
        fit, holdout: recordings in it; no held-out one: the last fifth of each fitted one.
        torque_constant: [N m/A], where currents were recorded.
        folder: of the data set.
        judge: pass lines from a verdict and the nMSE of each joint.
    """

    name: str
    folder: str
    urdf: str
    fit: tuple[str, ...]
    holdout: tuple[str, ...]
    judge: Callable[[dict[str, Any], Sequence[float]], list[Line]]
    torque_constant: tuple[float, ...] | None = None


def named_at(verdict: dict[str, Any], joint: str) -> list[str]:
    """Names of the effects at a joint."""
    return [e["effect"] for e in verdict["effects"] if e["joint"] == joint]


def parameter(verdict: dict[str, Any], effect: str, name: str) -> float | None:
    """The value of a parameter of the first effect of that name."""
    for entry in verdict["effects"]:
        if entry["effect"] == effect:
            return next(p["value"] for p in entry["parameters"] if p["name"] == name)
    return None


def judge_ur10e(verdict: dict[str, Any], nmse: Sequence[float]) -> list[Line]:
    """Friction everywhere, no payload, and a fit near that of plain least squares over all parameters."""
    joints = verdict["nominal"]["joints"]
    viscous = [j for j in joints if "viscous_friction" not in named_at(verdict, j)]
    dry = [j for j in joints if not set(DRY) & set(named_at(verdict, j))]
    mass = parameter(verdict, "payload", "m")
    return [
        Line("viscous friction named on all joints", {"without": viscous}, not viscous),
        Line("Coulomb friction, or a law that contains it, named on all joints", {"without": dry}, not dry),
        Line("no payload claimed, or |m| < 0.15 kg", {"m": mass}, mass is None or abs(mass) < 0.15),
        *(
            Line(f"nMSE of {j} at most {bound}", round(x, 5), x <= bound)
            for j, x, bound in zip(joints, nmse, UR10E_BOUNDS, strict=True)
        ),
    ]


def judge_tx40(verdict: dict[str, Any], nmse: Sequence[float]) -> list[Line]:
    """Friction and rotors per joint, and a wrist whose coupling is called unexplained."""
    joints = verdict["nominal"]["joints"]
    no_friction = [j for j in joints if not set(FRICTION) & set(named_at(verdict, j))]
    no_rotor = [j for j in joints if "rotor_inertia" not in named_at(verdict, j)]
    mean = sum(nmse) / len(nmse)
    wrist = [u for u in verdict["unexplained"] if u["joint"] in joints[4:]]
    other = {j: sorted(set(named_at(verdict, j)) - set(WRIST_NAMES)) for j in joints[4:]}
    return [
        Line("friction named on every joint", {"without": no_friction}, not no_friction),
        Line("rotor inertia named on every joint", {"without": no_rotor}, not no_rotor),
        Line(f"mean nMSE at most {TX40_MEAN}", round(mean, 5), mean <= TX40_MEAN),
        Line(
            "the coupled wrist is above noise and predicted by signals",
            {u["joint"]: u["depends_on"] for u in wrist},
            all(u["above_noise"] and u["depends_on"] for u in wrist),
        ),
        Line("no name for the wrist's coupling that is not it", other, not any(other.values())),
    ]


def judge_emps(verdict: dict[str, Any], nmse: Sequence[float]) -> list[Line]:
    """Printed friction parameters, and a mass that is right."""
    lines = []
    for (effect, name), printed in EMPS_PRINTED.items():
        value = parameter(verdict, effect, name)
        near = value is not None and abs(value - printed) <= 0.03 * abs(printed)
        lines.append(Line(f"{effect} {name} within 3 % of {printed}", value, near))
    masses = [parameter(verdict, *k) for k in (("rotor_inertia", "Ia"), ("payload", "m"), ("link_inertia", "dm"))]
    wrong = [m for m in masses if m is not None and abs(m) > 0.01 * EMPS_MASS]
    return [*lines, Line("no error of mass beyond 1 % of 95 kg", wrong, not wrong)]


UR10E = Arm(
    name="ur10e",
    folder="ur10e",
    urdf="ur10e.urdf",
    fit=("fit_0.csv.gz", "fit_1.csv.gz", "fit_2.csv.gz", "fit_3.csv.gz"),
    holdout=("holdout.csv.gz",),
    judge=judge_ur10e,
    torque_constant=(14.87, 13.26, 11.13, 10.62, 11.03, 11.47),
)
TX40 = Arm("staubli_tx40", "staubli_tx40", "tx40.urdf", ("fit.csv.gz",), ("holdout.csv.gz",), judge_tx40)
EMPS = Arm("emps", "emps", "emps.urdf", ("fit.csv.gz",), ("holdout.csv.gz",), judge_emps)
EMPS_WHOLE = Arm("emps_whole", "emps", "emps.urdf", ("fit.csv.gz", "holdout.csv.gz"), (), judge_emps)
