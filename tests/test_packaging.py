"""What is shipped: metadata, pinned versions, the wheel's contents, and nothing that names a machine."""

from __future__ import annotations

import hashlib
import json
import re
import shutil
import subprocess
import sys
import tomllib
import zipfile
from importlib.metadata import metadata, requires
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
PYPROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
PINNED = re.compile(r"^[A-Za-z0-9][A-Za-z0-9._-]*==[0-9][A-Za-z0-9.+!-]*$")
# written apart so that this file does not hold what it forbids
FORBIDDEN = tuple(
    re.compile(pattern)
    for pattern in (
        r"(?<![\w./~-])/(wo" + r"rk|ro" + r"ot|ho" + r"me|Us" + r"ers)/\w",
        r"(?<![\w./~-])/tm" + r"p/\w",
        r"[A-Z]:\\\\Us" + r"ers",
        r"(py" + r"pi\.org|python" + r"hosted|npm" + r"js\.|deb" + r"ian\.org|anaco" + r"nda\.org)",
    )
)
RECORDINGS = (".csv", ".csv.gz", ".parquet", ".npz", ".mat", ".pkl", ".pickle", ".pt", ".h5")


def tracked() -> list[Path]:
    """Files under version control, or all that would be shipped where this is no checkout."""
    listed = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, check=True).stdout
    return [ROOT / name for name in listed.decode().split("\0") if name and (ROOT / name).is_file()]


def name_of(requirement: str) -> str:
    return re.split(r"[\s<>=!~;\[(]", requirement, maxsplit=1)[0].lower().replace("_", "-").replace(".", "-")


def test_lock_holds_names_and_versions_alone() -> None:
    lines = (ROOT / "requirements.lock").read_text(encoding="utf-8").splitlines()
    assert [line for line in lines if not PINNED.match(line)] == []
    assert len({name_of(line) for line in lines}) == len(lines)


def test_lock_pins_every_declared_dependency() -> None:
    locked = {name_of(line) for line in (ROOT / "requirements.lock").read_text(encoding="utf-8").splitlines()}
    project = PYPROJECT["project"]
    declared = [*project["dependencies"], *(r for extra in project["optional-dependencies"].values() for r in extra)]
    assert {name_of(r) for r in declared} - locked - {"lagnet"} == set()


def test_metadata_of_the_installed_package() -> None:
    import lagnet

    about = metadata("lagnet")
    assert about["Version"] == lagnet.__version__ == PYPROJECT["project"]["version"]
    assert about["License-Expression"] == "MIT"
    assert about["Requires-Python"] == ">=3.11"
    assert not any(r.startswith("pybullet") and "extra" not in r for r in requires("lagnet") or [])


def test_versions_agree() -> None:
    version = PYPROJECT["project"]["version"]
    assert f"\nversion: {version}\n" in (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    assert version in (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")


def test_nothing_names_a_machine_or_a_registry() -> None:
    found = []
    for path in tracked():
        data = path.read_bytes()
        if b"\0" in data[:4096]:
            continue
        for number, line in enumerate(data.decode("utf-8", errors="replace").splitlines(), 1):
            if any(pattern.search(line) for pattern in FORBIDDEN) and not line.startswith("#!"):
                found.append(f"{path.relative_to(ROOT)}:{number}: {line.strip()[:120]}")
    assert found == []


def test_no_recording_of_others_and_no_pickle_is_tracked() -> None:
    """Recordings made by scripts of this project may stand in tests and data, small ones."""
    large = [p for p in tracked() if p.name.endswith(RECORDINGS) and p.stat().st_size > 1_000_000]
    code = [p for p in tracked() if p.suffix in (".pkl", ".pickle", ".pt", ".h5")]
    known = _checksums(json.loads((ROOT / "src/lagnet/recordings/datasets/manifest.json").read_text(encoding="utf-8")))
    assert known
    copies = [p for p in tracked() if p.name.endswith(RECORDINGS) and _sha256(p) in known]
    assert (large, code, copies) == ([], [], [])


def _checksums(node: object) -> set[str]:
    if isinstance(node, dict):
        own = {node["sha256"]} if isinstance(node.get("sha256"), str) else set()
        return own.union(*map(_checksums, node.values()))
    return set()


def _sha256(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> set[str]:
    """Names in a wheel that is built from tracked and new files alone."""
    out = tmp_path_factory.mktemp("wheel")
    source = out / "source"
    source.mkdir()
    for name in ("pyproject.toml", "README.md", "LICENSE"):
        shutil.copy(ROOT / name, source / name)
    shutil.copytree(ROOT / "src", source / "src", ignore=shutil.ignore_patterns("__pycache__"))
    command = [sys.executable, "-m", "build", "--wheel", "--no-isolation", "--outdir", str(out), str(source)]
    subprocess.run(command, check=True, capture_output=True)
    with zipfile.ZipFile(next(out.glob("*.whl"))) as file:
        return set(file.namelist())


@pytest.mark.xdist_group("wheel")
def test_wheel_holds_what_the_package_reads(wheel: set[str]) -> None:
    source = ROOT / "src"
    needed = {
        str(p.relative_to(source))
        for p in source.rglob("*")
        if p.is_file() and "__pycache__" not in p.parts and p.suffix != ".pyc"
    }
    assert needed <= wheel
    assert {"lagnet/recordings/datasets/manifest.json", "lagnet/reports/templates/base.html.j2"} <= wheel
    assert {"lagnet/reports/theme/report.css", "lagnet/reports/theme/report.js"} <= wheel


@pytest.mark.xdist_group("wheel")
def test_wheel_holds_no_recordings_tests_or_studies(wheel: set[str]) -> None:
    assert [n for n in wheel if n.endswith(RECORDINGS)] == []
    assert {n.split("/")[0] for n in wheel} <= {"lagnet", f"lagnet-{PYPROJECT['project']['version']}.dist-info"}
