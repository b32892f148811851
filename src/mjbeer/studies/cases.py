"""The standard cases of the studies: scenes, the start of each motion, and the times of its samples."""

from dataclasses import dataclass

import numpy as np

from mjbeer.theory.can import Can
from mjbeer.theory.exact import exact
from mjbeer.theory.named import frozen, hoop, pendulum, sliding
from mjbeer.theory.scene import Scene
from mjbeer.theory.trajectory import Trajectory

SAMPLES = 65
"""Samples of each motion, with both ends."""
INTERVAL = 32e-3
"""Time between two samples [s]. It is a power of two times every timestep tried with MuJoCo's integrators, so that all
runs have the same samples without interpolation."""
DURATION = (SAMPLES - 1) * INTERVAL
"""Duration of the motions [s]."""


@dataclass(frozen=True)
class Case:
    """A scene and the start of its motion, at rest."""

    name: str
    scene: Scene
    phi0: float
    """Initial phi [rad]."""
    story: str
    """The case in a few words, for titles."""

    @property
    def times(self) -> np.ndarray:
        """The times of the samples [s]."""
        return np.linspace(0, DURATION, SAMPLES)

    def truth(self) -> Trajectory:
        """Return the exact motion at the times of the samples."""
        return exact(self.scene, self.times, self.phi0)


_ALL = (
    Case("sliding", sliding(), 1.0, "beer that slides in a massless can, from 1 rad"),
    Case("sliding-metal", sliding(can=Can.sheet_metal()), 1.0, "beer that slides in a metal can, from 1 rad"),
    Case("frozen", frozen(), 0.0, "frozen beer, rocking from its surface along the incline"),
    Case("pendulum", pendulum(), 1.0, "a pendulum on the axle of a wheel, from 1 rad"),
    Case("hoop", hoop(), 0.5, "a light hoop with a heavy bar on its rim, from 0.5 rad"),
    Case("stiff", sliding(damping=1.0), 1.0, "beer that hardly slides in a massless can, from 1 rad"),
    Case("stiffer", sliding(damping=100.0), 1.0, "beer that is nearly frozen to a massless can, from 1 rad"),
)
CASES = {case.name: case for case in _ALL if not case.scene.dissipates}
DEFAULT = ("sliding", "sliding-metal", "frozen", "pendulum")
"""The cases that the benchmark measures if none is named."""
STIFF = {case.name: case for case in _ALL if case.scene.dissipates}
"""Cases of the benchmark alone: damping brings can and load together ten thousand times a second, or a million times,
which explicit methods have to follow."""
MEASURED = CASES | STIFF
"""All cases that the benchmark can measure."""
