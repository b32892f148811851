"""The commands about one motion, simulate, render, view, export and fit, and the key figures that they tell."""

import math
import os
import tempfile
import warnings
from argparse import Namespace
from contextlib import nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from mjbeer.cli.arguments import angle, scene, start, steps
from mjbeer.drawing.words import damping_in_words
from mjbeer.exceptions import LiquidWarning, MjbeerError, ParameterError, RenderingError
from mjbeer.model.setting import FRICTION, supported
from mjbeer.output import files, terminal
from mjbeer.output.terminal import say
from mjbeer.paper.checks import json_values, to_json
from mjbeer.theory.scene import Scene
from mjbeer.theory.trajectory import csv

if TYPE_CHECKING:
    from mjbeer.simulation.run import Run

KeyFigure = tuple[str, Any, str, str]  # a name, a value, its unit, and how text shows it: as a format, or in words


class Summary:
    """The key figures of a trajectory, and until when [s] a can would roll with a coefficient of friction."""

    def __init__(self, trajectory: "Run", friction: float = FRICTION) -> None:
        self.trajectory, self.friction = trajectory, friction
        # Where rolling needs no more than there is, this saves the run that looks for the first time at which it does.
        enough = trajectory.record.needed_friction <= friction
        self.rolls_until = math.inf if enough else trajectory.rolls_until(friction)
        # Although the run is right. In contact the can simply slips, and the run's own warnings say so.
        slips = f"a real can would slip from t = {self.rolls_until:.6g} s with a friction coefficient of {friction:g}"
        self.notes = [slips] if trajectory.rolling != "contact" and math.isfinite(self.rolls_until) else []

    @property
    def key_figures(self) -> tuple[KeyFigure, ...]:
        """The figures in the order of the text."""
        run, radius, until = self.trajectory, self.trajectory.scene.can.radius, self.rolls_until
        slip, lift, normal = run.slip / radius, run.lift / radius, run.forces.normal
        solved = not run.solver_warnings
        holds = not (run.rolling_warnings or run.liquid_warnings or self.notes)
        drift = None if run.scene.dissipates else run.energy_drift  # what damping and drag take is no error
        scale = "the swing's largest kinetic energy" if run.scene.load.offset else "the largest kinetic energy"
        end = "the end" if math.isinf(until) else f"t = {until:.6g} s"
        return (
            ("rolling", run.rolling, "", "{}"),
            ("integrator", run.integrator, "", "{}"),
            ("timestep", run.timestep, "s", "{:.6g}"),
            ("samples", len(run.time), "", "{}"),
            ("end", run.time[-1], "s", "{:.6g}"),
            ("phi at the end", math.degrees(run.phi[-1]), "degrees", "{:.9g}"),
            ("u at the end", run.u[-1], "m", "{:.9g}"),
            ("energy drift", drift, "", f"{{:.2e}} of {scale}"),
            ("largest slip", np.abs(slip).max(), "radii", "{:.2e}"),
            ("final slip", slip[-1], "radii", "{:.2e}"),
            ("lowest lift", lift.min(), "radii", "{:.2e}"),
            ("highest lift", lift.max(), "radii", "{:.2e}"),
            ("least normal force needed", normal.min(), "N", "{:.4g}"),
            ("largest normal force needed", normal.max(), "N", "{:.4g}"),
            ("friction coefficient needed", run.record.needed_friction, "", _needed(run)),
            ("can roll without slipping until", until, "s", f"{end} with friction {self.friction:g}"),
            *_steady(run.scene),
            ("estimated error of phi and u/a", run.error_estimate, "rad", "{:.2e}"),
            ("equations solved", solved, "", "yes" if solved else "no"),
            ("model holds", holds, "", "yes" if holds else "no"),
        )

    def text(self) -> str:
        """Return the figures as lines of text, without those that have no number to show."""
        lines = [
            f"{name:<31} {shown.format(value)} {unit}".rstrip() if "{" in shown else f"{name:<31} {shown}"
            for name, value, unit, shown in self.key_figures
            if "{" not in shown or json_values(value) is not None
        ]
        return "\n".join(lines) + "\n"

    def json(self) -> str:
        """Return the figures as a JSON object, with units in the names; what is not finite becomes null."""
        content = {f"{name} [{unit}]" if unit else name: value for name, value, unit, _ in self.key_figures}
        content |= {"warnings": self.trajectory.warnings, "notes": self.notes}
        return to_json(content, indent=2)


def _needed(run: "Run") -> str:
    if math.isfinite(run.record.needed_friction):
        return "{:.4g} to roll to the end without slipping"
    ends = f"N < 0 from t = {run.record.rolling_ends_at:.6g} s"
    return f"none is enough: {ends if math.isfinite(run.record.rolling_ends_at) else 'nothing presses (N = 0)'}"


