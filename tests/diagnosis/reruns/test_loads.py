"""What names leave of recordings less their loads is usual: a load is not asked to explain it."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from lagnet.diagnosis.reruns import loads
from lagnet.diagnosis.transients.detection import Scan


@pytest.mark.parametrize(
    ("layers", "names", "usual"),
    [([1.0, 1.0, 1.0], [4.0, 2.0, 0.5], [4.0, 2.0, 1.0]), ([5.0, 0.5, 1.0], [4.0, 2.0, 0.5], [5.0, 2.0, 1.0])],
)
def test_the_usual_power_is_that_beside_names_where_these_leave_more_than_the_layer(layers, names, usual) -> None:
    clean: Any = SimpleNamespace(sigma=np.sqrt(names))
    found = loads._usual_beside(clean, Scan((), np.array(layers), 2.0))
    np.testing.assert_allclose(found.power, usual)
    assert found.inflation == 2.0
