"""The commands about one motion: simulate, render, view and export."""

import math
import os
import pathlib
import tempfile
import warnings
from argparse import Namespace
from contextlib import nullcontext
from typing import TYPE_CHECKING, Any

import numpy as np

from mjbeer.cli.arguments import (
    REQUIRED,
    STEPS,
    Option,
    command,
    model_options,
    run_options,
    scene,
    standing_can,
    start,
    steps,
)
from mjbeer.drawing.camera import CAMERAS
from mjbeer.exceptions import LiquidWarning, ParameterError, RenderingError
from mjbeer.model.setting import supported
from mjbeer.output import files, terminal
from mjbeer.output.terminal import say

if TYPE_CHECKING:
    from mjbeer.cli.summary import Summary
    from mjbeer.theory.trajectory import Trajectory

_FPS = 30  # pictures per second of a video
_SPEED = Option("speed", "playback speed: 1 is real time, 0.25 is four times slower", 1.0)
_CAMERA = (
    "fixed (stands still and shows the whole motion), pan (moves along with a constant acceleration), close (goes "
    "with the can), or auto: fixed, unless the can would be too small"
)
_PORTABLE = (
    "write MJCF that MuJoCo 3.3.1, MJX, mujoco_warp and dm_control load too, with Euler, implicitfast or RK4 as "
    "integrator; docs/portability.md has each tool's error"
)


def trajectory_of(given: Namespace) -> "Trajectory":
    """Simulate the scene that was asked for and return its trajectory."""
    from mjbeer.simulation.simulate import simulate

    thing = scene(given)
    with warnings.catch_warnings(action="ignore", category=LiquidWarning):  # `_warn` says it
        return simulate(thing, given.duration, **start(given), **steps(given))


@command(
    *run_options(),
    Option("output", 'CSV file to write; "-" is standard output', None, pathlib.Path, "no CSV"),
    Option("json", "print the key figures and the warnings as JSON", kind=bool),
    numbers=float,
)
def simulate(given: Namespace) -> int:
    """Simulate a scene and print its key figures, with an estimate of the error."""
    from mjbeer.cli.summary import Summary
    from mjbeer.theory.trajectory import csv

    to_output = str(given.output) == "-"
    if to_output and given.json:
        raise ParameterError("standard output takes one of them: the JSON, or the CSV of --output -")
    with files.atomic_write(given.output) if given.output and not to_output else nullcontext() as temporary:
        summary = Summary(trajectory_of(given), given.friction)
        if temporary:
            temporary.write_text(csv(summary.trajectory), encoding="utf-8")
    if temporary:
        say(f"wrote {given.output}")
    if to_output:
        terminal.write(csv(summary.trajectory))
        say(summary.text().rstrip())
    else:
        terminal.write(summary.json() if given.json else summary.text())
    _warn(summary)
    return 0


@command(
    *run_options(),
    Option("output", "MP4 file to write", pathlib.Path("mjbeer.mp4"), pathlib.Path),
    _SPEED,
    Option("camera", _CAMERA, "auto", CAMERAS),
    Option("width", "width of the video [pixels]", 1280, int),
    Option("height", "height of the video [pixels]", 720, int),
    numbers=float,
)
def render(given: Namespace) -> int:
    """Simulate a scene and draw it as a video (MP4)."""
    from mjbeer.cli.summary import Summary
    from mjbeer.drawing.video import render

    trajectory = trajectory_of(given)
    _warn(Summary(trajectory, given.friction))
    # An eye can follow a turn of 1 rad from picture to picture, a sixth of a circle.
    turn = given.speed / _FPS * max(float(np.abs(rate).max()) for rate in (trajectory.roll_dot, trajectory.phi_dot))
    if turn > 1:
        fast = f"can or load turn by up to {math.degrees(turn):.0f} degrees from picture to picture"
        say(f"note: {fast}; a --speed below {given.speed / turn:.2g} shows it better", "yellow")
    picture = {name: getattr(given, name) for name in ("width", "height", "speed", "camera")}
    render(trajectory, given.output, fps=_FPS, **picture)
    say(f"wrote {given.output}")
    return 0


@command(*model_options(rolling=None), numbers=float, standing=STEPS)
def view(given: Namespace) -> int:
    """Open a scene in MuJoCo's viewer, which runs it at once.

    The space bar pauses it, - and = change its speed, and F4 plots u, phi and the other sensors. The reduced model of a
    frozen load has phi as its only coordinate, so it turns in place.
    """
    import glfw
    import mujoco.viewer

    from mjbeer.model.build import START
    from mjbeer.model.export import export

    thing, begin = _scene_and_start(given)
    how = steps(given)
    if given.scene != "standing" and given.rolling is None:
        how["rolling"] = "equality" if supported(thing, "equality") else "reduced"
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "scene.xml"
        export(thing, path, **begin, **how)
        model = mujoco.MjModel.from_xml_path(str(path))
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, model.key(START).id)
    glfw.ERROR_REPORTING = "ignore"
    if not glfw.init():  # MuJoCo would end the process
        reason: Any = glfw.get_error()[1]
        raise RenderingError(
            f"no window can be opened: {reason.decode()}; `mjbeer render` draws a video without a window, and "
            "`mjbeer export` writes a file for MuJoCo's viewer elsewhere"
        )
    os.environ.setdefault("LP_NUM_THREADS", "0")  # see `opengl.context`
    mujoco.viewer.launch(model, data, show_left_ui=False, show_right_ui=False)
    return 0


_WRITTEN = (
    Option("output", 'MJCF file to write (.xml); its keyframe "start" is the start', None, pathlib.Path, REQUIRED),
    Option("portable", _PORTABLE, kind=bool),
)


@command(*model_options(), *_WRITTEN, numbers=float, standing=(*STEPS, *_WRITTEN))
def export(given: Namespace) -> int:
    """Write a scene with its start as one MJCF file that MuJoCo 4 loads without mjbeer."""
    from mjbeer.model.export import export

    thing, begin = _scene_and_start(given)
    export(thing, given.output, **begin, **steps(given), portable=given.portable)
    keyframe = 'its start is a keyframe: mujoco.mj_resetDataKeyframe(model, data, model.key("start").id)'
    say(f"wrote {given.output}; {keyframe}")
    return 0


def _scene_and_start(given: Namespace) -> tuple[Any, dict[str, Any]]:
    """Return what was asked for, a scene or a standing can, and the start of a scene."""
    return (standing_can(given), {}) if given.scene == "standing" else (scene(given), start(given))


def _warn(summary: "Summary") -> None:
    run = summary.trajectory
    lines = [f"equations not solved: {warning}" for warning in run.solver_warnings]
    lines += [f"model does not hold: {warning}" for warning in (*run.rolling_warnings, *run.liquid_warnings)]
    for line in (*lines, *(f"note: {note}" for note in summary.notes)):
        say(line, "yellow")
