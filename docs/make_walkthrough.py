"""Diagnose the case of docs/how_a_diagnosis_works.md, draw its pictures and write its tables.

python docs/make_walkthrough.py        (about two minutes; run it when the diagnosis changes)
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np

from lagnet.diagnosis.diagnose import Diagnosis, diagnose
from lagnet.diagnosis.problem.residuals import residual_by_recording
from lagnet.diagnosis.selection.arm_search import views_of
from marked_regions import DOCS, replaced, write_or_check
from walkthrough_case import BEARING, CONTACT, FRICTION, PAYLOAD, PUSH, Case, make_case

mpl.use("Agg")
import matplotlib.pyplot as plt

PAGE = DOCS / "how_a_diagnosis_works.md"
PICTURES = DOCS / "images" / "walkthrough"
JOINT = 1  # whose friction is hidden
SHOWN = 8  # hypotheses in a picture
DOTS = 110  # an inch
BLUE, ORANGE, GREY = "#2b6cb0", "#c05621", "#718096"


def pictures(case: Case, result: Diagnosis) -> None:
    """Draw all of them."""
    PICTURES.mkdir(parents=True, exist_ok=True)
    drawn: dict[str, Callable[[Any, Case, Diagnosis], None]] = {
        "problem": draw_problem,
        "nominal": draw_sign,
        "regression": draw_hypotheses,
        "estimation": draw_intervals,
        "identifiability": draw_rivals,
        "unexplained": draw_remainder,
        "transients": draw_event,
        "verdict": draw_errors,
    }
    for name, draw in drawn.items():
        figure, axes = plt.subplots(figsize=(7.2, 2.9), layout="constrained")
        draw(axes, case, result)
        axes.spines[["top", "right"]].set_visible(False)
        figure.savefig(PICTURES / f"{name}.png", dpi=DOTS, metadata={"Software": None})
        plt.close(figure)


def draw_problem(axes: Any, case: Case, result: Diagnosis) -> None:
    """Recorded and nominal torque of one joint, and their difference."""
    problem = result.state.problem
    piece = problem.fit[0]
    time = piece.time[piece.keep]
    for signal, words, colour in ((piece.tau, "recorded F τ", "black"), (piece.load, "nominal F τ₀", BLUE)):
        axes.plot(time, problem.reduce(piece, signal)[:, JOINT], color=colour, label=words, lw=1.2)
    axes.plot(time, problem.residual(piece)[:, JOINT], color=ORANGE, label="residual r = F(τ − τ₀)", lw=1.2)
    noise = float(result.state.noise[JOINT])
    axes.axhspan(-noise, noise, color=GREY, alpha=0.5, label=f"noise floor ±{noise:.2g} N m")
    _named(axes, "time [s]", f"torque of {problem.joints[JOINT]} [N m]")


def draw_sign(axes: Any, case: Case, result: Diagnosis) -> None:
    """Residual of the friction joint over its speed, and s(v) with the fitted ε."""
    problem = result.state.problem
    others = [e for e in result.state.effects if e.joint != JOINT]
    series = residual_by_recording(problem, problem.fit, others)
    v = np.concatenate([s.motion.v[:, JOINT] for s in series])
    r = np.concatenate([s.residual[:, JOINT] for s in series])
    axes.plot(v, r, ".", color=GREY, ms=1.5, label="residual, other effects taken off")
    x, slow = np.linspace(-2.0, 2.0, 801), float(problem.slow[JOINT])
    straight = problem.straight is not None and bool(problem.straight[JOINT])
    sign = np.clip(x / slow, -1.0, 1.0) if straight else np.tanh(x / slow)
    axes.plot(x, FRICTION * sign, color=ORANGE, label=f"{FRICTION:g} N m · s(v), fitted ε = {slow:.2g} rad/s")
    axes.set_xlim(-2.0, 2.0)
    _named(axes, f"speed of {problem.joints[JOINT]} [rad/s]", "residual [N m]")


def draw_hypotheses(axes: Any, case: Case, result: Diagnosis) -> None:
    """Share of one joint's squared error that single hypotheses leave on blocks that they are not fitted to."""
    state = result.state
    view = views_of(state.equations, state.selection)[JOINT]
    library = state.library
    whole = view.error(())
    left = {i: view.error((i,)) / whole for i in library.local[JOINT]}
    best: dict[str, float] = {}
    for i, share in left.items():
        best[library.hypotheses[i].effect] = min(share, best.get(library.hypotheses[i].effect, np.inf))
    names = sorted(best, key=lambda n: best[n])[:SHOWN]
    axes.barh(names[::-1], [best[n] for n in names[::-1]], color=BLUE)
    axes.set_xscale("log")
    _named(axes, f"E / E(nothing) at {state.problem.joints[JOINT]}, payload taken off, log scale", "")


