"""What a user sees of a trajectory or a scene besides numbers: a plot, a table, a file, a video, a notebook's cell.

Trajectories and scenes belong to the theory, which knows neither plots nor files. Their methods load this module when
they are called.
"""

import html
import io
import math
import os
import pathlib
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from mjbeer import require
from mjbeer.exceptions import MjbeerError
from mjbeer.output import files
from mjbeer.theory.exact import solution
from mjbeer.theory.scene import Scene
from mjbeer.theory.trajectory import Trajectory
from mjbeer.theory.words import damping_in_words, in_words

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from mjbeer.drawing.world.cameras import Camera

_SMOOTH = 2000
"""Number of samples of the line of exact theory in a plot."""


def columns(trajectory: Trajectory) -> dict[str, np.ndarray]:
    """Return the columns of a trajectory's table by their names, which end with the unit."""
    return {
        "time [s]": trajectory.time,
        "u [m]": trajectory.u,
        "phi [rad]": trajectory.phi,
        "u_dot [m/s]": trajectory.u_dot,
        "phi_dot [rad/s]": trajectory.phi_dot,
        "roll [rad]": trajectory.roll,
        "lift [m]": trajectory.lift,
        "slip [m]": trajectory.slip,
        "energy [J]": trajectory.energy,
        "normal force needed [N]": trajectory.forces.normal,
        "friction force needed [N]": trajectory.forces.friction,
    }


def csv(trajectory: Trajectory) -> str:
    """Return a trajectory as CSV: one line per sample, units in the header, numbers with all their digits."""
    table, text = columns(trajectory), io.StringIO()
    np.savetxt(
        text, np.column_stack(list(table.values())), fmt="%.17g", delimiter=",", header=",".join(table), comments=""
    )
    return text.getvalue()


def write_csv(trajectory: Trajectory, path: str | os.PathLike[str]) -> None:
    """Write a trajectory as CSV, as `csv` returns it.

    Raises:
      OutputError: if the file cannot be written; an older one of that name then stays as it was.
    """
    with files.whole(require.path(path)) as temporary:
        temporary.write_text(csv(trajectory), encoding="utf-8")


def dataframe(trajectory: Trajectory) -> Any:
    """Return a trajectory as a pandas DataFrame: a row for each sample, columns with their units.

    Raises:
      MjbeerError: if pandas is not installed.
    """
    try:
        import pandas as pd
    except ImportError as error:
        raise MjbeerError("to_dataframe needs pandas: pip install pandas") from error
    return pd.DataFrame(columns(trajectory))


def plot(trajectory: Trajectory, theory: bool = False) -> "tuple[Axes, Axes]":
    """Return the axes of a new figure that shows φ [degrees] above and u [m] below, over time [s].

    With `theory`, the exact motion from the same start is drawn beneath as a wide grey line. A motion that rolls on
    where a can would leave the incline is dotted from there on.
    """
    import matplotlib as mpl
    from matplotlib import pyplot as plt

    from mjbeer.output.plots import SIMULATED, STYLE, THEORY, UNPHYSICAL

    require.boolean("theory", theory)
    scene, time = trajectory.scene, trajectory.time
    # A notebook makes matplotlib interactive with the first figure, which the context would undo at its end.
    figure = plt.figure(figsize=(8, 5), layout="constrained")
    with mpl.rc_context(STYLE):
        above, below = figure.subplots(2, 1, sharex=True)
        if theory:
            dense = np.union1d(time, np.linspace(0, time[-1], _SMOOTH))
            start = {"phi0": trajectory.phi0, "phi_dot0": trajectory.phi_dot0}
            truth = solution(scene, dense, **start)
            above.plot(dense, np.degrees(truth.phi), label="exact theory", **THEORY)
            below.plot(dense, truth.u, **THEORY)
        name = "exact theory" if trajectory.rolling == "exact" else "MuJoCo"
        parts = math.inf if trajectory.rolling == "contact" else trajectory.rolls_until()
        rolls, pulled = time <= parts, time >= parts
        for axes, values in ((above, np.degrees(trajectory.phi)), (below, trajectory.u)):
            axes.plot(time[rolls], values[rolls], label=name, **SIMULATED)
            if pulled.any():
                axes.plot(time[pulled], values[pulled], label="if the incline could pull the can", **UNPHYSICAL)
        above.set_ylabel("φ [°]")
        below.set(xlabel="time [s]", ylabel="u [m]")
        if len(above.get_lines()) > 1:
            above.legend()
        figure.suptitle(in_words(scene), fontsize=STYLE["axes.titlesize"])
    return above, below


@dataclass(frozen=True)
class Video:
    """A video in memory, which a notebook shows."""

    data: bytes
    """The video, MP4 with H.264."""
    width: int
    """Width [pixels]."""
    height: int
    """Height [pixels]."""

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the video as a file.

        Raises:
          OutputError: if the file cannot be written.
        """
        with files.whole(require.path(path)) as temporary:
            temporary.write_bytes(self.data)

    def _repr_html_(self) -> str:
        """Return the video as HTML, with nothing that has to be fetched."""
        import mediapy

        return mediapy.html_from_compressed_video(self.data, self.width, self.height, loop=True, autoplay=False)


def video(
    trajectory: Trajectory, width: int, height: int, fps: float, speed: float, camera: "Camera", progress: bool
) -> Video:
    """Return a video of a trajectory; the arguments are those of `mjbeer.render`.

    Raises:
      ParameterError: if a parameter is not allowed.
      RenderingError: if OpenGL or ffmpeg does not work; the message says what to do.
    """
    import tempfile

    from mjbeer.drawing.video import render

    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "trajectory.mp4"
        render(trajectory, path, width, height, fps=fps, speed=speed, camera=camera, progress=progress)
        return Video(path.read_bytes(), int(width), int(height))


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
        rows["torque of the damping"] = damping_in_words(scene)
        rows["drag of the air"] = f"{scene.drag:.6g} kg/m"
    return _html(rows)


def _html(rows: dict[str, str]) -> str:
    """Return rows of names and values as an HTML table."""
    cells = "".join(f"<tr><th>{html.escape(name)}</th><td>{html.escape(text)}</td></tr>" for name, text in rows.items())
    return f'<table style="text-align: left">{cells}</table>'
