"""Regions of random trials: what one has on a desk, and what nobody has.

A region states as data what its trials choose from: a number, a `Uniform` or `LogUniform` range, or
`OneOf` several of these. Each region takes one quantity, or all of them, to extremes, some of which
lie beyond the domain. A trial depends on its number alone.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import NamedTuple, TypeVar

import numpy as np

from mjbeer import require
from mjbeer.exceptions import NoEquilibriumError
from mjbeer.model.setting import MUJOCO_INTEGRATORS, ROLLINGS, supported
from mjbeer.studies.stability.judge import Trial
from mjbeer.theory.can import Can, Damping, Load
from mjbeer.theory.liquid import NAMES, liquid
from mjbeer.theory.paper_scenes import frozen, hoop, pendulum, sliding
from mjbeer.theory.scene import ATTACHMENTS, GRAVITY, Scene

T = TypeVar("T")
_SWINGS = 400.0
"""Number of swings of the longest motion that theory can follow."""
_TURNED = 3e3
"""Largest angle of a motion that theory can follow [rad]."""
_DAMPED = 0.05
"""Share of both that a damped motion may have, as theory follows it step by step."""
_MANY = 200
"""Largest number of regular samples in half of the trials; in the others, ten times as many."""


class Uniform(NamedTuple):
    """A number between two others, with a uniform distribution."""

    low: float
    high: float


class LogUniform(NamedTuple):
    """A number between two positive ones, whose logarithm has a uniform distribution."""

    low: float
    high: float


class OneOf:
    """One of several quantities, each of which is equally likely."""

    def __init__(self, *options: "Quantity") -> None:
        self.options = options


class Minus(NamedTuple):
    """A number minus a quantity."""

    number: float
    by: "Quantity"


Quantity = float | Uniform | LogUniform | OneOf | Minus
"""What a number is chosen from; a float stands for itself."""


def signed(quantity: Quantity) -> OneOf:
    """Return a quantity with either sign."""
    return OneOf(quantity, Minus(0, quantity))


class RandomPicker:
    """Makes random choices; the same seed makes the same ones."""

    def __init__(self, seed: int) -> None:
        self._generator = np.random.default_rng(seed)

    def number(self, quantity: Quantity) -> float:
        """Return a value of a quantity."""
        match quantity:
            case Uniform(low, high):
                return float(self._generator.uniform(low, high))
            case LogUniform(low, high):
                return 10 ** self.number(Uniform(math.log10(low), math.log10(high)))
            case Minus(number, by):
                return number - self.number(by)
            case OneOf():
                return self.number(self.one(*quantity.options))
        return float(quantity)

    def one(self, *options: T) -> T:
        """Return one of the options, each of which is equally likely."""
        if len(options) == 1:
            return options[0]
        return options[int(self._generator.integers(len(options)))]


@dataclass(frozen=True)
class Parts:
    """The parts of a scene, as ratios.

    Masses are divided by that of the load, offsets by the radius a, and inertias by m a^2, where m
    is the mass of the same part.
    """

    radius: Quantity
    """[m]"""
    load: Quantity
    """The load's mass [kg]."""
    can: Quantity
    """The can's mass."""
    rim: Quantity
    """The can's inertia."""
    offset: Quantity
    inertia: Quantity
    """The load's inertia, about its centre of mass."""
    incline: Quantity
    """[degrees]"""
    gravity: Quantity = GRAVITY

    def __call__(self, pick: RandomPicker) -> Scene:
        """Return a scene."""
        radius = pick.number(self.radius)
        load_mass = pick.number(self.load)
        can_mass = load_mass * pick.number(self.can)
        rim = can_mass * radius**2 * pick.number(self.rim)
        offset = radius * pick.number(self.offset)
        inertia = load_mass * radius**2 * pick.number(self.inertia)
        incline = math.radians(pick.number(self.incline))
        attachment = pick.one(*ATTACHMENTS)
        gravity = pick.number(self.gravity)
        can = Can(radius, 3 * radius, can_mass, rim)
        load = Load(load_mass, offset, inertia)
        return Scene(can, load, incline, attachment, gravity)


