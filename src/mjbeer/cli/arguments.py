"""What follows a command: options of scenes, starts, runs and studies, in degrees for angles and in SI units otherwise.

A scene has the options that its function in Python has, with the same defaults; only their meanings are written here.
"""

import inspect
import math
import re
from argparse import ArgumentTypeError, Namespace
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from mjbeer.drawing.camera import CAMERAS
from mjbeer.exceptions import ParameterError
from mjbeer.model.setting import LOOKS, MJBEER_INTEGRATORS, MUJOCO_INTEGRATORS, ROLLINGS, Setting
from mjbeer.output.terminal import say
from mjbeer.studies.benchmark.points import CASES
from mjbeer.theory.can import LENGTH, RADIUS, Can
from mjbeer.theory.liquid import NAMES, liquid, liquid_in
from mjbeer.theory.scene import DURATION, Scene, frozen, hoop, pendulum, sliding
from mjbeer.theory.standing import standing

SCENES: dict[str, Callable[..., Scene]] = {each.__name__: each for each in (sliding, liquid, frozen, pendulum, hoop)}
STANDING = {"standing": standing}
_CANS = {"massless": Can.massless, "metal": Can.sheet_metal}
_MEANINGS = {  # of the options of scenes, in the order of the help
    "incline": "angle of the incline to the horizontal [degrees]; if positive, u grows downhill",
    "fill": "height of the load as a fraction of the can's diameter, or of the length of a can that stands",
    "can": "massless (section 2 of the paper), or metal, of aluminium sheet 0.1 mm thick (section 3)",
    "radius": "radius of the can [m]",
    "length": "length of the can [m]",
    "liquid": "the liquid, at 20 degrees Celsius",
    "density": "density of beer [kg/m^3], or of a liquid if it is not its own",
    "viscosity": "kinematic viscosity [m^2/s] if it is not the liquid's own; water has 1e-6",
    "gravity": "acceleration of gravity [m/s^2]",
    "damping": "torque between can and beer over the rate at which the can turns faster than the beer [N m s]",
    "drag": "force of the air against the motion over the square of the speed [kg/m]",
    "wheel_mass": "mass of the wheel [kg]",
    "hoop_mass": "mass of the hoop [kg]",
    "load_mass": "mass of the load: a pendulum's bob, or a weight on a rim [kg]",
    "offset": "length of the pendulum, from the axle to the bob [m]",
    "modes": "modes of the slosh that move, from 0 (solid) to 5",
    "damping_ratio": "damping of each mode over the critical one; by default what the viscosity gives",
}


def angle(text: str) -> float:
    """Read an angle in degrees, or a rate in degrees/s, as one in radians."""
    if not math.isfinite(degrees := float(text)):
        raise ArgumentTypeError(f"it must be a finite number [degrees], got {text}")
    return math.radians(degrees)


def numbers(text: str) -> float | np.ndarray:
    """Read a number as "3", or several as "1,2,5" or as "1:20:39", which is 39 numbers from 1 to 20."""
    try:
        if ":" in text:
            first, last, count = text.split(":")
            read = np.linspace(float(first), float(last), int(count))
        else:
            read = np.array(text.split(","), float)
        if not (read.size and np.isfinite(read).all()):
            raise ValueError
    except ValueError:
        allowed = "no number, no list as 1,2,5, and no range as 1:20:39, which is 39 numbers from 1 to 20"
        raise ArgumentTypeError(f"{text!r} is {allowed}") from None
    return read if read.size > 1 else float(read[0])


def angles(text: str) -> float | np.ndarray:
    """Read `numbers` in degrees as ones in radians."""
    return np.radians(numbers(text))


def known(text: str) -> tuple[str, tuple[float, float]]:
    """Read a measured value with its error, as "fill=0.5±0.005" or "incline=2+-0.1" [degrees]."""
    try:
        name, value, error = re.split(r"=|±|\+-", text)
        unit = math.radians(1) if name in ("incline", "phi0", "turned") else 1.0
        return name, (unit * float(value), unit * float(error))
    except ValueError:
        raise ArgumentTypeError(f"{text!r} is no value with its error, as fill=0.5±0.005") from None


