"""What is measured on each scene of a sweep, wherever that is done: its quantities, its status, and why it failed."""

import math
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from mjbeer import require
from mjbeer.exceptions import DivergenceError, MjbeerError, ParameterError, ToleranceError, liquid_notes
from mjbeer.model.setting import OWN, Setting
from mjbeer.simulation.run import Run, integrate
from mjbeer.theory.scene import Scene

MOST_SAMPLES = 1_000_000
"""Largest number of samples of a run: they take a hundred megabytes, in every thread."""
_EACH_SWING = 128
"""Samples in a period of small swings for measuring a period: the error of a turning point is (2 pi/128)^4/384 of a
radian of phase, 1.5e-8."""
_TURNS = 1.5
"""Number of swings from rest in which there are three turning points behind the start."""
_PIECE = 1.0
"""Time after which a piece of work ends [s]: long enough that handing it out costs nothing, short enough to be lost."""


def _period(run: Run) -> float:
    scene = run.scene
    rest = scene.equilibrium()  # says it if there is none to swing about, where too few turning points would be named
    try:
        return 2 * math.pi / run.frequency()
    except MjbeerError as error:
        if scene.dissipates or run.phi_dot0:
            raise
        period = scene.period(math.remainder(run.phi0 - rest, 2 * math.pi))  # says it if it rolls on and does not swing
        if run.time[-1] > _TURNS * period:
            raise
        raise MjbeerError(
            f"only a longer duration has it: the swing takes {period:.4g} s, and {_TURNS:g} swings must end within "
            f"{run.time[-1]:.6g} s"
        ) from error


class Quantity(NamedTuple):
    """A number of a run, with its unit, and what it is in words."""

    of: Callable[[Run], Any]
    unit: str
    meaning: str


ALWAYS: Mapping[str, Quantity] = {
    "phi": Quantity(lambda run: run.phi[-1], "rad", "φ at the end"),
    "u": Quantity(lambda run: run.u[-1], "m", "u at the end"),
    "phi_dot": Quantity(lambda run: run.phi_dot[-1], "rad/s", "rate of φ at the end"),
    "u_dot": Quantity(lambda run: run.u_dot[-1], "m/s", "velocity at the end"),
    "error": Quantity(lambda run: run.error_estimate, "rad", "estimated error of φ and u/a"),
    "lowest_normal": Quantity(lambda run: run.record.lowest_normal, "N", "lowest normal force"),
    "friction_needed": Quantity(lambda run: run.record.needed, "", "friction coefficient that rolling needs"),
    "parting_time": Quantity(lambda run: run.record.fails_at, "s", "time from which N < 0"),
    "energy_drift": Quantity(lambda run: run.energy_drift, "", "energy drift over the swing's kinetic energy"),
}
"""The quantities that every sweep has, besides "trusted" and "status"."""
PERIOD, TRUSTED, STATUS = "period", "trusted", "status"
NAMED = {**ALWAYS, PERIOD: Quantity(_period, "s", "period of the swing")}
"""Those and the one that is measured if it is asked for by name: it needs more than the end of a run."""
STATUSES = {
    (WELL := 0): "all went well",
    (REFUSED := 1): "the scene is not possible",
    (DIVERGED := 2): "the motion diverged",
    (NOT_REACHED := 3): "the tolerance was not reached",
    (NO_VALUE := 4): "a quantity has no value",
    (BEYOND := 5): "the model left its range",
    (NOT_YET := -1): "not yet simulated",
}


