"""The commands about one motion: simulate, render, view, export and fit; and its key figures."""

import math
import os
import tempfile
import warnings
from argparse import ArgumentTypeError, Namespace
from contextlib import nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from mjbeer import require
from mjbeer.checks.as_json import json_values, to_json
from mjbeer.cli.arguments import angle, model_arguments, scene, start_arguments
from mjbeer.drawing.words import damping_in_words
from mjbeer.exceptions import LiquidWarning, MjbeerError, ParameterError, RenderingError
from mjbeer.model.setting import FRICTION, supported
from mjbeer.output import files, terminal
from mjbeer.output.terminal import say
from mjbeer.theory.scene import Scene
from mjbeer.theory.trajectory import csv

if TYPE_CHECKING:
    from mjbeer.simulation.run import Run


class KeyFigure(NamedTuple):
    """A quantity of a run that `mjbeer simulate` prints."""

    name: str
    value: Any
    """The value in JSON."""
    unit: str = ""
    shown: str = "{}"
    """How the text shows the value: a format for it, or words that stand in its place."""

    def line(self) -> str | None:
        """Return the line of the text, or None if there is no number to show."""
        if "{" not in self.shown:
            return f"{self.name:<31} {self.shown}"
        if json_values(self.value) is None:
            return None
        return f"{self.name:<31} {self.shown.format(self.value)} {self.unit}".rstrip()

    @property
    def key(self) -> str:
        """The name in JSON."""
        return f"{self.name} [{self.unit}]" if self.unit else self.name


class Summary:
    """The key figures of a run, and until when a can would roll with some friction."""

    def __init__(self, run: "Run", friction: float = FRICTION) -> None:
        self.run = run
        self.friction = friction
        self.rolls_until = math.inf
        """Until when the can would roll without slipping [s]."""
        # Looking for that time takes a second run, which a can that never slips does not need.
        if run.record.needed_friction > friction:
            self.rolls_until = run.rolls_until(friction)
        self.notes: list[str] = []
        # In contact the can simply slips, and the run's own warnings say so.
        if run.rolling != "contact" and math.isfinite(self.rolls_until):
            self.notes.append(
                f"a real can would slip from t = {self.rolls_until:.6g} s "
                f"with a friction coefficient of {friction:g}"
            )

    @property
    def key_figures(self) -> list[KeyFigure]:
        """The key figures in the order in which they are printed."""
        run = self.run
        radius = run.scene.can.radius
        slip = run.slip / radius
        lift = run.lift / radius
        normal = run.forces.normal
        return [
            KeyFigure("rolling", run.rolling),
            KeyFigure("integrator", run.integrator),
            KeyFigure("timestep", run.timestep, "s", "{:.6g}"),
            KeyFigure("samples", len(run.time)),
            KeyFigure("end", run.time[-1], "s", "{:.6g}"),
            KeyFigure("phi at the end", math.degrees(run.phi[-1]), "degrees", "{:.9g}"),
            KeyFigure("u at the end", run.u[-1], "m", "{:.9g}"),
            _energy_drift(run),
            KeyFigure("largest slip", np.abs(slip).max(), "radii", "{:.2e}"),
            KeyFigure("final slip", slip[-1], "radii", "{:.2e}"),
            KeyFigure("lowest lift", lift.min(), "radii", "{:.2e}"),
            KeyFigure("highest lift", lift.max(), "radii", "{:.2e}"),
            KeyFigure("least normal force needed", normal.min(), "N", "{:.4g}"),
            KeyFigure("largest normal force needed", normal.max(), "N", "{:.4g}"),
            _needed_friction(run),
            self._rolls_until(),
            *_steady_rolling(run.scene),
            KeyFigure("estimated error of phi and u/a", run.error_estimate, "rad", "{:.2e}"),
            _yes_or_no("equations solved", not run.solver_warnings),
            _yes_or_no(
                "model holds", not (run.rolling_warnings or run.liquid_warnings or self.notes)
            ),
        ]

    def _rolls_until(self) -> KeyFigure:
        until = self.rolls_until
        end = "the end" if math.isinf(until) else f"t = {until:.6g} s"
        shown = f"{end} with friction {self.friction:g}"
        return KeyFigure("can roll without slipping until", until, "s", shown)

    def text(self) -> str:
        """Return the figures as lines of text; one that has no number to show is left out."""
        lines = [figure.line() for figure in self.key_figures]
        return "\n".join(line for line in lines if line) + "\n"

    def json(self) -> str:
        """Return the figures as a JSON object, units in the names; infinity and NaN are null."""
        content = {figure.key: figure.value for figure in self.key_figures}
        content |= {"warnings": self.run.warnings, "notes": self.notes}
        return to_json(content, indent=2)


