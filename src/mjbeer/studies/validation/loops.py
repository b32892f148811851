"""Checks of loads that loop for ever although they are damped: their mean slip rate, and its variance."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache

import numpy as np
from scipy.interpolate import CubicHermiteSpline

from mjbeer.model.setting import DOP853
from mjbeer.simulation.run import Run
from mjbeer.simulation.simulate import simulate
from mjbeer.studies.check import Check
from mjbeer.theory.can import Can
from mjbeer.theory.named import sliding
from mjbeer.theory.scene import Scene

_SETTLED = 30.0
"""Time after which a loop is steady [s]: what distinguishes it decays in a second or faster."""


def checks(cans: Mapping[str, Can]) -> Iterator[Check]:
    """Yield the checks of loops of scenes with these cans."""
    steep, shallow = math.radians(30), sliding(damping=3e-3)
    for name, scene, rate in (
        ("massless can, 30 degrees, 3e-3 N m s", sliding(steep, damping=3e-3), 132.9),
        ("metal can, 30 degrees, 1e-2 N m s", sliding(steep, can=cans["metal can"], damping=1e-2), 120.1),
        ("massless can, 10 degrees, 3e-3 N m s", shallow, 72.7),
    ):
        by = f"sliding, {name}, looping, reduced, DOP853, 1 ms"
        reason = "the ends of whole turns, interpolated between samples 0.2 ms apart"
        yield Check(
            quantity="mean slip rate D of a load that turns steadily",
            by=by,
            bound=1e-9,
            unit="relative",
            reason=reason,
            deviation=lambda scene=scene, rate=rate: _loop(scene, rate).mean / scene.slip_rate() - 1,
        )
        yield Check(
            quantity="variance of the slip rate, D times the mean rate of the load",
            by=by,
            bound=1e-9,
            unit="relative",
            reason=reason,
            deviation=lambda scene=scene, rate=rate: _loop(scene, rate).excess(scene),
        )
    yield Check(
        quantity="ways to go on for ever, less two: steady rolling and a loop",
        by="sliding, massless can, 10 degrees, 3e-3 N m s, reduced",
        bound=0,
        unit="",
        reason="the load turns or not",
        deviation=lambda: sum((_rolls(shallow), _loop(shallow, 72.7).turning > 1)) - 2,
    )


@dataclass(frozen=True)
class _Loop:
    """A steady loop over a whole number of turns."""

    turning: float
    """Mean rate of the load [rad/s]."""
    mean: float
    """Mean slip rate [rad/s]."""
    variance: float
    """Variance of the slip rate [rad^2/s^2]."""

    def excess(self, scene: Scene) -> float:
        """Return by how much the variance exceeds D times the mean rate of the load, relative."""
        return self.variance / (scene.slip_rate() * self.turning) - 1


@cache
def _loop(scene: Scene, rate: float) -> _Loop:
    """Return what is measured on the steady loop that MuJoCo reaches from a start at phi = 0 with a `rate` [rad/s].

    Over whole turns even samples give the mean of what is periodic to rounding; how long they last is found first.
    """
    end = _SETTLED + 1

    def run(times: np.ndarray) -> Run:
        return simulate(scene, end, 0.0, rate, integrator=DOP853, times=times)

    some = run(np.linspace(_SETTLED, end, 5001))
    turns = math.floor((some.phi[-1] - some.phi[0]) / (2 * math.pi))
    angle = CubicHermiteSpline(some.time, some.phi, some.phi_dot)
    last = angle.solve(some.phi[0] + 2 * math.pi * turns, extrapolate=False)[-1]
    whole = run(np.linspace(_SETTLED, last, 64 * turns + 1))
    slip = whole.u_dot / scene.can.radius - whole.phi_dot
    duration = float(last) - _SETTLED
    turning = float(whole.phi[-1] - whole.phi[0]) / duration
    mean = float(whole.u[-1] - whole.u[0]) / scene.can.radius / duration - turning
    return _Loop(turning, mean, float(((slip - mean) ** 2)[:-1].mean()))


def _rolls(scene: Scene) -> bool:
    """Return whether a load that starts at rest near the terminal tilt does not turn in the end."""
    times = np.array([_SETTLED, _SETTLED + 1])
    phi = simulate(scene, times[-1], scene.terminal_tilt() + 0.1, times=times).phi
    return bool(abs(phi[1] - phi[0]) < 1e-3)
