"""The motions that the benchmark measures."""

from dataclasses import dataclass

import numpy as np

from mjbeer.theory.can import Can
from mjbeer.theory.exact import exact
from mjbeer.theory.scene import Scene, frozen, hoop, pendulum, sliding
from mjbeer.theory.trajectory import Trajectory

SAMPLES = 65
INTERVAL = 32e-3
"""Time between two samples [s]. Every timestep of MuJoCo's integrators is a binary fraction of it, so that all runs
have the same samples without interpolation."""
DURATION = (SAMPLES - 1) * INTERVAL
"""Length of the motions [s]."""


@dataclass(frozen=True)
class Case:
    """A scene and how it starts."""

    name: str
    scene: Scene
    phi0: float
    """Start angle [rad]; all start at rest."""
    command: str
    """The scene and its start as the command line has them."""
    story: str

    @property
    def times(self) -> np.ndarray:
        """The times of the samples [s]."""
        return np.linspace(0, DURATION, SAMPLES)

    def truth(self) -> Trajectory:
        """Return the exact motion at the samples."""
        return exact(self.scene, self.times, self.phi0)


CASES = {
    case.name: case
    for case in (
        Case("sliding", sliding(), 1.0, "sliding --phi0 57.3", "beer that slides in a massless can, from 1 rad"),
        Case(
            "sliding-metal",
            sliding(can=Can.sheet_metal()),
            1.0,
            "sliding --can metal --phi0 57.3",
            "beer that slides in a metal can, from 1 rad",
        ),
        Case("frozen", frozen(), 0.0, "frozen --phi0 0", "frozen beer, rocking from its surface along the incline"),
        Case("pendulum", pendulum(), 1.0, "pendulum --phi0 57.3", "a pendulum on the axle of a wheel, from 1 rad"),
        Case("hoop", hoop(), 0.5, "hoop --phi0 28.65", "a light hoop with a heavy bar on its rim, from 0.5 rad"),
    )
}
DEFAULT = ("sliding", "sliding-metal", "frozen", "pendulum")
