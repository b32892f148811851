"""The films of the report in the order of the page: the motions, the races, and what is told of them."""

import math
import pathlib
from collections.abc import Sequence
from functools import cache, partial
from typing import Any

import numpy as np

from mjbeer.drawing.film import MotionFilm
from mjbeer.drawing.overlay import Look
from mjbeer.drawing.race import Race, Runner
from mjbeer.drawing.video import FilmJob
from mjbeer.drawing.words import in_degrees
from mjbeer.paper import stories
from mjbeer.report.carry import Carry
from mjbeer.simulation.simulate import simulate
from mjbeer.theory.can import Can
from mjbeer.theory.liquid import Name, liquid_in
from mjbeer.theory.scene import Scene, frozen, hoop, pendulum, sliding

METAL = Can.sheet_metal()
LENGTH = 1.0  # distance from start to finish [m]
_GENTLE = math.radians(5)
"""Incline of the race of beer [rad]: gentle enough for the frozen can to finish without leaving the board."""
_STEEPER = math.radians(7.1)
"""Incline of the race of liquids [rad]: let go with a level surface, ice rolls over the top from 6.93 degrees on, and
honey, the thickest of the liquids, from 7.38."""
_FILL = 0.75  # how full the cans are that are neither full nor empty
_EMPTY = 2e-4  # fill of the empty can: its beer weighs less than a thousandth of the can
_ICE = 917.0  # density of ice [kg/m^3]
_HESITATES: Any = {"strips": ("u_dot", "ahead"), "marks": ("phi", "ghost"), "notes": ("hesitates",)}
_SMALL = 640, 360, 25  # width and height [pixels] and pictures per second in a quick report


def of_beer() -> Sequence[Runner]:
    """Return the cans of the race of beer that slides, frozen beer, and none."""
    cans = (
        ("beer slides", sliding(_GENTLE, can=METAL, fill=_FILL), 30, (0.75, 0.38, 0.0), "¾ full, starts at φ = 30°"),
        ("beer frozen", frozen(_GENTLE, can=METAL, fill=_FILL), 180, (0.15, 0.42, 0.72), "¾ full, starts upside down"),
        ("beer frozen, full", frozen(_GENTLE, can=METAL, fill=1.0), 0, (0.40, 0.25, 0.60), ""),
        ("empty", sliding(_GENTLE, can=METAL, fill=_EMPTY), 0, (0.30, 0.33, 0.37), ""),
    )
    return [
        Runner(name, simulate(scene, 2.35, math.radians(phi0), tolerance=1e-9), colour, note=note)
        for name, scene, phi0, colour, note in cans
    ]


def told_of_beer() -> str:
    """Return what is seen in the race of beer."""
    return (
        "Four equal cans are let go together on an incline of 5 degrees, and race over one metre. The can whose beer "
        "slides wins: its beer swings to and fro by 30 degrees but does not turn with the can, so that almost nothing "
        "is spent on turning. Frozen beer must turn with its can: the full can is as slow as a solid cylinder, with "
        "two thirds of the winner's acceleration. The frozen can that is three quarters full starts with its beer on "
        "top, for with its beer below it would stay where it is; that gives it a lead of two centimetres, which the "
        "winner takes back before half-way. The empty can comes last, since most of its mass is in its wall."
    )


def with_liquid(name: Name, viscosity: float | None = None) -> Scene:
    """Return the can of the race with a liquid in it, whose `viscosity` [m^2/s] may be another than its own."""
    used = liquid_in(name, _STEEPER, _FILL, METAL, viscosity=viscosity)
    return sliding(_STEEPER, _FILL, METAL, used.density, damping=used.damping)


def with_ice() -> Scene:
    """Return the can of the race with ice in it."""
    return frozen(_STEEPER, _FILL, METAL, _ICE)


def of_liquids() -> Sequence[Runner]:
    """Return the cans of the race of water, oil, honey and ice, all let go with a level surface."""
    cans = (  # each until it is out of the picture
        ("water", with_liquid("water"), 1.6, (0.08, 0.40, 0.72), (0.36, 0.66, 0.93)),
        ("olive oil", with_liquid("olive oil"), 2.1, (0.42, 0.45, 0.05), (0.78, 0.76, 0.20)),
        ("honey", with_liquid("honey"), 24.5, (0.72, 0.38, 0.0), (0.88, 0.52, 0.05)),
        ("ice", with_ice(), 2.5, (0.40, 0.42, 0.55), (0.84, 0.93, 0.98)),
    )
    return [
        Runner(name, simulate(scene, end, -_STEEPER, tolerance=1e-9), colour, load)
        for name, scene, end, colour, load in cans
    ]