_HEAVY_CAN = Parts(
    radius=OneOf(LogUniform(0.01, 0.3)),
    load=0.1,
    can=LogUniform(1, 1e5),
    rim=OneOf(0.5, 1.0),
    offset=OneOf(1.0, LogUniform(1e-3, 1)),
    inertia=OneOf(0.0, 0.1),
    incline=OneOf(0.0, Uniform(-20, 20)),
)
"""A can so heavy that the inertia hardly depends on the angle."""
_RATIOS = Parts(
    radius=OneOf(0.033, LogUniform(1e-3, 10)),
    load=OneOf(0.1, LogUniform(1e-4, 1e3)),
    can=LogUniform(1e-4, 1e4),
    rim=OneOf(0.5, 1.0, LogUniform(1e-12, 1)),
    offset=OneOf(1.0, Uniform(0, 1), Minus(1, LogUniform(1e-15, 1)), LogUniform(1e-12, 1)),
    inertia=OneOf(0.0, 0.3, LogUniform(1e-12, 1)),
    incline=Uniform(-20, 20),
)
_ANYTHING = Parts(
    radius=LogUniform(1e-3, 33),
    load=LogUniform(1e-6, 1e4),
    can=OneOf(0.0, LogUniform(1e-4, 1e4)),
    rim=OneOf(0.0, 0.5, 1.0, Uniform(0, 1)),
    offset=OneOf(0.0, 1.0, LogUniform(1e-9, 1), Uniform(0, 1)),
    inertia=OneOf(0.0, LogUniform(1e-12, 1), Uniform(0, 1)),
    incline=OneOf(0.0, 1e-8, 10.0, 89.9, Uniform(-30, 30), Uniform(-89.9, 89.9)),
    gravity=OneOf(GRAVITY, GRAVITY, GRAVITY, 0.0, LogUniform(1e-3, 1e3)),
)
"""Sizes, masses and gravities of many decades, with about as many special cases as others."""


def _ordinary(pick: RandomPicker) -> Scene:
    """Return a scene of the paper on a moderate incline, with a can that one can carry."""
    incline = math.radians(pick.number(OneOf(0.0, 10.0, Uniform(-20, 20))))
    radius = pick.number(OneOf(0.033, LogUniform(0.01, 0.3)))
    kind = pick.one("beer", "beer", "beer", "pendulum", "hoop")
    if kind == "pendulum":
        wheel_mass = pick.number(LogUniform(0.02, 2))
        load_mass = pick.number(LogUniform(0.01, 1))
        offset = radius * pick.number(Uniform(0.2, 1))
        return pendulum(incline, wheel_mass, load_mass, offset, radius, 3 * radius)
    if kind == "hoop":
        hoop_mass = pick.number(LogUniform(2e-3, 0.2))
        return hoop(incline, hoop_mass, 0.2, radius, 3 * radius)
    can = pick.one(Can.massless, Can.sheet_metal)(radius, 3.6 * radius)
    make = pick.one(sliding, frozen)
    fill = pick.number(OneOf(0.5, Uniform(0.05, 1)))
    return make(incline, fill, can)


def _fills(pick: RandomPicker) -> Scene:
    """Return a scene with a film of beer, or with a can that is nearly full."""
    fill = pick.number(OneOf(LogUniform(1e-4, 0.1), Minus(1, LogUniform(1e-9, 0.1))))
    can = pick.one(Can.massless, Can.sheet_metal)()
    make = pick.one(sliding, frozen)
    incline = math.radians(pick.number(Uniform(-20, 20)))
    return make(incline, fill, can)


def _steep(pick: RandomPicker) -> Scene:
    """Return an ordinary scene on a steep incline, up or down."""
    steepness = OneOf(Uniform(30, 89.9), Minus(90, LogUniform(1e-6, 1)))
    incline = math.radians(pick.number(signed(steepness)))
    return replace(_ordinary(pick), incline=incline)


