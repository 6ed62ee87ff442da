"""The small arm on the page: light, faithful to the bodies, and played by a real browser."""

from __future__ import annotations

import base64
import json
import re
import subprocess
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from lagnet.diagnosis.verdict.arm_motion import arm_motion
from lagnet.diagnosis.verdict.report_data import ArmMotion
from lagnet.reports.page import json_for_script, section, write_page
from lagnet.reports.sections.arm_view import view_data
from lagnet.rigid_body.random_arm import random_arm

ARM = random_arm(7, seed=2)
LIMIT = 60_000  # bytes of script and data
FLAGS = (
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-dev-shm-usage",
    "--virtual-time-budget=3000",
    "--dump-dom",
)


@pytest.fixture(scope="module")
def motion() -> ArmMotion:
    time = np.arange(6000) / 100.0
    q = 0.8 * np.sin(time[:, None] * np.linspace(0.5, 2.0, 7))
    residual = np.abs(np.cos(time[:, None] * np.linspace(0.3, 1.0, 7)))
    found = arm_motion(ARM, time, q, (residual, 0.1 * residual), np.ones(7))
    assert found is not None
    return found


def test_the_tree_and_the_tip_are_those_of_the_arm(motion: ArmMotion) -> None:
    q = np.random.default_rng(0).uniform(-1, 1, 7)
    placed: list[tuple[np.ndarray, np.ndarray]] = []
    for body, angle in zip(motion.tree, q, strict=True):
        p, r = (np.zeros(3), np.eye(3)) if body.parent < 0 else placed[body.parent]
        p, r = p + r @ body.position, r @ body.rotation
        x, y, z = body.axis
        cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
        turn = np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross
        placed.append((p, r @ turn) if body.turns else (p + r @ body.axis * angle, r))
    last = placed[-1]
    np.testing.assert_allclose(last[0] + last[1] @ motion.tip, ARM.skeleton(q)[-1], atol=1e-9)
    slid = [k for k, b in enumerate(motion.tree) if not b.turns]
    origins = np.array([p for p, _ in placed])
    turning = [k for k in range(7) if k not in slid]
    np.testing.assert_allclose(origins[turning], ARM.skeleton(q)[1:-1][turning], atol=1e-9)


def test_script_and_data_are_light(motion: ArmMotion) -> None:
    from importlib.resources import files

    script = files("lagnet.reports").joinpath("theme", "arm_view.js").read_bytes()
    data = str(json_for_script(view_data(ARM.joints, motion))).encode()
    assert len(script) + len(data) < LIMIT


def test_angles_and_residuals_survive_the_packing(motion: ArmMotion) -> None:
    data = view_data(ARM.joints, motion)
    packed = np.frombuffer(base64.b64decode(data["angles"]), dtype="<i2").reshape(-1, 7)
    np.testing.assert_allclose(packed * data["step"] + data["middle"], motion.q, atol=1e-4)
    shown = np.frombuffer(base64.b64decode(data["before"]), dtype=np.uint8).reshape(-1, 7) / 255.0 * data["top"]
    np.testing.assert_allclose(shown, np.minimum(motion.before, data["top"]), atol=data["top"] / 255.0)


def test_a_model_without_bodies_has_no_view() -> None:
    assert arm_motion(object(), np.arange(9.0), np.zeros((9, 1)), (np.zeros((9, 1)),) * 2, np.ones(1)) is None


@pytest.mark.browser
def test_it_plays_in_a_browser(motion: ArmMotion, browse: Callable, chromium: str, tmp_path: Path) -> None:
    data = view_data(ARM.joints, motion)
    part = section(
        "arm_view", "The arm in motion", scripts=("arm_view.js",), data=json_for_script(data), frames=data["frames"]
    )
    page = write_page(tmp_path / "view.html", "View", "", [part])
    seen = browse(page)
    assert seen.console == ()
    assert seen.requests == ()
    assert frame_of(seen.dom) == 0
    assert json.dumps(list(ARM.joints))[1:-1].replace(" ", "") in seen.dom
    playing = subprocess.run(
        [chromium, *FLAGS, f"--user-data-dir={tmp_path / 'own'}", clocked(page).resolve().as_uri() + "#arm_view"],
        capture_output=True,
        text=True,
        timeout=120,
        check=True,
    )
    assert frame_of(playing.stdout) > 10


def clocked(page: Path) -> Path:
    """The page with a timer in the place of the screen's refresh, which a busy machine may withhold for seconds."""
    script = page.read_text()
    timed = script.replace("requestAnimationFrame(tick)", "setTimeout(() => tick(performance.now()), 16)")
    assert timed.count("setTimeout(() => tick") == 2
    policy = re.compile(r'<meta http-equiv="Content-Security-Policy"[^>]*>')  # it holds the script's checksum
    copy = page.with_name("clocked.html")
    copy.write_text(policy.sub("", timed))
    return copy


def frame_of(dom: str) -> int:
    (frame,) = re.findall(r'data-frame="(\d+)"', dom)
    return int(frame)
