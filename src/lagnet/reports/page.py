"""Bind sections and plots to one self-contained HTML page that needs no network.

Every page carries a content security policy: only the scripts written here run, named by their hashes, and nothing can
be fetched. Templates escape whatever comes from files; the data of plots travel as JSON that cannot close its tag.
"""

from __future__ import annotations

import base64
import hashlib
import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Any

from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup

from lagnet.files import write_whole
from lagnet.reports.figures.figure import Figure
from lagnet.reports.wording import FILTERS


@dataclass(frozen=True)
class Section:
    """One part of a page.

    Args:
        key: its anchor.
        title: its heading; none if empty.
        body: its rendered content.
        figures: the plots placed in it.
        half: whether it may share a row with its neighbour on a wide screen.
        scripts: names of further scripts of the theme that it needs.
    """

    key: str
    title: str
    body: Markup
    figures: Sequence[Figure] = ()
    half: bool = False
    scripts: Sequence[str] = ()


def section(
    key: str,
    title: str,
    figures: Sequence[Figure] = (),
    half: bool = False,
    scripts: Sequence[str] = (),
    **context: Any,
) -> Section:
    """Render the template `KEY.html.j2` of a section; its plots are at hand there by their keys as `figures`."""
    context = {**context, "figures": {figure.key: figure for figure in figures}}
    return Section(key, title, render(f"{key}.html.j2", **context), figures, half, scripts)


def render(template: str, **context: Any) -> Markup:
    """Fill a template of this package; whatever is not markup of ours is escaped."""
    return Markup(_environment().get_template(template).render(**context))


def page(
    title: str,
    subtitle: str,
    sections: Sequence[Section],
    data: Mapping[str, Any] | None = None,
    script: str | None = None,
) -> str:
    """The page as one string of HTML.

    Args:
        title: heading and name of the page.
        subtitle: one line below it, e.g. the robot and the recordings.
        sections: the parts in order of reading; the headings make the table of contents.
        data: plain values for the page's own script, by the id under which it finds them.
        script: file of the theme that draws from them; none for pages whose plots are figures alone.
    """
    figures = {figure.key: figure.specification() for part in sections for figure in part.figures}
    own = dict.fromkeys([*(name for part in sections for name in part.scripts), *([script] if script else [])])
    scripts = [*([_plotly()] if figures else []), _theme("report.js"), *map(_theme, own)]
    return render(
        "base.html.j2",
        title=title,
        subtitle=subtitle,
        sections=sections,
        style=Markup(_theme("report.css")),
        data={"figures": json_for_script(figures)} | {k: json_for_script(v) for k, v in (data or {}).items()},
        scripts=[Markup(script) for script in scripts],
        policy=_policy(scripts),
    )


def write_page(
    path: str | Path,
    title: str,
    subtitle: str,
    sections: Sequence[Section],
    data: Mapping[str, Any] | None = None,
    script: str | None = None,
) -> Path:
    """Write the page in one step, so that an interrupted run leaves no half of it; see `page`."""
    return write_whole(path, page(title, subtitle, sections, data, script))


def json_for_script(content: Any) -> Markup:
    """JSON that may stand inside a script tag: no character of it can end the tag; numbers not finite become null."""
    text = json.dumps(_finite(content), allow_nan=False, separators=(",", ":"))  # ASCII: also no U+2028
    for character in "<>&":
        text = text.replace(character, f"\\u{ord(character):04x}")
    return Markup(text)


def _finite(node: Any) -> Any:
    if isinstance(node, float):
        return node if math.isfinite(node) else None
    if isinstance(node, Mapping):
        return {str(name): _finite(value) for name, value in node.items()}
    if isinstance(node, list | tuple):
        return [_finite(value) for value in node]
    return _finite(node.tolist()) if hasattr(node, "tolist") else node


def _policy(scripts: Sequence[str]) -> str:
    digests = (base64.b64encode(hashlib.sha256(script.encode()).digest()).decode() for script in scripts)
    allowed = " ".join(f"'sha256-{digest}'" for digest in digests)
    return (
        f"default-src 'none'; script-src {allowed}; style-src 'unsafe-inline'; img-src data: blob:; "
        "base-uri 'none'; form-action 'none'"
    )


@cache
def _environment() -> Environment:
    environment = Environment(
        loader=PackageLoader("lagnet.reports", "templates"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters.update(FILTERS)
    return environment


@cache
def _theme(name: str) -> str:
    return files("lagnet.reports").joinpath("theme", name).read_text(encoding="utf-8")


@cache
def _plotly() -> str:
    return files("plotly").joinpath("package_data", "plotly.min.js").read_text(encoding="utf-8")
