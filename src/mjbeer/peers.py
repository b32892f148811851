"""Other tools on the same scenes, to be timed beside MuJoCo: SciPy here, heyoka and EXUDYN in modules of their own.

SciPy and heyoka integrate the equations of motion that one derives by hand; EXUDYN is given bodies and joints.
"""

import importlib
import math
import warnings
from collections.abc import Callable, Generator
from contextlib import contextmanager
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike

from mjbeer import checks, equations
from mjbeer.exceptions import DivergenceError, ParameterError
from mjbeer.scene import Scene

Motion = tuple[np.ndarray, np.ndarray]
"""phi [rad] and u [m], one row a sample."""
Run = Callable[[], Motion]

_FINEST = 2.3e-14  # below 100 eps, SciPy's solve_ivp replaces rtol, with a warning
_MOST_EVALUATIONS = 1_000_000  # of a run of solve_ivp, which has no limit; runs of seconds need thousands
_MOST_STEPS = 100_000  # of odeint between two samples; its default is 500


@dataclass(frozen=True)
class Peer:
    """A tool that computes the motion of a scene, and how finely it can be asked to."""

    name: str
    knob: str
    """What its accuracy is set by: "tolerance" or "timestep"."""
    unit: str
    """Unit of the knob; a tolerance has none."""
    knobs: tuple[float, ...]
    """The ladder of settings, finest last."""
    set_up: Callable[[Scene, float, float, np.ndarray, float], Run] = field(repr=False)
    """What `prepare` calls when it has checked its arguments."""

    def prepare(self, scene: Scene, phi0: float, phi_dot0: float, times: ArrayLike, knob: float) -> Run:
        """Do once all that a motion needs but its integration: equations, models, compilation.

        `phi0` [rad] and `phi_dot0` [rad/s] are the start, `times` [s] the samples, the first at 0, and `knob` the
        setting, of `knobs` or any other. What comes back integrates the motion from its start at every call, and is
        all that is to be timed. It raises DivergenceError, with the tool's own words, if the tool fails.

        Raises:
          ParameterError: on a start, times or a setting that make no sense, or that the tool cannot keep to.
          UnsupportedError: if the tool has no model of the scene.
        """
        phi0, phi_dot0 = checks.start(phi0, phi_dot0)
        times = _samples(times)
        solve = self.set_up(scene, phi0, phi_dot0, times, checks.positive(self.knob, knob, self.unit))

        def run() -> Motion:
            phi, u = solve()
            # What is not finite once stays so, and to ask every sample would be a fifth of heyoka's time.
            if phi.shape != times.shape or not (math.isfinite(phi[-1]) and math.isfinite(u[-1])):
                raise DivergenceError(f"{self.name}: the motion did not stay finite until {times[-1]:g} s")
            return phi, u

        return run


def installed() -> list[Peer]:
    """The peers of this environment; heyoka and EXUDYN are optional, `pip install mjbeer[peers]` has both.

    Raises:
      ImportError: if one of them is installed and broken.
    """
    peers = [DOP853, LSODA, ODEINT]
    for package in ("heyoka", "exudyn"):
        try:
            importlib.import_module(package)
        except ModuleNotFoundError as error:
            if error.name != package:
                raise
        else:
            peers.append(importlib.import_module(f"mjbeer.peer_{package}").PEER)
    return peers


def decades(first: int, last: int) -> tuple[float, ...]:
    """The tolerances 10^-first to 10^-last."""
    return tuple(float(f"1e-{digits}") for digits in range(first, last + 1))


def _samples(times: ArrayLike) -> np.ndarray:
    values = np.array(times, dtype=float)
    if (
        values.ndim != 1
        or len(values) < 2
        or not np.isfinite(values).all()
        or values[0]
        or (np.diff(values) <= 0).any()
    ):
        raise ParameterError(f"times must be two or more, the first at 0, each later than the last [s], got {times!r}")
    return values


def _solve_ivp(method: str) -> Callable[[Scene, float, float, np.ndarray, float], Run]:
    def set_up(scene: Scene, phi0: float, phi_dot0: float, times: np.ndarray, knob: float) -> Run:
        from scipy.integrate import solve_ivp

        rates, start = equations.right_hand_side(scene), equations.start(scene, phi0, phi_dot0)
        span, relative = (0.0, float(times[-1])), max(knob, _FINEST)

        def run() -> Motion:
            left = iter(range(_MOST_EVALUATIONS))

            def counted(time: float, state: np.ndarray) -> tuple[float, ...]:
                next(left)
                return rates(time, state.tolist())

            try:
                with _complaints():
                    solution = solve_ivp(counted, span, start, method, times, rtol=relative, atol=knob)
            except StopIteration:
                raise DivergenceError(
                    f"SciPy {method}: {_MOST_EVALUATIONS} evaluations did not reach {span[1]:g} s"
                ) from None
            if not solution.success:
                raise DivergenceError(f"SciPy {method}: {solution.message}")
            return equations.coordinates(scene, solution.y.T)

        return run

    return set_up


def _odeint(scene: Scene, phi0: float, phi_dot0: float, times: np.ndarray, knob: float) -> Run:
    from scipy.integrate import odeint

    rates, start = equations.right_hand_side(scene), equations.start(scene, phi0, phi_dot0)

    def listed(time: float, state: np.ndarray) -> tuple[float, ...]:
        return rates(time, state.tolist())

    def run() -> Motion:
        with _complaints():
            states = odeint(listed, start, times, rtol=knob, atol=knob, tfirst=True, mxstep=_MOST_STEPS)
        return equations.coordinates(scene, states)

    return run


@contextmanager
def _complaints() -> Generator[None]:
    """Make errors of SciPy's warnings: odeint says by a warning alone that what it returns is not the solution.

    Raises:
      DivergenceError: with SciPy's words, also where a state has become too large for a sine.
    """
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            yield
    except (Warning, ValueError, OverflowError) as error:
        raise DivergenceError(f"SciPy: {error}") from error


DOP853 = Peer("SciPy DOP853", "tolerance", "", decades(3, 13), _solve_ivp("DOP853"))
LSODA = Peer("SciPy LSODA", "tolerance", "", decades(3, 13), _solve_ivp("LSODA"))
ODEINT = Peer("SciPy odeint", "tolerance", "", decades(3, 13), _odeint)
"""The method of LSODA, in a loop that is compiled."""
