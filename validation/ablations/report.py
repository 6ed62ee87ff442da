"""The result of what is finished: rules and steps to result.json, limits to limits.json, a figure and a table."""

from __future__ import annotations

import json
import platform
from collections.abc import Mapping, Sequence
from importlib.metadata import version
from pathlib import Path

from validation.ablations.answers import file_of, same_verdict
from validation.ablations.figure import draw
from validation.ablations.gains import Gain, Row, Told, gain_of, kind_of
from validation.ablations.kept_plants import opened_plant
from validation.ablations.limit_table import FACTORS, LIMITS_OF_RULES, SHARED_LIMITS, name_of
from validation.ablations.table import ABLATIONS, NOTHING, Ablation
from validation.ablations.watched import Effects
from validation.concealed.code import fingerprint
from validation.concealed.scoring import score

CODE = fingerprint()  # of the source as it is when the study starts
Folders = Mapping[str, Mapping[int, Path]]
"""By kind and number of a plant, where its verdicts are."""


class Finished:
    """All plants of one kind with their verdicts."""

    def __init__(self, folders: Mapping[int, Path], plants: Path) -> None:
        self.whole: dict[Path, dict] = {}
        self._plants: dict[Path, Path] = {}
        self._told: dict[Path, Told] = {}
        for number, folder in folders.items():
            if file_of(folder, NOTHING).exists():
                self.whole[folder] = json.loads(file_of(folder, NOTHING).read_text())
                self._plants[folder] = plants / f"plant_{number:04d}"

    def gain(self, ablation: Ablation) -> Gain | None:
        """What an ablation does on those plants for which it is known; None: on none."""
        pairs, unaffected = [], 0
        for folder, whole in self.whole.items():
            file = file_of(folder, ablation)
            idle = not _has_effect(whole, ablation)
            if idle or file.exists():
                own = file_of(folder, NOTHING)
                pairs.append((self._scored(folder, own), self._scored(folder, own if idle else file)))
                unaffected += idle
        return gain_of(pairs, unaffected) if pairs else None

    def checks(self) -> list[bool]:
        """Of verdicts that were run though nothing that was taken out had an effect, whether they are the same."""
        found = [(f, w) for folder, w in self.whole.items() for f in sorted((folder / "afresh").glob("*.json"))]
        return [same_verdict(json.loads(file.read_text()), whole) for file, whole in found]

    def _scored(self, folder: Path, file: Path) -> Told:
        """One plant's verdict against the truth; gains of corrected models are not asked for."""
        if file not in self._told:
            kept = json.loads(file.read_text())
            spent = kept["processor_seconds"]
            outcome = {"seconds": spent, "processor_seconds": spent, "message": kept["message"], "code": CODE}
            outcome |= {"gain_share": None, "gain_share_with_rest": None}
            plant = opened_plant(self._plants[folder])
            mismatch = kept["verdict"] is not None and kept["verdict"]["mismatch"]["found"]
            self._told[file] = Told(score(plant.plan, plant.witness, kept["verdict"], outcome), mismatch)
        return self._told[file]


def _has_effect(whole: dict, ablation: Ablation) -> bool:
    if ablation is NOTHING:
        return False
    return whole["verdict"] is None or Effects.from_json(whole["effects"]).of(ablation)


def report(folders: Folders, plants: Mapping[str, Path], seeds: Mapping[str, int], home: Path) -> bool:
    """Write the result files and the figure, print the table; whether every rule that was measured earned its place."""
    finished = {kind: Finished(own, plants[kind]) for kind, own in folders.items()}
    rows = rows_of(finished, ABLATIONS)
    idle = [row.name for row in rows if kind_of(row.name) == "rule" and not row.earns]
    checks = {kind: one.checks() for kind, one in finished.items()}
    content = {
        "study": {"command": "python -m validation.ablations.study", "seeds": dict(seeds)},
        "versions": {"lagnet": version("lagnet"), "pin": version("pin"), "python": platform.python_version()},
        "code": CODE,
        "plants": {kind: len(one.whole) for kind, one in finished.items()},
        "without_effect_run_nevertheless": {k: {"runs": len(c), "same_verdict": sum(c)} for k, c in checks.items()},
        "rules": {row.name.replace(" ", "_"): row.told() for row in rows},
        "rules_that_buy_nothing": idle,
        "rules_that_rejected_nothing": _idle_everywhere(rows),
        "steps_that_buy_nothing": [r.name for r in rows if kind_of(r.name) == "step" and not r.earns],
        "pass_line_kept": not idle and all(all(c) for c in checks.values()),
    }
    (home / "result.json").write_text(json.dumps(content, indent=1) + "\n")
    limits = rows_of(finished, (*SHARED_LIMITS, *LIMITS_OF_RULES))
    (home / "limits.json").write_text(json.dumps(limits_told(limits), indent=1) + "\n")
    draw(home / "result.json", home / "figure.png")
    for row in (*rows, *limits):
        for kind, gain in row.kinds.items():
            print(f"{row.name[:60]:60s} {kind:9s} {gain.line()}")
    return bool(content["pass_line_kept"])


def rows_of(finished: Mapping[str, Finished], ablations: Sequence[Ablation]) -> list[Row]:
    """Those ablations that some plant was asked under."""
    out = []
    for ablation in ablations:
        gains = {kind: gain for kind, one in finished.items() if (gain := one.gain(ablation)) is not None}
        if gains:
            out.append(Row(ablation.name, ablation.instead_of, gains))
    return out


def limits_told(rows: Sequence[Row]) -> dict[str, dict[str, dict]]:
    """By limit and change, the figures of each kind: of the diagnosis as it is, and with the limit changed."""
    known = {row.name: row for row in rows}
    names = dict.fromkeys(row.name.rpartition(" at ")[0] for row in rows)
    return {limit: {c: _change(row) for c in FACTORS if (row := known.get(name_of(limit, c)))} for limit in names}


def _change(row: Row) -> dict:
    kinds = {
        kind: {"whole": g.whole, "changed": g.figures, "plants_without_effect": g.unaffected}
        for kind, g in row.kinds.items()
    }
    for kind, gain in row.kinds.items():
        kinds[kind] |= {"plants_better": gain.plants_worse, "plants_worse": gain.plants_better, "claims": gain.claims}
    return {"values": row.instead_of} | kinds


def _idle_everywhere(rows: Sequence[Row]) -> list[str]:
    own = (row for row in rows if kind_of(row.name) == "rule")
    return [row.name for row in own if all(g.unaffected == g.figures["plants"] for g in row.kinds.values())]
