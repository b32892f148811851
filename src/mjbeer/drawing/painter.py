"""Draws cans on their board onto a sheet."""

from dataclasses import dataclass

import numpy as np

from mjbeer.drawing.overlay.sheet import Sheet
from mjbeer.drawing.world.canvas import Canvas
from mjbeer.drawing.world.display import Display, on_incline, scale
from mjbeer.drawing.world.view import View, circle
from mjbeer.theory.can import RADIUS

_RIM = 1.12
"""Radius of what is drawn of a can, in radii, with room for what sticks out of it."""


@dataclass
class Painter:
    """Draws cans on their board. Before a camera that stands still, only the parts with cans are drawn anew.

    Drawing takes as long as there are pixels: a can that takes a tenth of the picture is drawn in a tenth of the time.
    """

    canvas: Canvas
    display: Display
    still: bool
    """Whether all views are the same."""
    _empty: np.ndarray | None = None
    """The board without cans."""

    def paint(self, sheet: Sheet, view: View, positions: np.ndarray, top: int) -> None:
        """Draw a view onto a sheet, below a row of it, with u, phi, roll and lift of each can in the rows."""
        if self._empty is None and self.still:
            self.display.hide()
            board = self.canvas.draw(self.display.data, view)
            self._empty = np.dstack([board, np.full(board.shape[:2], 255, np.uint8)])
        self.display.pose(positions)
        if self._empty is None:
            sheet.put(self.canvas.draw(self.display.data, view), 0, top)
            return
        sheet.put(self._empty, 0, top)
        for number, position in enumerate(positions):
            left, upper, right, lower = view.box(outline(self.display, number, position), margin=3)
            if right > left and lower > upper:
                crop = view.crop(left, upper, right, lower)
                sheet.put(self.canvas.draw(self.display.data, crop), left, top + upper)


def outline(display: Display, number: int, position: np.ndarray) -> np.ndarray:
    """Return points around both ends of a can [m], shape (2, points, 3), for its u, phi, roll and lift."""
    scene = display.scenes[number]
    centre = on_incline(scene, position[0] * scale(scene), RADIUS + position[3] * scale(scene))
    places = centre + circle(_RIM * RADIUS)
    near = display.front(number)
    return np.stack([np.insert(places, 1, y, axis=1) for y in (near, near + display.length(number))])