def _steady(scene: Scene) -> list[KeyFigure]:
    """Return what takes energy from a motion, and the steady rolling to which it may come."""
    if not scene.dissipates:
        return []
    figures: list[KeyFigure] = [("damping torque over slip rate", damping_in_words(scene), "", "{}")]
    figures += [("drag of the air", scene.drag, "kg/m", "{:.4g}")]
    try:
        speed, tilt, roots = scene.terminal_speed(), math.degrees(scene.terminal_tilt()), scene.modes().tolist()
    except MjbeerError as error:  # its first clause says what there is not
        return [*figures, ("terminal speed", None, "m/s", str(error).partition(":")[0])]
    figures += [("terminal speed", speed, "m/s", "{:.6g}"), ("terminal tilt", tilt, "degrees", "{:.6g}")]
    pairs = [[root.real, root.imag] for root in roots]
    shown = ", ".join(f"{root:.4g}" if root.imag else f"{root.real:.4g}" for root in roots)
    return [*figures, ("modes, real and imaginary parts", pairs, "1/s", f"{shown} 1/s")]


def trajectory_of(given: Namespace) -> "Run":
    """Simulate the scene that was asked for."""
    from mjbeer.simulation.simulate import simulate

    thing = scene(given)
    with warnings.catch_warnings(action="ignore", category=LiquidWarning):  # `_warn` says it
        return simulate(thing, given.duration, **start(given), **steps(given))


def simulate(given: Namespace) -> None:
    """Simulate a scene and print its key figures, with an estimate of the error."""
    to_output = str(given.output) == "-"
    if to_output and given.json:
        raise ParameterError("standard output takes one of them: the JSON, or the CSV of --output -")
    with files.atomic_write(given.output) if given.output and not to_output else nullcontext() as temporary:
        with terminal.status("simulating"):
            summary = Summary(trajectory_of(given), given.friction)
        if summary.trajectory.timestep is not None:
            with terminal.status("estimating the error by a second run, which takes up to three times as long"):
                _ = summary.trajectory.error_estimate
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


def render(given: Namespace) -> None:
    """Simulate a scene and draw it as a video (MP4).

    A can that stands is held, and its liquid is let go with a surface 0.1 R high at the wall.
    """
    if given.scene == "standing":
        _render_standing(given)
        return
    from mjbeer.drawing.video import render

    trajectory = trajectory_of(given)
    _warn(Summary(trajectory, given.friction))
    render(trajectory, given.output, given.width, given.height, speed=given.speed, camera=given.camera)
    say(f"wrote {given.output}")


def _render_standing(given: Namespace) -> None:
    """Draw how the liquid of a standing can sloshes."""
    from mjbeer.drawing.standing_film import StandingFilm, render_standing

    can = scene(given)
    if can.moving_modes == 0:
        say("note: nothing moves in this film, because the liquid is solid", "yellow")
    film = StandingFilm(can, given.duration, **steps(given), speed=given.speed)
    render_standing(film, given.output, given.width, given.height)
    say(f"wrote {given.output}")


def view(given: Namespace) -> None:
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
        export(thing, path, **how, looks="full")
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


def export(given: Namespace) -> None:
    """Write a scene with its start as one MJCF file that MuJoCo 4 loads without mjbeer."""
    from mjbeer.model.export import export

    export(
        scene(given),
        given.output,
        **start(given),
        **steps(given),
        portable=given.portable,
        looks=given.looks,
    )
    keyframe = 'its start is a keyframe: mujoco.mj_resetDataKeyframe(model, data, model.key("start").id)'
    say(f"wrote {given.output}; {keyframe}")


def _warn(summary: Summary) -> None:
    run = summary.trajectory
    lines = [f"equations not solved: {warning}" for warning in run.solver_warnings]
    lines += [f"model does not hold: {warning}" for warning in (*run.rolling_warnings, *run.liquid_warnings)]
    for line in (*lines, *(f"note: {note}" for note in summary.notes)):
        say(line, "yellow")


def fit(given: Namespace) -> None:
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
    with files.atomic_write(output) if output else nullcontext() as temporary:
        found = fit(track, guess, given.free or ["incline"], dict(given.known), phi0, given.bend)
        if given.json:
            told = {"values": found.values, "errors": found.errors, "noise": found.noise, "warnings": found.warnings}
            terminal.write(to_json(told, indent=2))
        else:
            terminal.write("\n".join([found.title, *found.lines()]) + "\n")
            for each in found.warnings:
                say(f"note: {each}", "yellow")
        if temporary and temporary.suffix == ".mp4":
            found.video(temporary)
        elif temporary:
            figure: Any = found.plot()[0].figure
            figure.savefig(temporary, facecolor="white", dpi=150)
    if output:
        say(f"wrote {output}")
