"""The motions that MuJoCo is asked about by more than one row of the audit, each simulated once."""

import math
from functools import cache

from mjbeer.can import Can
from mjbeer.load import Load
from mjbeer.model import DOP853
from mjbeer.scene import Scene, frozen, pendulum, sliding
from mjbeer.simulation import simulate
from mjbeer.trajectory import Trajectory
from mjbeer.witness import Witness, watch

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


def footnote_scene(part: float = 1.0) -> Scene:
    """Appendix A's numbers, footnote 8: a = 3 cm, b = 1 cm, alpha = 10 degrees, g = 980 cm/s^2, I_axis = m a^2/2.

    Or with a `part` of that b.
    """
    a, b, mass = 0.03, 0.01 * part, 1.0
    return Scene(Can.massless(a), Load(mass, b, mass * (a**2 / 2 - b**2)), math.radians(10), "frozen", 9.8)


@cache
def footnote() -> Witness:
    """The roll-down of A.3 with the paper's numbers."""
    return watch(footnote_scene(), "equality", 0.8, math.pi)


@cache
def swung(scene: Scene, phi0: float, duration: float = 4.0, rolling: str = "reduced") -> Trajectory:
    """A swing that is measured, in 4000 steps."""
    return simulate(scene, duration, phi0, rolling=rolling, integrator=DOP853, timestep=duration / 4000)


def balanced(k: float, gravity: float = 9.81) -> Scene:
    """A cylinder of inertia k m a^2 about its axis, rolling: a balanced load frozen to a massless can."""
    can = Can.massless()
    return Scene(can, Load(0.2, 0.0, k * 0.2 * can.radius**2), attachment="frozen", gravity=gravity)


def still(scene: Scene, rolling: str) -> Witness:
    """One second from the equilibrium."""
    return watch(scene, rolling, 1.0, scene.equilibrium() if scene.load.offset else 0.0)
