"""Each kind of row for damped scenes fails if MuJoCo has another damping, or another gravity, than theory."""

from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any

import mujoco
import pytest

from mjbeer import Scene, build, simulate
from mjbeer.simulation.run import Run
from mjbeer.studies.study import Row
from mjbeer.studies.validation import damped
from mjbeer.theory.damping import Damping

ROWS = {f"{row.name} - {row.by}": row for row in damped.rows()}


def scaled(scene: Scene, factor: float) -> Scene:
    law = Damping(*(factor * each for each in scene.damping_law.coefficients))
    return replace(scene, damping=law if isinstance(scene.damping, Damping) else law.linear)


def more_damped(scene: Scene) -> Scene:
    return scaled(scene, 1 + 1e-3)


def weaker(scene: Scene) -> Scene:
    return replace(scene, gravity=scene.gravity * (1 - 1e-6))


def squared(scene: Scene) -> Scene:
    """Not proportional to what it is thought to be."""
    return scaled(scene, scene.damping_law.linear)


def tilted(scene: Scene) -> Scene:
    return replace(scene, incline=scene.incline + 1e-9)


@pytest.fixture
def instead(monkeypatch: pytest.MonkeyPatch) -> Iterator[Callable[[Callable[[Scene], Scene]], None]]:
    """Let MuJoCo have another scene than the one that is asked for."""

    def by(other: Callable[[Scene], Scene]) -> None:
        def run(scene: Scene, *rest: Any, **words: Any) -> Run:
            return replace(simulate(other(scene), *rest, **words), scene=scene)

        def model(scene: Scene, *rest: Any) -> mujoco.MjModel:
            return build(other(scene), *rest)

        monkeypatch.setattr(damped, "simulate", run)
        monkeypatch.setattr(damped, "build", model)

    yield by
    damped._steady.cache_clear()
    damped._loop.cache_clear()


def first(quantity: str) -> Row:
    return next(row for name, row in ROWS.items() if name.startswith(quantity))


@pytest.mark.slow
@pytest.mark.parametrize(
    ("quantity", "other"),
    [
        ("frequency, eq. (10)", weaker),
        ("power of the damping with which it bends", squared),
        ("power of the damping with which the load creeps", squared),
        ("terminal speed", more_damped),
        ("terminal tilt", tilted),
        ("decay and frequency of a swing", more_damped),
        ("each decay and frequency", more_damped),
        ("mean slip rate D", more_damped),
        ("variance of the slip rate", more_damped),
        ("ways to go on for ever", lambda scene: scaled(scene, 0.01)),
        ("phi over 1 s", more_damped),
    ],
)
def test_a_wrong_model_is_found_out(
    quantity: str, other: Callable[[Scene], Scene], instead: Callable[[Callable[[Scene], Scene]], None]
) -> None:
    damped._steady.cache_clear()
    damped._loop.cache_clear()
    instead(other)
    assert not first(quantity).result().passed
