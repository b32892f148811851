"""SciPy's integrators DOP853, LSODA, odeint and Radau, on equations of motion written by hand."""

import warnings
from collections.abc import Callable, Generator
from contextlib import contextmanager

import numpy as np

from mjbeer.exceptions import DivergenceError
from mjbeer.studies.benchmark.peers import equations
from mjbeer.studies.benchmark.peers.peer import Integrate, Motion, Peer, decades
from mjbeer.theory.scene import Scene

_FINEST = 2.3e-14  # solve_ivp replaces an rtol below 100 eps, with a warning
_MOST_EVALUATIONS = 1_000_000  # of a run of solve_ivp, which has no limit of its own; runs over seconds need thousands
_MOST_STEPS = 100_000  # of odeint between two samples; its default is 500


def _solve_ivp(method: str) -> Callable[[Scene, float, float, np.ndarray, float], Integrate]:
    """Return the function that sets up a motion for a method of solve_ivp."""

    def set_up(scene: Scene, phi0: float, phi_dot0: float, times: np.ndarray, knob: float) -> Integrate:
        from scipy.integrate import solve_ivp

        rates, start = equations.right_hand_side(scene), equations.start(scene, phi0, phi_dot0)
        span, relative = (0.0, float(times[-1])), max(knob, _FINEST)

        def integrate() -> Motion:
            remaining = iter(range(_MOST_EVALUATIONS))

            def count_and_evaluate(time: float, state: np.ndarray) -> tuple[float, ...]:
                next(remaining)
                return rates(time, state.tolist())

            try:
                with _warnings_as_errors():
                    solution = solve_ivp(
                        count_and_evaluate, span, start, method=method, t_eval=times, rtol=relative, atol=knob
                    )
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

    def evaluate(time: float, state: np.ndarray) -> tuple[float, ...]:
        return rates(time, state.tolist())

    def integrate() -> Motion:
        with _warnings_as_errors():
            states = odeint(evaluate, start, times, rtol=knob, atol=knob, tfirst=True, mxstep=_MOST_STEPS)
        return equations.coordinates(scene, states)

    return integrate


@contextmanager
def _warnings_as_errors() -> Generator[None]:
    """Turn SciPy's warnings into errors: if odeint fails, it only warns, and still returns numbers.

    Raises:
      DivergenceError: with SciPy's message; also if a state is too large for a sine.
    """
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            yield
    except (Warning, ValueError, OverflowError) as error:
        raise DivergenceError(f"SciPy: {error}") from error


_LADDER = decades(3, 13)
DOP853 = Peer(name="SciPy DOP853", tolerances=_LADDER, set_up=_solve_ivp("DOP853"))
LSODA = Peer(name="SciPy LSODA", tolerances=_LADDER, set_up=_solve_ivp("LSODA"))
ODEINT = Peer(name="SciPy odeint", tolerances=_LADDER, set_up=_odeint)
"""The method of LSODA, in a compiled loop."""
STIFF = (Peer(name="SciPy Radau", tolerances=decades(3, 12), set_up=_solve_ivp("Radau")),)
"""Implicit methods, which only stiff cases need."""
