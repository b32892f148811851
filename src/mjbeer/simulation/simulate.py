"""The function `simulate`, which checks its arguments and runs MuJoCo."""

import math

import numpy as np

from mjbeer import require
from mjbeer.exceptions import ParameterError
from mjbeer.model.setting import DOP853, FRICTION, TUNED, Setting, Softness
from mjbeer.simulation.run import Run, integrate
from mjbeer.theory.scene import Scene

_ON_A_STEP = 1e-6
"""Largest distance of a requested time from a multiple of the timestep, in timesteps: it allows for rounding."""
_MOST_SAMPLES = 1e8
"""Largest number of samples at every timestep: they take ten gigabytes."""


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
    """Return the motion of a scene over a `duration` [s], stepped by MuJoCo in compiled code.

    The motion starts at `phi0` [rad] with `phi_dot0` [rad/s], and the axis as in `exact`. `rolling`, `friction` and
    `softness` are those of `build`. `integrator` is one of MuJoCo's five, or "DOP853", a method of eighth order
    around MuJoCo's forward dynamics; `timestep` [s] is fixed. Samples are at every timestep, or at `times` [s] from 0
    on, which must be multiples of the timestep unless the integrator is DOP853. Samples at every timestep end with the
    first multiple of the timestep at or after `duration`.

    With a `tolerance` [rad] the integrator is DOP853, which chooses its own steps. The run is repeated until the
    error of phi and u/a over the whole motion is below the tolerance, relative to the angle where that exceeds 1 rad;
    the trajectory has the estimate. `timestep` is then the sampling interval, and what a contact is tuned to. The
    tolerance bounds the error of integrating the model. The model itself is exact for "reduced" and "equality", but
    not for a soft contact. Without a tolerance the trajectory estimates its error when it is asked for it.

    Raises:
      ParameterError: if a parameter is not allowed.
      UnsupportedError: if MuJoCo cannot have such a model.
      TemplateError: if the template of the scene is missing or not as it should be.
      DivergenceError: if the motion stops being finite.
      ToleranceError: if the tolerance is not reached.
    """
    require.positive("duration", duration, "s")
    phi0, phi_dot0 = require.start(phi0, phi_dot0)
    setting = Setting(
        rolling=rolling,
        integrator=integrator,
        timestep=timestep,
        tolerance=tolerance,
        friction=friction,
        softness=softness,
    )
    sample_times = _sample_times(duration, setting, times)
    return integrate(scene, phi0=phi0, phi_dot0=phi_dot0, setting=setting, times=sample_times)


def _sample_times(duration: float, setting: Setting, times: np.ndarray | None) -> np.ndarray:
    """Return the times of the samples [s], which for MuJoCo's integrators are exact multiples of the timestep."""
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
