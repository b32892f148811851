"""The validation table passes row by row, and each kind of row fails on a wrong model or a
misprint."""

import dataclasses
import json
import math
from collections.abc import Callable
from typing import Any

import pytest

from mjbeer import Scene, simulate, sliding
from mjbeer.checks.check import Check, Result
from mjbeer.simulation.run import Run
from mjbeer.studies.validation import motion_checks as motions
from mjbeer.studies.validation.validate import Validation, checks
from mjbeer.theory.can import Damping

CHECKS = {f"{check.name} - {check.by}": check for check in checks()}


def params() -> list[Any]:
    """Every check; fits take seconds, and the tests of `fit` have others."""
    marked = []
    for name, check in CHECKS.items():
        mark = pytest.mark.costly if check.group == "tracks" else pytest.mark.slow
        marked.append(pytest.param(check, id=name, marks=mark))
    return marked


@pytest.mark.parametrize("check", params())
def test_check(check: Check) -> None:
    result = check.result()

    assert result.passed, f"{result.error} > {result.bound} {result.unit}"


def test_checks_are_told_apart_and_can_be_written() -> None:
    """A bound that NumPy computed would make the verdict one of its own, unknown to JSON."""
    results = []
    for check in checks():
        result = Result(
            check.group, check.name, check.by, check.bound, check.unit, check.reason, 0.0
        )
        results.append(result)

    content = json.loads(Validation(results, []).json())

    assert len(content["checks"]) == len(CHECKS)


def test_a_wrong_motion_is_found_out() -> None:
    """A gravity 1e-6 too strong shows in phi and in the period."""
    run = simulate(sliding(gravity=9.81 * (1 + 1e-6)), 4, 1.0)

    wrong = dataclasses.replace(run, scene=sliding())

    assert motions.phi_error(wrong) > 1e-7
    assert abs(2 * math.pi / wrong.frequency() / sliding().period(1.0) - 1) > 1e-9


def more_damped(scene: Scene) -> Scene:
    """Return a scene with a thousandth more damping."""
    coefficients = [(1 + 1e-3) * coefficient for coefficient in scene.damping_law.coefficients]
    law = Damping(*coefficients)
    damping = law if isinstance(scene.damping, Damping) else law.linear
    return dataclasses.replace(scene, damping=damping)


def tilted(scene: Scene) -> Scene:
    return dataclasses.replace(scene, incline=scene.incline + 1e-9)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("quantity", "other"),
    [("terminal speed", more_damped), ("terminal tilt", tilted), ("phi over 1 s", more_damped)],
)
def test_a_wrong_model_is_found_out(
    quantity: str, other: Callable[[Scene], Scene], monkeypatch: pytest.MonkeyPatch
) -> None:
    """MuJoCo has another damping or incline than theory."""

    def run(scene: Scene, *rest: Any, **words: Any) -> Run:
        return dataclasses.replace(simulate(other(scene), *rest, **words), scene=scene)

    monkeypatch.setattr(motions, "simulate", run)
    motions._steady.cache_clear()
    (check, *_) = (check for name, check in CHECKS.items() if name.startswith(quantity))

    result = check.result()

    assert not result.passed
    motions._steady.cache_clear()
