"""Stand-ins for what takes long: made-up rows to validate, videos that are not drawn, studies that are short."""

import inspect
import pathlib
from collections.abc import Callable
from typing import Any

import pytest

from mjbeer import audit, exact, output, peers, settings, sliding, stories, validation, video
from mjbeer import benchmark as benchmarks
from mjbeer import stability as stabilities
from mjbeer.claim import confirmed
from mjbeer.exceptions import RenderingError
from mjbeer.row import Row
from mjbeer.settings import Curve
from mjbeer.story import Film, Story
from mjbeer.task import Task

STEPS = tuple(16e-3 / 2**k for k in range(6))
LARGE = tuple(64e-3 / 2**k for k in range(7))
LADDERS = {
    Curve("reduced", "Euler", "timestep"): STEPS,
    Curve("reduced", "RK4", "timestep"): STEPS,
    Curve("reduced", "DOP853", "timestep"): LARGE,
    Curve("reduced", "DOP853", "tolerance"): (1e-6, 1e-9),
    Curve("equality", "RK4", "timestep"): STEPS,
    Curve("contact", "DOP853", "timestep"): LARGE[:5],
    Curve("equality, slide first", "Euler", "timestep"): (2e-3,),
    Curve("equality, hinge first", "Euler", "timestep"): (2e-3,),
    Curve("contact, defaults", "Euler", "timestep"): (2e-3,),
}


def benchmark(monkeypatch: pytest.MonkeyPatch) -> None:
    """Make the benchmark one of short ladders and two peers, timed twice, with a made-up cost of stages."""
    monkeypatch.setattr(settings, "curves", lambda scene, quick: dict(LADDERS))
    monkeypatch.setattr(benchmarks, "installed", lambda: [peers.DOP853, peers.ODEINT])
    stages = [{"case": "frozen", "integrator": "RK4", "step": 1e-6, "clock": 2.0}]
    monkeypatch.setattr(benchmarks, "ablate", lambda: stages)
    monkeypatch.setattr(benchmarks, "REPEATS", 2)


def stability(monkeypatch: pytest.MonkeyPatch) -> None:
    """Make the stability study one of the first task of each group, but for the maps, which take longer."""
    first: dict[str, Task] = {}
    for each in stabilities.tasks(quick=True):
        first.setdefault(each.group, each)
    del first["maps"]
    monkeypatch.setattr(stabilities, "tasks", lambda quick: list(first.values()))


def validate(monkeypatch: pytest.MonkeyPatch, **errors: float) -> None:
    """Make the validation table one of rows with a quantity and an error each, and the bound 1e-3; audit nothing."""
    rows = [Row(name, "a stub", 1e-3, "rad", "none", lambda error=error: error) for name, error in errors.items()]
    monkeypatch.setattr(validation, "rows", lambda: rows)
    monkeypatch.setattr(audit, "claims", list)


def audited(monkeypatch: pytest.MonkeyPatch, **errors: float) -> None:
    """Make the audit one of confirmed equations with an error each, and the bound 1e-3."""
    claims = [
        confirmed(name, "a stub", "none", lambda e=error: (1.0 + e, -1.0), 1e-3, "") for name, error in errors.items()
    ]
    monkeypatch.setattr(audit, "claims", lambda: claims)


def draw(monkeypatch: pytest.MonkeyPatch, fail_at: str = "") -> list[dict[str, Any]]:
    """Make videos and pictures text files, and the one of a name fail; the arguments of all calls so far.

    The paper has a single story then, whose plot is a text file too.
    """
    calls: list[dict[str, Any]] = []

    def stub(name: str, real: Callable[..., None]) -> Callable[..., None]:
        signature = inspect.signature(real)

        def instead(*args: object, **kwargs: object) -> None:
            call = signature.bind(*args, **kwargs).arguments
            call["path"] = pathlib.Path(call["path"])
            if call["path"].name == fail_at:
                raise RenderingError(f"cannot draw {fail_at}")
            output.write(call["path"], name)
            calls.append({"function": name, **call})

        return instead

    def tell(path: pathlib.Path) -> None:
        output.write(path.with_name(f"{path.name}.svg"), "plot")

    film = Film(0.5, lambda: exact(sliding(), [0.0, 0.1], 0.1))
    monkeypatch.setattr(stories, "stories", lambda: [Story("told", "A stub's story.", tell, film)])
    for name in ("render", "save_frame"):
        monkeypatch.setattr(video, name, stub(name, getattr(video, name)))
    return calls
