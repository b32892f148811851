"""What is drawn over the pictures of a motion to explain it: words above, marks at the can, numbers on the board."""

import math
import textwrap
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal, Self

import numpy as np
from matplotlib.ticker import MaxNLocator

from mjbeer.drawing import strip
from mjbeer.drawing.camera import Camera, View, circle, in_space, scale
from mjbeer.drawing.scene import Display, coordinates
from mjbeer.drawing.sheet import INK, Colour, Sheet, overlap
from mjbeer.drawing.words import in_words
from mjbeer.model import looks
from mjbeer.model.looks import WALL
from mjbeer.theory.can import RADIUS
from mjbeer.theory.trajectory import Trajectory

Mark = Literal["ghost", "paths", "normal", "friction", "phi", "measured"]
"""ghost: a can that accelerates evenly. paths: of a point on the rim and of the load's centre of mass. normal: N.
friction: F. phi: the angle of the load. measured: where a film has had the axis so far."""
_KINDS = {  # by the names of looks: the title of a film of which nothing else is known, what rolls, and what is in it
    "sliding": ("Beer that slides in its can without friction", "can", "beer"),
    "frozen": ("Beer frozen to its can", "can", "beer"),
    "pendulum": ("A pendulum in a rolling wheel", "wheel", "bob"),
    "hoop": ("A weight on the rim of a hoop", "hoop", "bar"),
}


@dataclass(frozen=True)
class Look:
    """What is drawn into the pictures of a motion besides the can, and below them."""

    title: str  # what is seen, in a few words
    strips: tuple[str, ...] = ("phi", "u")  # names of the quantities in the charts below the picture
    marks: tuple[Mark, ...] = ("phi", "paths")  # what is drawn to explain the motion
    camera: Camera = "auto"  # how the camera moves
    notes: tuple[str, ...] = ()  # what is said while it happens; the charts mark when the first one is
    measured: np.ndarray | None = None  # times [s] and places u [m] of a filmed axis, shape (points, 2)

    @classmethod
    def usual(cls, trajectory: Trajectory, camera: Camera = "auto") -> Self:
        """Return the look of a motion of which nothing else is known."""
        damped, title = trajectory.scene.dissipates, _KINDS[looks.name(trajectory.scene)][0]
        title = "A can that its load or the air brakes" if damped else title
        if trajectory.rolling == "contact":
            return cls(title, ("phi", "normal"), ("phi", "paths", "normal", "friction"), camera)
        if trajectory.scene.attachment == "sliding" and not damped:
            return cls(title, ("phi", "ahead"), ("phi", "ghost"), camera)
        return cls(title, ("phi", "u_dot" if damped else "u"), camera=camera)


HEIGHT = 4.1  # height of the first two lines above a picture, in units of the sheet
HEADER = 5.6  # and with the third, which tells what the marks mean
STRIP = 10  # height of the charts below a picture
NOTE = 3  # height of a note, at the top of the scene
_RIM, _CENTRE, _GHOST, _FILMED = (0.79, 0.12, 0.16), (0.42, 0.21, 0.0), (0.25, 0.33, 0.45), (0.85, 0.0, 0.35)
"""Colours of the path of a point on the rim, of that of the centre of mass, of the ghost, and of measured places."""
_DOUBT = (0.72, 0.05, 0.05)  # colour of what is said of a run that is not to be relied on
_NORMAL, _FRICTION = (0.0, 0.45, 0.30), (0.62, 0.20, 0.55)  # colours of the forces
_LEGENDS: dict[Mark, tuple[tuple[str, Colour, str], ...]] = {  # sign, colour, meaning; in the order of drawing
    "ghost": (("- -", _GHOST, "a {} that accelerates evenly"),),
    "paths": (("—", _RIM, "a point on the rim"), ("—", _CENTRE, "centre of mass")),
    "normal": (("→", _NORMAL, "normal force N"),),
    "friction": (("→", _FRICTION, "friction F"),),
    "phi": (),
    "measured": (("•", _FILMED, "where the filmed {} was"),),
}


