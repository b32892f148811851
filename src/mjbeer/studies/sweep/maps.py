"""Two of the maps of `docs/sweeps.md`, by MuJoCo, with the borders that theory gives.

`python -m mjbeer.studies.sweep.maps docs/figures` draws them, and that of `damped_map`.
"""

import math
import pathlib
import sys
from collections.abc import Callable

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from scipy.optimize import brentq

from mjbeer.exceptions import NoEquilibriumError, NoLibrationError
from mjbeer.output.plots import COLOURS, chart, name_below
from mjbeer.studies.sweep import damped_map
from mjbeer.studies.sweep.arrays import Sweep
from mjbeer.studies.sweep.run import sweep
from mjbeer.theory.exact import exact
from mjbeer.theory.named import frozen
from mjbeer.theory.scene import Scene

DURATION = 2.0
"""Time after the release in which a can of the map of outcomes may slip, part or roll down [s]."""
FRICTION = 0.5
"""Coefficient of friction of that map."""
ROCKS, ROLLS_DOWN, SLIPS, PARTS = range(4)
OUTCOMES = (
    "rocks",
    "rolls down",
    f"slips (friction coefficient {FRICTION:g})",
    "parts from the incline, however rough",
)
"""What a frozen can does that is released with its surface along the incline, phi = 0."""
_SHADES = ("#D6E6F2", "#7FB3D9", "#F3D9A4", "#E8A583")
_SAMPLES = 1001
"""Samples of a motion by theory in which it is looked for slip and parting."""
_NEAR = math.radians(0.01)
"""How exactly a border is found [rad], a tenth of the width of its line."""
_STEEPEST = math.radians(45)
_INCLINES, _FILLS = np.radians(np.linspace(0.5, 45, 90)), np.linspace(0.05, 0.95, 61)
_TILTS, _AMPLITUDES = np.radians(np.linspace(0, 24, 49)), np.radians(np.linspace(2, 178, 59))
_SWINGS = 4.0
"""Duration of the swings whose period is measured [s]: beside the separatrix they take twice as long as small ones."""
_PERIODS = (0.5, 0.55, 0.6, 0.7, 0.8, 1.0)
"""Periods whose lines theory draws [s]."""


def outcomes(inclines: np.ndarray, fills: np.ndarray) -> np.ndarray:
    """Return what frozen cans do by MuJoCo, as indices of `OUTCOMES`, shape (inclines, fills).

    What needs more force than there is counts as slip or as parting, whichever holds on the rougher incline.
    """
    swept = sweep(frozen, DURATION, 0.0, tolerance=1e-6, incline=inclines, fill=fills)
    found = np.where(np.abs(swept["phi"]) > math.pi, ROLLS_DOWN, ROCKS)
    found[swept["friction_needed"] > FRICTION] = SLIPS
    found[np.isfinite(swept["parting_time"])] = PARTS
    return found


def rolls_down(scene: Scene) -> float:
    """Return by how much a can that is released at phi = 0 is beyond the separatrix [rad]; below 0 it rocks."""
    try:
        lower, _ = scene.separatrix()
    except NoEquilibriumError:
        return math.pi
    return lower


def slips(scene: Scene) -> float:
    """Return the most by which |F| exceeds friction times N [N]; below 0 the can never slips."""
    forces = exact(scene, np.linspace(0, DURATION, _SAMPLES), 0.0).forces
    return float((np.abs(forces.friction) - FRICTION * forces.normal).max())


def parts(scene: Scene) -> float:
    """Return the most by which N is below 0 [N]; below 0 the can never parts."""
    return float(-exact(scene, np.linspace(0, DURATION, _SAMPLES), 0.0).forces.normal.min())


def border(excess: Callable[[Scene], float], fill: float) -> float:
    """Return the incline [rad] at which an excess of theory's becomes positive; the steepest one if it never does."""

    def of_incline(incline: float) -> float:
        try:
            return excess(frozen(incline, fill))
        except NoLibrationError:  # on the separatrix itself: a border as well
            return 0.0

    if of_incline(_STEEPEST) < 0:
        return _STEEPEST
    return float(brentq(of_incline, _NEAR, _STEEPEST, xtol=_NEAR))


