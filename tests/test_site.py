"""The documentation site: built strictly, complete, read and searched from files without a request to anywhere."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from collections.abc import Callable
from html import unescape
from pathlib import Path
from typing import Any
from urllib.parse import urldefrag

import pytest

ROOT = Path(__file__).resolve().parents[1]
BUILT = os.environ.get("LAGNET_SITE")  # a site that `make site` has just built
LOADED = re.compile(r"<(?:script|img|iframe|source)[^>]* src=\"?([^\"\s>]+)|<link[^>]* href=\"?([^\"\s>]+)")
LINK = re.compile(r"<a [^>]*href=\"([^\"]+)\"")


@pytest.fixture(scope="session")
def site(tmp_path_factory) -> Path:
    """The built site."""
    if BUILT:
        return (ROOT / BUILT).resolve()
    out = tmp_path_factory.mktemp("site")
    command = [sys.executable, "-m", "mkdocs", "build", "--strict", "--quiet", "--site-dir", str(out)]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    return out


@pytest.mark.slow
@pytest.mark.browser
@pytest.mark.xdist_group("site")
@pytest.mark.parametrize("page", ["index.html", "how_a_diagnosis_works.html", "reference/diagnosis.rules.html"])
def test_pages_open_from_files_and_ask_for_nothing_outside(site: Path, page: str, browse: Callable[..., Any]) -> None:
    seen = browse(site / page)
    assert not seen.console
    assert not seen.requests
    assert "md-search-result" in seen.dom


@pytest.mark.slow
@pytest.mark.browser
@pytest.mark.xdist_group("site")
def test_the_search_works_without_a_server(site: Path, browse: Callable[..., Any]) -> None:
    seen = browse(site / "index.html", "?q=ReversalsOnly")
    assert not seen.console
    links = re.findall(r'href="([^"]*)" class="md-search-result__link"', seen.dom)
    assert any("reference/diagnosis.rules.html" in link for link in links)


@pytest.mark.slow
@pytest.mark.xdist_group("site")
def test_every_page_loads_its_own_files_only(site: Path) -> None:
    for page in _pages(site):
        loaded = {a or b for a, b in LOADED.findall(page.read_text(encoding="utf-8"))}
        assert loaded
        for address in loaded:
            assert not re.match(r"(https?:)?//", address), f"{page.name} loads {address}"
            assert (page.parent / address.partition("?")[0]).exists(), f"{page.name} loads {address}"


@pytest.mark.slow
@pytest.mark.xdist_group("site")
def test_every_link_leads_to_a_page_and_a_heading_of_it(site: Path) -> None:
    identifiers = {p: set(re.findall(r"\bid=\"?([^\"\s>]+)", p.read_text(encoding="utf-8"))) for p in _pages(site)}
    for page in identifiers:
        for href in LINK.findall(page.read_text(encoding="utf-8")):
            path, anchor = urldefrag(unescape(href))
            if re.match(r"[a-z]+:", path):
                continue
            there = (page.parent / path).resolve() if path else page
            assert there.exists(), f"{page.name} links to {href}"
            known = identifiers.get(there)
            assert known is None or not anchor or unescape(anchor) in {unescape(i) for i in known}, (
                f"{page.relative_to(site)} links to {href}"
            )


@pytest.mark.slow
@pytest.mark.xdist_group("site")
def test_the_reference_says_shapes_units_and_errors(site: Path) -> None:
    page = (site / "reference" / "diagnosis.html").read_text(encoding="utf-8")
    words = re.sub(r"\s+", " ", re.sub(r"<[^>]+>", "", page))
    assert "nominal_error" in words
    assert "shape (dof,), torque that the nominal model is known to miss" in words
    assert "Raises:" in words
    assert "DiagnosisError" in words


def _pages(site: Path) -> list[Path]:
    """All pages but the one that only a server shows."""
    return sorted(p for p in site.rglob("*.html") if p.name != "404.html")