class Option(NamedTuple):
    """An option, or a word if its name has no dashes; of several values if its default is a list, of none if False."""

    name: str
    help: str
    default: Any = None
    kind: Any = float
    """A function that reads a value, also the default if that is a text; or all values that are allowed."""


_MODEL = (
    Option("--rolling", "reduced coordinates (default), joint equality (default to view), or contact", None, ROLLINGS),
    Option(
        "--integrator",
        "MuJoCo's or mjbeer's; by default RK4, or what keeps a tolerance",
        None,
        MUJOCO_INTEGRATORS + MJBEER_INTEGRATORS,
    ),
    Option("--timestep", "timestep; with a tolerance, interval between samples [s]", Setting.timestep),
    Option("--friction", "coefficient of friction: a contact slips beyond it", Setting.friction),
)
_RUN = (
    Option("--duration", "duration of the motion [s]", DURATION),
    Option("--tolerance", "largest error in phi and u/radius [rad]; a sweep without an integrator takes 1e-6"),
    *_MODEL,
)
_JSON = Option("--json", "print the results as JSON", False)
_FOLDER = "folder to write to, which is new, empty, or this command's own"
OPTIONS = {  # of each command; if a scene comes first, these come after that of the scene
    "simulate": (*_RUN, Option("--output", 'CSV file to write; "-" is standard output', None, Path), _JSON),
    "render": (
        *_RUN,
        Option("--output", "MP4 file to write", "mjbeer.mp4", Path),
        Option("--speed", "playback speed: 1 is real time, 0.25 is four times slower", 1.0),
        Option(
            "--camera", "fixed, pan (moves along evenly), or auto (pan where the can would be small)", "auto", CAMERAS
        ),
        Option("--width", "width of the video [pixels]", 1280, int),
        Option("--height", "height of the video [pixels]", 720, int),
    ),
    "view": _MODEL,
    "export": (
        *_MODEL,
        Option("--output", 'MJCF file to write (.xml); its keyframe "start" is the start', "can.xml", Path),
        Option("--looks", "plain, in a file of 10 kB, or full, as mjbeer draws it", "plain", LOOKS),
        Option("--portable", "write MJCF that other tools load too: docs/portability.md has each tool's error", False),
    ),
    "fit": (
        Option("--free", "what is sought, of incline, fill, damping, drag; a scene's options are guesses", [], str),
        Option("--known", "measured values with their errors, as fill=0.5±0.005 [incline in degrees]", [], known),
        Option("--phi0", "the load's angle when it is let go: level, free, or a number [degrees]", "level", str),
        Option("--bend", "bend of the track by a lens [m]; by default 5 mm, or 1/400 of a short way"),
        Option("--columns", "columns by heading or number, as time=1 x=3; by default the usual headings", [], str),
        Option("--rate", "pictures per second, where frames are numbered and have no times [1/s]"),
        Option("--output", "plot (.svg, .png) or film (.mp4) to write", None, Path),
        _JSON,
    ),
    "sweep": (
        *_RUN,
        Option("--quantity", "plotted, as phi, u, error or period; files have all, the last if asked for", "phi", str),
        Option("--output", "plot (.png, .svg), table (.csv), or NetCDF (.nc), which is resumed", "sweep.png", Path),
    ),
    "validate": (Option("--table", "print every row, not only those that failed", False), _JSON),
    "benchmark": (
        Option("scenes", f"of {', '.join(CASES)}; by default all", [], str),
        Option("--output", _FOLDER, "benchmark", Path),
        Option("--quick", "try fewer timesteps and tolerances; takes two minutes", False),
    ),
    "stability": (
        Option("--output", f"{_FOLDER}; an interrupted study in it is continued", "stability", Path),
        Option("--quick", "coarser maps, 250 random runs, not 3000; two minutes", False),
        _JSON,
    ),
    "paper": (Option("--output", _FOLDER, "paper", Path), Option("--films", "also draw films of the motions", False)),
    "report": (
        Option("--output", _FOLDER, "report", Path),
        Option("--quick", "draw smaller videos with fewer frames, and no films for the paper's scenarios", False),
    ),
}


