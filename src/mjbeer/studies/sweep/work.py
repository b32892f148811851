"""The work of a sweep: one scene after the other is simulated, and its quantities are read off the run."""

import math
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from mjbeer.exceptions import DivergenceError, MjbeerError, ToleranceError
from mjbeer.model.setting import OWN, Setting
from mjbeer.simulation.run import Run, integrate
from mjbeer.studies.sweep.quantities import ALWAYS, ASKED, DIVERGED, NO_VALUE, NOT_REACHED, REFUSED, WELL
from mjbeer.theory.scene import Scene

_EACH_SWING = 128
"""Samples in a period of small swings for measuring a period: the error of a turning point is (2 pi/128)^4/384 of a
radian of phase, 1.5e-8."""
MOST_SAMPLES = 1_000_000
"""Largest number of samples of a run: they take a hundred megabytes, in every thread."""


@dataclass(frozen=True)
class Work:
    """What all scenes of a sweep have in common; it is sent to where they are simulated."""

    make: Callable[..., Scene]
    fixed: Mapping[str, Any]
    """Arguments of `make` that all scenes have."""
    start: Mapping[str, float]
    """phi0 [rad] and phi_dot0 [rad/s], unless they are among `names`."""
    names: tuple[str, ...]
    """The parameters that vary, in the order of the columns of the scenes' rows."""
    setting: Setting
    end: float
    """Time at which every run ends [s]."""
    asked: tuple[str, ...]
    """Names of quantities that are measured besides those that every sweep has."""
    functions: Mapping[str, Callable[[Run], float]]
    """Quantities that are functions of a trajectory, by their names."""

    @property
    def columns(self) -> tuple[str, ...]:
        """Return the names of all quantities, in the order of the columns of what is measured."""
        return (*ALWAYS, *self.asked, *self.functions)

    def scene(self, row: np.ndarray) -> tuple[Scene, float, float]:
        """Return the scene of a row of parameters, with its phi0 [rad] and phi_dot0 [rad/s].

        Raises:
          ParameterError: if a parameter is not allowed.
        """
        varied = {**self.start, **dict(zip(self.names, row.tolist(), strict=True))}
        phi0, phi_dot0 = varied.pop("phi0"), varied.pop("phi_dot0")
        return self.make(**self.fixed, **varied), phi0, phi_dot0


@dataclass
class Measured:
    """What was measured on some scenes; the first axis of each array is that of the scenes."""

    values: np.ndarray
    """Quantities, shape (scenes, quantities); NaN where there is none."""
    trusted: np.ndarray
    status: np.ndarray
    reasons: dict[int, str]
    """Why a scene's status is not 0, by its index."""
    pace: float = math.inf
    """Time that a scene takes [s]. The first scene is left out, in which numba may still compile; infinite if it is
    the only one."""


def measure(work: Work, rows: np.ndarray) -> Measured:
    """Return what is measured on the scenes of some rows of parameters, shape (scenes, parameters)."""
    count = len(rows)
    found = Measured(
        np.full((count, len(work.columns)), np.nan), np.zeros(count, np.bool_), np.zeros(count, np.int8), {}
    )
    began = 0.0
    for index, row in enumerate(rows):
        found.values[index], found.trusted[index], found.status[index], reason = outcome(work, row)
        if reason:
            found.reasons[index] = reason
        began = began or time.perf_counter()
    if count > 1:
        found.pace = (time.perf_counter() - began) / (count - 1)
    return found


def outcome(work: Work, row: np.ndarray) -> tuple[np.ndarray, bool, int, str]:
    """Return the quantities of one scene, whether its run is trusted, its status, and a reason unless that is 0."""
    values = np.full(len(work.columns), np.nan)
    try:
        scene, phi0, phi_dot0 = work.scene(row)
    except Exception as error:  # whatever a function of the user's raises, the other scenes go on
        return values, False, REFUSED, _told(error)
    try:
        run = integrate(scene, phi0, phi_dot0, work.setting, _times(work, scene))
        values[: len(ALWAYS)] = [quantity.of(run) for quantity in ALWAYS.values()]
        trusted = run.trusted
    except DivergenceError as error:
        return values, False, DIVERGED, str(error)
    except ToleranceError as error:
        return values, False, NOT_REACHED, str(error)
    except Exception as error:  # so that no scene ends the sweep, whatever is wrong with it
        return values, False, REFUSED, _told(error)
    status, reason = WELL, ""
    measures = [ASKED[name].of for name in work.asked] + list(work.functions.values())
    for place, of in enumerate(measures, len(ALWAYS)):
        try:
            values[place] = of(run)
        except Exception as error:  # whatever a function of the user's raises, the other scenes go on
            status, reason = NO_VALUE, f"{work.columns[place]}: {_told(error)}"
    return values, trusted, status, reason


def _told(error: Exception) -> str:
    """Return an error in one line, with its kind if it is none of mjbeer's."""
    kind = "" if isinstance(error, MjbeerError) else f"{type(error).__name__}: "
    return kind + " ".join(str(error).split())


def _times(work: Work, scene: Scene) -> np.ndarray:
    """Return the times of the samples of a run [s]: its end, and a swing's if it is to be measured."""
    setting, end = work.setting, work.end
    stepped = setting.tolerance is None and setting.integrator not in OWN
    if work.functions:  # as simulate has them: at every timestep
        times = setting.timestep * np.arange(1 + math.floor(end / setting.timestep * (1 + 1e-12)))
        return times if times[-1] >= end * (1 - 1e-12) else np.append(times, end)
    if not work.asked:
        return np.array([end])
    try:
        interval = 2 * math.pi / scene.frequency() / _EACH_SWING
    except MjbeerError:  # the quantity itself then says why it has no value
        return np.array([end])
    interval = max(interval, end / MOST_SAMPLES)
    if not stepped:
        return np.linspace(0.0, end, math.ceil(end / interval) + 1)
    last, stride = round(end / setting.timestep), max(1, int(interval / setting.timestep))
    return setting.timestep * np.union1d(np.arange(0, last, stride), [last])
