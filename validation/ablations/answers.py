"""The verdict on a plant without a rule or step, each kept in a file of its own."""

from __future__ import annotations

import json
import time
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from lagnet.diagnosis.diagnose import diagnose
from lagnet.diagnosis.rules.rule import RejectionRule
from lagnet.files import write_whole
from validation.ablations.kept_plants import KeptPlant
from validation.ablations.names_alone import NAMES_ALONE
from validation.ablations.patience import patience
from validation.ablations.remembered import Memory, remembered
from validation.ablations.table import NOTHING, Ablation
from validation.ablations.taken_out import Instead, taken_out
from validation.ablations.watched import Effects, watched_places, watched_rules


@dataclass
class Asked:
    """A plant that is asked without one thing after the other.

    Args:
        plant: recordings and truth.
        home: where its verdicts are kept, a file an ablation.
        watched: ablations whose effect in the whole diagnosis is noted.
    """

    plant: KeptPlant
    home: Path
    watched: Sequence[Ablation]
    memory: Memory = field(default_factory=Memory)
    _read: Any = None

    def whole(self) -> dict:
        """The verdict of the whole diagnosis, with what had an effect in it."""
        file = self._file(NOTHING)
        if not file.exists():
            seen = Effects()
            rules = watched_rules(NOTHING.rules, self.watched, seen)
            kept = self._diagnosed(NOTHING, rules, watched_places(self.watched, seen), self.memory)
            _write(file, kept | {"effects": seen.to_json()})
        return _read(file)

    def has_effect(self, ablation: Ablation) -> bool:
        """Whether an ablation may change the verdict; a whole diagnosis without a verdict says nothing of that."""
        whole = self.whole()
        return whole["verdict"] is None or Effects.from_json(whole["effects"]).of(ablation)

    def without(self, ablation: Ablation) -> dict:
        """The verdict under an ablation."""
        file = self._file(ablation)
        if not file.exists():
            _write(file, self._diagnosed(ablation, ablation.rules, ablation.instead, self.memory))
        return _read(file)

    def afresh(self, ablation: Ablation) -> dict:
        """The same with nothing remembered, to hold it against the verdict of the whole diagnosis."""
        file = self.home / "afresh" / self._file(ablation).name
        if not file.exists():
            _write(file, self._diagnosed(ablation, ablation.rules, ablation.instead, Memory()))
        return _read(file)

    def _file(self, ablation: Ablation) -> Path:
        return file_of(self.home, ablation)

    def _diagnosed(self, ablation: Ablation, rules: Sequence[RejectionRule], steps: Instead, memory: Memory) -> dict:
        robot, recordings = self._recordings()
        began, message, verdict = time.process_time(), "", None
        try:
            with taken_out(NAMES_ALONE), remembered(memory, ablation.instead), taken_out(steps), patience():
                found = diagnose(recordings[:-1], robot, recordings[-1:], rules=rules, limits=ablation.limits)
                verdict = found.verdict.to_dict()
        except Exception as error:  # what a rule protects from may be a breakdown
            message = f"{type(error).__name__}: {error}"
        return {"verdict": verdict, "message": message, "processor_seconds": time.process_time() - began}

    def _recordings(self) -> tuple[Any, list]:
        """Read once: what is remembered of a plant is known by its robot."""
        self._read = self._read or self.plant.read()
        return self._read


def file_of(home: Path, ablation: Ablation) -> Path:
    """Where the verdict of a plant under an ablation is kept."""
    return home / f"{ablation.name.replace(' ', '_')}.json"


def same_verdict(one: dict, other: dict) -> bool:
    """Whether two answers are one verdict, to the last digit, but for the limits that they tell."""
    pair = [x["verdict"] for x in (one, other)]
    return None not in pair and without_limits(pair[0]) == without_limits(pair[1])


def without_limits(verdict: dict) -> dict:
    """All that was decided; a rejection without the limit that decided it and the words on that."""
    rejected = [{k: v for k, v in r.items() if k not in ("value", "limit", "detail")} for r in verdict["rejected"]]
    return {k: v for k, v in verdict.items() if k != "limits"} | {"rejected": rejected}


def _write(file: Path, content: dict) -> None:
    file.parent.mkdir(parents=True, exist_ok=True)
    write_whole(file, json.dumps(content).encode())


def _read(file: Path) -> dict:
    return json.loads(file.read_text())
