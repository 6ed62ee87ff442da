"""The verdict in words: whether the arm differs from the model, what was left out, how far the fit gets."""

from __future__ import annotations

from statistics import median
from typing import Any

from lagnet.reports.findings import Findings, place
from lagnet.reports.page import Section, section
from lagnet.reports.wording import counted, effect_words, listed, percent, unit_words, with_interval

SHOWN_PARAMETERS = 4  # of one effect in one line; the table of parameters holds all


def build(findings: Findings) -> Section:
    """Some sentences, four figures to remember, and one line for each effect."""
    return section(
        "headline",
        "",
        state=_state(findings),
        sentences=_sentences(findings),
        tiles=_tiles(findings),
        causes=_causes(findings),
        remainder=[findings.unexplained(joint) for joint in _remaining(findings)],
        n_abstentions=len(findings.verdict["abstentions"]),
        warnings=findings.verdict["warnings"],
    )


def _state(findings: Findings) -> str:
    if not findings.verdict["mismatch"]["found"]:
        return "agree"
    return "explained" if findings.effects else "unnamed"


def _sentences(findings: Findings) -> list[str]:
    n, differing = len(findings.joints), findings.differing
    if not findings.verdict["mismatch"]["found"]:
        which = "on its joint the torque error is not" if n == 1 else f"on none of its {n} joints is the torque error"
        return [f"The arm agrees with the model: {which} larger than sensor noise and differentiation explain."]
    where = "its only joint" if n == 1 else f"{len(differing)} of {n} joints"
    sentences = [f"The arm differs from the model on {where}."]
    if not findings.effects:
        return [*sentences, "No physics of the catalogue explains the difference beyond doubt."]
    return [*sentences, _left_out(findings), _improvement(findings)]


def _left_out(findings: Findings) -> str:
    """Effects with their values if there are few, else with the number of their joints."""
    if len(findings.effects) <= 3:
        parts = [f"{_name(effect)} on {place(effect['joint'])} ({_values(effect)})" for effect in findings.effects]
    else:
        parts = [f"{words} on {_on(effects)}" for words, effects in _by_name(findings).items()]
    return f"Left out: {listed(parts)}."


def _improvement(findings: Findings) -> str:
    fits = [findings.fit(joint) for joint in findings.differing or findings.joints]
    before, after = [fit["nmse_nominal"] for fit in fits], [fit["nmse_named"] for fit in fits]
    if len(fits) == 1:
        return f"Held-out torque error falls from {percent(before[0])} to {percent(after[0])}."
    return (
        f"Held-out torque error falls from {percent(median(before))} to {percent(median(after))} "
        f"(median of the joints that differ)."
    )


def _tiles(findings: Findings) -> list[dict[str, str]]:
    named = sum(effect["status"] == "named" for effect in findings.effects)
    tied = len(findings.effects) - named
    remaining = _remaining(findings)
    tiles = [
        {"value": f"{len(findings.differing)} of {len(findings.joints)}", "words": "joints differ from the model"},
        {"value": str(named), "words": "effects named" + (f", {tied} tied with rivals" if tied else "")},
    ]
    if findings.verdict["fit"]:
        best = max(findings.verdict["fit"], key=lambda fit: fit["nmse_nominal"] - fit["nmse_named"])
        tiles.append(
            {
                "value": f"{percent(best['nmse_nominal'])} → {percent(best['nmse_named'])}",
                "words": f"held-out torque error of {best['joint']}",
            }
        )
    words = "joints keep something unexplained" if len(remaining) != 1 else "joint keeps something unexplained"
    return [*tiles, {"value": str(len(remaining)), "words": words}]


def _causes(findings: Findings) -> list[dict[str, Any]]:
    causes = []
    for words, effects in _by_name(findings).items():
        entries = [{"place": place(effect["joint"]), "values": _values(effect)} for effect in effects]
        cause = {"words": words, "name": effects[0]["effect"], "tied": effects[0]["tied_with"], "entries": entries}
        causes.append({**cause, "advice": [effect["explanation"] for effect in effects if effect["joint"] is None]})
    return causes


def _by_name(findings: Findings) -> dict[str, list[dict[str, Any]]]:
    groups: dict[str, list[dict[str, Any]]] = {}
    for effect in findings.effects:
        groups.setdefault(_name(effect), []).append(effect)
    return groups


def _name(effect: dict[str, Any]) -> str:
    """The effect's name in words, with those of the rivals that explain as much."""
    return " or ".join(effect_words(name) for name in (effect["effect"], *effect["tied_with"]))


def _on(effects: list[dict[str, Any]]) -> str:
    joints = [effect["joint"] for effect in effects]
    return place(joints[0]) if len(joints) == 1 else counted(len(joints), "joint")


def _values(effect: dict[str, Any]) -> str:
    parameters = effect["parameters"]
    alone = len(parameters) == 1
    words = [
        ("" if alone else f"{p['name']} ") + f"{with_interval(p['value'], *p['ci95'])} {unit_words(p['unit'])}".rstrip()
        for p in parameters[:SHOWN_PARAMETERS]
    ]
    interval = effect.get("interval_s")
    if interval:
        words.append(f"from {interval[0]:.4g} s to {interval[-1]:.4g} s")
    return ", ".join(words) + (" …" if len(parameters) > SHOWN_PARAMETERS else "")


def _remaining(findings: Findings) -> list[str]:
    return [entry["joint"] for entry in findings.verdict["unexplained"] if entry["above_noise"]]
