"""How a command line is read: options of scenes, starts and runs, in degrees for angles and in SI units otherwise.

A scene has the options that its function in Python has, with the same defaults; only their meanings are written here.
"""

import argparse
import functools
import inspect
import math
import pathlib
from argparse import Namespace
from collections.abc import Callable, Iterable, Mapping
from typing import Any, NamedTuple, NoReturn, Self

import numpy as np

from mjbeer import require
from mjbeer.exceptions import ParameterError
from mjbeer.model.setting import FRICTION, INTEGRATORS, OWN, ROLLINGS
from mjbeer.output.terminal import say
from mjbeer.theory.can import LENGTH, RADIUS, Can
from mjbeer.theory.liquid import NAMES, liquid, liquid_in
from mjbeer.theory.scene import DURATION, GRAVITY, PHI0, Scene
from mjbeer.theory.scenes import frozen, hoop, pendulum, sliding
from mjbeer.theory.standing import Standing, standing

SCENES: dict[str, Callable[..., Scene]] = {each.__name__: each for each in (sliding, liquid, frozen, pendulum, hoop)}
_CANS = {"massless": Can.massless, "metal": Can.sheet_metal}
_CHOICES = {"can": tuple(_CANS), "liquid": NAMES}
_MEANINGS = {
    "incline": "angle of the incline to the horizontal [degrees]; if positive, u grows downhill",
    "fill": "height of the load as a fraction of the can's diameter, in (0, 1]",
    "can": "massless (section 2 of the paper), or metal, of aluminium sheet 0.1 mm thick (section 3)",
    "radius": "radius of the can [m]",
    "length": "length of the can [m]",
    "liquid": "the liquid, at 20 degrees Celsius",
    "density": "density of beer or liquid [kg/m^3]",
    "viscosity": "kinematic viscosity [m^2/s]; water has 1e-6",
    "gravity": "acceleration of gravity [m/s^2]",
    "damping": "torque between can and beer over the rate at which the can turns faster than the beer [N m s]",
    "drag": "force of the air against the motion over the square of the speed [kg/m]",
    "wheel_mass": "mass of the wheel [kg]",
    "hoop_mass": "mass of the hoop [kg]",
    "load_mass": "mass of the load: a pendulum's bob, or a weight on a rim [kg]",
    "offset": "length of the pendulum, from the axle to the bob [m]",
}
"""What the options of scenes mean; their order is that of the help."""
_TURNS = np.array([1 / 6, 1 / 4, 1 / 3, 1 / 2, 2 / 3, 3 / 4, 1, 3 / 2, 2]) * math.pi  # angles that look like radians
REQUIRED = "required"


def several(text: str) -> float | np.ndarray:
    """Read a number as "3", or several as "1,2,5" or as "1:20:39", which is 39 numbers from 1 to 20."""
    try:
        if ":" in text:
            first, last, count = text.split(":")
            with np.errstate(invalid="ignore"):
                numbers = np.linspace(float(first), float(last), min(int(count), 10**8))  # they take a gigabyte
        else:
            numbers = np.array([float(each) for each in text.split(",")])
        if not (numbers.size and np.isfinite(numbers).all()):
            raise ValueError
    except ValueError:
        raise argparse.ArgumentTypeError(
            f"{text!r} is no number, no list as 1,2,5, and no range as 1:20:39, which is 39 numbers from 1 to 20"
        ) from None
    return numbers if numbers.size > 1 else float(numbers[0])


class Option(NamedTuple):
    """An option, of several words if its default is a list; or words without one, if its default is several.

    Where the default is no value, `otherwise` says in words what is taken, or is REQUIRED.
    """

    name: str
    help: str
    default: Any = None
    kind: Any = float  # a function that reads a word, or the names that are allowed; bool, if the option takes no value
    otherwise: str = ""


class Command(NamedTuple):
    """A command: the function that runs it, whose docstring says what it does, and its options."""

    run: Callable[[Namespace], int]
    options: tuple[Option, ...]
    numbers: Callable[[str], Any] | None = None
    """How the numbers of its scene are read, which is its first argument; None if it has no scene."""
    standing: tuple[Option, ...] = ()
    """The options beside those of a standing can, if the command takes one instead of a scene."""
    file: str = ""
    """What the file is that it reads, whose name comes before the scene."""


