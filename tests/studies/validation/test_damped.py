"""Each kind of row for damped scenes fails if MuJoCo has another damping, or another gravity, than theory."""

from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any

import pytest

from mjbeer import Scene, simulate
from mjbeer.checks import Check
from mjbeer.simulation.run import Run
from mjbeer.studies.validation import damped_checks as damped
from mjbeer.theory.damping import Damping

ROWS = {f"{row.name} - {row.by}": row for row in damped.checks()}


def scaled(scene: Scene, factor: float) -> Scene:
    law = Damping(*(factor * each for each in scene.damping_law.coefficients))
    return replace(scene, damping=law if isinstance(scene.damping, Damping) else law.linear)


def more_damped(scene: Scene) -> Scene:
    return scaled(scene, 1 + 1e-3)


def weaker(scene: Scene) -> Scene:
    return replace(scene, gravity=scene.gravity * (1 - 1e-6))


def tilted(scene: Scene) -> Scene:
    return replace(scene, incline=scene.incline + 1e-9)


@pytest.fixture
def instead(monkeypatch: pytest.MonkeyPatch) -> Iterator[Callable[[Callable[[Scene], Scene]], None]]:
    """Let MuJoCo have another scene than the one that is asked for."""

    def by(other: Callable[[Scene], Scene]) -> None:
        def run(scene: Scene, *rest: Any, **words: Any) -> Run:
            return replace(simulate(other(scene), *rest, **words), scene=scene)

        monkeypatch.setattr(damped, "simulate", run)

    yield by
    damped._steady.cache_clear()


def first(quantity: str) -> Check:
    return next(row for name, row in ROWS.items() if name.startswith(quantity))


@pytest.mark.slow
@pytest.mark.parametrize(
    ("quantity", "other"),
    [
        ("frequency, eq. (10)", weaker),
        ("terminal speed", more_damped),
        ("terminal tilt", tilted),
        ("decay and frequency of a swing", more_damped),
        ("phi over 1 s", more_damped),
    ],
)
def test_a_wrong_model_is_found_out(
    quantity: str, other: Callable[[Scene], Scene], instead: Callable[[Callable[[Scene], Scene]], None]
) -> None:
    damped._steady.cache_clear()
    instead(other)
    assert not first(quantity).result().passed
