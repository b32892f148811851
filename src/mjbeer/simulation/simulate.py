"""The function `simulate`: from a scene and a setting to a run."""

import math
import os
import warnings

import numpy as np
from numpy.typing import ArrayLike

from mjbeer import require
from mjbeer.exceptions import LiquidWarning, ParameterError, UntrustedWarning
from mjbeer.model.joints import to_coordinates
from mjbeer.model.mujoco_library import quiet
from mjbeer.model.setting import FRICTION, MJBEER_INTEGRATORS, Integrator, Rolling, Setting
from mjbeer.simulation.methods import model_numbers
from mjbeer.simulation.run import Run, diagnose_run, turns_rounding
from mjbeer.simulation.solve import solve
from mjbeer.simulation.stepped_model import kept_model
from mjbeer.theory.equations import Coordinates
from mjbeer.theory.oscillator import reduced
from mjbeer.theory.scene import DURATION, PHI0, Scene

_ON_A_STEP = 1e-10
"""Largest distance of a requested time from a multiple of the timestep, divided by the time: a sum
of a million timesteps, as MuJoCo's own clock makes it, is 2e-11 off (measured)."""
_MOST_SAMPLES = 1e8
"""Largest number of samples at every timestep: they take ten gigabytes."""
_MOST_STEPS = 1e12
"""Largest number of steps: at half a microsecond each they take a week."""
_CHECKPOINTS = 4096
"""Number of timesteps, evenly spread over a run, at which a second run is compared with it besides
the samples."""
_PARTS = np.arange(33) / 32
"""Ends of the parts of a run to a tolerance, as shares of it: its runs are compared in each part at
least once."""


def simulate(
    scene: Scene,
    duration: float | None = None,
    phi0: float = PHI0,
    phi_dot0: float = 0.0,
    rolling: Rolling = "reduced",
    integrator: Integrator | None = None,
    timestep: float = 1e-3,
    tolerance: float | None = None,
    times: ArrayLike | None = None,
    friction: float = FRICTION,
    mjcf: str | os.PathLike[str] | None = None,
) -> Run:
    """Return the motion of a scene, stepped by MuJoCo in compiled code.

    Args:
      scene: what rolls.
      duration: how long [s], 2 s if neither it nor `times` is given; samples at every timestep end
        with the first one at or after it. With `times` it is only checked: none may be later.
      phi0: angle of the load to the incline at the start [rad].
      phi_dot0: its rate at the start [rad/s].
      rolling: how the can is made to roll, as in `build`: "reduced", "equality" or "contact".
      integrator: one of MuJoCo's five, "DOP853" or, in "reduced" without damping, "GaussJackson";
        RK4 if none is given.
      timestep: fixed timestep [s], to which a contact is tuned; with a tolerance the interval
        between samples.
      tolerance: largest error of phi and u/a [rad], relative beyond 1 rad, to which the integrator
        and its steps are then chosen. A "contact" is refused, as its softness is an error of the
        model.
      times: increasing times of the samples [s], for MuJoCo's integrators multiples of the
        timestep.
      friction: coefficient of friction of a contact.
      mjcf: a folder of MJCF that is read instead of mjbeer's, as in `build`.

    A run that slips, parts from the incline, drifts in energy, or would have to be pulled at gives
    an `UntrustedWarning`, one in which a liquid is no lump any more, or tilts beyond linear theory,
    a `LiquidWarning`, and a start beyond a whole turn an `AngleWarning`.

    Raises:
      ParameterError: if a parameter is not allowed.
      UnsupportedError: if MuJoCo cannot represent such a model.
      TemplateError: if the MJCF is missing, lacks an element, or does not move as theory says.
      DivergenceError: if the motion stops being finite, or the timestep is too long for the method.
      ToleranceError: if the tolerance is not reached.
    """
    require.instance("scene", scene, Scene)
    if duration is not None:
        duration = require.positive("duration", duration, "s")
    phi0, phi_dot0 = require.start(phi0, phi_dot0)
    require.warn_of_degrees(phi0)
    setting = Setting.of(
        integrator, tolerance, rolling=rolling, timestep=timestep, friction=friction, mjcf=mjcf
    )
    if times is None:
        sample_times = _every_step(DURATION if duration is None else duration, setting.timestep)
    else:
        times = require.times("times", times, increasing=True)
        sample_times = _sample_times(duration, setting, times)
    run = integrate(scene, phi0=phi0, phi_dot0=phi_dot0, setting=setting, times=sample_times)
    reasons = (*run.diagnosis.solver, *run.diagnosis.rolling)
    if reasons:
        message = "this run is not to be relied on: " + "; ".join(reasons)
        warnings.warn(message, UntrustedWarning, stacklevel=2)
    for reason in run.diagnosis.liquid:
        warnings.warn(reason, LiquidWarning, stacklevel=2)
    return run


