"""A small fleet from manifest to tables: what changed, what failed, and that nothing is done twice."""

from __future__ import annotations

import shutil
from pathlib import Path

import pyarrow.parquet as pq
import pytest
from tests.tracking.fleets import write_fleet

from lagnet.errors import LagnetError
from lagnet.reports.fleet_report import write_fleet_report
from lagnet.tracking import tables
from lagnet.tracking import track as module
from lagnet.tracking.engine import EngineSettings, open_engine
from lagnet.tracking.fleet_pages import fleet_of
from lagnet.tracking.tables import read_track
from lagnet.tracking.track import track

pytestmark = [
    pytest.mark.filterwarnings("ignore::ResourceWarning", "ignore::DeprecationWarning"),
    pytest.mark.xdist_group("track"),  # what they share is made once
]
ROBOTS, RECORDINGS = 2, 5


@pytest.fixture(scope="module")
def fleet(tmp_path_factory, scheduler):
    """A fleet with one bad file, tracked."""
    folder = tmp_path_factory.mktemp("fleet")
    manifest = write_fleet(folder, ROBOTS, RECORDINGS)
    manifest.write_text(manifest.read_text().replace("reports = false", 'reports = false\nsearch = "unusual"'))
    (folder / "arm_1" / "2026-01-12.parquet").write_text("this is no recording")
    engine = EngineSettings(scheduler=scheduler)
    return manifest, folder / "out", engine, track(manifest, folder / "out", engine)


def test_the_tool_is_told_from_the_recording_on_that_shows_it(fleet):
    events = fleet[3].analysis.events
    assert {(e.robot, e.effect, f"{e.date:%m-%d}") for e in events} == {("arm_0", "payload", "02-02")}


def test_one_bad_file_is_a_row_with_its_error(fleet):
    (row,) = fleet[3].failed
    assert (row.robot, row.recording) == ("arm_1", "arm_1/2026-01-12.parquet")
    assert "2026-01-12.parquet" in row.error
    table = read_track(fleet[1]).to_pylist()
    assert [r["recording"] for r in table if r["error"]] == ["arm_1/2026-01-12.parquet"]
    assert len({r["recording"] for r in table}) == ROBOTS * RECORDINGS
    assert all(r["temperature"] == 25.0 for r in table if r["joint"])


def test_finished_work_is_not_done_again_and_lost_work_comes_back_the_same(fleet, monkeypatch):
    manifest, out, engine, _ = fleet
    before = (out / "track.parquet").read_bytes()
    monkeypatch.setattr(module, "open_engine", lambda settings: pytest.fail("work was done again"))
    track(manifest, out, engine)
    monkeypatch.undo()
    shutil.rmtree(next((out / "diagnoses" / "arm_0").iterdir()))
    (out / "diagnoses" / "arm_0" / ".half.part").mkdir()
    track(manifest, out, engine)
    assert (out / "track.parquet").read_bytes() == before


def test_searched_recordings_hold_a_diagnosis(fleet):
    searched = {r.diagnosis for r in fleet[3].rows if r.diagnosis}
    assert searched
    assert all((fleet[1] / d / "verdict.json").is_file() and (fleet[1] / d / "corrected").is_dir() for d in searched)


def test_report_of_a_track(fleet, tmp_path):
    text = write_fleet_report(fleet_of(fleet[3]), tmp_path / "report.html").read_text()
    assert "1 robot of 2 changed." in text
    assert "verdict.json" in text


def test_many_rows_are_parted_by_robot(fleet, monkeypatch, tmp_path):
    monkeypatch.setattr(tables, "PARTITIONED", 10)
    tables.write_tables(fleet[3].rows, fleet[3].analysis, (), tmp_path)
    assert sorted(p.name for p in (tmp_path / "track.parquet").iterdir()) == ["robot=arm_0", "robot=arm_1"]
    whole = pq.read_table(fleet[1] / "track.parquet")
    assert read_track(tmp_path).select(whole.column_names).sort_by("value") == whole.sort_by("value")


def test_engine_tells_errors_beside_results(scheduler):
    with open_engine(EngineSettings(scheduler=scheduler, retries=0)) as engine:
        outcomes = {o.index: o for o in engine.run(float, ["1", "x", "3"])}
    assert (outcomes[0].result, outcomes[2].result) == (1.0, 3.0)
    assert "could not convert" in outcomes[1].error


def test_no_scheduler_is_one_line(monkeypatch):
    monkeypatch.setattr("lagnet.tracking.engine.CONNECTING", 1)
    with (
        pytest.raises(LagnetError, match="no Dask scheduler answers"),
        open_engine(EngineSettings("tcp://127.0.0.1:9")),
    ):
        pass


def test_a_make_without_a_readable_recording_is_told(tmp_path, scheduler):
    manifest = write_fleet(tmp_path, 1, 1, calibrated=False)
    (tmp_path / "arm_0" / "2026-01-05.parquet").write_text("nothing")
    with pytest.raises(LagnetError, match="make planar: no calibration"):
        track(manifest, tmp_path / "out", EngineSettings(scheduler=scheduler))


def test_the_query_of_the_docs_runs(fleet):
    duckdb = pytest.importorskip("duckdb")
    page = Path(__file__).resolve().parents[2] / "docs" / "fleet.md"
    query = page.read_text(encoding="utf-8").split("```sql")[1].split("```")[0]
    rows = duckdb.sql(query.replace("track/track.parquet", str(fleet[1] / "track.parquet"))).fetchall()
    assert {(row[0], row[2]) for row in rows} == {(f"arm_{r}", p) for r in range(ROBOTS) for p in ("Fc", "Fv")}
    assert all(abs(row[3]) < 0.1 for row in rows)
