"""A scene in words, for titles and captions, and a run as a plot of its quantities over time."""

import math
from typing import Any

import numpy as np

from mjbeer import require
from mjbeer.theory.can import Damping
from mjbeer.theory.scene import Scene
from mjbeer.theory.trajectory import Trajectory, exact_motion

_FILLS = {0.25: "quarter-full", 0.5: "half-full", 0.75: "three-quarters-full", 1.0: "full"}


def in_words(scene: Scene) -> str:
    """Return a scene in words, as "half-full massless can, beer frozen, incline 10°"."""
    can, load = scene.can, scene.load
    if load.inertia > 0:
        full = "" if load.fill is None else _FILLS.get(load.fill, f"{100 * load.fill:.3g} % full")
        parts = [f"{full} {'massless can' if can.mass == 0 else f'can of {1e3 * can.mass:.3g} g'}".strip()]
        parts.append(f"{'load' if load.fill is None else 'beer'} {scene.attachment}")
        parts.append(f"its centre of mass {1e3 * load.offset:.3g} mm from the axis" if load.fill is None else "")
    else:  # a load without size: a pendulum's bob or a weight on a hoop
        body = "wheel with a pendulum" if scene.attachment == "sliding" else "hoop with a weight on its rim"
        parts = [body, f"M = {1e3 * can.mass:.3g} g, m = {1e3 * load.mass:.3g} g"]
    law = scene.damping_law
    parts.append("" if not law else f"damping {law.linear:.3g} N m s" if law == Damping(law.linear) else "damped")
    parts.append(f"drag {scene.drag:.3g} kg/m" if scene.drag else "")
    parts.append(f"incline {in_degrees(scene.incline)}" if scene.incline else "level ground")
    return ", ".join(part for part in parts if part)


def in_degrees(angle: float) -> str:
    """Return an angle [rad] in degrees with their sign, to a tenth of a degree."""
    return f"{round(math.degrees(angle), 1):g}°".replace("-", "\N{MINUS SIGN}")


def damping_in_words(scene: Scene) -> str:
    """Return the torque between can and load over their slip rate w, as "0.001 N m s"; "0" if there is none."""
    shares = zip(scene.damping_law.coefficients, ("N m s", "N m s^2 |w|", "N m s^3 w^2"), strict=True)
    return " + ".join(f"{share:.4g} {unit}" for share, unit in shares if share) or "0"


_LABELS = {  # of the quantities that a plot can show, by their names in a trajectory
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
    require.choice("theory", theory, (True, False))
    scene, time = trajectory.scene, trajectory.time
    # A notebook makes matplotlib interactive with the first figure, which the context would undo at its end.
    figure = plt.figure(figsize=(8, max(3.5, 2.5 * len(names))), layout="constrained")
    with mpl.rc_context(STYLE):
        panels = tuple(figure.subplots(len(names), 1, sharex=True, squeeze=False).flat)
        if theory:
            dense = np.union1d(time, np.linspace(0, time[-1], 2000))
            truth = exact_motion(scene, dense, trajectory.phi0, trajectory.phi_dot0)
        source = "exact theory" if trajectory.rolling == "exact" else "MuJoCo"
        parts = math.inf if trajectory.rolling == "contact" else trajectory.rolls_until()
        rolls, pulled = time <= parts, time >= parts
        for axes, name in zip(panels, names, strict=True):
            values = _values(trajectory, name)
            if theory:
                axes.plot(dense, _values(truth, name), label="exact theory", **THEORY)
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
