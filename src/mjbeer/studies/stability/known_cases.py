"""Stiff and extreme cases, and cases in which the search found errors, each with the reason."""

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import NamedTuple

from mjbeer.exceptions import NoEquilibriumError
from mjbeer.model.setting import ROLLINGS
from mjbeer.studies.stability.judge import Trial
from mjbeer.theory.can import Can, Load
from mjbeer.theory.paper_scenes import frozen, hoop, pendulum, sliding
from mjbeer.theory.record import ERROR
from mjbeer.theory.scene import Scene

TOLERANCE = 1e-9
"""Tolerance of the runs that are made to a tolerance [rad]."""
_STEPS = 300
"""Number of timesteps in a natural period."""
_METAL = Can.sheet_metal()
_SLIDING_OR_FROZEN = (("sliding", sliding), ("frozen", frozen))
_SCENES = (
    ("sliding", sliding(can=_METAL)),
    ("frozen", frozen()),
    ("pendulum", pendulum()),
)
_ADAPTED = ("tolerance",)
_FIXED = ("reduced", "equality")
_ALL = (*_FIXED, *_ADAPTED)
"""The settings that must be accurate: RK4 with "reduced" or "equality", and a tolerance."""


class Variant(NamedTuple):
    """One way to simulate a case."""

    setting: str
    """Way of rolling, integrator, and timestep or tolerance, in words."""
    trial: Trial
    within: float = math.inf
    """Largest error that the run may have [rad]. A scene that the way of rolling does not support
    must be refused instead."""


class KnownCase(NamedTuple):
    """A case: its name, the reason why it is a case, and its variants."""

    name: str
    why: str
    variants: tuple[Variant, ...]


def cases() -> list[KnownCase]:
    """Return all cases."""
    return [*_stiff(), *_extreme(), *_found_by_search()]


def natural_period(scene: Scene, phi_dot0: float = 0.0) -> float:
    """Return the time of a swing, a turn, or a fall by a radius [s], whichever decides a motion."""
    try:
        frequency = scene.frequency()
    except NoEquilibriumError:
        frequency = 0.0
    fastest = max(abs(phi_dot0), frequency or math.sqrt(scene.gravity / scene.can.radius))
    return 2 * math.pi / fastest if fastest else 1.0


def _motion(
    name: str,
    why: str,
    scene: Scene,
    phi0: float,
    phi_dot0: float = 0.0,
    accurate: tuple[str, ...] = _ALL,
    periods: float = 5.0,
) -> KnownCase:
    """Return a case with a variant for every way of rolling, and for a tolerance.

    Its motion lasts some natural `periods`. The settings in `accurate` must be accurate.
    """
    period = natural_period(scene, phi_dot0)
    timestep = period / _STEPS
    whole = Trial(
        scene,
        phi0,
        phi_dot0,
        timestep=timestep,
        steps=_steps(periods * period, timestep),
    )
    variants = []
    for rolling in ROLLINGS:
        trial = replace(whole, rolling=rolling, integrator="RK4")
        within = ERROR if rolling in accurate else math.inf
        variants.append(Variant(f"{rolling}, RK4, T/{_STEPS}", trial, within))
        if rolling != "contact":
            trial = replace(whole, rolling=rolling, tolerance=TOLERANCE)
            within = TOLERANCE if "tolerance" in accurate else math.inf
            setting = f"{rolling}, to a tolerance of {TOLERANCE:g}"
            variants.append(Variant(setting, trial, within))
    # The setting of a can on a desk is tried with every scene.
    duration = min(max(periods * period, 0.1), 30.0)
    desk = Trial(scene, phi0, phi_dot0, timestep=1e-3, steps=_steps(duration, 1e-3))
    variants.append(Variant("reduced, RK4, 1 ms", desk))
    return KnownCase(name, why, tuple(variants))


def _steps(duration: float, timestep: float) -> int:
    """Return the number of timesteps in a duration, to which rounding adds none."""
    return math.ceil(duration / timestep * (1 - 1e-10))


def _stiff() -> Iterator[KnownCase]:
    """Yield stiff motions."""
    why = "the mass matrix is badly conditioned"
    for ratio in (1e-3, 1e-2, 1.0, 1e2, 1e3):
        for kind, make in _SLIDING_OR_FROZEN:
            scene = make(can=Can.hoop(mass=ratio * Load.segment().mass))
            yield _motion(f"{kind}, can {ratio:.0e} times the load", why, scene, 1.0)
    yield _motion(
        "pendulum on a wheel of 0.1 g",
        "J falls to a thousandth at phi = 0, where the load swings through in a thousandth of the "
        "period",
        pendulum(wheel_mass=1e-4),
        1.0,
        accurate=_ADAPTED,
    )
    why = "at pi the tendon that gives the model its J has no length and no direction"
    for beside in (0.0, 1e-15, 1e-12, 1e-9, 1e-6, 1e-3):
        yield _motion(f"frozen, let go {beside:g} rad beside pi", why, frozen(), math.pi - beside)


