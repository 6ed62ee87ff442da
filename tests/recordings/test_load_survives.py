"""Flaws of real files that are survived, and told in the recording's warnings."""

from __future__ import annotations

import gzip
from pathlib import Path

import numpy as np
import pytest

from lagnet.errors import RecordingError
from lagnet.recordings.loading.load import load_recording

HEADER = "time,q_0,q_1,tau_0,tau_1"


def samples(n: int = 60) -> list[str]:
    """A two-joint swing, one text line a sample, without header."""
    time = 0.01 * np.arange(n)
    rows = np.column_stack([time, np.sin(time), np.cos(time), 10 * np.cos(time), 5 * np.sin(time)])
    return [",".join(f"{value:.6f}" for value in row) for row in rows]


def load(folder: Path, text: str | bytes, name: str = "run.csv"):
    """Write and read back."""
    path = folder / name
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return load_recording(path)


WHOLE = "\n".join([HEADER, *samples()]) + "\n"
SAME = {
    "byte-order mark": b"\xef\xbb\xbf" + WHOLE.encode(),
    "windows line ends": WHOLE.replace("\n", "\r\n").encode(),
    "old mac line ends": WHOLE.replace("\n", "\r").encode(),
    "no final line end": WHOLE.rstrip("\n").encode(),
    "blank lines at the end": (WHOLE + "\n\n\n").encode(),
    "blank lines before": ("\n\n" + WHOLE).encode(),
    "semicolons": WHOLE.replace(",", ";").encode(),
    "semicolons and decimal commas": WHOLE.replace(",", ";").replace(".", ",").encode(),
    "tabs": WHOLE.replace(",", "\t").encode(),
    "quotes": WHOLE.replace(HEADER, '"time","q_0","q_1","tau_0","tau_1"').encode(),
    "spaces after commas": WHOLE.replace(",", ", ").encode(),
    "commented header": ("# " + WHOLE).encode(),
    "plus signs": WHOLE.replace("\n0.", "\n+0.").encode(),
    "t for time": WHOLE.replace("time", "t").encode(),
    "columns of other things": "".join(
        line + end for line, end in zip(WHOLE.splitlines(), [",comment\n", *[",hello world\n"] * 60], strict=True)
    ).encode(),
    "other order": "\n".join(",".join(reversed(line.split(","))) for line in WHOLE.splitlines()).encode(),
}


@pytest.mark.parametrize("case", SAME)
def test_reads_the_same_numbers_without_a_warning(case: str, tmp_path: Path) -> None:
    expected, found = load(tmp_path, WHOLE), load(tmp_path, SAME[case])
    for name in ("time", "q", "tau"):
        np.testing.assert_array_equal(getattr(found, name), getattr(expected, name))
    assert found.joints == ("joint_0", "joint_1")
    assert found.warnings == ()
    assert found.v is None
    assert found.a is None


CUT = {
    "in its middle": "0.60,0.1,0.2",
    "after a separator": "0.60,0.1,0.2,1.0,",
    "before its last cell ends": "0.60,0.1,0.2,1.0,-",
    "in an exponent": "0.60,0.1,0.2,1.0,1.5e",
    "after the time": "0.60",
}


@pytest.mark.parametrize("case", CUT)
@pytest.mark.parametrize("compressed", ["run.csv", "run.csv.gz"])
def test_a_truncated_last_line_is_dropped_and_told(case: str, compressed: str, tmp_path: Path) -> None:
    text = (WHOLE + CUT[case]).encode()
    found = load(tmp_path, gzip.compress(text) if compressed.endswith("gz") else text, compressed)
    assert len(found) == 60
    assert found.warnings == ("the last line is cut short; it was dropped",)


def test_a_short_last_line_with_line_end_is_dropped_too(tmp_path: Path) -> None:
    found = load(tmp_path, WHOLE + "0.60,0.1\n")
    assert len(found) == 60
    assert found.warnings == ("the last line is cut short; it was dropped",)


def test_damaged_lines_inside_are_counted_and_later_lines_keep_their_numbers(tmp_path: Path) -> None:
    lines = WHOLE.splitlines()
    lines[10], lines[20] = "0.09,0.1", lines[20] + lines[21]
    found = load(tmp_path, "\n".join(lines) + "\n")
    assert len(found) == 58
    assert found.warnings == ("2 lines with a wrong number of cells dropped, the first is line 11",)
    lines[30] = "0.29,0.1,nan,1,1"
    with pytest.raises(RecordingError, match="line 31, column q_1"):
        load(tmp_path, "\n".join(lines) + "\n")
    lines[40] = "0.39,0.1,bad,1,1"
    with pytest.raises(RecordingError, match="line 41, column q_1: 'bad'"):
        load(tmp_path, "\n".join(lines) + "\n")


def test_an_empty_line_inside_is_told(tmp_path: Path) -> None:
    lines = WHOLE.splitlines()
    lines.insert(12, "")
    found = load(tmp_path, "\n".join(lines) + "\n")
    assert len(found) == 60
    assert found.warnings == ("1 empty line dropped, the first is line 13",)


def test_repeated_time_stamps_keep_the_first_sample(tmp_path: Path) -> None:
    lines = WHOLE.splitlines()
    lines.insert(8, lines[7].replace("0.06", "0.06", 1).rsplit(",", 1)[0] + ",99.0")
    found = load(tmp_path, "\n".join(lines) + "\n")
    assert len(found) == 60
    assert found.tau.max() < 99
    assert found.warnings == ("1 repeated time stamp, the first on line 9: the first sample of each was kept",)


