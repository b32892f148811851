"""Texts and lines at the board, which stand still: gravity, the incline's angle, and distances."""

import math

import numpy as np
from matplotlib.ticker import MaxNLocator

from mjbeer.drawing.camera import View, in_space, scale, unit_vectors
from mjbeer.drawing.scene import Display
from mjbeer.drawing.sheet import INK, Box, Sheet, overlap

_ASIDE = 0.28
"""Distance of the incline's angle from the middle of the picture, in widths of the picture."""


class Board:
    """The board of a display, with gravity's arrow, the incline's angle, and distances below it.

    Angle and distances are written at the near edge of the board's underside.
    """

    def __init__(self, display: Display, start: float = 0.0) -> None:
        """Take the board of a display; `start` is where the distances begin [m]."""
        board = display.model.geom("board")
        self.front = float(board.pos[1] - board.size[1])
        """The coordinate y of the edge [m]."""
        self.under = float(board.pos[2] - board.size[2])
        """Its height above the incline [m], which is negative."""
        self._scene = display.scenes[0]
        self._start = start

    def pixel(self, view: View, along: np.ndarray | float) -> np.ndarray:
        """Return column and row of points of the edge, shape (..., 2); `along` is as drawn [m]."""
        return view.pixel(in_space(self._scene, along, self.under, self.front))

    def along(self, view: View, column: float) -> float:
        """Return how far down the incline the edge is in a column of the picture, as drawn [m]."""
        first, second = self.pixel(view, np.array([0.0, 1.0]))[:, 0]
        return float((column - first) / (second - first))

    def draw(self, sheet: Sheet, view: View) -> None:
        """Draw gravity's arrow, the incline's angle and distances."""
        self._draw_gravity(sheet, view)
        if self._scene.incline:
            self._draw_angle(sheet, view)
        self.draw_distances(sheet, view)

    def _draw_gravity(self, sheet: Sheet, view: View) -> None:
        """Draw gravity's arrow in the corner from which the incline falls away."""
        unit = sheet.unit
        column = 3 * unit if self._scene.incline < 0 else sheet.width - 1.6 * unit
        tail = np.array([column, view.top + 1.0 * unit])
        sheet.arrow(tail, tail + np.array([0, 4.2 * unit]), 0.32 * unit, INK)
        sheet.text(tail + np.array([-0.6, 2]) * unit, "g", 1.5 * unit, anchor=(1, 0.5))

    def _draw_angle(self, sheet: Sheet, view: View) -> None:
        """Draw the angle of the incline under the board, and keep other texts from its lines."""
        unit = sheet.unit
        tilt = abs(self._scene.incline)
        uphill = -math.copysign(1.0, self._scene.incline)  # 1 to the right
        reach = 9 * unit
        lowest = view.top + view.pixels[1] - 2.6 * unit
        # Uphill of the middle, where a can and its arrows seldom are, and whole in the picture.
        aside = min(_ASIDE * sheet.width, sheet.width / 2 - reach - unit)
        corner = self.pixel(view, self.along(view, sheet.width / 2 + uphill * aside))
        if corner[1] > lowest:  # the board leaves the picture through its lower edge
            corner = corner + (corner[1] - lowest) * np.array([uphill / math.tan(tilt), -1])
        end = corner + np.array([uphill * reach, 0])
        arc = np.array([uphill, -1]) * unit_vectors(np.linspace(0, tilt, 24))
        sheet.line(np.array([corner, end]), 0.12 * unit)
        sheet.line(corner + 0.8 * reach * arc, 0.12 * unit)
        place = corner + np.array([uphill * 0.5 * reach, 0.3 * unit])
        sheet.text(place, f"α = {math.degrees(tilt):.3g}°", 1.4 * unit, anchor=(0.5, 0))
        left, right = sorted([float(corner[0]), float(end[0])])
        height = reach * math.sin(tilt)
        sheet.boxes.append(Box(left, float(corner[1] - height), right, float(corner[1])))

    def draw_distances(self, sheet: Sheet, view: View) -> None:
        """Write distances [m] below the board, with a tick at each, where there is room."""
        unit = sheet.unit
        size = scale(self._scene)
        first = self.along(view, 0) / size - self._start
        last = self.along(view, sheet.width) / size - self._start
        most = max(1, int(sheet.width / (6 * unit)))  # two of them are six units apart at least
        ticks = MaxNLocator(most, steps=[1, 2, 5, 10]).tick_values(first, last)
        numbers = np.round(ticks, 12)
        places = self.pixel(view, (numbers + self._start) * size)
        down = np.array([-math.sin(self._scene.incline), math.cos(self._scene.incline)])
        for number, place in zip(numbers, places, strict=True):
            words = f"{number:.6g} m".replace("-", "\N{MINUS SIGN}")
            below = place + np.array([0, 0.8 * unit])
            box = sheet.box(below, words, 1.15 * unit, anchor=(0.5, 0))
            if _has_room(box, sheet, view):
                sheet.line(np.array([place, place + 0.5 * unit * down]), 0.12 * unit)
                sheet.text(below, words, 1.15 * unit, anchor=(0.5, 0))


def _has_room(box: Box, sheet: Sheet, view: View) -> bool:
    """Return whether a box is inside the picture, and free of texts with a gap beside it."""
    gap = 0.6 * sheet.unit
    apart = box._replace(left=box.left - gap, right=box.right + gap)
    in_columns = box.left > 0 and box.right < sheet.width
    in_rows = box.top > view.top and box.bottom < view.top + view.pixels[1]
    return in_columns and in_rows and not any(overlap(apart, other) for other in sheet.boxes)
