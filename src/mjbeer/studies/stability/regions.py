"""Regions of random trials, as rows of data: what one has on a desk, and what nobody has.

A quantity is a number, a pair (low, high) between which its logarithm is even, an `Even` range, or a list of which one
is taken. Each region takes one thing or all to its extremes, some beyond the domain. A trial depends on its number
alone.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple, TypeVar

import numpy as np

from mjbeer import require
from mjbeer.exceptions import NoEquilibriumError
from mjbeer.model.setting import MUJOCO_INTEGRATORS, ROLLINGS, supported
from mjbeer.studies.stability.judge import Trial
from mjbeer.theory.can import Can, Damping, Load
from mjbeer.theory.liquid import NAMES, liquid
from mjbeer.theory.scene import ATTACHMENTS, GRAVITY, Scene, frozen, hoop, pendulum, sliding

T = TypeVar("T")
_SWINGS, _TURNED = 400.0, 3e3
"""Longest motion, in swings, and in angle [rad], which theory can follow."""
_DAMPED = 0.05
"""Share of these that a damped motion may have, which theory follows step by step."""
_MANY = 200
"""Largest number of regular samples after the start, so that repeating a run takes few of them."""


class Even(NamedTuple):
    """An even distribution between two numbers."""

    low: float
    high: float


class Beside(NamedTuple):
    """A number less a quantity."""

    number: float
    by: Any


def signed(quantity: Any) -> list[Any]:
    """Return a quantity to either side of 0."""
    return [quantity, Beside(0, quantity)]


class Pick:
    """Makes random choices; the same seed makes the same ones."""

    def __init__(self, seed: int) -> None:
        self._generator = np.random.default_rng(seed)

    def __call__(self, quantity: Any) -> float:
        """Return a value of a quantity."""
        match quantity:
            case Even(low, high):
                return float(self._generator.uniform(low, high))
            case Beside(number, by):
                return number - self(by)
            case (low, high) if isinstance(quantity, tuple):
                return 10 ** self(Even(math.log10(low), math.log10(high)))
            case [*options]:
                return self(self.one(*options))
        return float(quantity)

    def one(self, *options: T) -> T:
        """Return one of the options; all are equally likely."""
        return options[int(self._generator.integers(len(options)))] if len(options) > 1 else options[0]


@dataclass(frozen=True)
class Parts:
    """A scene put together: masses in kg and over each other, lengths over the radius, inertias over m a^2."""

    radius: Any
    load: Any
    can: Any
    """The can's mass over that of the load."""
    rim: Any
    """The can's inertia."""
    offset: Any
    own: Any
    """The load's own inertia."""
    incline: Any
    """[degrees]"""
    gravity: Any = GRAVITY

    def __call__(self, pick: Pick) -> Scene:
        """Return a scene."""
        radius, load = pick(self.radius), pick(self.load)
        mass = load * pick(self.can)
        can = Can(radius, 3 * radius, mass, mass * radius**2 * pick(self.rim))
        beer = Load(load, radius * pick(self.offset), load * radius**2 * pick(self.own))
        return Scene(can, beer, math.radians(pick(self.incline)), pick.one(*ATTACHMENTS), pick(self.gravity))


_STEADY = Parts([(0.01, 0.3)], 0.1, (1, 1e5), [0.5, 1.0], [1.0, (1e-3, 1)], [0.0, 0.1], [0.0, Even(-20, 20)])
"""A can so heavy that the inertia hardly depends on the angle."""
_RATIOS = Parts(
    [0.033, (1e-3, 10)], [0.1, (1e-4, 1e3)], (1e-4, 1e4), [0.5, 1.0, (1e-12, 1)],
    [1.0, Even(0, 1), Beside(1, (1e-15, 1)), (1e-12, 1)], [0.0, 0.3, (1e-12, 1)], Even(-20, 20),
)  # fmt: skip
_ANYTHING = Parts(
    (1e-3, 33), (1e-6, 1e4), [0.0, (1e-4, 1e4)], [0.0, 0.5, 1.0, Even(0, 1)], [0.0, 1.0, (1e-9, 1), Even(0, 1)],
    [0.0, (1e-12, 1), Even(0, 1)], [0.0, 1e-8, 10.0, 89.9, Even(-30, 30), Even(-89.9, 89.9)],
    [GRAVITY, GRAVITY, GRAVITY, 0.0, (1e-3, 1e3)],
)  # fmt: skip
"""Sizes, masses and gravities over their decades, with special cases about as often as others."""


