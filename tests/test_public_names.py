"""The names that `import lagnet` promises, each imported when first used."""

from __future__ import annotations

import importlib.metadata
import subprocess
import sys

import pytest

import lagnet

PROMISED = {"load_robot", "load_recording", "train", "load_model", "decompose", "check", "diagnose", "__version__"}


def test_the_promised_names_are_public() -> None:
    assert set(lagnet.__all__) >= PROMISED
    assert len(set(lagnet.__all__)) == len(lagnet.__all__)
    assert dir(lagnet) == sorted(lagnet.__all__)


@pytest.mark.parametrize("name", [n for n in lagnet.__all__ if n != "__version__"])
def test_every_public_name_leads_to_what_it_says(name: str) -> None:
    value = getattr(lagnet, name)
    assert value is getattr(lagnet, name)
    assert value is not None


def test_an_unknown_name_is_an_attribute_error() -> None:
    with pytest.raises(AttributeError, match="no_such_name"):
        _ = lagnet.no_such_name


def test_importing_the_package_imports_no_heavy_one() -> None:
    heavy = ("jax", "pinocchio", "sklearn", "plotly", "pybullet", "scipy")
    code = f"import sys, lagnet; print([m for m in {heavy!r} if m in sys.modules])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_the_version_is_that_of_the_distribution() -> None:
    assert lagnet.__version__ == importlib.metadata.version("lagnet")
