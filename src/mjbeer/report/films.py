"""The films of the report in the order of the page: races and motions, with their captions."""

import math
import pathlib
from collections.abc import Sequence
from functools import partial
from typing import Any

import numpy as np

from mjbeer.drawing.film import Film, MotionFilm
from mjbeer.drawing.race import Race, Runner
from mjbeer.drawing.style import FilmStyle
from mjbeer.drawing.video import FilmJob
from mjbeer.paper import stories
from mjbeer.report.carry import Carry
from mjbeer.simulation.simulate import simulate
from mjbeer.theory.can import Can
from mjbeer.theory.liquid import centrifugal_ratio, liquid
from mjbeer.theory.paper_scenes import frozen, hoop, pendulum, sliding
from mjbeer.theory.scene import Scene
from mjbeer.theory.trajectory import Trajectory

METAL = Can.sheet_metal()
LENGTH = 1.0
"""Distance from start to finish of a race [m]."""
_GENTLE = math.radians(5)
"""Incline of the race of beer [rad], on which the frozen can stays on the board."""
_STEEPER = math.radians(7.1)
"""Incline of the race of liquids [rad].

Let go with a level surface, ice rolls over the top from 6.93 degrees on, and honey from 7.38."""
_FILL = 0.75
"""How full the cans are that are neither full nor empty."""
_ICE = 917.0
"""Density of ice [kg/m^3]."""
WITH_LIQUID: Any = {"incline": _STEEPER, "fill": _FILL, "can": METAL}
"""What `liquid` takes, besides its name, for a can of the race of liquids."""
_hesitating = partial(
    FilmStyle, strips=("u_dot", "ahead"), marks=("phi", "ghost"), notes=("hesitates",)
)
"""The style of a film, by its title, of a can that hesitates in every swing of its load."""
HOP = partial(
    simulate,
    hoop(hoop_mass=0.06),
    duration=0.26,
    phi0=math.radians(-90),
    phi_dot0=math.radians(1700),
    rolling="contact",
    timestep=1e-4,
    friction=0.01,
)
"""A hop whose height does not depend on the timestep. It would if the hoop skimmed the ground, or
gripped and slipped in turn."""
_SMALL = (640, 360, 25)
"""Width and height [pixels] and pictures per second in a quick report."""


def _rough_from(motion: Trajectory) -> str:
    """Return from when on a liquid is too fast to stay at the bottom, in words."""
    is_beyond = np.asarray(centrifugal_ratio(motion.scene, motion.u_dot)) > 1
    return f"rough from {motion.time[is_beyond][0]:.2f} s on"


def of_beer() -> Sequence[Runner]:
    """Return the cans of the race of beer that slides, frozen beer, and none."""
    slides = sliding(_GENTLE, can=METAL, fill=_FILL)
    is_frozen = frozen(_GENTLE, can=METAL, fill=_FILL)
    is_full = frozen(_GENTLE, can=METAL, fill=1.0)
    # There is no can without a load: that of the empty one weighs a thousandth of the can.
    is_empty = sliding(_GENTLE, can=METAL, fill=0.01, density=12.5)
    return [
        Runner(
            "beer slides",
            _race(slides, 30),
            colour=(0.75, 0.38, 0.0),
            note="¾ full, from φ = 30°",
        ),
        Runner(
            "beer frozen",
            _race(is_frozen, 180),
            colour=(0.15, 0.42, 0.72),
            note="¾ full, beer on top",
        ),
        Runner("beer frozen, full", _race(is_full, 0), colour=(0.40, 0.25, 0.60)),
        Runner(
            "empty",
            _race(is_empty, 0),
            colour=(0.30, 0.33, 0.37),
            load=(0.45, 0.46, 0.47),  # as the inside of the can, to be no more seen than it weighs
        ),
    ]


def _race(scene: Scene, degrees: float) -> Trajectory:
    return simulate(scene, 2.35, math.radians(degrees), tolerance=1e-9)