def _gravity(pick: RandomPicker) -> Scene:
    """Return a scene in no gravity, on an asteroid, or on a star."""
    scene = _ordinary(pick)
    gravity = pick.number(OneOf(0.0, LogUniform(1e-3, 1), LogUniform(20, 1e3)))
    return replace(scene, gravity=gravity)


def _liquid(pick: RandomPicker) -> Scene:
    """Return a scene with a real liquid."""
    make_can = pick.one(Can.massless, Can.sheet_metal)
    can = make_can(pick.number(OneOf(0.033, LogUniform(0.02, 0.1))))
    name = pick.one(*NAMES)
    incline = math.radians(pick.number(Uniform(-15, 15)))
    fill = pick.number(Uniform(0.05, 0.95))
    return liquid(name, incline, fill, can)


def _metal(pick: RandomPicker) -> Scene:
    """Return a scene with a can of sheet metal, as it is attached to a world."""
    can = Can.sheet_metal(pick.number(OneOf(0.033, LogUniform(0.02, 0.1))))
    make = pick.one(sliding, frozen)
    incline = math.radians(pick.number(Uniform(-15, 15)))
    fill = pick.number(Uniform(0.1, 0.9))
    return make(incline, fill, can)


def _damped(pick: RandomPicker, scene: Scene) -> Scene:
    """Return a scene with a sliding load and with damping, drag or both, over many decades.

    Damping is in units of M a^2 divided by the time of a fall through the radius, and drag in units
    of M/a. The torque may have terms in several powers of the slip rate.
    """
    radius = scene.can.radius
    mass = scene.effective_mass
    clock = _clock(scene)
    linear = mass * radius**2 / clock * pick.number(LogUniform(1e-6, 1e6))
    squared = Damping(linear, linear * clock * pick.number(LogUniform(1e-6, 1e2)))
    cubed = Damping(
        pick.number(OneOf(0.0, linear)),
        linear * clock * pick.number(LogUniform(1e-6, 1e2)),
        linear * clock**2 * pick.number(LogUniform(1e-6, 1e2)),
    )
    damping = pick.one(linear, linear, squared, cubed, 0.0)
    drag = mass / radius * pick.number(LogUniform(1e-6, 1e2))
    drag = pick.one(drag, drag if damping == 0 else 0.0)
    return replace(scene, attachment="sliding", damping=damping, drag=drag)


def _clock(scene: Scene) -> float:
    """Return the time of a fall through the radius [s], or a second without gravity."""
    if scene.gravity == 0:
        return 1.0
    return math.sqrt(scene.can.radius / scene.gravity)


class Start(NamedTuple):
    """The start of a motion."""

    phi0: Quantity
    """[rad]"""
    rate: Quantity
    """phi_dot0 times the time of `_clock`."""


_STARTS = {
    "by hand": Start(
        OneOf(0.0, 1.0, math.pi, Uniform(-math.pi, math.pi), LogUniform(1e-9, 1)),
        OneOf(0.0, 0.0, Uniform(-3, 3)),
    ),
    "spun": Start(
        Uniform(-4, 4),
        signed(OneOf(LogUniform(2, 500), LogUniform(2, 500), LogUniform(1e2, 1e6))),
    ),
    "far": Start(
        signed(LogUniform(1e2, 1e4)),
        OneOf(0.0, Uniform(-3, 3), signed(LogUniform(1e1, 1e5))),
    ),
    "let go": Start(Uniform(-2.5, 2.5), 0.0),
}
_BESIDE_THE_SEPARATRIX = "separatrix"
"""The name of starts that depend on the scene."""


def _start(pick: RandomPicker, scene: Scene, name: str) -> tuple[float, float]:
    """Return phi0 [rad] and phi_dot0 [rad/s]. A scene without a separatrix starts by hand."""
    if name == _BESIDE_THE_SEPARATRIX:
        try:
            low, high = replace(scene, damping=0.0, drag=0.0).separatrix()
        except NoEquilibriumError:
            name = "by hand"
        else:
            return _start_beside(pick, scene, low, high)
    start = _STARTS[name]
    phi0 = pick.number(start.phi0)
    rate = pick.number(start.rate)
    return phi0, rate / _clock(scene)


