"""The film of two cans, one with beer and one rigid, that are carried by the same move."""

from collections.abc import Generator
from dataclasses import dataclass
from functools import partial

import numpy as np
from matplotlib.colors import to_rgb

from mjbeer.drawing.film import RenderPlan
from mjbeer.drawing.overlay import HEIGHT, STRIP, head
from mjbeer.drawing.sheet import UNITS, Sheet
from mjbeer.drawing.strip import Chart, Line, Strip
from mjbeer.output import plots
from mjbeer.simulation.carry import Carried, carry
from mjbeer.theory.standing import Standing, standing

_DISTANCE, _MOVE, _AFTER = 0.4, 1.0, 1.0
_NAMES = {"beer": ("beer that sloshes", 1, plots.COLOURS[0]), "rigid": ("rigid", 0, plots.COLOURS[1])}
_BEER, _METAL = to_rgb("#FAA114"), to_rgb("#8A929C")
_LOWER, _TALL = 0.16, 0.32
"""Distance of the rigid can below the other one, and height of what is seen above the chart [m]."""


@dataclass(frozen=True)
class Carry:
    """The film of two cans that are moved by 0.4 m in one second; it is a `drawing.film.Film`."""

    title: str = "Two cans in one gripper: beer that sloshes, and a rigid one"
    speed: float = 0.5
    still: float = 0.25
    caption: str = (
        "Two cans, half full, are carried by 0.4 m in one second by the same gripper. In the upper one the beer is "
        "free to slosh, and its surface tilts; in the lower one it is solid, as in other simulators. Below is the "
        "force of the gripper: the beer needs a tenth more, and goes on after the stop."
    )

    def plan(self) -> RenderPlan:
        """Compute both motions, and return what is needed to draw them."""
        cans = {name: standing(modes=modes) for name, (_, modes, _) in _NAMES.items()}
        runs = {name: carry(can, _DISTANCE, _MOVE, _AFTER) for name, can in cans.items()}
        return RenderPlan(0.0, _MOVE + _AFTER, self.speed, partial(self._draw, cans, runs))

    def _draw(
        self, cans: dict[str, Standing], runs: dict[str, Carried], times: np.ndarray, width: int, height: int
    ) -> Generator[np.ndarray]:
        sheet, unit = Sheet(width, height), height / UNITS
        below = round(STRIP * unit)
        scale, foot = (height - HEIGHT * unit - below) / _TALL, height - below - 2.2 * unit
        corner = np.array([(width - _DISTANCE * scale) / 2, foot])
        lines = [Line(told, runs[name].time, runs[name].force, to_rgb(hue)) for name, (told, _, hue) in _NAMES.items()]
        strip = Strip([Chart("force of the gripper [N]", lines)], width, below)
        words = self.title, f"half a 12-oz can of beer, carried by {_DISTANCE:g} m in {_MOVE:g} s"
        for time in times:
            sheet.blank(0, 0, width, height)
            head(sheet, words, time, self.speed, unit)
            for name, (told, _, hue) in _NAMES.items():
                floor = _LOWER * (name == "beer")
                shell, liquid = _outline(cans[name], runs[name], float(time), floor)
                sheet.area(corner + liquid * [scale, -scale], _BEER)
                sheet.line(corner + shell * [scale, -scale], 0.25 * unit, _METAL)
                row = foot - floor * scale
                sheet.line(np.array([[1.2 * unit, row], [width - 1.2 * unit, row]]), 0.08 * unit, plots.GREY)
                sheet.text((1.2 * unit, row + 0.9 * unit), told, 1.1 * unit, hue)
            strip.draw(sheet, time, height - below)
            yield sheet.picture()


def _outline(can: Standing, run: Carried, time: float, floor: float) -> tuple[np.ndarray, np.ndarray]:
    """Return the corners of wall and liquid [m] at a time [s], shape (4, 2) each; the surface is drawn plane."""
    x, rise = np.interp(time, run.time, run.place), np.interp(time, run.time, run.rise) * can.can.radius
    left, right = x - can.can.radius, x + can.can.radius
    heights = can.can.length, 0.0, 0.0, can.can.length
    levels = can.height - rise, 0.0, 0.0, can.height + rise
    sides = left, left, right, right
    return np.stack([sides, floor + np.array(heights)], axis=1), np.stack([sides, floor + np.array(levels)], axis=1)
