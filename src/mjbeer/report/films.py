"""The films of the report in the order of the page: the motions, the races, and what is told of them."""

import math
import pathlib
from collections.abc import Sequence
from functools import partial
from typing import Any

from mjbeer.drawing.film import Film, MotionFilm
from mjbeer.drawing.race import Race, Runner
from mjbeer.drawing.style import FilmStyle
from mjbeer.drawing.video import FilmJob
from mjbeer.paper import stories
from mjbeer.report.carry import Carry
from mjbeer.simulation.simulate import simulate
from mjbeer.theory.can import Can
from mjbeer.theory.liquid import liquid
from mjbeer.theory.scene import frozen, hoop, pendulum, sliding

METAL = Can.sheet_metal()
LENGTH = 1.0  # distance from start to finish [m]
_GENTLE = math.radians(5)  # incline of the race of beer [rad], on which the frozen can stays on the board
_STEEPER = math.radians(7.1)
"""Incline of the race of liquids [rad]: let go with a level surface, ice rolls over the top from 6.93 degrees on, and
honey, the thickest of the liquids, from 7.38."""
_FILL = 0.75  # how full the cans are that are neither full nor empty
_EMPTY: Any = {"fill": 0.01, "density": 12.5}  # of the empty can: what is in it weighs a thousandth of the can
_ICE = 917.0  # density of ice [kg/m^3]
WITH_LIQUID: Any = {"incline": _STEEPER, "fill": _FILL, "can": METAL}
_HESITATES: Any = {"strips": ("u_dot", "ahead"), "marks": ("phi", "ghost"), "notes": ("hesitates",)}
HOP = partial(
    simulate,
    hoop(hoop_mass=0.06),
    0.26,
    math.radians(-90),
    math.radians(1700),
    rolling="contact",
    timestep=1e-4,
    friction=0.01,
)
"""A hop whose height does not hang on the timestep, as it does where a hoop skims, or grips and slips in turn."""
_SMALL = 640, 360, 25  # width and height [pixels] and pictures per second in a quick report


def of_beer() -> Sequence[Runner]:
    """Return the cans of the race of beer that slides, frozen beer, and none."""
    cans = (
        ("beer slides", sliding(_GENTLE, can=METAL, fill=_FILL), 30, (0.75, 0.38, 0.0), "¾ full, starts at φ = 30°"),
        ("beer frozen", frozen(_GENTLE, can=METAL, fill=_FILL), 180, (0.15, 0.42, 0.72), "¾ full, starts upside down"),
        ("beer frozen, full", frozen(_GENTLE, can=METAL, fill=1.0), 0, (0.40, 0.25, 0.60), ""),
        ("empty", sliding(_GENTLE, can=METAL, **_EMPTY), 0, (0.30, 0.33, 0.37), ""),
    )
    return [
        Runner(name, simulate(scene, 2.35, math.radians(phi0), tolerance=1e-9), colour, note=note)
        for name, scene, phi0, colour, note in cans
    ]


def of_liquids() -> Sequence[Runner]:
    """Return the cans of the race of water, oil, honey and ice, all let go with a level surface."""
    cans = (  # each until it is out of the picture
        ("water", liquid("water", **WITH_LIQUID), 1.6, (0.08, 0.40, 0.72), (0.36, 0.66, 0.93)),
        ("olive oil", liquid("olive oil", **WITH_LIQUID), 2.1, (0.42, 0.45, 0.05), (0.78, 0.76, 0.20)),
        ("honey", liquid("honey", **WITH_LIQUID), 24.5, (0.72, 0.38, 0.0), (0.88, 0.52, 0.05)),
        ("ice", frozen(_STEEPER, _FILL, METAL, _ICE), 2.5, (0.40, 0.42, 0.55), (0.84, 0.93, 0.98)),
    )
    return [
        Runner(name, simulate(scene, end, -_STEEPER, tolerance=1e-9), colour, load)
        for name, scene, end, colour, load in cans
    ]


