"""The small fleet of the study of interruptions can be drawn and written."""

from __future__ import annotations

from pathlib import Path

from validation.fleet.generate import write_fleet
from validation.fleet.interruptions import RECORDINGS, ROBOTS, SEED


def test_its_fleet_has_a_robot_of_each_make_to_calibrate_on(tmp_path: Path) -> None:
    manifest = write_fleet(tmp_path, ROBOTS, RECORDINGS, SEED, "unusual")
    assert manifest.exists()
    assert len(list((tmp_path / "recordings").glob("*/*.parquet"))) == ROBOTS * RECORDINGS