def header(sheet: Sheet, look: Look, trajectory: Trajectory, time: float, speed: float) -> None:
    """Draw the lines above a picture as they are at a `time` [s]."""
    duration = float(trajectory.time[-1] - trajectory.time[0])
    digits = max(2, math.ceil(-math.log10(duration)) + 1) if duration > 0 else 2
    sheet.blank(0, round(HEADER * sheet.unit))
    head(sheet, look.title, in_words(trajectory.scene), time, speed, digits)
    unit, column, row = sheet.unit, 1.2 * sheet.unit, 4.7 * sheet.unit
    body = _KINDS[looks.name(trajectory.scene)][1]
    for sign, colour, meaning in (entry for mark in look.marks for entry in _LEGENDS[mark]):
        *_, column, _ = sheet.text((column, row), sign, 1.1 * unit, colour, bold=True)
        *_, column, _ = sheet.text((column + 0.5 * unit, row), meaning.format(body), unit)
        column += 1.8 * unit


def head(sheet: Sheet, title: str, words: str, time: float, speed: float, digits: int = 2) -> None:
    """Draw a title and a scene in words, the `time` [s] with some digits after the point, and the playback speed."""
    pace, unit = f"slowed down {1 / speed:.3g} times" if speed < 1 else f"sped up {speed:.3g} times", sheet.unit
    left, right, pace = 1.2 * unit, sheet.width - 1.2 * unit, "real time" if speed == 1 else pace
    sheet.blank(0, round(HEIGHT * unit))
    lines = (1.5, 1.45, INK, title, f"t = {time:.{digits}f} s"), (3.2, 1.1, "#52606d", words, pace)
    for row, size, colour, said, aside in lines:
        bold = said == title
        room, *_ = sheet.text((right, row * unit), aside, size * unit, colour, (1, 0.5))
        *_, end, _ = sheet.box((left, 0), said, size * unit, bold=bold)
        fits = max(0.5, min(1.0, (room - 2 * unit) / end))
        sheet.text((left, row * unit), said, fits * size * unit, colour, bold=bold)


NOTES: dict[str, tuple[str, Callable[[Trajectory], np.ndarray]]] = {
    "flies": (
        "its {load} pulls it up: it flies, up to {lift:.0f} mm high",
        lambda motion: motion.lift > 0.02 * motion.scene.can.radius,
    ),
    "slips": (  # what a contact that rolls creeps is no slip
        "it slips: rolling needs more friction than μN",
        lambda motion: np.abs(np.gradient(motion.slip, motion.time)) > 0.09 * np.sqrt(motion.scene.can.radius),
    ),
    "heavy": ("the {load} below presses the {body} down", lambda motion: strip.forces(motion)[0] > 1.8),
    "light": ("the {load} pulls up: the {body} hardly presses", lambda motion: strip.forces(motion)[0] < 0.4),
    "hesitates": (
        "the {load} is uphill: the {body} hesitates",
        lambda motion: np.gradient(motion.u_dot, motion.time) < motion.scene.acceleration() / 2,
    ),
}
"""What a note says while a motion does something, and when it does, by name; the first that holds is shown."""


def spans(motion: Trajectory, names: Sequence[str]) -> dict[str, list[tuple[float, float]]]:
    """Return from when to when [s] notes hold, by their words."""
    time, noted = np.append(motion.time, motion.time[-1]), dict[str, list[tuple[float, float]]]()
    _, body, load = _KINDS[looks.name(motion.scene)]
    for words, holds in (NOTES[name] for name in names):
        edges = np.flatnonzero(np.diff(np.concatenate([[False], holds(motion), [False]])))
        found = noted.setdefault(words.format(body=body, load=load, lift=1e3 * motion.lift.max()), [])
        for first, last in time[edges].reshape(-1, 2).tolist():  # a brief pause does not interrupt a note
            begins = found.pop()[0] if found and first - found[-1][1] < np.ptp(time) / 50 else first
            found.append((begins, last))
    return noted


