"""Other tools that compute the motion of a scene: SciPy and heyoka, on equations of motion that are written by hand.

A frozen load has the state (phi, phi_dot), and u = a phi; a sliding one (u, phi, u_dot, phi_dot). With
p = depth sin(bottom) and q = depth cos(bottom) of the scene's `Oscillator`, and M_e = m + m_can + I_can/a^2,

    frozen:   phi_ddot = (slope + p cos(phi) - (q + chord/4 phi_dot^2) sin(phi))
                         / (base + chord/2 - chord/2 cos(phi)),                               eq. (52)
    sliding:  phi_ddot = (p cos(phi) - (q + swing phi_dot^2 cos(phi)) sin(phi)) / (base + swing sin^2(phi)),
              u_ddot = A + m b/M_e (cos(phi) phi_ddot - sin(phi) phi_dot^2),                  eqs. (46), (47)

with A the steady acceleration of footnote 4. An evaluation needs one sine and one cosine.
"""

import importlib
import math
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from mjbeer.model.setting import Setting
from mjbeer.simulation.simulate import integrate as simulate
from mjbeer.theory.scene import Scene

RightHandSide = Callable[[float, Sequence[Any]], tuple[Any, ...]]
Samples = tuple[np.ndarray, np.ndarray, int | None]
"""phi [rad] and u [m], with one entry for each sample, and how often accelerations were evaluated, if that is known."""
Integrate = Callable[[], Samples]
"""A function that integrates a motion from its start at every call."""
Function = Callable[[Any], Any]
WHOLE = "mjbeer.simulate"
"""The name of whole calls of mjbeer, which are timed like another tool."""


def right_hand_side(scene: Scene, sin: Function = math.sin, cos: Function = math.cos) -> RightHandSide:
    """Return the function f(t, state) that gives the rates of change of a scene's state [rad, m, and per s].

    The scene has no damping. Pass the state as plain floats: with NumPy's scalars the function takes four times as
    long. With the `sin` and `cos` of a library of symbols, it returns symbols.
    """
    form, mass = scene.oscillator, scene.effective_mass
    p, q = form.depth * math.sin(form.bottom), form.depth * math.cos(form.bottom)
    slope, half, quarter, middle = form.ramp, form.chord / 2, form.chord / 4, form.base + form.chord / 2
    steady, share = scene.downhill_weight / mass, scene.load.moment / mass

    def frozen(_: float, state: Sequence[Any]) -> tuple[Any, ...]:
        phi, phi_dot = state
        s, c = sin(phi), cos(phi)
        return phi_dot, (slope + p * c - (q + quarter * (phi_dot * phi_dot)) * s) / (middle - half * c)

    def sliding(_: float, state: Sequence[Any]) -> tuple[Any, ...]:
        _u, phi, u_dot, phi_dot = state
        s, c, square = sin(phi), cos(phi), phi_dot * phi_dot
        phi_ddot = (p * c - (q + form.coupling * square * c) * s) / (form.base + form.coupling * (s * s))
        return u_dot, phi_dot, steady + share * (c * phi_ddot - s * square), phi_ddot

    return frozen if scene.attachment == "frozen" else sliding


def start(scene: Scene, phi0: float, phi_dot0: float) -> tuple[float, ...]:
    """Return the initial state, in the order of `right_hand_side`, with u and u_dot from `Scene.initial_axis`."""
    if scene.attachment == "frozen":
        return phi0, phi_dot0
    u, u_dot = scene.initial_axis(phi0, phi_dot0)
    return u, phi0, u_dot, phi_dot0


def coordinates(scene: Scene, states: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return phi [rad] and u [m] of states with one row for each sample."""
    if scene.attachment == "frozen":
        return states[:, 0], scene.can.radius * states[:, 0]
    return states[:, 1], states[:, 0]


class OtherTool(NamedTuple):
    """A tool that computes the motion of a scene, with its tolerances, finest last."""

    tolerances: tuple[float, ...]
    set_up: Callable[[Scene, float, float, np.ndarray, float], Integrate]
    """Takes scene, phi0 [rad], phi_dot0 [rad/s], times of samples [s] and tolerance. Equations, models and compilation
    are done there, so that only calls of what it returns need be timed."""


def _scipy(lsoda: bool, scene: Scene, phi0: float, phi_dot0: float, times: np.ndarray, tolerance: float) -> Integrate:
    """DOP853 of solve_ivp, or odeint, which is LSODA in a compiled loop."""
    from scipy.integrate import odeint, solve_ivp

    rates, begin, span = right_hand_side(scene), start(scene, phi0, phi_dot0), (0.0, float(times[-1]))
    allowed = {"rtol": tolerance, "atol": tolerance}
    evaluate = lambda time, state: rates(time, state.tolist())  # noqa: E731

    def integrate() -> Samples:
        if lsoda:
            states, about = odeint(evaluate, begin, times, tfirst=True, full_output=True, **allowed)
            return *coordinates(scene, states), int(about["nfe"][-1])
        found = solve_ivp(evaluate, span, begin, method="DOP853", t_eval=times, **allowed)
        return *coordinates(scene, found.y.T), int(found.nfev)

    return integrate


def _heyoka(scene: Scene, phi0: float, phi_dot0: float, times: np.ndarray, tolerance: float) -> Integrate:
    """Taylor's method, compiled for the equations of one scene and one tolerance (github.com/bluescarni/heyoka.py)."""
    import heyoka

    begin, grid = np.array(start(scene, phi0, phi_dot0)), times.tolist()  # it reads a list faster than an array
    variables = heyoka.make_vars(*(f"x{index}" for index in range(len(begin))))
    rates = right_hand_side(scene, heyoka.sin, heyoka.cos)(0.0, variables)
    heyoka.llvm_state.set_diskcache_enabled(False)  # the time of set-up must not depend on what ran before
    heyoka.llvm_state.clear_memcache()
    equations = list(zip(variables, rates, strict=True))
    integrator = heyoka.taylor_adaptive(equations, begin.tolist(), tol=tolerance, compact_mode=False)

    def integrate() -> Samples:
        integrator.time, integrator.state[:] = 0.0, begin
        *_, states = integrator.propagate_grid(grid)
        return *coordinates(scene, states), None  # it has no evaluations, but Taylor series of each step

    return integrate


def _whole_call(scene: Scene, phi0: float, phi_dot0: float, times: np.ndarray, tolerance: float) -> Integrate:
    def integrate() -> Samples:
        run = simulate(scene, phi0, phi_dot0, Setting(tolerance=tolerance), times)
        return run.phi, run.u, None

    return integrate


_DECADES = tuple(float(f"1e-{digits}") for digits in range(3, 17))
OTHER_TOOLS = {
    "SciPy DOP853": OtherTool(_DECADES[:11], partial(_scipy, False)),
    "SciPy odeint": OtherTool(_DECADES[:11], partial(_scipy, True)),
    "heyoka": OtherTool(_DECADES, _heyoka),
    WHOLE: OtherTool(_DECADES[:10], _whole_call),
}
"""All other tools by their names, whether they can be imported here or not."""


def absent() -> dict[str, str]:
    """Return the names of the other tools that cannot be imported here, each with the reason, on one line."""
    try:
        importlib.import_module("heyoka")  # optional; in a checkout `pip install ".[peers]"` installs it
    except Exception as error:  # a package that lacks a library of the system may raise anything
        return {"heyoka": " ".join(str(error).split()) or type(error).__name__}
    return {}
