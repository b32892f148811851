"""Draws what a gripper feels of a can with beer and of a rigid one: `python docs/figures/carry.py` writes carry.svg."""

import math
import pathlib

import numpy as np

from mjbeer.output import plots
from mjbeer.report.carry import Carried, carry
from mjbeer.theory.standing import INDICATIVE, standing

DISTANCE, MOVE, AFTER = 0.4, 1.0, 1.0
"""How far and how long a can is moved [m], [s], and how long it is watched afterwards [s]."""
MOVES = tuple(float(each) for each in np.geomspace(0.6, 2.5, 72))
"""Times of the moves of the right panel [s]."""
MODES = {"beer that sloshes": 1, "rigid": 0}


def peak(run: Carried, start: float, end: float) -> float:
    """Return the largest force [N] between two times [s]."""
    return float(np.abs(run.force[(run.time >= start) & (run.time <= end)]).max())


def draw(path: pathlib.Path) -> None:
    """Draw the force while a can is moved in a second, and the rigid can's error over the time of the move."""
    beer, rigid = (
        [carry(standing(modes=modes), DISTANCE, move, AFTER) for move in (*MOVES, MOVE)]
        for modes in MODES.values()
    )
    peaks = [
        np.array([peak(run, 0.0, move) for run, move in zip(of, MOVES, strict=False)])
        for of in (beer, rigid)
    ]
    after = np.array([peak(run, move, math.inf) for run, move in zip(beer, MOVES, strict=False)])
    highest = np.array([np.abs(run.rise).max() for run in beer[:-1]])
    title, subtitle = (
        "A can on its gripper",
        "half a 12-oz can of beer, moved 0.4 m with the least jerk",
    )
    with plots.chart(path, columns=2, width=10, height=4.2, title=title, subtitle=subtitle) as (
        left,
        right,
    ):
        for name, of, colour in zip(MODES, (beer, rigid), plots.COLOURS, strict=False):
            left.plot(of[-1].time, of[-1].force, color=colour, label=name)
        left.set(xlabel="time [s]", ylabel="force [N]", title="moved in 1 s")
        left.legend()
        right.plot(
            MOVES, 100 * (1 - peaks[1] / peaks[0]), color=plots.COLOURS[1], label="peak force"
        )
        right.plot(
            MOVES, 100 * after / peaks[0], color=plots.COLOURS[2], label="ringing after the stop"
        )
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
