"""The lines above a picture: what is seen, when, how fast, and what the marks mean."""

import math
from dataclasses import dataclass

from mjbeer.drawing.overlay.look import Look
from mjbeer.drawing.overlay.marks import LEGENDS
from mjbeer.drawing.overlay.sheet import Sheet
from mjbeer.theory.named import in_words
from mjbeer.theory.trajectory import Trajectory

HEIGHT = 4.1
"""Height of the first two lines, in units of the picture."""
_LEGEND = 1.5
"""Height of the third line, which tells what the marks mean, if they need it."""
_FIRST, _SECOND, _THIRD = 1.5, 3.2, 4.7
"""Height at which each of them is."""
_GREY = "#52606d"


@dataclass(frozen=True, eq=False)
class Header:
    """The lines above the pictures of a trajectory."""

    look: Look
    trajectory: Trajectory
    speed: float
    unit: float
    """Unit of length of the sheet [pixels]."""

    @property
    def height(self) -> int:
        """Return the height of the lines [pixels]."""
        return round((HEIGHT + (_LEGEND if self._legend else 0)) * self.unit)

    @property
    def _legend(self) -> list[tuple[str, tuple[float, float, float], str]]:
        return [entry for mark in self.look.marks for entry in LEGENDS[mark]]

    def draw(self, sheet: Sheet, time: float) -> None:
        """Draw the lines as they are at a `time` [s]."""
        unit, column = self.unit, 1.2 * self.unit
        duration = float(self.trajectory.time[-1] - self.trajectory.time[0])
        digits = max(2, math.ceil(-math.log10(duration)) + 1) if duration > 0 else 2
        head(sheet, (self.look.title, in_words(self.trajectory.scene)), time, self.speed, unit, digits)
        sheet.blank(0, round(HEIGHT * unit), sheet.width, self.height)
        for sign, colour, meaning in self._legend:
            *_, column, _ = sheet.text((column, _THIRD * unit), sign, 1.1 * unit, colour, bold=True)
            *_, column, _ = sheet.text((column + 0.5 * unit, _THIRD * unit), meaning, 1.0 * unit)
            column += 1.8 * unit


def head(sheet: Sheet, words: tuple[str, str], time: float, speed: float, unit: float, digits: int) -> None:
    """Draw a title and a scene in words, the `time` [s] with some digits after the point, and the playback speed."""
    sheet.blank(0, 0, sheet.width, round(HEIGHT * unit))
    sheet.text((1.2 * unit, _FIRST * unit), words[0], 1.45 * unit, bold=True)
    sheet.text((1.2 * unit, _SECOND * unit), words[1], 1.1 * unit, _GREY)
    right = sheet.width - 1.2 * unit
    sheet.text((right, _FIRST * unit), f"t = {time:.{digits}f} s", 1.45 * unit, anchor=(1, 0.5))
    sheet.text((right, _SECOND * unit), pace(speed), 1.1 * unit, _GREY, anchor=(1, 0.5))


def pace(speed: float) -> str:
    """Return a playback speed in words."""
    if speed == 1:
        return "real time"
    return f"slowed down {1 / speed:.3g} times" if speed < 1 else f"sped up {speed:.3g} times"