def note(sheet: Sheet, notes: Mapping[str, Sequence[tuple[float, float]]], time: float, top: int) -> None:
    """Write the first of some notes that holds at a `time` [s] into the scene, whose upper edge is at a row `top`."""
    words = next((words for words, of in notes.items() if any(first <= time <= last for first, last in of)), None)
    if words:
        place = np.array([1.2, NOTE / 2]) * sheet.unit + [0, top]
        sheet.plate(place, [words], INK, (0, 0.5), ground=(1.0, 0.95, 0.72))


def warn(sheet: Sheet, doubts: Sequence[str], top: int) -> None:
    """Say below a row `top` that what is shown is not to be relied on, and why; nothing if there are no `doubts`.

    Of each doubt the picture has what comes before its parentheses, in which is what would be trusted.
    """
    if doubts:
        letters = int((sheet.width / sheet.unit - 4) / 0.65)  # of a line; the mean letter is 0.6 units wide
        lines = [line for doubt in doubts for line in textwrap.wrap(doubt.partition(" (")[0], letters)]
        place = sheet.unit * np.array([1.2, 0.6]) + [0, top]
        sheet.plate(place, ["Not to be relied on", *lines], _DOUBT, (0, 0), ground=(1.0, 0.9, 0.88))


LONGEST = 1.6  # longest arrow of a force, in radii; that of the weight is 1. Only the blow of a landing would be longer
_CLEAR, _FAINT = 0.4, 0.05  # least distance of a force's letter from the foot, and least arrow that is drawn, in radii


