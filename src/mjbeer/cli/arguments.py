"""What follows a command: options of scenes, starts, runs and studies, in degrees and SI units.

A scene has the options that its function in Python has, with the same defaults; only their meanings
are written here.
"""

import inspect
import math
import re
from argparse import ArgumentTypeError, Namespace
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from mjbeer import require
from mjbeer.drawing.camera import CAMERAS
from mjbeer.exceptions import ParameterError
from mjbeer.model.setting import LOOKS, MJBEER_INTEGRATORS, MUJOCO_INTEGRATORS, ROLLINGS, Setting
from mjbeer.output.terminal import say
from mjbeer.studies.benchmark.points import CASES
from mjbeer.theory.can import LENGTH, RADIUS, Can
from mjbeer.theory.liquid import liquid, liquid_in
from mjbeer.theory.liquid_properties import NAMES
from mjbeer.theory.paper_scenes import frozen, hoop, pendulum, sliding
from mjbeer.theory.scene import DURATION, Scene
from mjbeer.theory.standing import standing

SCENES: dict[str, Callable[..., Scene]] = {
    "sliding": sliding,
    "liquid": liquid,
    "frozen": frozen,
    "pendulum": pendulum,
    "hoop": hoop,
}
STANDING = {"standing": standing}
_CANS = {"massless": Can.massless, "metal": Can.sheet_metal}
_MEANINGS = {
    "incline": "angle of the incline to the horizontal [degrees]; if positive, u grows downhill",
    "fill": "height of the load as a fraction of the can's diameter, "
    "or of the length of a can that stands",
    "can": "massless (section 2 of the paper), "
    "or metal, of aluminium sheet 0.1 mm thick (section 3)",
    "can_mass": "mass of the can [kg] if it is not that of --can; "
    "it is then spread as in metal sheet",
    "radius": "radius of the can [m]",
    "length": "length of the can [m]",
    "liquid": "the liquid, at 20 degrees Celsius",
    "density": "density of the beer, or of the liquid if it is not its own [kg/m^3]",
    "viscosity": "kinematic viscosity [m^2/s] if it is not the liquid's own; water has 1e-6",
    "gravity": "acceleration of gravity [m/s^2]",
    "damping": "torque between can and beer, divided by the rate at which the can turns faster "
    "than the beer [N m s]",
    "drag": "force of the air against the motion, divided by the square of the speed [kg/m]",
    "wheel_mass": "mass of the wheel [kg]",
    "hoop_mass": "mass of the hoop [kg]",
    "load_mass": "mass of the load: a pendulum's bob, or a weight on a rim [kg]",
    "offset": "length of the pendulum, from the axle to the bob [m]",
    "modes": "modes of the slosh that move, from 0 (solid) to 5",
    "damping_ratio": "damping of each mode, divided by the critical one; "
    "by default what the viscosity gives",
}
"""What each option of a scene means, in the order of the help."""


def angle(text: str) -> float:
    """Read an angle in degrees, or a rate in degrees/s, as one in radians."""
    degrees = float(text)
    if not math.isfinite(degrees):
        raise ArgumentTypeError(f"it must be a finite number [degrees], got {text}")
    return math.radians(degrees)


def numbers(text: str) -> float | np.ndarray:
    """Read one number, as "3", or several: "1,2,5", or "1:20:39" for 39 numbers from 1 to 20."""
    try:
        if ":" in text:
            first, last, count = text.split(":")
            values = np.linspace(float(first), float(last), int(count))
        else:
            values = np.array(text.split(","), float)
        if not (values.size and np.isfinite(values).all()):
            raise ValueError
    except ValueError:
        raise ArgumentTypeError(
            "it must be a number, a list such as 1,2,5, or a range such as 1:20:39 "
            f"(39 numbers from 1 to 20), got {text!r}"
        ) from None
    return values if values.size > 1 else float(values[0])


def angles(text: str) -> float | np.ndarray:
    """Read one angle or several in degrees, written as for `numbers`, as radians."""
    return np.radians(numbers(text))


def known(text: str) -> tuple[str, tuple[float, float]]:
    """Read a measured value with its error, as "fill=0.5±0.005" or "incline=2+-0.1" [degrees]."""
    try:
        name, value, error = re.split(r"=|±|\+-", text)
        unit = math.radians(1) if name in ("incline", "phi0", "turned") else 1.0
        return name, (unit * float(value), unit * float(error))
    except ValueError:
        raise ArgumentTypeError(
            f"it must be a value with its error, such as fill=0.5±0.005, got {text!r}"
        ) from None


def mark(text: str) -> tuple[float, float, float]:
    """Read a mark on the board, as "655,398=1": x and y [pixels], and its place [m]."""
    try:
        x, y, place = re.split("[,=]", text)
        return float(x), float(y), float(place)
    except ValueError:
        raise ArgumentTypeError(
            f"it must be x and y [pixels] and the place [m], such as 655,398=1, got {text!r}"
        ) from None


