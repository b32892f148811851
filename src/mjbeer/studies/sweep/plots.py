"""A quantity of a sweep over one parameter, or as a map over two."""

import matplotlib as mpl
import numpy as np
from matplotlib import pyplot as plt
from matplotlib.axes import Axes

from mjbeer import require
from mjbeer.exceptions import ParameterError
from mjbeer.output.plots import STYLE
from mjbeer.studies.sweep.arrays import Sweep
from mjbeer.studies.sweep.quantities import NAMED, unit

_COLOURS = "cividis"
"""A colour map that colour-blind readers see as others do, and which is even in print."""
_LABELS = {"incline": "incline", "phi0": "φ at the start", "phi_dot0": "rate of φ at the start"}


def plot(sweep: Sweep, name: str) -> Axes:
    """Plot a quantity in a new figure, as `Sweep.plot` does."""
    require.choice("name", name, sweep.names)
    if sweep.plan.paired or len(sweep.shape) not in (1, 2):
        raise ParameterError(f"a plot needs a sweep over one or two parameters, got {sweep.over}")
    # A notebook makes matplotlib interactive with the first figure, which the context would undo at its end.
    figure = plt.figure(figsize=(7, 4.5), layout="constrained")
    with mpl.rc_context(STYLE):
        axes = figure.subplots()
        draw(sweep, name, axes)
        figure.suptitle(f"{sweep.about['make']}, {sweep.about['end [s]']:.6g} s", fontsize=STYLE["axes.titlesize"])
    return axes


def draw(sweep: Sweep, name: str, axes: Axes) -> None:
    """Draw a quantity into some axes, with its name and unit."""
    values = shown(name, np.where(np.isfinite(sweep[name]), sweep[name], np.nan))
    first = shown(sweep.dims[0], sweep[sweep.dims[0]])
    axes.set_xlabel(label(sweep.dims[0]))
    if len(sweep.dims) == 1:
        axes.plot(first, values, marker="." if len(first) < 100 else "")
        axes.set_ylabel(label(name))
        return
    second = shown(sweep.dims[1], sweep[sweep.dims[1]])
    mesh = axes.pcolormesh(first, second, values.T, cmap=_COLOURS, shading="nearest", rasterized=True)
    axes.set_ylabel(label(sweep.dims[1]))
    axes.figure.colorbar(mesh, ax=axes, label=label(name))
    axes.grid(visible=False)


def shown(name: str, values: np.ndarray) -> np.ndarray:
    """Return the values of a quantity or parameter as plots have them: angles and their rates in degrees."""
    return np.degrees(values) if unit(name) in ("rad", "rad/s") and name != "error" else values


def label(name: str) -> str:
    """Return the name of a quantity or parameter with its unit in plots."""
    known = NAMED[name].meaning if name in NAMED else _LABELS.get(name, name.replace("_", " "))
    in_degrees = unit(name) if name == "error" else unit(name).replace("rad", "°")
    return f"{known} [{in_degrees}]" if in_degrees else known
