"""SciPy's integrators on equations of motion written by hand."""

import warnings
from collections.abc import Callable, Generator
from contextlib import contextmanager

import numpy as np

from mjbeer.exceptions import DivergenceError
from mjbeer.studies.benchmark.peers import equations
from mjbeer.studies.benchmark.peers.peer import Integrate, Motion, Peer, decades
from mjbeer.theory.scene import Scene

_FINEST = 2.3e-14  # below 100 eps, SciPy's solve_ivp replaces rtol, with a warning
_MOST_EVALUATIONS = 1_000_000  # of a run of solve_ivp, which has no limit; runs of seconds need thousands
_MOST_STEPS = 100_000  # of odeint between two samples; its default is 500


def _solve_ivp(method: str) -> Callable[[Scene, float, float, np.ndarray, float], Integrate]:
    def set_up(scene: Scene, phi0: float, phi_dot0: float, times: np.ndarray, knob: float) -> Integrate:
        from scipy.integrate import solve_ivp

        rates, start = equations.right_hand_side(scene), equations.start(scene, phi0, phi_dot0)
        span, relative = (0.0, float(times[-1])), max(knob, _FINEST)

        def integrate() -> Motion:
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

        return integrate

    return set_up


def _odeint(scene: Scene, phi0: float, phi_dot0: float, times: np.ndarray, knob: float) -> Integrate:
    from scipy.integrate import odeint

    rates, start = equations.right_hand_side(scene), equations.start(scene, phi0, phi_dot0)

    def listed(time: float, state: np.ndarray) -> tuple[float, ...]:
        return rates(time, state.tolist())

    def integrate() -> Motion:
        with _complaints():
            states = odeint(listed, start, times, rtol=knob, atol=knob, tfirst=True, mxstep=_MOST_STEPS)
        return equations.coordinates(scene, states)

    return integrate


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
