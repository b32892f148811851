"""Stories of appendix A.4: the hoop that hops."""

import math
import pathlib
from collections.abc import Iterator

import numpy as np

from mjbeer.drawing.film import Film
from mjbeer.output.plots import chart
from mjbeer.paper.equations import hopping
from mjbeer.paper.scenarios import GRIP, MU, RATIO, fall_from_top
from mjbeer.paper.stories.story import Story
from mjbeer.simulation.simulate import simulate
from mjbeer.theory.scene import hoop


def stories() -> Iterator[Story]:
    """Yield the stories of the chapter."""
    yield Story(
        "hopping",
        "A hoop with a weight on its rim falls from its top without slipping. What the ground pushes with, over the "
        "weight's own weight: below 0 it would have to pull, and the hoop hops. That needs M/m < 1/13.",
        _normal,
        Film(0.1, lambda: simulate(hoop(), 0.5, -3.0, 16.0, rolling="contact", timestep=2e-4)),
    )  # fmt: skip
    yield Story(
        "lift-off",
        "Where the hoop lifts off and where it skids, over its own mass. Littlewood's 90 degrees are the limit of no "
        "mass; at any finite friction the hoop skids first.",
        _lift_off,
        Film(0.1, lambda: simulate(hoop(), 0.5, -3.0, 16.0, rolling="contact", timestep=2e-4, friction=MU)),
    )  # fmt: skip


def _normal(path: pathlib.Path) -> None:
    angles = np.linspace(1, 179, 400)
    with chart(path, width=8, height=4.8) as (axes,):
        for ratio, name in ((1e-3, "1/1000"), (RATIO, "1/20"), (1 / 13, "1/13"), (0.2, "1/5")):
            values = [hopping.normal(ratio, math.pi - math.radians(each)) for each in angles]
            axes.plot(angles, values, label=f"M/m = {name}")
        axes.axhline(0, color="k", linewidth=0.8)
        axes.axvline(90, color="grey", linewidth=0.8)
        axes.annotate("weight level", (90, 3.3), (4, 0), textcoords="offset points", color="grey", fontsize=9)
        axes.set(
            xlabel="angle of the weight from the top [degrees]", ylabel="N / mg", ylim=(-1.5, 4),
            title="a hoop of mass M with a weight m on its rim, from rest", xticks=range(0, 181, 30),
        )  # fmt: skip
        axes.legend(loc="upper left")


def _lift_off(path: pathlib.Path) -> None:
    # Denser towards 1/13, where the angle of lift-off rises as a root does.
    ratios = np.unique(np.append(np.geomspace(1e-3, 0.07, 60), 1 / 13 * (1 - np.geomspace(0.1, 1e-6, 20))))
    few = np.array([2e-3, 8e-3, 0.03, 0.06])
    seen = []
    for ratio in few:
        angle = fall_from_top(hoop(hoop_mass=0.2 * float(ratio)), 5e-5, GRIP).takeoff()
        seen.append(math.nan if angle is None else math.degrees(angle))
    with chart(path, width=8, height=5) as (axes,):
        axes.semilogx(
            ratios, [math.degrees(hopping.lift_off(float(each))) for each in ratios], label="lifts off, theory"
        )
        axes.semilogx(few, seen, "ko", label="lifts off, MuJoCo in contact, μ = 1 000 000")
        for mu in (0.5, MU, 2.0):
            skids = [math.degrees(hopping.slip(float(each), mu)) for each in ratios]
            axes.semilogx(ratios, skids, "--", label=f"skids, theory, μ = {mu:g}")
        axes.axhline(90, color="grey", linewidth=0.8)
        axes.axvline(1 / 13, color="grey", linewidth=0.8)
        axes.annotate("Littlewood: 90", (1e-3, 90), (2, 4), textcoords="offset points", color="grey", fontsize=9)
        axes.annotate("1/13", (1 / 13, 78), (-26, 0), textcoords="offset points", color="grey", fontsize=9)
        axes.set(
            xlabel="hoop over weight, M/m", ylabel="angle of the weight from the top [degrees]",
            title="where the hoop skids, and where it lifts off",
        )  # fmt: skip
        axes.legend(loc="upper left", fontsize=9)
