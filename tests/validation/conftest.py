"""The small plants of the diagnosis' tests, for tests of studies."""

from tests.diagnosis.conftest import arm, at, names, plant

__all__ = ["arm", "at", "names", "plant"]
