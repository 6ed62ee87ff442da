"""Fetching data sets: from a server on the loopback, from local copies, and every way in which that fails."""

from __future__ import annotations

import gzip
import hashlib
import http.server
import json
import threading
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import pytest
import scipy.io

from lagnet.errors import DataError
from lagnet.recordings.datasets import download as download_module
from lagnet.recordings.datasets.derived import RECIPES
from lagnet.recordings.datasets.fetch import DataFile, DataSet, data_sets, fetch
from lagnet.recordings.loading.load import load_recording

CONTENT = b"a" * 300_000


@dataclass
class Server:
    """What the server answers, by path: (status, declared length, body)."""

    address: str
    answers: dict[str, tuple[int, int, bytes]] = field(default_factory=dict)
    asked: list[str] = field(default_factory=list)

    def offer(self, name: str, body: bytes = CONTENT, *, status: int = 200, length: int | None = None) -> str:
        self.answers[f"/{name}"] = (status, len(body) if length is None else length, body)
        return f"{self.address}/{name}"


@pytest.fixture
def server() -> Iterator[Server]:
    class Handler(http.server.BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            known.asked.append(self.path)
            status, length, body = known.answers.get(self.path, (404, 0, b""))
            self.send_response(status)
            self.send_header("Content-Length", str(length))
            self.end_headers()
            self.wfile.write(body)

        def log_message(self, *_: object) -> None:
            pass

    with http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler) as listener:
        known = Server(f"http://127.0.0.1:{listener.server_port}")
        thread = threading.Thread(target=listener.serve_forever, kwargs={"poll_interval": 0.01})
        thread.start()
        yield known
        listener.shutdown()
        thread.join()


