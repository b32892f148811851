"""Other tools that compute the motion of a scene, from equations of motion written by hand.

A frozen load has the state (phi, phi_dot), and u = a phi; a sliding one (u, phi, u_dot, phi_dot).
With p = depth sin(bottom) and q = depth cos(bottom) of the scene's `Oscillator`, and
M_e = m + m_can + I_can/a^2,

    frozen:   phi_ddot = (slope + p cos(phi) - (q + chord/4 phi_dot^2) sin(phi))
                         / (base + chord/2 - chord/2 cos(phi)),                      eq. (52)
    sliding:  phi_ddot = (p cos(phi) - (q + coupling phi_dot^2 cos(phi)) sin(phi))
                         / (base + coupling sin^2(phi)),
              u_ddot = A + m b/M_e (cos(phi) phi_ddot - sin(phi) phi_dot^2),         eqs. (46), (47)

with A the steady acceleration of footnote 4. An evaluation needs one sine and one cosine.

The tools are SciPy's odeint, which is LSODA, with interpreted and with compiled equations; DOP853
with compiled equations, so that neither Python nor MuJoCo is called; and heyoka. A whole call of
mjbeer is timed as if it were another tool.
"""

import importlib
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from mjbeer.model.joints import rolling_coordinates
from mjbeer.model.setting import Setting
from mjbeer.simulation.simulate import integrate as simulate
from mjbeer.studies.benchmark.points import Case
from mjbeer.theory.equations import Coordinates
from mjbeer.theory.scene import Scene

RightHandSide = Callable[[float, Sequence[Any]], tuple[Any, ...]]
Function = Callable[[Any], Any]
ODEINT = "SciPy odeint"
"""LSODA, whose loop is compiled, with equations in interpreted Python."""
COMPILED_ODEINT = "SciPy odeint, compiled equations"
"""The same with equations compiled by numba, which LSODA still calls as a Python function."""
COMPILED_DOP853 = "DOP853, compiled equations"
"""The method of SciPy's DOP853 in mjbeer's compiled code, with compiled equations."""
HEYOKA = "heyoka"
WHOLE_CALL = "mjbeer.simulate"
"""A whole call of mjbeer, from the scene to a run that judges itself."""
_MOST_STEPS = 100_000
"""Largest number of odeint's steps between two samples; its default of 500 is too low."""


class Samples(NamedTuple):
    """The motion that a run computed."""

    motion: Coordinates
    evaluations: int | None
    """Number of evaluations of the accelerations; None if it is not known."""


@dataclass(frozen=True)
class Solver:
    """A setting that is ready to run. Only the run is timed."""

    run: Callable[[], Any]
    """Integrates the motion from its start; it can be called again and again."""
    read: Callable[[Any], Samples]
    """Returns the samples in the result of `run`."""


@dataclass(frozen=True)
class OtherTool:
    """A tool that computes the motion of a scene."""

    tolerances: tuple[float, ...]
    """The tolerances to be tried, finest last."""
    set_up: Callable[[Case, float], Solver]
    """Returns the solver of a case for a tolerance. All that is done once, such as compiling, is
    done here, so that only `Solver.run` is timed."""


def right_hand_side(
    scene: Scene, sin: Function = math.sin, cos: Function = math.cos
) -> RightHandSide:
    """Return the function f(t, state) that gives the rates of change of a state [rad, m, per s].

    The scene has no damping. Pass the state as plain floats: with NumPy's scalars the function
    takes four times as long. With the `sin` and `cos` of a library of symbols, it returns symbols.
    """
    form = scene.oscillator
    p = form.depth * math.sin(form.bottom)
    q = form.depth * math.cos(form.bottom)
    slope = form.ramp
    base = form.base
    coupling = form.coupling
    half_chord = form.chord / 2
    quarter_chord = form.chord / 4
    middle = base + half_chord
    steady = scene.downhill_weight / scene.effective_mass
    arm = scene.load.moment / scene.effective_mass

    def frozen(_: float, state: Sequence[Any]) -> tuple[Any, ...]:
        phi, phi_dot = state
        s = sin(phi)
        c = cos(phi)
        torque = slope + p * c - (q + quarter_chord * (phi_dot * phi_dot)) * s
        return phi_dot, torque / (middle - half_chord * c)

    def sliding(_: float, state: Sequence[Any]) -> tuple[Any, ...]:
        _u, phi, u_dot, phi_dot = state
        s = sin(phi)
        c = cos(phi)
        square = phi_dot * phi_dot
        phi_ddot = (p * c - (q + coupling * square * c) * s) / (base + coupling * (s * s))
        u_ddot = steady + arm * (c * phi_ddot - s * square)
        return u_dot, phi_dot, u_ddot, phi_ddot

    return frozen if scene.attachment == "frozen" else sliding


