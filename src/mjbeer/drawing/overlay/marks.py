"""What is drawn at the can to show its motion: the angle phi, paths, forces, and a can that accelerates evenly."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from mjbeer.drawing.overlay import quantity
from mjbeer.drawing.overlay.look import Mark
from mjbeer.drawing.overlay.sheet import INK, Sheet
from mjbeer.drawing.world.display import on_incline
from mjbeer.drawing.world.view import View, circle
from mjbeer.model.looks import WALL
from mjbeer.theory.can import RADIUS
from mjbeer.theory.scene import Scene
from mjbeer.theory.trajectory import Trajectory

RIM, CENTRE, GHOST = (0.79, 0.12, 0.16), (0.42, 0.21, 0.0), (0.25, 0.33, 0.45)
"""Colours of the path of a point on the rim, of that of the centre of mass, and of the ghost."""
NORMAL, FRICTION = (0.0, 0.45, 0.30), (0.62, 0.20, 0.55)
"""Colours of the forces."""
_WEIGHT = 1.0
"""Length of the arrow of a force equal to the weight, in radii, unless a longer one would be too long."""
LONGEST = 1.6
"""Longest arrow of a force, in radii. Only the blow of a landing would be longer."""
_CLEAR = 0.4
"""Least distance of a force's letter from the foot of the can, in radii: no letter is to cover it."""
_RARE = 90.0
"""Percentage of times at which no force is larger than the longest arrow shows."""
_FAINT = 0.05
"""Least length of an arrow that is drawn, in radii."""
LEGENDS: dict[Mark, tuple[tuple[str, tuple[float, float, float], str], ...]] = {
    "phi": (),
    "paths": (("—", RIM, "path of a point on the rim"), ("—", CENTRE, "path of the centre of mass")),
    "forces": (("→", NORMAL, "normal force N"), ("→", FRICTION, "friction F")),
    "ghost": (("- -", GHOST, "a can that accelerates evenly"),),
}
"""What the marks are: a sign, its colour, and its meaning."""


