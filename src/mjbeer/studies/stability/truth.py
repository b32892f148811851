"""Where a scene truly is at some times: by two theories that share no code, and how far rounding lets them part."""

import dataclasses
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass

import numpy as np

from mjbeer.exceptions import NoLibrationError, ParameterError, ToleranceError
from mjbeer.studies.stability.reference.lagrangian import LongMotionError, reference
from mjbeer.theory.conserved import kinetic_energy
from mjbeer.theory.coordinates import Coordinates
from mjbeer.theory.exact import exact
from mjbeer.theory.scene import Scene

_ROUNDING = float(np.finfo(float).eps)
_NUDGES = 30.0
"""Largest distance of the two theories over the effect of nudging the start and the scene by a rounding each."""
_FLOOR = 3e-11
"""Distance of the two theories that needs no explanation [rad], relative beyond 1 rad: the rounding of some hundred
swings, each of which the reference makes in twenty steps, or more where the load passes the bottom in no time."""
_LAST_DIGITS = 4.0
"""The same in roundings of the angle itself, which has few digits left after many turns."""


@dataclass(frozen=True, eq=False)
class Angles:
    """phi and u/a of a motion [rad] at some times, and where both started."""

    phi: np.ndarray
    roll: np.ndarray
    start: tuple[float, float]

    def off(self, phi: np.ndarray, roll: np.ndarray) -> float:
        """Return the largest distance of `phi` and `roll` from this motion [rad], relative to the way beyond 1 rad."""
        pairs = (phi, self.phi, self.start[0]), (roll, self.roll, self.start[1])
        return float(np.max([_off(angles, truth, start) for angles, truth, start in pairs]))


@dataclass(frozen=True, eq=False)
class Truth:
    """The motion at the times of the samples, by each theory that has it."""

    motions: tuple[Angles, ...]
    """The motions: that of `exact` first, that of `reference` last."""
    apart: float
    """Largest distance of the two theories [rad], relative beyond 1 rad; 0 if there is only one."""
    explained: bool
    """Whether the effect of rounding on the motion explains that distance."""
    kinetic: float
    """Largest kinetic energy of can and load at the samples [J]."""

    def off(self, phi: np.ndarray, roll: np.ndarray) -> float:
        """Return the largest distance of `phi` and `roll` [rad] from the nearer theory, relative beyond 1 rad.

        Where rounding explains that the two part, either is the motion of a start that doubles cannot tell from this.
        """
        return float(np.min([motion.off(phi, roll) for motion in self.motions]))


def truth(scene: Scene, times: np.ndarray, phi0: float, phi_dot0: float) -> Truth:
    """Return the motion at increasing `times` [s] that starts at `phi0` [rad] with `phi_dot0` [rad/s] at time 0."""
    motions: list[Coordinates] = []
    with suppress(
        NoLibrationError, ParameterError, ToleranceError
    ):  # on the separatrix, and beyond what rounding leaves to it
        motions.append(exact(scene, times, phi0, phi_dot0, many_turns=True))
    try:
        motions.append(reference(scene, times, phi0, phi_dot0))
    except LongMotionError:
        if not motions:
            raise
    found = tuple(angles(scene, motion, phi0, phi_dot0) for motion in motions)
    apart, explained = 0.0, True
    if len(found) > 1:
        apart = found[1].off(found[0].phi, found[0].roll)
        floor = _FLOOR + _LAST_DIGITS * _ROUNDING * max(float(np.abs(found[1].phi).max()), abs(phi0))
        explained = apart <= floor or apart <= _NUDGES * _condition(scene, times, phi0, phi_dot0, found[1])
    kinetic = max(float(kinetic_energy(scene, motion).max()) for motion in motions)
    return Truth(found, apart, explained, kinetic)


def angles(scene: Scene, motion: Coordinates, phi0: float, phi_dot0: float) -> Angles:
    """Return the angles of a motion that starts at `phi0` [rad] with `phi_dot0` [rad/s]."""
    start = phi0, scene.start(phi0, phi_dot0)[0] / scene.can.radius
    return Angles(motion.phi, motion.u / scene.can.radius, start)


def _off(angles: np.ndarray, truth: np.ndarray, start: float) -> float:
    turned = np.maximum.accumulate(np.abs(truth - start))
    return float(np.max(np.abs(angles - truth) / np.maximum(1, turned)))


def _condition(scene: Scene, times: np.ndarray, phi0: float, phi_dot0: float, motion: Angles) -> float:
    """Return by how much a rounding of start and scene moves the motion [rad], relative beyond 1 rad."""
    total = 0.0
    for other, phi, phi_dot in _beside(scene, phi0, phi_dot0):
        nudged = reference(other, times, phi, phi_dot)
        total += motion.off(nudged.phi, nudged.u / scene.can.radius)
    return total


def _beside(scene: Scene, phi0: float, phi_dot0: float) -> Iterator[tuple[Scene, float, float]]:
    """Yield scene and start with one number nudged by a rounding."""
    aside = _ROUNDING * max(1.0, abs(phi0))
    yield scene, phi0 + aside, phi_dot0
    yield scene, phi0 - aside, phi_dot0
    yield scene, phi0, phi_dot0 * (1 + _ROUNDING)
    for name in ("incline", "gravity"):
        yield dataclasses.replace(scene, **{name: getattr(scene, name) * (1 + _ROUNDING)}), phi0, phi_dot0