def _start_beside(pick: RandomPicker, scene: Scene, low: float, high: float) -> tuple[float, float]:
    """Return a start at rest near one of two tops, or between them with nearly a top's energy."""
    beside = pick.number(signed(LogUniform(1e-15, 0.1)))
    at_rest = pick.one(True, False)
    if at_rest:
        return pick.one(low, high) + beside, 0.0
    phi0 = pick.number(Uniform(low, high))
    oscillator = scene.oscillator
    drop = max(0.0, float(oscillator.drop(phi0, high)))
    rate = math.sqrt(2 * drop / float(oscillator.inertia(phi0)))
    return phi0, pick.one(1, -1) * rate * (1 + beside)


class Pace(NamedTuple):
    """The timestep and the length of a run."""

    unit: str
    """The unit of the timestep, by its name in `_unit`."""
    timestep: Quantity
    steps: Quantity


_MANY_STEPS = LogUniform(20, 3000)
_NEARLY_ONE = OneOf(1.0, Minus(1, signed(LogUniform(1e-12, 0.1))))
_MULTIPLES = (1, 1, 1, 2, 3)
_TURNS = math.pi * np.array([0.5, 1.0, 2.0, 4.0, 8.0, 16.0])
_WHOLE_TURNS = OneOf(*np.outer(_TURNS, _MULTIPLES).ravel().tolist())
_RESONANT = "resonant"
"""A pace with a whole number of turns, or nearly, in a step or a part of one.

RK4 evaluates forces at half steps, and at half the timestep it does so at quarters. With whole
turns all of these see the same angle.
"""
_LONG_STEPS = LogUniform(4e3, 1.5e4)
_PACES = {
    "usual": Pace("clock", LogUniform(1e-3, 0.3), _MANY_STEPS),
    "swinging": Pace("swing", LogUniform(1e-3, 0.1), _MANY_STEPS),
    "extreme": Pace("fast", LogUniform(1e-4, 3), LogUniform(10, 1e4)),
    "turning": Pace("turn", LogUniform(1e-2, 1e2), _MANY_STEPS),
    _RESONANT: Pace("turn", _WHOLE_TURNS, OneOf(LogUniform(2, 30), LogUniform(2, 500))),
    "few": Pace("clock", LogUniform(1e-6, 3), Uniform(1, 6)),
    "long": Pace("second", LogUniform(5e-3, 3e-2), _LONG_STEPS),
    "desk": Pace("second", LogUniform(1e-4, 1e-3), LogUniform(100, 2000)),
}


def _unit(name: str, clock: float, spin: float, frequency: float) -> float:
    """Return a unit of time [s]. `spin` and `frequency` are rates of turns and swings [rad/s]."""
    match name:
        case "clock":
            return clock
        case "fast":
            return clock / max(1.0, spin * clock)
        case "turn":
            return 1 / max(spin, 1 / clock)
        case "swing":
            return 2 * math.pi / max(frequency, spin, 1e-3 / clock)
    return 1.0  # a second


def _pace(
    pick: RandomPicker, scene: Scene, phi0: float, phi_dot0: float, name: str
) -> tuple[float, int]:
    """Return timestep [s] and number of steps of a pace, shortened to what theory can follow."""
    pace = _PACES[name]
    spin = abs(phi_dot0)
    frequency = _frequency(scene, phi0, phi_dot0)
    timestep = _unit(pace.unit, clock=_clock(scene), spin=spin, frequency=frequency)
    timestep *= pick.number(pace.timestep)
    if name == _RESONANT:
        timestep *= pick.number(_NEARLY_ONE)
    longest = _longest(scene, spin, frequency)
    timestep = min(timestep, longest)
    steps = min(pick.number(pace.steps), longest / timestep)
    return timestep, max(1, int(steps))


