"""The films of the report, in the order in which the page shows them, and how to draw them."""

import math
import pathlib
from functools import partial

from mjbeer.drawing.film import MotionFilm
from mjbeer.drawing.overlay import Look
from mjbeer.drawing.race import Race
from mjbeer.drawing.video import FilmJob
from mjbeer.paper import stories
from mjbeer.report import races
from mjbeer.report.carry import Carry
from mjbeer.simulation.simulate import simulate
from mjbeer.theory.scenes import frozen, hoop, pendulum, sliding

FILMS: dict[str, Race | MotionFilm | Carry] = {
    "race": Race(
        "Which can wins?",
        races.of_beer,
        length=races.LENGTH,
        speed=0.25,
        told=races.told_of_beer,
        still=1.4,
        duration=2.3,
    ),
    "liquids": Race(
        "Water, oil, honey or ice: which can wins, and which is last?",
        races.of_liquids,
        length=races.LENGTH,
        speed=1 / 3,
        told=races.told_of_liquids,
        still=2.2,
        duration=2.72,
        facts="all cans ¾ full; here each liquid is one lump, and stays at the bottom",
    ),
    "sliding": MotionFilm(
        partial(simulate, sliding(can=races.METAL), 1.2, math.radians(60), tolerance=1e-9),
        speed=0.25,
        caption="Half a can of beer, let go at φ = 60°. The beer slides in its can without friction and swings. The "
        "can goes to and fro about the dashed one, which accelerates evenly: it hesitates with every swing. The camera "
        "moves along evenly.",
        still=0.4,
        look=Look(
            "Beer slides in its can, and the can hesitates", ("u_dot", "ahead"), ("phi", "ghost"), notes=("hesitates",)
        ),
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
        look=Look(
            "A pendulum in a wheel: does the wheel roll evenly?",
            ("u_dot", "ahead"),
            ("phi", "ghost"),
            notes=("hesitates",),
        ),
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
RACES = ("race", "liquids")  # the films that the page shows first
COMMANDS = {
    "sliding": "mjbeer render sliding --can metal --phi0 60 --duration 1.2 --tolerance 1e-9 --speed 0.25",
    "frozen": "mjbeer render frozen --phi0 180 --duration 0.82 --tolerance 1e-9 --speed 0.2",
    "pendulum": "mjbeer render pendulum --phi0 60 --duration 1.5 --tolerance 1e-9 --speed 0.25",
    "hoop": "mjbeer render hoop --phi0 -171.8873 --phi-dot0 916.7325 --duration 0.5 --rolling contact --timestep 2e-4 "
    "--speed 0.1",
}
"""The command that draws a film by itself; the others are drawn by `mjbeer report` alone."""
_SMALL = 640, 360, 25  # width and height [pixels] and pictures per second in a quick report


def film_jobs(folder: pathlib.Path, quick: bool) -> list[FilmJob]:
    """Return the films of the scenes and, unless it must be quick, of the stories, to be drawn into a folder."""
    size = _SMALL if quick else stories.SIZE
    drawn = [FilmJob(film, folder / f"{name}.mp4", *size) for name, film in FILMS.items()]
    return drawn if quick else drawn + stories.films(folder)