def _every_step(duration: float, timestep: float) -> np.ndarray:
    """Return the times of all steps [s], from 0 to the first one at or after `duration`."""
    ratio = duration / timestep
    if ratio > _MOST_SAMPLES:
        raise ParameterError(
            f"a duration of {duration!r} s has too many timesteps of {timestep!r} s: "
            f"at most {_MOST_SAMPLES:g}, or say with times= which samples to keep"
        )
    nearest = round(ratio)
    last = nearest if abs(ratio - nearest) <= _ON_A_STEP * ratio else math.ceil(ratio)
    return timestep * np.arange(last + 1)


def _sample_times(duration: float | None, setting: Setting, times: np.ndarray) -> np.ndarray:
    """Return the times of the samples [s]; MuJoCo's integrators have exact multiples of a step."""
    timestep = setting.timestep
    if duration is not None and times[-1] > duration * (1 + _ON_A_STEP):
        raise ParameterError(
            f"times must be between 0 and the duration {duration!r} s, got {times[-1]} s"
        )
    if setting.tolerance is not None:
        return times
    ratios = times / timestep
    if ratios[-1] > _MOST_STEPS:
        raise ParameterError(
            f"times must be within {_MOST_STEPS:g} timesteps of {timestep!r} s, got {times[-1]} s"
        )
    if setting.integrator in MJBEER_INTEGRATORS:
        return times
    steps = np.rint(ratios)
    off = (np.abs(ratios - steps) > _ON_A_STEP * ratios) | (np.diff(steps, prepend=-1.0) == 0)
    if off.any():
        raise ParameterError(
            "MuJoCo's integrators have samples at different multiples of the timestep "
            f'{timestep!r} s only, not at {times[off][0]} s; integrator="DOP853" has them anywhere'
        )
    return steps * timestep


def integrate(
    scene: Scene, phi0: float, phi_dot0: float, setting: Setting, times: np.ndarray
) -> Run:
    """Return the motion of a scene in a setting at increasing `times` [s].

    It raises what `simulate` raises. The model starts without the whole turns of `phi0`, as angles
    near 0 have more digits; the samples get them back.
    """
    near_phi0 = reduced(phi0)
    checkpoints = _checkpoints(setting, times)
    with quiet():  # once: the steps and models inside then find it so
        stepped = kept_model(model_numbers(scene, setting))
        start = stepped.initial_state(near_phi0, phi_dot0)
        solution = solve(stepped, setting, start, checkpoints, rounding=turns_rounding(phi0))
    motion = to_coordinates(stepped.model, scene, solution.states, checkpoints)
    stepped.check(motion)
    return Run(
        **_samples(scene, motion, times, turns=phi0 - near_phi0),
        scene=scene,
        phi0=phi0,
        phi_dot0=phi_dot0,
        setting=setting,
        record=solution.record,
        diagnosis=diagnose_run(solution.record, setting, solution.method, near_phi0, phi_dot0),
        method=solution.method,
        error=solution.error,
        checkpoints=motion,
    )


def _samples(
    scene: Scene, motion: Coordinates, times: np.ndarray, turns: float
) -> dict[str, np.ndarray]:
    """Return a motion at those of its times that are samples, by name, with `turns` [rad] added."""
    arrays = dict(vars(motion))
    if motion.time is not times:
        samples = np.searchsorted(motion.time, times)
        arrays = {name: array[samples] for name, array in arrays.items()}
    if turns != 0:
        arrays["phi"] = arrays["phi"] + turns
        if scene.attachment == "frozen":  # u = a phi, and the can turns with its load
            arrays["u"] = arrays["u"] + scene.can.radius * turns
            arrays["roll"] = arrays["roll"] + turns
    return arrays


def _checkpoints(setting: Setting, times: np.ndarray) -> np.ndarray:
    """Return increasing times [s] at which runs are compared: the samples, and more in between.

    With a fixed timestep they are up to `_CHECKPOINTS` steps; with a tolerance, the ends of
    `_PARTS` if samples are few.
    """
    last = times[-1]
    if setting.tolerance is None:
        count = max(1, int(last / setting.timestep))
        steps = np.linspace(0, count, min(count, _CHECKPOINTS) + 1).astype(np.int64)
        more = setting.timestep * steps
    elif (times[1:] - times[:-1]).max(initial=times[0]) > last * _PARTS[1]:
        more = last * _PARTS
    else:
        return times
    both = np.concatenate([times, more[more <= last]])
    both.sort()
    is_new = np.empty(len(both), bool)
    is_new[0] = True
    is_new[1:] = both[1:] > both[:-1]
    return both[is_new]  # unlike union1d this does not import masked arrays
