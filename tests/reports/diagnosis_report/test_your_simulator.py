"""The section "Your simulator, before and after" says what a replay found, for every kind of arm and drive."""

from __future__ import annotations

import base64
import json
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lagnet.reports.contents.replay_data import ReplayData
from lagnet.reports.diagnosis_report import write_report
from lagnet.reports.page import write_page
from lagnet.reports.sections.your_simulator import build

TITLE = "Your simulator, before and after"
LONG = tuple(f"left_manipulator_segment_{i}_actuated_rotary_joint" for i in range(8))


def replayed(joints: tuple[str, ...], units: tuple[str, ...], mode: str = "torques", after: bool = True) -> ReplayData:
    """Two stretches of one recording with a gap between them; errors of 0.1 before and 0.01 after on every joint."""
    time = np.r_[np.arange(0.0, 4.0, 0.01), np.arange(6.0, 16.0, 0.01)]
    sides = {"before": 0.1, "after": 0.01} if after else {"before": 0.1}
    columns: dict[str, Any] = {"recording": ["held.csv"] * time.size, "time": time}
    for i in range(len(joints)):
        q = np.sin(time + i)
        columns[f"q_measured_{i}"] = q
        columns |= {f"q_{side}_{i}": q + error for side, error in sides.items()}
    found = {
        side: {"rmse": [error] * len(joints), "horizon_median_s": 0.2 / error, "horizons_s": [0.1 / error, 0.3 / error],
               "horizons_left": [True, side == "before"]}
        for side, error in sides.items()
    }  # fmt: skip
    summary = {
        "engine": "mujoco", "mode": mode, "tolerance_rad": 0.05, "window_s": 30.0, "bandwidth_rad_s": 8.0,
        "joints": list(joints), "units": list(units), "recordings": [{"recording": "held.csv", "seconds": 14.0}],
        "before": found["before"], "after": found.get("after"), **({"error_ratio": 0.1} if after else {}),
    }  # fmt: skip
    return ReplayData(summary, columns)


CASES: dict[str, Callable[[], ReplayData]] = {
    "torques": lambda: replayed(("shoulder", "elbow"), ("rad", "rad")),
    "commands": lambda: replayed(("shoulder", "elbow"), ("rad", "rad"), "commands"),
    "before_alone": lambda: replayed(("shoulder",), ("rad",), after=False),
    "a_slide": lambda: replayed(("column", "shoulder"), ("m", "rad")),
    "long_names": lambda: replayed(LONG, ("rad",) * 8),
}


@pytest.fixture(params=CASES, ids=list(CASES))
def data(request: pytest.FixtureRequest) -> ReplayData:
    return CASES[request.param]()


def specifications(data: ReplayData) -> dict[str, Any]:
    return {figure.key: figure.specification() for figure in build(data).figures}


def values(packed: Any) -> np.ndarray:
    """What `figures.packed` packed."""
    return np.frombuffer(base64.b64decode(packed["bdata"]), "<f4")


def test_every_axis_of_numbers_has_a_unit(data: ReplayData) -> None:
    for key, figure in specifications(data).items():
        for name in ("xaxis", "yaxis"):
            axis = figure["layout"][name]
            if axis.get("type") != "category":
                assert re.fullmatch(r".+ \[.+\]", axis["title"]["text"]), (key, name)


def test_a_slide_is_measured_in_metres() -> None:
    figures = specifications(CASES["a_slide"]())
    titles = [figures[f"replay-{i}"]["layout"]["yaxis"]["title"]["text"] for i in range(2)]
    assert titles == ["position [m]", "position [rad]"]
    assert figures["replay-by-joint"]["layout"]["xaxis"]["title"]["text"] == "error, rms [rad or m]"


def test_curves_over_time_are_those_of_the_longest_stretch() -> None:
    figure = specifications(CASES["torques"]())["replay-0"]
    time = values(figure["data"][0]["x"])
    assert time[0] == pytest.approx(6.0)
    assert time[-1] == pytest.approx(15.99)


def test_a_constant_error_is_that_error_at_every_time() -> None:
    figure = specifications(CASES["torques"]())["replay-over-time"]
    np.testing.assert_allclose(values(figure["data"][0]["y"]), 0.1, rtol=1e-5)
    np.testing.assert_allclose(values(figure["data"][1]["y"]), 0.01, rtol=1e-5)


def test_rollouts_that_never_left_count_as_near_to_the_end() -> None:
    """Before: left after 1 s and 3 s. After: left after 10 s; the other was near when it ended."""
    before, after = specifications(CASES["torques"]())["replay-horizon"]["data"]
    np.testing.assert_allclose(values(before["x"]), [0.0, 1.0, 3.0])
    np.testing.assert_allclose(values(before["y"]), [100.0, 50.0, 0.0])
    np.testing.assert_allclose(values(after["x"]), [0.0, 10.0, 30.0])
    np.testing.assert_allclose(values(after["y"]), [100.0, 50.0, 50.0])


def test_the_words_state_error_tolerance_and_horizon() -> None:
    words = re.sub(r"<[^>]+>|\s+", " ", str(build(CASES["torques"]()).body))
    assert "the error is 10 % of what it was" in " ".join(words.split())
    assert "stays within 0.05 rad of the real arm for 2.00 s before and 20.0 s after" in " ".join(words.split())


@pytest.mark.slow
def test_the_diagnosis_report_holds_it_only_where_there_was_a_replay(six, tmp_path: Path) -> None:
    without = write_report(six.verdict, six.evidence, tmp_path / "a.html").read_text(encoding="utf-8")
    replay = CASES["long_names"]()
    within = write_report(six.verdict, six.evidence, tmp_path / "b.html", replay).read_text(encoding="utf-8")
    assert TITLE not in without
    assert within.count(f"<h2>{TITLE}</h2>") == 1
    figures = re.search(r'<script type="application/json" id="figures">(.*?)</script>', within)
    assert figures is not None
    assert set(specifications(replay)) <= set(json.loads(figures[1]))
    assert len(within) - len(without) < 4e5


@pytest.mark.slow
@pytest.mark.browser
def test_it_opens_in_a_browser(data: ReplayData, tmp_path: Path, browse: Callable) -> None:
    seen = browse(write_page(tmp_path / "report.html", "Replay", "", [build(data)]))
    assert seen.console == ()
    assert seen.requests == ()
    assert seen.drawn == 4  # by joint, over time, horizon, and one joint's motion
    assert TITLE in seen.text
