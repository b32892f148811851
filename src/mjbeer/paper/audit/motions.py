"""The motions that MuJoCo is asked about by more than one row of the audit, each simulated once."""

import math
from functools import cache

from mjbeer.model.setting import DOP853
from mjbeer.paper.audit.witness import Witness, watch
from mjbeer.paper.scenarios import footnote_scene
from mjbeer.simulation.simulate import simulate
from mjbeer.theory.can import Can
from mjbeer.theory.scene import Scene, frozen, pendulum, sliding
from mjbeer.theory.trajectory import Trajectory

LARGE, MODERATE, SMALL = 2.0, 1.0, 1e-3
"""Amplitudes [rad]: one at which every term of an equation counts, one that is clearly not small, and a small one."""
REDUCED = "MuJoCo, reduced"
EQUALITY = "MuJoCo, equality"
CONTACT = "MuJoCo, contact"
THEORY = "exact theory"
EXACT, ROUNDING = 1e-12, "rounding of MuJoCo's forward dynamics"
HELD, DRIFT = 2e-8, "what MuJoCo's joint equality takes back of its drift"


@cache
def swing(amplitude: float = LARGE, incline: float = math.radians(10)) -> Witness:
    """Beer that slides in a massless can."""
    return watch(sliding(incline), "reduced", 1.0, amplitude)


@cache
def metal() -> Witness:
    """Beer that slides in the 12-oz can."""
    return watch(sliding(can=Can.sheet_metal()), "equality", 1.0, LARGE)


@cache
def wheel() -> Witness:
    """A pendulum in a wheel."""
    return watch(pendulum(), "equality", 1.0, LARGE)


@cache
def rolling_down() -> Witness:
    """Beer frozen to its can, from the top."""
    return watch(frozen(), "equality", 0.8, math.pi)


@cache
def footnote() -> Witness:
    """The roll-down of A.3 with the paper's numbers."""
    return watch(footnote_scene(), "equality", 0.8, math.pi)


@cache
def swung(scene: Scene, phi0: float, duration: float = 4.0, rolling: str = "reduced") -> Trajectory:
    """A swing that is measured, in 4000 steps."""
    return simulate(scene, duration, phi0, rolling=rolling, integrator=DOP853, timestep=duration / 4000)


def still(scene: Scene, rolling: str) -> Witness:
    """One second from the equilibrium."""
    return watch(scene, rolling, 1.0, scene.equilibrium() if scene.load.offset else 0.0)