def initial_state(case: Case) -> tuple[float, ...]:
    """Return the state at the start, in the order of `right_hand_side`."""
    if case.scene.attachment == "frozen":
        return case.phi0, case.phi_dot0
    u, u_dot = case.scene.initial_axis(case.phi0, case.phi_dot0)
    return u, case.phi0, u_dot, case.phi_dot0


def coordinates(case: Case, states: np.ndarray) -> Coordinates:
    """Return the motion with these states of `right_hand_side`, shape (samples, components)."""
    radius = case.scene.can.radius
    if case.scene.attachment == "frozen":
        phi, phi_dot = states.T
        u = radius * phi
        u_dot = radius * phi_dot
    else:
        u, phi, u_dot, phi_dot = states.T
    motion = rolling_coordinates(radius, u, u_dot, phi, phi_dot)
    return replace(motion, time=case.times)


def _set_up_odeint(compiled: bool, case: Case, tolerance: float) -> Solver:
    """Set SciPy's odeint up, which is LSODA in a compiled loop."""
    from scipy.integrate import odeint

    rates: Callable[[float, np.ndarray], Any]
    if compiled:
        from mjbeer.studies.benchmark.compiled_equations import array_function  # imports numba

        rates = array_function(case)
    else:
        equations = right_hand_side(case.scene)
        rates = lambda time, state: equations(time, state.tolist())  # noqa: E731

    def run() -> tuple[np.ndarray, dict[str, Any]]:
        return odeint(
            rates,
            initial_state(case),
            case.times,
            tfirst=True,
            full_output=True,
            rtol=tolerance,
            atol=tolerance,
            mxstep=_MOST_STEPS,
        )

    def read(found: tuple[np.ndarray, dict[str, Any]]) -> Samples:
        states, statistics = found
        return Samples(coordinates(case, states), int(statistics["nfe"][-1]))

    return Solver(run, read)


def _set_up_dop853(case: Case, tolerance: float) -> Solver:
    """Set DOP853 up on compiled equations; tolerances are those of `scipy.integrate.solve_ivp`."""
    from mjbeer.integrators.dop853 import DOP853
    from mjbeer.studies.benchmark.compiled_equations import CompiledEquations  # imports numba

    dynamics = CompiledEquations(case)
    method = DOP853(dynamics, local_tolerance=tolerance)
    start = np.array(initial_state(case))

    def run() -> np.ndarray:
        dynamics.evaluations = 0
        return method.run(start, case.times)

    return Solver(run, lambda states: Samples(coordinates(case, states), dynamics.evaluations))


def _set_up_heyoka(case: Case, tolerance: float) -> Solver:
    """Set Taylor's method up, compiled for one scene and tolerance.

    It is the one of github.com/bluescarni/heyoka.py.
    """
    import heyoka

    start = np.array(initial_state(case))
    grid = case.times.tolist()  # it reads a list faster than an array
    variables = heyoka.make_vars(*(f"x{index}" for index in range(len(start))))
    rates = right_hand_side(case.scene, heyoka.sin, heyoka.cos)(0.0, variables)
    heyoka.llvm_state.set_diskcache_enabled(False)  # set-up must not be faster after another run
    heyoka.llvm_state.clear_memcache()
    equations = list(zip(variables, rates, strict=True))
    integrator = heyoka.taylor_adaptive(
        equations, start.tolist(), tol=tolerance, compact_mode=False
    )

    def run() -> np.ndarray:
        integrator.time = 0.0
        integrator.state[:] = start
        *_, states = integrator.propagate_grid(grid)
        return states

    # Taylor's method expands the motion in each step, and evaluates no accelerations.
    return Solver(run, lambda states: Samples(coordinates(case, states), None))


def _set_up_whole_call(case: Case, tolerance: float) -> Solver:
    """Set nothing up: a whole call includes all that it needs."""
    setting = Setting(tolerance=tolerance)
    run = partial(simulate, case.scene, case.phi0, case.phi_dot0, setting, case.times)
    return Solver(run, lambda found: Samples(found, None))


_DECADES = tuple(float(f"1e-{digits}") for digits in range(3, 17))
OTHER_TOOLS = {
    ODEINT: OtherTool(_DECADES[:11], partial(_set_up_odeint, False)),
    COMPILED_ODEINT: OtherTool(_DECADES[:11], partial(_set_up_odeint, True)),
    COMPILED_DOP853: OtherTool(_DECADES[:12], _set_up_dop853),
    HEYOKA: OtherTool(_DECADES, _set_up_heyoka),
    WHOLE_CALL: OtherTool(_DECADES[:10], _set_up_whole_call),
}
"""All other tools by their names, whether they can be imported here or not."""


def absent() -> dict[str, str]:
    """Return the tools that cannot be imported here, by name, each with the reason on one line."""
    try:
        importlib.import_module("heyoka")  # optional: `pip install ".[peers]"` installs it
    except Exception as error:  # a package that lacks a library of the system may raise anything
        return {HEYOKA: " ".join(str(error).split()) or type(error).__name__}
    return {}