def draw_intervals(axes: Any, case: Case, result: Diagnosis) -> None:
    """Parameters over their true values, with 95 % intervals."""
    rows = _parameters(case, result)
    for y, (words, truth, value, (low, high)) in enumerate(reversed(rows)):
        ends = sorted((low / truth, high / truth))
        axes.errorbar(
            value / truth, y, xerr=[[value / truth - ends[0]], [ends[1] - value / truth]], fmt="o", color=BLUE
        )
        axes.text(0.0, y + 0.18, words, transform=axes.get_yaxis_transform(), fontsize=8, color=GREY)
    axes.axvline(1.0, color="black", lw=0.8)
    axes.set_yticks([])
    axes.set_ylim(-0.5, len(rows) - 0.3)
    _named(axes, "estimate over truth, with 95 % interval", "")


def draw_rivals(axes: Any, case: Case, result: Diagnosis) -> None:
    """Odds of the named effects over their closest rivals."""
    state = result.state
    rows = []
    for comparison in state.comparisons:
        h = state.library.hypotheses[comparison.index]
        rows += [(f"{h.effect} over {name}", odds) for name, odds in comparison.rivals[:3]]
    axes.barh([r[0] for r in rows[::-1]], [max(r[1], 0.0) for r in rows[::-1]], color=BLUE)
    limit = state.problem.limits.tie_odds
    axes.axvline(limit, color=ORANGE, label=f"tied below {limit:g}")
    axes.set_xscale("symlog", linthresh=limit)
    _named(axes, "log10 odds", "")


def draw_remainder(axes: Any, case: Case, result: Diagnosis) -> None:
    """What is left at the first joint over its strongest signal."""
    entry = result.evidence.joints[0].remainder
    assert entry is not None, "nothing is left that a signal predicts"
    axes.plot(entry.value, entry.residual, ".", color=GREY, ms=2, label="residual on held-out samples")
    axes.plot(entry.curve[:, 0], entry.curve[:, 1], color=ORANGE, label="median over bins")
    _named(axes, f"{entry.signal} (SI units)", f"left at {result.state.problem.joints[0]} [N m]")


def draw_event(axes: Any, case: Case, result: Diagnosis) -> None:
    """What the persistent effects leave in the recording with the contact."""
    state = result.state
    strand = residual_by_recording(state.problem, state.problem.fit, state.refit.effects)[1]
    for joint, name in enumerate(state.problem.joints):
        axes.plot(strand.time, strand.residual[:, joint], lw=1, label=f"residual of {name}")
    axes.axvspan(*CONTACT, color=GREY, alpha=0.25, label="hidden contact")
    for transient in state.transients:
        for edge in transient.effect.interval or ():
            axes.axvline(edge, color="black", ls="--", lw=1)
    _named(axes, "time [s]; dashed: interval found", "residual [N m]")


def draw_errors(axes: Any, case: Case, result: Diagnosis) -> None:
    """Held-out errors of every joint."""
    fit = result.verdict.fit
    at = np.arange(len(fit))
    bars = (
        ("nominal model", [f.nmse_nominal for f in fit], GREY),
        ("with the named effects", [f.nmse_named for f in fit], BLUE),
        ("noise floor", [f.nmse_noise_floor for f in fit], ORANGE),
    )
    for k, (words, values, colour) in enumerate(bars):
        axes.bar(at + 0.27 * (k - 1), values, 0.25, color=colour, label=words)
    axes.set_yscale("log")
    axes.set_xticks(at, [f.joint for f in fit])
    _named(axes, "", "held-out nMSE [1]")


