"""The runs of a sweep: what is measured in each, and pieces of work for an executor."""

import math
import pickle
import time
from collections.abc import Callable, Generator, Iterator, Mapping
from concurrent.futures import Executor, ThreadPoolExecutor
from contextlib import closing, contextmanager
from dataclasses import dataclass
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from mjbeer import require
from mjbeer.exceptions import (
    DivergenceError,
    MjbeerError,
    ParameterError,
    ToleranceError,
    warn_of_liquid,
)
from mjbeer.model.setting import Setting
from mjbeer.output.jobs import Job, as_finished
from mjbeer.simulation.run import Run
from mjbeer.simulation.simulate import integrate
from mjbeer.theory.scene import Scene

_PIECE = 0.25
"""Longest time that a piece of work should take [s]: no more is lost with a process."""
_LARGEST_PIECE = 256
"""Largest number of scenes in a piece."""
_WORKERS = 64
"""Assumed number of workers of an executor that does not say how many it has, as a cluster's."""

WELL = 0
REFUSED = 1
DIVERGED = 2
NOT_REACHED = 3
NO_VALUE = 4
BEYOND = 5
NOT_YET = -1
STATUSES = {
    WELL: "all went well",
    REFUSED: "the scene is not possible",
    DIVERGED: "the motion diverged",
    NOT_REACHED: "the tolerance was not reached",
    NO_VALUE: "a quantity has no value",
    BEYOND: "the model left its range",
    NOT_YET: "not yet simulated",
}
"""What the status of a scene means."""


class Quantity(NamedTuple):
    """A number that is measured in each run of a sweep."""

    name: str
    measure: Callable[[Run], Any]
    unit: str | None = None
    """Empty for a number without a unit; None if the unit is not known."""
    long_name: str = ""


def _period(run: Run) -> float:
    """Return the period of the swing [s]; a function with a name can be sent to processes."""
    return 2 * math.pi / run.frequency()


ALWAYS = (
    Quantity("phi", lambda run: run.phi[-1], "rad", "φ at the end"),
    Quantity("u", lambda run: run.u[-1], "m", "u at the end"),
    Quantity("phi_dot", lambda run: run.phi_dot[-1], "rad/s", "rate of φ at the end"),
    Quantity("u_dot", lambda run: run.u_dot[-1], "m/s", "velocity at the end"),
    Quantity("error", lambda run: run.error_estimate, "rad", "estimated error of φ and u/a"),
    Quantity("lowest_normal", lambda run: run.record.lowest_normal, "N", "lowest normal force"),
    Quantity(
        "friction_needed", lambda run: run.record.needed_friction, "", "friction coefficient needed"
    ),
    Quantity("parting_time", lambda run: run.record.rolling_ends_at, "s", "time from which N < 0"),
    Quantity(
        "energy_drift",
        lambda run: run.energy_drift,
        "",
        "largest change of energy divided by the swing's kinetic energy",
    ),
)
"""The quantities that every sweep has, besides whether a run is trusted and its status."""
PERIOD = Quantity("period", _period, "s", "period of the swing")


@dataclass(frozen=True)
class Work:
    """The part of a sweep that all of its scenes share; it is sent to where they are simulated."""

    make: Callable[..., Scene]
    fixed: Mapping[str, Any]
    """Arguments of `make`, phi0 [rad] and phi_dot0 [rad/s] included, that all scenes have."""
    setting: Setting
    times: np.ndarray
    """Times of the samples of every run [s]."""
    asked: tuple[Quantity, ...]
    """Quantities besides those that every sweep has."""

    def scene(self, varied: Mapping[str, float]) -> tuple[Scene, float, float]:
        """Return the scene with these values, and its phi0 [rad] and phi_dot0 [rad/s].

        Raises:
          ParameterError: if a parameter is not allowed, or `make` does not return a scene.
        """
        values = {**self.fixed, **varied}
        phi0, phi_dot0 = require.start(values.pop("phi0"), values.pop("phi_dot0"))
        scene = self.make(**values)
        if not isinstance(scene, Scene):
            called = require.format_value(self.make)
            returned = require.format_value(scene)
            raise ParameterError(
                f"make must return a scene, got {called}, which returns {returned}"
            )
        return scene, phi0, phi_dot0


class Outcome(NamedTuple):
    """What was measured on one scene."""

    values: list[float]
    """A value for each quantity, NaN where it has none; then whether the run is trusted, and the
    scene's status."""
    reason: str
    """Why the status is not `WELL`; empty if it is."""


class Measured(NamedTuple):
    """What was measured on a piece of work."""

    values: np.ndarray
    """A row for each scene, as in `Outcome`."""
    reasons: list[str]
    seconds: float
    """Time that it took [s]."""


@contextmanager
def collect_liquid_warnings() -> Generator[list[str]]:
    """Yield a list that collects the warnings about liquids in this block and this thread."""
    messages: list[str] = []
    token = warn_of_liquid.set(lambda message, *_, **__: messages.append(message))
    try:
        yield messages
    finally:
        warn_of_liquid.reset(token)


