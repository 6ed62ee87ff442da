"""Share of each term in the torque of each joint."""

from __future__ import annotations

from lagnet.decomposition.decompose import Decomposition
from lagnet.reports.figures.figure import Figure, axis, colour, names_axis, plain
from lagnet.reports.page import Section, section
from lagnet.reports.wording import effect_words, percent

ROLES = {"inertial": "series-1", "coriolis": "series-4", "gravity": "series-3", "residual": "series-2"}


def build(parts: Decomposition) -> Section:
    """Bars that add up to one; a term that works against the others reaches to the left of zero."""
    names = [plain(joint) for joint in parts.joints]
    traces = [
        {
            "type": "bar", "orientation": "h", "y": names, "x": share.tolist(), "name": effect_words(name),
            "marker": {"color": colour(ROLES[name])}, "text": [percent(float(x)) for x in share],
            "textposition": "none", "hovertemplate": f"{effect_words(name)} %{{x:.1%}}<extra></extra>",
        }
        for name, share in parts.shares.items()
    ]  # fmt: skip
    layout = {
        "barmode": "relative",
        "xaxis": axis("share of the torque's power", "–", tickformat=".0%"),
        "yaxis": names_axis(autorange="reversed"),
    }
    figure = Figure("shares", traces, "Share of each term in the torque of each joint", layout, 150 + 34 * parts.n_dof)
    return section("decomposition_shares", "Share of each part", [figure])
