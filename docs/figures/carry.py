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


def peak(run: Carried, start: float, end: float) -> float:
    """Return the largest force [N] between two times [s]."""
    return float(np.abs(run.force[(run.time >= start) & (run.time <= end)]).max())


def runs(modes: int) -> list[Carried]:
    """Return what a gripper feels in each of the `MOVES`, with some modes of the beer's slosh."""
    can = standing(modes=modes)
    return [carry(can, DISTANCE, move, AFTER) for move in MOVES]


def draw(path: pathlib.Path) -> None:
    """Draw the force while a can is moved in a second, and what a rigid can lacks.

    What it lacks is drawn against the time of the move.
    """
    beer = runs(1)
    rigid = runs(0)
    beer_peaks = np.array([peak(run, 0.0, move) for run, move in zip(beer, MOVES, strict=True)])
    rigid_peaks = np.array([peak(run, 0.0, move) for run, move in zip(rigid, MOVES, strict=True)])
    after = np.array([peak(run, move, math.inf) for run, move in zip(beer, MOVES, strict=True)])
    highest = np.array([np.abs(run.rise).max() for run in beer])
    missed = 100 * (1 - rigid_peaks / beer_peaks)
    ringing = 100 * after / beer_peaks
    # Beyond it, theory is indicative alone.
    within = -highest > -INDICATIVE
    title = (
        f"A rigid can pulls the gripper with up to {missed[within].max():.0f} % less force, "
        "and does not ring"
    )
    subtitle = (
        f"Half a 12-oz can of beer is moved by {DISTANCE:g} m on a path of the least jerk. "
        f"After the stop the beer rings with up to {ringing[within].max():.0f} % of the peak "
        f"force. Grey: its surface rises by more than {INDICATIVE:g} radii, and theory is "
        "indicative alone."
    )
    with plots.chart(path, columns=2, width=9, height=4.4, title=title, subtitle=subtitle) as (
        left,
        right,
    ):
        blue, orange, green = plots.COLOURS[:3]
        for modes, colour in ((0, orange), (1, blue)):
            run = carry(standing(modes=modes), DISTANCE, MOVE, AFTER)
            left.plot(run.time, run.force, color=colour)
        plots.note(left, "a rigid can", (0.3, 0.45), (8, 0), color=orange)
        plots.note(left, "a can with beer", (0.2, 0.56), (8, 0), color=blue)
        plots.note(left, "the beer rings", (1.5, 0.06), (0, 8), color=blue, ha="center")
        left.set(
            xlabel="time [s]",
            ylabel="force on the gripper [N]",
            title=f"Moved within {MOVE:g} s",
        )
        right.plot(MOVES, missed, color=orange)
        right.plot(MOVES, ringing, color=green)
        first = float(np.interp(-INDICATIVE, -highest, MOVES))
        right.axvspan(min(MOVES), first, color=plots.GREY, alpha=0.12, linewidth=0)
        plots.note(right, "beer: ringing after the stop", (1.25, 15.5), (0, 8), color=green)
        plots.note(
            right, "rigid can: lacking at the peak", (1.6, -0.5), (0, -9), color=orange, ha="center"
        )
        right.set(
            xlabel="time that the move takes [s]",
            ylabel="share of the peak force [%]",
            title="What the rigid can lacks",
            ylim=(-3, 24),
        )


if __name__ == "__main__":
    draw(pathlib.Path(__file__).with_name("carry"))
