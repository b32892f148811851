"""What the stability study writes: its runs as CSV, its plots, and a summary with the tables."""

import pathlib
from typing import Any

import numpy as np

from mjbeer import output, stability_limits, stability_maps, stability_plots, stability_tables
from mjbeer.charts import COLOURS, chart
from mjbeer.grid import Grid
from mjbeer.linear_stability import RUNGE_KUTTA
from mjbeer.stability import Stability

_READ = """
A run is **stable and accurate** if phi and u/a stay within 0.01 rad of exact theory (relative beyond 1 rad), **stable,
inaccurate** if they do not and the run says so, **unstable, detected** if it blows up, and is raised or flagged,
**refused** if it ends in an error that says why, and **wrong and silent** if it is trusted and off by more: there must
be none of those.
"""
_FLOOR = 1e-16
_SEMI_IMPLICIT = "semi-implicit"
_COLOURS = dict(zip((_SEMI_IMPLICIT, *RUNGE_KUTTA), COLOURS, strict=False))
_ENDURANCE = (
    "stability-endurance: energy drifts with the number of swings by laws that theory gives. It stays in bounds where "
    "semi-implicit Euler is symplectic; where each step loses a share, were it by rounded coefficients, it falls in "
    "proportion."
)


def write(found: Stability, folder: pathlib.Path) -> None:
    """Write runs.csv, the plots, and last summary.md.

    Raises:
      OutputError: if a file cannot be written.
    """
    output.write(folder / "runs.csv", stability_tables.runs(found))
    endurance(found, folder / "stability-endurance")
    pictures = [*stability_plots.draw(found.of("limits"), found.of("maps"), folder), _ENDURANCE]
    lines = ["# mjbeer: stability", "", f"{_words(found)}", _READ]
    lines += [stability_tables.verdicts(found).markdown()]
    for name, caption in (each.split(": ", 1) for each in pictures):
        lines += [f"![{name}]({name}.svg)", "", f"{caption[0].upper()}{caption[1:]}", ""]
    lines += [grid.markdown() for grid in tables(found)[1:]]
    lines += [stability_tables.catalogue(found).markdown(), stability_tables.reasons(found).markdown()]
    output.write(folder / "summary.md", "\n".join(lines))


def tables(found: Stability) -> list[Grid]:
    """For the terminal; the catalogue's own, with a line a case, are in the summary."""
    return [
        stability_tables.verdicts(found),
        stability_tables.laws(found),
        stability_limits.grid(found.of("limits")),
        stability_maps.grid(found.of("maps")),
        stability_tables.search(found),
        stability_tables.endurance(found),
    ]


def _words(found: Stability) -> str:
    count = len(found.unexpected)
    return "All came out as theory expects." if not count else f"**{count} did not come out as theory expects.**"


def endurance(found: Stability, path: pathlib.Path) -> None:
    """Draw how energy drifts: `path` with .svg and with .png.

    Raises:
      OutputError: if a file cannot be written.
    """
    lines: dict[tuple[str, int, str], list[dict[str, Any]]] = {}
    for each in found.of("endurance"):
        kin = each["integrator"] if each["integrator"] in RUNGE_KUTTA else _SEMI_IMPLICIT
        lines.setdefault((kin, each["steps"], each["name"]), []).append(each)
    styles = {kin: iter(("-", "--", ":")) for kin in _COLOURS}
    with chart(path, width=9, height=6.5) as (axes,):
        for (kin, steps, name), runs in lines.items():
            shown = max(runs, key=lambda each: each["swings"])  # the others of its kin lie under it
            law = " or ".join({each["law"] or "no law": None for each in runs})
            size = np.maximum(np.abs(shown["width" if shown["law"] == "bounded" else "drift"]), _FLOOR)
            style = next(styles[kin])
            label = f"{', '.join(each['integrator'] for each in runs)}: {steps} steps a swing, {name} ({law})"
            axes.plot(shown["counts"], size, style, color=_COLOURS[kin], label=label)
        axes.set_xscale("log")
        axes.set_yscale("log")
        axes.set_ylim(_FLOOR, 2)
        axes.set_xlabel("number of swings of 1 rad")
        axes.set_ylabel("energy of the swing gained or lost, as a share of it")
        axes.set_title("How much energy a swing gains or loses by being simulated")
        axes.figure.legend(loc="outside lower center", fontsize=8)
