"""Regions of random trials, as rows of data: what one has on a desk, and what nobody has.

Each takes one thing or all to its extremes: it chooses scene, start, pace, setting and samples. A trial depends on its
number alone.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any, NamedTuple, TypeVar

import numpy as np

from mjbeer import require
from mjbeer.exceptions import NoEquilibriumError, ParameterError, liquid_notes
from mjbeer.model.setting import DOP853, INTEGRATORS, ROLLINGS, supported
from mjbeer.studies.stability.judge import Trial
from mjbeer.theory.can import Can
from mjbeer.theory.damping import Damping
from mjbeer.theory.liquid import NAMES, liquid
from mjbeer.theory.load import Load
from mjbeer.theory.named import frozen, hoop, pendulum, sliding
from mjbeer.theory.scene import ATTACHMENTS, GRAVITY, Scene

T = TypeVar("T")
Start = tuple[float, float]
"""phi [rad] and phi_dot [rad/s]."""
_SWINGS, _TURNED = 400.0, 3e3
"""Longest motion, in swings, and in angle [rad], which theory can follow."""
_DAMPED = 0.05
"""Share of these that a damped motion may have, which theory follows step by step."""
_MANY = 200
"""Largest number of regular samples after the start, so that repeating a run takes few of them."""


class Pick:
    """Makes random choices; the same seed makes the same ones."""

    def __init__(self, seed: int) -> None:
        self._generator = np.random.default_rng(seed)

    def between(self, low: float, high: float) -> float:
        """Return a number between two others, from an even distribution."""
        return float(self._generator.uniform(low, high))

    def decades(self, low: float, high: float) -> float:
        """Return a number between two positive others whose logarithm is evenly distributed."""
        return 10 ** self.between(math.log10(low), math.log10(high))

    def one(self, *options: T) -> T:
        """Return one of the options; all are equally likely, and a single one takes no choice."""
        return options[int(self._generator.integers(len(options)))] if len(options) > 1 else options[0]

    def sign(self) -> int:
        """Return 1 or -1."""
        return self.one(1, -1)

    def chance(self, probability: float) -> bool:
        return bool(self._generator.random() < probability)


def slow(scene: Scene) -> float:
    """Return the time of a fall through the radius [s], or a second without gravity: the pace of a scene."""
    return math.sqrt(scene.can.radius / scene.gravity) if scene.gravity > 0 else 1.0


def _ordinary(pick: Pick) -> Scene:
    """Return a scene of the paper, on a moderate incline, with a can of any size that one can carry."""
    incline = math.radians(pick.one(0.0, 10.0, pick.between(-20, 20)))
    radius = pick.one(0.033, pick.decades(0.01, 0.3))
    kind = pick.one("beer", "beer", "beer", "pendulum", "hoop")
    if kind == "pendulum":
        offset = radius * pick.between(0.2, 1)
        return pendulum(incline, pick.decades(0.02, 2), pick.decades(0.01, 1), offset, radius, 3 * radius)
    if kind == "hoop":
        return hoop(incline, pick.decades(2e-3, 0.2), 0.2, radius, 3 * radius)
    make, can = pick.one(sliding, frozen), pick.one(Can.massless, Can.sheet_metal)
    return make(incline, pick.one(0.5, pick.between(0.05, 1)), can(radius, 3.6 * radius))


def _steady(pick: Pick) -> Scene:
    """Return a scene whose inertia hardly depends on the angle, as the can is much heavier than its load."""
    radius, mass = pick.decades(0.01, 0.3), pick.decades(0.1, 1e6)
    load = Load(0.1, radius * pick.one(1.0, pick.decades(1e-3, 1)), 0.1 * radius**2 * pick.one(0.0, 0.1))
    can = Can(radius, 3 * radius, mass, mass * radius**2 * pick.one(0.5, 1.0))
    return Scene(can, load, math.radians(pick.one(0.0, pick.between(-20, 20))), pick.one(*ATTACHMENTS))


def _fills(pick: Pick) -> Scene:
    """Return a scene with a film of beer, or with a can that is nearly full."""
    fill = pick.one(pick.decades(1e-5, 0.1), 1 - pick.decades(1e-9, 0.1))
    can = pick.one(Can.massless, Can.sheet_metal)
    return pick.one(sliding, frozen)(math.radians(pick.between(-20, 20)), fill, can())


def _steep(pick: Pick) -> Scene:
    """Return a scene on a steep incline, to either side."""
    scene, side = _ordinary(pick), pick.sign()
    return replace(scene, incline=side * math.radians(pick.one(pick.between(30, 89.9), 90 - pick.decades(1e-6, 1))))


def _gravity(pick: Pick) -> Scene:
    """Return a scene in no gravity, on an asteroid, or on a star."""
    return replace(_ordinary(pick), gravity=pick.one(0.0, pick.decades(1e-3, 1), pick.decades(20, 1e3)))


def _ratios(pick: Pick) -> Scene:
    """Return a scene of a can and a load with very different masses and moments of inertia."""
    radius, load_mass = pick.one(0.033, pick.decades(1e-3, 10)), pick.one(0.1, pick.decades(1e-6, 1e3))
    mass = load_mass * pick.decades(1e-6, 1e6)
    can = Can(radius, 3 * radius, mass, mass * radius**2 * pick.one(0.5, 1.0, pick.decades(1e-12, 1)))
    offset = radius * pick.one(1.0, pick.between(0, 1), 1 - pick.decades(1e-15, 1), pick.decades(1e-12, 1))
    load = Load(load_mass, offset, load_mass * radius**2 * pick.one(0.0, 0.3, pick.decades(1e-12, 1)))
    return Scene(can, load, math.radians(pick.between(-20, 20)), pick.one(*ATTACHMENTS))


def _anything(pick: Pick) -> Scene:
    """Return a scene from anywhere: sizes, masses and gravities are spread over their decades.

    Special cases (an empty can, a full can, a point load, no gravity, no incline) are about as frequent as others.
    """
    radius, load_mass = pick.decades(1e-4, 33), pick.decades(1e-9, 1e6)
    mass = pick.one(0.0, load_mass * pick.decades(1e-6, 1e6))
    can = Can(radius, 3 * radius, mass, mass * radius**2 * pick.one(0.0, 0.5, 1.0, pick.between(0, 1)))
    fill = pick.one(1e-6, 1 - 1e-6, 1.0, 0.5, pick.between(1e-6, 1))
    segment = Load.segment(radius, 3 * radius, fill, load_mass / (3 * math.pi * radius**3))
    offset = radius * pick.one(0.0, 1.0, pick.decades(1e-9, 1), pick.between(0, 1))
    inertia = load_mass * radius**2 * pick.one(0.0, pick.decades(1e-12, 1), pick.between(0, 1))
    load = pick.one(segment, Load(load_mass, offset, inertia))
    incline = pick.one(0.0, 1e-8, 10.0, 89.9, pick.between(-30, 30), pick.between(-89.9, 89.9))
    weight = pick.one(GRAVITY, GRAVITY, GRAVITY, 0.0, pick.decades(1e-3, 1e3))
    return Scene(can, load, math.radians(incline), pick.one(*ATTACHMENTS), weight)


def _damped(pick: Pick, scene: Scene) -> Scene:
    """Return a scene with a sliding load and with damping over twelve decades, drag over eight, or both.

    The unit of damping is M a^2 over the time of a fall through the radius, and that of drag is M/a; the torque may
    grow with several powers of the slip rate.
    """
    radius, mass, clock = scene.can.radius, scene.effective_mass, slow(scene)
    linear = mass * radius**2 / clock * pick.decades(1e-6, 1e6)
    squared = Damping(linear, linear * clock * pick.decades(1e-6, 1e2))
    cubed = Damping(pick.one(0.0, linear), *(linear * clock**power * pick.decades(1e-6, 1e2) for power in (1, 2)))
    law = pick.one(linear, linear, squared, cubed, 0.0)
    drag = mass / radius * pick.decades(1e-6, 1e2)
    return replace(scene, attachment="sliding", damping=law, drag=pick.one(drag, drag if law == 0 else 0.0))


def _liquid(pick: Pick) -> Scene:
    """Return a can with a real liquid in it."""
    can = pick.one(Can.massless, Can.sheet_metal)(pick.one(0.033, pick.decades(0.02, 0.1)))
    with liquid_notes():
        return liquid(pick.one(*NAMES), math.radians(pick.between(-15, 15)), pick.between(0.05, 0.95), can)


def _metal(pick: Pick) -> Scene:
    """Return a can of sheet metal, as one attaches it to a world."""
    can = Can.sheet_metal(pick.one(0.033, pick.decades(0.02, 0.1)))
    return pick.one(sliding, frozen)(math.radians(pick.between(-15, 15)), pick.between(0.1, 0.9), can)


def _by_hand(pick: Pick, scene: Scene) -> Start:
    """Return a start such as one makes by hand: let go, pushed or spun."""
    phi0 = pick.one(0.0, 1.0, math.pi, pick.between(-math.pi, math.pi), pick.decades(1e-9, 1))
    return phi0, pick.one(0.0, 0.0, pick.between(-3, 3)) / slow(scene)


def _let_go(pick: Pick, scene: Scene) -> Start:
    return pick.between(-2.5, 2.5), 0.0


def _spun(pick: Pick, scene: Scene) -> Start:
    """Return a start with a spin much faster than any swing."""
    spin = pick.one(pick.decades(2, 500), pick.decades(2, 500), pick.decades(1e2, 1e6))
    return pick.between(-4, 4), pick.sign() * spin / slow(scene)


def _far(pick: Pick, scene: Scene) -> Start:
    """Return a start many turns away, at rest, slow, or so fast that seconds take it many turns away."""
    phi0 = pick.sign() * pick.decades(1e2, 1e4)
    return phi0, pick.one(0.0, pick.between(-3, 3) / slow(scene), pick.sign() * pick.decades(1e2, 1e6))


def _beside_the_separatrix(pick: Pick, scene: Scene) -> Start:
    """Return a start at rest beside a barrier's top, or anywhere with nearly the energy of that top.

    The top is that of the scene without damping and drag.
    """
    form = scene.oscillator
    try:
        low, high = replace(scene, damping=0.0, drag=0.0).separatrix()
    except NoEquilibriumError:
        return _by_hand(pick, scene)
    beside = pick.sign() * pick.decades(1e-15, 0.1)
    if pick.chance(0.5):
        return pick.one(low, high) + beside, 0.0
    phi0 = pick.between(low, high)
    missing = max(0.0, float(form.drop(phi0, high)))
    rate = math.sqrt(2 * missing / float(form.inertia(phi0)))
    return phi0, pick.sign() * rate * (1 + beside)


def _steps(pick: Pick) -> float:
    return pick.decades(20, 3000)


def _resonant(pick: Pick, clock: float, spin: float, frequency: float) -> tuple[float, float]:
    """Return a whole number of turns, or nearly, in a step or a part of one.

    RK4 evaluates forces at half steps, and a run at half the timestep at quarters of them: all see the same angle.
    """
    whole = 2 * math.pi * (pick.one(0.25, 0.5, 1.0, 2.0, 4.0, 8.0) * pick.one(1, 1, 1, 2, 3))
    timestep = whole * (1 + pick.one(0.0, pick.sign() * pick.decades(1e-12, 0.1))) / max(spin, 1 / clock)
    return timestep, pick.one(pick.decades(2, 30), pick.decades(2, 500))


def _long(pick: Pick, clock: float, spin: float, frequency: float) -> tuple[float, float]:
    """Return 20 to 200 s in thousands of steps."""
    duration, steps = pick.decades(20, 200), pick.decades(2e3, 1.5e4)
    return duration / steps, steps


_PACES: dict[str, Callable[[Pick, float, float, float], tuple[float, float]]] = {
    "usual": lambda pick, clock, *_: (clock * pick.decades(1e-3, 0.3), _steps(pick)),
    "swinging": lambda pick, clock, spin, frequency: (
        2 * math.pi / max(frequency, spin, 1e-3 / clock) / pick.decades(10, 1000),
        _steps(pick),
    ),
    "extreme": lambda pick, clock, spin, _: (
        clock / max(1.0, spin * clock) * pick.decades(1e-4, 3),
        pick.decades(10, 1e4),
    ),
    "turning": lambda pick, clock, spin, _: (pick.decades(1e-2, 1e2) / max(spin, 1 / clock), _steps(pick)),
    "resonant": _resonant,
    "few": lambda pick, clock, *_: (clock * pick.decades(1e-6, 3), pick.between(1, 6)),
    "long": _long,
    "desk": lambda pick, *_: (pick.decades(1e-4, 1e-3), pick.decades(100, 2000)),
}
"""Timestep [s] and number of steps of a scene with a clock, the time of a fall through the radius [s], and the rates of
its spin and its swing [rad/s]: of the clock, of a small swing or a turn, far too small or too large, by 0.01 to 100 rad
a step, in resonance, one step to five, many seconds, or as one steps a can on a desk."""


def _pace(pick: Pick, scene: Scene, start: Start, name: str) -> tuple[float, int]:
    """Return timestep [s] and number of steps at one of the paces, or less: as much as theory can follow."""
    spin, frequency, form = abs(start[1]), _frequency(scene, start), scene.oscillator
    timestep, steps = _PACES[name](pick, slow(scene), spin, frequency)
    share = _DAMPED if scene.dissipates else 1.0
    push = max(abs(form.slope) / (form.base + (form.chord + form.swing) / 2), 1e-300)
    if scene.dissipates:  # the load may turn with the can
        push = max(push, scene.gravity * abs(math.sin(scene.incline)) / scene.can.radius)
    longest = min(share * _TURNED / max(spin, 1e-300), math.sqrt(2 * share * _TURNED / push))
    if frequency > 0:
        longest = min(longest, share * _SWINGS * 2 * math.pi / frequency)
    timestep = min(timestep, longest)
    return timestep, max(1, int(min(steps, longest / timestep)))


def _frequency(scene: Scene, start: Start) -> float:
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
    return math.sqrt(form.depth / (form.base + (form.chord / 4 + form.swing) * square / 2))


def _usual_setting(pick: Pick, scene: Scene) -> dict[str, Any]:
    """Return any way of rolling that the scene allows, any integrator, and in every fourth run a tolerance."""
    rolling = pick.one(*(way for way in ROLLINGS if supported(scene, way)))
    tolerance = None
    if rolling != "contact" and pick.chance(0.25):  # a stiff contact would need too many steps to reach it
        tolerance = 10 ** -pick.between(1.5, 12)
    friction = pick.one(1.0, 1.0, pick.decades(0.01, 10), pick.decades(1e-2, 1e3))
    integrator = pick.one(*INTEGRATORS, "RK4", DOP853, DOP853)
    return {"rolling": rolling, "integrator": integrator, "tolerance": tolerance, "friction": friction}


def _contact(pick: Pick, scene: Scene) -> dict[str, Any]:
    """Return a contact with next to no friction, or plenty."""
    integrator = pick.one(*INTEGRATORS, "RK4", DOP853)
    return {"rolling": "contact", "integrator": integrator, "tolerance": None, "friction": pick.decades(0.01, 10)}


def _attached(pick: Pick, scene: Scene) -> dict[str, Any]:
    """Return a can that lies in a world of its own, which steps it accurately."""
    return {"rolling": "contact", "integrator": "RK4", "tolerance": None, "attached": True}


def _any_setting(pick: Pick, scene: Scene) -> dict[str, Any]:
    """Return any setting, also where MuJoCo cannot have the scene that way."""
    setting = _usual_setting(pick, scene)
    rolling = pick.one(setting["rolling"], setting["rolling"], *ROLLINGS)
    return setting | {"rolling": rolling, "tolerance": setting["tolerance"] if rolling != "contact" else None}


def _samples(pick: Pick, steps: int, anywhere: bool, kind: str) -> dict[str, Any]:
    """Return samples of a kind, as fields of a trial: `anywhere`, or at whole numbers of timesteps.

    "regular" ones are at every timestep, or every so many, "sparse" are two to six, and "late" is the last alone, or
    with the one before.
    """
    if kind == "regular":
        return {"every": max(1, -(-steps // pick.one(_MANY, 10 * _MANY)))}
    if kind == "late":
        return {"moments": tuple(sorted({float(max(0, steps - pick.one(0, 0, 1))), float(steps)}))}
    count = pick.one(2, 3, 4, 5, 6)
    moments = {pick.between(0, steps) for _ in range(count)}
    return {"moments": tuple(sorted(moments if anywhere else {float(round(moment)) for moment in moments}))}


class Region(NamedTuple):
    """A part of the search: what its trials choose from for scene, start, pace, setting and samples."""

    name: str
    scenes: Sequence[Callable[[Pick], Scene]] = (_ordinary,)
    starts: Sequence[Callable[[Pick, Scene], Start]] = (_by_hand,)
    paces: Sequence[str] = ("usual",)
    setting: Callable[[Pick, Scene], dict[str, Any]] = _usual_setting
    samples: Sequence[str] = ("regular",)
    damped: bool = False

    def draw(self, pick: Pick) -> Trial:
        """Return a random trial of this region.

        Raises:
          ParameterError: if the choices make a scene that cannot be, or a start or timestep outside the domain.
        """
        scene = pick.one(*self.scenes)(pick)
        if self.damped:
            scene = _damped(pick, scene)
        start = pick.one(*self.starts)(pick, scene)
        timestep, steps = _pace(pick, scene, start, pick.one(*self.paces))
        setting = self.setting(pick, scene)
        anywhere = setting["tolerance"] is not None or setting["integrator"] == DOP853
        if setting["tolerance"] is not None:
            setting["integrator"] = None
        setting |= _samples(pick, steps, anywhere, pick.one(*self.samples))
        require.start(*start)
        require.within("timestep", timestep, *require.TIMESTEP)
        return Trial(scene, *start, timestep=timestep, steps=steps, **setting)


_ANY_SCENE = (_ordinary, _steady, _anything, _ratios, _fills, _steep, _gravity)
_ANY_START = (_by_hand, _by_hand, _spun, _far, _beside_the_separatrix)
_MOSTLY_ORDINARY, _MOSTLY_STEADY = (_ordinary, _ordinary, _anything), (_steady, _steady, _ordinary)
_EITHER_PACE, _ANY_PACE = ("usual", "swinging"), tuple(_PACES)
_ANY_SAMPLES = ("regular", "sparse", "late")
REGIONS = (
    Region("ordinary"),
    Region("anything", (_anything,), _ANY_START, ("extreme",), _any_setting),
    Region("sparse samples", _MOSTLY_ORDINARY, paces=_EITHER_PACE, samples=("sparse",)),
    Region("single late sample", _MOSTLY_ORDINARY, paces=_EITHER_PACE, samples=("late",)),
    Region("few steps", paces=("few",)),
    Region("fast rotation", _MOSTLY_STEADY, (_spun,), ("turning",)),
    Region("resonance", _MOSTLY_STEADY, (_spun,), ("resonant",), samples=_ANY_SAMPLES),
    Region("contact friction", setting=_contact),
    Region("mass ratios", (_ratios,), paces=_EITHER_PACE),
    Region("thin or full", (_fills,), paces=_EITHER_PACE, samples=_ANY_SAMPLES),
    Region("long", paces=("long",), samples=_ANY_SAMPLES),
    Region("far angles", starts=(_far,), samples=_ANY_SAMPLES),
    Region("steep", (_steep,)),
    Region("weak or strong gravity", (_gravity,)),
    Region("beside the separatrix", starts=(_beside_the_separatrix,), samples=_ANY_SAMPLES),
    Region("mixed", _ANY_SCENE, _ANY_START, _ANY_PACE, _any_setting, _ANY_SAMPLES),
    Region("liquids", (_liquid,), paces=_EITHER_PACE),
    Region("attached", (_metal,), (_let_go,), ("desk",), _attached),
    Region("damped", paces=_EITHER_PACE, damped=True),
    Region("damped, mixed", _ANY_SCENE, _ANY_START, _ANY_PACE, _any_setting, _ANY_SAMPLES, damped=True),
)
"""All regions; as many trials are drawn from each."""


def random_trial(number: int) -> Trial:
    """Return the trial of a number from 0 on, in the regions by turns."""
    pick, region = Pick(number), REGIONS[number % len(REGIONS)]
    while True:
        try:
            return region.draw(pick)
        except ParameterError:  # outside the domain: choose again
            pass
