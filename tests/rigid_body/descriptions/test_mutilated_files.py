"""Files mangled at random are read or refused in one line; never a crash, never torques that are not numbers."""

from __future__ import annotations

import random
import re

import numpy as np
import pytest

from lagnet.errors import RobotError
from lagnet.rigid_body.random_arm import random_arm
from lagnet.rigid_body.robot import load_description

JUNK = ["nan", "1e999", "-1", "", "0", "abc", "1 2", "1 2 3 4", "0 0 0", "1e308", "../x", "A" * 5000, "free", "ball"]
JUNK += ["base", "link_0", "joint_0", "world", "universe", "floating", "true", "%s%n", "é"]
MANGLED = 250


def mangle(text: str, draw: random.Random) -> str:
    for _ in range(draw.randint(1, 3)):
        values, tags = list(re.finditer(r'"([^"]*)"', text)), list(re.finditer(r"<[^>/]*/>", text))
        if draw.random() < 0.7 or not tags:
            spot = draw.choice(values)
            text = text[: spot.start(1)] + draw.choice(JUNK) + text[spot.end(1) :]
        else:
            spot = draw.choice(tags)
            text = text[: spot.start()] + draw.choice(["", spot.group() * 2]) + text[spot.end() :]
    return text


@pytest.mark.parametrize("form", ["urdf", "mjcf"])
def test_mangled_files_are_read_or_refused(form, tmp_path):
    draw, path = random.Random(1), tmp_path / "arm.xml"
    getattr(random_arm(3, 1), f"write_{form}")(path)
    whole, read, messages = path.read_text(), 0, []
    for _ in range(MANGLED):
        path.write_text(mangle(whole, draw))
        try:
            robot = load_description(path)
        except RobotError as error:
            messages.append(str(error))
            continue
        read += 1
        tau = robot.inverse_dynamics(*np.full((3, 1, robot.n_dof), 0.3))
        assert np.isfinite(tau).all()
    assert all(message.startswith(str(path)) and "\n" not in message for message in messages)
    assert MANGLED / 50 < read < MANGLED / 2, "the mangling neither always nor never hurts"