def test_gaps_and_jitter_are_told_with_their_place(tmp_path: Path) -> None:
    rows = samples(400)
    found = load(tmp_path, "\n".join([HEADER, *rows[:100], *rows[130:200], *rows[210:]]) + "\n")
    assert len(found.warnings) == 1
    assert found.warnings[0].startswith("2 gaps in time")
    assert "the longest 0.31 s after line 101 (t = 0.99 s)" in found.warnings[0]
    rng = np.random.default_rng(3)
    time = np.cumsum(rng.uniform(0.005, 0.015, 200))
    np.savez(tmp_path / "jitter.npz", time=time, q=np.sin(time), tau=time)
    (told,) = load_recording(tmp_path / "jitter.npz").warnings
    assert told.startswith("the clock jitters: steps of 5")
    np.savez(tmp_path / "ms.npz", time=np.arange(200) * 10.0, q=np.sin(time), tau=time)
    (told,) = load_recording(tmp_path / "ms.npz").warnings
    assert "time = 0.001" in told


def test_trajectories_may_restart_the_clock_but_not_come_back(tmp_path: Path) -> None:
    rows = samples(30)
    labelled = [f"{row},{name}" for name in ("b", "a") for row in rows]
    found = load(tmp_path, "\n".join([HEADER + ",trajectory", *labelled]) + "\n")
    assert found.trajectory_names == ("b", "a")
    assert [len(part) for part in found.parts()] == [30, 30]
    assert found.warnings == ()
    again = [*labelled, *(f"{row},b" for row in rows)]
    with pytest.raises(RecordingError, match=r"line 62: trajectory 'b' comes back"):
        load(tmp_path, "\n".join([HEADER + ",trajectory", *again]) + "\n")
    labelled[45] = labelled[45].replace("0.15", "0.01", 1)
    with pytest.raises(RecordingError, match=r"line 47, column time: time runs back from 0\.14 to 0\.01"):
        load(tmp_path, "\n".join([HEADER + ",trajectory", *labelled]) + "\n")


@pytest.mark.parametrize("label", ["{}", "{}.0", "run {}"])
def test_labels_may_be_integers_or_text(label: str, tmp_path: Path) -> None:
    rows = [f"{row},{label.format(k)}" for k in (3, 1) for row in samples(25)]
    found = load(tmp_path, "\n".join([HEADER + ",trajectory", *rows]) + "\n")
    assert found.trajectory_names == (label.format(3), label.format(1))
    np.testing.assert_array_equal(found.trajectory, np.repeat([0, 1], 25))


def test_short_trajectories_are_told(tmp_path: Path) -> None:
    rows = [f"{row},{min(k // 28, 1)}" for k, row in enumerate(samples(30))]
    found = load(tmp_path, "\n".join([HEADER + ",trajectory", *rows]) + "\n")
    assert found.warnings == ("1 trajectory has fewer than 5 samples: 1",)


def test_torque_is_preferred_to_current(tmp_path: Path) -> None:
    both = WHOLE.replace(HEADER, HEADER + ",current_0,current_1").splitlines()
    both[1:] = [line + ",7,7" for line in both[1:]]
    found = load(tmp_path, "\n".join(both) + "\n")
    np.testing.assert_array_equal(found.tau, load(tmp_path, WHOLE).tau)
    assert found.warnings == ("holds torque and current: the torque is used",)


@pytest.mark.parametrize("cell", ["0.1234567", "12.5000000", "-3.25e-01", "walk_12"])
def test_a_last_cell_that_lost_its_end_is_noticed_wherever_writing_is_even(cell: str, tmp_path: Path) -> None:
    """Cut at every byte of the last line: the whole lines stay, the cut one never comes in with a wrong number."""
    header = HEADER + (",trajectory" if cell == "walk_12" else ",note")
    lines = [header, *(f"{row},{cell}" for row in samples(40))]
    whole = "\n".join(lines).encode()
    start = whole.rindex(b"\n") + 1
    for stop in range(start + 1, len(whole)):
        found = load(tmp_path, whole[:stop])
        assert len(found) == 39
        assert found.warnings == ("the last line is cut short; it was dropped",)
    assert len(load(tmp_path, whole)) == 40
    assert load(tmp_path, whole).warnings == ()


def test_numbers_of_uneven_length_do_not_cost_the_last_sample(tmp_path: Path) -> None:
    """A file that merely lacks its last line end is whole."""
    time = 0.01 * np.arange(60)
    rows = [f"{t:.7g},{np.sin(t):.7g},{round(np.cos(t), k % 4):.7g}" for k, t in enumerate(time)]
    found = load(tmp_path, "\n".join(["time,q_0,tau_0", *rows]))
    assert len(found) == 60
    assert found.warnings == ()


def test_other_encodings_in_columns_of_no_interest(tmp_path: Path) -> None:
    lines = WHOLE.splitlines()
    text = "\n".join([lines[0] + ",operator", *(line + ",Jürgen" for line in lines[1:])]) + "\n"
    for encoding in ("latin-1", "utf-8"):
        assert len(load(tmp_path, text.encode(encoding))) == 60
    damaged = text.replace("0.30", "Jü,0.30", 1).encode("latin-1")
    assert "1 line with a wrong number of cells" in load(tmp_path, damaged).warnings[0]


def test_an_open_quote_costs_its_own_line_only(tmp_path: Path) -> None:
    lines = WHOLE.splitlines()
    lines[10] = lines[10].replace(",", ',"', 1)
    found = load(tmp_path, "\n".join(lines) + "\n")
    assert len(found) == 59


def test_an_empty_label_is_refused(tmp_path: Path) -> None:
    rows = [f"{row},a" for row in samples(30)]
    rows[12] = rows[12][:-1]
    with pytest.raises(RecordingError, match="line 14, column trajectory: empty cell"):
        load(tmp_path, "\n".join([HEADER + ",trajectory", *rows]) + "\n")