FILMS: dict[str, Film] = {  # by the names of their files
    "race": Race(
        *("Which can wins?", of_beer, LENGTH, 2.3),
        speed=0.25,
        still=1.4,
        caption="Four equal cans race over one metre on an incline of 5 degrees. The can whose beer slides wins: its "
        "beer swings to and fro by 30 degrees but does not turn with the can, so that almost nothing is spent on "
        "turning. Frozen beer must turn with its can: the full can is as slow as a solid cylinder, with two thirds of "
        "the winner's acceleration. The frozen can that is three quarters full starts with its beer on top, for else "
        "it would stay where it is; its lead of two centimetres is gone before half-way. The empty can comes last, "
        "since most of its mass is in its wall.",
    ),
    "liquids": Race(
        *("Water, oil, honey or ice: which can wins, and which is last?", of_liquids, LENGTH, 2.72),
        facts="all cans ¾ full, each liquid one lump",
        speed=1 / 3,
        still=2.2,
        caption="Predict first, then look. Four equal cans, three quarters full, are let go together on an incline of "
        "7.1°, each with its surface level. Water hardly rubs against its can, and ice turns with it. Water wins after "
        "1.33 s, and oil follows after 1.63 s. The ice hesitates with its load nearly on top, rolls over, and finishes "
        "after 2.32 s. The honey is last: when the ice arrives it has come 15 cm, and it needs 21.47 s. It neither "
        "slides freely nor turns with its can, and as it rubs it takes all that the incline gives: it creeps with 4.5 "
        "cm/s. Each liquid is one lump here, and the times are this model's: real water and oil are soon so fast that "
        "they need not stay at the bottom, and of real honey the wall carries up to 30 % round with it. With half or "
        "twice the viscosity honey is last as well.",
    ),
    "sliding": MotionFilm(
        partial(simulate, sliding(can=METAL), 1.2, math.radians(60), tolerance=1e-9),
        speed=0.25,
        caption="Half a can of beer, let go at φ = 60°, slides in its can without friction and swings. The can goes to "
        "and fro about the dashed one, which accelerates evenly: it hesitates with every swing.",
        still=0.4,
        style=FilmStyle("Beer slides in its can, and the can hesitates", **_HESITATES),
    ),
    "frozen": MotionFilm(
        partial(simulate, frozen(), 0.82, math.pi, tolerance=1e-9),
        speed=0.2,
        caption="Frozen beer is let go on top, and rolls down ever faster, in jerks. The film ends just before the can "
        "would leave the incline.",
        still=0.55,
        style=FilmStyle(
            "Frozen beer rolls down in jerks",
            ("normal", "u"),
            ("paths", "normal", "friction"),
            notes=("heavy", "light"),
        ),
    ),
    "pendulum": MotionFilm(
        partial(simulate, pendulum(), 1.5, math.radians(60), tolerance=1e-9),
        speed=0.25,
        caption="The wheel goes to and fro about the dashed one, which accelerates evenly: it hesitates whenever its "
        "bob is uphill, and runs ahead whenever it is downhill, for nothing but their weight drives them together.",
        still=0.4,
        style=FilmStyle("A pendulum in a wheel: does the wheel roll evenly?", **_HESITATES),
    ),
    "hoop": MotionFilm(
        HOP,
        speed=0.06,
        caption="A hoop of 60 g with a bar of 200 g on its rim is pushed on ice (μ = 0.01), with the bar in front, and "
        "turns at 1700° per second. As the bar goes through below, the hoop presses on the ice with 9.4 times the "
        "weight of both. After 0.10 s the bar comes up behind and lifts the hoop, which flies 34 mm high: about its "
        "radius. The film ends just before the landing.",
        still=0.2,
        style=FilmStyle(
            "Why does a hoop fly? The bar on its rim lifts it",
            ("lift", "normal"),
            ("paths", "normal"),
            notes=("flies", "heavy", "light"),
        ),
    ),
    "carry": Carry(),
}
COMMANDS = {  # that draw a film by itself; `mjbeer report` draws the others
    "sliding": "mjbeer render sliding --can metal --phi0 60 --duration 1.2 --tolerance 1e-9 --speed 0.25",
    "frozen": "mjbeer render frozen --phi0 180 --duration 0.82 --tolerance 1e-9 --speed 0.2",
    "pendulum": "mjbeer render pendulum --phi0 60 --duration 1.5 --tolerance 1e-9 --speed 0.25",
    "hoop": "mjbeer render hoop --hoop-mass 0.06 --phi0 -90 --phi-dot0 1700 --duration 0.26 --rolling contact "
    "--friction 0.01 --timestep 1e-4 --speed 0.06",
}


def film_jobs(folder: pathlib.Path, quick: bool) -> list[FilmJob]:
    """Return the films of the scenes and, unless it must be quick, of the stories, to be drawn into a folder."""
    size = _SMALL if quick else stories.SIZE
    drawn = [FilmJob(film, folder / f"{name}.mp4", *size) for name, film in FILMS.items()]
    return drawn if quick else drawn + stories.films(folder)
