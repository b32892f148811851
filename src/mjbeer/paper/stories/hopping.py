"""Stories of appendix A.4: the hoop that hops."""

import math
import pathlib
from collections.abc import Iterator
from functools import partial

import numpy as np
from matplotlib.axes import Axes

from mjbeer.drawing.film import Take
from mjbeer.drawing.overlay.look import Look
from mjbeer.model.setting import FRICTION
from mjbeer.output.plots import COLOURS, GREY, REFERENCE, UNPHYSICAL, chart, name_below, note, ticks
from mjbeer.paper.equations import hopping
from mjbeer.paper.scenarios import GRIP, MU, RATIO, fall_from_top
from mjbeer.paper.stories.story import Story
from mjbeer.simulation.simulate import simulate
from mjbeer.theory.exact import exact
from mjbeer.theory.named import hoop, in_degrees, in_words
from mjbeer.theory.trajectory import Trajectory

_SCENE = f"{in_words(hoop(), {'load'})}; M: mass of the hoop, m: mass of the weight"
_JUMP = 3.0
"""Change of an angle [degrees] from one point to the next, beyond which a line breaks off: elsewhere it is below 1."""


def stories() -> Iterator[Story]:
    """Yield the stories of this chapter."""
    yield Story(
        "hopping",
        "A hoop with a weight on its rim. Left: it starts with the weight on top and rolls without slipping. Where the "
        "ground would have to pull, the lines are dotted; there the hoop hops, which needs M/m < 1/13. Right: a fast "
        "hoop of M/m = 1/20, in contact with the ground, with a friction coefficient of 1.",
        draw=_draw_normal,
        film=Take(
            partial(_hop, FRICTION),
            speed=0.1,
            look=Look("A weight on the rim makes a light hoop hop", ("normal", "lift"), ("paths", "forces")),
        ),
    )
    yield Story(
        "lift-off",
        "Left: the angles at which a hoop that starts from rest lifts off and at which it skids, over its mass. "
        "Littlewood's 90° hold for a massless hoop; with any finite friction coefficient the hoop skids first. A hoop "
        "just too heavy to skid at 80° grips until after 90°: hence the jump. Right: a fast hoop skids, then hops.",
        draw=_draw_lift_off,
        film=Take(
            partial(_hop, MU),
            speed=0.1,
            look=Look("With less friction the hoop skids before it hops", ("normal", "slip"), ("paths", "forces")),
        ),
    )


def _hop(friction: float) -> Trajectory:
    """Return the motion of a light hoop, pushed with the weight on top, in contact with level ground."""
    return simulate(hoop(), 0.5, -3.0, 16.0, rolling="contact", timestep=2e-4, friction=friction)


def _draw_hop(axes: Axes, friction: float, sliding: bool) -> None:
    """Draw the height of a pushed hoop, how far it has slid if asked for, and what theory foresees."""
    run = _hop(friction)
    rolling = exact(run.scene, np.linspace(0, 0.06, 6001), run.phi0, run.phi_dot0)
    if sliding:
        axes.plot(run.time, 1e3 * run.slip, color=COLOURS[2], label="slip: distance less the arc turned, MuJoCo")
    axes.plot(run.time, 1e3 * run.lift, color="black", label="height above the ground, MuJoCo")
    skids, parts = rolling.rolls_until(friction), rolling.rolls_until()
    for event, line, name in (
        (skids, "--", "theory: it skids from here on"),
        (parts, ":", "theory: here N = 0 if it still rolled"),
    ):
        axes.axvline(event, label=name, color=GREY, linewidth=1.2, linestyle=line)
    axes.set(
        xlabel="time t [s]",
        ylabel="distance [mm]" if sliding else "height [mm]",
        title=f"Pushed: φ = {in_degrees(run.phi0)}, {run.phi_dot0:g} rad/s, M/m = 1/20, μ = {friction:g}",
    )