def _longest(scene: Scene, spin: float, frequency: float) -> float:
    """Return the longest time [s] over which theory can follow a motion."""
    oscillator = scene.oscillator
    mean_inertia = oscillator.base + (oscillator.chord + oscillator.coupling) / 2
    acceleration = max(abs(oscillator.ramp) / mean_inertia, 1e-300)  # mean angular one [rad/s^2]
    share = 1.0
    if scene.dissipates:
        share = _DAMPED
        # The load may turn with the can, which accelerates down the incline.
        of_can = scene.gravity * abs(math.sin(scene.incline)) / scene.can.radius
        acceleration = max(acceleration, of_can)
    turned = share * _TURNED
    longest = min(turned / max(spin, 1e-300), math.sqrt(2 * turned / acceleration))
    if frequency > 0:
        longest = min(longest, share * _SWINGS * 2 * math.pi / frequency)
    return longest


def _frequency(scene: Scene, phi0: float, phi_dot0: float) -> float:
    """Return an estimate of the angular frequency of the swing from a start [rad/s].

    It depends on the amplitude: if the can is light and the load has hardly any inertia, a small
    swing about the bottom is faster than a large one by many powers of ten.
    """
    oscillator = scene.oscillator
    depth = oscillator.depth
    if depth == 0:
        return 0.0
    kinetic = float(oscillator.inertia(phi0)) * phi_dot0**2 / 2
    height = 2 * depth * math.sin((phi0 - oscillator.bottom) / 2) ** 2
    square_of_amplitude = min(1.0, 2 * (kinetic + height) / depth)
    varying = (oscillator.chord / 4 + oscillator.coupling) * square_of_amplitude / 2
    return math.sqrt(depth / (oscillator.base + varying))


def _with_setting(pick: RandomPicker, trial: Trial, kind: str) -> Trial:
    """Return a trial with any setting that its scene allows; every fourth has a tolerance.

    The kind "contact" has hardly any friction, or plenty, and no tolerance. "any" includes ways of
    rolling that the scene does not support. "attached" is a can in another world, which steps it
    accurately.
    """
    if kind == "attached":
        return replace(trial, rolling="contact", integrator="RK4", attached=True)
    if kind == "contact":
        rolling = "contact"
        friction = pick.number(LogUniform(0.01, 10))
    else:
        rollings = [rolling for rolling in ROLLINGS if supported(trial.scene, rolling)]
        if kind == "any":
            rollings += ROLLINGS
        rolling = pick.one(*rollings)
        friction = pick.number(OneOf(1.0, 1.0, LogUniform(0.01, 1e3)))
    trial = replace(trial, rolling=rolling, friction=friction)
    if rolling != "contact" and pick.one(True, False, False, False):
        return replace(trial, tolerance=pick.number(LogUniform(1e-12, 0.03)))
    integrator = pick.one(*MUJOCO_INTEGRATORS, "RK4", "DOP853", "DOP853")
    return replace(trial, integrator=integrator)


def _with_samples(pick: RandomPicker, trial: Trial, kind: str) -> Trial:
    """Return a trial with samples of a kind.

    "regular" samples are at every timestep, or every so many, "sparse" ones are two to six at
    random times, and "late" is the last alone or with the one before. MuJoCo's integrators have
    samples at whole numbers of timesteps only.
    """
    steps = trial.steps
    if kind == "regular":
        most = pick.one(_MANY, 10 * _MANY)
        return replace(trial, every=max(1, math.ceil(steps / most)))
    if kind == "late":
        before = max(0, steps - pick.one(0, 0, 1))
        moments = {float(before), float(steps)}
    else:
        count = pick.one(2, 3, 4, 5, 6)
        moments = {pick.number(Uniform(0, steps)) for _ in range(count)}
        if trial.integrator not in (None, "DOP853"):
            moments = {float(round(moment)) for moment in moments}
    return replace(trial, moments=tuple(sorted(moments)))


