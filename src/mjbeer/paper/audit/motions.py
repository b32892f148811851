"""The motions that several claims of the audit share, each simulated once, and the errors that they have."""

import math
from functools import cache

from mjbeer.model.setting import DOP853, Rolling
from mjbeer.paper.audit.witness import Witness, watch
from mjbeer.paper.scenarios import footnote_scene
from mjbeer.simulation.simulate import simulate
from mjbeer.theory.can import Can
from mjbeer.theory.named import frozen, pendulum, sliding
from mjbeer.theory.scene import Scene
from mjbeer.theory.trajectory import Trajectory

LARGE, MODERATE, SMALL = 2.0, 1.0, 1e-3
"""Amplitudes [rad]: at the first every term of an equation matters, the second is clearly not small, the third is."""
REDUCED = "MuJoCo, reduced"
EQUALITY = "MuJoCo, equality"
CONTACT = "MuJoCo, contact"
THEORY = "exact theory"
EXACT, ROUNDING = 1e-12, "rounding of MuJoCo's forward dynamics"
HELD, DRIFT = 2e-8, "what MuJoCo's joint equality takes back of its drift"
"""Bounds of the errors that MuJoCo has in the reduced model, and where a constraint makes the can roll; the reasons."""


@cache
def swing(amplitude: float = LARGE, incline: float = math.radians(10)) -> Witness:
    """Return a second of beer that slides in a massless can, let go at an amplitude on an incline [rad]."""
    return watch(sliding(incline), "reduced", 1.0, amplitude)


@cache
def metal() -> Witness:
    """Return a second of beer that slides in the 12-oz can of sheet metal, let go at 2 rad."""
    return watch(sliding(can=Can.sheet_metal()), "equality", 1.0, LARGE)


@cache
def wheel() -> Witness:
    """Return a second of a pendulum in a wheel, let go at 2 rad."""
    return watch(pendulum(), "equality", 1.0, LARGE)


@cache
def rolling_down() -> Witness:
    """Return the first 0.8 s of a can with frozen beer that rolls down, let go with the beer on top."""
    return watch(frozen(), "equality", 0.8, math.pi)


@cache
def footnote() -> Witness:
    """Return the same roll-down with the numbers of the paper's section A.3."""
    return watch(footnote_scene(), "equality", 0.8, math.pi)


@cache
def long_swing(scene: Scene, phi0: float, duration: float = 4.0, rolling: Rolling = "reduced") -> Trajectory:
    """Return a swing, simulated in 4000 steps, whose frequency is to be measured."""
    return simulate(scene, duration, phi0, rolling=rolling, integrator=DOP853, timestep=duration / 4000)


def equilibrium_motion(scene: Scene, rolling: Rolling) -> Witness:
    """Return a second that starts at the equilibrium; a balanced load starts at phi = 0."""
    return watch(scene, rolling, 1.0, scene.equilibrium() if scene.load.offset else 0.0)