def of_liquids() -> Sequence[Runner]:
    """Return the cans of the race of water, oil, honey and ice, all let go with a level surface."""
    water = liquid("water", **WITH_LIQUID)
    oil = liquid("olive oil", **WITH_LIQUID)
    honey = liquid("honey", **WITH_LIQUID)
    ice = frozen(_STEEPER, _FILL, METAL, _ICE)
    # Each is simulated until it is out of the picture.
    of_water = _race_from_level(water, 1.6)
    of_oil = _race_from_level(oil, 2.1)
    return [
        Runner(
            "water",
            of_water,
            colour=(0.08, 0.40, 0.72),
            load=(0.36, 0.66, 0.93),
            note=_rough_from(of_water),
        ),
        Runner(
            "olive oil",
            of_oil,
            colour=(0.42, 0.45, 0.05),
            load=(0.78, 0.76, 0.20),
            note=_rough_from(of_oil),
        ),
        Runner(
            "honey",
            _race_from_level(honey, 24.5),
            colour=(0.72, 0.38, 0.0),
            load=(0.88, 0.52, 0.05),
            note="rough",
        ),
        Runner(
            "ice",
            _race_from_level(ice, 2.5),
            colour=(0.40, 0.42, 0.55),
            load=(0.84, 0.93, 0.98),
        ),
    ]


def _race_from_level(scene: Scene, duration: float) -> Trajectory:
    return simulate(scene, duration, -_STEEPER, tolerance=1e-9)


