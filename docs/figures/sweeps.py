"""Draws the three maps of `docs/sweeps.md`, by MuJoCo, with the borders that theory gives, beside this file.

`python docs/figures/sweeps.py` takes some minutes.
"""

import math
import pathlib
from collections.abc import Callable
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from scipy.optimize import bisect, brentq

import mjbeer
from mjbeer import Can, Scene, exact, frozen, sliding
from mjbeer.exceptions import NoEquilibriumError, NoLibrationError
from mjbeer.output.plots import COLOURS, chart, name_below

HERE = pathlib.Path(__file__).parent
SHADES = ["#D6E6F2", "#7FB3D9", "#F3D9A4", "#E8A583"]
LINE: dict[str, Any] = {"color": COLOURS[-1], "linewidth": 1.2}
STEEPEST, SAMPLES = math.radians(45), 1001


def draw_outcomes(friction: float = 0.5, duration: float = 2.0) -> None:
    """Draw what a frozen can does that is released with its surface along the incline."""
    inclines, fills = np.radians(np.linspace(0.5, 45, 90)), np.linspace(0.05, 0.95, 61)
    swept = mjbeer.sweep(frozen, duration, 0.0, tolerance=1e-6, incline=inclines, fill=fills)
    found = np.where(np.abs(swept["phi"].values) > math.pi, 1, 0)
    found[swept["friction_needed"].values > friction] = 2
    found[np.isfinite(swept["parting_time"].values)] = 3

    def rolls_down(scene: Scene) -> float:
        try:
            return scene.separatrix()[0]
        except NoEquilibriumError:
            return math.pi

    def slips(scene: Scene) -> float:
        forces = exact(scene, np.linspace(0, duration, SAMPLES), 0.0).forces
        return float((np.abs(forces.friction) - friction * forces.normal).max())

    def parts(scene: Scene) -> float:
        return float(-exact(scene, np.linspace(0, duration, SAMPLES), 0.0).forces.normal.min())

    part, slip, down = (
        np.array([border(each, fill) for fill in fills]) for each in (parts, slips, rolls_down)
    )
    near = math.radians(0.01)
    seen = (
        part < STEEPEST,
        slip < part - near,
        down <= part + near,
    )  # beyond parting, there is nothing to see
    names = [
        "rocks",
        "rolls down",
        f"slips (friction coefficient {friction:g})",
        "parts from the incline, however rough",
    ]
    subtitle = f"massless can of frozen beer, released at rest with φ = 0, {duration:g} s"
    with chart(HERE / "sweep-outcomes", 1, 1, 8, 6, "What a frozen can does", subtitle) as (axes,):
        colour(axes, np.degrees(inclines), fills, found, "incline [°]", "fill")
        for line, shown in zip((part, slip, down), seen, strict=True):
            axes.plot(np.degrees(np.where(shown, line, np.nan)), fills, **LINE)
        name_below(
            [axes], 3, [*patches(names), Line2D([], [], label="borders by exact theory", **LINE)]
        )


def border(excess: Callable[[Scene], float], fill: float) -> float:
    """Return the incline [rad] at which an excess of theory's becomes positive, to a tenth of the width of its line."""

    def of_incline(incline: float) -> float:
        try:
            return excess(frozen(incline, fill))
        except NoLibrationError:  # on the separatrix itself: a border as well
            return 0.0

    near = math.radians(0.01)
    return STEEPEST if of_incline(STEEPEST) < 0 else brentq(of_incline, near, STEEPEST, xtol=near)


