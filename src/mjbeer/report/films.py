"""The films of the report, in the order in which the page shows them, and how to draw them."""

import math
import pathlib
from collections.abc import Sequence
from functools import partial

from mjbeer.drawing.film import Film, Take
from mjbeer.drawing.overlay.look import Look
from mjbeer.drawing.race import Race
from mjbeer.drawing.runner import Runner
from mjbeer.drawing.studio import Order
from mjbeer.paper.stories import report as stories_report
from mjbeer.simulation.simulate import simulate
from mjbeer.theory.can import Can
from mjbeer.theory.scene import frozen, hoop, pendulum, sliding

_METAL = Can.sheet_metal()
_GENTLE = math.radians(5)
"""Incline of the race [rad]: gentle enough for the frozen can to roll to the finish without leaving the board."""
_FILL = 0.75
"""How full the cans of the race are that are neither full nor empty."""
_EMPTY = 1e-6
"""Fill of the empty can: its beer weighs a ten millionth of the can."""


def runners() -> Sequence[Runner]:
    """Return the cans of the race, each with its motion."""
    cans = (
        ("beer slides, ¾ full", sliding(_GENTLE, can=_METAL, fill=_FILL), math.radians(30), (0.80, 0.45, 0.0)),
        ("beer frozen, ¾ full", frozen(_GENTLE, can=_METAL, fill=_FILL), math.pi, (0.15, 0.45, 0.75)),
        ("beer frozen, full", frozen(_GENTLE, can=_METAL, fill=1.0), 0.0, (0.40, 0.25, 0.60)),
        ("empty", sliding(_GENTLE, can=_METAL, fill=_EMPTY), 0.0, (0.35, 0.38, 0.42)),
    )
    return [Runner(name, simulate(scene, 2.3, phi0, tolerance=1e-9), colour) for name, scene, phi0, colour in cans]


FILMS: dict[str, Film] = {
    "race": Race(
        "Which can wins?",
        runners,
        length=1.0,
        speed=0.25,
        caption="Four equal cans are let go together on an incline of 5 degrees, and race over one metre. The can wins "
        "whose beer slides: the beer only goes downhill and does not turn, so that almost nothing is spent on turning. "
        "What is frozen must turn with its can: the full one is as slow as a solid cylinder, with two thirds of the "
        "winner's acceleration. The frozen one that is three quarters full starts with its beer on top, for with its "
        "beer below it would stay where it is; that gives it a lead of two centimetres, which the winner takes back "
        "before half-way. The empty can comes last, since all of its mass is in its wall. Theory has the same times, "
        "to all digits.",
        still=1.4,
        after=0.2,
    ),
    "sliding": Take(
        partial(simulate, sliding(can=_METAL), 1.2, math.radians(60), tolerance=1e-9),
        speed=0.25,
        caption="Half a can of beer, let go at φ = 60°. The beer slides in its can without friction and swings. The "
        "can goes to and fro about the dashed one, which accelerates evenly: it hesitates with every swing. The camera "
        "moves along evenly.",
        still=0.4,
        look=Look("Half a can of beer that slides in it", ("phi", "ahead"), ("phi", "ghost")),
    ),
    "frozen": Take(
        partial(simulate, frozen(), 0.82, math.pi, tolerance=1e-9),
        speed=0.2,
        caption="The beer is frozen to the can and let go with the beer on top: it rolls down ever faster, in jerks. "
        "The film ends just before the can would leave the incline.",
        still=0.55,
        look=Look("Frozen beer, let go with the beer on top", ("u", "normal"), ("phi", "paths", "forces")),
    ),
    "pendulum": Take(
        partial(simulate, pendulum(), 1.5, math.radians(60), tolerance=1e-9),
        speed=0.25,
        caption="A hoop wheel with a pendulum on its axle, let go at φ = 60°. The wheel goes to and fro about the "
        "dashed one, which accelerates evenly.",
        still=0.4,
        look=Look("A pendulum on the axle of a wheel", ("phi", "ahead"), ("phi", "ghost")),
    ),
    "hoop": Take(
        partial(simulate, hoop(), 0.5, -3.0, 16.0, rolling="contact", timestep=2e-4),
        speed=0.1,
        caption="A light hoop with a heavy bar on its rim, pushed with the bar on top, on level ground. It rolls over "
        "once, and hops a radius high when the bar comes up: nothing holds it down but its weight.",
        still=0.24,
        look=Look("A light hoop with a heavy bar on its rim", ("normal", "lift"), ("paths", "forces")),
    ),
}
"""The films by the names of their files."""
RACE = "race"
"""The film that the page shows first and alone."""
COMMANDS = {
    "sliding": "mjbeer render sliding --can metal --phi0 60 --duration 1.2 --tolerance 1e-9 --speed 0.25",
    "frozen": "mjbeer render frozen --phi0 180 --duration 0.82 --tolerance 1e-9 --speed 0.2",
    "pendulum": "mjbeer render pendulum --phi0 60 --duration 1.5 --tolerance 1e-9 --speed 0.25",
    "hoop": "mjbeer render hoop --phi0 -171.8873 --phi-dot0 916.7325 --duration 0.5 --rolling contact --timestep 2e-4 "
    "--speed 0.1",
}
"""The command that draws a film by itself; the others are drawn by `mjbeer report` alone."""
_SMALL, _LARGE = (640, 360, 30), (1280, 720, 30)
"""Width and height [pixels] and pictures per second of a film in a quick report, and in another one."""


def orders(folder: pathlib.Path, quick: bool) -> list[Order]:
    """Return the films to be drawn into a folder: those of the scenes and, unless it must be quick, of the stories."""
    size = _SMALL if quick else _LARGE
    scenes = [Order(film, folder / f"{name}.mp4", *size) for name, film in FILMS.items()]
    return scenes if quick else scenes + stories_report.orders(folder / "paper")


def not_drawn(names: Sequence[str]) -> str:
    """Return the line that says why films are missing and what brings them, or "" where they can be drawn."""
    from mjbeer.drawing import encoder, opengl

    if opengl.problem():
        return opengl.missing(names)
    return encoder.missing(names) if encoder.problem() else ""