def _draw_normal(path: pathlib.Path) -> None:
    angles = np.linspace(1, 179, 400)
    title = "Why a hoop hops: the ground would have to pull"
    with chart(path, 1, 2, width=12, height=5.4, title=title, subtitle=_SCENE) as (push, hop):
        for (ratio, name), colour in zip(
            ((1e-3, "1/1000"), (RATIO, "1/20"), (1 / 13, "1/13"), (0.2, "1/5")), COLOURS, strict=False
        ):
            values = np.array([hopping.normal(ratio, math.pi - math.radians(angle)) for angle in angles])
            negative = np.flatnonzero(values < 0)
            end = negative[0] if len(negative) else len(angles)
            push.plot(angles[:end], values[:end], color=colour, label=f"M/m = {name}")
            push.plot(angles[end:], values[end:], ":", color=colour)
        push.plot([], [], label="after it would have hopped", **UNPHYSICAL)
        push.axhline(0, **REFERENCE)
        push.axvline(90, **REFERENCE)
        note(push, "weight level\nwith the axis", (90, 2.6), (-6, 0), ha="right")
        push.set(
            xlabel="angle of the weight from the top [°]",
            ylabel="normal force / weight on the rim, N / m g",
            ylim=(-1.5, 4),
            title="Rolling from rest, theory",
            xticks=range(0, 181, 30),
        )
        _draw_hop(hop, FRICTION, sliding=False)
        name_below([push, hop], 3)


def _skids(ratios: np.ndarray, mu: float) -> tuple[np.ndarray, np.ndarray]:
    """Return ratios M/m and the angles from the top at which a hoop skids [degrees], with a gap (NaN) at a jump."""
    angles = np.degrees([hopping.slip(float(ratio), mu) for ratio in ratios])
    jumps = np.flatnonzero(np.abs(np.diff(angles)) > _JUMP)
    for place in jumps[::-1]:
        low, high = ratios[place], ratios[place + 1]
        while high - low > 1e-3 * low:
            middle = (low + high) / 2
            before = abs(math.degrees(hopping.slip(float(middle), mu)) - angles[place]) < _JUMP
            low, high = (middle, high) if before else (low, middle)
        ends = np.degrees([hopping.slip(float(low), mu), math.nan, hopping.slip(float(high), mu)])
        ratios, angles = np.insert(ratios, place + 1, [low, low, high]), np.insert(angles, place + 1, ends)
    return ratios, angles


def _draw_lift_off(path: pathlib.Path) -> None:
    # The angle of lift-off rises like a square root just below 1/13, so that the points are denser there.
    ratios = np.unique(np.append(np.geomspace(1e-3, 0.07, 60), 1 / 13 * (1 - np.geomspace(0.1, 1e-6, 20))))
    few = np.array([2e-3, 8e-3, 0.03, 0.06])
    measured = []
    for ratio in few:
        angle = fall_from_top(hoop(hoop_mass=0.2 * float(ratio)), 5e-5, GRIP).takeoff()
        measured.append(math.nan if angle is None else math.degrees(angle))
    title = "Before a hoop lifts off, it skids"
    with chart(path, 1, 2, width=12, height=5.6, title=title, subtitle=_SCENE) as (where, hop):
        lifts = [math.degrees(hopping.lift_off(float(ratio))) for ratio in ratios]
        where.plot(ratios, lifts, color=COLOURS[0], label="lifts off, theory")
        where.plot(few, measured, "o", color=COLOURS[0], label="lifts off, MuJoCo, μ = 1 000 000")
        for mu, colour in ((0.5, COLOURS[4]), (MU, COLOURS[1]), (2.0, COLOURS[3])):
            where.plot(*_skids(ratios, mu), "--", color=colour, label=f"skids, theory, μ = {mu:g}")
        where.axhline(90, **REFERENCE)
        where.axvline(1 / 13, **REFERENCE)
        note(where, "Littlewood: 90°", (0.01, 90), (4, -8))
        note(where, "M/m = 1/13", (1 / 13, 75), (-4, 0), ha="right")
        where.set(
            xscale="log",
            xlabel="mass of the hoop / weight on its rim, M / m",
            ylabel="angle of the weight from the top [°]",
            title="Rolling from rest",
        )
        ticks(where.xaxis, (0.001, 0.002, 0.005, 0.01, 0.02, 0.05))
        _draw_hop(hop, MU, sliding=True)
        name_below([where, hop], 3)
