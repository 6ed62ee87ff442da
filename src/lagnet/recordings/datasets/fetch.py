"""Public data sets: where their files come from, which checksum they have, and how they become recordings."""

from __future__ import annotations

import hashlib
import json
import os
import shutil
from collections.abc import Mapping
from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path

from lagnet.errors import DataError, LagnetError, closest
from lagnet.recordings.datasets.derived import RECIPES
from lagnet.recordings.datasets.download import Progress, download

LOCAL_COPIES = "LAGNET_DATA_DIR"


@dataclass(frozen=True)
class DataFile:
    """One file of a data set.

    Args:
        name: path inside the data set's folder.
        sha256: checksum of its bytes, or None where nobody stated one.
        bytes: size, or None.
        upstream: address, or None where it is derived from other files or exists as local copy only.
        note: what else is to be known.
    """

    name: str
    sha256: str | None = None
    bytes: int | None = None
    upstream: str | None = None
    note: str = ""


@dataclass(frozen=True)
class DataSet:
    """A set of files with one origin.

    Args:
        name: short name.
        about: what it is, and its licence.
        repository: where it was published.
        commit: version of the repository.
        files: its files.
    """

    name: str
    about: str
    repository: str
    commit: str
    files: tuple[DataFile, ...]


@dataclass(frozen=True)
class Fetched:
    """Where the files of a data set lie now.

    Args:
        paths: file name to path.
        notes: what could not be had, and what was not checked.
    """

    paths: dict[str, Path]
    notes: tuple[str, ...] = ()


def data_sets(manifest: str | None = None) -> Mapping[str, DataSet]:
    """All data sets by name.

    Args:
        manifest: JSON text; the package's own where None.
    """
    text = files("lagnet.recordings.datasets").joinpath("manifest.json").read_text() if manifest is None else manifest
    return {name: _data_set(name, entry) for name, entry in sorted(json.loads(text).items())}


def _data_set(name: str, entry: dict) -> DataSet:
    found = [
        DataFile(file, facts.get("sha256"), facts.get("bytes"), facts.get("upstream"), facts.get("note", ""))
        for file, facts in entry["files"].items()
    ]
    return DataSet(name, entry["about"], entry["repository"], entry["commit"], tuple(found))


def cache_folder() -> Path:
    """Where fetched files are kept between runs."""
    import pooch

    return Path(pooch.os_cache("lagnet"))


def fetch(
    name: str,
    folder: Path | None = None,
    *,
    sets: Mapping[str, DataSet] | None = None,
    progress: Progress | None = None,
) -> Fetched:
    """Bring a data set to this machine: from LAGNET_DATA_DIR, else from upstream, else derived from its raw files.

    Args:
        name: name of the data set.
        folder: where its folder NAME shall lie; the user's cache where None.
        sets: the data sets known; the package's own where None.
        progress: told while downloading.

    Returns:
        Paths and notes. Local copies are used where they lie, unless `folder` is given.

    Raises:
        DataError: unknown name, failed download, wrong checksum, or nothing of the set can be had.
    """
    known = data_sets() if sets is None else sets
    if name not in known:
        near = closest(name, known)
        raise DataError(
            f"no data set is called {name!r}" + (f", did you mean {near!r}?" if near else ""), choices=known
        )
    return _Errand(known[name], (folder or cache_folder()) / name, folder is not None, progress).run()


@dataclass(frozen=True)
class _Errand:
    """Brings the files of one set, upstream files first, since others are derived from them."""

    data: DataSet
    folder: Path
    copy_local: bool
    progress: Progress | None

    def run(self) -> Fetched:
        paths: dict[str, Path] = {}
        notes: list[str] = []
        for file in sorted(self.data.files, key=lambda file: file.upstream is None):
            path = self._local(file) or self._cached(file) or self._upstream(file, notes) or self._derived(file, paths)
            if path is not None:
                paths[file.name] = path
        for name, recipe in RECIPES.get(self.data.name, {}).items():
            if name not in paths and all(raw in paths for raw in recipe.needs):
                paths[name] = recipe.write(self.folder / name, [paths[raw] for raw in recipe.needs])
        lacking = [file.name for file in self.data.files if file.name not in paths and file.upstream is None]
        if lacking:
            notes.append(f"available as a local copy only ({LOCAL_COPIES}): {', '.join(lacking)}")
        if not paths:
            raise DataError(
                f"{self.data.name} is not offered for download in a format that is safe to read",
                next_step=f"put {', '.join(f'{self.data.name}/{name}' for name in lacking)} in a folder"
                f" and name it in {LOCAL_COPIES}",
            )
        return Fetched(paths, tuple(notes))

    def _local(self, file: DataFile) -> Path | None:
        folder = os.environ.get(LOCAL_COPIES)
        path = Path(folder) / self.data.name / file.name if folder else None
        if path is None or not path.is_file():
            return None
        self._check(path, file, f"replace it, or take it out of {LOCAL_COPIES}")
        return self._copied(path, file) if self.copy_local else path

    def _copied(self, source: Path, file: DataFile) -> Path:
        target = self.folder / file.name
        target.parent.mkdir(parents=True, exist_ok=True)
        part = target.with_name(f".{target.name}.{os.getpid()}.part")
        try:
            shutil.copyfile(source, part)
            part.replace(target)
        finally:
            part.unlink(missing_ok=True)
        return target

    def _cached(self, file: DataFile) -> Path | None:
        path = self.folder / file.name
        right = path.is_file() and file.sha256 is not None and _sha256(path) == file.sha256
        return path if right else None

    def _upstream(self, file: DataFile, notes: list[str]) -> Path | None:
        if file.upstream is None:
            return None
        target = self.folder / file.name
        if file.sha256 is not None:
            return download(file.upstream, target, file.sha256, file.bytes, self.progress)
        return self._unchecked(file, target, notes)

    def _unchecked(self, file: DataFile, target: Path, notes: list[str]) -> Path | None:
        """A file without a stated checksum: it must at least hold what it should, and it may be missing."""
        try:
            path = download(str(file.upstream), target, None, None, self.progress)
        except DataError as error:
            notes.append(f"not fetched: {error}")
            return None
        try:
            _verify_content(path, file.note)
        except LagnetError as error:
            path.unlink(missing_ok=True)
            raise DataError(f"what the server sent is not {file.name}: {error.what}", where=file.upstream) from None
        notes.append(f"{file.name} has no published checksum; its content was checked. sha256 {_sha256(path)}")
        return path

    def _derived(self, file: DataFile, paths: dict[str, Path]) -> Path | None:
        recipe = RECIPES.get(self.data.name, {}).get(file.name)
        if recipe is None or any(raw not in paths for raw in recipe.needs):
            return None
        return recipe.write(self.folder / file.name, [paths[raw] for raw in recipe.needs])

    def _check(self, path: Path, file: DataFile, next_step: str) -> None:
        if file.sha256 is not None and _sha256(path) != file.sha256:
            raise DataError(f"does not have the sha256 {file.sha256}", where=str(path), next_step=next_step)


def _verify_content(path: Path, note: str) -> None:
    """The manifest's note states the shape of a file without checksum, e.g. "44484 x 28; ..."."""
    from lagnet.recordings.datasets.sarcos import load_sarcos

    rows = int(note.split("x", 1)[0])
    found = len(load_sarcos(path))
    if found != rows:
        raise DataError(f"holds {found} rows instead of {rows}")


def _sha256(path: Path) -> str:
    with path.open("rb") as stream:
        return hashlib.file_digest(stream, "sha256").hexdigest()
