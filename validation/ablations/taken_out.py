"""Takes steps that are no rules out of the diagnosis: neutral functions in the place of named ones, for a while."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import ExitStack, contextmanager
from functools import reduce
from importlib import import_module
from pkgutil import walk_packages
from typing import Any
from unittest.mock import patch

import lagnet.diagnosis

Instead = Mapping[str, Callable[[Any], Any]]
"""Places, written "module:name" or "module:Class.method", each with what makes the neutral value from the one there."""


def import_all() -> None:
    """Every module of the diagnosis, so that no name is bound while another stands in its place."""
    for module in walk_packages(lagnet.diagnosis.__path__, "lagnet.diagnosis."):
        import_module(module.name)


def what_stands_at(place: str) -> Any:
    """The function, method or constant at a place.

    Raises:
        ModuleNotFoundError, AttributeError: there is none; the diagnosis has changed, and so must the table.
    """
    module, _, name = place.partition(":")
    return reduce(getattr, name.split("."), import_module(module))


@contextmanager
def taken_out(instead: Instead) -> Iterator[None]:
    """Puts the neutral values in their places, and back at the end.

    A function is replaced wherever lagnet has bound it by name; constants and methods only where they are defined.
    """
    import_all()
    with ExitStack() as stack:
        for place, neutral in instead.items():
            old = what_stands_at(place)
            new = neutral(old)
            for owner, name in list(_bindings(place, old)):
                stack.enter_context(patch.object(owner, name, new))
        yield


def _bindings(place: str, value: Any) -> Iterator[tuple[Any, str]]:
    module, _, path = place.partition(":")
    *owners, name = path.split(".")
    yield reduce(getattr, owners, import_module(module)), name
    if owners or not callable(value):
        return
    for other, content in list(sys.modules.items()):
        if other.startswith("lagnet.") and other != module and getattr(content, name, None) is value:
            yield content, name
