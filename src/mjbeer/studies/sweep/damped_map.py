"""The map of damped cans in `docs/sweeps.md`: whose load is carried over the top, by MuJoCo and by theory."""

import math
import pathlib

import numpy as np
from matplotlib.colors import ListedColormap
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from mjbeer.output.plots import COLOURS, chart, name_below
from mjbeer.studies.sweep.run import sweep
from mjbeer.theory.can import Can
from mjbeer.theory.exact import exact
from mjbeer.theory.named import frozen, sliding
from mjbeer.theory.scene import Scene

DURATION = 4.0
"""Time after the release in which the load of a can may be carried over the top [s]."""
_METAL = Can.sheet_metal()
_SHADES = ("#D6E6F2", "#7FB3D9")
_OUTCOMES = ("the load stays below", "the load is carried over the top")
_DAMPINGS, _INCLINES = np.geomspace(1e-4, 0.1, 37), np.radians(np.linspace(12, 32, 41))
_BORDERS = _DAMPINGS[::2]
"""Those for which theory's border is found: exact motions of a stiff can take a second."""
_SAMPLES = 401
"""Samples of a motion by theory: a turn over the top takes longer than one of their intervals."""
_NEAR = math.radians(0.05)
"""How exactly a border is found [rad], half the width of its line."""


def can(incline: float, damping: float) -> Scene:
    """Return the half-full can of the map."""
    return sliding(incline, can=_METAL, damping=damping)


def turned(dampings: np.ndarray, inclines: np.ndarray) -> np.ndarray:
    """Return whose load MuJoCo carries over the top, shape (dampings, inclines).

    A can is let go with the surface of its load level. A load that has been over the top once is beyond pi for good.
    """
    each_damping, each_incline = (grid.ravel() for grid in np.meshgrid(dampings, inclines, indexing="ij"))
    swept = sweep(can, DURATION, -each_incline, paired=True, tolerance=1e-6, damping=each_damping, incline=each_incline)
    return (np.abs(swept["phi"]) > math.pi).reshape(len(dampings), len(inclines))


def border(damping: float) -> float:
    """Return the incline [rad] beyond which theory carries the load over the top."""
    low, high = float(_INCLINES[0]), float(_INCLINES[-1])
    while high - low > _NEAR:
        middle = (low + high) / 2
        motion = exact(can(middle, damping), np.linspace(0, DURATION, _SAMPLES), -middle)
        low, high = (low, middle) if np.abs(motion.phi).max() > math.pi else (middle, high)
    return (low + high) / 2


def draw(path: pathlib.Path) -> None:
    """Draw whose load is carried over the top, over damping and incline; as SVG and PNG."""
    found, borders = turned(_DAMPINGS, _INCLINES), [border(damping) for damping in _BORDERS]
    steepest = math.degrees(frozen(can=_METAL).largest_incline())
    subtitle = f"half-full can of sheet metal, let go with its surface level, {DURATION:g} s"
    with chart(path, width=8, height=5.5, title="What a damped can does", subtitle=subtitle) as (axes,):
        degrees = np.degrees(_INCLINES)
        axes.pcolormesh(
            _DAMPINGS,
            degrees,
            found.T,
            cmap=ListedColormap(_SHADES),
            vmin=0,
            vmax=1,
            shading="nearest",
            rasterized=True,
        )
        axes.plot(_BORDERS, np.degrees(borders), color=COLOURS[-1], linewidth=1.2)
        axes.axhline(steepest, color=COLOURS[-1], linewidth=1.2, linestyle="--")
        axes.set(xlabel="damping [N m s]", ylabel="incline [°]", xscale="log")
        axes.set(xlim=(_DAMPINGS[0], _DAMPINGS[-1]), ylim=(degrees[0], degrees[-1]))
        axes.grid(visible=False)
        patches = [Patch(facecolor=shade, label=name) for shade, name in zip(_SHADES, _OUTCOMES, strict=True)]
        lines = [
            Line2D([], [], color=COLOURS[-1], linewidth=1.2, label="border by exact theory"),
            Line2D([], [], color=COLOURS[-1], linewidth=1.2, linestyle="--", label="steepest with steady rolling"),
        ]
        name_below([axes], 2, [*patches, *lines])
