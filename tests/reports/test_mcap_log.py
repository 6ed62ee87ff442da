"""The MCAP file reads back by its own library with the numbers that went in."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory

from lagnet.reports.mcap_log import TOPICS, TorqueLog, logs_of, verdict_lines, write_mcap

VERDICT = {
    "effects": [{"explanation": "Dry friction of 2 N m on elbow."}],
    "warnings": ["the clock jitters"],
    "mismatch": {"found": True},
}


def decoded(path: Path, topic: str) -> list:
    with path.open("rb") as file:
        reader = make_reader(file, decoder_factories=[DecoderFactory()])
        return [message for _, _, _, message in reader.iter_decoded_messages(topics=[topic])]


@pytest.fixture
def logs() -> list[TorqueLog]:
    rng = np.random.default_rng(0)
    return [
        TorqueLog(
            np.arange(n) * 0.01 + 7.0,
            rng.normal(size=(n, 2)),
            rng.normal(size=(n, 2)),
            {kind: rng.normal(size=(n, 2)) for kind in TOPICS[:3]},
        )
        for n in (20, 30)
    ]


def test_torques_read_back_and_recordings_follow_each_other(logs: list[TorqueLog], tmp_path: Path) -> None:
    path = write_mcap(tmp_path / "out.mcap", ["shoulder", "elbow"], logs, VERDICT)
    for topic in TOPICS:
        own = decoded(path, f"/{topic}")
        effort = np.array([m.effort for m in own])
        expected = np.concatenate(
            [
                log.torques["measured"] - log.torques["corrected"] if topic == "residual" else log.torques[topic]
                for log in logs
            ]
        )
        np.testing.assert_array_equal(effort, expected)
        assert list(own[0].name) == ["shoulder", "elbow"]
        stamps = [m.header.stamp.sec + 1e-9 * m.header.stamp.nanosec for m in own]
        assert np.all(np.diff(stamps) > 0.0)
        assert stamps[20] - stamps[19] == pytest.approx(1.0)
    positions = np.array([m.position for m in decoded(path, "/measured")])
    np.testing.assert_array_equal(positions, np.concatenate([log.q for log in logs]))


def test_the_verdict_is_a_log_and_an_attachment(logs: list[TorqueLog], tmp_path: Path) -> None:
    path = write_mcap(tmp_path / "out.mcap", ["shoulder", "elbow"], logs, VERDICT)
    said = decoded(path, "/verdict")
    assert [(m.level, m.msg) for m in said] == [(20, "Dry friction of 2 N m on elbow."), (30, "the clock jitters")]
    with path.open("rb") as file:
        (attached,) = make_reader(file).iter_attachments()
    assert json.loads(attached.data) == VERDICT


def test_a_verdict_without_names_still_says_something() -> None:
    assert "No left-out" in verdict_lines({"effects": [], "warnings": [], "mismatch": {"found": False}})[0][1]
    assert "no known physics" in verdict_lines({"effects": [], "warnings": [], "mismatch": {"found": True}})[0][1]


def test_logs_are_cut_where_recordings_end() -> None:
    table = {"time": np.arange(5.0)} | {f"tau_{k}_0": np.arange(5.0) for k in TOPICS[:3]}
    motions = [(np.zeros((2, 1)), np.zeros((2, 1))), (np.ones((3, 1)), np.ones((3, 1)))]
    first, second = logs_of(table, motions, 1)
    assert first.time.tolist() == [0.0, 1.0]
    assert second.torques["nominal"][:, 0].tolist() == [2.0, 3.0, 4.0]