def _ordinary(pick: Pick) -> Scene:
    """Return a scene of the paper, on a moderate incline, with a can of any size that one can carry."""
    incline, radius = math.radians(pick([0.0, 10.0, Even(-20, 20)])), pick([0.033, (0.01, 0.3)])
    kind = pick.one("beer", "beer", "beer", "pendulum", "hoop")
    if kind == "pendulum":
        return pendulum(incline, pick((0.02, 2)), pick((0.01, 1)), radius * pick(Even(0.2, 1)), radius, 3 * radius)
    if kind == "hoop":
        return hoop(incline, pick((2e-3, 0.2)), 0.2, radius, 3 * radius)
    can = pick.one(Can.massless, Can.sheet_metal)(radius, 3.6 * radius)
    return pick.one(sliding, frozen)(incline, pick([0.5, Even(0.05, 1)]), can)


def _fills(pick: Pick) -> Scene:
    """Return a scene with a film of beer, or with a can that is nearly full."""
    fill, can = pick([(1e-4, 0.1), Beside(1, (1e-9, 0.1))]), pick.one(Can.massless, Can.sheet_metal)()
    return pick.one(sliding, frozen)(math.radians(pick(Even(-20, 20))), fill, can)


def _steep(pick: Pick) -> Scene:
    incline = math.radians(pick(signed([Even(30, 89.9), Beside(90, (1e-6, 1))])))
    return replace(_ordinary(pick), incline=incline)


def _gravity(pick: Pick) -> Scene:
    """Return a scene in no gravity, on an asteroid, or on a star."""
    return replace(_ordinary(pick), gravity=pick([0.0, (1e-3, 1), (20, 1e3)]))


def _liquid(pick: Pick) -> Scene:
    """Return a can with a real liquid in it."""
    can = pick.one(Can.massless, Can.sheet_metal)(pick([0.033, (0.02, 0.1)]))
    return liquid(pick.one(*NAMES), math.radians(pick(Even(-15, 15))), pick(Even(0.05, 0.95)), can)


def _metal(pick: Pick) -> Scene:
    """Return a can of sheet metal, as one attaches it to a world."""
    can = Can.sheet_metal(pick([0.033, (0.02, 0.1)]))
    return pick.one(sliding, frozen)(math.radians(pick(Even(-15, 15))), pick(Even(0.1, 0.9)), can)


def _damped(pick: Pick, scene: Scene) -> Scene:
    """Return a scene with a sliding load and with damping over twelve decades, drag over eight, or both.

    The unit of damping is M a^2 over the time of a fall through the radius, and that of drag is M/a; the torque may
    grow with several powers of the slip rate.
    """
    radius, mass, clock = scene.can.radius, scene.effective_mass, _clock(scene)
    linear = mass * radius**2 / clock * pick((1e-6, 1e6))
    squared = Damping(linear, linear * clock * pick((1e-6, 1e2)))
    cubed = Damping(pick([0.0, linear]), *(linear * clock**power * pick((1e-6, 1e2)) for power in (1, 2)))
    law = pick.one(linear, linear, squared, cubed, 0.0)
    drag = mass / radius * pick((1e-6, 1e2))
    return replace(scene, attachment="sliding", damping=law, drag=pick.one(drag, drag if law == 0 else 0.0))


def _clock(scene: Scene) -> float:
    """Return the time of a fall through the radius [s], or a second without gravity: the pace of a scene."""
    return math.sqrt(scene.can.radius / scene.gravity) if scene.gravity > 0 else 1.0


_STARTS: dict[str, tuple[Any, Any]] = {
    "by hand": ([0.0, 1.0, math.pi, Even(-math.pi, math.pi), (1e-9, 1)], [0.0, 0.0, Even(-3, 3)]),
    "spun": (Even(-4, 4), signed([(2, 500), (2, 500), (1e2, 1e6)])),
    "far": (signed((1e2, 1e4)), [0.0, Even(-3, 3), signed((1e1, 1e5))]),
    "let go": (Even(-2.5, 2.5), 0.0),
}
"""phi [rad], and phi_dot over the clock's rate; a start beside the separatrix is no row."""


def _start(pick: Pick, scene: Scene, name: str) -> tuple[float, float]:
    """Return a start; beside a barrier's top, without damping, or anywhere with nearly the energy of that top."""
    try:
        low, high = replace(scene, damping=0.0, drag=0.0).separatrix() if name == "separatrix" else (0.0, 0.0)
    except NoEquilibriumError:
        name = "by hand"
    if name != "separatrix":
        phi0, rate = (pick(quantity) for quantity in _STARTS[name])
        return phi0, rate / _clock(scene)
    beside = pick(signed((1e-15, 0.1)))
    if pick.one(True, False):
        return pick.one(low, high) + beside, 0.0
    phi0, form = pick(Even(low, high)), scene.oscillator
    rate = math.sqrt(2 * max(0.0, float(form.drop(phi0, high))) / float(form.inertia(phi0)))
    return phi0, pick.one(1, -1) * rate * (1 + beside)