_ROLLS = ("--rolling", "--friction", "--tolerance", "--camera")
"""Options that a can that stands does not have: they are those of a can that rolls."""


def of_scene(name: str, command: str) -> list[Option]:
    """Return the options of a scene and of its start, and then those of a command; a sweep takes several numbers."""
    number, degrees = (numbers, angles) if command == "sweep" else (float, angle)
    kinds = {"can": tuple(_CANS), "liquid": NAMES, "incline": degrees, "modes": int}
    given = {each.name: each.default for each in inspect.signature((SCENES | STANDING)[name]).parameters.values()}
    if "can" in given:
        given |= {"can": "metal" if name == "standing" else "massless", "radius": RADIUS, "length": LENGTH}
    if name == "liquid":
        given["liquid"] = given["name"]
    if "incline" in given:
        given["incline"] = f"{math.degrees(given['incline']):.9g}"
    own = [
        Option("--" + each.replace("_", "-"), text, given[each], kinds.get(each, number))
        for each, text in _MEANINGS.items()
        if each in given
    ]
    if name == "standing":
        return [*own, *(each for each in OPTIONS[command] if each.name not in _ROLLS)]
    if command != "fit":
        own.append(Option("--phi0", "initial phi [degrees]: 0 with the load nearest to the incline", "60", degrees))
        own.append(Option("--phi-dot0", "initial rate of change of phi [degrees/s]", "0", degrees))
    return [*own, *OPTIONS[command]]


def steps(given: Namespace) -> dict[str, Any]:
    """Return how a scene is modelled and stepped, where that is given."""
    names = ("rolling", "integrator", "timestep", "tolerance", "friction")
    return {name: value for name, value in vars(given).items() if name in names and value is not None}


def start(given: Namespace) -> dict[str, Any]:
    """Return the initial phi0 [rad] and phi_dot0 [rad/s], and say so if phi0 looks like radians, as 3.14159."""
    if given.scene == "standing":
        return {}
    degrees = np.round(np.degrees(given.phi0), 9)
    if degrees.ndim == 0 and abs(degrees) < 10 and round(degrees, 2) != degrees:
        say(f"note: phi0 = {degrees:g} is taken as degrees; that many radians are {math.degrees(degrees):.6g} degrees")
    return {"phi0": given.phi0, "phi_dot0": given.phi_dot0}


def scene_arguments(given: Namespace) -> dict[str, Any]:
    """Return the options of the scene, as `make` takes them, after a check of the one that is given in degrees."""
    for degrees in np.degrees(getattr(given, "incline", [])).ravel():
        if not abs(degrees) < 90:
            raise ParameterError(f"incline must be between -90 and 90 [degrees], got {degrees:.9g}")
    return {name: getattr(given, name) for name in _MEANINGS if hasattr(given, name)}


def make(function: Callable[..., Any], **options: Any) -> Any:
    """Call a function that makes a scene with the options of the command line."""
    if "can" in options:
        options["can"] = _CANS[options["can"]](options.pop("radius"), options.pop("length"))
    if function in (liquid, liquid_in):
        options["name"] = options.pop("liquid")
    return function(**options)


def scene(given: Namespace) -> Any:
    """Return the scene or the standing can that was asked for, and say what a liquid takes that was not given."""
    options = scene_arguments(given)
    if given.scene == "liquid":
        say(str(make(liquid_in, **{name: value for name, value in options.items() if name != "drag"})))
    return make((SCENES | STANDING)[given.scene], **options)