class Region(NamedTuple):
    """A part of the search. A trial chooses one of each tuple, all of which are equally likely."""

    name: str
    scenes: tuple[Callable[[RandomPicker], Scene], ...] = (_ordinary,)
    starts: tuple[str, ...] = ("by hand",)
    paces: tuple[str, ...] = ("usual",)
    setting: str = "usual"
    samples: tuple[str, ...] = ("regular",)
    damped: bool = False

    def draw(self, pick: RandomPicker) -> Trial:
        """Return a random trial of this region.

        Raises:
          ParameterError: if the choices make a scene that cannot be, or a start or timestep outside
            the domain.
        """
        make_scene = pick.one(*self.scenes)
        scene = make_scene(pick)
        if self.damped:
            scene = _damped(pick, scene)
        phi0, phi_dot0 = _start(pick, scene, pick.one(*self.starts))
        timestep, steps = _pace(pick, scene, phi0, phi_dot0, pick.one(*self.paces))
        trial = Trial(scene, phi0, phi_dot0, timestep=timestep, steps=steps)
        trial = _with_setting(pick, trial, self.setting)
        trial = _with_samples(pick, trial, pick.one(*self.samples))
        require.start(phi0, phi_dot0)
        require.within("timestep", timestep, *require.TIMESTEP)
        return trial


_EVERY_SCENE = (_ordinary, _HEAVY_CAN, _ANYTHING, _RATIOS, _fills, _steep, _gravity)
_EVERY_START = ("by hand", "by hand", "spun", "far", _BESIDE_THE_SEPARATRIX)
_EVERY_PACE = ("usual", "swinging", "extreme", "turning", _RESONANT, "few", "long")
_EVERY_SAMPLING = ("regular", "sparse", "late")
_MOSTLY_ORDINARY = (_ordinary, _ordinary, _ANYTHING)
_MOSTLY_HEAVY = (_HEAVY_CAN, _HEAVY_CAN, _ordinary)
_USUAL_OR_SWINGING = ("usual", "swinging")
REGIONS = (
    Region("ordinary"),
    Region("anything", (_ANYTHING,), _EVERY_START, ("extreme",), "any"),
    Region("sparse samples", _MOSTLY_ORDINARY, paces=_USUAL_OR_SWINGING, samples=("sparse",)),
    Region("single late sample", _MOSTLY_ORDINARY, paces=_USUAL_OR_SWINGING, samples=("late",)),
    Region("few steps", paces=("few",)),
    Region("fast rotation", _MOSTLY_HEAVY, ("spun",), ("turning",)),
    Region("resonance", _MOSTLY_HEAVY, ("spun",), (_RESONANT,), samples=_EVERY_SAMPLING),
    Region("contact friction", setting="contact"),
    Region("mass ratios", (_RATIOS,), paces=_USUAL_OR_SWINGING),
    Region("thin or full", (_fills,), paces=_USUAL_OR_SWINGING, samples=_EVERY_SAMPLING),
    Region("long", paces=("long",), samples=_EVERY_SAMPLING),
    Region("far angles", starts=("far",), samples=_EVERY_SAMPLING),
    Region("steep", (_steep,)),
    Region("weak or strong gravity", (_gravity,)),
    Region("beside the separatrix", starts=(_BESIDE_THE_SEPARATRIX,), samples=_EVERY_SAMPLING),
    Region("mixed", _EVERY_SCENE, _EVERY_START, _EVERY_PACE, "any", _EVERY_SAMPLING),
    Region("liquids", (_liquid,), paces=_USUAL_OR_SWINGING),
    Region("attached", (_metal,), ("let go",), ("desk",), "attached"),
    Region("damped", paces=_USUAL_OR_SWINGING, damped=True),
    Region(
        "damped, mixed",
        _EVERY_SCENE,
        _EVERY_START,
        _EVERY_PACE,
        "any",
        _EVERY_SAMPLING,
        damped=True,
    ),
)
"""All regions, from which equally many trials are drawn."""


def random_trial(number: int) -> Trial:
    """Return the trial of a number from 0 on; the regions take turns.

    The regions are wider than the domain. A trial outside it counts as refused, and is not replaced
    by another.

    Raises:
      ParameterError: if the scene, the start or the timestep is outside the domain.
    """
    return REGIONS[number % len(REGIONS)].draw(RandomPicker(number))