def _yes_or_no(name: str, value: bool) -> KeyFigure:
    return KeyFigure(name, value, shown="yes" if value else "no")


def _energy_drift(run: "Run") -> KeyFigure:
    """Return the drift of the energy; it has no value if damping or drag takes energy."""
    scale = "the swing's largest kinetic energy"
    if not run.scene.load.offset:
        scale = "the largest kinetic energy"
    drift = None if run.scene.dissipates else run.energy_drift
    return KeyFigure("energy drift", drift, shown=f"{{:.2e}} of {scale}")


def _needed_friction(run: "Run") -> KeyFigure:
    record = run.record
    if math.isfinite(record.needed_friction):
        shown = "{:.4g} to roll to the end without slipping"
    elif math.isfinite(record.rolling_ends_at):
        shown = f"none is enough: N < 0 from t = {record.rolling_ends_at:.6g} s"
    else:
        shown = "none is enough: nothing presses (N = 0)"
    return KeyFigure("friction coefficient needed", record.needed_friction, shown=shown)


def _steady_rolling(scene: Scene) -> list[KeyFigure]:
    """Return the damping and the drag of a scene that has any, and how it may come to roll."""
    if not scene.dissipates:
        return []
    figures = [
        KeyFigure("damping torque per slip rate", damping_in_words(scene)),
        KeyFigure("drag of the air", scene.drag, "kg/m", "{:.4g}"),
    ]
    try:
        speed = scene.terminal_speed()
        tilt = math.degrees(scene.terminal_tilt())
        roots = scene.modes().tolist()
    except MjbeerError as error:
        # The first clause says what does not exist.
        reason, _, _ = str(error).partition(":")
        return [*figures, KeyFigure("terminal speed", None, "m/s", reason)]
    pairs = [[root.real, root.imag] for root in roots]
    words = [f"{root:.4g}" if root.imag else f"{root.real:.4g}" for root in roots]
    modes = f"{', '.join(words)} 1/s"
    return [
        *figures,
        KeyFigure("terminal speed", speed, "m/s", "{:.6g}"),
        KeyFigure("terminal tilt", tilt, "degrees", "{:.6g}"),
        KeyFigure("modes, real and imaginary parts", pairs, "1/s", modes),
    ]


def run_of(given: Namespace) -> "Run":
    """Simulate the scene of a command line."""
    from mjbeer.simulation.simulate import simulate

    can = scene(given)
    # `_print_warnings` tells what the run warns of.
    with warnings.catch_warnings(action="ignore", category=LiquidWarning):
        return simulate(can, given.duration, **start_arguments(given), **model_arguments(given))


def simulate(given: Namespace) -> None:
    """Simulate a scene and print its key figures, with an estimate of the error."""
    to_output = str(given.output) == "-"
    if to_output and given.json:
        raise ParameterError(
            "standard output takes one of them: the JSON, or the CSV of --output -"
        )
    to_file = given.output and not to_output
    writing = files.atomic_write(given.output) if to_file else nullcontext()
    with writing as temporary:
        with terminal.status("simulating"):
            summary = Summary(run_of(given), given.friction)
        if summary.run.timestep is not None:
            second = "estimating the error by a second run, which takes up to three times as long"
            with terminal.status(second):
                _ = summary.run.error_estimate  # it is computed here, and kept for the text
        if temporary:
            temporary.write_text(csv(summary.run), encoding="utf-8")
    if temporary:
        say(f"wrote {given.output}")
    if to_output:
        terminal.write(csv(summary.run))
        say(summary.text().rstrip())
    else:
        terminal.write(summary.json() if given.json else summary.text())
    _print_warnings(summary)


def render(given: Namespace) -> None:
    """Simulate a scene and draw it as a video (MP4).

    A can that stands is held, and its liquid is let go with a surface 0.1 R high at the wall.
    """
    from mjbeer.drawing import video

    # A mistake is an error before the run, which may take long.
    video.check_target(given.output, given.width, given.height)
    require.positive("speed", given.speed)
    if given.scene == "standing":
        _render_standing(given)
        return
    trajectory = run_of(given)
    _print_warnings(Summary(trajectory, given.friction))
    video.render(
        trajectory,
        given.output,
        given.width,
        given.height,
        speed=given.speed,
        camera=given.camera,
    )
    say(f"wrote {given.output}")