class Option(NamedTuple):
    """An option, or a word if its name has no dashes."""

    name: str
    help: str
    default: Any = None
    read: Any = float
    """A function that reads a value from its text, and the default if that is a text."""
    choices: tuple[str, ...] = ()
    """The values that are allowed, if they are a few texts; `read` is not used then."""
    several: bool = False
    """Whether it takes several values."""
    flag: bool = False
    """Whether it takes no value, and is true where it is given."""
    synonyms: tuple[str, ...] = ()
    """Other names of the option."""


_MODEL = (
    Option(
        "--rolling",
        "reduced coordinates (default), joint equality (default to view), or contact",
        choices=ROLLINGS,
    ),
    Option(
        "--integrator",
        "MuJoCo's or mjbeer's; by default RK4, or mjbeer's choice with a tolerance",
        choices=MUJOCO_INTEGRATORS + MJBEER_INTEGRATORS,
    ),
    Option(
        "--timestep", "timestep; with a tolerance, interval between samples [s]", Setting.timestep
    ),
    Option("--friction", "coefficient of friction: a contact slips beyond it", Setting.friction),
)
_RUN = (
    Option("--duration", "duration of the motion [s]", DURATION),
    Option(
        "--tolerance",
        "largest error in phi and u/radius [rad]; a sweep without an integrator takes 1e-6",
    ),
    *_MODEL,
)
_JSON = Option("--json", "print the results as JSON", flag=True)
_FOLDER = "folder to write to, which is new, empty, or this command's own"
OPTIONS = {
    "simulate": (
        *_RUN,
        Option("--output", 'CSV file to write; "-" is standard output', None, Path),
        _JSON,
    ),
    "render": (
        *_RUN,
        Option("--output", "MP4 file to write", "mjbeer.mp4", Path),
        Option("--speed", "playback speed: 1 is real time, 0.25 is four times slower", 1.0),
        Option(
            "--camera",
            "fixed, pan (moves along evenly), or auto (pan where the can would be small)",
            "auto",
            choices=CAMERAS,
        ),
        Option("--width", "width of the video [pixels]", 1280, int),
        Option("--height", "height of the video [pixels]", 720, int),
    ),
    "view": _MODEL,
    "export": (
        *_MODEL,
        Option(
            "--output",
            'MJCF file to write (.xml); its keyframe "start" is the start',
            "can.xml",
            Path,
        ),
        Option(
            "--looks",
            "plain, in a file of 10 kB, or full, as mjbeer draws it",
            "plain",
            choices=LOOKS,
        ),
        Option(
            "--portable",
            "write MJCF that other tools load too: docs/portability.md has each tool's error",
            flag=True,
        ),
    ),
    "fit": (
        Option(
            "--free",
            "what is sought, of incline, fill, damping, drag; a scene's options are guesses",
            [],
            str,
            several=True,
        ),
        Option(
            "--known",
            "measured values with their errors, as fill=0.5±0.005 [incline in degrees]",
            [],
            known,
            several=True,
        ),
        Option(
            "--phi0",
            "the load's angle when it is let go: level, free, or a number [degrees]",
            "level",
            str,
        ),
        Option(
            "--bend", "bend of the track by a lens [m]; by default 5 mm, or 1/400 of a short way"
        ),
        Option(
            "--columns",
            "columns by heading or number, as time=1 x=3; by default the usual headings",
            [],
            str,
            several=True,
        ),
        Option("--rate", "pictures per second, where frames are numbered and have no times [1/s]"),
        Option("--scale", "scale of a table in pixels, of a camera square to the board [pixels/m]"),
        Option(
            "--marks",
            "three or more places on the board in a table in pixels, as 102,411=0 655,398=1 "
            "1190,384=2 [pixels, m]",
            [],
            mark,
            several=True,
        ),
        Option("--output", "plot (.svg, .png) or film (.mp4) to write", None, Path),
        _JSON,
    ),
    "sweep": (
        *_RUN,
        Option(
            "--quantity",
            "plotted, as phi, u, error or period; files have all, the last if asked for",
            "phi",
            str,
        ),
        Option(
            "--output",
            "plot (.png, .svg), table (.csv), or NetCDF (.nc), which is resumed",
            "sweep.png",
            Path,
        ),
    ),
    "validate": (
        Option("--table", "print every row, not only those that failed", flag=True),
        _JSON,
    ),
    "benchmark": (
        Option("scenes", f"of {', '.join(CASES)}; by default all", [], str, several=True),
        Option("--output", _FOLDER, "benchmark", Path),
        Option("--quick", "try fewer timesteps and tolerances; takes four minutes", flag=True),
    ),
    "stability": (
        Option(
            "--output", f"{_FOLDER}; an interrupted study in it is continued", "stability", Path
        ),
        Option("--quick", "coarser maps, 250 random runs, not 3000; two minutes", flag=True),
    ),
    "paper": (
        Option("--output", _FOLDER, "paper", Path),
        Option("--films", "also draw films of the motions", flag=True),
    ),
    "report": (
        Option("--output", _FOLDER, "report", Path),
        Option(
            "--quick",
            "draw smaller videos with fewer frames, and no films for the paper's scenarios",
            flag=True,
        ),
    ),
}
"""The options of each command; those of a scene come before them."""
_FOR_ROLLING = ("--rolling", "--friction", "--tolerance", "--camera")
"""Options of a can that rolls, which a can that stands does not have."""


