"""Laws that motions obey near an extreme, such as an unstable equilibrium, measured on MuJoCo's motions."""

import dataclasses
import math
from collections.abc import Iterator
from typing import Any

import numpy as np
from scipy.interpolate import CubicHermiteSpline

from mjbeer.model.setting import DOP853, Integrator
from mjbeer.predictions.semi_implicit_euler import euler_motion
from mjbeer.simulation.simulate import simulate
from mjbeer.studies.check import Check
from mjbeer.studies.convergence import observed_order
from mjbeer.studies.study import Task
from mjbeer.theory.can import Can
from mjbeer.theory.exact import exact
from mjbeer.theory.named import frozen, pendulum, sliding
from mjbeer.theory.scene import Scene

_BESIDE_FOLD = np.array([1e-6, 1e-7, 1e-8])
"""Relative distances of sin(alpha) from that of the steepest incline with an equilibrium, the fold."""
_BESIDE_SEPARATRIX = np.array([1e-4, 1e-6, 1e-8, 1e-10])
"""Distances [rad] of the start from the end of the largest swing, the separatrix."""
_SIZES = (2e-4, 1e-3, 25.0)
_GRAVITIES = (1e-3, 1e3)
"""Radii [m] and gravities [m/s^2] at which the scaled motion must be the same."""


def tasks() -> list[Task]:
    """Return one task a law."""
    return [Task("laws", f"{law.quantity} ({law.by})", lambda law=law: _measure(law)) for law in laws()]


def _measure(law: Check) -> dict[str, Any]:
    result = law.measure()
    return dataclasses.asdict(result) | {"as_expected": result.passed}


def laws() -> Iterator[Check]:
    """Yield the laws."""
    yield Check(
        "frequency over distance from the fold: exponent less 1/4",
        "frozen, reduced, DOP853",
        bound=1e-3,
        unit="",
        reason="the next term of the expansion: the square root of the largest distance, 1e-6",
        deviation=lambda: _fold_exponent() - 0.25,
    )
    scenes = {"sliding, metal can": sliding(can=Can.sheet_metal()), "frozen": frozen(), "pendulum": pendulum()}
    for name, scene in scenes.items():
        yield Check(
            "fall from beside the separatrix over the logarithm of the distance: slope",
            f"{name}, reduced, DOP853",
            bound=1e-5,
            unit="relative",
            reason="rounding by 4e-16 rad at the top, against the smallest distance of 1e-10 rad",
            deviation=lambda scene=scene: _measured_fall_slope(scene) / fall_slope(scene) - 1,
        )
    for integrator, duration in (("Euler", 8.0), ("implicit", 2.4)):
        yield Check(
            f"rolling down for {duration} s, by how much the timestep falsifies the turn",
            f"frozen, equality, {integrator}, 1 ms",
            bound=1e-3,
            unit="relative",
            reason="second order in the timestep",
            deviation=lambda integrator=integrator, duration=duration: _timestep_error_ratio(integrator, duration),
        )
    for make, name in ((sliding, "sliding"), (frozen, "frozen")):
        yield Check(
            "similarity: phi over t sqrt(g/a), cans of 0.2 mm to 25 m, 1e-3 to 1e3 m/s^2",
            f"{name}, metal can, reduced, DOP853",
            bound=1e-10,
            unit="rad",
            reason="rounding of the scaled scene's sizes and masses",
            deviation=lambda make=make: _dissimilarity(make),
        )
        yield Check(
            "full can, let go at 1 rad: how far it comes in 10 s",
            f"{name if make is sliding else 'frozen, on the level'}, reduced, RK4, 1 ms",
            bound=0.0,
            unit="rad",
            reason="b = 0, so that the torque is 0 as well",
            deviation=lambda make=make: _largest_swing_of_full_can(make),
        )


def fall_slope(scene: Scene) -> float:
    """Return dt/d(ln distance) [s] for the time t to fall from beside an unstable equilibrium.

    It is -1/lambda with lambda^2 = -V''/J, since the distance grows as cosh(lambda t). A period has four such times
    where both ends of the swing are unstable equilibria, as on level ground and for any sliding load, and two for a
    frozen load on an incline.
    """
    form = scene.oscillator
    return -math.sqrt(float(form.inertia(scene.separatrix()[1])) / form.crest.curvature)


def _fold_exponent() -> float:
    """Return the measured exponent of the frequency over the distance from the fold."""
    fold, frequencies = math.sin(frozen().largest_incline()), []
    for beside in _BESIDE_FOLD:
        scene = frozen(math.asin(fold * (1 - beside)))
        amplitude = 1e-3 * math.sqrt(
            beside
        )  # far smaller than the width of the well, which shrinks like the square root too
        period = scene.period(amplitude)
        run = simulate(scene, 2.2 * period, scene.equilibrium() + amplitude, integrator=DOP853, timestep=period / 50)
        frequencies.append(run.frequency())
    return observed_order(_BESIDE_FOLD, np.array(frequencies))


def _measured_fall_slope(scene: Scene) -> float:
    """Return the measured dt/d(ln distance) [s] of a fall from beside the separatrix."""
    top, bottom, times = scene.separatrix()[1], scene.equilibrium(), []
    for beside in _BESIDE_SEPARATRIX:
        period = scene.period(top - beside - bottom)
        run = simulate(scene, period / 2, top - beside, integrator=DOP853, timestep=period / 1000)
        times.append(CubicHermiteSpline(run.time, run.phi, run.phi_dot).solve(bottom, extrapolate=False)[0])
    return float(np.polyfit(np.log(_BESIDE_SEPARATRIX), times, 1)[0])


def _timestep_error_ratio(integrator: Integrator, duration: float) -> float:
    """Return the error of the turn due to the timestep over the predicted one, less 1."""
    scene, timestep, times = frozen(), 1e-3, np.array([0.0, duration])
    truth = exact(scene, times, math.pi).phi[-1]
    run = simulate(scene, duration, math.pi, rolling="equality", integrator=integrator, timestep=timestep, times=times)
    return (run.phi[-1] - truth) / (euler_motion(scene, times, timestep, integrator, math.pi)[-1] - truth) - 1


def _dissimilarity(make: Any) -> float:
    """Return the largest difference of phi [rad] between cans of other sizes and gravities and the usual can."""

    def phi(radius: float, gravity: float) -> np.ndarray:
        # The proportions of the default can: radius 33 mm, length 120 mm, 0.1 mm of sheet metal.
        can = Can.sheet_metal(radius, radius * 0.12 / 0.033, radius * 1e-4 / 0.033)
        slow = math.sqrt(radius / gravity)
        return simulate(make(can=can, gravity=gravity), 40 * slow, 1.0, integrator=DOP853, timestep=slow / 8).phi

    usual = phi(0.033, 9.81)
    others = [*(phi(size, 9.81) for size in _SIZES), *(phi(0.033, gravity) for gravity in _GRAVITIES)]
    return max(float(np.abs(usual - other).max()) for other in others)


def _largest_swing_of_full_can(make: Any) -> float:
    """Return how far the load of a full can moves [rad] in 10 s, let go at 1 rad."""
    scene = make(fill=1.0) if make is sliding else make(0.0, fill=1.0)
    return float(np.abs(simulate(scene, 10.0, 1.0).phi - 1.0).max())