def _render_standing(given: Namespace) -> None:
    """Draw how the liquid of a standing can sloshes."""
    from mjbeer.drawing.standing_film import StandingFilm, render_standing

    can = scene(given)
    if can.moving_modes == 0:
        say("note: nothing moves in this film, because the liquid is solid", "yellow")
    film = StandingFilm(can, given.duration, **model_arguments(given), speed=given.speed)
    render_standing(film, given.output, given.width, given.height)
    say(f"wrote {given.output}")


def view(given: Namespace) -> None:
    """Open a scene in MuJoCo's viewer, which runs it at once.

    The space bar pauses it, - and = change its speed, and F4 plots u, phi and the other sensors.
    The reduced model of a frozen load has phi as its only coordinate, so it turns in place.
    """
    import glfw
    import mujoco.viewer

    from mjbeer.model.build import START
    from mjbeer.model.export import export

    can = scene(given)
    settings: dict[str, Any] = start_arguments(given) | model_arguments(given)
    if given.scene != "standing" and supported(can, "equality"):
        settings.setdefault("rolling", "equality")
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "scene.xml"
        export(can, path, **settings, looks="full")
        model = mujoco.MjModel.from_xml_path(str(path))
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, model.key(START).id)
    glfw.ERROR_REPORTING = "ignore"
    # Where GLFW fails, MuJoCo would end the process.
    if not glfw.init():
        reason: Any = glfw.get_error()[1]
        raise RenderingError(
            f"no window can be opened: {reason.decode()}; `mjbeer render` draws a video without a "
            "window, and `mjbeer export` writes a file for MuJoCo's viewer elsewhere"
        )
    os.environ.setdefault("LP_NUM_THREADS", "0")  # see `opengl.context`
    mujoco.viewer.launch(model, data, show_left_ui=False, show_right_ui=False)


def export(given: Namespace) -> None:
    """Write a scene with its start as one MJCF file that MuJoCo 4 loads without mjbeer."""
    from mjbeer.model.export import export

    export(
        scene(given),
        given.output,
        **start_arguments(given),
        **model_arguments(given),
        portable=given.portable,
        looks=given.looks,
    )
    keyframe = (
        'its start is a keyframe: mujoco.mj_resetDataKeyframe(model, data, model.key("start").id)'
    )
    say(f"wrote {given.output}; {keyframe}")


def _print_warnings(summary: Summary) -> None:
    run = summary.run
    for warning in run.solver_warnings:
        say(f"equations not solved: {warning}", "yellow")
    for warning in (*run.rolling_warnings, *run.liquid_warnings):
        say(f"model does not hold: {warning}", "yellow")
    for note in summary.notes:
        say(f"note: {note}", "yellow")


def fit(given: Namespace) -> None:
    """Tell from the track of a filmed can what was in it, and on which incline it rolled."""
    from mjbeer.tracks.fit import fit
    from mjbeer.tracks.track import read_track

    output = given.output
    if output and output.suffix not in (".svg", ".png", ".mp4"):
        raise ParameterError(
            f"the file's name must end in .svg or .png or .mp4, got {str(output)!r}"
        )
    phi0 = _phi0_of_fit(given.phi0)
    columns = {}
    for column in given.columns:
        quantity, _, heading = column.partition("=")
        columns[quantity] = heading
    track = read_track(given.file, columns, given.rate, given.scale, given.marks or None)
    # A warning about a guess says nothing about the fit.
    with warnings.catch_warnings(action="ignore", category=LiquidWarning):
        guess = scene(given)
    writing = files.atomic_write(output) if output else nullcontext()
    with writing as temporary:
        result = fit(track, guess, given.free or ["incline"], dict(given.known), phi0, given.bend)
        if given.json:
            content = {
                "values": result.values,
                "errors": result.errors,
                "noise": result.noise,
                "warnings": result.warnings,
            }
            terminal.write(to_json(content, indent=2))
        else:
            terminal.write("\n".join([result.title, *result.lines()]) + "\n")
            for warning in result.warnings:
                say(f"note: {warning}", "yellow")
        if temporary and temporary.suffix == ".mp4":
            result.video(temporary)
        elif temporary:
            figure: Any = result.plot()[0].figure
            figure.savefig(temporary, facecolor="white", dpi=150)
    if output:
        say(f"wrote {output}")


def _phi0_of_fit(text: str) -> str | float:
    """Return what a fit takes as phi0: "level", "free", or an angle [rad]."""
    if text in ("level", "free"):
        return text
    try:
        return angle(text)
    except (ValueError, ArgumentTypeError):
        raise ParameterError(
            f"phi0 must be level, free, or a number [degrees], got {text!r}"
        ) from None
