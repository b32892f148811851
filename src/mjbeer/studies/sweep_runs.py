"""The runs of a sweep: what is measured in each, and pieces of work for threads, processes, or a cluster."""

import math
import pickle
import time
from collections.abc import Callable, Generator, Mapping
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, Executor, Future, ThreadPoolExecutor, wait
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import numpy as np

from mjbeer import require
from mjbeer.exceptions import DivergenceError, MjbeerError, ParameterError, ToleranceError, warn_of_liquid
from mjbeer.model.setting import Setting
from mjbeer.simulation.run import Run
from mjbeer.simulation.simulate import integrate
from mjbeer.theory.scene import Scene

_PIECE, _LARGEST_PIECE = 0.25, 256
"""Pieces grow up to this time [s] and number of scenes: little enough to be lost with a process."""
_WORKERS = 64
"""Number of workers that an executor is taken to have that does not tell, such as a cluster's."""
ALWAYS: dict[str, tuple[Callable[[Run], Any], str, str]] = {
    "phi": (lambda run: run.phi[-1], "rad", "φ at the end"),
    "u": (lambda run: run.u[-1], "m", "u at the end"),
    "phi_dot": (lambda run: run.phi_dot[-1], "rad/s", "rate of φ at the end"),
    "u_dot": (lambda run: run.u_dot[-1], "m/s", "velocity at the end"),
    "error": (lambda run: run.error_estimate, "rad", "estimated error of φ and u/a"),
    "lowest_normal": (lambda run: run.record.lowest_normal, "N", "lowest normal force"),
    "friction_needed": (lambda run: run.record.needed_friction, "", "friction coefficient needed"),
    "parting_time": (lambda run: run.record.rolling_ends_at, "s", "time from which N < 0"),
    "energy_drift": (lambda run: run.energy_drift, "", "largest change of energy over the swing's kinetic energy"),
}
"""The quantities that every sweep has, besides whether a run is trusted and its status: what measures each, its unit,
and what it is in words."""
PERIOD: tuple[Callable[[Run], Any], str, str] = (lambda run: 2 * math.pi / run.frequency(), "s", "period of the swing")
WELL, REFUSED, DIVERGED, NOT_REACHED, NO_VALUE, BEYOND, NOT_YET = 0, 1, 2, 3, 4, 5, -1
STATUSES = {
    WELL: "all went well",
    REFUSED: "the scene is not possible",
    DIVERGED: "the motion diverged",
    NOT_REACHED: "the tolerance was not reached",
    NO_VALUE: "a quantity has no value",
    BEYOND: "the model left its range",
    NOT_YET: "not yet simulated",
}


@dataclass(frozen=True)
class Work:
    """The part of a sweep that all of its scenes share; it is sent to where they are simulated."""

    make: Callable[..., Scene]
    fixed: Mapping[str, Any]
    """Arguments of `make`, phi0 [rad] and phi_dot0 [rad/s] included, that are the same in all scenes."""
    setting: Setting
    times: np.ndarray
    """Times of the samples of every run [s]."""
    measures: Mapping[str, Callable[[Run], Any]]
    """Measures of a run besides the quantities of every sweep."""

    def scene(self, varied: Mapping[str, float]) -> tuple[Scene, float, float]:
        """Return the scene of some values of what varies, with its phi0 [rad] and phi_dot0 [rad/s].

        Raises:
          ParameterError: if a parameter is not allowed, or `make` does not return a scene.
        """
        values = {**self.fixed, **varied}
        start = require.start(values.pop("phi0"), values.pop("phi_dot0"))
        if not isinstance(made := self.make(**values), Scene):
            called = require.format_value(self.make)
            raise ParameterError(f"make must return a scene, got {called}, which returns {require.format_value(made)}")
        return made, *start


@contextmanager
def collect_liquid_warnings() -> Generator[list[str]]:
    """Yield a list that gets what liquids warn of in this block and this thread, instead of the user."""
    notes: list[str] = []
    token = warn_of_liquid.set(lambda message, *_, **__: notes.append(message))
    try:
        yield notes
    finally:
        warn_of_liquid.reset(token)


