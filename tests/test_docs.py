"""README and docs: links lead somewhere, code is code, what is generated is current, nothing names a machine."""

from __future__ import annotations

import ast
import json
import re
import subprocess
import sys
import tomllib
from importlib.metadata import entry_points
from pathlib import Path

import pytest
import typer

ROOT = Path(__file__).resolve().parents[1]
PAGES = sorted(
    [*ROOT.glob("*.md"), *ROOT.glob("docs/**/*.md"), *ROOT.glob("validation/*/README.md"), *ROOT.glob("data/*.md")]
)
LINK = re.compile(r"(?<!!)\[[^\]]*\]\(([^)\s]+)\)|!\[[^\]]*\]\(([^)\s]+)\)")
BLOCK = re.compile(r"^```(\w+)\n(.*?)^```", re.DOTALL | re.MULTILINE)
CODE = re.compile(r"^```.*?^```|`[^`\n]*`", re.DOTALL | re.MULTILINE)
COMMAND = re.compile(r"^(?:    |\$ )?lagnet (\w+)(.*)$", re.MULTILINE)


def page_id(page: Path) -> str:
    return str(page.relative_to(ROOT))


def blocks(page: Path, language: str) -> list[str]:
    return [code for found, code in BLOCK.findall(page.read_text(encoding="utf-8")) if found == language]


def anchors(page: Path) -> set[str]:
    """What GitHub makes of headings, and anchors set by hand."""
    text = page.read_text(encoding="utf-8")
    slugs = set(re.findall(r'<a id="([^"]+)"', text))
    for heading in re.findall(
        r"^#+ +(.+)$", CODE.sub(lambda m: m[0].strip("`") if m[0][:3] != "```" else "", text), re.M
    ):
        slugs.add(re.sub(r"[^\w\- ]", "", heading.strip().lower()).replace(" ", "-"))
    return slugs


@pytest.mark.parametrize("page", PAGES, ids=page_id)
def test_links_lead_somewhere(page: Path) -> None:
    text = CODE.sub("", page.read_text(encoding="utf-8"))
    for target in (a or b for a, b in LINK.findall(text)):
        if re.match(r"[a-z]+:", target):
            continue
        path, _, anchor = target.partition("#")
        there = (page.parent / path).resolve() if path else page
        assert there.exists(), f"{page_id(page)} links to {target}, which does not exist"
        assert not anchor or anchor in anchors(there), f"{page_id(page)} links to {target}, which has no such heading"


def test_every_page_of_docs_can_be_reached_from_its_index() -> None:
    seen, left = set(), [ROOT / "docs" / "index.md"]
    while left:
        page = left.pop()
        seen.add(page)
        found = {(page.parent / (a or b).partition("#")[0]).resolve() for a, b in LINK.findall(page.read_text())}
        left += [p for p in found if p.suffix == ".md" and p.exists() and p not in seen]
    assert set((ROOT / "docs").glob("*.md")) <= seen


@pytest.mark.parametrize("page", PAGES, ids=page_id)
def test_code_blocks_parse(page: Path) -> None:
    for code in blocks(page, "python"):
        ast.parse(code)
    for code in blocks(page, "toml"):
        tomllib.loads(code)
    for code in blocks(page, "json"):
        json.loads(code)


@pytest.mark.parametrize("page", PAGES, ids=page_id)
def test_python_blocks_import_what_exists(page: Path) -> None:
    for code in blocks(page, "python"):
        for node in ast.walk(ast.parse(code)):
            if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("lagnet"):
                module = __import__(node.module or "", fromlist=[a.name for a in node.names])
                assert all(hasattr(module, a.name) for a in node.names), f"{page_id(page)}: {ast.unparse(node)}"
            elif isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and node.value.id == "lagnet":
                assert hasattr(__import__("lagnet"), node.attr), f"{page_id(page)}: lagnet.{node.attr}"


@pytest.mark.parametrize("page", PAGES, ids=page_id)
def test_commands_and_options_exist(page: Path) -> None:
    from lagnet.cli.main import COMMANDS, load_command

    for name, rest in COMMAND.findall(page.read_text(encoding="utf-8")):
        if name not in COMMANDS:  # prose that begins a line with the name
            continue
        command = load_command(name)
        known = {o for p in command.params for o in (*p.opts, *p.secondary_opts)} | {"--help"}
        used = re.findall(r"(?<!\S)--[a-z][a-z-]*", rest)
        assert isinstance(command, typer.core.TyperGroup) or set(used) <= known, f"{page_id(page)}: lagnet {name}{rest}"


@pytest.mark.parametrize(
    "script", ["make_catalogue.py", "make_simulators.py", "make_confusion.py", "make_limits.py", "fill_figures.py"]
)
def test_what_is_generated_is_current(script: str) -> None:
    done = subprocess.run(
        [sys.executable, str(ROOT / "docs" / script), "--check"], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stdout + done.stderr


def test_every_source_of_an_effect_is_a_reference() -> None:
    from lagnet.effects.catalogue import CATALOGUE

    keys = anchors(ROOT / "docs" / "references.md")
    assert {e.source for e in CATALOGUE.values()} <= keys


def test_every_source_of_a_rule_is_a_reference() -> None:
    from lagnet.diagnosis.rules.catalogue import RULES

    assert {r.source for r in RULES if r.source} <= anchors(ROOT / "docs" / "references.md")


def test_the_picture_in_the_readme_is_a_picture_of_modest_size() -> None:
    picture = ROOT / "docs" / "images" / "report.png"
    assert "docs/images/report.png" in (ROOT / "README.md").read_text(encoding="utf-8")
    assert picture.read_bytes().startswith(b"\x89PNG")
    assert 50_000 < picture.stat().st_size <= 400 * 1024


def test_the_pytest_plugin_is_announced_under_the_documented_name() -> None:
    declared = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["entry-points"]["pytest11"]
    assert {e.name: e.value for e in entry_points(group="pytest11") if e.name == "lagnet"} == declared
