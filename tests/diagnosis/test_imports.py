"""A diagnosis imports JAX and scikit-learn only where something is left to learn."""

from __future__ import annotations

import subprocess
import sys

SLOW = ("jax", "equinox", "optax", "sklearn")


def test_the_diagnosis_is_imported_without_what_only_remainders_need() -> None:
    script = f"import lagnet.diagnosis.diagnose, sys; print([m for m in {SLOW} if m in sys.modules])"
    said = subprocess.run([sys.executable, "-c", script], check=True, capture_output=True, text=True)
    assert said.stdout.strip() == "[]"
