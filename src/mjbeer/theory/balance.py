"""What a motion with damping or drag should conserve, and does not: what it loses, less what these forces take."""

import numpy as np

from mjbeer.theory import equations
from mjbeer.theory.equations import Coordinates
from mjbeer.theory.losses import forgetting, losses
from mjbeer.theory.scene import Scene


class Balance:
    """The largest changes of a motion's energies and of its axis that damping and drag do not explain.

    They make up for an error of the speed, which is lost as the speed itself is. Only what lasts of it moves the axis.
    """

    def __init__(self, scene: Scene) -> None:
        """Begin with nothing."""
        self._scene = scene
        self.energy_change = 0.0
        """Of the energy of can and load and the work of damping and drag together [J]."""
        self.swing_change = 0.0
        """Of the energy of the swing [J]."""
        self.axis_change = 0.0
        """Of the place of the axis [m]."""
        self._energy = self._swing = self._way = self._speed = 0.0

    def add(self, motion: Coordinates, last: Coordinates) -> None:
        """Add the next piece of the motion, with the last sample before it."""
        scene = self._scene
        joined = Coordinates(
            **{name: np.append(getattr(last, name), values) for name, values in vars(motion).items() if name in _NAMES}
        )
        lost = losses(scene, joined)
        energy = np.diff(equations.energy(scene, joined)) + lost.work
        energies = self._energy + np.cumsum(energy)
        self._energy, self.energy_change = float(energies[-1]), _largest(self.energy_change, energies)
        # Of a motion that can and load make as one the energy tells as much, and no sum of large torques has to cancel.
        swing = energy if lost.swing is None else _swing(scene, joined) + lost.swing
        changes = self._swing + np.cumsum(swing)
        self._swing, self.swing_change = float(changes[-1]), _largest(self.swing_change, changes)
        self._add_axis(joined, lost.speed, lost.way)

    def _add_axis(self, joined: Coordinates, lost_speed: np.ndarray, lost_way: np.ndarray) -> None:
        """Add how far the axis is from where the forces of theory along the motion itself would have it."""
        scene, step = self._scene, np.diff(joined.time)
        way, speed = equations.axis_without_swing(scene, joined)
        steady = equations.steady_acceleration(scene)
        too_fast = np.diff(speed) - steady * step + lost_speed
        too_far = np.diff(way) - step * speed[:-1] - steady * step**2 / 2 + lost_way
        rate = forgetting(scene, joined.phi_dot[:-1], joined.u_dot[:-1])
        kept = np.exp(-rate * step)
        speeds = _relax(kept, too_fast, self._speed)
        with np.errstate(divide="ignore", invalid="ignore"):
            time = np.where(rate * step > 0, -np.expm1(-rate * step) / rate, step)
        ways = self._way + np.cumsum(too_far + time * speeds[:-1])
        self._way, self._speed = float(ways[-1]), float(speeds[-1])
        self.axis_change = _largest(self.axis_change, ways)


_NAMES = tuple(Coordinates.__dataclass_fields__)


def _swing(scene: Scene, motion: Coordinates) -> np.ndarray:
    """Return by how much the energy of the swing grows from each sample to the next one [J]."""
    oscillator = scene.oscillator
    phi, kinetic = motion.phi, oscillator.inertia(motion.phi) * motion.phi_dot**2 / 2
    return np.diff(kinetic) - oscillator.drop(phi[1:], phi[:-1])


def _relax(kept: np.ndarray, added: np.ndarray, first: float) -> np.ndarray:
    """Return what is `first`, of which a step keeps the share `kept` and gains `added`, before all steps and after."""
    from scipy.linalg import solve_banded  # only here, as most scenes have no losses

    matrix = np.stack([np.ones(len(kept) + 1), np.append(-kept, 0.0)])
    return solve_banded((1, 0), matrix, np.append(first, added), check_finite=False)


def _largest(so_far: float, values: np.ndarray) -> float:
    """Return the largest magnitude; NaN if there is one, which `max` would hide."""
    return float(np.maximum(so_far, np.abs(values).max()))
