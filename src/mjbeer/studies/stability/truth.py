"""Where a scene truly is at some times: by two theories that share no code, and how far rounding lets them part."""

import dataclasses
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from mjbeer.exceptions import NoLibrationError, ParameterError, ToleranceError
from mjbeer.studies.stability.reference.lagrangian import LongMotionError, reference
from mjbeer.theory.conserved import kinetic_energy
from mjbeer.theory.coordinates import Coordinates
from mjbeer.theory.exact import solution
from mjbeer.theory.scene import Scene

_ROUNDING = float(np.finfo(float).eps)
_NUDGES = 10.0
"""Largest distance of the two theories over the effect of nudging start and scene by a rounding each. In 2,400 random
runs it was at most 2 where it needed an explanation."""
_FLOOR = 1e-11
"""Distance of the two theories that needs no explanation [rad], relative beyond 1 rad: the rounding of some hundred
swings, each of which the reference makes in twenty steps, is up to 1e-12."""
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
    """The motions that a run may be near: that of each theory, and if they part those of starts a rounding aside."""
    apart: float | None
    """Largest distance of the two theories [rad], relative beyond 1 rad; None if only one has the motion."""
    explained: bool
    """Whether the effect of rounding on the motion explains that distance; False if no theory has the motion."""
    kinetic: float
    """Largest kinetic energy of can and load at the samples [J]."""

    def off(self, phi: np.ndarray, roll: np.ndarray) -> float:
        """Return the distance of `phi` and `roll` [rad] from the nearest motion, relative beyond 1 rad.

        Where rounding explains that motions part, each is that of a start that doubles cannot tell from this one.
        """
        return float(np.min([motion.off(phi, roll) for motion in self.motions], initial=np.inf))


def truth(scene: Scene, times: np.ndarray, phi0: float, phi_dot0: float) -> Truth:
    """Return the motion at increasing `times` [s] that starts at `phi0` [rad] with `phi_dot0` [rad/s] at time 0."""
    start = phi0, phi_dot0
    first, second = _exact(scene, times, *start), _reference(scene, times, *start)
    found = [motion for motion in (first, second) if motion is not None]
    seen = tuple(angles(scene, motion, *start) for motion in found)
    kinetic = max((float(kinetic_energy(scene, motion).max()) for motion in found), default=0.0)
    if second is None:
        return Truth(seen, None, bool(seen), kinetic)
    if first is not None:
        apart = seen[1].off(seen[0].phi, seen[0].roll)
        if apart <= _FLOOR + _LAST_DIGITS * _ROUNDING * max(float(np.abs(second.phi).max()), abs(phi0)):
            return Truth(seen, apart, explained=True, kinetic=kinetic)
    beside = tuple(_beside(scene, times, *start))
    if first is None:
        return Truth((*seen, *beside), None, explained=True, kinetic=kinetic)
    effect = sum(seen[1].off(motion.phi, motion.roll) for motion in beside)
    return Truth((*seen, *beside), apart, explained=apart <= _NUDGES * effect, kinetic=kinetic)


def _exact(scene: Scene, times: np.ndarray, phi0: float, phi_dot0: float) -> Coordinates | None:
    """Return the motion by `exact`; None on a separatrix, and beyond what rounding leaves to that theory."""
    try:
        return solution(scene, times, phi0, phi_dot0)
    except (NoLibrationError, ParameterError, ToleranceError):
        return None


def _reference(scene: Scene, times: np.ndarray, phi0: float, phi_dot0: float) -> Coordinates | None:
    """Return the motion by `reference`; None if it takes too many steps, or is damped."""
    if scene.dissipates:
        return None
    try:
        return reference(scene, times, phi0, phi_dot0)
    except LongMotionError:
        return None


def angles(scene: Scene, motion: Coordinates, phi0: float, phi_dot0: float) -> Angles:
    """Return the angles of a motion that starts at `phi0` [rad] with `phi_dot0` [rad/s]."""
    start = phi0, scene.start(phi0, phi_dot0)[0] / scene.can.radius
    return Angles(motion.phi, motion.u / scene.can.radius, start)


def _off(angles: np.ndarray, truth: np.ndarray, start: float) -> float:
    turned = np.maximum.accumulate(np.abs(truth - start))
    return float(np.max(np.abs(angles - truth) / np.maximum(1, turned)))


def _beside(scene: Scene, times: np.ndarray, phi0: float, phi_dot0: float) -> Iterator[Angles]:
    """Yield the motions, by `reference`, of a scene and a start of which one number is nudged by a rounding."""
    aside = _ROUNDING * max(1.0, abs(phi0))
    nudged = [(scene, phi0 + aside, phi_dot0), (scene, phi0 - aside, phi_dot0)]
    nudged += [(scene, phi0, phi_dot0 * (1 + _ROUNDING))]
    for name in ("incline", "gravity"):
        other = dataclasses.replace(scene, **{name: getattr(scene, name) * (1 + _ROUNDING)})
        nudged.append((other, phi0, phi_dot0))
    for other, *start in nudged:
        if (motion := _reference(other, times, *start)) is not None:
            yield angles(other, motion, *start)
