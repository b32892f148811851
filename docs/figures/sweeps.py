"""Draws the three maps of `docs/sweeps.md`, by MuJoCo, with the borders that theory gives.

They are written beside this file.
`python docs/figures/sweeps.py` takes some minutes.
"""

import math
import pathlib
from collections.abc import Callable
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from scipy.optimize import bisect, brentq

import mjbeer
from mjbeer import Can, Scene, exact, frozen, sliding
from mjbeer.exceptions import NoEquilibriumError, NoLibrationError
from mjbeer.output.plots import COLOURS, chart

HERE = pathlib.Path(__file__).parent
SHADES = ["#D6E6F2", "#7FB3D9", "#F3D9A4", "#E8A583"]
LINE: dict[str, Any] = {"color": COLOURS[-1], "linewidth": 1.2}
STEEPEST = math.radians(45)
"""The steepest incline [rad] of the map of outcomes."""
SAMPLES = 1001
"""Samples of a motion in which theory looks for slip and parting."""


def draw_outcomes(friction: float = 0.5, duration: float = 2.0) -> None:
    """Draw what a frozen can does that is released with its surface along the incline."""
    inclines = np.radians(np.linspace(0.5, 45, 90))
    fills = np.linspace(0.05, 0.95, 61)
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

    part = np.array([border(parts, fill) for fill in fills])
    slip = np.array([border(slips, fill) for fill in fills])
    down = np.array([border(rolls_down, fill) for fill in fills])
    near = math.radians(0.01)
    # Beyond parting, there is nothing to see.
    seen = (part < STEEPEST, slip < part - near, (down <= part + near) & (down < STEEPEST))
    gentle = float(np.interp(0.5, fills, np.degrees(np.minimum(down, slip))))
    title = f"Half full, frozen beer rocks below {gentle:.0f}° and lifts off above"
    subtitle = (
        f"massless can of frozen beer, released at rest with φ = 0, for {duration:g} s; "
        "lines are exact theory"
    )
    with chart(HERE / "sweep-outcomes", 1, 1, 8, 5.6, title, subtitle) as (axes,):
        fill = "fill, depth of the beer / diameter"
        colour(axes, np.degrees(inclines), fills, found, "incline [°]", fill)
        for line, shown in zip((part, slip, down), seen, strict=True):
            axes.plot(np.degrees(np.where(shown, line, np.nan)), fills, **LINE)
        name(axes, "rocks", (9, 0.35))
        name(axes, "rolls down", (5, 0.9))
        name(axes, f"slips, with a friction coefficient of {friction:g}", (33, 0.13))
        # The slipping wedge beside the part where cans roll down is narrow.
        point = {"arrowstyle": "-", "linewidth": 0.8}
        axes.annotate("slips", (14, 0.925), (20, 0.88), va="center", arrowprops=point)
        name(axes, "lifts off the incline,\nhowever rough it is", (31, 0.65))


def border(excess: Callable[[Scene], float], fill: float) -> float:
    """Return the incline [rad] at which an excess of theory's becomes positive.

    It is found to a tenth of the width of its line.
    """

    def of_incline(incline: float) -> float:
        try:
            return excess(frozen(incline, fill))
        except NoLibrationError:  # on the separatrix itself: a border as well
            return 0.0

    near = math.radians(0.01)
    return STEEPEST if of_incline(STEEPEST) < 0 else brentq(of_incline, near, STEEPEST, xtol=near)


