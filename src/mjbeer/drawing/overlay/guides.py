"""What stands still in a picture and explains it: gravity's arrow, the incline's angle, and distances on the board."""

import math
from dataclasses import dataclass

import mujoco
import numpy as np

from mjbeer.drawing.overlay.sheet import Box, Sheet, overlap
from mjbeer.drawing.world.display import on_incline, scale
from mjbeer.drawing.world.view import View
from mjbeer.theory.scene import Scene

_DARK = (0.12, 0.16, 0.2)
"""Colour of gravity's arrow."""
_ALPHA = "\N{GREEK SMALL LETTER ALPHA}"
_SPACING = 7.0
"""Least distance of two numbers on the board, in units of the sheet."""


@dataclass(frozen=True, eq=False)
class Board:
    """The near edge of the board's underside, where its numbers and the angle of the incline are."""

    scene: Scene
    front: float
    """Its coordinate y [m]."""
    under: float
    """Its height over the surface on which the can rolls, negative [m]."""

    @classmethod
    def of(cls, scene: Scene, model: mujoco.MjModel) -> "Board":
        """Return the edge of the board of a display model."""
        board = model.geom("board")
        return cls(scene, front=float(board.pos[1] - board.size[1]), under=float(board.pos[2] - board.size[2]))

    def pixel(self, view: View, along: np.ndarray | float) -> np.ndarray:
        """Return column and row of points of the edge, `along` the incline as drawn [m], shape (..., 2)."""
        x, z = np.moveaxis(on_incline(self.scene, along, self.under), -1, 0)
        return view.pixel(np.stack([x, np.full_like(x, self.front), z], axis=-1))

    def along(self, view: View, column: float) -> float:
        """Return how far down the incline the edge is seen in a column of the picture, as drawn [m]."""
        first, second = self.pixel(view, np.array([0.0, 1.0]))[:, 0]
        return float((column - first) / (second - first))


def draw(sheet: Sheet, board: Board, view: View, top: int, unit: float) -> None:
    """Draw gravity's arrow, the incline's angle and distances into a view whose upper edge is at a row of the sheet.

    `unit` is the unit of length of the sheet [pixels].
    """
    width, height = view.pixels
    sheet.clip((0, top, width, top + height))
    shift = np.array([0.0, top])
    tail = np.array([width - 1.6 * unit, top + 1.0 * unit])
    if board.scene.incline < 0:
        tail[0] = 3 * unit
    sheet.arrow(tail, tail + np.array([0, 4.2 * unit]), 0.32 * unit, _DARK)
    sheet.text(tail + np.array([-0.6, 2]) * unit, "g", 1.5 * unit, anchor=(1, 0.5))
    taken = [_draw_angle(sheet, board, view, shift, unit)] if board.scene.incline else []
    _draw_distances(sheet, board, view, shift, unit, taken)
    sheet.clip(None)


def _draw_angle(sheet: Sheet, board: Board, view: View, shift: np.ndarray, unit: float) -> Box:
    """Draw the angle of the incline under the board's lower end, and return the box of its lines."""
    width, height = view.pixels
    uphill = -math.copysign(1.0, board.scene.incline)
    tilt, reach = abs(board.scene.incline), 9 * unit
    column = width - 2 * unit if uphill < 0 else 2 * unit
    lowest = height - 2.6 * unit
    corner = board.pixel(view, board.along(view, column))
    if corner[1] > lowest:  # the board leaves the picture through its lower edge
        corner = corner + (corner[1] - lowest) * np.array([uphill / math.tan(tilt), -1])
    corner = corner + shift
    sheet.line(corner + np.array([[0, 0], [uphill * reach, 0]]), 0.12 * unit)
    arc = np.linspace(0, tilt, 24)
    sheet.line(corner + 0.8 * reach * np.stack([uphill * np.cos(arc), -np.sin(arc)], axis=1), 0.12 * unit)
    ends = sorted((float(corner[0]), float(corner[0] + uphill * reach)))
    place = corner + np.array([uphill * 0.5 * reach, 0.3 * unit])
    sheet.text(place, f"{_ALPHA} = {degrees(tilt)}", 1.4 * unit, anchor=(0.5, 0))
    return ends[0], float(corner[1] - reach * math.sin(tilt)), ends[1], float(corner[1])


def _draw_distances(sheet: Sheet, board: Board, view: View, shift: np.ndarray, unit: float, taken: list[Box]) -> None:
    """Write distances down the incline below the board [m], with a tick at each, where there is room."""
    width, height = view.pixels
    ends = [board.along(view, column) / scale(board.scene) for column in (0, width)]
    step = _round((ends[1] - ends[0]) * _SPACING * unit / width)
    numbers = step * np.arange(math.ceil(min(ends) / step), math.floor(max(ends) / step) + 1)
    down = np.array([-math.sin(board.scene.incline), math.cos(board.scene.incline)])
    window = (0.0, shift[1], float(width), shift[1] + height)
    for number, place in zip(numbers, board.pixel(view, numbers * scale(board.scene)) + shift, strict=True):
        words = f"{round(number / step) * step:.6g} m".replace("-", "\N{MINUS SIGN}")
        below = place + np.array([0, 0.8 * unit])
        box = sheet.box(below, words, 1.15 * unit, anchor=(0.5, 0))
        inside = window[0] < box[0] and window[1] < box[1] and box[2] < window[2] and box[3] < window[3]
        if inside and not any(overlap(box, other) for other in sheet.boxes + taken):
            sheet.line(np.array([place, place + 0.5 * unit * down]), 0.12 * unit)
            sheet.text(below, words, 1.15 * unit, anchor=(0.5, 0))


def _round(least: float) -> float:
    """Return the least of 1, 2 and 5 times a power of ten that is not less than a number."""
    power = 10.0 ** math.floor(math.log10(least))
    return next(power * factor for factor in (1, 2, 5, 10) if power * factor >= least * (1 - 1e-9))


def degrees(angle: float) -> str:
    """Return an `angle` [rad] as text in degrees, with three digits."""
    return f"{math.degrees(angle):.3g}°"
