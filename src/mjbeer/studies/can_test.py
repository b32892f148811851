"""The can test: two motions that theory knows to rounding, and how far another one is from them.

The studies of engines, of MuJoCo's contact and of prisms roll their bodies through these cases.
"""

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from mjbeer.theory.can import RADIUS, Can, Load
from mjbeer.theory.scene import Scene
from mjbeer.theory.trajectory import Trajectory, exact

DURATION = 2.0
"""Length of the motions [s]."""
_MASS = 0.2
"""Mass of the can with its load [kg]."""


@dataclass(frozen=True, eq=False)
class Case:
    """A motion that theory knows to rounding."""

    name: str
    about: str
    """The case in a few words."""
    scene: Scene
    phi0: float
    """phi at the start [rad]."""
    phi_dot0: float
    """Its rate [rad/s]."""

    def truth(self, time: np.ndarray, aside: float = 0.0) -> Trajectory:
        """Return the exact motion at some times [s], from a start so far `aside` [rad]."""
        return exact(self.scene, time, self.phi0 + aside, self.phi_dot0)


def _frozen(offset: float) -> Scene:
    """Return a can without mass, whose frozen load has its centre of mass `offset` [m] off axis.

    About the axis the load has the inertia of a full or of a half cylinder, m a^2/2.
    """
    load = Load(_MASS, offset, _MASS * (RADIUS**2 / 2 - offset**2))
    return Scene(Can.massless(), load, attachment="frozen")


ROCK = Case(
    name="rock",
    about="a half-full can of ice rocks, from 1 rad at 0.5 rad/s",
    scene=_frozen(4 * RADIUS / (3 * math.pi)),
    phi0=1.0,
    phi_dot0=0.5,
)
ROLL = Case(
    name="roll",
    about="a slightly eccentric full can rolls down, from rest",
    scene=_frozen(0.05 * RADIUS),
    phi0=0.0,
    phi_dot0=0.0,
)
"""It turns ten times."""
CASES = {case.name: case for case in (ROCK, ROLL)}
"""Both cases by their names."""


class Errors(NamedTuple):
    """The largest errors of a motion over its samples."""

    phi: float
    """[rad]"""
    u: float
    """Error of u divided by the radius [rad]."""

    @property
    def largest(self) -> float:
        """Return the larger of the two."""
        return max(self)


def errors(truth: Trajectory, phi: np.ndarray, u: np.ndarray) -> Errors:
    """Return how far phi [rad] and u [m] are from an exact motion, at worst over its samples."""
    of_phi = float(np.abs(phi - truth.phi).max())
    of_u = float(np.abs(u - truth.u).max())
    return Errors(of_phi, of_u / truth.scene.can.radius)
