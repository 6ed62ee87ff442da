"""An extension of Griffe: `fit, holdout: ...` under Args documents two arguments, each with its own type."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import griffe


class JoinedNames(griffe.Extension):
    """One entry for each name of a joined entry."""

    def on_object(self, *, obj: griffe.Object, **_: Any) -> None:
        """Divide the joined entries of the object's docstring."""
        if obj.docstring is None or not isinstance(obj, griffe.Function | griffe.Class):
            return
        for section in obj.docstring.parsed:
            if isinstance(section, griffe.DocstringSectionParameters):
                section.value = [one for entry in section.value for one in _divided(entry, obj)]


def _divided(entry: griffe.DocstringParameter, obj: Any) -> Iterator[griffe.DocstringParameter]:
    for name in (n.strip() for n in entry.name.split(",")):
        known = next((p for p in obj.parameters if p.name.lstrip("*") == name.lstrip("*")), None)
        kind, value = (known.annotation, known.default) if known else (entry.annotation, entry.value)
        yield griffe.DocstringParameter(name, description=entry.description, annotation=kind, value=value)
