"""Further functions are taken where held-out blocks are predicted better with them, and where nothing is, nothing."""

from __future__ import annotations

import numpy as np
import pytest

from lagnet.diagnosis.identified.design import Design, Group, JointRows
from lagnet.diagnosis.identified.dictionary import GAIN, PATH
from lagnet.diagnosis.identified.folds import Choice, block_folds, choose

BODIES, N, NOISE = 4, 600, 0.3
OWN, FURTHER = 2, 3
WIDTH = OWN + FURTHER


def made(further: float, coupled: float = 0.0, bodies: float = 1.0, name: str = "waves") -> Design:
    """Two joints with bodies, functions of their own, optional ones, and a tie of the first to the second.

    Args:
        further: weights of the optional functions of the first joint; those of the second have none.
        coupled: weight of the tie.
        bodies: weight of everything else.
        name: of the optional functions.
    """
    rng, joints = np.random.default_rng(3), []
    tie = BODIES + 2 * WIDTH
    for j in range(2):
        own = BODIES + WIDTH * j + np.arange(WIDTH)
        unknowns = np.concatenate([np.arange(BODIES), own, [tie]])
        x = np.concatenate([np.full(BODIES + OWN, bodies), np.full(FURTHER, further * (j == 0)), [coupled]])
        columns = rng.standard_normal((N, unknowns.size))
        joints.append(JointRows(columns, columns @ x + NOISE * rng.standard_normal(N), np.ones(N, bool), unknowns))
    groups = [Group("bodies", np.arange(BODIES), False)]
    for j in range(2):
        first = BODIES + WIDTH * j
        groups.append(Group("own", first + np.arange(OWN), free=True, joint=j))
        groups.append(Group(name, first + OWN + np.arange(FURTHER), False, joint=j, optional=True))
    groups.append(Group("tie", np.array([tie]), False, pair=(0, 1), optional=True))
    return Design(tuple(joints), tuple(groups), (), BODIES, np.ones(tie + 1), np.zeros(N, dtype=int))


def chosen(*args: float, **more) -> Choice:
    found = choose(made(*args, **more))
    assert found is not None
    return found


@pytest.mark.parametrize(
    ("further", "coupled", "name", "excluded"),
    [
        pytest.param(1.0, 0.0, "waves", {4, 5}, id="of the joint that has them"),
        pytest.param(0.0, 1.0, "waves", {2, 4}, id="a tie"),
        pytest.param(0.0, 0.0, "waves", {2, 4, 5}, id="none"),
        pytest.param(0.12, 0.0, "waves", {4, 5}, id="a third of what is left"),
        pytest.param(0.12, 0.0, PATH, {2, 4, 5}, id="a third of what is left, friction along the path"),
        pytest.param(1.0, 0.0, GAIN, {4, 5}, id="a scale of one joint"),
    ],
)
def test_what_predicts_unseen_blocks_is_taken(further, coupled, name, excluded) -> None:
    found = chosen(further, coupled, name=name)
    assert found.excluded == excluded
    power = [np.mean(j.target**2) for j in made(further, coupled).joints]
    left = np.array([NOISE**2 + FURTHER * further**2 * (2 in found.excluded), NOISE**2])
    assert found.nmse == pytest.approx(left / np.array(power), rel=0.15)


def test_scales_of_all_joints_are_never_free() -> None:
    """Every joint's torque would be predicted far better with a scale: one of them stays that of the others."""
    design = made(1.0, name=GAIN)
    second = design.joints[1]
    second.target[:] += second.columns[:, BODIES + OWN : BODIES + WIDTH].sum(axis=1)
    found = choose(design)
    assert found is not None
    assert len(found.excluded & {2, 4}) == 1


def test_where_no_joint_is_predicted_nothing_is() -> None:
    assert choose(made(0.0, bodies=0.0)) is None


def test_folds_hold_every_row_out_once_and_leave_a_guard_around_it() -> None:
    design = made(1.0)
    folds = block_folds(design)
    assert sum(f.held_out[0].n_samples for f in folds) == N
    assert all(f.fitted[0].n_samples + f.held_out[0].n_samples < N for f in folds)
    power = sum(float(f.held_out[1].power) for f in folds)
    assert power == pytest.approx(float(design.joints[1].target @ design.joints[1].target))
