"""Stiff and extreme cases, and those in which the search found errors, each with why it is one."""

import math
from collections.abc import Iterator
from typing import Any, NamedTuple

from mjbeer.exceptions import NoEquilibriumError
from mjbeer.model.setting import ROLLINGS
from mjbeer.studies.stability.judge import Trial
from mjbeer.theory.can import Can, Load
from mjbeer.theory.record import ERROR
from mjbeer.theory.scene import Scene, frozen, hoop, pendulum, sliding

TOLERANCE = 1e-9
"""Tolerance of the runs that are made to a tolerance [rad]."""
_STEPS = 300
"""Timesteps a natural period."""
_METAL = Can.sheet_metal()
_EITHER = (("sliding", sliding), ("frozen", frozen))
_EVERYWHERE = (("sliding", sliding(can=_METAL)), ("frozen", frozen()), ("pendulum", pendulum()))
Ways = tuple[str, ...]
_SURE, _ADAPTED = ("reduced", "equality", "tolerance"), ("tolerance",)
"""The ways that must be accurate: with RK4 in reduced models and by an equality, and to a tolerance."""


class Variant(NamedTuple):
    """One way to simulate a case."""

    setting: str
    """Name of the way: of rolling, integrator, and timestep or tolerance."""
    trial: Trial
    within: float = math.inf
    """Largest error that the run must have [rad], unless no model can have it and it must be refused."""


class KnownCase(NamedTuple):
    """A case: its name, why it is one, and its variants."""

    name: str
    why: str
    variants: tuple[Variant, ...]


def cases() -> list[KnownCase]:
    """Return all cases."""
    return [*_stiff(), *_extreme(), *_found()]


def natural_period(scene: Scene, phi_dot0: float = 0.0) -> float:
    """Return the time scale of a motion [s]: a small swing or a turn, or else a fall through the radius."""
    try:
        frequency = scene.frequency()
    except NoEquilibriumError:
        frequency = 0.0
    fastest = max(abs(phi_dot0), frequency or math.sqrt(scene.gravity / scene.can.radius))
    return 2 * math.pi / fastest if fastest else 1.0


def _tried(
    name: str, why: str, scene: Scene, phi0: float, rate: float = 0.0, sure: Ways = _SURE, swings: float = 5.0
) -> KnownCase:
    """Return a motion, some natural periods long, in every way of rolling, with RK4 and to a tolerance."""
    period, made = natural_period(scene, rate), []

    def lasting(duration: float, timestep: float, **setting: Any) -> Trial:
        steps = math.ceil(duration / timestep * (1 - 1e-10))
        return Trial(scene, phi0, rate, timestep=timestep, steps=steps, **setting)

    for rolling in ROLLINGS:
        trial = lasting(swings * period, period / _STEPS, rolling=rolling, integrator="RK4")
        made.append(Variant(f"{rolling}, RK4, T/{_STEPS}", trial, ERROR if rolling in sure else math.inf))
        if rolling != "contact":
            trial = lasting(swings * period, period / _STEPS, rolling=rolling, tolerance=TOLERANCE)
            within = TOLERANCE if "tolerance" in sure else math.inf
            made.append(Variant(f"{rolling}, to a tolerance of {TOLERANCE:g}", trial, within))
    desk = min(max(swings * period, 0.1), 30.0)  # as for a can on a desk, whatever the scene
    return KnownCase(name, why, (*made, Variant("reduced, RK4, 1 ms", lasting(desk, 1e-3))))


def _stiff() -> Iterator[KnownCase]:
    """Yield stiff motions."""
    for ratio in (1e-3, 1e-2, 1.0, 1e2, 1e3):
        for name, make in _EITHER:
            scene, why = make(can=Can.hoop(mass=ratio * Load.segment().mass)), "the mass matrix is badly conditioned"
            yield _tried(f"{name}, can {ratio:.0e} times the load", why, scene, 1.0)
    why = "J falls to a thousandth at phi = 0, where the load swings through in a thousandth of the period"
    yield _tried("pendulum on a wheel of 0.1 g", why, pendulum(wheel_mass=1e-4), 1.0, 0.0, _ADAPTED)
    for beside in (0.0, 1e-15, 1e-12, 1e-9, 1e-6, 1e-3):
        why = "at pi the tendon that gives the model its J has no length and no direction"
        yield _tried(f"frozen, let go {beside:g} rad beside pi", why, frozen(), math.pi - beside)