def measure(work: Work, scenes: list[dict[str, float]]) -> Measured:
    """Measure the quantities of scenes, each given by its values of the parameters that vary."""
    began = time.perf_counter()
    with collect_liquid_warnings():  # the sweep has issued them before the first scene
        outcomes = [_outcome(work, parameters) for parameters in scenes]
    values = np.array([outcome.values for outcome in outcomes])
    reasons = [outcome.reason for outcome in outcomes]
    return Measured(values, reasons, time.perf_counter() - began)


def _outcome(work: Work, varied: Mapping[str, float]) -> Outcome:
    """Simulate a scene. An error, also of the user's functions, does not stop other scenes."""
    values = [math.nan] * (len(ALWAYS) + len(work.asked))
    try:
        scene, phi0, phi_dot0 = work.scene(varied)
        run = integrate(scene, phi0, phi_dot0, work.setting, work.times)
        values[: len(ALWAYS)] = [float(quantity.measure(run)) for quantity in ALWAYS]
        trusted = run.trusted
    except Exception as error:
        return Outcome([*values, False, _status_of(error)], _in_a_line(error))
    status = WELL
    reason = ""
    for place, quantity in enumerate(work.asked, len(ALWAYS)):
        try:
            values[place] = float(quantity.measure(run))
        except Exception as error:
            status = NO_VALUE
            reason = f"{quantity.name}: {_in_a_line(error)}"
        else:
            if math.isnan(values[place]):
                status = NO_VALUE
                reason = f"{quantity.name}: it is not a number (NaN)"
    if status == WELL:
        beyond = (*run.rolling_warnings, *run.liquid_warnings)
        if beyond:
            status = BEYOND
            reason = "; ".join(beyond)
    return Outcome([*values, trusted, status], reason)


def _status_of(error: Exception) -> int:
    """Return the status of a scene that cannot be simulated."""
    if isinstance(error, DivergenceError):
        return DIVERGED
    if isinstance(error, ToleranceError):
        return NOT_REACHED
    return REFUSED


def _in_a_line(error: Exception) -> str:
    """Return an error in one line, with its type unless it is one of mjbeer's."""
    kind = "" if isinstance(error, MjbeerError) else f"{type(error).__name__}: "
    return kind + " ".join(str(error).split())


class _Pieces:
    """Cuts the numbers of scenes into pieces, which grow as long as they take little time."""

    def __init__(self, scenes: np.ndarray, largest: int) -> None:
        self._scenes = scenes
        self._largest = largest
        self._size = 1

    def __iter__(self) -> Iterator[np.ndarray]:
        begun = 0
        while begun < len(self._scenes):
            piece = self._scenes[begun : begun + self._size]
            begun += len(piece)
            yield piece

    def adapt(self, seconds: float) -> None:
        """Choose the size of the next pieces after one that took some time [s]."""
        if seconds < _PIECE:
            self._size = min(self._largest, 2 * self._size)
        else:
            self._size = max(1, self._size // 2)


def run_all(
    work: Work,
    scenes: np.ndarray,
    parameters: Callable[[np.ndarray], list[dict[str, float]]],
    executor: Executor,
) -> Generator[tuple[np.ndarray, Measured]]:
    """Yield the numbers of scenes and what was measured on them, piece by piece.

    `parameters` returns the values of those that vary for some numbers of scenes. The results of a
    scene do not depend on the piece that it is in. If the generator is closed, pieces that have not
    begun are cancelled.

    Raises:
      ParameterError: if the work cannot be sent to processes.
      OSError: if the system ends one of the executor's processes.
    """
    if not isinstance(executor, ThreadPoolExecutor):
        _require_picklable(work)
    workers = getattr(executor, "_max_workers", None) or _WORKERS
    largest = max(1, len(scenes) // (4 * workers))
    pieces = _Pieces(scenes, min(_LARGEST_PIECE, largest))
    under_way: dict[Job, np.ndarray] = {}

    def jobs() -> Iterator[Job]:
        for piece in pieces:
            name = f"scenes {piece[0]} to {piece[-1]}"
            job = Job(name, partial(measure, work, parameters(piece)))
            under_way[job] = piece
            yield job

    with closing(as_finished(jobs(), executor, at_once=2 * workers)) as finished:
        for job, measured in finished:
            pieces.adapt(measured.seconds)
            yield under_way.pop(job), measured


def _require_picklable(work: Work) -> None:
    """Raise a ParameterError for work that cannot be pickled, with which processes may hang."""
    try:
        pickle.dumps(work)
    except (pickle.PicklingError, AttributeError, TypeError) as error:
        raise ParameterError(
            "what makes the scenes, and functions of their runs, must be defined at the top of a "
            f"module to be sent to processes: {' '.join(str(error).split())}"
        ) from error
