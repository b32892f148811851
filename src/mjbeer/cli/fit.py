"""The command that fits a scene to the track of a video."""

import argparse
import json
import math
import pathlib
import re
import warnings
from argparse import Namespace
from typing import Any

from mjbeer.cli.arguments import Option, command, scene
from mjbeer.exceptions import LiquidWarning, ParameterError
from mjbeer.output import files, terminal
from mjbeer.output.terminal import say

_ENDINGS = ".svg", ".png", ".mp4"
_ANGLES = "incline", "phi0", "turned"


def known(text: str) -> tuple[str, tuple[float, float]]:
    """Read a measured value with its error, as "fill=0.5±0.005" or "incline=2+-0.1" [degrees]."""
    try:
        name, value, error = re.split(r"=|±|\+-", text)
        unit = math.pi / 180 if name in _ANGLES else 1.0
        return name, (unit * float(value), unit * float(error))
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r} is no value with its error, as fill=0.5±0.005") from None


def column(text: str) -> tuple[str, str]:
    """Read which column is meant, as "x=3" or "time=t"."""
    name, _, heading = text.partition("=")
    return name, heading


@command(
    Option(
        "free", "what is sought, of incline, fill, damping, drag; the scene's options are guesses", ["incline"], str
    ),
    Option("known", "measured values with their errors, as fill=0.5±0.005 [incline in degrees]", [], known, "none"),
    Option("phi0", "the load's angle when it is let go: level, free, or a number [degrees]", "level", str),
    Option("bend", "bend of the track by a lens; 0 is none [m]", None, float, "5 mm, or 1/400 of a short way"),
    Option("columns", "columns by heading or number, as time=1 x=3", [], column, "by the usual headings"),
    Option("rate", "pictures per second, where frames are numbered [1/s]", None, float, "times in the table"),
    Option("json", "print the values with their errors as JSON", kind=bool),
    Option("output", "plot (.svg, .png) or film (.mp4) to write", None, pathlib.Path, "none"),
    numbers=float,
    file="table of the track, as Tracker, Logger Pro, Capstone and phyphox export it",
)
def fit(given: Namespace) -> int:
    """Tell from the track of a filmed can what was in it, and on which incline it rolled."""
    from mjbeer.tracks.fit import fit
    from mjbeer.tracks.track import read_track

    output = given.output
    if output and output.suffix not in _ENDINGS:
        raise ParameterError(f"the file's name must end in {' or '.join(_ENDINGS)}, got {str(output)!r}")
    try:
        phi0 = given.phi0 if given.phi0 in ("level", "free") else math.radians(float(given.phi0))
    except ValueError:
        raise ParameterError(f"phi0 must be level, free, or a number [degrees], got {given.phi0!r}") from None
    track = read_track(given.file, dict(given.columns), given.rate)
    with warnings.catch_warnings(action="ignore", category=LiquidWarning):  # of a guess
        guess = scene(given)
    found = fit(track, guess, given.free, dict(given.known), phi0, given.bend)
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
