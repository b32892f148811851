"""A scene in words, for titles and captions, and a run as a plot of its quantities over time."""

import math
from typing import TYPE_CHECKING

import numpy as np

from mjbeer import require
from mjbeer.theory.can import Damping
from mjbeer.theory.scene import Scene
from mjbeer.theory.trajectory import Trajectory, exact_motion

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_FILLS = {0.25: "quarter-full", 0.5: "half-full", 0.75: "three-quarters-full", 1.0: "full"}


def in_words(scene: Scene) -> str:
    """Return a scene in words, as "half-full massless can, beer frozen, incline 10°"."""
    if scene.load.inertia == 0:
        parts = _point_load_in_words(scene)
    elif scene.load.fill is None:
        parts = _load_in_words(scene)
    else:
        parts = _beer_in_words(scene, scene.load.fill)
    law = scene.damping_law
    if law == Damping(law.linear) and law:
        parts.append(f"damping {law.linear:.3g} N m s")
    elif law and not law.liquid:
        parts.append("damped")
    if scene.drag:
        parts.append(f"drag {scene.drag:.3g} kg/m")
    parts.append(f"incline {in_degrees(scene.incline)}" if scene.incline else "level ground")
    return ", ".join(parts)


def _beer_in_words(scene: Scene, fill: float) -> list[str]:
    full = _FILLS.get(fill, f"{100 * fill:.3g} % full")
    contents = scene.damping_law.liquid or f"beer {scene.attachment}"
    return [f"{full} {_can_in_words(scene)}", contents]


def _load_in_words(scene: Scene) -> list[str]:
    offset = f"its centre of mass {1e3 * scene.load.offset:.3g} mm from the axis"
    return [_can_in_words(scene), f"load {scene.attachment}", offset]


def _point_load_in_words(scene: Scene) -> list[str]:
    """Return the words for a load without size: a pendulum's bob, or a weight on a hoop."""
    body = (
        "wheel with a pendulum"
        if scene.attachment == "sliding"
        else "hoop with a weight on its rim"
    )
    return [body, f"M = {1e3 * scene.can.mass:.3g} g", f"m = {1e3 * scene.load.mass:.3g} g"]


def _can_in_words(scene: Scene) -> str:
    return "massless can" if scene.can.mass == 0 else f"can of {1e3 * scene.can.mass:.3g} g"


def in_degrees(angle: float) -> str:
    """Return an angle [rad] in degrees with their sign, to a tenth of a degree."""
    return f"{round(math.degrees(angle), 1):g}°".replace("-", "\N{MINUS SIGN}")


def damping_in_words(scene: Scene) -> str:
    """Return the torque between can and load divided by their slip rate w.

    It is as "0.001 N m s", or "0" if there is none.
    """
    units = ("N m s", "N m s^2 |w|", "N m s^3 w^2")
    coefficients = scene.damping_law.coefficients
    terms = [
        f"{coefficient:.4g} {unit}"
        for coefficient, unit in zip(coefficients, units, strict=True)
        if coefficient
    ]
    return " + ".join(terms) or "0"


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


def plot(trajectory: Trajectory, *names: str, theory: bool = False) -> "tuple[Axes, ...]":
    """Return the axes of a new figure that shows quantities over time [s].

    They stand one below the other, and are phi and u by default.

    With `theory`, the exact motion from the same start is drawn beneath as a wide grey line. A
    motion that rolls on where a can would leave the incline is dotted from there on.

    Raises:
      ParameterError: if there is no quantity of a name; the message lists the names.
    """
    import matplotlib as mpl
    from matplotlib import pyplot as plt

    from mjbeer.output.plots import STYLE

    names = names or ("phi", "u")
    for name in names:
        require.choice("quantity", name, _LABELS)
    require.choice("theory", theory, (True, False))
    beneath = _exact_motion(trajectory) if theory else None
    leaves_at = math.inf if trajectory.rolling == "contact" else trajectory.rolls_until()
    # A notebook makes matplotlib interactive with the first figure, which the context would undo at
    # its end.
    figure = plt.figure(figsize=(8, max(3.5, 2.5 * len(names))), layout="constrained")
    with mpl.rc_context(STYLE):
        panels = tuple(figure.subplots(len(names), 1, sharex=True, squeeze=False).flat)
        for axes, name in zip(panels, names, strict=True):
            _draw_quantity(axes, name, trajectory, beneath, leaves_at)
        panels[-1].set_xlabel("time [s]")
        if len(panels[0].get_lines()) > 1:
            panels[0].legend()
        figure.suptitle(in_words(trajectory.scene), fontsize=STYLE["axes.titlesize"])
    return panels


def _exact_motion(trajectory: Trajectory) -> Trajectory:
    """Return the exact motion from the start of another, at its times and at many more."""
    times = np.union1d(trajectory.time, np.linspace(0, trajectory.time[-1], 2000))
    return exact_motion(trajectory.scene, times, trajectory.phi0, trajectory.phi_dot0)


def _draw_quantity(
    axes: "Axes", name: str, trajectory: Trajectory, beneath: Trajectory | None, leaves_at: float
) -> None:
    """Draw a quantity of a motion, dotted from when the can leaves the incline, `leaves_at` [s]."""
    from mjbeer.output.plots import SIMULATED, THEORY, UNPHYSICAL

    if beneath is not None:
        axes.plot(beneath.time, _values(beneath, name), label="exact theory", **THEORY)
    time = trajectory.time
    values = _values(trajectory, name)
    rolls = time <= leaves_at
    pulled = time >= leaves_at
    source = "exact theory" if trajectory.rolling == "exact" else "MuJoCo"
    axes.plot(time[rolls], values[rolls], label=source, **SIMULATED)
    if pulled.any():
        label = "if the incline could pull the can"
        axes.plot(time[pulled], values[pulled], label=label, **UNPHYSICAL)
    axes.set_ylabel(_LABELS[name])


def _values(trajectory: Trajectory, name: str) -> np.ndarray:
    """Return a quantity of a trajectory at each sample, in the unit of its label."""
    values = getattr(trajectory, name)
    return np.degrees(values) if "°" in _LABELS[name] else values