@pytest.fixture(autouse=True)
def no_local_copies(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("LAGNET_DATA_DIR", raising=False)
    for name in ("http_proxy", "https_proxy", "all_proxy"):
        monkeypatch.delenv(name, raising=False)
        monkeypatch.delenv(name.upper(), raising=False)


def one_file(url: str | None, content: bytes = CONTENT, name: str = "run.csv") -> dict[str, DataSet]:
    """A data set of one file with the right checksum."""
    file = DataFile(name, hashlib.sha256(content).hexdigest(), len(content), url)
    return {"arm": DataSet("arm", "about", "repository", "commit", (file,))}


def everything_in(folder: Path) -> list[Path]:
    return sorted(path for path in folder.rglob("*") if path.is_file())


def test_a_file_is_fetched_checked_and_kept(server: Server, tmp_path: Path) -> None:
    told: list[tuple[str, int, int | None]] = []
    sets = one_file(server.offer("run.csv"))
    fetched = fetch("arm", tmp_path, sets=sets, progress=lambda *step: told.append(step))
    assert fetched.paths == {"run.csv": tmp_path / "arm" / "run.csv"}
    assert fetched.paths["run.csv"].read_bytes() == CONTENT
    assert told[-1] == ("run.csv", 300_000, 300_000)
    assert fetch("arm", tmp_path, sets=sets).paths == fetched.paths
    assert server.asked == ["/run.csv"]
    assert everything_in(tmp_path) == [tmp_path / "arm" / "run.csv"]


def test_a_file_that_was_damaged_after_its_download_is_fetched_again(server: Server, tmp_path: Path) -> None:
    sets = one_file(server.offer("run.csv"))
    path = fetch("arm", tmp_path, sets=sets).paths["run.csv"]
    path.write_bytes(b"damaged")
    assert fetch("arm", tmp_path, sets=sets).paths["run.csv"].read_bytes() == CONTENT


BROKEN = {
    "truncated": ({"body": CONTENT[:1000], "length": len(CONTENT)}, "connection broke in the middle"),
    "wrong checksum": ({"body": b"b" * len(CONTENT)}, "does not have the sha256:"),
    "shorter": ({"body": CONTENT[:1000]}, "does not have the sha256:"),
    "server error": ({"body": b"oops", "status": 500}, "the server answered 500"),
    "gone": ({"body": b"", "status": 404}, "the server answered 404"),
    "endless": ({"body": CONTENT * 3}, "sends more than 300000 bytes"),
}


@pytest.mark.parametrize("case", BROKEN)
def test_a_broken_download_is_told_in_one_line_and_leaves_nothing(case: str, server: Server, tmp_path: Path) -> None:
    answer, expected = BROKEN[case]
    url = server.offer("run.csv", **answer)
    with pytest.raises(DataError, match=expected) as refusal:
        fetch("arm", tmp_path, sets=one_file(url))
    assert str(refusal.value).startswith(url)
    assert "\n" not in str(refusal.value)
    assert everything_in(tmp_path) == []
    assert not (tmp_path / "arm").exists()


def test_a_broken_download_keeps_the_old_file(server: Server, tmp_path: Path) -> None:
    path = tmp_path / "arm" / "run.csv"
    path.parent.mkdir()
    path.write_bytes(b"an older version")
    with pytest.raises(DataError, match="answered 500"):
        fetch("arm", tmp_path, sets=one_file(server.offer("run.csv", b"", status=500)))
    assert path.read_bytes() == b"an older version"


def test_no_server_and_a_silent_server_are_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(DataError, match=r"no connection to the server; .* or put arm/run\.csv in a folder"):
        fetch("arm", tmp_path, sets=one_file("http://127.0.0.1:1/run.csv"))
    import socket

    monkeypatch.setattr(download_module, "TIMEOUT", (0.2, 0.2))
    with socket.create_server(("127.0.0.1", 0)) as silent:
        url = f"http://127.0.0.1:{silent.getsockname()[1]}/run.csv"
        with pytest.raises(DataError, match="did not answer in time"):
            fetch("arm", tmp_path, sets=one_file(url))


def test_local_copies_come_first_and_are_checked_too(
    server: Server, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    local = tmp_path / "local" / "arm" / "run.csv"
    local.parent.mkdir(parents=True)
    local.write_bytes(CONTENT)
    monkeypatch.setenv("LAGNET_DATA_DIR", str(tmp_path / "local"))
    sets = one_file(server.offer("run.csv"))
    out = tmp_path / "out"
    assert fetch("arm", out, sets=sets).paths["run.csv"].read_bytes() == CONTENT
    assert everything_in(out) == [out / "arm" / "run.csv"]
    monkeypatch.setattr("lagnet.recordings.datasets.fetch.cache_folder", lambda: tmp_path / "cache")
    assert fetch("arm", sets=sets).paths["run.csv"] == local
    assert server.asked == []
    local.write_bytes(b"something else")
    with pytest.raises(DataError, match=r"local/arm/run\.csv: does not have the sha256 .*LAGNET_DATA_DIR"):
        fetch("arm", sets=sets)


def test_an_unknown_name_and_a_set_that_cannot_be_had(tmp_path: Path) -> None:
    with pytest.raises(DataError, match=r"no data set is called 'ur10', did you mean 'ur10e'\?.*valid: .*sarcos"):
        fetch("ur10", tmp_path)
    with pytest.raises(DataError, match=r"delan_characters is not offered .*delan_characters/characters\.npz"):
        fetch("delan_characters", tmp_path)
    assert everything_in(tmp_path) == []


def sarcos_like(rows: int) -> bytes:
    import io

    stream = io.BytesIO()
    scipy.io.savemat(stream, {"sarcos_inv": np.random.default_rng(0).normal(size=(rows, 28))})
    return stream.getvalue()


def test_a_file_without_published_checksum_is_checked_by_content(server: Server, tmp_path: Path) -> None:
    def sets(url: str) -> dict[str, DataSet]:
        file = DataFile("sarcos_inv.mat", None, None, url, "50 x 28; not published")
        pinned = DataFile("run.csv", hashlib.sha256(CONTENT).hexdigest(), len(CONTENT), server.offer("run.csv"))
        return {"arm": DataSet("arm", "", "", "", (pinned, file))}

    good = fetch("arm", tmp_path / "good", sets=sets(server.offer("good.mat", sarcos_like(50))))
    assert sorted(good.paths) == ["run.csv", "sarcos_inv.mat"]
    assert "no published checksum" in good.notes[0]
    with pytest.raises(DataError, match=r"what the server sent is not sarcos_inv\.mat: holds 49 rows instead of 50"):
        fetch("arm", tmp_path / "short", sets=sets(server.offer("short.mat", sarcos_like(49))))
    with pytest.raises(DataError, match="cannot be read as a MATLAB file"):
        fetch("arm", tmp_path / "page", sets=sets(server.offer("page.mat", b"<html>moved</html>" * 9)))
    assert everything_in(tmp_path / "page") == [tmp_path / "page" / "arm" / "run.csv"]
    lost = fetch("arm", tmp_path / "lost", sets=sets(f"{server.address}/nowhere.mat"))
    assert list(lost.paths) == ["run.csv"]
    assert "not fetched" in lost.notes[0]


def test_the_manifest_pins_every_address() -> None:
    for data in data_sets().values():
        for file in data.files:
            assert not file.name.startswith(("/", "..", "\\"))
            if file.upstream is not None and file.sha256 is not None:
                assert len(bytes.fromhex(file.sha256)) == 32
                assert file.bytes is not None
                assert data.commit in file.upstream or "gaussianprocess" in file.upstream
        for name, recipe in RECIPES.get(data.name, {}).items():
            assert set(recipe.needs) <= {file.name for file in data.files if file.upstream}, name


@pytest.mark.shared_data
@pytest.mark.parametrize("name", ["ur10e", "staubli_tx40", "emps"])
def test_derived_recordings_equal_the_published_ones(
    name: str, shared_data: Path, server: Server, tmp_path: Path
) -> None:
    """Raw files from a server alone give the same text as the recordings that the pass lines were stated on."""
    origin = data_sets()[name]
    served = []
    for file in origin.files:
        raw = file.upstream is not None
        url = server.offer(file.name, (shared_data / name / file.name).read_bytes()) if raw else None
        served.append(DataFile(file.name, file.sha256, file.bytes, url))
    sets = {name: DataSet(name, origin.about, origin.repository, origin.commit, tuple(served))}
    fetched = fetch(name, tmp_path, sets=sets)
    tables = [file for file in fetched.paths if file.endswith(".csv.gz")]
    assert "fit.csv.gz" in tables or "fit_0.csv.gz" in tables
    for table in tables:
        ours, theirs = (gzip.decompress((base / name / table).read_bytes()) for base in (tmp_path, shared_data))
        assert ours == theirs
    if name == "ur10e":
        assert "point_to_point.csv.gz" in fetched.notes[0]
        recording = load_recording(fetched.paths["fit_0.csv.gz"], columns=fetched.paths["columns.toml"])
        assert np.abs(recording.tau).max() > 50
    from xml.etree import ElementTree

    (urdf,) = [path for file, path in fetched.paths.items() if file.endswith(".urdf") and "/" not in file]
    flat = [
        ElementTree.canonicalize(path.read_text(), strip_text=True) for path in (urdf, shared_data / name / urdf.name)
    ]
    assert flat[0] == flat[1]


def test_the_manifest_is_the_published_one(shared_data: Path) -> None:
    assert data_sets() == data_sets((shared_data / "manifest.json").read_text())
    assert json.loads((shared_data / "manifest.json").read_text()).keys() == data_sets().keys()