def _extreme() -> Iterator[KnownCase]:
    """Yield extreme motions."""
    for fill in (0.01, 0.03, 1 - 1e-3, 1 - 1e-6, 1.0):
        amount = f"{fill:g}" if fill < 0.5 or fill == 1 else f"1 - {1 - fill:.0e}"
        for name, make in _EITHER:
            for can in (None, _METAL):
                scene, sure, swings = make(fill=fill, can=can), _SURE, 5.0
                why = "a thin film of beer" if fill < 0.5 else "b = 0, or nearly: hardly any torque acts on the load"
                if 0.5 < fill < 1 and make is sliding:
                    # Only half a swing: where rounding disturbs the motion, a whole one would take minutes.
                    sure, swings = (), 0.5
                    distance = scene.acceleration() / 2 * (natural_period(scene) / 2) ** 2
                    why = f"rounding of the {distance:.0e} m that it rolls is not small beside b"
                title = f"{name}, {'massless' if can is None else 'metal'} can, fill {amount}"
                yield _tried(title, why, scene, 1.0, 0.0, sure, swings)
    for incline in (0.0, 1e-8, 85.0):
        sure = _SURE if incline < 1 else ("reduced", "equality")
        why = "level, or hardly tilted" if incline < 1 else "steep: little presses the can on the incline"
        for name, make, can in (("sliding, metal can", sliding, _METAL), ("frozen", frozen, None)):
            scene = make(math.radians(incline), can=can)
            yield _tried(f"{name}, incline {incline:g} degrees", why, scene, 0.5, 0.0, sure)
    fold = math.sin(frozen().largest_incline())
    for beside in (-1e-2, -1e-6, 1e-6, 1e-2):
        scene = frozen(math.asin(fold * (1 + beside)))
        start = scene.equilibrium() - 1e-3 * abs(beside) ** 0.5 if beside < 0 else math.pi / 2 - scene.incline
        why = "near the steepest incline with an equilibrium, eq. (53): a shallow well below, and a long rest above"
        yield _tried(f"frozen, {abs(beside):.0e} {'below' if beside < 0 else 'above'} the fold", why, scene, start)
    for gravity in (0.0, 1e-3, 1e3):
        why = "times are proportional to 1/sqrt(g)" if gravity else "nothing presses the can on the incline"
        for name, make in _EITHER:
            scene = make(gravity=gravity, can=_METAL)
            yield _tried(f"{name}, g = {gravity:g} m/s^2", why, scene, 1.0, 0.0 if gravity else 3.0)
    for name, scene in _EVERYWHERE:
        why = "rounding of the start grows as exp(lambda t) near the top"
        for beside, sure in ((1e-2, _ADAPTED), (1e-6, ()), (1e-10, ())):
            start = scene.separatrix()[1] - beside
            yield _tried(f"{name}, {beside:.0e} rad inside the separatrix", why, scene, start, 0.0, sure)
        for spin in (1e2, 1e4):
            why = "the energy of a swing is tiny beside that of the spin"
            yield _tried(f"{name}, spun at {spin:.0e} rad/s", why, scene, 0.5, spin)
        why = "exactly on top a sliding load balances, unless rounding pushes it off, and a frozen one rolls down"
        yield _tried(f"{name}, let go at pi", why, scene, math.pi, 0.0, ())
    why = "at the bottom the point stands still, and J is the hoop's alone"
    yield _tried("point on the rim of a hoop, let go a quarter turn from the bottom", why, hoop(), math.pi / 2)
    why = "1e-20 kg m^2 are far below MuJoCo's smallest (mjMINVAL, 1e-15), and lost beside the load's 1e-5"
    scene = Scene(Can(mass=1e-3, inertia=1e-20), Load.segment())
    yield _tried("can with next to no inertia around a sliding load", why, scene, 1.0, 0.0, ("reduced",))