_MANY_STEPS, _NEARLY = (20, 3000), [1.0, Beside(1, signed((1e-12, 0.1)))]
_WHOLE = [math.pi * part * times for part in (0.5, 1.0, 2.0, 4.0, 8.0, 16.0) for times in (1, 1, 1, 2, 3)]
_PACES: dict[str, tuple[str, Any, Any]] = {
    "usual": ("clock", (1e-3, 0.3), _MANY_STEPS),
    "swinging": ("swing", (1e-3, 0.1), _MANY_STEPS),
    "extreme": ("fast", (1e-4, 3), (10, 1e4)),
    "turning": ("turn", (1e-2, 1e2), _MANY_STEPS),
    # A whole number of turns, or nearly, in a step or a part of one: RK4 evaluates forces at half steps, and a run at
    # half the timestep at quarters of them, all of which then see the same angle.
    "resonant": ("turn", _WHOLE, [(2, 30), (2, 500)]),
    "few": ("clock", (1e-6, 3), Even(1, 6)),
    "long": ("second", (5e-3, 3e-2), (4e3, 1.5e4)),
    "desk": ("second", (1e-4, 1e-3), (100, 2000)),
}
"""The unit of the timestep, the timestep, and the number of steps."""


def _pace(pick: Pick, scene: Scene, start: tuple[float, float], name: str) -> tuple[float, int]:
    """Return timestep [s] and number of steps at one of the paces, or less: as much as theory can follow."""
    spin, frequency, form, clock = abs(start[1]), _frequency(scene, start), scene.oscillator, _clock(scene)
    unit, timestep, steps = _PACES[name]
    units = {"clock": clock, "second": 1.0, "turn": 1 / max(spin, 1 / clock), "fast": clock / max(1.0, spin * clock)}
    units["swing"] = 2 * math.pi / max(frequency, spin, 1e-3 / clock)
    step = units[unit] * pick(timestep) * (pick(_NEARLY) if name == "resonant" else 1.0)
    share = _DAMPED if scene.dissipates else 1.0
    push = max(abs(form.ramp) / (form.base + (form.chord + form.coupling) / 2), 1e-300)
    if scene.dissipates:  # the load may turn with the can
        push = max(push, scene.gravity * abs(math.sin(scene.incline)) / scene.can.radius)
    longest = min(share * _TURNED / max(spin, 1e-300), math.sqrt(2 * share * _TURNED / push))
    if frequency > 0:
        longest = min(longest, share * _SWINGS * 2 * math.pi / frequency)
    step = min(step, longest)
    return step, max(1, int(min(pick(steps), longest / step)))


def _frequency(scene: Scene, start: tuple[float, float]) -> float:
    """Return about the angular frequency of the swing of a start [rad/s].

    Where the can is light and the load has next to no inertia, a small swing about the bottom is faster by many decades
    than a large one.
    """
    form = scene.oscillator
    if form.depth == 0:
        return 0.0
    kinetic = float(form.inertia(start[0])) * start[1] ** 2 / 2
    height = 2 * form.depth * math.sin((start[0] - form.bottom) / 2) ** 2
    square = min(1.0, 2 * (kinetic + height) / form.depth)  # of the swing's amplitude
    return math.sqrt(form.depth / (form.base + (form.chord / 4 + form.coupling) * square / 2))


def _setting(pick: Pick, scene: Scene, kind: str) -> dict[str, Any]:
    """Return any setting that the scene allows, in every fourth run a tolerance unless it is in contact.

    A "contact" has next to no friction, or plenty; "any" may be one that MuJoCo cannot have; "attached" is a can in a
    world of its own, which steps it accurately.
    """
    if kind == "attached":
        return {"rolling": "contact", "integrator": "RK4", "attached": True}
    rollings = [*(each for each in ROLLINGS if supported(scene, each)), *(ROLLINGS if kind == "any" else ())]
    rolling, friction = ("contact", (0.01, 10)) if kind == "contact" else (pick.one(*rollings), [1.0, 1.0, (0.01, 1e3)])
    setting: dict[str, Any] = {"rolling": rolling, "friction": pick(friction)}
    if rolling != "contact" and pick.one(True, False, False, False):
        return setting | {"tolerance": pick((1e-12, 0.03))}
    return setting | {"integrator": pick.one(*MUJOCO_INTEGRATORS, "RK4", "DOP853", "DOP853")}