def _named(axes: Any, x: str, y: str) -> None:
    axes.set_xlabel(x)
    axes.set_ylabel(y)
    if axes.get_legend_handles_labels()[1]:
        axes.legend(fontsize=8, frameon=False, loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=4)


def _parameters(case: Case, result: Diagnosis) -> list[tuple[str, float, float, tuple[float, float]]]:
    """Words, truth, estimate and interval of the hidden parameters that are not zero and were estimated."""
    joints = result.state.problem.joints
    truth = {(e.effect, None if e.joint is None else joints[e.joint]): e.parameters() for e in case.hidden}
    out = []
    for effect in result.effects:
        true = truth.get((effect.effect, effect.joint), {})
        for p in effect.parameters:
            if abs(true.get(p.name, 0.0)) > 0.01:
                out.append((f"{effect.effect} {p.name} [{p.unit}]", true[p.name], p.value, p.ci95))
    return out


def tables(case: Case, result: Diagnosis) -> dict[str, str]:
    """The regions of the page."""
    state = result.state
    rejected = [
        ("–" if r.joint is None else state.problem.joints[r.joint], f"`{r.rule}` | {r.value:.3g} | {r.limit:.3g}", r)
        for r in state.rejected
    ]
    rows = _parameters(case, result)
    named = [f"- {e.explanation}" for e in result.effects]
    left = [
        (u.joint, f"{100 * u.share_of_mismatch:.2g} %", ", ".join(u.depends_on) or "–", u.formula or "–")
        for u in result.verdict.unexplained
        if u.above_noise
    ]
    problem = state.problem
    fitted, held = (sum(p.keep.size for p in pieces) for pieces in (problem.fit, problem.holdout))
    facts = (
        f"Here: {problem.n_dof} joints, bandwidth {problem.bandwidth:.3g} Hz, {fitted} samples to fit and {held} held "
        f"out, {len(state.library.hypotheses)} hypotheses."
    )
    lasting = f"a payload of {PAYLOAD:g} kg; Coulomb friction of {FRICTION:g} N m at {problem.joints[JOINT]}"
    acting = f"from {CONTACT[0]:g} to {CONTACT[1]:g} s of the second recording a push of {PUSH:g} N"
    unlisted = (
        f"friction at {problem.joints[0]} that depends on the angle of {problem.joints[1]}, {BEARING:g} q_1 s(v_0) N m"
    )
    hidden = f"Hidden from it: {lasting}; {acting}; and, in no catalogue, {unlisted}."
    return {
        "hidden": hidden,
        "facts": facts,
        "rejected": _table(
            ("effect", "joint", "rule", "value", "limit", "in words"),
            [(f"`{r.effect}`", joint, figures, r.detail) for joint, figures, r in rejected],
        ),
        "estimates": _table(
            ("parameter", "truth", "estimate", "95 % interval"),
            [(w, f"{t:.3g}", f"{v:.4g}", f"{low:.4g} … {high:.4g}") for w, t, v, (low, high) in rows],
        ),
        "left": _table(("joint", "left of its mismatch", "depends on", "formula"), left),
        "named": "\n".join(named),
    }


def _table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    return "\n".join(f"| {' | '.join(row)} |" for row in (head, ["---"] * len(head), *rows))


def pages(case: Case, result: Diagnosis) -> dict[Path, str]:
    """The page with its regions written anew."""
    text = PAGE.read_text(encoding="utf-8")
    for name, words in tables(case, result).items():
        text = replaced(text, name, words, PAGE.name)
    return {PAGE: text}


def main() -> int:
    """Diagnose, draw and write."""
    case = make_case()
    result = diagnose(case.fit, case.robot, case.holdout)
    pictures(case, result)
    return write_or_check(pages(case, result), "python docs/make_walkthrough.py")


if __name__ == "__main__":
    sys.exit(main())