def scene_options(name: str, command: str) -> list[Option]:
    """Return the options of a scene and of its start, and then those of a command.

    In a sweep each number may be several.
    """
    number = numbers if command == "sweep" else float
    degrees = angles if command == "sweep" else angle
    choices = {"can": tuple(_CANS), "liquid": NAMES}
    reads = {"incline": degrees, "modes": int}
    defaults = _defaults(name)
    synonyms = {"radius": ("--can-radius",)}
    options = [
        Option(
            "--" + argument.replace("_", "-"),
            meaning,
            defaults[argument],
            reads.get(argument, number),
            choices.get(argument, ()),
            synonyms=synonyms.get(argument, ()),
        )
        for argument, meaning in _MEANINGS.items()
        if argument in defaults
    ]
    if name == "standing":
        return options + [option for option in OPTIONS[command] if option.name not in _FOR_ROLLING]
    if command != "fit":
        phi0 = "initial phi [degrees]: 0 with the load nearest to the incline"
        phi_dot0 = "initial rate of change of phi [degrees/s]"
        options += [
            Option("--phi0", phi0, "60", degrees),
            Option("--phi-dot0", phi_dot0, "0", degrees),
        ]
    return [*options, *OPTIONS[command]]


def _defaults(name: str) -> dict[str, Any]:
    """Return the defaults of the options of a scene, which are those of its function in Python."""
    parameters = inspect.signature((SCENES | STANDING)[name]).parameters.values()
    defaults = {parameter.name: parameter.default for parameter in parameters}
    if "can" in defaults:
        defaults["can"] = "metal" if name == "standing" else "massless"
        defaults["can_mass"] = None
        defaults["radius"] = RADIUS
        defaults["length"] = LENGTH
    if name == "liquid":
        defaults["liquid"] = defaults["name"]
    if "incline" in defaults:
        defaults["incline"] = f"{math.degrees(defaults['incline']):.9g}"
    return defaults


def model_arguments(given: Namespace) -> dict[str, Any]:
    """Return the options that say how a scene is modelled and stepped, if they are given."""
    names = ("rolling", "integrator", "timestep", "tolerance", "friction")
    return {
        name: value for name, value in vars(given).items() if name in names and value is not None
    }


def start_arguments(given: Namespace) -> dict[str, Any]:
    """Return the initial phi0 [rad] and phi_dot0 [rad/s].

    A note is printed if phi0 looks like radians, as 3.14159 does.
    """
    if given.scene == "standing":
        return {}
    degrees = np.round(np.degrees(given.phi0), 9)
    is_single = degrees.ndim == 0
    # Nobody writes so small an angle in degrees with three decimals or more.
    if is_single and abs(degrees) < 10 and round(degrees, 2) != degrees:
        as_radians = math.degrees(degrees)
        say(
            f"note: phi0 = {degrees:g} is taken as degrees; "
            f"that many radians are {as_radians:.6g} degrees"
        )
    return {"phi0": given.phi0, "phi_dot0": given.phi_dot0}


def scene_arguments(given: Namespace) -> dict[str, Any]:
    """Return the options of the scene, as `make` takes them.

    Raises:
      ParameterError: if an incline is not allowed; the message has it in degrees.
    """
    for incline in np.ravel(getattr(given, "incline", [])):
        lowest, highest = require.INCLINE
        if not lowest <= incline <= highest:
            allowed = f"between {math.degrees(lowest):g} and {math.degrees(highest):g} [degrees]"
            came = math.degrees(incline)
            raise ParameterError(f"incline must be {allowed}, got {came:.9g}")
    return {name: getattr(given, name) for name in _MEANINGS if hasattr(given, name)}


def make(function: Callable[..., Any], **options: Any) -> Any:
    """Return the scene that a function makes from options of the command line."""
    if "can" in options:
        can = _CANS[options["can"]](options.pop("radius"), options.pop("length"))
        options["can"] = _with_mass(can, options.pop("can_mass"))
    if function in (liquid, liquid_in):
        options["name"] = options.pop("liquid")
    return function(**options)


def _with_mass(can: Can, mass: float | None) -> Can:
    """Return the can with a mass [kg] that is spread as in metal sheet, or as it is if None."""
    if mass is None:
        return can
    sheet = Can.sheet_metal(can.radius, can.length)
    return replace(can, mass=mass, inertia=sheet.inertia * mass / sheet.mass)


def scene(given: Namespace) -> Any:
    """Return the scene or the standing can of a command line; a liquid prints what it assumes."""
    options = scene_arguments(given)
    if given.scene == "liquid":
        without_drag = {name: value for name, value in options.items() if name != "drag"}
        say(str(make(liquid_in, **without_drag)))
    return make((SCENES | STANDING)[given.scene], **options)
