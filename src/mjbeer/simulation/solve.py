"""From a model in a setting to the states of a run, with the record of its steps."""

import math
from contextlib import suppress

import numpy as np

from mjbeer.exceptions import ToleranceError
from mjbeer.model.joints import angle_sums, state_sizes
from mjbeer.model.mujoco_library import MAX_STATE
from mjbeer.model.setting import MJBEER_INTEGRATORS, Setting
from mjbeer.simulation.methods import (
    finer_dop853,
    finer_gauss_jackson,
    fixed_method,
    suits_gauss_jackson,
)
from mjbeer.simulation.recorder import Recorder
from mjbeer.simulation.stepped_model import SteppedModel
from mjbeer.simulation.tolerance import SAFETY, Problem, Solution, not_reached, solve_to_tolerance
from mjbeer.theory.oscillator import Oscillator
from mjbeer.theory.scene import Scene, relaxation_rate

NUDGE = 4e-14
"""Distance of the start of a nudged run: in sizes of the state's components, whose rounding is a
hundredth of it."""
SMALLEST = 1e-12
"""Smallest tolerance [rad]: below it the rounding of angles decides."""
EVALUATIONS = 2_000_000
"""Largest number of evaluations of the accelerations in all runs of a method: some seconds."""
_STABLE_STEP = 6.4
"""Longest step with which DOP853 is stable, times the rate at which slip decays."""
_STEP_EVALUATIONS = 12
"""Evaluations in a step of DOP853."""


def solve(
    stepped: SteppedModel,
    setting: Setting,
    start: np.ndarray,
    times: np.ndarray,
    *,
    friction: float = math.inf,
    rounding: float = 0.0,
) -> Solution:
    """Return the motion from the state `start` at `times` [s].

    Its record says until when a can rolls with a coefficient of `friction`. A tolerance has to
    leave room for the `rounding` [rad] of what is later added to the angles.

    Raises:
      DivergenceError: if the motion stops being finite, or the timestep is too long for the method.
      ToleranceError: if the tolerance is not reached; the message says how near the runs came.
    """
    if setting.tolerance is None:
        recorder = Recorder(
            stepped.model, stepped.scene, friction, setting.integrator in MJBEER_INTEGRATORS
        )
        states = fixed_method(stepped, setting).run(start, times, recorder)
        return Solution(states, recorder.record, None, setting.integrator)
    if setting.tolerance < SMALLEST:
        raise not_reached(
            setting.tolerance, f"less than {SMALLEST:g} rad is lost in the rounding of angles"
        )
    if setting.tolerance <= rounding:
        raise not_reached(
            setting.tolerance,
            f"doubles near an angle as large as phi0 have errors of up to {rounding:.2g} rad; "
            "start fewer turns away",
        )
    return _try_methods(stepped, start, times, setting.tolerance - rounding, friction)


def _try_methods(
    stepped: SteppedModel, start: np.ndarray, times: np.ndarray, tolerance: float, friction: float
) -> Solution:
    """Return the motion with an error of phi and u/a below `tolerance` [rad].

    If the motion is smooth and undamped, Gauss-Jackson is tried. If it is not, or if that fails,
    DOP853 follows.
    """
    from mjbeer.simulation.smooth_recorder import SmoothRecorder  # numba is slow to import

    model = stepped.model
    scene = stepped.scene
    dynamics = stepped.dynamics
    _refuse_stiff(scene, times[-1], tolerance)
    scale = state_sizes(model, scene)
    signs = _along_energy(dynamics.derivative(start))
    problem = Problem(
        start=start,
        nudged_start=start + _nudge(scene.oscillator) * scale * signs,
        times=times,
        tolerance=tolerance,
        angles=angle_sums(model, scene),
    )
    if suits_gauss_jackson(scene, model):
        dynamics.most_evaluations = dynamics.evaluations + EVALUATIONS
        methods = finer_gauss_jackson(stepped, start, times[-1], tolerance / SAFETY)
        with suppress(ToleranceError):
            return solve_to_tolerance(
                methods, problem, lambda: SmoothRecorder(model, scene, friction)
            )
    dynamics.most_evaluations = dynamics.evaluations + EVALUATIONS
    methods = finer_dop853(stepped, tolerance, scale)
    return solve_to_tolerance(
        methods, problem, lambda: Recorder(model, scene, friction, look_within_steps=True)
    )


def _nudge(swing: Oscillator) -> float:
    """Return how far a nudged run starts aside, in sizes of the components of the state.

    It is more than `NUDGE` where J has a narrow minimum, base (1 + narrowness phi^2) about 0. There
    MuJoCo computes J as a small difference of large numbers, whose rounding is 1 + narrowness times
    as large. But the load is there for a share of its way only, 1/sqrt(1 + narrowness). So the
    nudge grows with sqrt(1 + narrowness).
    """
    narrowness = max(swing.coupling, swing.chord / 4) / swing.base
    return NUDGE * math.sqrt(1 + narrowness)


def _along_energy(rates: np.ndarray) -> np.ndarray:
    """Return a sign for each component of a state: moves with these signs all raise the energy.

    `rates` are the time derivatives of the state: velocities, then accelerations. A move against an
    acceleration raises V, and a larger velocity the kinetic energy.
    """
    half = len(rates) // 2
    return np.copysign(1.0, np.concatenate([-rates[half:], rates[:half]]))


def _refuse_stiff(scene: Scene, duration: float, tolerance: float) -> None:
    """Refuse a damping so strong that DOP853 would need too many steps."""
    if not scene.damping_law:
        return
    # The weight of can and load, pulling at the rim, drives them apart at most at this rate.
    slip = min(scene.damping_law.rate_at(scene.mass * scene.gravity * scene.can.radius), MAX_STATE)
    rate = float(relaxation_rate(scene, math.pi, slip))  # at pi, where it is largest
    most_steps = EVALUATIONS / _STEP_EVALUATIONS
    if rate * duration > _STABLE_STEP * most_steps:
        raise not_reached(
            tolerance,
            f"slip decays at {rate:.2g}/s, so that {duration:.6g} s would take too many steps; "
            'integrator="implicitfast" takes longer ones, and a frozen load is the limit',
        )