def _extreme() -> Iterator[KnownCase]:
    """Yield extreme motions."""
    yield from _extreme_fills()
    yield from _extreme_inclines()
    for gravity in (0.0, 1e-3, 1e3):
        why = "nothing presses the can on the incline"
        phi_dot0 = 3.0
        if gravity > 0:
            why = "times are proportional to 1/sqrt(g)"
            phi_dot0 = 0.0
        for kind, make in _SLIDING_OR_FROZEN:
            scene = make(gravity=gravity, can=_METAL)
            yield _motion(f"{kind}, g = {gravity:g} m/s^2", why, scene, 1.0, phi_dot0)
    for kind, scene in _SCENES:
        yield from _extreme_starts(kind, scene)
    yield _motion(
        "point on the rim of a hoop, let go a quarter turn from the bottom",
        "at the bottom the point stands still, and J is the hoop's alone",
        hoop(),
        math.pi / 2,
    )
    yield _motion(
        "can with next to no inertia around a sliding load",
        "1e-20 kg m^2 are far below MuJoCo's smallest (mjMINVAL, 1e-15), and lost beside the "
        "load's 1e-5",
        Scene(Can(mass=1e-3, inertia=1e-20), Load.segment()),
        1.0,
        accurate=("reduced",),
    )


def _extreme_fills() -> Iterator[KnownCase]:
    """Yield motions of a thin film, and of cans that are full or nearly full."""
    for fill in (0.01, 0.03, 1 - 1e-3, 1 - 1e-6, 1.0):
        amount = f"{fill:g}" if fill < 0.5 or fill == 1 else f"1 - {1 - fill:.0e}"
        for kind, make in _SLIDING_OR_FROZEN:
            for wall, can in (("massless", None), ("metal", _METAL)):
                scene = make(fill=fill, can=can)
                name = f"{kind}, {wall} can, fill {amount}"
                if fill < 0.5:
                    yield _motion(name, "a thin film of beer", scene, 1.0)
                elif fill == 1 or kind == "frozen":
                    why = "b = 0, or nearly: hardly any torque acts on the load"
                    yield _motion(name, why, scene, 1.0)
                else:
                    yield _sliding_in_a_nearly_full_can(name, scene)


def _sliding_in_a_nearly_full_can(name: str, scene: Scene) -> KnownCase:
    """Return half a swing: where rounding disturbs the motion, a whole one would take minutes."""
    half_period = natural_period(scene) / 2
    distance = scene.acceleration() / 2 * half_period**2
    why = f"rounding of the {distance:.0e} m that it rolls is not small beside b"
    return _motion(name, why, scene, 1.0, accurate=(), periods=0.5)


def _extreme_inclines() -> Iterator[KnownCase]:
    """Yield motions on level and steep ground, and near the steepest one with an equilibrium."""
    for degrees in (0.0, 1e-8, 85.0):
        why = "level, or hardly tilted"
        accurate = _ALL
        if degrees > 1:
            why = "steep: little presses the can on the incline"
            accurate = _FIXED
        incline = math.radians(degrees)
        scenes = (("sliding, metal can", sliding(incline, can=_METAL)), ("frozen", frozen(incline)))
        for kind, scene in scenes:
            name = f"{kind}, incline {degrees:g} degrees"
            yield _motion(name, why, scene, 0.5, accurate=accurate)
    fold = math.sin(frozen().largest_incline())
    why = (
        "near the steepest incline with an equilibrium, eq. (53): a shallow well below, and a long "
        "rest above"
    )
    for beside in (-1e-2, -1e-6, 1e-6, 1e-2):
        scene = frozen(math.asin(fold * (1 + beside)))
        if beside < 0:
            side = "below"
            phi0 = scene.equilibrium() - 1e-3 * abs(beside) ** 0.5
        else:
            side = "above"
            phi0 = math.pi / 2 - scene.incline
        yield _motion(f"frozen, {abs(beside):.0e} {side} the fold", why, scene, phi0)


def _extreme_starts(kind: str, scene: Scene) -> Iterator[KnownCase]:
    """Yield motions that begin beside the separatrix, with a fast spin, or on top."""
    why = "rounding of the start grows as exp(lambda t) near the top"
    for beside, accurate in ((1e-2, _ADAPTED), (1e-6, ()), (1e-10, ())):
        _, top = scene.separatrix()
        name = f"{kind}, {beside:.0e} rad inside the separatrix"
        yield _motion(name, why, scene, top - beside, accurate=accurate)
    why = "the energy of a swing is tiny beside that of the spin"
    for spin in (1e2, 1e4):
        yield _motion(f"{kind}, spun at {spin:.0e} rad/s", why, scene, 0.5, spin)
    yield _motion(
        f"{kind}, let go at pi",
        "exactly on top a sliding load balances, unless rounding pushes it off, and a frozen one "
        "rolls down",
        scene,
        math.pi,
        accurate=(),
    )


