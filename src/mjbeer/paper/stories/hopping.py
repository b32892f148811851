"""Stories of appendix A.4: the hoop that hops."""

import math
import pathlib
from collections.abc import Iterator
from functools import partial

import numpy as np

from mjbeer.drawing.film import Take
from mjbeer.drawing.look import Look
from mjbeer.output.plots import chart
from mjbeer.paper.equations import hopping
from mjbeer.paper.scenarios import GRIP, MU, RATIO, fall_from_top
from mjbeer.paper.stories.story import Story
from mjbeer.simulation.simulate import simulate
from mjbeer.theory.scene import hoop
from mjbeer.theory.trajectory import Trajectory

_HOP = Look("A weight on the rim makes a light hoop hop", ("normal", "lift"), ("paths", "forces"))
_LIFT_OFF = Look("With less friction the hoop skids before it hops", ("normal", "slip"), ("paths", "forces"))


def stories() -> Iterator[Story]:
    """Yield the stories of this chapter."""
    yield Story(
        "hopping",
        "A hoop with a weight on its rim starts with the weight on top and rolls without slipping. The plot shows the "
        "ground's normal force, divided by m g. Below 0 the ground would have to pull, so the hoop hops: that needs "
        "M/m < 1/13.",
        draw=_draw_normal,
        film=Take(partial(_hop, friction=1.0), speed=0.1, look=_HOP),
    )
    yield Story(
        "lift-off",
        "The angles at which the hoop lifts off and at which it skids, for different masses of the hoop. Littlewood's "
        "90 degrees hold for a massless hoop; with any finite friction coefficient the hoop skids first.",
        draw=_draw_lift_off,
        film=Take(partial(_hop, friction=MU), speed=0.1, look=_LIFT_OFF),
    )


def _hop(friction: float) -> Trajectory:
    """Return the motion of a light hoop, pushed with the weight on top, in contact with level ground."""
    return simulate(hoop(), 0.5, -3.0, 16.0, rolling="contact", timestep=2e-4, friction=friction)


def _draw_normal(path: pathlib.Path) -> None:
    angles = np.linspace(1, 179, 400)
    with chart(path, width=8, height=4.8) as (axes,):
        for ratio, name in ((1e-3, "1/1000"), (RATIO, "1/20"), (1 / 13, "1/13"), (0.2, "1/5")):
            values = [hopping.normal(ratio, math.pi - math.radians(angle)) for angle in angles]
            axes.plot(angles, values, label=f"M/m = {name}")
        axes.axhline(0, color="k", linewidth=0.8)
        axes.axvline(90, color="grey", linewidth=0.8)
        axes.annotate("weight level", (90, 3.3), (4, 0), textcoords="offset points", color="grey", fontsize=9)
        axes.set(
            xlabel="angle of the weight from the top [degrees]",
            ylabel="N / mg",
            ylim=(-1.5, 4),
            title="a hoop of mass M with a weight m on its rim, from rest",
            xticks=range(0, 181, 30),
        )
        axes.legend(loc="upper left")


def _draw_lift_off(path: pathlib.Path) -> None:
    # The angle of lift-off rises like a square root just below 1/13, so that the points are denser there.
    ratios = np.unique(np.append(np.geomspace(1e-3, 0.07, 60), 1 / 13 * (1 - np.geomspace(0.1, 1e-6, 20))))
    few = np.array([2e-3, 8e-3, 0.03, 0.06])
    measured = []
    for ratio in few:
        angle = fall_from_top(hoop(hoop_mass=0.2 * float(ratio)), 5e-5, GRIP).takeoff()
        measured.append(math.nan if angle is None else math.degrees(angle))
    with chart(path, width=8, height=5) as (axes,):
        axes.semilogx(
            ratios, [math.degrees(hopping.lift_off(float(ratio))) for ratio in ratios], label="lifts off, theory"
        )
        axes.semilogx(few, measured, "ko", label="lifts off, MuJoCo in contact, μ = 1 000 000")
        for mu in (0.5, MU, 2.0):
            skids = [math.degrees(hopping.slip(float(ratio), mu)) for ratio in ratios]
            axes.semilogx(ratios, skids, "--", label=f"skids, theory, μ = {mu:g}")
        axes.axhline(90, color="grey", linewidth=0.8)
        axes.axvline(1 / 13, color="grey", linewidth=0.8)
        axes.annotate("Littlewood: 90", (1e-3, 90), (2, 4), textcoords="offset points", color="grey", fontsize=9)
        axes.annotate("1/13", (1 / 13, 78), (-26, 0), textcoords="offset points", color="grey", fontsize=9)
        axes.set(
            xlabel="hoop over weight, M/m",
            ylabel="angle of the weight from the top [degrees]",
            title="where the hoop skids, and where it lifts off",
        )
        axes.legend(loc="upper left", fontsize=9)
