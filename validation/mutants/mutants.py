"""All sabotaged models: each breaks one statement of physics, and names the check that is meant to catch it."""

from __future__ import annotations

from validation.mutants import of_bodies, of_calls, of_references
from validation.mutants.registry import MUTANTS, Mutant

__all__ = ["MUTANTS", "Mutant", "of_bodies", "of_calls", "of_references"]