def measure(work: Work, scenes: list[dict[str, float]]) -> tuple[np.ndarray, list[str], float]:
    """Return the quantities of scenes, a row each: NaN where there is none, then whether it is trusted and its status;
    why the status is not 0; and the time that all took [s]."""
    began = time.perf_counter()
    with collect_liquid_warnings():  # the sweep has said them
        found, reasons = zip(*(_outcome(work, scene) for scene in scenes), strict=True)
    return np.array(found), list(reasons), time.perf_counter() - began


def _outcome(work: Work, varied: Mapping[str, float]) -> tuple[list[float], str]:
    """Return the quantities of a scene, and a reason unless its status is 0.

    Whatever a function of the user's raises, or is wrong with a scene, the others go on.
    """
    values = [math.nan] * (len(ALWAYS) + len(work.measures))
    try:
        scene, *start = work.scene(varied)
        run = integrate(scene, *start, work.setting, work.times)
        values[: len(ALWAYS)] = [float(of(run)) for of, *_ in ALWAYS.values()]
        trusted = run.trusted
    except Exception as error:
        kinds = {DivergenceError: DIVERGED, ToleranceError: NOT_REACHED}
        return [*values, False, kinds.get(type(error), REFUSED)], _in_a_line(error)
    status, reason = WELL, ""
    for place, (name, of) in enumerate(work.measures.items(), len(ALWAYS)):
        try:
            values[place] = float(of(run))
        except Exception as error:
            status, reason = NO_VALUE, f"{name}: {_in_a_line(error)}"
        else:
            if math.isnan(values[place]):
                status, reason = NO_VALUE, f"{name}: it is not a number (NaN)"
    if status == WELL and (beyond := (*run.rolling_warnings, *run.liquid_warnings)):
        status, reason = BEYOND, "; ".join(beyond)
    return [*values, trusted, status], reason


def _in_a_line(error: Exception) -> str:
    """Return an error in one line, with its kind if it is none of mjbeer's."""
    kind = "" if isinstance(error, MjbeerError) else f"{type(error).__name__}: "
    return kind + " ".join(str(error).split())


def run_all(
    work: Work, scenes: np.ndarray, varied: Callable[[np.ndarray], list[dict[str, float]]], executor: Executor
) -> Generator[tuple[np.ndarray, np.ndarray, list[str]]]:
    """Yield the numbers of some scenes with what was measured on them, piece by piece, as the pieces come back.

    `varied` returns the parameters of scenes. Pieces grow as long as they are quick; what is measured on a scene does
    not depend on that. If the generator is closed, pieces that have not begun are cancelled.

    Raises:
      ParameterError: if the work cannot be sent to processes.
      OSError: if the system ends one of the executor's processes.
    """
    if not isinstance(executor, ThreadPoolExecutor):  # processes may hang at their end if this cannot be sent
        try:
            pickle.dumps(work)
        except (pickle.PicklingError, AttributeError, TypeError) as error:
            raise ParameterError(
                "what makes the scenes, and functions of their runs, must be defined at the top of a module to be sent "
                f"to processes: {' '.join(str(error).split())}"
            ) from error
    workers = getattr(executor, "_max_workers", None) or _WORKERS
    begun, size, largest = 0, 1, min(_LARGEST_PIECE, max(1, len(scenes) // (4 * workers)))
    out: dict[Future[Any], np.ndarray] = {}
    try:
        while begun < len(scenes) or out:
            while begun < len(scenes) and len(out) < 2 * workers:
                piece = scenes[begun : begun + size]
                begun += size
                out[executor.submit(measure, work, varied(piece))] = piece
            for future in wait(out, return_when=FIRST_COMPLETED).done:
                piece = out.pop(future)
                values, reasons, seconds = future.result()
                size = min(largest, 2 * size) if seconds < _PIECE else max(1, size // 2)
                yield piece, values, reasons
    except BrokenExecutor as error:
        raise OSError("a process of the sweep was ended from outside: is memory short?") from error
    finally:
        for future in out:
            future.cancel()
