"""A can with beer and a rigid one, carried by the same move: a film and a plot of what the gripper feels."""

import io
import math
import pathlib
import sys
import warnings
from collections.abc import Generator, Sequence
from dataclasses import dataclass
from functools import partial

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Polygon

from mjbeer.drawing.film import Reel
from mjbeer.exceptions import LiquidWarning
from mjbeer.output import plots
from mjbeer.simulation.carry import Carried, carry
from mjbeer.theory.standing import INDICATIVE, Standing, standing

_DISTANCE, _MOVE, _AFTER = 0.4, 1.0, 1.0
_NAMES = {"beer": ("beer that sloshes", 1, plots.COLOURS[0]), "rigid": ("rigid", 0, plots.COLOURS[1])}
_BEER, _METAL = "#FAA114", "#8A929C"
_MOVES = tuple(float(each) for each in np.geomspace(0.6, 2.5, 24))
"""Times of the moves of the plot [s]."""
_LOWER = 0.16
"""Distance of the rigid can below the other one in the film [m]."""


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
        with mpl.rc_context(plots.STYLE):
            figure = Figure(figsize=(8, 8 * (height + 0.5) / width), dpi=width / 8)  # a part of a pixel is cut off
            stage, chart = figure.subplots(2, 1, height_ratios=[2.2, 1])
            moving = _scenery(stage, cans)
            for name, run in runs.items():
                chart.plot(run.time, run.force, color=_NAMES[name][2], label=_NAMES[name][0])
            now = chart.axvline(0, **plots.REFERENCE)
            plots.label(chart, "time [s]", "force [N]", xlim=(0, _MOVE + _AFTER))
            chart.legend(loc="upper right", ncols=2)
        for time in times:
            for name, (wall, beer) in moving.items():
                shell, liquid = _outline(cans[name], runs[name], float(time), _LOWER * (name == "beer"))
                wall.set_xy(shell)
                beer.set_xy(liquid)
            now.set_xdata([time, time])
            stage.set_title(f"Two cans, one gripper: t = {time:.2f} s, {self.speed:g} times as fast as in reality")
            picture = io.BytesIO()
            with mpl.rc_context(plots.STYLE):
                figure.savefig(picture, format="rgba", facecolor="white")
            yield np.frombuffer(picture.getvalue(), np.uint8).reshape(height, width, 4)[..., :3].copy()


def _scenery(stage: Axes, cans: dict[str, Standing]) -> dict[str, tuple[Polygon, Polygon]]:
    """Set up the view, and return wall and liquid of each can."""
    room = 3 * next(iter(cans.values())).can.radius
    stage.set(xlim=(-room, _DISTANCE + room), ylim=(-0.03, _LOWER + 0.13))
    stage.set_aspect("equal")
    stage.set_axis_off()
    moving = {}
    for name in cans:
        floor = _LOWER * (name == "beer")
        stage.axhline(floor, color=plots.GREY, linewidth=1)
        stage.text(-room, floor - 0.004, _NAMES[name][0], va="top", color=_NAMES[name][2])
        beer = Polygon(np.zeros((4, 2)), facecolor=_BEER)
        wall = Polygon(np.zeros((4, 2)), closed=False, fill=False, edgecolor=_METAL, linewidth=3)
        for each in (beer, wall):
            stage.add_patch(each)
        moving[name] = wall, beer
    return moving


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
    draw_plot(target := pathlib.Path(sys.argv[1]))
    target.with_suffix(".png").unlink()