FILMS: dict[str, Film] = {
    "race": Race(
        "Which can wins?",
        of_beer,
        length=LENGTH,
        duration=2.3,
        speed=0.25,
        hold=1.5,
        still=0.0,  # who wins is to be predicted
        caption="Four equal cans race over one metre on an incline of 5 degrees, and each is held "
        "at the finish; below is the near end of each. The can whose beer slides wins: its beer "
        "swings to and fro by 30 degrees but does not turn with the can, so that almost nothing "
        "is spent on turning. Frozen beer must turn with its can: the full can is as slow as a "
        "solid cylinder, with two thirds of the winner's acceleration. The frozen can that is "
        "three quarters full starts with its beer on top, for else it would stay where it is, and "
        "this is why it beats the full one: its load falls from the top, which gives it speed at "
        "once. Without that start it would need 1.85 s, the full one 1.88 s. At first it even "
        "leads, by two centimetres, but not for half of the way. The empty can comes last, since "
        "most of its mass is in its wall.",
    ),
    "liquids": Race(
        "Water, oil, honey or ice: which can wins, and which is last?",
        of_liquids,
        length=LENGTH,
        duration=2.72,
        facts="¾ full; rough: beyond the model's range",
        speed=1 / 3,
        hold=1.5,
        still=0.0,
        caption="Predict first, then look. Four equal cans, three quarters full, are let go "
        "together on an incline of 7.1°, each with its surface level; below is the near end of "
        "each. Water hardly rubs against its can, and wins after about 1.3 s; oil follows after "
        "about 1.6 s. Ice turns with its can: it hesitates with its load nearly on top, rolls "
        "over, and finishes after 2.32 s. Honey needs about 21 s: it rubs, which takes all that "
        "the incline gives, and creeps with about 4.5 cm/s. When the ice arrives it has come 15 "
        "cm. The model takes each liquid for one body that keeps its shape. Real water does not "
        "after 0.48 s, nor oil after 0.59 s: the can then turns so fast that it can carry them "
        "all the way round. The wall can carry 30 % of real honey round, too. So the times with ≈ "
        "are rough; honey is last with half or twice its viscosity as well.",
    ),
    "sliding": MotionFilm(
        partial(simulate, sliding(can=METAL), 1.2, math.radians(60), tolerance=1e-9),
        speed=0.25,
        caption="Half a can of beer, let go at φ = 60°, slides in its can without friction and "
        "swings. The can goes to and fro about the dashed one, which accelerates evenly: it "
        "hesitates with every swing.",
        still=0.4,
        style=_hesitating("Beer slides in its can, and the can hesitates"),
    ),
    "frozen": MotionFilm(
        partial(simulate, frozen(), 0.82, math.pi, tolerance=1e-9),
        speed=0.2,
        caption="Frozen beer is let go on top, and rolls down ever faster, in jerks. N is the "
        "force with which the incline presses on the can. Whenever the beer goes "
        "through below, N is more than twice the weight, and in between it is less. From 0.834 s "
        "on the incline would have to pull the can for it to keep rolling: there it lifts off, and "
        "the film ends just before. The film slip-and-hop shows what comes then.",
        hold=2.0,
        still=0.55,
        style=FilmStyle(
            "Frozen beer rolls down in jerks",
            strips=("normal", "u"),
            marks=("paths", "normal"),
            camera="pan",
            notes=("heavy", "light"),
            facts="let go on top",
            answer="next, at 0.83 s, the beer lifts its can off: see the film slip-and-hop",
        ),
    ),
    "pendulum": MotionFilm(
        partial(simulate, pendulum(), 1.5, math.radians(60), tolerance=1e-9),
        speed=0.25,
        caption="The wheel goes to and fro about the dashed one, which accelerates evenly: it "
        "hesitates whenever its bob is uphill, and runs ahead whenever it is downhill, for "
        "nothing but their weight drives them together.",
        still=0.4,
        hold=2.0,
        style=_hesitating(
            "A pendulum in a wheel: does the wheel roll evenly?",
            answer="No: whenever the bob swings uphill, the wheel hesitates",
        ),
    ),
    "hoop": MotionFilm(
        HOP,
        speed=0.06,
        caption="A hoop of 60 g with a bar of 200 g on its rim is pushed on ice (μ = 0.01), with "
        "the bar in front, and turns at 1700° per second. As the bar goes through below, the hoop "
        "presses on the ice with 9.4 times the weight of both (mean of 5 ms). After "
        "0.10 s the bar comes up behind and lifts the hoop, which flies 34 mm high: about its "
        "radius. The charts shade when the bar presses, when it pulls, and when the hoop flies. "
        "The film ends just before the landing.",
        still=0.2,
        style=FilmStyle(
            "Why does a hoop on ice fly? The bar on its rim lifts it",
            strips=("lift", "normal"),
            marks=("paths", "normal"),
            camera="fixed",
            notes=("flies", "heavy", "light"),
            notes_aside=True,
            facts="1700°/s at first, μ = 0.01",
        ),
    ),
    "carry": Carry(),
}
"""The films by the names of their files."""
COMMANDS = {
    "sliding": "mjbeer render sliding --can metal --phi0 60 --duration 1.2 --tolerance 1e-9 "
    "--speed 0.25",
    "frozen": "mjbeer render frozen --phi0 180 --duration 0.82 --tolerance 1e-9 --speed 0.2",
    "pendulum": "mjbeer render pendulum --phi0 60 --duration 1.5 --tolerance 1e-9 --speed 0.25",
    "hoop": "mjbeer render hoop --hoop-mass 0.06 --phi0 -90 --phi-dot0 1700 --duration 0.26 "
    "--rolling contact --friction 0.01 --timestep 1e-4 --speed 0.06",
}
"""Commands that draw a film by itself; `mjbeer report` draws the others."""


def film_jobs(folder: pathlib.Path, quick: bool) -> list[FilmJob]:
    """Return the films of the scenes and, unless it is quick, of the stories in a folder."""
    size = _SMALL if quick else stories.SIZE
    jobs = [FilmJob(film, folder / f"{name}.mp4", *size) for name, film in FILMS.items()]
    return jobs if quick else jobs + stories.films(folder)
