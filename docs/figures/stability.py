"""Draws the pictures in docs/stability.md anew: `python docs/figures/stability.py [STUDY]`.

The maps are those that come with mjbeer. The limits are those of a whole study, `mjbeer stability --long`, whose
stability.jsonl is the STUDY.
"""

import pathlib
import sys
from collections.abc import Sequence
from typing import Any

from matplotlib.artist import Artist
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from mjbeer.model.setting import DOP853, INTEGRATORS, ROLLINGS
from mjbeer.output.plots import COLOURS, GREY, chart, name_below
from mjbeer.predictions import linear_stability
from mjbeer.studies.cases import CASES
from mjbeer.studies.rows import Result, Study
from mjbeer.studies.stability import stiff_maps
from mjbeer.studies.stability.limits import GROUP
from mjbeer.studies.stability.study import COMMAND


def draw(results: Sequence[Result], path: pathlib.Path) -> None:
    """Draw the limits over the integrators, to `path` with .svg appended."""
    limits = [result.values for result in results]
    names = [name for name in (*INTEGRATORS, DOP853) if any(of["integrator"] == name for of in limits)]
    cases = [case for case in CASES if any(of["case"] == case for of in limits)]
    markers, colours = dict(zip(ROLLINGS, "os^", strict=True)), dict(zip(CASES, COLOURS, strict=False))
    title = "How long may a timestep be? Limits of small swings, and linear theory"
    subtitle = "reduced: rolling is built into the coordinates; equality: a constraint of two joints; contact: friction"
    with chart(path, width=10, height=6.5, title=title, subtitle=subtitle) as [axes]:
        for place, name in enumerate(names):
            for limit in (linear_stability.stable_limit(name), linear_stability.accurate_limit(name)):
                axes.plot([place - 0.45, place + 0.45], [limit] * 2, color="black", linewidth=1.2, zorder=1)
        for of in limits:
            x = names.index(of["integrator"]) + (cases.index(of["case"]) - (len(cases) - 1) / 2) * 0.16
            x += (ROLLINGS.index(of["rolling"]) - 1) * 0.045
            style: dict[str, Any] = {"linestyle": "none", "color": colours[of["case"]], "markersize": 6}
            marker = markers[of["rolling"]] if of["settled"] else "x"
            axes.plot([x], [of["stable"]], marker=marker, **style)
            if of["settled"]:
                axes.plot([x], [of["accurate"]], marker=marker, markerfacecolor="white", **style)
        style = {"linestyle": "none", "color": GREY}
        handles: list[Artist] = [Patch(facecolor=colours[case], label=case) for case in cases]
        handles += [Line2D([], [], marker=marker, label=name, **style) for name, marker in markers.items()]
        handles += [
            Line2D([], [], marker="o", label="largest stable timestep", **style),
            Line2D([], [], marker="o", markerfacecolor="white", label="largest accurate timestep (1 %)", **style),
            Line2D([], [], marker="x", label="stable, contact not settled", **style),
            Line2D([], [], color="black", label="linear theory of the scene"),
        ]
        axes.set_xticks(range(len(names)), names)
        axes.set(yscale="log", xlabel="integrator", ylabel="frequency of the swing × timestep, ωh", ylim=(1e-2, 12))
        name_below([axes], 4, handles)


folder = pathlib.Path(__file__).parent
for name, draw_maps in stiff_maps.figures(stiff_maps.load()).items():
    draw_maps(folder / name)
if sys.argv[1:]:
    draw(Study.load(pathlib.Path(sys.argv[1]), COMMAND).of(GROUP), folder / "stability-limits")
