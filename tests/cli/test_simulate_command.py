"""`lagnet simulate` writes whole files, keeps the truth apart, and refuses bad input before it writes anything."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

pytest.importorskip("pybullet")

from lagnet.cli.main import main
from lagnet.recordings.loading.load import load_recording

SHORT = ["--trajectories", "2", "--duration", "1", "--seed", "3"]
EFFECTS = '[[effect]]\nname = "coulomb_friction"\njoint = "elbow_joint"\nFc = 1.5\n'


def test_recordings_settings_and_truth_are_written(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "effects.toml").write_text(EFFECTS)
    out = tmp_path / "sim"
    assert (
        main(["simulate", "--robot", "ur5", "--out", str(out), "--effects", str(tmp_path / "effects.toml"), *SHORT])
        == 0
    )
    assert sorted(p.name for p in out.iterdir()) == [
        "settings.json", "trajectory_0.csv", "trajectory_1.csv", "truth.json",
    ]  # fmt: skip
    truth = json.loads((out / "truth.json").read_text())
    assert truth["effects"] == [{"effect": "coulomb_friction", "joint": "elbow_joint", "parameters": {"Fc": 1.5}}]
    for name in ("trajectory_0.csv", "settings.json"):
        assert "coulomb" not in (out / name).read_text()
    recording = load_recording(out / "trajectory_0.csv")
    assert len(recording) == 100
    assert recording.n_dof == 6
    assert "truth.json" in capsys.readouterr().out


def test_the_same_seed_writes_the_same_bytes(tmp_path: Path) -> None:
    for name in ("a", "b"):
        assert main(["simulate", "--robot", "ur5", "--out", str(tmp_path / name), *SHORT]) == 0
    for file in ("trajectory_0.csv", "trajectory_1.csv", "truth.json"):
        assert (tmp_path / "a" / file).read_bytes() == (tmp_path / "b" / file).read_bytes()


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--robot", "ur55"], "ur5"),
        (["--robot", "ur5", "--engine", "chalk"], "valid: pybullet"),
        (["--robot", "ur5", "--trajectories", "0"], "ask for at least 1"),
        (["--robot", "ur5", "--duration", "0"], "1 to 3600 s"),
        (["--robot", "ur5", "--step-rate", "100"], "500 to 10000 Hz"),
        (["--robot", "ur5", "--rate", "5000"], "cannot be faster"),
        (["--robot", "ur5", "--torque-noise", "-1"], "0 to 1"),
        (["--robot", "ur5", "--encoder-bits", "99"], "0 to 40"),
        (["--robot", "ur5", "--clock-jitter", "nan"], "0 to 1 s"),
        (["--robot", "ur5", "--effects", "missing.toml"], "missing.toml"),
    ],
)
def test_bad_input_is_one_line_and_writes_nothing(
    arguments: list[str], message: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "sim"
    assert main(["simulate", "--out", str(out), *arguments]) == 2
    error = capsys.readouterr().err
    assert message in error
    assert error.count("\n") == 1
    assert not out.exists()


def test_a_folder_in_use_is_left_alone(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "notes.txt").write_text("mine")
    assert main(["simulate", "--robot", "ur5", "--out", str(tmp_path), *SHORT]) == 2
    assert "not empty" in capsys.readouterr().err
    assert [p.name for p in tmp_path.iterdir()] == ["notes.txt"]


def test_an_interruption_keeps_whole_files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from lagnet.simulation import simulate

    real, calls = simulate.run_closed_loop, []

    def stopped(*given: object) -> object:
        calls.append(given)
        if len(calls) == 2:
            raise KeyboardInterrupt
        return real(*given)  # type: ignore[arg-type]

    monkeypatch.setattr(simulate, "run_closed_loop", stopped)
    assert main(["simulate", "--robot", "ur5", "--out", str(tmp_path / "sim"), *SHORT]) == 3
    assert sorted(p.name for p in (tmp_path / "sim").iterdir()) == ["settings.json", "trajectory_0.csv", "truth.json"]
    assert len(load_recording(tmp_path / "sim" / "trajectory_0.csv")) == 100