def draw_periods() -> None:
    """Draw the period of a frozen can that is released at rest below its equilibrium."""
    inclines = np.radians(np.linspace(0, 24, 49))
    amplitudes = np.radians(np.linspace(2, 178, 59))
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
    title = f"A frozen can swings in {np.nanmin(theory):.2f} s, more slowly if wide or steep"
    subtitle = (
        "half-full massless can, beer frozen, released at rest below its equilibrium; "
        "lines are exact theory"
    )
    with chart(HERE / "sweep-periods", 1, 1, 8, 5.3, title, subtitle) as (axes,):
        tilts = np.degrees(inclines)
        swing = np.degrees(amplitudes)
        mesh = axes.pcolormesh(
            tilts, swing, measured.T, cmap="cividis", shading="nearest", rasterized=True
        )
        periods = (0.5, 0.55, 0.6, 0.7, 0.8, 1.0)
        lines = axes.contour(tilts, swing, theory.T, periods, colors="white", linewidths=1)
        axes.clabel(lines, fmt=lambda period: f"{period:g} s")
        # The shortest swings are the small ones on level ground, in the corner of the map.
        axes.text(0.3, 4, f"{np.nanmin(theory):.2f} s", color="white", fontsize=10)
        axes.plot(tilts, np.degrees(largest), **LINE)
        axes.set(
            xlabel="incline [°]",
            ylabel="amplitude of the swing [°]",
            xlim=(0, tilts[-1]),
            ylim=(0, 180),
        )
        axes.grid(visible=False)
        # The layout of `chart` fails on a gridspec for the bar, which has rows without height.
        axes.figure.colorbar(mesh, ax=axes, label="period by MuJoCo [s]", use_gridspec=False)
        name(axes, "wider, it rolls down:\nthere is no swing", (15, 150))


def draw_damping(duration: float = 4.0) -> None:
    """Draw which cans, let go with their surface level, carry their load over the top."""
    metal = Can.sheet_metal()
    dampings = np.geomspace(1e-4, 0.1, 37)
    inclines = np.radians(np.linspace(12, 32, 41))

    def can(incline: float, damping: float) -> Scene:
        return sliding(incline, can=metal, damping=damping)

    def beyond(incline: float, damping: float) -> float:
        motion = exact(can(incline, damping), np.linspace(0, duration, 401), -incline)
        return float(np.abs(motion.phi).max() > math.pi) - 0.5

    swept = [
        mjbeer.sweep(can, duration, -tilt, tolerance=1e-6, damping=dampings, incline=tilt)
        for tilt in inclines
    ]
    # A load that has once been over the top stays beyond it.
    found = np.array([np.abs(runs["phi"].values) > math.pi for runs in swept]).T
    shown = dampings[::2]  # exact motions of a stiff can take a second
    ends = (inclines[0], inclines[-1])
    near = math.radians(0.025)
    borders = [bisect(beyond, *ends, (damping,), xtol=near) for damping in shown]
    steady = math.degrees(frozen(can=metal).largest_incline())
    title = (
        f"On {math.degrees(min(borders)):.0f}° to {math.degrees(max(borders)):.0f}° damping "
        "decides whether beer goes over the top"
    )
    subtitle = (
        f"half-full can of sheet metal, let go with its surface level, for {duration:g} s; "
        "lines are exact theory"
    )
    with chart(HERE / "sweep-damping", 1, 1, 8, 5.2, title, subtitle) as (axes,):
        axes.set_xscale("log")
        colour(axes, dampings, np.degrees(inclines), found, "damping [N m s]", "incline [°]")
        axes.plot(shown, np.degrees(borders), **LINE)
        axes.axhline(steady, linestyle="--", **LINE)
        axes.set_yticks(range(12, 33, 4))
        name(axes, "The load is carried over the top.", (6e-3, 28))
        name(axes, "The load stays below.", (6e-4, 17.5))
        steepest = f"steepest incline with steady rolling: {steady:.1f}°"
        name(axes, steepest, (1.3e-2, steady + 0.7), fontsize=9.5)


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


def name(axes: Axes, text: str, place: tuple[float, float], **style: float) -> None:
    """Write what a region or a line is, with its middle at a place in the data."""
    axes.text(*place, text, ha="center", va="center", **style)


if __name__ == "__main__":
    draw_outcomes()
    draw_periods()
    draw_damping()