def draw_outcomes(path: pathlib.Path) -> None:
    """Draw where a frozen can rocks, rolls down, slips or parts; as SVG and PNG."""
    found = outcomes(_INCLINES, _FILLS)
    part, slip, down = (np.array([border(each, fill) for fill in _FILLS]) for each in (parts, slips, rolls_down))
    subtitle = f"massless can of frozen beer, released at rest with φ = 0, {DURATION:g} s"
    with chart(path, width=8, height=6, title="What a frozen can does", subtitle=subtitle) as (axes,):
        degrees = np.degrees(_INCLINES)
        axes.pcolormesh(
            degrees, _FILLS, found.T, cmap=ListedColormap(_SHADES), vmin=0, vmax=3, shading="nearest", rasterized=True
        )
        seen = part < _STEEPEST, slip < part - _NEAR, down <= part + _NEAR  # beyond parting, there is nothing to see
        for line, shown in zip((part, slip, down), seen, strict=True):
            axes.plot(np.degrees(np.where(shown, line, np.nan)), _FILLS, color=COLOURS[-1], linewidth=1.2)
        axes.set(xlabel="incline [°]", ylabel="fill", xlim=(degrees[0], degrees[-1]), ylim=(_FILLS[0], _FILLS[-1]))
        axes.grid(visible=False)
        patches = [Patch(facecolor=shade, label=name) for shade, name in zip(_SHADES, OUTCOMES, strict=True)]
        name_below([axes], 3, [*patches, _by_theory("borders by exact theory")])


def periods(inclines: np.ndarray, amplitudes: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the period [s] of half-full frozen cans by MuJoCo and by theory, shape (inclines, amplitudes).

    A swing starts at rest an amplitude [rad] below the equilibrium. Both are NaN beyond the separatrix.
    """
    places = [(row, column) for row in range(len(inclines)) for column in range(len(amplitudes))]
    theory = np.full((len(inclines), len(amplitudes)), np.nan)
    starts = np.empty(len(places))
    for number, (row, column) in enumerate(places):
        scene = frozen(inclines[row])
        starts[number] = scene.equilibrium() + amplitudes[column]
        try:
            theory[row, column] = scene.period(amplitudes[column])
        except NoLibrationError:
            continue
    swings = np.flatnonzero(np.isfinite(theory.ravel()))
    swept: Sweep = sweep(
        frozen,
        _SWINGS,
        starts[swings],
        paired=True,
        tolerance=1e-6,
        quantity="period",
        incline=np.repeat(inclines, len(amplitudes))[swings],
    )
    measured = np.full(theory.size, np.nan)
    measured[swings] = swept["period"]
    return measured.reshape(theory.shape), theory


def draw_periods(path: pathlib.Path) -> None:
    """Draw the period of a frozen can over incline and amplitude; as SVG and PNG."""
    measured, theory = periods(_TILTS, _AMPLITUDES)
    subtitle = "half-full massless can, beer frozen, released at rest below its equilibrium"
    with chart(path, width=8, height=5.5, title="The period of a frozen can", subtitle=subtitle) as (axes,):
        tilts, amplitudes = np.degrees(_TILTS), np.degrees(_AMPLITUDES)
        mesh = axes.pcolormesh(tilts, amplitudes, measured.T, cmap="cividis", shading="nearest", rasterized=True)
        lines = axes.contour(tilts, amplitudes, theory.T, _PERIODS, colors="white", linewidths=1)
        axes.clabel(lines, fmt=lambda period: f"{period:g} s")
        _edge(axes)
        axes.set(xlabel="incline [°]", ylabel="amplitude [°]", xlim=(0, tilts[-1]), ylim=(0, 180))
        axes.grid(visible=False)
        axes.figure.colorbar(mesh, ax=axes, label="period by MuJoCo [s]")
        name_below([axes], 1, [_by_theory("by exact theory: the largest swing, and periods in white")])


def _edge(axes: Axes) -> None:
    """Draw the largest amplitude of a swing at each incline, by theory."""
    scenes = [frozen(float(incline)) for incline in _TILTS]
    largest = [scene.separatrix()[1] - scene.equilibrium() for scene in scenes]
    axes.plot(np.degrees(_TILTS), np.degrees(largest), color=COLOURS[-1], linewidth=1.2)


def _by_theory(label: str) -> Line2D:
    return Line2D([], [], color=COLOURS[-1], linewidth=1.2, label=label)


if __name__ == "__main__":
    folder = pathlib.Path(sys.argv[1])
    draw_outcomes(folder / "sweep-outcomes")
    draw_periods(folder / "sweep-periods")
    damped_map.draw(folder / "sweep-damping")