@dataclass(frozen=True)
class Work:
    """What all scenes of a sweep have in common; it is sent to where they are simulated."""

    make: Callable[..., Scene]
    fixed: Mapping[str, Any]
    """Arguments of `make`, phi0 [rad] and phi_dot0 [rad/s] included, that are the same in all scenes."""
    varied: tuple[str, ...]
    """The others, in the order of the columns of the scenes' rows."""
    setting: Setting
    end: float
    """Time at which every run ends [s]."""
    measures: Mapping[str, Callable[[Run], Any]]
    """What is measured besides the quantities of every sweep."""

    def scene(self, row: np.ndarray) -> tuple[Scene, float, float]:
        """Return the scene of a row of parameters, with its phi0 [rad] and phi_dot0 [rad/s].

        Raises:
          ParameterError: if a parameter is not allowed, or `make` does not return a scene.
        """
        values = {**self.fixed, **dict(zip(self.varied, row.tolist(), strict=True))}
        start = require.start(values.pop("phi0"), values.pop("phi_dot0"))
        if not isinstance(made := self.make(**values), Scene):
            called = require.shown(self.make)
            raise ParameterError(f"make must return a scene, got {called}, which returns {require.shown(made)}")
        return made, *start


def measure(work: Work, rows: np.ndarray) -> tuple[list[list[float]], dict[int, str]]:
    """Simulate the scenes of some rows of parameters, at least one and as many as a second has time for.

    Return for each its quantities, NaN where there is none, whether it is trusted and its status; and by its place in
    the rows why the status is not 0.
    """
    found: list[list[float]] = []
    reasons: dict[int, str] = {}
    began = time.perf_counter()
    with liquid_notes():  # the sweep has said them
        for place, row in enumerate(rows):
            values = [math.nan] * (len(ALWAYS) + len(work.measures))
            trusted, status, reason = _outcome(work, row, values)
            found.append([*values, trusted, status])
            if reason:
                reasons[place] = reason
            if time.perf_counter() - began > _PIECE:
                break
    return found, reasons


def _outcome(work: Work, row: np.ndarray, values: list[float]) -> tuple[bool, int, str]:
    """Fill in the quantities of a scene; return whether its run is trusted, its status, and a reason unless that is 0.

    Whatever a function of the user's raises, or is wrong with a scene, the others go on.
    """
    try:
        scene, *start = work.scene(row)
        run = integrate(scene, *start, work.setting, _times(work, scene))
        values[: len(ALWAYS)] = [float(quantity.of(run)) for quantity in ALWAYS.values()]
        trusted = run.trusted
    except Exception as error:
        kinds = {DivergenceError: DIVERGED, ToleranceError: NOT_REACHED}
        return False, kinds.get(type(error), REFUSED), _in_a_line(error)
    status, reason = WELL, ""
    for place, (name, of) in enumerate(work.measures.items(), len(ALWAYS)):
        try:
            values[place] = float(of(run))
        except Exception as error:
            status, reason = NO_VALUE, f"{name}: {_in_a_line(error)}"
    if status == WELL and (beyond := (*run.rolling_warnings, *run.liquid_warnings)):
        status, reason = BEYOND, "; ".join(beyond)
    return trusted, status, reason


def _in_a_line(error: Exception) -> str:
    """Return an error in one line, with its kind if it is none of mjbeer's."""
    kind = "" if isinstance(error, MjbeerError) else f"{type(error).__name__}: "
    return kind + " ".join(str(error).split())


def _times(work: Work, scene: Scene) -> np.ndarray:
    """Return the times of the samples of a run [s]: its end, and a swing's or all timesteps where they are needed."""
    step, end = work.setting.timestep, work.end
    if set(work.measures) - {PERIOD}:  # a function has them as simulate does: at every timestep
        times = step * np.arange(1 + math.floor(end / step * (1 + 1e-12)))
        return times if times[-1] >= end * (1 - 1e-12) else np.append(times, end)
    if not work.measures:
        return np.array([end])
    try:
        interval = max(2 * math.pi / scene.frequency() / _EACH_SWING, end / MOST_SAMPLES)
    except MjbeerError:  # the quantity itself then says why it has no value
        return np.array([end])
    if work.setting.tolerance is not None or work.setting.integrator in OWN:
        return np.linspace(0.0, end, math.ceil(end / interval) + 1)
    last, stride = round(end / step), max(1, int(interval / step))
    return step * np.union1d(np.arange(0, last, stride), [last])
