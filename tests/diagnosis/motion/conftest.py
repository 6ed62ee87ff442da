"""The nominal pendulum and diagnoses of it, made once."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path
from types import ModuleType

import pytest


@pytest.fixture(scope="session")
def pendulum() -> ModuleType:
    """The module beside this file that simulates one servo with a pendulum in MuJoCo."""
    spec = importlib.util.spec_from_file_location("motion_pendulum", Path(__file__).with_name("pendulum.py"))
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="session")
def nominal(pendulum: ModuleType, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The MJCF that a user would have."""
    return pendulum.write_model(tmp_path_factory.mktemp("nominal") / "pendulum.xml")
