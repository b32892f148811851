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
_EVEN = 1e-6
"""Largest relative difference of steps that count as even: values may come from a text."""
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
    axes.set_xscale("log" if _in_steps_of_a_factor(first) else "linear")
    if len(sweep.dims) == 1:
        axes.plot(first, values, marker="." if len(first) < 100 else "")
        axes.set_ylabel(label(name))
        return
    second = shown(sweep.dims[1], sweep[sweep.dims[1]])
    mesh = axes.pcolormesh(_edges(first), _edges(second), values.T, cmap=_COLOURS, rasterized=True)
    axes.set_ylabel(label(sweep.dims[1]))
    axes.set_yscale("log" if _in_steps_of_a_factor(second) else "linear")
    axes.figure.colorbar(mesh, ax=axes, label=label(name))
    axes.grid(visible=False)


def _in_steps_of_a_factor(values: np.ndarray) -> bool:
    """Return whether each value is the one before times the same factor, over a decade or more."""
    if len(values) < 3 or not (values > 0).all():
        return False
    steps = np.diff(np.log10(values))
    return bool(abs(steps.sum()) >= 1 and np.ptp(steps) < _EVEN * abs(steps[0]))


def _edges(values: np.ndarray) -> np.ndarray:
    """Return the borders of a map's cells around some values: half-way between them, also on a logarithmic axis."""
    if geometric := _in_steps_of_a_factor(values):
        values = np.log(values)
    half = np.diff(values) / 2 if len(values) > 1 else np.array([0.5])
    edges = np.concatenate([values[:1] - half[:1], values[:-1] + half[: len(values) - 1], values[-1:] + half[-1:]])
    return np.exp(edges) if geometric else edges


def shown(name: str, values: np.ndarray) -> np.ndarray:
    """Return the values of a quantity or parameter as plots have them: angles and their rates in degrees."""
    return np.degrees(values) if unit(name) in ("rad", "rad/s") and name != "error" else values


def label(name: str) -> str:
    """Return the name of a quantity or parameter with its unit in plots."""
    known = NAMED[name].meaning if name in NAMED else _LABELS.get(name, name.replace("_", " "))
    in_degrees = unit(name) if name == "error" else unit(name).replace("rad", "°")
    return f"{known} [{in_degrees}]" if in_degrees else known
