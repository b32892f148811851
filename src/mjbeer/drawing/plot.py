"""A plot of a trajectory: its quantities over time, over exact theory."""

import math
from typing import Any

import numpy as np

from mjbeer import require
from mjbeer.drawing.words import in_words
from mjbeer.theory.exact import exact_motion
from mjbeer.theory.trajectory import Trajectory

_SMOOTH = 2000  # number of samples of the line of exact theory in a plot
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


def plot(trajectory: Trajectory, *names: str, theory: bool = False) -> tuple[Any, ...]:
    """Return the axes of a new figure that shows quantities over time [s], one below the other: phi and u by default.

    With `theory`, the exact motion from the same start is drawn beneath as a wide grey line. A motion that rolls on
    where a can would leave the incline is dotted from there on.

    Raises:
      ParameterError: if there is no quantity of a name; the message lists the names.
    """
    import matplotlib as mpl
    from matplotlib import pyplot as plt

    from mjbeer.output.plots import SIMULATED, STYLE, THEORY, UNPHYSICAL

    names = names or ("phi", "u")
    for name in names:
        require.choice("quantity", name, _LABELS)
    require.boolean("theory", theory)
    scene, time = trajectory.scene, trajectory.time
    # A notebook makes matplotlib interactive with the first figure, which the context would undo at its end.
    figure = plt.figure(figsize=(8, max(3.5, 2.5 * len(names))), layout="constrained")
    with mpl.rc_context(STYLE):
        panels = tuple(figure.subplots(len(names), 1, sharex=True, squeeze=False).flat)
        if theory:
            dense = np.union1d(time, np.linspace(0, time[-1], _SMOOTH))
            truth = exact_motion(scene, dense, trajectory.phi0, trajectory.phi_dot0)
            for axes, name in zip(panels, names, strict=True):
                axes.plot(dense, _values(truth, name), label="exact theory", **THEORY)
        source = "exact theory" if trajectory.rolling == "exact" else "MuJoCo"
        parts = math.inf if trajectory.rolling == "contact" else trajectory.rolls_until()
        rolls, pulled = time <= parts, time >= parts
        for axes, name in zip(panels, names, strict=True):
            values = _values(trajectory, name)
            axes.plot(time[rolls], values[rolls], label=source, **SIMULATED)
            if pulled.any():
                axes.plot(time[pulled], values[pulled], label="if the incline could pull the can", **UNPHYSICAL)
            axes.set_ylabel(_LABELS[name])
        panels[-1].set_xlabel("time [s]")
        if len(panels[0].get_lines()) > 1:
            panels[0].legend()
        figure.suptitle(in_words(scene), fontsize=STYLE["axes.titlesize"])
    return panels


def _values(trajectory: Trajectory, name: str) -> np.ndarray:
    """Return a quantity of a trajectory at each sample, in the unit of its label."""
    values = getattr(trajectory, name)
    return np.degrees(values) if "°" in _LABELS[name] else values
