"""The commands about one motion: simulate, render, view, export and fit."""

import json
import math
import os
import tempfile
import warnings
from argparse import Namespace
from contextlib import nullcontext
from pathlib import Path
from typing import Any

import numpy as np

from mjbeer.cli.arguments import angle, scene, start, steps
from mjbeer.cli.summary import Summary
from mjbeer.exceptions import LiquidWarning, ParameterError, RenderingError
from mjbeer.model.setting import supported
from mjbeer.output import files, terminal
from mjbeer.output.terminal import say
from mjbeer.theory.trajectory import Trajectory, csv

_FPS = 30  # pictures per second of a video


def trajectory_of(given: Namespace) -> Trajectory:
    """Simulate the scene that was asked for and return its trajectory."""
    from mjbeer.simulation.simulate import simulate

    thing = scene(given)
    with warnings.catch_warnings(action="ignore", category=LiquidWarning):  # `_warn` says it
        return simulate(thing, given.duration, **start(given), **steps(given))


def simulate(given: Namespace) -> int:
    """Simulate a scene and print its key figures, with an estimate of the error."""
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


def render(given: Namespace) -> int:
    """Simulate a scene and draw it as a video (MP4)."""
    from mjbeer.drawing.video import render

    trajectory = trajectory_of(given)
    _warn(Summary(trajectory, given.friction))
    # An eye can follow a turn of 1 rad from picture to picture, a sixth of a circle.
    turn = given.speed / _FPS * max(float(np.abs(rate).max()) for rate in (trajectory.roll_dot, trajectory.phi_dot))
    if turn > 1:
        fast = f"can or load turn by up to {math.degrees(turn):.0f} degrees from picture to picture"
        say(f"note: {fast}; a --speed below {given.speed / turn:.2g} shows it better", "yellow")
    render(trajectory, given.output, given.width, given.height, _FPS, given.speed, given.camera)
    say(f"wrote {given.output}")
    return 0


def view(given: Namespace) -> int:
    """Open a scene in MuJoCo's viewer, which runs it at once.

    The space bar pauses it, - and = change its speed, and F4 plots u, phi and the other sensors. The reduced model of a
    frozen load has phi as its only coordinate, so it turns in place.
    """
    import glfw
    import mujoco.viewer

    from mjbeer.model.build import START
    from mjbeer.model.export import export

    thing = scene(given)
    how: dict[str, Any] = start(given) | steps(given)
    if given.scene != "standing" and supported(thing, "equality"):
        how = {"rolling": "equality"} | how
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "scene.xml"
        export(thing, path, **how)
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


def export(given: Namespace) -> int:
    """Write a scene with its start as one MJCF file that MuJoCo 4 loads without mjbeer."""
    from mjbeer.model.export import export

    export(scene(given), given.output, **start(given), **steps(given), portable=given.portable)
    keyframe = 'its start is a keyframe: mujoco.mj_resetDataKeyframe(model, data, model.key("start").id)'
    say(f"wrote {given.output}; {keyframe}")
    return 0


def _warn(summary: Summary) -> None:
    run = summary.trajectory
    lines = [f"equations not solved: {warning}" for warning in run.solver_warnings]
    lines += [f"model does not hold: {warning}" for warning in (*run.rolling_warnings, *run.liquid_warnings)]
    for line in (*lines, *(f"note: {note}" for note in summary.notes)):
        say(line, "yellow")


def fit(given: Namespace) -> int:
    """Tell from the track of a filmed can what was in it, and on which incline it rolled."""
    from mjbeer.tracks.fit import fit
    from mjbeer.tracks.track import read_track

    output, phi0 = given.output, given.phi0
    if output and output.suffix not in (".svg", ".png", ".mp4"):
        raise ParameterError(f"the file's name must end in .svg or .png or .mp4, got {str(output)!r}")
    try:
        phi0 = phi0 if phi0 in ("level", "free") else angle(phi0)
    except ValueError:
        raise ParameterError(f"phi0 must be level, free, or a number [degrees], got {phi0!r}") from None
    track = read_track(given.file, dict(each.partition("=")[::2] for each in given.columns), given.rate)
    with warnings.catch_warnings(action="ignore", category=LiquidWarning):  # of a guess
        guess = scene(given)
    found = fit(track, guess, given.free or ["incline"], dict(given.known), phi0, given.bend)
    if given.json:
        told = {"values": found.values, "errors": found.errors, "noise": found.noise, "warnings": found.warnings}
        terminal.write(json.dumps(told, indent=2) + "\n")
    else:
        terminal.write("\n".join([found.title, *found.lines()]) + "\n")
        for each in found.warnings:
            say(f"note: {each}", "yellow")
    if output and output.suffix == ".mp4":
        found.video(output)
    elif output:
        with files.atomic_write(output) as temporary:
            figure: Any = found.plot()[0].figure
            figure.savefig(temporary, facecolor="white", dpi=150)
    if output:
        say(f"wrote {output}")
    return 0