def _found() -> Iterator[KnownCase]:
    """Yield the cases in which the random search found errors."""

    def case(name: str, why: str, setting: str, trial: Trial, within: float = math.inf) -> KnownCase:
        return KnownCase(name, why, (Variant(setting, trial, within),))

    contact: dict[str, Any] = {"rolling": "contact", "integrator": "DOP853"}
    why = "MuJoCo's solver stops once its cost falls by less than 1e-8 m^2/s^4: its tolerance has to scale with g^2"
    for name, scene in (("pendulum", pendulum(gravity=1e-3)), ("frozen", frozen(gravity=1e-3))):
        trial = Trial(scene, 1.0, 0.0, "contact", "RK4", math.sqrt(0.033 / 1e-3) / 100, steps=3000)
        yield case(f"{name} in contact in a gravity of 1e-3 m/s^2", why, "contact, RK4", trial, ERROR)

    can = Can(0.025006609705965473, 0.075, 4961.58700106942, 3.102631823991216)
    scene = Scene(can, Load(2589.3299018014327, 0.01647772919452516), 0.1789453673759448)
    trial = Trial(scene, 1.762099488321489, -10.949445992431022, tolerance=1e-3, steps=5040)
    why = "two runs were 1.4e-4 rad apart, but 1.1e-3 rad off: steps so large do not show the method's order"
    yield case("a swing through 2 rad, to a loose tolerance", why, "to a tolerance", trial, 1e-3)

    start, step = pendulum().separatrix()[1] - 1.9179754510771998e-4, 9.52342486122195e-4
    trial = Trial(pendulum(), start, timestep=step, tolerance=1e-8, steps=1984)
    why = "rounding grows a millionfold: two runs were by chance 3e-9 rad apart, and 7e-7 rad off"
    yield case("pendulum, 1.9e-4 rad inside the separatrix, to a tolerance", why, "to a tolerance", trial)

    can = Can(2.232597258875798, 6.697791776627394, 24.64135895693299, 122.82462012912089)
    load = Load(9007.68689806812, 0.9475437058226647, 14361.91170936032)
    scene, start = Scene(can, load, 1.7453292519943295e-10, "frozen"), 3.1415926530014993
    trial = Trial(scene, start, timestep=0.006320380984655366, friction=479.9389762024384, steps=4187, **contact)
    why = "the solver of the contact took what moves the can for nothing, alike at half the timestep"
    yield case("frozen, 6e-10 rad beside the top, in contact", why, "contact, DOP853, 6 ms", trial, ERROR)

    scene = frozen(math.radians(9.4), can=_METAL)
    trial = Trial(scene, -1.13, timestep=1.9e-4, friction=0.0147, steps=90, moments=(90.0,), **contact)
    why = "slip has to be counted over all steps, whatever samples are asked for"
    yield case("a can that slips before its only sample", why, "contact, DOP853, 0.19 ms", trial)

    scene, rate = Scene(Can(0.033, 0.1, 61.0, 0.0332), Load(0.1, 0.0039, 1.09e-5), 0.0), 1298.0
    trial = Trial(scene, -1.356, rate, "reduced", "RK4", 8 * math.pi / rate, steps=12, moments=(12.0,))
    why = "RK4 sees the same angle at every half of its step, and at half the timestep too; uneven timesteps do not"
    yield case("four whole turns in a timestep", why, "reduced, RK4, 19 ms", trial)

    can = Can(0.033, 0.099, 0.20528761908358859, 3.284134444100273e-11)
    scene = Scene(can, Load(0.1, 0.023717555437268875, 4.4992031467605796e-24), 0.1530378281024036)
    trial = Trial(scene, 0.1741755317767891, 47.46025974037111, tolerance=8.8e-5, steps=13_500)
    why = "two runs may miss the bottom alike; the energy drifts where a step does, and bounds the tolerance too"
    yield case(
        "a load without inertia in a can with next to none, to a tolerance", why, "to a tolerance", trial, 8.8e-5
    )