def _single_run(
    name: str, why: str, setting: str, trial: Trial, within: float = math.inf
) -> KnownCase:
    """Return a case with one variant."""
    return KnownCase(name, why, (Variant(setting, trial, within),))


def _found_by_search() -> Iterator[KnownCase]:
    """Yield the cases in which the random search found errors."""
    for kind, scene in (
        ("pendulum", pendulum(gravity=1e-3)),
        ("frozen", frozen(gravity=1e-3)),
    ):
        yield _single_run(
            f"{kind} in contact in a gravity of 1e-3 m/s^2",
            "MuJoCo's solver stops once its cost falls by less than 1e-8 m^2/s^4: its tolerance "
            "has to scale with g^2",
            "contact, RK4",
            Trial(
                scene,
                1.0,
                rolling="contact",
                integrator="RK4",
                timestep=math.sqrt(0.033 / 1e-3) / 100,
                steps=3000,
            ),
            ERROR,
        )

    can = Can(0.025006609705965473, 0.075, 4961.58700106942, 3.102631823991216)
    load = Load(2589.3299018014327, 0.01647772919452516)
    scene = Scene(can, load, 0.1789453673759448)
    yield _single_run(
        "a swing through 2 rad, to a loose tolerance",
        "two runs were 1.4e-4 rad apart, but 1.1e-3 rad off: steps so large do not show the "
        "method's order",
        "to a tolerance",
        Trial(scene, 1.762099488321489, -10.949445992431022, tolerance=1e-3, steps=5040),
        1e-3,
    )

    _, top = pendulum().separatrix()
    yield _single_run(
        "pendulum, 1.9e-4 rad inside the separatrix, to a tolerance",
        "rounding grows a millionfold: two runs were by chance 3e-9 rad apart, and 7e-7 rad off",
        "to a tolerance",
        Trial(
            pendulum(),
            top - 1.9179754510771998e-4,
            timestep=9.52342486122195e-4,
            tolerance=1e-8,
            steps=1984,
        ),
    )

    can = Can(2.232597258875798, 6.697791776627394, 24.64135895693299, 122.82462012912089)
    load = Load(9007.68689806812, 0.9475437058226647, 14361.91170936032)
    yield _single_run(
        "frozen, 6e-10 rad beside the top, in contact",
        "the solver of the contact ignored the torque that moves the can, at half the timestep too",
        "contact, DOP853, 6 ms",
        Trial(
            Scene(can, load, 1.7453292519943295e-10, "frozen"),
            3.1415926530014993,
            rolling="contact",
            integrator="DOP853",
            timestep=0.006320380984655366,
            friction=479.9389762024384,
            steps=4187,
        ),
        ERROR,
    )

    yield _single_run(
        "a can that slips before its only sample",
        "slip has to be counted over all steps, whatever samples are asked for",
        "contact, DOP853, 0.19 ms",
        Trial(
            frozen(math.radians(9.4), can=_METAL),
            -1.13,
            rolling="contact",
            integrator="DOP853",
            timestep=1.9e-4,
            friction=0.0147,
            steps=90,
            moments=(90.0,),
        ),
    )

    scene = Scene(Can(0.033, 0.1, 61.0, 0.0332), Load(0.1, 0.0039, 1.09e-5), 0.0)
    rate = 1298.0
    yield _single_run(
        "four whole turns in a timestep",
        "RK4 sees the same angle at every half of its step, and at half the timestep too; uneven "
        "timesteps do not",
        "reduced, RK4, 19 ms",
        Trial(
            scene,
            -1.356,
            rate,
            integrator="RK4",
            timestep=8 * math.pi / rate,
            steps=12,
            moments=(12.0,),
        ),
    )

    can = Can(0.033, 0.099, 0.20528761908358859, 3.284134444100273e-11)
    load = Load(0.1, 0.023717555437268875, 4.4992031467605796e-24)
    yield _single_run(
        "a load without inertia in a can with next to none, to a tolerance",
        "two runs may miss the bottom alike; the energy drifts where a step does, and bounds the "
        "tolerance too",
        "to a tolerance",
        Trial(
            Scene(can, load, 0.1530378281024036),
            0.1741755317767891,
            47.46025974037111,
            tolerance=8.8e-5,
            steps=13_500,
        ),
        8.8e-5,
    )
