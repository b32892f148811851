"""What a user sees of a trajectory or a scene besides numbers: a plot, a video, a notebook's cell.

Trajectories and scenes belong to the theory, which knows no pictures. Their methods load this module when they are
called, as `mjbeer` registers it with them.
"""

import html
import math
import os
from typing import TYPE_CHECKING, Any

import numpy as np

from mjbeer import require
from mjbeer.drawing.words import damping_in_words, in_words
from mjbeer.theory.exact import exact_motion
from mjbeer.theory.scene import Scene
from mjbeer.theory.trajectory import Trajectory

if TYPE_CHECKING:
    from matplotlib.axes import Axes


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


def plot(trajectory: Trajectory, *names: str, theory: bool = False) -> "tuple[Axes, ...]":
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


def video(
    trajectory: Trajectory,
    path: str | os.PathLike[str] | None,
    width: int,
    height: int,
    progress: bool = True,
    **others: Any,
) -> None:
    """Write a video of a trajectory to `path`, as `mjbeer.render` does, or show it in a notebook if there is none."""
    from mjbeer.drawing.video import render, show

    if path is None:
        show(trajectory, width, height, **others)
    else:
        render(trajectory, path, width, height, progress=progress, **others)


def trajectory_html(trajectory: Trajectory) -> str:
    """Return the key figures of a trajectory, and what it says about itself, as an HTML table."""
    time, radius, record = trajectory.time, trajectory.scene.can.radius, trajectory.record
    rows = {
        "scene": in_words(trajectory.scene),
        "rolling, integrator": f"{trajectory.rolling}, {trajectory.integrator}",
        "samples": f"{len(time)}, from {time[0]:.6g} s to {time[-1]:.6g} s",
        "φ at the last sample": f"{math.degrees(trajectory.phi[-1]):.6g} degrees",
        "u at the last sample": f"{trajectory.u[-1]:.6g} m",
        "largest slip and lift": f"{record.slip / radius:.2g} and {record.lift / radius:.2g} radii",
    }
    if trajectory.error_estimate is not None:
        rows["estimated error of φ and u/a"] = f"{trajectory.error_estimate:.2g} rad"
    rows["trusted"] = "yes" if trajectory.trusted else "no: " + "; ".join(trajectory.warnings)
    return _html(rows)


def scene_html(scene: Scene) -> str:
    """Return the parameters of a scene as an HTML table."""
    can, load = scene.can, scene.load
    rows = {
        "scene": in_words(scene, {"incline"}),
        "incline": f"{math.degrees(scene.incline):.6g} degrees",
        "can": f"radius {can.radius:.6g} m, length {can.length:.6g} m, mass {can.mass:.6g} kg, "
        f"inertia {can.inertia:.6g} kg m²",
        "load": f"mass {load.mass:.6g} kg, {load.offset:.6g} m from the axis, inertia {load.inertia:.6g} kg m²"
        + (f", filled to {load.fill:.4g} of the can's diameter" if load.fill is not None else ""),
        "gravity": f"{scene.gravity:.6g} m/s²",
    }
    if scene.dissipates:
        rows["damping torque over slip rate"] = damping_in_words(scene)
        rows["drag of the air"] = f"{scene.drag:.6g} kg/m"
    return _html(rows)


def _html(rows: dict[str, str]) -> str:
    """Return rows of names and values as an HTML table."""
    cells = "".join(f"<tr><th>{html.escape(name)}</th><td>{html.escape(text)}</td></tr>" for name, text in rows.items())
    return f'<table style="text-align: left">{cells}</table>'
