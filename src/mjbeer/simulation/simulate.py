"""Simulate a scene with MuJoCo."""

import math
from collections.abc import Callable
from dataclasses import replace
from functools import partial

import mujoco
import numpy as np

from mjbeer import require
from mjbeer.exceptions import DivergenceError, ParameterError, ToleranceError
from mjbeer.model import state
from mjbeer.model.build import build
from mjbeer.model.setting import DOP853, FRICTION
from mjbeer.model.state import START_DEPTH
from mjbeer.simulation import dop853, stepping
from mjbeer.simulation.tolerance import Solver, tuning
from mjbeer.theory.conserved import implied_error
from mjbeer.theory.diagnostics import ERROR
from mjbeer.theory.measure import farthest
from mjbeer.theory.scene import Scene
from mjbeer.theory.trajectory import Trajectory

_ON_A_STEP = 1e-6
"""How far from a multiple of the timestep a requested time may be, in timesteps: what rounding can do to it."""
_CAUTION = 2.5
"""The estimated error over the distance from a run at half the timestep: 2 for a method of first order, whose error
halves, and a quarter more for what it is off its order."""
_ASIDE = 4e-14
"""How far beside the start the run at half the timestep starts [rad]: a hundred roundings. In contact it is the depth
at which the can starts, in radii, which no two models would have alike. Beside a separatrix all depends on it."""
_MOST_SAMPLES = 1e8
"""Most samples that are kept unasked: ten gigabytes."""


def simulate(
    scene: Scene,
    duration: float,
    phi0: float,
    phi_dot0: float = 0.0,
    rolling: str = "reduced",
    integrator: str = "RK4",
    timestep: float = 1e-3,
    tolerance: float | None = None,
    times: np.ndarray | None = None,
    friction: float = FRICTION,
) -> Trajectory:
    """Motion of a scene over a `duration` [s], stepped by MuJoCo in compiled code.

    The start is `phi0` [rad], `phi_dot0` [rad/s], with the axis as in `exact`. `rolling` and `friction` are
    those of `build`. `integrator` is one of MuJoCo's five, or "DOP853", an eighth-order one around MuJoCo's
    forward dynamics; `timestep` [s] is fixed. Samples are at every timestep, or at `times` [s] from 0 on:
    any for DOP853, multiples of the timestep for the others. MuJoCo's integrators end on the first multiple
    of the timestep at or after `duration`.

    With a `tolerance` [rad] the run is DOP853 with steps of its own, and is repeated until the error of phi
    and u/a over the whole motion is below it (relative to the angle where that exceeds 1 rad); the estimate
    is kept on the trajectory. `timestep` is then only the sampling interval, and what constraints are tuned
    to. It is the error of integrating the model: that of the model itself is zero for "reduced" and "equality",
    but not for a soft contact. Without a tolerance the error is estimated when one asks the trajectory for it.

    Raises:
      ParameterError: on a parameter that is not allowed.
      UnsupportedError: if MuJoCo has no such model.
      DivergenceError: if the motion stops being finite.
      ToleranceError: if the tolerance is not reached.
    """
    make = partial(_build, scene, rolling, friction)
    return follow(make, scene, duration, phi0, phi_dot0, rolling, integrator, timestep, tolerance, times)


Make = Callable[[str, float], mujoco.MjModel]
"""Makes the model of a scene for an integrator and a timestep [s]."""


def _build(scene: Scene, rolling: str, friction: float, integrator: str, timestep: float) -> mujoco.MjModel:
    return build(scene, rolling, integrator=integrator, timestep=timestep, friction=friction)


