"""The kinds of learned model by name: what settings each takes and how one is drawn.

A new kind is a file with a settings dataclass and a maker, and one line in KINDS; saving, training, the command line
and the conformance tests then know it.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import jax
from jaxtyping import Array

from lagnet.errors import ModelError, closest
from lagnet.models.dynamics import AbstractDynamics
from lagnet.models.features import JointFeatures
from lagnet.models.lagrangians.black_box_lagrangian import BlackBoxSettings, make_black_box
from lagnet.models.lagrangians.conservative import Conservative, FreeLagrangian
from lagnet.models.lagrangians.delan import DelanSettings, make_delan
from lagnet.models.lagrangians.perceptron_delan import PerceptronDelanSettings, make_perceptron_delan
from lagnet.models.residuals.augmented import PARITIES, Augmented
from lagnet.models.residuals.body_drag import BodyDragSettings, make_dragged
from lagnet.models.residuals.dissipation import DissipationSettings, make_dissipation
from lagnet.models.residuals.feed_forward import FeedForward
from lagnet.models.residuals.torque_network import TorqueNetworkSettings, make_torque_network, silenced
from lagnet.models.scales import Scales
from lagnet.models.serial_chain.dynamics import make_serial_chain
from lagnet.models.serial_chain.settings import SerialChainSettings

OWN_MOTION = 'form="dissipation" has a motion of its own and goes with all mechanics'


@dataclass(frozen=True)
class AugmentedSettings:
    """What carries H, c and g, and the network that carries ε.

    Args:
        mechanics: name of the kind under ε; mechanics_settings: its settings, None for its defaults.
        form: what is behind ε: "perceptron" of (q, v, a), or what takes energy out and is odd in v: "dissipation", or
            "body-drag" on the bodies of a `delan`, which is trained together with it (`separation="joint"`).
        residual: settings of that form, None for its defaults.
        parity: "odd" keeps only what changes sign with the velocity, which mechanics can never be; "any" keeps all of
            it, which can also be conservative torque and must be held back by the penalty λ.
    """

    mechanics: str = "delan"
    mechanics_settings: Any = None
    residual: Any = None
    parity: str = "any"
    form: str = "perceptron"

    def __post_init__(self) -> None:
        if self.parity not in PARITIES:
            raise ModelError(f"parity {self.parity!r} is unknown", choices=PARITIES)
        if self.form not in RESIDUALS:
            raise ModelError(f"form {self.form!r} is unknown", choices=RESIDUALS)
        if self.residual is None:
            object.__setattr__(self, "residual", RESIDUALS[self.form][0]())
        if self.form == "body-drag" and self.mechanics != "delan":
            raise ModelError(f"body-drag acts on the bodies of delan, not of {self.mechanics}", next_step=OWN_MOTION)
        if self.mechanics_settings is None:
            object.__setattr__(self, "mechanics_settings", settings_class(self.mechanics)())


@dataclass(frozen=True)
class ModelSpec:
    """All that a model is, but for its weights.

    Args:
        kind: name in KINDS.
        settings: the settings dataclass of the kind.
        joints: joint names in model order.
        features: how positions enter, fitted to the training data; scales: sizes of motion and torque in it.
    """

    kind: str
    settings: Any
    joints: tuple[str, ...]
    features: JointFeatures
    scales: Scales

    @property
    def joint_types(self) -> tuple[str, ...]:
        """'continuous', 'revolute' or 'prismatic' for each joint."""
        return self.features.joint_types


def _make_augmented(key: Array, features: JointFeatures, scales: Scales, settings: AugmentedSettings) -> Augmented:
    """Mechanics start as they would without ε, so that with an ε that stays silent they also end there."""
    mechanics = _entry(settings.mechanics)[1](key, features, scales, settings.mechanics_settings)
    own = jax.random.fold_in(key, 1), features, scales, settings.residual
    return RESIDUALS[settings.form][1](mechanics, settings.parity, *own)


def _beside(make: Callable[..., Any]) -> Callable[..., Augmented]:
    """Mechanics with an ε that does not look at them."""
    return lambda mechanics, parity, *own: Augmented(mechanics, make(*own), parity)


RESIDUALS: dict[str, tuple[type, Callable[..., Augmented]]] = {
    "perceptron": (TorqueNetworkSettings, _beside(lambda *own: silenced(make_torque_network(*own)))),
    "dissipation": (DissipationSettings, _beside(make_dissipation)),
    "body-drag": (BodyDragSettings, make_dragged),
}

KINDS: dict[str, tuple[type, Callable[..., AbstractDynamics]]] = {
    "delan": (DelanSettings, lambda *given: Conservative(make_delan(*given))),
    "delan-perceptron": (PerceptronDelanSettings, lambda *given: Conservative(make_perceptron_delan(*given))),
    "delan-blackbox": (BlackBoxSettings, lambda *given: FreeLagrangian(make_black_box(*given))),
    "ffnn": (TorqueNetworkSettings, lambda *given: FeedForward(make_torque_network(*given))),
    "delan-ffnn": (AugmentedSettings, _make_augmented),
    "serial-chain": (SerialChainSettings, make_serial_chain),
}


def settings_class(kind: str) -> type:
    """The settings dataclass of a kind.

    Raises:
        ModelError: no such kind.
    """
    return _entry(kind)[0]


def draw(spec: ModelSpec, key: Array) -> AbstractDynamics:
    """An untrained model with random weights."""
    return _entry(spec.kind)[1](key, spec.features, spec.scales, spec.settings)


def settings_from(kind: str, given: Mapping[str, Any]) -> Any:
    """Settings of a kind from plain values, as they come from a file.

    Raises:
        ModelError: an unknown setting, or a value that the kind refuses.
    """
    return _made(settings_class(kind), given, kind)


def _made(cls: type, given: Mapping[str, Any], kind: str) -> Any:
    names = [f.name for f in dataclasses.fields(cls)]
    for name in given:
        if name not in names:
            hint = closest(name, names)
            raise ModelError(
                f"{kind} has no setting {name!r}", choices=names, next_step=f"did you mean {hint}?" if hint else None
            )
    values = {name: tuple(value) if isinstance(value, list) else value for name, value in given.items()}
    if cls is AugmentedSettings:
        values = _nested(values)
    makers: dict[str, Any] = {f.name: f.default_factory for f in dataclasses.fields(cls)}
    try:
        for name, value in values.items():
            if isinstance(value, Mapping) and dataclasses.is_dataclass(makers[name]):  # plain, as in files
                values[name] = makers[name](**value)
        return cls(**values)
    except (TypeError, ValueError) as error:
        raise ModelError(f"settings of {kind} are not usable: {error}") from None


def _nested(values: dict[str, Any]) -> dict[str, Any]:
    below = values.get("mechanics", "delan")
    if isinstance(values.get("mechanics_settings"), Mapping):
        values["mechanics_settings"] = settings_from(below, values["mechanics_settings"])
    if isinstance(values.get("residual"), Mapping):
        cls = RESIDUALS.get(values.get("form", "perceptron"), RESIDUALS["perceptron"])[0]
        values["residual"] = _made(cls, values["residual"], "residual")
    return values


def _entry(kind: str) -> tuple[type, Callable[..., AbstractDynamics]]:
    if kind not in KINDS:
        hint = closest(kind, KINDS)
        raise ModelError(
            f"model {kind!r} is unknown", choices=KINDS, next_step=f"did you mean {hint}?" if hint else None
        )
    return KINDS[kind]
