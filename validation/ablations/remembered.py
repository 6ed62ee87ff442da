"""What all ablations of a plant share is computed once: each question by its content, answered from memory.

No limit and no rule stands behind these functions: they are handed problems whose limits raise when they are read.
Behind those of `SHARED` stands no step either; what is behind a step is remembered for each set of steps taken out.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from typing import Any

from lagnet.diagnosis.problem.problem import Problem
from validation.ablations.content import Contents
from validation.ablations.taken_out import Instead, taken_out

SHARED = (
    "lagnet.recordings.conditioning.condition:condition",
    "lagnet.diagnosis.data_quality.inspect:screened_for",
    "lagnet.diagnosis.regression.excited_hypotheses:build_library",
    "lagnet.diagnosis.regression.block_gram:collect_block_grams",
    "lagnet.diagnosis.problem.noise_floor:noise_floor",
    "lagnet.diagnosis.unexplained.predictability:predictability_of",
    "lagnet.diagnosis.unexplained.formula:find_shape",
)
BEHIND_STEPS = (
    "lagnet.diagnosis.nominal.mounting:mounting_of",
    "lagnet.diagnosis.estimation.refit:refit",
    "lagnet.diagnosis.estimation.intervals.misspecification:interval_errors",
    "lagnet.diagnosis.transients.detection:detect_events",
    "lagnet.diagnosis.identified.fit:identify",
)
SIGN_MODEL = "lagnet.diagnosis.problem.dry_friction:fit_sign_model"
POSED = "lagnet.diagnosis.problem.problem:pose_problem"


@dataclass
class Memory:
    """Answers by what was asked; of one plant, since recordings and models are kept with them."""

    contents: Contents = field(default_factory=Contents)
    answers: dict[Hashable, Any] = field(default_factory=dict)

    def answer(self, key: tuple[Hashable, ...], asked: Any, compute: Callable[[], Any]) -> Any:
        """What is known of a question, or what is computed."""
        key = (*key, self.contents.digest(asked))
        if key not in self.answers:
            self.answers[key] = compute()
        return self.answers[key]


class OutOfReach:
    """Limits that nothing may read."""

    def __getattr__(self, name: str) -> Any:
        raise AssertionError(f"the limit {name} is read where answers are remembered whatever the limits are")


@contextmanager
def remembered(memory: Memory, instead: Instead | None = None) -> Iterator[None]:
    """Within it, the same question on the same samples is answered from memory.

    Args:
        instead: the steps that are taken out meanwhile.
    """
    steps = tuple(sorted(instead or ()))
    places = {p: _recalled(memory, p, ()) for p in SHARED}
    places |= {p: _recalled(memory, p, steps) for p in BEHIND_STEPS}
    with taken_out({**places, SIGN_MODEL: _sign_model(memory), POSED: _posed(memory)}):
        yield


def _recalled(memory: Memory, place: str, steps: tuple[str, ...]) -> Callable[[Callable], Callable]:
    def wrap(old: Callable) -> Callable:
        def recalled(*given: Any, **more: Any) -> Any:
            def compute() -> Any:
                return old(*map(_blind, given), **{k: _blind(x) for k, x in more.items()})

            return memory.answer((place, steps), (given, more), compute)

        return recalled

    return wrap


def _blind(x: Any) -> Any:
    return replace(x, limits=OutOfReach()) if isinstance(x, Problem) else x


def _sign_model(memory: Memory) -> Callable[[Callable], Callable]:
    """The sign model's numbers are remembered, not the problem that carries them."""

    def wrap(old: Callable) -> Callable:
        def fit_sign_model(problem: Problem) -> Problem:
            def compute() -> tuple[Any, Any]:
                found = old(_blind(problem))
                return found.slow, found.straight

            slow, straight = memory.answer((SIGN_MODEL,), problem, compute)
            return replace(problem, slow=slow, straight=straight)

        return fit_sign_model

    return wrap


def _posed(memory: Memory) -> Callable[[Callable], Callable]:
    """The problem as posed, with the limits that are asked for; its pieces keep what was computed on them."""

    def wrap(old: Callable) -> Callable:
        def pose_problem(nominal: Any, fit: Any, holdout: Any, ends_of: Any = (), limits: Any = None) -> Problem:
            asked = nominal, fit, holdout, tuple(ends_of)
            plain = memory.answer((POSED,), asked, lambda: old(*asked))
            return plain if limits is None else replace(plain, limits=limits)

        return pose_problem

    return wrap