def _samples(pick: Pick, steps: int, anywhere: bool, kind: str) -> dict[str, Any]:
    """Return samples of a kind, as fields of a trial: `anywhere`, or at whole numbers of timesteps.

    "regular" ones are at every timestep, or every so many, "sparse" are two to six, and "late" is the last alone, or
    with the one before.
    """
    if kind == "regular":
        return {"every": max(1, -(-steps // pick.one(_MANY, 10 * _MANY)))}
    if kind == "late":
        return {"moments": tuple(sorted({float(max(0, steps - pick.one(0, 0, 1))), float(steps)}))}
    moments = {pick(Even(0, steps)) for _ in range(pick.one(2, 3, 4, 5, 6))}
    return {"moments": tuple(sorted(moments if anywhere else {float(round(moment)) for moment in moments}))}


class Region(NamedTuple):
    """A part of the search: what its trials choose from for scene, start, pace, setting and samples."""

    name: str
    scenes: Sequence[Callable[[Pick], Scene]] = (_ordinary,)
    starts: Sequence[str] = ("by hand",)
    paces: Sequence[str] = ("usual",)
    setting: str = "usual"
    samples: Sequence[str] = ("regular",)
    damped: bool = False

    def draw(self, pick: Pick) -> Trial:
        """Return a random trial of this region.

        Raises:
          ParameterError: if the choices make a scene that cannot be, or a start or timestep outside the domain.
        """
        scene = pick.one(*self.scenes)(pick)
        scene = _damped(pick, scene) if self.damped else scene
        start = _start(pick, scene, pick.one(*self.starts))
        timestep, steps = _pace(pick, scene, start, pick.one(*self.paces))
        setting = _setting(pick, scene, self.setting)
        setting |= _samples(pick, steps, setting.get("integrator") in (None, "DOP853"), pick.one(*self.samples))
        require.start(*start)
        require.within("timestep", timestep, *require.TIMESTEP)
        return Trial(scene, *start, timestep=timestep, steps=steps, **setting)


_ANY = (_ordinary, _STEADY, _ANYTHING, _RATIOS, _fills, _steep, _gravity)
_ANY_START, _ANY_PACE = ("by hand", "by hand", "spun", "far", "separatrix"), tuple(_PACES)[:-1]
_MOSTLY, _HEAVY, _EITHER = (_ordinary, _ordinary, _ANYTHING), (_STEADY, _STEADY, _ordinary), ("usual", "swinging")
_SAMPLES = ("regular", "sparse", "late")
REGIONS = (
    Region("ordinary"),
    Region("anything", (_ANYTHING,), _ANY_START, ("extreme",), "any"),
    Region("sparse samples", _MOSTLY, paces=_EITHER, samples=("sparse",)),
    Region("single late sample", _MOSTLY, paces=_EITHER, samples=("late",)),
    Region("few steps", paces=("few",)),
    Region("fast rotation", _HEAVY, ("spun",), ("turning",)),
    Region("resonance", _HEAVY, ("spun",), ("resonant",), samples=_SAMPLES),
    Region("contact friction", setting="contact"),
    Region("mass ratios", (_RATIOS,), paces=_EITHER),
    Region("thin or full", (_fills,), paces=_EITHER, samples=_SAMPLES),
    Region("long", paces=("long",), samples=_SAMPLES),
    Region("far angles", starts=("far",), samples=_SAMPLES),
    Region("steep", (_steep,)),
    Region("weak or strong gravity", (_gravity,)),
    Region("beside the separatrix", starts=("separatrix",), samples=_SAMPLES),
    Region("mixed", _ANY, _ANY_START, _ANY_PACE, "any", _SAMPLES),
    Region("liquids", (_liquid,), paces=_EITHER),
    Region("attached", (_metal,), ("let go",), ("desk",), "attached"),
    Region("damped", paces=_EITHER, damped=True),
    Region("damped, mixed", _ANY, _ANY_START, _ANY_PACE, "any", _SAMPLES, damped=True),
)
"""All regions; as many trials are drawn from each."""


def random_trial(number: int) -> Trial:
    """Return the trial of a number from 0 on, in the regions by turns.

    The regions are wider than the domain: what it refuses counts as refused, and is not drawn again.

    Raises:
      ParameterError: if the scene, the start or the timestep is outside the domain.
    """
    return REGIONS[number % len(REGIONS)].draw(Pick(number))
