"""The plausibility checks as pytest tests. Imports nothing of weight: it is loaded in every pytest run on the machine.

Two ways in:

- `pytest --lagnet-model DIR_OR_ROBOT [--lagnet-reference ROBOT] [--lagnet-vertical-base]` adds one test a check to
  whatever else is collected.
- In a test file, subclass `PlausibilityTests` and define `model`, or define a fixture `lagnet_model` and use
  `lagnet_check` in a test of your own; `@pytest.mark.lagnet(limits={...}, skip=[...])` sets limits.

JUnit output holds for every check its name, value, limit and unit as properties.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest

MARK = (
    "lagnet(limits={}, skip=[], vertical_base=False, reference=None, seed=0): how the plausibility checks of lagnet "
    "treat the model of this test or class"
)
OPTIONS = ("limits", "skip", "vertical_base", "samples")


def pytest_addoption(parser: pytest.Parser) -> None:
    """Options of the command line."""
    group = parser.getgroup("lagnet", "plausibility of dynamics models")
    group.addoption(
        "--lagnet-model",
        metavar="DIR_OR_ROBOT",
        help="check this model: folder, URDF, MJCF or robot name",
    )
    group.addoption(
        "--lagnet-reference", metavar="DIR_OR_ROBOT", help="a model that is believed, compared term by term"
    )
    group.addoption(
        "--lagnet-vertical-base", action="store_true", help="its first axis is vertical: the angle must not matter"
    )


def pytest_configure(config: pytest.Config) -> None:
    """Make the marker known to runs with --strict-markers."""
    config.addinivalue_line("markers", MARK)


def pytest_collection_modifyitems(session: pytest.Session, config: pytest.Config, items: list[pytest.Item]) -> None:
    """Add one test a check for the model of the command line."""
    spec = config.getoption("--lagnet-model")
    if not spec:
        return
    from lagnet.plausibility.checks import CHECK_NAMES

    upright = bool(config.getoption("--lagnet-vertical-base"))
    shared = _FromCommandLine(spec, config.getoption("--lagnet-reference"), upright)
    suite = ModelUnderTest.from_parent(session, name=f"lagnet[{spec}]", nodeid=f"lagnet[{spec}]")
    items.extend(CheckItem.from_parent(suite, name=name, shared=shared) for name in CHECK_NAMES)


class ModelUnderTest(pytest.Collector):
    """The model of the command line as a place in the report."""

    def collect(self) -> Iterator[pytest.Item]:
        """Nothing more: its tests are added beside those of the project."""
        return iter(())


class CheckItem(pytest.Item):
    """One check of the model of the command line."""

    def __init__(self, *, shared: _FromCommandLine, **rest: Any):
        super().__init__(**rest)
        self.shared = shared

    def runtest(self) -> None:
        """Run the check and keep its numbers."""
        _judge(self.name, self.shared.subject(), self.user_properties)

    def repr_failure(self, excinfo: Any, style: Any = None) -> Any:
        """What is wrong and where, without a traceback through the suite."""
        if excinfo.errisinstance(AssertionError):
            return str(excinfo.value)
        return super().repr_failure(excinfo, style)

    def reportinfo(self) -> tuple[Any, int | None, str]:
        """Where the test stands in the report."""
        return self.config.rootpath, None, f"{self.parent.name if self.parent else 'lagnet'}::{self.name}"


class _FromCommandLine:
    """Loads model and reference once for all checks, when the first of them runs."""

    def __init__(self, spec: str, reference: str | None, vertical_base: bool):
        self.spec, self.reference, self.vertical_base, self._subject = spec, reference, vertical_base, None

    def subject(self) -> Any:
        if self._subject is None:
            from lagnet.models.files.loading import load_any
            from lagnet.plausibility.settings import CheckSettings
            from lagnet.plausibility.subject import Subject

            reference = load_any(self.reference) if self.reference else None
            settings = CheckSettings(vertical_base=self.vertical_base)
            self._subject = Subject(load_any(self.spec), reference, settings=settings)
        return self._subject


class LagnetCheck:
    """One check, bound to the model of a test."""

    def __init__(self, name: str, subject: Any, properties: list[tuple[str, object]]):
        self.name, self._subject, self._properties = name, subject, properties

    def assert_holds(self) -> Any:
        """Fail the test with what is wrong and where; skip it where the check does not apply.

        Returns:
            The CheckResult.
        """
        __tracebackhide__ = True
        return _judge(self.name, self._subject, self._properties)


class PlausibilityTests:
    """Base class for the tests of a model of your own: one test a check.

    Example:
        class TestMyArm(PlausibilityTests):
            def model(self):
                return MyArm()

    Add `@pytest.mark.lagnet(limits={"gravity_is_gradient": 1e-4}, skip=["bounded_growth"])` to set limits.
    """

    def model(self) -> Any:
        """The model, with the calls of lagnet.types.InverseDynamics."""
        raise NotImplementedError("define model(self) in your subclass of PlausibilityTests")

    def test_plausible(self, lagnet_check: LagnetCheck) -> None:
        """Holds the model against one check."""
        lagnet_check.assert_holds()


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    """One test for every check that the marker does not skip."""
    if "lagnet_check" in metafunc.fixturenames:
        from lagnet.plausibility.checks import CHECK_NAMES
        from lagnet.plausibility.suite import refuse_unknown

        asked = _asked(metafunc.definition)
        refuse_unknown([*asked.get("limits", {}), *asked.get("skip", ())])
        names = [name for name in CHECK_NAMES if name not in asked.get("skip", ())]
        metafunc.parametrize("lagnet_check", names, indirect=True)


@pytest.fixture
def lagnet_check(request: pytest.FixtureRequest, lagnet_model: Any) -> LagnetCheck:
    """One check after the other, each bound to the fixture `lagnet_model`."""
    subject = _subject_of(request, lagnet_model)
    return LagnetCheck(request.param, subject, request.node.user_properties)


@pytest.fixture(scope="class")
def lagnet_model(request: pytest.FixtureRequest) -> Any:
    """What `model` of a PlausibilityTests class returns, else --lagnet-model; override it to give your own."""
    if request.cls is not None and issubclass(request.cls, PlausibilityTests):
        return request.cls().model()
    return request.getfixturevalue("lagnet_model_of_command_line")


@pytest.fixture(scope="session")
def lagnet_model_of_command_line(request: pytest.FixtureRequest) -> Any:
    """The model of --lagnet-model, loaded once."""
    spec = request.config.getoption("--lagnet-model")
    if not spec:
        pytest.fail("define a fixture lagnet_model that returns your model, or give --lagnet-model")
    from lagnet.models.files.loading import load_any

    return load_any(spec)


_SUBJECTS: dict[tuple[int, str], tuple[Any, Any]] = {}


def _subject_of(request: pytest.FixtureRequest, model: Any) -> Any:
    """The same Subject for all checks of one model under one marker: what it learned of the model is kept."""
    from lagnet.plausibility.settings import CheckSettings
    from lagnet.plausibility.subject import Subject

    asked = _asked(request.node)
    key = id(model), repr(sorted(asked.items(), key=lambda item: item[0]))
    if key not in _SUBJECTS:
        settings = CheckSettings(**{name: asked[name] for name in OPTIONS if name in asked})
        reference = asked.get("reference")
        if isinstance(reference, str):
            from lagnet.models.files.loading import load_any

            reference = load_any(reference)
        # The model is kept beside its subject, so that its id is not given to another one.
        _SUBJECTS[key] = model, Subject(model, reference, settings=settings, seed=asked.get("seed", 0))
    return _SUBJECTS[key][1]


def _asked(node: Any) -> dict[str, Any]:
    """The marker's arguments, those of the class under those of the test."""
    asked: dict[str, Any] = {}
    for mark in reversed(list(node.iter_markers("lagnet"))):
        unknown = set(mark.kwargs) - {*OPTIONS, "reference", "seed"}
        if unknown or mark.args:
            valid = ", ".join((*OPTIONS, "reference", "seed"))
            raise pytest.UsageError(f"pytest.mark.lagnet does not know {sorted(unknown) or mark.args} (valid: {valid})")
        asked |= mark.kwargs
    return asked


def _judge(name: str, subject: Any, properties: list[tuple[str, object]]) -> Any:
    __tracebackhide__ = True
    from lagnet.plausibility.suite import run_one

    result, _ = run_one(name, subject)
    told = {"check": name, "status": result.status, "value": result.value, "limit": result.limit, "unit": result.unit}
    properties.extend((f"lagnet_{key}", value) for key, value in told.items() if value is not None)
    if result.status == "not_applicable":
        pytest.skip(result.detail)
    if result.failed:  # raised, not asserted: pytest would print the whole result below the sentence
        raise AssertionError(f"{result.sentence()}\n{result.meaning} Limit: {result.justification}")
    return result
