"""A can with beer and a rigid one, carried by the same move: a film and a plot of what the gripper feels."""

import math
import pathlib
import sys
import warnings
from collections.abc import Generator, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np
from matplotlib.colors import to_rgb

from mjbeer.drawing.film import Reel
from mjbeer.drawing.overlay import HEIGHT, STRIP, head
from mjbeer.drawing.sheet import UNITS, Sheet
from mjbeer.drawing.strip import Chart, Line, Strip
from mjbeer.exceptions import LiquidWarning
from mjbeer.output import plots
from mjbeer.simulation.carry import Carried, carry
from mjbeer.theory.standing import INDICATIVE, Standing, standing

_DISTANCE, _MOVE, _AFTER = 0.4, 1.0, 1.0
_NAMES = {"beer": ("beer that sloshes", 1, plots.COLOURS[0]), "rigid": ("rigid", 0, plots.COLOURS[1])}
_BEER, _METAL = to_rgb("#FAA114"), to_rgb("#8A929C")
_MOVES = tuple(float(each) for each in np.geomspace(0.6, 2.5, 24))
"""Times of the moves of the plot [s]."""
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

    def reel(self) -> Reel:
        """Compute both motions, and return what is needed to draw them."""
        cans = {name: standing(modes=modes) for name, (_, modes, _) in _NAMES.items()}
        runs = {name: carry(can, _DISTANCE, _MOVE, _AFTER) for name, can in cans.items()}
        return Reel(0.0, _MOVE + _AFTER, self.speed, partial(self._draw, cans, runs))

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


def draw_plot(path: pathlib.Path, moves: Sequence[float] = _MOVES) -> None:
    """Draw the force while a can is moved in a second, and the rigid can's error over the time of the move.

    Raises:
      OutputError: if a file cannot be written.
    """
    runs = {}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", LiquidWarning)  # the plot says where
        for name, (_, modes, _) in _NAMES.items():
            runs[name] = [carry(standing(modes=modes), _DISTANCE, move, _AFTER) for move in (*moves, _MOVE)]
    peaks = {
        name: np.array([_peak(run, 0.0, move) for run, move in zip(found, moves, strict=False)])
        for name, found in runs.items()
    }
    after = np.array([_peak(run, move, math.inf) for run, move in zip(runs["beer"], moves, strict=False)])
    highest = np.array([np.abs(run.rise).max() for run in runs["beer"][:-1]])
    title, subtitle = "A can on its gripper", "half a 12-oz can of beer, moved by 0.4 m with the least jerk"
    with plots.chart(path, columns=2, width=10, height=4.2, title=title, subtitle=subtitle) as (left, right):
        for name, (told, _, colour) in _NAMES.items():
            left.plot(runs[name][-1].time, runs[name][-1].force, color=colour, label=told)
        plots.label(left, "time [s]", "force [N]", "moved in 1 s")
        left.legend()
        right.plot(moves, 100 * (1 - peaks["rigid"] / peaks["beer"]), color=plots.COLOURS[1], label="peak force")
        right.plot(moves, 100 * after / peaks["beer"], color=plots.COLOURS[2], label="ringing after the stop")
        first = float(np.interp(-INDICATIVE, -highest, moves))
        right.axvspan(min(moves), first, color=plots.GREY, alpha=0.12, linewidth=0)
        plots.note(right, "surface rises\nby more than 0.3 R", (min(moves), right.get_ylim()[1]), (4, -14))
        plots.label(right, "time of the move [s]", "error of a rigid can [% of the peak]", "what a rigid can misses")
        right.legend()


def _peak(run: Carried, start: float, end: float) -> float:
    return float(np.abs(run.force[(run.time >= start) & (run.time <= end)]).max())


if __name__ == "__main__":
    draw_plot(pathlib.Path(sys.argv[1]))
