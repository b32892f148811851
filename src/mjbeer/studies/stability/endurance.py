"""A million swings: how an integrator's energy drifts, and by which law."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from functools import partial
from typing import Any

import numpy as np
import scipy.integrate

from mjbeer.model.setting import DOP853, Setting
from mjbeer.predictions.semi_implicit_euler import energy_per_swing
from mjbeer.simulation.prepare import Prepared
from mjbeer.studies.study import Task
from mjbeer.theory.can import Can
from mjbeer.theory.scene import Scene, sliding

AMPLITUDE = 1.0
"""Of the swing [rad]."""
BOUNDED, LINEAR = "bounded", "linear"
_EXPONENT = (0.9, 1.1)
"""Exponents of the number of swings that go by the linear law; at first, rounding at random adds to it."""
_STEADY = 0.05
"""Share by which the largest deviation within a swing may differ from that in the first one if it is bounded: the
samples fall otherwise on a swing whose period is not quite a number of steps."""
_MOMENTS_A_DECADE = 8
_OUT_OF_STEP = 0.37
_FLOOR = 1e-13
"""Share of the energy under which a drift is rounding, of the energy itself and of some hundred swings."""
_SPENT = 0.1
"""Share of the energy above which a drift no longer is that of the swing it began with."""


@dataclass(frozen=True)
class Endurance:
    """A long libration with one integrator."""

    name: str
    scene: Scene
    integrator: str
    steps: int
    """Timesteps a period."""
    swings: int
    quick_swings: int
    law: str
    """What theory expects of the energy's drift."""
    why: str
    exact_steps: bool = False
    """Whether the steps are so small that only rounding is left."""

    def task(self, quick: bool) -> Task:
        """Return the task of measuring it, or a thousandth of it."""
        name = f"{self.name}, {self.integrator}, T/{self.steps}"
        return Task("endurance", name, partial(self.measure, self.quick_swings if quick else self.swings))

    def measure(self, swings: int) -> dict[str, Any]:
        """Return the drift of the energy over the number of swings, its exponent, and the law that it obeys."""
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
        found: dict[str, Any] = {
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
        then = 0
        if self.exact_steps:  # what rounds at random shrinks beside it with the number of swings
            predicted, then = rounded_coefficients(self.steps), -1
        if predicted is not None:
            found |= {"predicted_per_swing": predicted, "measured_per_swing": float(drift[then] / counts[then])}
        return found

    def _drift(self, period: float, counts: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Mean energy of the swing after each count less that of the first, and its largest deviation from the start,
        both relative to the swing's energy."""
        scene = self.scene
        # In step with the swing, each one would be rounded like the one before.
        timestep = period / (self.steps + (_OUT_OF_STEP if self.exact_steps else 0))
        prepared = Prepared(scene, Setting(integrator=self.integrator, timestep=timestep))
        start = prepared.start(scene.equilibrium() + AMPLITUDE, 0.0)
        window = np.arange(self.steps)
        wanted = np.unique(np.concatenate([window, *(self.steps * int(count) + window for count in counts)]))
        times = timestep * wanted
        motion, form = prepared.coordinates(prepared.solve(start, times).states, times), scene.oscillator
        kinetic = form.inertia(motion.phi) * motion.phi_dot**2 / 2
        energy = (kinetic - form.drop(motion.phi, float(motion.phi[0]))) / form.drop(scene.equilibrium(), motion.phi[0])
        places = np.searchsorted(wanted, self.steps * counts)
        swings = np.array([energy[place : place + self.steps] for place in places])
        return swings.mean(axis=1) - energy[: self.steps].mean(), np.abs(swings).max(axis=1)


def _counts(swings: int) -> np.ndarray:
    decades = math.log10(swings)
    return np.unique(np.rint(np.logspace(0, decades, round(decades * _MOMENTS_A_DECADE) + 1)).astype(np.int64))


def tasks(quick: bool) -> list[Task]:
    """Return a task a case; quickly, for a thousand swings at most."""
    return [case.task(quick) for case in cases() if not quick or case.quick_swings]


def cases() -> Iterator[Endurance]:
    """Yield the cases: a swing whose inertia is constant, since its can is too heavy to move, and one whose is not."""
    heavy, light = sliding(0.0, can=Can.hoop(mass=1e9)), sliding(0.0)
    free, moving = "can too heavy to move", "massless can"
    symplectic = "semi-implicit Euler is symplectic where the mass matrix is constant"
    for integrator in ("Euler", "implicit", "implicitfast", "discrete"):
        swings = 1_000_000 if integrator == "Euler" else 10_000
        yield Endurance(free, heavy, integrator, 32, swings, 1000, BOUNDED, symplectic)
    varying = "where it is not, each swing loses or gains h/2 times the integral of J' sqrt(w) w'"
    for integrator in ("Euler", "implicit", "implicitfast", "discrete"):
        yield Endurance(moving, light, integrator, 20_000, 30, 30, LINEAR, varying)
    dissipative = "its steps lose a share of (omega h)^6 / 72"
    yield Endurance(free, heavy, "RK4", 32, 1_000_000, 1000, LINEAR, dissipative)
    yield Endurance(moving, light, "RK4", 32, 1_000_000, 1000, LINEAR, dissipative)
    yield Endurance(free, heavy, DOP853, 10, 1_000_000, 1000, LINEAR, "its steps lose the same share each")
    rounding = "its steps are exact but for the rounding of its coefficients to doubles"
    yield Endurance(free, heavy, DOP853, 160, 100_000, 0, LINEAR, rounding, exact_steps=True)


def rounded_coefficients(steps: int) -> float:
    """Return the share of its energy that a small swing gains in each period because DOP853's coefficients are doubles.

    With errors e of sum(b) = 1 and f of sum(b c) = 1/2, the method's |R(iy)|^2 is 1 + 2 (e - f) y^2, y = 2 pi/`steps`;
    the errors of higher conditions come with higher powers of y.
    """
    method = scipy.integrate.DOP853
    weights = [Fraction(float(each)) for each in method.B]
    nodes = [sum(Fraction(float(each)) for each in row) for row in method.A[: len(method.B)]]
    e = sum(weights) - 1
    f = sum(weight * node for weight, node in zip(weights, nodes, strict=True)) - Fraction(1, 2)
    return 2 * float(e - f) * (2 * math.pi / steps) ** 2 * steps