class Marks:
    """The marks at the can of a trajectory, to be drawn over the pictures at some times. Sizes are in radii."""

    def __init__(self, trajectory: Trajectory, look: Look, plane: float) -> None:
        """Prepare to draw on the `plane` y of the can's near end [m]."""
        self._motion, self._look, self._plane = trajectory, look, plane
        self._fine = np.linspace(trajectory.time[0], trajectory.time[-1], 2000)  # times at which paths are drawn [s]
        self._positions = coordinates(trajectory, self._fine)
        self._radius, self._offset = trajectory.scene.can.radius, trajectory.scene.load.offset
        if {"normal", "friction"} & {*look.marks}:
            forces = strip.forces(trajectory)
            largest = max(np.percentile(np.hypot(*forces), 90), _FAINT)  # a larger one is rare
            self._forces = min(1.0, LONGEST / largest) * forces  # lengths of their arrows

    def draw(self, sheet: Sheet, view: View, time: float, now: np.ndarray) -> None:
        """Draw the marks at a `time` [s] with u, phi, roll and lift `now`."""
        self._sheet, self._view, self._time, self._now = sheet, view, time, now
        self._size = RADIUS * view.scale(np.array([0.0, self._plane, 0.0]))  # the can's radius [pixels]
        self._axis = np.array([now[0], self._radius + now[3]]) / self._radius
        for mark in (each for each in _LEGENDS if each in self._look.marks):
            getattr(self, f"_{mark}")()

    def _ghost(self) -> None:
        roll = float(strip.even(self._motion, np.array(self._time))) / self._radius
        centre, turned = np.array([roll, 1.0]), np.array([math.sin(roll), math.cos(roll)])
        self._line(centre + circle(1 + WALL), 0.05, _GHOST, dashes=(3, 2.5))
        self._line(centre + np.array([[0.8], [1 + WALL]]) * turned, 0.07, _GHOST)

    def _paths(self) -> None:
        until = np.searchsorted(self._fine, self._time, side="right")
        u, phi, roll, lift = np.vstack([self._positions[:until], self._now]).T
        axis = np.stack([u, self._radius + lift], axis=1) / self._radius
        centre = axis - min(self._offset / self._radius, 1.0) * np.stack([np.sin(phi), np.cos(phi)], axis=1)
        self._line(axis + np.stack([np.sin(roll), np.cos(roll)], axis=1), 0.03, _RIM, alpha=0.8)
        self._line(centre, 0.035, _CENTRE, alpha=0.9)
        self._disc(centre[-1], 0.07, _CENTRE)

    def _normal(self) -> None:
        foot, normal, way, _ = self._contact()
        if normal > _FAINT:
            length = min(normal, LONGEST)
            self._arrow(foot - np.array([0, length]), foot, _NORMAL)
            self._text(foot - np.array([0.36 * way, max(length, _CLEAR) + 0.1]), "N", _NORMAL)

    def _friction(self) -> None:
        foot, _, way, friction = self._contact()
        if friction > _FAINT:
            length, start = min(friction, LONGEST), foot - np.array([0, 0.12])
            self._arrow(start, start + np.array([way * length, 0]), _FRICTION)
            self._text(foot + np.array([way * max(length, _CLEAR), -0.54]), "F", _FRICTION)

    def _contact(self) -> tuple[np.ndarray, float, float, float]:
        """Return the can's foot, the length of N, and the direction of F down the incline, 1 or -1, with its length."""
        normal, friction = (float(np.interp(self._time, self._motion.time, force)) for force in self._forces)
        return np.array([self._axis[0], -WALL]), normal, -1.0 if friction > 0 else 1.0, abs(friction)

    def _phi(self) -> None:
        """Draw phi outside the rim: from the incline to the beer's surface, or from under the axle to over a bob."""
        angle, filled = math.radians(float(strip.wrapped(self._now[1]))), self._motion.scene.load.fill is not None
        start = (math.pi if angle >= 0 else 0.0) if filled else -math.pi / 2
        for direction in (start, start - angle):
            self._line(self._axis + np.array([[1.07], [1.42]]) * _towards(direction), 0.045, INK)
        self._line(self._axis + 1.26 * _towards(start - np.linspace(0, angle, 32)), 0.045, INK)
        self._text(self._axis + 1.62 * _towards(start - angle / 2), "φ", INK)

    def _measured(self) -> None:
        assert self._look.measured is not None
        seen = self._look.measured[self._look.measured[:, 0] <= self._time]
        for _, u in [*seen[:: max(1, len(self._look.measured) // 60)], *seen[-1:]]:
            self._disc(np.array([u / self._radius, 1.0]), 0.08, _FILMED)

    # How they are drawn: at places along and over the incline, in radii.

    def _pixel(self, points: np.ndarray) -> np.ndarray:
        along, height = RADIUS * points[..., 0], RADIUS * points[..., 1]
        return self._view.pixel(in_space(self._motion.scene, along, height, self._plane))

    def _line(self, points: np.ndarray, width: float, colour: Colour, **style: Any) -> None:
        self._sheet.line(self._pixel(points), max(1.0, width * self._size), colour, **style)

    def _arrow(self, tail: np.ndarray, tip: np.ndarray, colour: Colour) -> None:
        self._sheet.arrow(self._pixel(tail), self._pixel(tip), max(2.0, 0.11 * self._size), colour)

    def _disc(self, point: np.ndarray, radius: float, colour: Colour) -> None:
        self._sheet.disc(self._pixel(point), max(2.0, radius * self._size), colour)

    def _text(self, point: np.ndarray, words: str, colour: Colour) -> None:
        size = float(np.clip(0.4 * self._size, 1.35 * self._sheet.unit, 2 * self._sheet.unit))
        self._sheet.text(self._pixel(point), words, size, colour, (0.5, 0.5), halo=True)


def _towards(angle: float | np.ndarray) -> np.ndarray:
    """Return unit vectors at angles [rad] from the first axis to the second, shape (..., 2)."""
    return np.stack([np.cos(angle), np.sin(angle)], axis=-1)


class Board:
    """What stands still: gravity's arrow, and at the near edge of the board's underside distances and the incline."""

    def __init__(self, display: Display, start: float = 0.0) -> None:
        """Take the board of a display; `start` is where the distances begin [m]."""
        board, self.scene, self._start = display.model.geom("board"), display.scenes[0], start
        self.front, self.under = float(board.pos[1] - board.size[1]), float(board.pos[2] - board.size[2])

    def pixel(self, view: View, along: np.ndarray | float) -> np.ndarray:
        """Return column and row of points of the edge, `along` the incline as drawn [m], shape (..., 2)."""
        return view.pixel(in_space(self.scene, along, self.under, self.front))

    def along(self, view: View, column: float) -> float:
        """Return how far down the incline the edge is in a column of the picture, as drawn [m]."""
        first, second = self.pixel(view, np.array([0.0, 1.0]))[:, 0]
        return float((column - first) / (second - first))

    def draw(self, sheet: Sheet, view: View) -> None:
        """Draw gravity's arrow, the incline's angle and distances."""
        unit = sheet.unit
        tail = np.array([3 * unit if self.scene.incline < 0 else sheet.width - 1.6 * unit, view.top + 1.0 * unit])
        sheet.arrow(tail, tail + np.array([0, 4.2 * unit]), 0.32 * unit, INK)
        sheet.text(tail + np.array([-0.6, 2]) * unit, "g", 1.5 * unit, anchor=(1, 0.5))
        if self.scene.incline:
            self._draw_angle(sheet, view)
        self._draw_distances(sheet, view)

    def _draw_angle(self, sheet: Sheet, view: View) -> None:
        """Draw the angle of the incline under the board, and keep other texts from its lines."""
        unit, uphill, tilt = sheet.unit, -math.copysign(1.0, self.scene.incline), abs(self.scene.incline)
        reach, lowest = 9 * unit, view.top + view.pixels[1] - 2.6 * unit
        corner = self.pixel(view, self.along(view, sheet.width * (0.5 - 0.1 * uphill)))
        if corner[1] > lowest:  # the board leaves the picture through its lower edge
            corner = corner + (corner[1] - lowest) * np.array([uphill / math.tan(tilt), -1])
        sheet.line(corner + np.array([[0, 0], [uphill * reach, 0]]), 0.12 * unit)
        sheet.line(corner + 0.8 * reach * np.array([uphill, -1]) * _towards(np.linspace(0, tilt, 24)), 0.12 * unit)
        place = corner + np.array([uphill * 0.5 * reach, 0.3 * unit])
        sheet.text(place, f"α = {math.degrees(tilt):.3g}°", 1.4 * unit, anchor=(0.5, 0))
        left, right = sorted((float(corner[0]), float(corner[0] + uphill * reach)))
        sheet.boxes.append((left, float(corner[1] - reach * math.sin(tilt)), right, float(corner[1])))

    def _draw_distances(self, sheet: Sheet, view: View) -> None:
        """Write distances down the incline below the board [m], with a tick at each, where there is room."""
        unit, size, lowest = sheet.unit, scale(self.scene), view.top + view.pixels[1]
        ends = [self.along(view, column) / size - self._start for column in (0, sheet.width)]
        most = max(1, int(sheet.width / (6 * unit)))  # two of them are six units apart at least
        numbers = np.round(MaxNLocator(most, steps=[1, 2, 5, 10]).tick_values(*ends), 12)
        down = np.array([-math.sin(self.scene.incline), math.cos(self.scene.incline)])
        for number, place in zip(numbers, self.pixel(view, (numbers + self._start) * size), strict=True):
            words = f"{number:.6g} m".replace("-", "\N{MINUS SIGN}")
            below = place + np.array([0, 0.8 * unit])
            box = sheet.box(below, words, 1.15 * unit, anchor=(0.5, 0))
            inside = box[0] > 0 and box[1] > view.top and box[2] < sheet.width and box[3] < lowest
            if inside and not any(overlap(box, other) for other in sheet.boxes):
                sheet.line(np.array([place, place + 0.5 * unit * down]), 0.12 * unit)
                sheet.text(below, words, 1.15 * unit, anchor=(0.5, 0))
