"""The verdict in words: whether the arm differs from the model, what was left out, how far the fit gets."""

from __future__ import annotations

from typing import Any

from lagnet.diagnosis.verdict.wording import BESIDE_FREE_LINKS
from lagnet.effects.catalogue import CATALOGUE
from lagnet.reports.contents.findings import Findings, place
from lagnet.reports.held_out_error import error_falls
from lagnet.reports.page import Section, section
from lagnet.reports.wording import counted, effect_words, listed, percent, unit_words, with_interval

SHOWN_PARAMETERS = 4  # of one effect in one line; the table of parameters holds all
LINKS = (
    "Several of its links differ at once: what these recordings determine of their inertia is identified, "
    "not attributed to one of them."
)
TRIFLE = 1e-4  # of the torque's variance: what the page writes as "< 0.01 %"


def build(findings: Findings) -> Section:
    """Some sentences, four figures to remember, and one line for each effect."""
    return section(
        "headline",
        "",
        state=_state(findings),
        sentences=_sentences(findings),
        tiles=_tiles(findings),
        causes=_causes(findings),
        remainder=_remainder(findings),
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
    where = f"{len(differing)} of {n} joints" if len(differing) < n else "its joint" if n == 1 else f"all {n} joints"
    sentences = [f"The arm differs from the model on {where}."]
    sentences += [LINKS] if BESIDE_FREE_LINKS in findings.verdict["warnings"] else []
    if not findings.effects:
        sentences += ["No physics of the catalogue explains the difference beyond doubt.", *_unjudged(findings)]
    else:
        sentences += _left_out(findings)
    return [*sentences, *filter(None, [error_falls(findings)])]


def _unjudged(findings: Findings) -> list[str]:
    """The hypotheses that the recordings could not test, as the likeliest place of what is missing."""
    names = dict.fromkeys(effect_words(entry["effect"]) for entry in findings.verdict["abstentions"])
    return [f"These recordings cannot judge {listed(list(names))}."] if names else []


def _left_out(findings: Findings) -> list[str]:
    """What the model lacks, and what the arm has less of."""
    more, less = ([e for e in findings.effects if is_less(e) == asked] for asked in (False, True))
    told = (("Left out", more), ("Less than modelled", less))
    return [f"{lead}: {_gathered(findings, effects)}." for lead, effects in told if effects]


def is_less(effect: dict[str, Any]) -> bool:
    """Whether the arm has less of a law than its nominal model."""
    law = CATALOGUE.get(effect["effect"])
    return law is not None and law.is_less({p["name"]: p["value"] for p in effect["parameters"]})


def _gathered(findings: Findings, effects: list[dict[str, Any]]) -> str:
    """Effects with their values if there are few, else gathered by the joints they share."""
    if len(effects) <= 3:
        return listed(
            [
                f"{effect_words(e['effect'])} on {place(e['joint'])} ({', '.join(_values(e))}{_ties([e], ', ')})"
                for e in effects
            ]
        )
    by_places: dict[tuple[str | None, ...], list[str]] = {}
    for (name, _), group in _by_name(findings, effects).items():
        places = tuple(effect["joint"] for effect in group)
        by_places.setdefault(places, []).append(effect_words(name) + (f" ({_ties(group)})" if _ties(group) else ""))
    return "; ".join(f"{listed(words)} on {_on(places, findings)}" for places, words in by_places.items())


def _ties(effects: list[dict[str, Any]], before: str = "") -> str:
    """The rivals of those effects that are tied, and where, if not all are."""
    tied = [effect for effect in effects if effect["tied_with"]]
    rivals = dict.fromkeys(effect_words(rival) for effect in tied for rival in effect["tied_with"])
    where = f"on {listed([place(e['joint']) for e in tied])} " if len(tied) < len(effects) else ""
    return f"{before}{where}tied with {listed(list(rivals))}" if tied else ""


def _tiles(findings: Findings) -> list[dict[str, str]]:
    """Four figures to remember."""
    named = sum(effect["status"] == "named" for effect in findings.effects)
    tied = len(findings.effects) - named
    tiles = [
        _tile(f"{len(findings.differing)} of {len(findings.joints)}", "joints differ from the model"),
        _tile(str(named), f"effect{'' if named == 1 else 's'} named" + (f", {tied} tied with rivals" if tied else "")),
        *_gain(findings),
    ]
    remainder = _remainder(findings)
    if not remainder:
        return [*tiles, _tile("0", "joints keep more than 0.01 % of their torque unexplained")]
    most = max(remainder, key=lambda r: r["share_of_mismatch"] * findings.fit(r["joint"])["nmse_nominal"])
    rest = f", the most of {counted(len(remainder), 'joint')}" if len(remainder) > 1 else ""
    return [
        *tiles,
        _tile(percent(most["share_of_mismatch"]), "of the mismatch stays unexplained on", most["joint"], rest),
    ]


def _tile(value: str, words: str, joint: str = "", rest: str = "") -> dict[str, str]:
    return {"value": value, "words": words, "joint": joint, "rest": rest}


def _gain(findings: Findings) -> list[dict[str, str]]:
    """The joint whose held-out error falls most; where nothing was named, the one with the largest error."""
    fits = findings.verdict["fit"]
    if not fits:
        return []
    best = max(fits, key=lambda fit: fit["nmse_nominal"] - fit["nmse_named"])
    if findings.effects:
        change = f"{percent(best['nmse_nominal'])} → {percent(best['nmse_named'])}"
        return [_tile(change, "held-out torque error of", best["joint"])]
    worst = max(fits, key=lambda fit: fit["nmse_nominal"])
    rest = f", the largest; noise alone would leave {percent(worst['nmse_noise_floor'])}"
    return [_tile(percent(worst["nmse_nominal"]), "held-out torque error of", worst["joint"], rest)]


def _causes(findings: Findings) -> list[dict[str, Any]]:
    causes = []
    for (name, less), effects in _by_name(findings, findings.effects).items():
        entries = [{"place": place(e["joint"]), "values": _values(e), "tied_with": e["tied_with"]} for e in effects]
        advice = [effect["explanation"] for effect in effects if effect["joint"] is None]
        causes.append({"name": name, "less": less, "entries": entries, "advice": advice})
    return causes


def _by_name(findings: Findings, effects: list[dict[str, Any]]) -> dict[tuple[str, bool], list[dict[str, Any]]]:
    """Effects of one kind and sign together, the strongest kind first, each in the order of the joints."""
    groups: dict[tuple[str, bool], list[dict[str, Any]]] = {}
    for effect in effects:
        groups.setdefault((effect["effect"], is_less(effect)), []).append(effect)
    order = {joint: index for index, joint in enumerate(findings.joints)}
    return {name: sorted(group, key=lambda e: order.get(e["joint"], -1)) for name, group in groups.items()}


def _on(places: tuple[str | None, ...], findings: Findings) -> str:
    if len(places) > 2 and set(places) == set(findings.differing):
        return "each of these"
    return listed([place(joint) for joint in places]) if len(places) < 3 else counted(len(places), "joint")


def _values(effect: dict[str, Any]) -> list[str]:
    law, found = CATALOGUE.get(effect["effect"]), {p["name"]: p["value"] for p in effect["parameters"]}
    told = [*found] if law is None else law.told(found)
    parameters = [p for p in effect["parameters"] if p["name"] in told]
    alone = len(parameters) == 1
    words = [
        ("" if alone else f"{p['name']} ") + f"{with_interval(p['value'], *p['ci95'])} {unit_words(p['unit'])}".rstrip()
        for p in parameters[:SHOWN_PARAMETERS]
    ]
    form = law.remark(found) if law is not None and law.settled else ""
    words.extend([form] if form else [])
    interval = effect.get("interval_s")
    if interval:
        words.append(f"from {interval[0]:.4g} s to {interval[-1]:.4g} s")
    return [*words, "…"] if len(parameters) > SHOWN_PARAMETERS else words


def _remainder(findings: Findings) -> list[dict[str, Any]]:
    """What is left above the noise and is no trifle, the largest share first; the table further down holds all."""
    left = [entry for entry in findings.verdict["unexplained"] if entry["above_noise"] and _matters(findings, entry)]
    return sorted(left, key=lambda entry: -entry["share_of_mismatch"])


def _matters(findings: Findings, entry: dict[str, Any]) -> bool:
    """Whether the rest is more of the torque than the page tells from nothing."""
    return entry["share_of_mismatch"] * findings.fit(entry["joint"])["nmse_nominal"] >= TRIFLE