def command(*options: Option, **more: Any) -> Callable[[Callable[[Namespace], int]], Command]:
    """Make a function the command of its name, with `numbers` and `standing` as a `Command` has them."""
    return lambda run: Command(run, options, **more)


class Parser(argparse.ArgumentParser):
    """A parser whose errors are one line each."""

    def __init__(self, **settings: Any) -> None:
        settings["description"] = " ".join(settings["description"].split())
        settings["formatter_class"] = functools.partial(argparse.HelpFormatter, max_help_position=28)
        super().__init__(allow_abbrev=False, **settings)

    def error(self, message: str) -> NoReturn:
        raise ParameterError(f"{message}; see `{self.prog} --help`")

    def add_words(self, title: str, name: str, meanings: Mapping[str, str], before: str = "") -> dict[str, Self]:
        """Add words of which one must follow, with what they mean, and return the parser of each.

        Their help begins with `before`.
        """
        choice = self.add_subparsers(title=title, dest=name.lower(), metavar=name, required=True)
        return {
            word: choice.add_parser(word, help=meaning.split(".\n")[0].removesuffix("."), description=before + meaning)
            for word, meaning in meanings.items()
        }

    def add_options(self, options: Iterable[Option]) -> None:
        """Add options."""
        self.usage = "%(prog)s [options]"
        metavars = {float: "NUMBER", several: "NUMBERS", int: "PIXELS", pathlib.Path: "PATH"}
        for name, meaning, default, kind, otherwise in options:
            taken = otherwise or (f"{default:g}" if isinstance(default, float) else default)
            taken = " ".join(taken) if isinstance(taken, list) else taken
            how: dict[str, Any] = {"choices": kind}
            if callable(kind):
                how = {"type": kind, "metavar": metavars.get(kind, "NAME")}
            if isinstance(default, tuple):
                self.usage += " [NAME ...]"
                self.add_argument(name, nargs="*", metavar="NAME", help=f"{meaning} (default: {', '.join(default)})")
            elif kind is bool:
                self.add_argument(f"--{name}", action="store_true", help=meaning)
            else:
                how |= {"help": f"{meaning} ({taken if taken == REQUIRED else f'default: {taken}'})"}
                how |= {"default": default, "required": taken == REQUIRED}
                how |= {"nargs": "+"} if isinstance(default, list) else {}
                self.add_argument("--" + name.replace("_", "-"), **how)


def defaults(scene: str) -> dict[str, Any]:
    """Return the options of a scene with their defaults; the incline is in degrees."""
    given = {name: each.default for name, each in inspect.signature(SCENES[scene]).parameters.items()}
    if "can" in given:
        given |= {"can": "massless", "radius": RADIUS, "length": LENGTH}
    given |= {"liquid": given["name"]} if "name" in given else {}
    given["incline"] = round(math.degrees(given["incline"]), 9)
    return {name: given[name] for name in _MEANINGS if name in given}


def scene_options(scene: str, numbers: Callable[[str], Any]) -> Iterable[Option]:
    """Return the options of a scene; `numbers` reads those that are numbers."""
    for name, default in defaults(scene).items():
        yield Option(name, _MEANINGS[name], default, _CHOICES.get(name, numbers), "the liquid's" * (default is None))


STANDING = "a can that stands on a floor, free in space, with a liquid that sloshes"
SCENE_MEANINGS = {
    name: str(make.__doc__).split("\n")[0].removeprefix("Return the scene of ") for name, make in SCENES.items()
}
STANDING_OPTIONS = (  # the can is of aluminium sheet
    Option("liquid", _MEANINGS["liquid"], "beer", NAMES),
    Option("fill", "height of the liquid as a fraction of the can's length, between 0 and 1", 0.5),
    Option("radius", _MEANINGS["radius"], RADIUS),
    Option("length", _MEANINGS["length"], LENGTH),
    Option("modes", "modes of the slosh that move, from 0 (solid) to 5", "1", tuple("012345")),
    Option("damping_ratio", "damping of each mode over the critical one", None, float, "what the viscosity gives"),
    Option("gravity", _MEANINGS["gravity"], GRAVITY),
)


def standing_can(given: Namespace) -> Standing:
    """Return the standing can that was asked for."""
    can = Can.sheet_metal(given.radius, given.length)
    return standing(given.liquid, given.fill, can, int(given.modes), given.damping_ratio, given.gravity)


