"""Draws what a gripper feels of a can with beer and of a rigid one.

`python docs/figures/carry.py` writes carry.svg.
"""

import math
import pathlib

import numpy as np

from mjbeer.output import plots
from mjbeer.report.carry import Carried, carry
from mjbeer.theory.standing import INDICATIVE, standing

DISTANCE = 0.4
"""How far a can is moved [m]."""
MOVE = 1.0
"""How long it is moved in the left panel [s]."""
AFTER = 1.0
"""How long it is watched afterwards [s]."""
MOVES = tuple(float(time) for time in np.geomspace(0.6, 2.5, 72))
"""Times of the moves of the right panel [s]."""
MODES = {"beer that sloshes": 1, "rigid": 0}


def peak(run: Carried, start: float, end: float) -> float:
    """Return the largest force [N] between two times [s]."""
    return float(np.abs(run.force[(run.time >= start) & (run.time <= end)]).max())


def runs(modes: int) -> list[Carried]:
    """Return what a gripper feels in each of the `MOVES`, with some modes of the beer's slosh."""
    can = standing(modes=modes)
    return [carry(can, DISTANCE, move, AFTER) for move in MOVES]


def draw(path: pathlib.Path) -> None:
    """Draw the force while a can is moved in a second, and what a rigid can misses.

    What it misses is drawn against the time of the move.
    """
    beer = runs(1)
    rigid = runs(0)
    beer_peaks = np.array([peak(run, 0.0, move) for run, move in zip(beer, MOVES, strict=True)])
    rigid_peaks = np.array([peak(run, 0.0, move) for run, move in zip(rigid, MOVES, strict=True)])
    after = np.array([peak(run, move, math.inf) for run, move in zip(beer, MOVES, strict=True)])
    highest = np.array([np.abs(run.rise).max() for run in beer])
    title = "A can on its gripper"
    subtitle = "half a 12-oz can of beer, moved 0.4 m with the least jerk"
    with plots.chart(path, columns=2, width=10, height=4.2, title=title, subtitle=subtitle) as (
        left,
        right,
    ):
        for (name, modes), colour in zip(MODES.items(), plots.COLOURS, strict=False):
            run = carry(standing(modes=modes), DISTANCE, MOVE, AFTER)
            left.plot(run.time, run.force, color=colour, label=name)
        left.set(xlabel="time [s]", ylabel="force [N]", title="moved in 1 s")
        left.legend()
        missed = 100 * (1 - rigid_peaks / beer_peaks)
        ringing = 100 * after / beer_peaks
        right.plot(MOVES, missed, color=plots.COLOURS[1], label="peak force")
        right.plot(MOVES, ringing, color=plots.COLOURS[2], label="ringing after the stop")
        first = float(np.interp(-INDICATIVE, -highest, MOVES))
        right.set_ylim(-1, 24)  # so that the curves leave room for the note and the legend
        right.axvspan(min(MOVES), first, color=plots.GREY, alpha=0.12, linewidth=0)
        plots.note(right, "surface rises\nby more than 0.3 R", (min(MOVES), 24), (4, -16))
        right.set(
            xlabel="time of the move [s]",
            ylabel="error of a rigid can [% of the peak]",
            title="what a rigid can misses",
        )
        right.legend()


if __name__ == "__main__":
    draw(pathlib.Path(__file__).with_name("carry"))
