"""Up to a million swings: how a swing's energy drifts with each integrator, and by which law."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from functools import partial
from typing import Any

import numpy as np
import scipy.integrate

from mjbeer.model.setting import DOP853, Integrator, Setting
from mjbeer.predictions.semi_implicit_euler import energy_per_swing
from mjbeer.simulation.run import Prepared
from mjbeer.studies.study import Task
from mjbeer.theory.can import Can
from mjbeer.theory.named import sliding
from mjbeer.theory.scene import Scene

AMPLITUDE = 1.0
"""Amplitude of the swing [rad]."""
BOUNDED, LINEAR = "bounded", "linear"
"""Laws of the drift: the energy stays within bounds, or its drift grows in proportion to the number of swings."""
_EXPONENT = (0.9, 1.1)
"""Measured exponents of the number of swings that count as the linear law: early on, random rounding adds to it."""
_STEADY = 0.05
"""The energy counts as bounded if its largest deviation within any swing exceeds that in the first by less than this
share. The share is not 0 because a period is not exactly a whole number of steps, so that samples fall differently."""
_MOMENTS_A_DECADE = 8
"""Numbers of swings per decade at which the drift is measured."""
_OUT_OF_STEP = 0.37
"""Extra steps a period that keep steps and swings out of phase: in phase, each swing would be rounded like the last."""
_FLOOR = 1e-13
"""Drift, as a share of the energy, below which it is only rounding of the energy and of a hundred swings."""
_SPENT = 0.1
"""Drift, as a share of the energy, above which the swing is too different from the first one to obey its law."""


@dataclass(frozen=True)
class Endurance:
    """A swing that is simulated for very long with one integrator."""

    name: str
    """What kind of can swings."""
    scene: Scene
    integrator: Integrator
    steps: int
    """Timesteps a period."""
    swings: int
    quick_swings: int
    """Number of swings in a quick study; 0 leaves the case out."""
    law: str
    """Law that theory expects of the energy's drift: `BOUNDED` or `LINEAR`."""
    why: str
    """Why theory expects it."""
    exact_steps: bool = False
    """Whether the steps are so small that rounding is the only error."""

    def task(self, quick: bool) -> Task:
        """Return the task of measuring the drift, with fewer swings if `quick`."""
        name = f"{self.name}, {self.integrator}, T/{self.steps}"
        return Task("endurance", name, partial(self.measure, self.quick_swings if quick else self.swings))

    def measure(self, swings: int) -> dict[str, Any]:
        """Return the drift of the energy after different numbers of swings, its exponent, and the law that it obeys."""
        period = self.scene.period(AMPLITUDE)
        counts = _counts(swings)
        drift, width = self._drift(period, counts)
        size = np.abs(drift)
        clear, exponent, law = (size > _FLOOR) & (size < _SPENT), None, None
        if width.max() < (1 + _STEADY) * width[0]:
            law = BOUNDED
        elif clear.sum() >= _MOMENTS_A_DECADE:
            exponent = float(np.polyfit(np.log(counts[clear]), np.log(size[clear]), 1)[0])
            law = LINEAR if _EXPONENT[0] <= exponent <= _EXPONENT[1] else None
        result: dict[str, Any] = {
            "name": self.name,
            "integrator": self.integrator,
            "steps": self.steps,
            "swings": swings,
            "why": self.why,
            "counts": counts.tolist(),
            "drift": drift.tolist(),
            "width": width.tolist(),
            "exponent": exponent,
            "law": law,
            "expected": self.law,
            "as_expected": law == self.law,
        }
        predicted = energy_per_swing(self.scene, AMPLITUDE, period / self.steps, self.integrator)
        moment = 0
        if self.exact_steps:  # after many swings the linear drift exceeds what rounds at random
            predicted, moment = rounded_coefficients(self.steps), -1
        if predicted is not None:
            result |= {"predicted_per_swing": predicted, "measured_per_swing": float(drift[moment] / counts[moment])}
        return result

    def _drift(self, period: float, counts: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return how the energy has changed after each count of swings, as shares of the swing's energy.

        The first array is the mean over that swing minus the mean over the first one; the second is the largest
        deviation from the start within that swing.
        """
        scene = self.scene
        timestep = period / (self.steps + (_OUT_OF_STEP if self.exact_steps else 0))
        prepared = Prepared(scene, Setting(integrator=self.integrator, timestep=timestep))
        start = prepared.start(scene.equilibrium() + AMPLITUDE, 0.0)
        window = np.arange(self.steps)
        samples = np.unique(np.concatenate([window, *(self.steps * int(count) + window for count in counts)]))
        times = timestep * samples
        motion, form = prepared.coordinates(prepared.solve(start, times).states, times), scene.oscillator
        kinetic = form.inertia(motion.phi) * motion.phi_dot**2 / 2
        energy = (kinetic - form.drop(motion.phi, float(motion.phi[0]))) / form.drop(scene.equilibrium(), motion.phi[0])
        places = np.searchsorted(samples, self.steps * counts)
        swings = np.array([energy[place : place + self.steps] for place in places])
        return swings.mean(axis=1) - energy[: self.steps].mean(), np.abs(swings).max(axis=1)


def _counts(swings: int) -> np.ndarray:
    """Return the numbers of swings after which the drift is measured, evenly spread over the decades."""
    decades = math.log10(swings)
    return np.unique(np.rint(np.logspace(0, decades, round(decades * _MOMENTS_A_DECADE) + 1)).astype(np.int64))


def tasks(quick: bool) -> list[Task]:
    """Return one task a case; a `quick` study has at most a thousand swings a case."""
    return [case.task(quick) for case in cases() if not quick or case.quick_swings]


def cases() -> Iterator[Endurance]:
    """Yield the cases: swings of constant inertia, in a can too heavy to move, and swings of varying inertia."""
    heavy, light = sliding(0.0, can=Can.hoop(mass=1e5)), sliding(0.0)
    free, moving = "can too heavy to move", "massless can"
    symplectic = "semi-implicit Euler is symplectic where the mass matrix is constant"
    for integrator in ("Euler", "implicit", "implicitfast", "discrete"):
        swings = 1_000_000 if integrator == "Euler" else 10_000
        yield Endurance(free, heavy, integrator, 32, swings, 1000, BOUNDED, symplectic)
    varying = "the mass matrix varies: each swing loses or gains h/2 times the integral of J' sqrt(w) w'"
    for integrator in ("Euler", "implicit", "implicitfast", "discrete"):
        yield Endurance(moving, light, integrator, 20_000, 30, 30, LINEAR, varying)
    dissipative = "each step loses the share (omega h)^6 / 72 of the energy"
    yield Endurance(free, heavy, "RK4", 32, 1_000_000, 1000, LINEAR, dissipative)
    yield Endurance(moving, light, "RK4", 32, 1_000_000, 1000, LINEAR, dissipative)
    yield Endurance(free, heavy, DOP853, 10, 1_000_000, 1000, LINEAR, "each step loses the same share of the energy")
    rounding = "the steps are exact, but for the method's coefficients, which are rounded to doubles"
    yield Endurance(free, heavy, DOP853, 160, 100_000, 0, LINEAR, rounding, exact_steps=True)


def rounded_coefficients(steps: int) -> float:
    """Return the share of its energy that a small swing gains a period because DOP853's coefficients are rounded.

    With errors e of sum(b) = 1 and f of sum(b c) = 1/2, the method's |R(iy)|^2 is 1 + 2 (e - f) y^2, y = 2 pi/`steps`;
    the errors of higher conditions come with higher powers of y.
    """
    method = scipy.integrate.DOP853
    weights = [Fraction(float(weight)) for weight in method.B]
    nodes = [sum(Fraction(float(coefficient)) for coefficient in row) for row in method.A[: len(method.B)]]
    e = sum(weights) - 1
    f = sum(weight * node for weight, node in zip(weights, nodes, strict=True)) - Fraction(1, 2)
    return 2 * float(e - f) * (2 * math.pi / steps) ** 2 * steps
