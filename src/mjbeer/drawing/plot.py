"""A motion as a plot: its quantities over time, one below the other."""

import math
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib import pyplot as plt
from matplotlib.axes import Axes

from mjbeer import require
from mjbeer.drawing.words import in_words
from mjbeer.output.plots import SIMULATED, STYLE, THEORY, UNPHYSICAL, note
from mjbeer.theory.trajectory import Trajectory, exact_motion

_LABELS = {
    "phi": "φ [°]",
    "u": "u [m]",
    "phi_dot": "dφ/dt [°/s]",
    "u_dot": "du/dt [m/s]",
    "roll": "roll [°]",
    "distance": "distance [m]",
    "lift": "lift [m]",
    "slip": "slip [m]",
    "energy": "energy [J]",
}
"""Labels of the quantities that a plot can show, by their names in a trajectory."""
_CONSTANT = 1e-4
"""A quantity that changes by less than this share of itself is drawn as constant."""


def plot(trajectory: Trajectory, *names: str, theory: bool = False) -> tuple[Axes, ...]:
    """Plot quantities of a motion over time [s] in a new figure, and return the axes of each.

    Without names they are phi and u. With `theory`, the exact motion from the same start is drawn
    beneath as a wide grey line. From where the incline would have to pull the can for it to keep
    rolling, the motion is dotted.

    Raises:
      ParameterError: if there is no quantity of a name; the message lists the names.
    """
    names = names or ("phi", "u")
    for name in names:
        require.choice("quantity", name, _LABELS)
    require.choice("theory", theory, (True, False))
    beneath = _exact_motion(trajectory) if theory else None
    # A can in contact leaves the incline by itself.
    leaves_at = math.inf if trajectory.rolling == "contact" else trajectory.rolls_until()
    # The figure is made outside the context: in a notebook, matplotlib becomes interactive with the
    # first figure, and the context would undo that at its end.
    figure = plt.figure(figsize=(8, max(3.5, 2.5 * len(names))), layout="constrained")
    with mpl.rc_context(STYLE):
        panels = tuple(figure.subplots(len(names), 1, sharex=True, squeeze=False).flat)
        for axes, name in zip(panels, names, strict=True):
            if beneath is not None:
                axes.plot(beneath.time, _values(beneath, name), label="exact theory", **THEORY)
            _draw_motion(axes, trajectory, name, leaves_at)
            axes.set_ylabel(_LABELS[name])
            _show_constancy(axes)
        panels[-1].set_xlabel("time [s]")
        if len(panels[0].get_lines()) > 1:
            # Above the panel, where no curve is.
            above: dict[str, Any] = {"loc": "lower right", "bbox_to_anchor": (1, 1)}
            panels[0].legend(ncols=3, borderaxespad=0.2, **above)
        heading = STYLE["axes.titlesize"]
        figure.suptitle(in_words(trajectory.scene), fontsize=heading, x=0.02, ha="left")
    return panels


def _exact_motion(trajectory: Trajectory) -> Trajectory:
    """Return the exact motion from the start of another, at its times and at 2000 more."""
    times = np.union1d(trajectory.time, np.linspace(0, trajectory.time[-1], 2000))
    return exact_motion(trajectory.scene, times, trajectory.phi0, trajectory.phi_dot0)


def _draw_motion(axes: Axes, trajectory: Trajectory, name: str, leaves_at: float) -> None:
    """Draw a quantity of a motion, dotted from when the can leaves the incline, `leaves_at` [s]."""
    time = trajectory.time
    values = _values(trajectory, name)
    rolls = time <= leaves_at
    pulled = time >= leaves_at
    source = "exact theory" if trajectory.rolling == "exact" else "MuJoCo"
    axes.plot(time[rolls], values[rolls], label=source, **SIMULATED)
    if pulled.any():
        label = "if the incline could pull the can"
        axes.plot(time[pulled], values[pulled], label=label, **UNPHYSICAL)


def _show_constancy(axes: Axes) -> None:
    """Let what is constant but for an error look constant, and say how far it changes."""
    values = np.concatenate([np.asarray(line.get_ydata()) for line in axes.get_lines()])
    change = np.ptp(values)
    largest = np.abs(values).max()
    if not 0 < change < _CONSTANT * largest:
        return
    middle = (values.min() + values.max()) / 2
    axes.set_ylim(middle - largest / 10, middle + largest / 10)
    unit = axes.get_ylabel().partition("[")[2].rstrip("]")
    text = f"constant within {change:.0e} {unit}"
    note(axes, text, (axes.get_xlim()[0], middle), (6, 12))


def _values(trajectory: Trajectory, name: str) -> np.ndarray:
    """Return a quantity of a trajectory at each sample, in the unit of its label."""
    values = getattr(trajectory, name)
    return np.degrees(values) if "°" in _LABELS[name] else values
