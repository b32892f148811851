"""Simulate a scene with MuJoCo."""

import math

import numpy as np

from mjbeer import require
from mjbeer.exceptions import ParameterError
from mjbeer.model.setting import DOP853, FRICTION, TUNED, Setting, Softness
from mjbeer.simulation.run import Run, integrate
from mjbeer.theory.scene import Scene

_ON_A_STEP = 1e-6
"""How far from a multiple of the timestep a requested time may be, in timesteps: what rounding can do to it."""
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
    softness: Softness = TUNED,
) -> Run:
    """Motion of a scene over a `duration` [s], stepped by MuJoCo in compiled code.

    The start is `phi0` [rad], `phi_dot0` [rad/s], with the axis as in `exact`. `rolling`, `friction` and
    `softness` are those of `build`. `integrator` is one of MuJoCo's five, or "DOP853", an eighth-order one
    around MuJoCo's forward dynamics; `timestep` [s] is fixed. Samples are at every timestep, or at `times`
    [s] from 0 on: any for DOP853, multiples of the timestep for the others. MuJoCo's integrators end on the
    first multiple of the timestep at or after `duration`.

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
    require.positive("duration", duration, "s")
    phi0, phi_dot0 = require.start(phi0, phi_dot0)
    setting = Setting(rolling, integrator, timestep, tolerance, friction, softness)
    return integrate(scene, phi0, phi_dot0, setting, _sample_times(duration, setting, times))


def _sample_times(duration: float, setting: Setting, times: np.ndarray | None) -> np.ndarray:
    """The times of the samples [s]; for MuJoCo's integrators exactly those of timesteps."""
    timestep = setting.timestep
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
    if setting.tolerance is not None or setting.integrator == DOP853:
        return moments
    steps = np.rint(moments / timestep)
    off = np.abs(moments / timestep - steps)
    if off.max() > _ON_A_STEP:
        raise ParameterError(
            f"MuJoCo's integrators have samples at multiples of the timestep {timestep!r} s only, not at "
            f'{moments[off.argmax()]!r} s; integrator="DOP853" has them anywhere'
        )
    return steps * timestep