def follow(
    make: Make,
    scene: Scene,
    duration: float,
    phi0: float,
    phi_dot0: float = 0.0,
    rolling: str = "reduced",
    integrator: str = "RK4",
    timestep: float = 1e-3,
    tolerance: float | None = None,
    times: np.ndarray | None = None,
) -> Trajectory:
    """Motion of a scene as the model that `make` makes has it, which need not be mjbeer's own; see `simulate`.

    The model has the joints of the scene's `rolling`.
    """
    require.positive("duration", duration, "s")
    phi0, phi_dot0 = require.start(phi0, phi_dot0)
    if tolerance is not None:
        require.positive("tolerance", tolerance, "rad")
        integrator = DOP853
    model = make(integrator, timestep if tolerance is None else tuning(scene, rolling, timestep))
    start = state.start(model, scene, phi0, phi_dot0)
    moments = _moments(duration, timestep, times)
    if integrator != DOP853:
        steps = _steps(moments, timestep)
        states, moments = stepping.step(model, start[None], steps)[0], steps * timestep
    elif tolerance is None:
        states = dop853.integrate(model, start, moments, timestep)
    else:
        solution = Solver(model, scene).run(start, moments, tolerance)
        states = solution.states
    fixed = timestep if tolerance is None else None
    run = Trajectory(scene, rolling, integrator, fixed, moments, **vars(state.read(model, scene, states)))
    if tolerance is not None and rolling != "contact":
        _check_conserved(run, tolerance)
    if tolerance is None:
        opinion = partial(_halved, make, run, max(duration, float(moments[-1])), phi0, phi_dot0)
    else:
        opinion = partial(float, solution.estimate)
    return replace(run, second_opinion=opinion)


def _check_conserved(run: Trajectory, tolerance: float) -> None:
    """Two runs agree on what they both lose: a short arm in the rounding of a long way, or an equality's hardness."""
    implied, radius = implied_error(run), run.scene.can.radius
    if implied > max(tolerance, ERROR):
        raise ToleranceError(
            f"tolerance {tolerance:g} rad is not reached: two runs agree, but energy or momentum drift like an error "
            f"of {implied:.2g} rad; the model loses in rounding what moves it"
        )
    slid = float(np.abs(run.slip).max() / max(radius, np.abs(run.u - run.u[0]).max()))
    if slid > tolerance:
        raise ToleranceError(
            f"tolerance {tolerance:g} rad is not reached: the can slips by {slid:.2g} of its way; with masses so "
            'unequal MuJoCo has no harder equality, and rolling="reduced" needs none'
        )


def _halved(make: Make, run: Trajectory, duration: float, phi0: float, phi_dot0: float) -> float:
    """The error [rad] that a run at half the timestep shows, whose own is half as large or less.

    Constraints that are tuned to the timestep get harder with it, so that what their softness does shows too; and it
    starts a little aside, so that it shows what the motion makes of rounding.
    """
    assert run.timestep is not None
    settings = run.rolling, run.integrator, run.timestep / 2, None, run.time
    aside = START_DEPTH if run.rolling == "contact" else _ASIDE
    try:
        finer = follow(make, run.scene, duration, phi0 + aside, phi_dot0, *settings)
    except DivergenceError:
        return math.inf
    radius = run.scene.can.radius
    apart = max(farthest(run.phi, finer.phi), farthest(run.u / radius, finer.u / radius))
    return _CAUTION * apart


def _moments(duration: float, timestep: float, times: np.ndarray | None) -> np.ndarray:
    """The times of the samples [s]."""
    if times is None:
        if duration / timestep > _MOST_SAMPLES:
            raise ParameterError(
                f"a duration of {duration!r} s has too many timesteps of {timestep!r} s: at most {_MOST_SAMPLES:g}, "
                "or say with times= which samples to keep"
            )
        return timestep * np.arange(math.ceil(duration / timestep - _ON_A_STEP) + 1)
    moments = np.asarray(times, dtype=float)
    if moments.ndim != 1 or not len(moments) or not np.isfinite(moments).all() or (np.diff(moments) <= 0).any():
        raise ParameterError("times must be a one-dimensional array of increasing finite times [s]")
    if moments[0] < 0 or moments[-1] > duration * (1 + 1e-12):
        raise ParameterError(
            f"times must be between 0 and the duration {duration!r} s, got {moments[0]!r} to {moments[-1]!r}"
        )
    return moments


def _steps(moments: np.ndarray, timestep: float) -> np.ndarray:
    """Numbers of timesteps to the given times."""
    steps = np.rint(moments / timestep).astype(np.int64)
    off = np.abs(moments / timestep - steps)
    if off.max() > _ON_A_STEP:
        raise ParameterError(
            f"MuJoCo's integrators have samples at multiples of the timestep {timestep!r} s only, not at "
            f'{moments[off.argmax()]!r} s; integrator="DOP853" has them anywhere'
        )
    return steps