_PHI0 = "initial phi, the angle of the load [degrees]: 0 where its centre of mass is nearest to the incline"
_ROLLING = "what makes the can roll: reduced coordinates, a joint equality, or contact with friction"
_TIMESTEP = Option("timestep", "timestep; with a tolerance, interval between samples [s]", 1e-3)
STEPS = Option("integrator", "one of MuJoCo's", "RK4", INTEGRATORS), _TIMESTEP  # the options of what MuJoCo steps
_FRICTION = Option("friction", "coefficient of friction: a contact slips beyond it", FRICTION)


def _start(numbers: Callable[[str], Any] = float) -> tuple[Option, ...]:
    rate = Option("phi_dot0", "initial rate of change of phi [degrees/s]", 0.0, numbers)
    return Option("phi0", _PHI0, round(math.degrees(PHI0), 9), numbers), rate


def model_options(rolling: str | None = "reduced") -> tuple[Option, ...]:
    """Return the options of a model at its start with one of MuJoCo's integrators."""
    way = Option("rolling", _ROLLING, rolling, ROLLINGS, "" if rolling else "equality, or reduced if only that exists")
    return *_start(), way, *STEPS, _FRICTION


def run_options(numbers: Callable[[str], Any] = float) -> tuple[Option, ...]:
    """Return the options of a simulation with any integrator."""
    tolerance = "none" if numbers is float else "1e-6; none with an integrator"
    integrators = "one of MuJoCo's, by its name in MJCF, or of mjbeer's: DOP853, GaussJackson"
    return (
        *_start(numbers),
        Option("duration", "duration of the motion [s]", DURATION),
        Option("rolling", _ROLLING, "reduced", ROLLINGS),
        Option("integrator", integrators, None, (*INTEGRATORS, *OWN), "RK4, or what keeps a tolerance"),
        _TIMESTEP,
        Option("tolerance", "largest error allowed in phi and u/radius [rad]", otherwise=tolerance),
        _FRICTION,
    )


def steps(given: Namespace) -> dict[str, Any]:
    """Return how a scene is modelled and stepped."""
    names = ("rolling", "integrator", "timestep", "tolerance", "friction")
    return {name: value for name, value in vars(given).items() if name in names}


def radians(name: str, value: Any, unit: str = "degrees") -> Any:
    """Convert an angle from degrees to radians, or a rate from degrees/s to radians/s: a number, or an array.

    Raises:
      ParameterError: if one is not finite; the message has the `name` of the option and the `unit` of its value.
    """
    for each in np.ravel(value).tolist():
        require.number(name, each, unit)
    return np.radians(value) if isinstance(value, np.ndarray) else math.radians(value)


def start(given: Namespace) -> dict[str, Any]:
    """Return the initial phi0 [rad] and phi_dot0 [rad/s], and say so if phi0 looks like radians, as 3.14159."""
    phi0 = given.phi0
    if np.ndim(phi0) == 0 and round(phi0, 2) != phi0 and (np.abs(_TURNS - abs(phi0)) < 1e-3).any():
        meant = f"in degrees, that many radians are {math.degrees(phi0):.6g}"
        say(f"note: phi0 = {phi0:g} is taken as degrees; {meant}")
    return {"phi0": radians("phi0", phi0), "phi_dot0": radians("phi_dot0", given.phi_dot0, "degrees/s")}


def scene_arguments(given: Namespace) -> dict[str, Any]:
    """Return the options of the scene, as `make` takes them: the incline in radians.

    Raises:
      ParameterError: if the incline is not between -90 and 90 degrees.
    """
    for each in np.ravel(given.incline).tolist():
        if not abs(each) < 90:
            raise ParameterError(f"incline must be between -90 and 90 [degrees], got {each!r}")
    options = {name: getattr(given, name) for name in defaults(given.scene)}
    return options | {"incline": radians("incline", given.incline)}


def make(function: Callable[..., Any], **options: Any) -> Any:
    """Call a function that makes a scene with the options of the command line, but with the incline in radians."""
    if "can" in options:
        options["can"] = _CANS[options["can"]](options.pop("radius"), options.pop("length"))
    return function(**{"name" if name == "liquid" else name: value for name, value in options.items()})


def scene(given: Namespace) -> Scene:
    """Return the scene that was asked for, and say what a liquid takes that was not given."""
    options = scene_arguments(given)
    if given.scene == "liquid":
        say(str(make(liquid_in, **{name: value for name, value in options.items() if name != "drag"})))
    return make(SCENES[given.scene], **options)