def draw_periods() -> None:
    """Draw the period of a frozen can that is released at rest below its equilibrium."""
    inclines, amplitudes = np.radians(np.linspace(0, 24, 49)), np.radians(np.linspace(2, 178, 59))
    scenes = [frozen(float(incline)) for incline in inclines]
    largest = np.array([scene.separatrix()[1] - scene.equilibrium() for scene in scenes])
    swings = amplitudes < largest[:, np.newaxis]
    measured, theory = np.full((2, *swings.shape), np.nan)
    for row, scene in enumerate(scenes):
        of_scene = amplitudes[swings[row]]
        # Over 4 s, as beside the separatrix a swing takes twice as long as small ones.
        swept = mjbeer.sweep(
            frozen,
            4.0,
            scene.equilibrium() + of_scene,
            tolerance=1e-6,
            quantity="period",
            incline=scene.incline,
        )
        measured[row, swings[row]] = swept["period"]
        theory[row, swings[row]] = [scene.period(amplitude) for amplitude in of_scene]
    subtitle = "half-full massless can, beer frozen, released at rest below its equilibrium"
    with chart(HERE / "sweep-periods", 1, 1, 8, 5.5, "The period of a frozen can", subtitle) as (
        axes,
    ):
        tilts, swing = np.degrees(inclines), np.degrees(amplitudes)
        mesh = axes.pcolormesh(
            tilts, swing, measured.T, cmap="cividis", shading="nearest", rasterized=True
        )
        lines = axes.contour(
            tilts, swing, theory.T, (0.5, 0.55, 0.6, 0.7, 0.8, 1.0), colors="white", linewidths=1
        )
        axes.clabel(lines, fmt=lambda period: f"{period:g} s")
        axes.plot(tilts, np.degrees(largest), **LINE)
        axes.set(xlabel="incline [°]", ylabel="amplitude [°]", xlim=(0, tilts[-1]), ylim=(0, 180))
        axes.grid(visible=False)
        axes.figure.colorbar(mesh, ax=axes, label="period by MuJoCo [s]")
        theory_line = Line2D(
            [], [], label="by exact theory: the largest swing, and periods in white", **LINE
        )
        name_below([axes], 1, [theory_line])


def draw_damping(duration: float = 4.0) -> None:
    """Draw whose load is carried over the top that is let go with its surface level."""
    metal = Can.sheet_metal()
    dampings, inclines = np.geomspace(1e-4, 0.1, 37), np.radians(np.linspace(12, 32, 41))

    def can(incline: float, damping: float) -> Scene:
        return sliding(incline, can=metal, damping=damping)

    def beyond(incline: float, damping: float) -> float:
        motion = exact(can(incline, damping), np.linspace(0, duration, 401), -incline)
        return float(np.abs(motion.phi).max() > math.pi) - 0.5

    swept = [
        mjbeer.sweep(can, duration, -tilt, tolerance=1e-6, damping=dampings, incline=tilt)
        for tilt in inclines
    ]
    found = np.array(
        [np.abs(each["phi"].values) > math.pi for each in swept]
    ).T  # once over the top, for good
    shown = dampings[::2]  # exact motions of a stiff can take a second
    borders = [
        bisect(beyond, inclines[0], inclines[-1], (each,), xtol=math.radians(0.025))
        for each in shown
    ]
    subtitle = f"half-full can of sheet metal, let go with its surface level, {duration:g} s"
    with chart(HERE / "sweep-damping", 1, 1, 8, 5.5, "What a damped can does", subtitle) as (axes,):
        axes.set_xscale("log")
        colour(axes, dampings, np.degrees(inclines), found, "damping [N m s]", "incline [°]")
        axes.plot(shown, np.degrees(borders), **LINE)
        axes.axhline(math.degrees(frozen(can=metal).largest_incline()), linestyle="--", **LINE)
        lines = [
            Line2D([], [], label="border by exact theory", **LINE),
            Line2D([], [], label="steepest with steady rolling", linestyle="--", **LINE),
        ]
        name_below(
            [axes],
            2,
            [*patches(["the load stays below", "the load is carried over the top"]), *lines],
        )


def colour(
    axes: Axes, x: np.ndarray, y: np.ndarray, found: np.ndarray, across: str, up: str
) -> None:
    """Colour the cells of a map by what was found in them, shape (x, y)."""
    shades = ListedColormap(SHADES[: found.max() + 1])
    axes.pcolormesh(
        x, y, found.T, cmap=shades, vmin=0, vmax=shades.N - 1, shading="nearest", rasterized=True
    )
    axes.set(xlabel=across, ylabel=up, xlim=(x[0], x[-1]), ylim=(y[0], y[-1]))
    axes.grid(visible=False)


def patches(names: list[str]) -> list[Patch]:
    """Return what names the colours of a map."""
    return [Patch(facecolor=shade, label=name) for shade, name in zip(SHADES, names, strict=False)]


if __name__ == "__main__":
    draw_outcomes()
    draw_periods()
    draw_damping()