@dataclass(frozen=True, eq=False)
class Marks:
    """The marks of a trajectory, to be drawn over the pictures at some times."""

    trajectory: Trajectory
    kinds: Sequence[Mark]
    plane: float
    """Coordinate y of the can's near end [m]."""
    fine: np.ndarray
    """Times [s] at which the paths are drawn."""
    positions: np.ndarray
    """u, phi, roll and lift at these times, shape (times, 4)."""

    @property
    def scene(self) -> Scene:
        """Return the scene."""
        return self.trajectory.scene

    def draw(self, sheet: Sheet, view: View, top: int, time: float, now: np.ndarray) -> None:
        """Draw the marks at a `time` [s] with u, phi, roll and lift `now`; `top` is the row of the view's top."""
        sheet.clip((0, top, view.pixels[0], top + view.pixels[1]))
        pen = _Pen(sheet, view, self.scene, plane=self.plane, top=top)
        drawn = {"ghost": self._ghost, "paths": self._paths, "forces": self._forces, "phi": self._phi}
        for kind, draw in drawn.items():
            if kind in self.kinds:
                draw(pen, time, now)
        sheet.clip(None)

    def _ghost(self, pen: "_Pen", time: float, now: np.ndarray) -> None:
        trajectory, radius = self.trajectory, self.scene.can.radius
        along = float(quantity.even(self.scene, trajectory, np.array(time)))
        centre = np.array([along / radius, 1.0])
        roll = along / radius
        pen.line(centre + circle(1 + WALL), 0.05, GHOST, dashes=(3, 2.5))
        turned = np.array([math.sin(roll), math.cos(roll)])
        pen.line(np.array([centre + 0.8 * turned, centre + (1 + WALL) * turned]), 0.07, GHOST)

    def _paths(self, pen: "_Pen", time: float, now: np.ndarray) -> None:
        until = np.searchsorted(self.fine, time, side="right")
        positions = np.vstack([self.positions[:until], now])
        rim, centre = self._places(positions)
        pen.line(rim, 0.03, RIM, alpha=0.8)
        pen.line(centre, 0.035, CENTRE, alpha=0.9)
        pen.disc(centre[-1], 0.07, CENTRE)

    def _places(self, positions: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return where the marked point of the rim and the centre of mass are, along and over the incline [radii]."""
        u, phi, roll, lift = positions.T
        radius = self.scene.can.radius
        axis = np.stack([u / radius, 1 + lift / radius], axis=1)
        offset = min(self.scene.load.offset / radius, 1.0)
        load = axis - offset * np.stack([np.sin(phi), np.cos(phi)], axis=1)
        return axis + np.stack([np.sin(roll), np.cos(roll)], axis=1), load

    def _forces(self, pen: "_Pen", time: float, now: np.ndarray) -> None:
        normal, friction = (float(np.interp(time, self.trajectory.time, force)) for force in self._lengths)
        foot = np.array([now[0] / self.scene.can.radius, -WALL])
        way = -1.0 if friction > 0 else 1.0
        if normal > _FAINT:
            length = min(normal, LONGEST)
            pen.arrow(foot - np.array([0, length]), foot, NORMAL)
            pen.text(foot - np.array([0.3 * way, max(length, _CLEAR) + 0.1]), "N", NORMAL)
        if abs(friction) > _FAINT:
            length = min(abs(friction), LONGEST)
            start = foot - np.array([0, 0.12])
            pen.arrow(start, start + np.array([way * length, 0]), FRICTION)
            pen.text(foot + np.array([way * max(length, _CLEAR), -0.5]), "F", FRICTION)

    @cached_property
    def _lengths(self) -> tuple[np.ndarray, np.ndarray]:
        """Return the lengths of the arrows of N and F [radii], positive away from the incline and up it."""
        normal, friction = quantity.forces(self.scene, self.trajectory)
        weight = quantity.weight(self.scene)
        largest = np.percentile(np.hypot(normal, friction), _RARE) / weight
        length = min(_WEIGHT, LONGEST / max(largest, _FAINT)) / weight
        return length * normal, length * friction

    def _phi(self, pen: "_Pen", time: float, now: np.ndarray) -> None:
        """Draw phi outside the rim, where it opens upwards: at the beer's surface, or over a bob."""
        u, phi, _, lift = now
        angle = math.radians(float(quantity.wrapped(phi)))
        centre = np.array([u / self.scene.can.radius, 1 + lift / self.scene.can.radius])
        start = math.pi / 2 if self.scene.load.fill is None else math.pi if angle >= 0 else 0.0
        for direction in (start, start - angle):
            way = np.array([math.cos(direction), math.sin(direction)])
            pen.line(centre + np.array([[1.07], [1.5]]) * way, 0.035, INK)
        arc = start - np.linspace(0, angle, 32)
        pen.line(centre + 1.32 * np.stack([np.cos(arc), np.sin(arc)], axis=1), 0.035, INK)
        middle = start - angle / 2
        pen.text(centre + 1.76 * np.array([math.cos(middle), math.sin(middle)]), "φ", INK, size=0.36)


@dataclass(frozen=True, eq=False)
class _Pen:
    """Draws at places along and over the incline, in radii, on the plane of the can's near end."""

    sheet: Sheet
    view: View
    scene: Scene
    plane: float
    top: int

    @property
    def radius(self) -> float:
        """Return the can's radius in the picture [pixels]."""
        return RADIUS * self.view.scale(np.array([0.0, self.plane, 0.0]))

    def places(self, points: np.ndarray) -> np.ndarray:
        """Return column and row on the sheet."""
        x, z = np.moveaxis(on_incline(self.scene, RADIUS * points[..., 0], RADIUS * points[..., 1]), -1, 0)
        points = np.stack([x, np.full_like(x, self.plane), z], axis=-1)
        return self.view.pixel(points) + np.array([0, self.top])

    def line(self, points: np.ndarray, width: float, colour, alpha: float = 1.0, dashes: Sequence[float] = ()) -> None:
        self.sheet.line(self.places(points), max(1.0, width * self.radius), colour, alpha=alpha, dashes=dashes)

    def arrow(self, tail: np.ndarray, head: np.ndarray, colour: tuple[float, float, float]) -> None:
        self.sheet.arrow(self.places(tail), self.places(head), max(2.0, 0.09 * self.radius), colour)

    def disc(self, point: np.ndarray, radius: float, colour: tuple[float, float, float]) -> None:
        self.sheet.disc(self.places(point), max(2.0, radius * self.radius), colour)

    def text(self, point: np.ndarray, words: str, colour, size: float = 0.34) -> None:
        place = self.places(np.asarray(point))
        self.sheet.text(place, words, max(10.0, size * self.radius), colour, anchor=(0.5, 0.5), halo=True)