@cache
def told_of_liquids() -> str:
    """Return what is seen in the race of liquids, with its numbers."""
    cans = {can.name: can for can in of_liquids()}
    times = {name: can.finish(LENGTH) for name, can in cans.items()}
    carried = liquid_in("honey", _STEEPER, _FILL, METAL).carried
    honey = cans["honey"]
    way, speed = honey.positions(np.array([times["ice"]]))[0, 0], honey.trajectory.scene.terminal_speed()
    return (
        "Predict first, then look. Four equal cans, three quarters full of water, olive oil, honey and ice, are let go "
        f"together on an incline of {in_degrees(_STEEPER)}, each with its surface level. They differ in how hard the "
        "load rubs against the can: water hardly does, and ice not at all, since it turns with the can. Water wins "
        f"after {times['water']:.2f} s, and oil follows after {times['olive oil']:.2f} s. The ice hesitates with its "
        f"load nearly on top, rolls over, and finishes after {times['ice']:.2f} s, since it turns with its can. The "
        f"honey is last: when the ice arrives it has come {100 * way:.0f} cm, and it needs {times['honey']:.2f} s. It "
        "is between water and ice, yet slower than both. It neither slides freely nor turns with its can, and as it "
        f"rubs it takes all that the incline gives: it creeps with {100 * speed:.1f} cm/s. Each liquid is one lump "
        "here, and the times are this model's. Real water and oil are soon so fast that they need not stay at the "
        f"bottom, and of real honey the wall carries up to {100 * carried:.0f} % round with it. With half or twice the "
        "viscosity honey is last as well."
    )


RACES = {
    "race": Race("Which can wins?", of_beer, LENGTH, 2.3, 0.25, told_of_beer, still=1.4),
    "liquids": Race(
        "Water, oil, honey or ice: which can wins, and which is last?",
        *(of_liquids, LENGTH, 2.72, 1 / 3, told_of_liquids),
        still=2.2,
        facts="all cans ¾ full, each liquid one lump",
    ),
}
"""The films that the page shows first, by the names of their files."""
FILMS: dict[str, Race | MotionFilm | Carry] = RACES | {
    "sliding": MotionFilm(
        partial(simulate, sliding(can=METAL), 1.2, math.radians(60), tolerance=1e-9),
        speed=0.25,
        caption="Half a can of beer, let go at φ = 60°. The beer slides in its can without friction and swings. The "
        "can goes to and fro about the dashed one, which accelerates evenly: it hesitates with every swing. The camera "
        "moves along evenly.",
        still=0.4,
        look=Look("Beer slides in its can, and the can hesitates", **_HESITATES),
    ),
    "frozen": MotionFilm(
        partial(simulate, frozen(), 0.82, math.pi, tolerance=1e-9),
        speed=0.2,
        caption="The beer is frozen to the can and let go with the beer on top: it rolls down ever faster, in jerks. "
        "The film ends just before the can would leave the incline.",
        still=0.55,
        look=Look(
            "Frozen beer rolls down in jerks",
            ("normal", "u"),
            ("paths", "normal", "friction"),
            notes=("heavy", "light"),
        ),
    ),
    "pendulum": MotionFilm(
        partial(simulate, pendulum(), 1.5, math.radians(60), tolerance=1e-9),
        speed=0.25,
        caption="Does a wheel roll evenly with a pendulum on its axle? No: the wheel goes to and fro about the dashed "
        "one, which accelerates evenly. Nothing but their weight drives wheel and bob down the incline together, so "
        "that the wheel hesitates whenever its bob is uphill, and runs ahead whenever it is downhill.",
        still=0.4,
        look=Look("A pendulum in a wheel: does the wheel roll evenly?", **_HESITATES),
    ),
    "hoop": MotionFilm(
        partial(simulate, hoop(), 0.5, -3.0, 16.0, rolling="contact", timestep=2e-4),
        speed=0.1,
        caption="A light hoop with a heavy bar on its rim, pushed at 16 rad/s with the bar on top, on level ground. "
        "Soon nothing presses it down, and it skims: it leaves the ground by less than a millimetre and lands, many "
        "times a second. Each landing is a blow; N is the mean over 10 ms. When the bar comes up, the hoop hops a "
        "radius high.",
        still=0.24,
        look=Look(
            "Why does a hoop fly? The bar on its rim lifts it",
            ("lift", "normal"),
            ("paths", "normal"),
            notes=("flies", "heavy", "light"),
        ),
    ),
    "carry": Carry(),
}
"""The films by the names of their files."""
COMMANDS = {
    "sliding": "mjbeer render sliding --can metal --phi0 60 --duration 1.2 --tolerance 1e-9 --speed 0.25",
    "frozen": "mjbeer render frozen --phi0 180 --duration 0.82 --tolerance 1e-9 --speed 0.2",
    "pendulum": "mjbeer render pendulum --phi0 60 --duration 1.5 --tolerance 1e-9 --speed 0.25",
    "hoop": "mjbeer render hoop --phi0 -171.8873 --phi-dot0 916.7325 --duration 0.5 --rolling contact --timestep 2e-4 "
    "--speed 0.1",
}
"""The command that draws a film by itself; the others are drawn by `mjbeer report` alone."""


def film_jobs(folder: pathlib.Path, quick: bool) -> list[FilmJob]:
    """Return the films of the scenes and, unless it must be quick, of the stories, to be drawn into a folder."""
    size = _SMALL if quick else stories.SIZE
    drawn = [FilmJob(film, folder / f"{name}.mp4", *size) for name, film in FILMS.items()]
    return drawn if quick else drawn + stories.films(folder)
