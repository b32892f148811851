"""Lines, arrows and letters at the can, which explain a motion."""

import math
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from mjbeer.drawing.camera import View, circle, in_space, unit_vectors
from mjbeer.drawing.quantities import MeanForces, mean_forces, mean_motion, wrapped
from mjbeer.drawing.scene import coordinates
from mjbeer.drawing.sheet import INK, Colour, Sheet
from mjbeer.drawing.style import FilmStyle, Mark
from mjbeer.model.looks import WALL
from mjbeer.theory.can import RADIUS
from mjbeer.theory.trajectory import Trajectory

LONGEST = 3.2
"""Length of the longest arrow of a force, in radii; that of the weight is 1 at most. Only the blow
of a landing would be longer."""
_NO_BLOW = 97
"""Share of the time in which a can that may land feels no blow of a landing [%]."""
_SHORTEST = 0.15
"""Length of the shortest arrow that is drawn, in radii."""
_LETTER_ASIDE = 0.5
"""Distance of a force's letter from the line of its arrow, in radii."""

_RIM = (0.79, 0.12, 0.16)
_CENTRE = (0.42, 0.21, 0.0)
_GHOST = (0.25, 0.33, 0.45)
_RESTING = (0.05, 0.35, 0.62)
_FILMED = (0.85, 0.0, 0.35)
_NORMAL = (0.0, 0.45, 0.30)
_FRICTION = (0.62, 0.20, 0.55)
"""Colours of the marks."""


class Legend(NamedTuple):
    """What a mark means."""

    sign: str
    """A sign that looks like the mark."""
    colour: Colour
    meaning: str
    """What it means in words, with a place {} for what rolls."""


LEGENDS: dict[Mark, tuple[Legend, ...]] = {
    "ghost": (Legend("- -", _GHOST, "a {} that accelerates evenly"),),
    "paths": (
        Legend("—", _RIM, "a point on the rim"),
        Legend("—", _CENTRE, "centre of mass"),
    ),
    "normal": (Legend("→", _NORMAL, "normal force N"),),
    "friction": (Legend("→", _FRICTION, "friction F"),),
    "phi": (),
    "equilibrium": (Legend("- -", _RESTING, "the beer's surface at the equilibrium"),),
    "measured": (Legend("•", _FILMED, "where the filmed {} was"),),
}
"""What marks mean, in the order in which they are drawn."""


class Position(NamedTuple):
    """Where a can is at a time."""

    time: float
    """[s]."""
    u: float
    """[m]."""
    phi: float
    """[rad]."""
    roll: float
    """[rad]."""
    lift: float
    """[m]."""


class Annotations:
    """The marks at the can of a trajectory, drawn on top of its pictures.

    Places along the incline and above it, and sizes, are in radii.
    """

    def __init__(self, trajectory: Trajectory, style: FilmStyle, plane: float) -> None:
        """Prepare to draw in the plane y = `plane` of the can's near end [m]."""
        self._motion = trajectory
        self._measured = style.measured
        self._plane = plane
        self._radius = trajectory.scene.can.radius
        self._path_times = np.linspace(trajectory.time[0], trajectory.time[-1], 2000)
        self._path = coordinates(trajectory, self._path_times)
        self._forces = MeanForces(np.zeros(0), np.zeros(0))
        """The lengths of the arrows of forces at the samples, in radii."""
        if "normal" in style.marks or "friction" in style.marks:
            self._forces = _arrow_lengths(trajectory)
        draw: dict[Mark, Callable[[_Pen, Position], None]] = {
            "ghost": self._draw_ghost,
            "paths": self._draw_paths,
            "normal": self._draw_normal,
            "friction": self._draw_friction,
            "phi": self._draw_phi,
            "equilibrium": self._draw_equilibrium,
            "measured": self._draw_measured,
        }
        self._marks = [draw[mark] for mark in LEGENDS if mark in style.marks]

    def draw(self, sheet: Sheet, view: View, time: float, now: np.ndarray) -> None:
        """Draw the marks at a `time` [s] with u, phi, roll and lift `now`."""
        pen = _Pen(sheet, view, self._motion, self._plane)
        for draw_mark in self._marks:
            draw_mark(pen, Position(time, *now))

    def _axis(self, now: Position) -> np.ndarray:
        return np.array([now.u, self._radius + now.lift]) / self._radius

    def _draw_ghost(self, pen: "_Pen", now: Position) -> None:
        roll = float(mean_motion(self._motion, np.array(now.time))) / self._radius
        centre = np.array([roll, 1.0])
        upward = np.array([math.sin(roll), math.cos(roll)])
        pen.line(centre + circle(1 + WALL), 0.05, _GHOST, dashes=(3, 2.5))
        pen.line(centre + np.array([[0.8], [1 + WALL]]) * upward, 0.07, _GHOST)

    def _draw_paths(self, pen: "_Pen", now: Position) -> None:
        """Draw where a point on the rim, and the load's centre of mass, have been so far."""
        passed = np.searchsorted(self._path_times, now.time, side="right")
        u, phi, roll, lift = np.vstack([self._path[:passed], now[1:]]).T
        axis = np.stack([u, self._radius + lift], axis=1) / self._radius
        offset = min(self._motion.scene.load.offset / self._radius, 1.0)
        centre = axis - offset * np.stack([np.sin(phi), np.cos(phi)], axis=1)
        rim = axis + np.stack([np.sin(roll), np.cos(roll)], axis=1)
        pen.line(rim, 0.03, _RIM, alpha=0.8)
        pen.line(centre, 0.035, _CENTRE, alpha=0.9)
        pen.disc(centre[-1], 0.07, _CENTRE)

    def _draw_normal(self, pen: "_Pen", now: Position) -> None:
        normal = self._arrow(self._forces.normal, now)
        if normal > _SHORTEST:
            length = min(normal, LONGEST)
            foot = self._foot(now)
            pen.arrow(foot, foot + np.array([0, length]), _NORMAL)
            pen.text(foot + np.array([_LETTER_ASIDE, length / 2]), "N", _NORMAL)

    def _draw_friction(self, pen: "_Pen", now: Position) -> None:
        friction = abs(self._arrow(self._forces.friction, now))
        if friction > _SHORTEST:
            length = min(friction, LONGEST)
            direction = self._friction_direction(now)
            foot = self._foot(now)
            tail = foot - np.array([0, 0.12])
            pen.arrow(tail, tail + np.array([direction * length, 0]), _FRICTION)
            letter = np.array([direction * length / 2, -_LETTER_ASIDE])
            pen.text(tail + letter, "F", _FRICTION)

    def _arrow(self, force: np.ndarray, now: Position) -> float:
        """Return the length of a force's arrow, with the force's sign."""
        return float(np.interp(now.time, self._motion.time, force))

    def _friction_direction(self, now: Position) -> float:
        """Return 1 if friction pushes the can down the incline, otherwise -1."""
        return -1.0 if self._arrow(self._forces.friction, now) > 0 else 1.0

    def _foot(self, now: Position) -> np.ndarray:
        """Return the place below the axis on the incline."""
        return np.array([self._axis(now)[0], -WALL])

    def _draw_phi(self, pen: "_Pen", now: Position) -> None:
        """Draw phi outside the rim: an arc between two short lines, and the letter beside it.

        It is the angle from the incline to the beer's surface, or from below the axle to a bob.
        """
        angle = math.radians(float(wrapped(now.phi)))
        start = math.pi if angle >= 0 else 0.0
        if self._motion.scene.load.fill is None:
            start = -math.pi / 2
        axis = self._axis(now)
        ends = np.array([[1.07], [1.42]])
        pen.line(axis + ends * unit_vectors(start), 0.045, INK)
        pen.line(axis + ends * unit_vectors(start - angle), 0.045, INK)
        arc = start - np.linspace(0, angle, 32)
        pen.line(axis + 1.26 * unit_vectors(arc), 0.045, INK)
        pen.text(axis + 1.62 * unit_vectors(start - angle / 2), "φ", INK)

    def _draw_equilibrium(self, pen: "_Pen", now: Position) -> None:
        """Draw a line through the axis that the beer's surface is parallel to at rest."""
        along = unit_vectors(math.pi - self._motion.scene.equilibrium())
        ends = np.array([[-1.42], [1.42]])
        pen.line(self._axis(now) + ends * along, 0.05, _RESTING, dashes=(3, 2.5))

    def _draw_measured(self, pen: "_Pen", now: Position) -> None:
        """Draw about sixty of the measured places, and the latest."""
        assert self._measured is not None
        step = max(1, len(self._measured) // 60)
        seen = self._measured[self._measured[:, 0] <= now.time]
        for _, u in [*seen[::step], *seen[-1:]]:
            pen.disc(np.array([u / self._radius, 1.0]), 0.08, _FILMED)


def _arrow_lengths(motion: Trajectory) -> MeanForces:
    """Return the lengths of the arrows of a motion's forces, in radii.

    A weight has the length 1, or less if the forces were too long then, apart from the blow of a
    landing.
    """
    forces = mean_forces(motion)
    share = _NO_BLOW if motion.rolling == "contact" else 100
    large = max(np.percentile(np.hypot(*forces), share), _SHORTEST)
    factor = min(1.0, LONGEST / large)
    return MeanForces(factor * forces.normal, factor * forces.friction)


class _Pen:
    """Draws onto a sheet at places along the incline and above it, all in radii."""

    def __init__(self, sheet: Sheet, view: View, motion: Trajectory, plane: float) -> None:
        self._sheet = sheet
        self._view = view
        self._scene = motion.scene
        self._plane = plane
        self._size = RADIUS * view.scale(np.array([0.0, plane, 0.0]))  # the can's radius [pixels]

    def _pixel(self, points: np.ndarray) -> np.ndarray:
        along = RADIUS * points[..., 0]
        height = RADIUS * points[..., 1]
        return self._view.pixel(in_space(self._scene, along, height, self._plane))

    def line(
        self,
        points: np.ndarray,
        width: float,
        colour: Colour,
        alpha: float = 1.0,
        dashes: Sequence[float] = (),
    ) -> None:
        thick = max(1.0, width * self._size)
        self._sheet.line(self._pixel(points), thick, colour, alpha, dashes)

    def arrow(self, tail: np.ndarray, tip: np.ndarray, colour: Colour) -> None:
        """Draw an arrow with a white edge, so that it is seen on anything."""
        width = max(2.0, 0.12 * self._size)
        self._sheet.arrow(self._pixel(tail), self._pixel(tip), width, colour, halo=True)

    def disc(self, point: np.ndarray, radius: float, colour: Colour) -> None:
        self._sheet.disc(self._pixel(point), max(2.0, radius * self._size), colour)

    def text(self, point: np.ndarray, words: str, colour: Colour) -> None:
        unit = self._sheet.unit
        size = float(np.clip(0.4 * self._size, 1.35 * unit, 2 * unit))
        self._sheet.text(self._pixel(point), words, size, colour, (0.5, 0.5), halo=True)
